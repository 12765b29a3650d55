"""Makes the methods of the class Calls: the functions of bendy.h, with objects and lists instead of addresses."""

import re

from web_structs import NUMBERS, array_type, camel, is_text, pascal, short

SCRATCH = 512  # bytes of Runtime.scratch that a call may use
ARRAYS = {"float": ("Float32Array<ArrayBuffer>", "Floats"), "double": ("Float64Array<ArrayBuffer>", "Doubles"),
          "uint32_t": ("Uint32Array<ArrayBuffer>", "Integers")}


def is_count(parameter):
    return parameter.name == "count" and str(parameter.type) == "size_t"


class Call:
    """A method. Each parameter of the function adds to what the method takes, what it passes, and what it returns."""

    def __init__(self, structs, function):
        self.structs, self.function = structs, function
        self.given = []     # (name, type, whether it may be absent)
        self.passed = []    # expressions, for the function
        self.results = []   # (name, type, expression)
        self.prepared = []  # statements before the call
        self.borrowed = []  # (name, size in bytes) of memory during the call
        self.texts = []     # names of those that are in memory during the call
        self.used = 0       # bytes of Runtime.scratch in use
        self.listed = None  # the name of the list whose length is `count`
        parameters = [one for one in function.parameters if one.type.name != "bendy_error"]
        self.has_count = any(map(is_count, parameters))
        for one in parameters:
            self.take(one)
        assert self.used <= SCRATCH, function.name
        if function.can_fail:
            self.passed.append("runtime.error")

    def place(self, size):
        at = f"runtime.scratch + {self.used}"
        self.used += -(-size // 8) * 8
        return at

    def borrow(self, name, size):
        self.borrowed.append((f"{name}At", size))
        self.passed.append(f"{name}At")

    # ---- Parameters

    def take(self, one):
        name, kind, is_written = camel(one.name), one.type.name, not one.type.is_const
        struct = self.structs.api.structs.get(kind)
        if one.count:
            self.give_array(name, one) if is_written else self.take_array(name, one)
        elif not one.type.is_pointer:
            self.take_number(name, one)
        elif is_text(one):
            self.given.append((name, "string", False))
            self.texts.append(name)
            self.passed.append(f"{name}At")
        elif kind in self.structs.api.handles:
            self.given.append((name, "Handle", one.may_be_null))
            self.passed.append(f"runtime.address({name}, '{name}')")
        elif struct and not is_written and self.structs.is_given(struct):
            is_list = self.function.is_list(one)
            self.take_objects(name, struct) if is_list else self.take_object(name, struct, one.may_be_null)
        elif struct and is_written and self.listed and self.function.is_list(one):
            self.give_objects(name, struct)
        elif struct and is_written and one.name in ("out", "result"):
            self.give_object(name, struct)
        elif is_written and self.has_count and kind in ("float", "uint32_t"):
            self.give_list(name, one)
        elif is_written and kind in ("size_t", "uint64_t", "double"):
            self.give_number(name, one)
        else:
            self.address(name)

    def address(self, name):
        """Adds memory that the caller has."""
        self.given.append((name, "number", False))
        self.passed.append(name)

    def take_number(self, name, one):
        if self.listed and is_count(one):
            self.passed.append(f"{self.listed}.length")
        elif one.enum:
            self.given.append((name, pascal(short(one.enum)), False))
            self.passed.append(f"runtime.word({camel(short(one.enum))}Words, {name}, '{name}')")
        else:
            self.given.append((name, "number", False))
            self.passed.append(f"BigInt({name})" if one.type.name in ("uint64_t", "int64_t") else
                               f"checkNumber({name}, '{name}')" if one.type.name in ("float", "double") else name)

    def give_number(self, name, one):
        at = self.place(8)
        self.passed.append(at)
        method = NUMBERS[one.type.name][1]
        value = f"runtime.view.get{method}({at}, true)"
        self.results.append((name, "number", f"Number({value})" if method.startswith("Big") else value))

    def take_array(self, name, one):
        at = self.place(NUMBERS[one.type.name][0] * one.count)
        put = f"runtime.put{ARRAYS[one.type.name][1]}({at}, {name}, {one.count}, '{name}')"
        self.given.append((name, array_type(one.count), one.may_be_null))
        self.passed.append(f"{name} == null ? 0 : {put}" if one.may_be_null else put)

    def give_array(self, name, one):
        at = self.place(NUMBERS[one.type.name][0] * one.count)
        kind, numbers = ARRAYS[one.type.name]
        self.passed.append(at)
        self.results.append((name, kind, f"runtime.copy{numbers}({at}, {one.count})"))

    def give_list(self, name, one):
        """`count` numbers, or a multiple of `count` if the comment says so."""
        kind, numbers = ARRAYS[one.type.name]
        each = re.search(r"\b(\d+) each\b", one.doc)
        count = f"{each[1]} * count" if each else "count"
        self.borrow(name, f"4 * {count}")
        self.results.append((name, kind, f"runtime.copy{numbers}({name}At, {count})"))

    def take_object(self, name, struct, may_be_null):
        at = self.place(self.structs.layouts[struct.name].size)
        self.given.append((name, self.structs.given_type(struct), may_be_null))
        self.passed.append(f"write{pascal(struct.name)}(runtime, {at}, {name}{' ?? {}' if may_be_null else ''})")

    def give_object(self, name, struct):
        kind, at = pascal(struct.name), self.place(self.structs.layouts[struct.name].size)
        self.passed.append(f"runtime.struct({camel(short(struct.name))}Layout, {at})" if struct.has_size else at)
        self.results.append((name, kind, f"read{kind}(runtime, {at})"))

    def take_objects(self, name, struct):
        """A list: its structs one after another, followed by what they point to."""
        size, beyond = self.structs.layouts[struct.name].size, self.structs.beyond(struct)
        self.given.append((name, f"readonly {self.structs.given_type(struct)}[]", False))
        self.borrow(name, f"{size + beyond} * {name}.length")
        inner = f", {name}At + {size} * {name}.length + {beyond} * i" if beyond else ""
        write = f"write{pascal(struct.name)}(runtime, {name}At + {size} * i, one{inner})"
        self.prepared.append(f"{name}.forEach((one, i) => {write});")
        self.listed = name

    def give_objects(self, name, struct):
        """One for each item of the list."""
        kind, at = pascal(struct.name), f"{name}At + {self.structs.layouts[struct.name].size} * i"
        self.borrow(name, f"{self.structs.layouts[struct.name].size} * {self.listed}.length")
        self.prepared.append(f"{self.listed}.forEach((_, i) => runtime.struct({camel(short(struct.name))}Layout, {at}));")
        self.results.append((name, f"{kind}[]", f"{self.listed}.map((_, i) => read{kind}(runtime, {at}))"))

    # ---- The method

    def statements(self):
        """The method's body, and the type that it returns."""
        function, result = self.function, self.function.result
        call = f"runtime.functions.{function.name}({', '.join(self.passed)})"
        if result.name == "bendy_status" and len(self.results) > 1:
            kind = "{ " + "; ".join(f"{name}: {kind}" for name, kind, _ in self.results) + " }"
            return kind, [f"runtime.check({call});",
                          "return {", *(f"  {name}: {value}," for name, _, value in self.results), "};"]
        if result.name == "bendy_status" and self.results:
            return self.results[0][1], [f"runtime.check({call});", f"return {self.results[0][2]};"]
        if result.name == "bendy_status":
            return "void", [f"runtime.check({call});"]
        if result.is_pointer and self.results:  # a list, and its length
            return ARRAYS[result.name][0], [
                f"const at = {call};", f"return runtime.copyIntegers(at, at === 0 ? 0 : {self.results[0][2]});"]
        if result.name == "char":
            return ("unknown", [f"return runtime.json({call});"]) if function.is_json else ("string", [f"return runtime.text({call});"])
        if result.is_pointer and function.can_fail:
            return "number", [f"return runtime.checkHandle({call});"]
        if function.may_be_none:
            return "number | null", [f"return orNull({call} >>> 0);"]
        return "number", [f"return Number({call});" if result.name in ("uint64_t", "int64_t") else f"return {call};"]

    def lines(self):
        kind, lines = self.statements()
        lines = self.prepared + lines
        for name in self.texts:
            lines = [f"return runtime.withText({name}, ({name}At) => {{", *(f"  {line}" for line in lines), "});"]
        if self.borrowed:
            places, at = [], "memory"
            for name, size in self.borrowed:
                places.append(f"const {name} = {at};")
                at = f"{name} + {size}"
            size = " + ".join(size for _, size in self.borrowed)
            lines = [f"return runtime.borrow({size}, (memory) => {{", *(f"  {line}" for line in places + lines), "});"]
        last = len(self.given)  # trailing arguments that may be absent need not be passed
        while last and self.given[last - 1][2]:
            last -= 1
        listed = ", ".join(f"{name}{'?' if i >= last else ''}: {one}{' | null | undefined' if may_be_absent else ''}"
                           for i, (name, one, may_be_absent) in enumerate(self.given))
        return [f"  {self.function.name}({listed}): {kind} {{", "    const runtime = this.#runtime;",
                *(f"    {line}" for line in lines), "  }"]
