"""Makes the bases of TypeScript's classes: what follows from bendy.h for the class of a handle, see methods.py."""

import re

from methods import Method, PARTS, documentation, follow
from web_structs import camel, comment, pascal, short

EXCUSED = re.compile("Only for C|Not in JavaScript")


class Base:
    """The base of the class that says `extends MadePose`, with what that class does not define itself."""

    def __init__(self, structs, handle, source):
        self.structs, self.handle = structs, handle
        self.name = "Made" + pascal(short(handle))
        body = source.partition(f" extends {self.name} ")[2].partition("\n}\n")[0]
        by_hand = set(re.findall(r"^  (?:get |set )?(\w+)\(", body, re.MULTILINE))
        self.is_used = bool(body)
        followed = follow(structs.api, handle, EXCUSED).values() if body else []
        self.members = [one for one in followed if camel(one.name) not in by_hand]

    @property
    def functions(self):
        """The names of the functions that it calls."""
        setters = {one.setter.name for one in self.members if not isinstance(one, Method) and one.setter}
        return setters | {one.function.name for one in self.members}

    def type_of(self, one):
        """Of a parameter."""
        if one.enum:
            return pascal(short(one.enum))
        if one.name in PARTS:
            return f"Key<{pascal(one.name)}>"
        return pascal(short(one.type.name)) if one.type.name in self.structs.api.handles else "number"

    def taken(self, one):
        if one.default is not None:
            return f"{camel(one.name)}: {self.type_of(one)} = " + (f"'{one.default}'" if one.enum else one.default)
        return f"{camel(one.name)}{'?' if one.may_be_null else ''}: {self.type_of(one)}"

    def passed(self, one):
        plural = camel(one.name) + ("es" if one.name.endswith("h") else "s")
        return f"this.model.{plural}.number({camel(one.name)})" if one.name in PARTS else camel(one.name)

    def property(self, one):
        name, call = camel(one.name), f"this.runtime.calls.{one.function.name}(this)"
        if one.field:
            kind, value = self.structs.value_type(one.field, True), f"{call}.{name}"
        else:
            kind, value = ("boolean", f"{call} !== 0") if one.is_flag else ("number", call)
        doc = self.structs.phrase(one.doc, bool(one.field) and one.is_flag)
        lines = [*comment(doc), f"get {name}(): {kind} {{", f"  return {value};", "}"]
        if one.setter:
            lines += ["", f"set {name}({name}: {kind}) {{", f"  this.runtime.calls.{one.setter.name}(this, {name});", "}"]
        return lines

    def method(self, one):
        function = one.function
        thrown = ["NOT_FOUND"] * any(given.name in PARTS for given in one.given) + ["BAD_ARGUMENT"] * (function.can_fail and bool(one.given))
        doc = documentation(function).replace(f"`{function.parameters[0].name}`", f"the {function.parameters[0].name}")
        doc = self.structs.phrase(doc) + (f" Throws {', '.join(thrown)}." if thrown else "")
        call = f"this.runtime.calls.{function.name}({', '.join(['this', *map(self.passed, one.given)])});"
        is_changed = function.result.name == "bendy_status" and not one.out
        result = "this" if is_changed else pascal(one.out.type.name) if one.out else "number"
        return [*comment(doc), f"{camel(one.name)}({', '.join(map(self.taken, one.taken))}): {result} {{",
                *([f"  {call}", "  return this;"] if is_changed else [f"  return {call}"]), "}"]

    def lines(self):
        made = [self.method(one) if isinstance(one, Method) else self.property(one) for one in self.members]
        is_of_model = any(function.result and function.result.name == self.handle and function.parameters[0].type.name == "bendy_model"
                          for function in self.structs.api.functions.values())
        return [f"export abstract class {self.name} extends {'OfModel' if is_of_model else 'Handle'} {{",
                *"\n\n".join("\n".join("  " + line if line else "" for line in one) for one in made).split("\n"), "}", ""]


def classes(structs, bases):
    """The lines of classes.ts."""
    lines = [line for base in bases if base.is_used for line in base.lines()]
    text = "\n".join(lines)
    words = [pascal(short(enum)) for enum in structs.api.enums] + [pascal(name) for name in structs.api.structs]
    parts = ["Key", *map(pascal, PARTS), *(pascal(short(handle)) for handle in structs.api.handles)]

    def named(names):
        return ", ".join(sorted({name for name in names if re.search(rf"[:<] ?{name}\b", text)}))
    return ["// Made from bendy.h by bindings/make_web.py.", "import { Handle, OfModel } from '../runtime.js';",
            f"import type {{ {named(parts)} }} from '../index.js';", f"import type {{ {named(words)} }} from './bindings.js';", "", *lines]
