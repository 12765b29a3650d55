#!/usr/bin/env python3
"""Makes from bendy.h what Python has of it.

make_python.py BENDY_H made SOURCE.cpp STUB.pyi    the module bendy._bendy.c, over bindings/python/src/c_layer.h, and its types
make_python.py BENDY_H expand FROM.py TO.py        a file of the package: **options: "bendy_NAME" in a signature, its docstring and
                                                   the call below become the options, with their defaults, in the order of the struct;
                                                   the signature may have some of them itself; "convert_options" are those of `convert`;
                                                   follows: "bendy_HANDLE" in a class becomes what methods.py finds and it lacks

A function becomes one of the same name, without bendy_: errors are exceptions; what the function fills is its result, and a struct
may also be given by keyword to be filled; `count` follows from arrays; NULL and BENDY_NONE are None. bendy_NAME_free is what frees a
handle. A function whose comment says "Only for C" is left out.
"""

import re
import sys
import textwrap
from keyword import iskeyword
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import convert_options  # noqa: E402
from describe import read  # noqa: E402
from methods import Method, PARTS, class_of, documentation, follow, name_of  # noqa: E402

# type of C: kind in c_layer.h, Python's
NUMBERS = {"uint32_t": ("u32", "int"), "int32_t": ("i32", "int"), "uint64_t": ("u64", "int"), "int64_t": ("i64", "int"),
           "size_t": ("size", "int"), "float": ("f32", "float"), "double": ("f64", "float")}
ARRAYS = {"float": "NDArray[np.float32]", "double": "NDArray[np.float64]", "uint32_t": "NDArray[np.uint32]", "void": "NDArray[np.uint8]"}


def bare(name):
    return name[len("bendy_"):]


def python_name(name):
    return name + "_" * iskeyword(name)


def pascal(name):
    return "".join(word[:1].upper() + word[1:] for word in bare(name).split("_"))


def words_name(enum):
    return "k" + pascal(enum)


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def in_python(doc):
    """A comment with Python's names."""
    doc = re.sub(r"\bbendy_(\w+)", lambda found: found[1], doc)
    return re.sub(r"\b(?:BENDY_NONE|NULL)\b", "None", doc)


class Maker:
    def __init__(self, api):
        self.api = api
        self.frees = {f.parameters[0].type.name: f for f in api.functions.values()
                      if f.result is None and len(f.parameters) == 1 and f.parameters[0].type.name in api.handles}
        for handle in api.handles:
            if handle not in self.frees:
                raise SystemExit(f"nothing frees a {handle}")
        # Callers never see bendy_error: errors are exceptions.
        self.structs = {name: struct for name, struct in api.structs.items() if name != "bendy_error"}

    def is_rows(self, name):
        """Whether a struct consists of floats only, so that an array of them has one row each."""
        return name in self.structs and all(one.type.name == "float" and not one.type.is_pointer for one in self.structs[name].fields)

    def width(self, parameter):
        """Numbers of one element of an array."""
        if self.is_rows(parameter.type.name):
            return sum(one.count or 1 for one in self.structs[parameter.type.name].fields)
        found = re.search(r"(\d+) each", parameter.doc)
        return int(found[1]) if found else 1

    # Structs.

    def fields(self, struct):
        """(name in Python, field, name of its has_X) of the fields that callers see."""
        names = {one.name for one in struct.fields}
        for one in struct.fields:
            if one.name in ("size", "reserved") or (one.name.startswith("has_") and one.name[4:] in names):
                continue
            given = "has_" + one.name
            yield python_name(one.inverse or one.name), one, given if given in names else None

    def kind(self, one):
        kind = one.type.name
        if one.type.is_pointer:
            if kind == "char":
                return "text"
            if kind in NUMBERS or kind == "void":
                return "pointer" if one.type.is_const else "memory"
            return "reference"
        if kind == "char":
            return "characters"
        if kind in self.structs:
            return "nested"
        if kind == "uint32_t":
            if one.inverse:
                return "inverse_flag"
            if one.is_flag:
                return "flag"
            if one.enum in self.api.enums:
                return "word"
            if "BENDY_NONE" in one.doc:
                return "index"
        return NUMBERS[kind][0]

    def python_type(self, one, given=None):
        kind = self.kind(one)
        if kind in ("text", "characters"):
            made = "str"
        elif kind == "pointer":
            return "Optional[Pointer]"
        elif kind == "memory":
            return "Optional[NDArray[np.float32]]"
        elif kind == "reference":
            return f"Optional[{pascal(one.type.name)}]"
        elif kind == "nested":
            made = pascal(one.type.name)
        elif kind in ("flag", "inverse_flag"):
            made = "bool"
        elif kind == "word":
            made = pascal(one.enum) + "Word"
        elif kind == "index":
            return "Optional[int]"
        else:
            made = NUMBERS[one.type.name][1]
        if one.count and kind != "characters":
            made = f"Tuple[{', '.join([made] * one.count)}]"
        return f"Optional[{made}]" if given else made

    def struct_source(self, struct):
        name = struct.name
        rows = []
        for python, one, given in self.fields(struct):
            kind = self.kind(one)
            entry = [f".name = {quoted(python)}", f".doc = {quoted(in_python(one.doc))}", f".offset = offsetof({name}, {one.name})",
                     f".kind = Kind::{kind}"]
            if kind == "pointer":
                entry.append(f".element = Kind::{'u8' if one.type.name == 'void' else NUMBERS[one.type.name][0]}")
            if kind == "nested":
                entry.append(f".count = sizeof({one.type.name})")
            elif one.count:
                entry.append(f".count = {one.count}")
            if kind == "word":
                entry.append(f".words = {words_name(one.enum)}")
            if given:
                entry.append(f".given = offsetof({name}, {given})")
            if kind == "nested":
                entry.append(f".nested = &About<{one.type.name}>::layout()")
            if kind == "reference":
                what = "handle" if one.type.name in self.api.handles else "struct"
                entry.append(f".unwrap = &{what}_pointer<{one.type.name}>")
            rows.append("            {" + ", ".join(entry) + "},")
        if struct.defaults is not None:
            initial = f"    {name} made = {name.upper()}_INIT;\n        return made;"
        elif struct.has_size:
            initial = f"    {name} made{{}};\n        made.size = sizeof made;\n        return made;"
        else:
            initial = "    return {};"
        return "\n".join([
            "template <>", f"struct About<{name}> {{", f"    static {name} initial() {{", "    " + initial, "    }",
            "    static const Layout& layout() {", "        static const FieldInfo fields[] = {", *rows, "        };",
            f"        static const Layout layout{{{quoted(pascal(name))}, {quoted(in_python(struct.doc) or pascal(name))}, fields,",
            f"                                   &make_struct<{name}>}};",
            "        return layout;", "    }", "};", ""])

    # Functions.

    def plan(self, function):
        """A list of (role, parameter): how each parameter appears in Python."""
        listed = [one for one in function.parameters if one.type.name != "bendy_error"]
        values = {one.name for one in listed if not one.type.is_pointer and not one.count}
        counted = next((name for name in ("count", "capacity") if name in values), None)
        has_outputs = any(one.type.is_pointer and not one.type.is_const and not one.count and one.type.name in ARRAYS for one in listed)
        roles = []
        for one in listed:
            name, is_pointer = one.type.name, one.type.is_pointer
            if not is_pointer and one.count:  # an array of so many
                roles.append(("fixed in" if one.type.is_const else "fixed out", one))
            elif not is_pointer and name in NUMBERS:
                roles.append(("room" if one.name == counted else "size" if one.name == "size" and "bytes" in {two.name for two in listed}
                              else "number", one))
            elif name == "char":
                roles.append(("text", one))
            elif name == "void":
                roles.append(("bytes", one))
            elif name in self.api.handles:
                roles.append(("handle", one))
            elif name in NUMBERS or self.is_rows(name) and counted:
                if one.type.is_const:
                    roles.append(("array in" if counted and not has_outputs else "free array", one))
                else:
                    roles.append(("array out" if counted and name in ARRAYS or self.is_rows(name) else "scalar", one))
            elif name in self.structs:
                roles.append((("structs " if function.is_list(one) else "struct ") + ("in" if one.type.is_const else "out"), one))
            else:
                raise SystemExit(f"{function.name}: {one.name} is a {one.type}, which Python cannot take: say \"Only for C\" and why")
        return roles

    def parameters(self, roles):
        """(parameter of Python, its type, whether it may be omitted), in Python's order."""
        listed = []
        for role, one in roles:
            if role in ("room", "size", "scalar", "fixed out") or role.endswith(" out") and role.startswith("struct"):
                continue
            kind = one.type.name
            optional = one.may_be_null
            if role == "number":
                if one.enum in self.api.enums:
                    made = f"Union[{pascal(one.enum)}Word, int]"
                elif kind == "uint32_t":
                    made = "Optional[SupportsIndex]"
                else:
                    made = NUMBERS[kind][1]
                optional = False
            elif role == "text":
                made = "str"
            elif role == "bytes":
                made = "Buffer"
            elif role in ("handle", "struct in"):
                made = pascal(kind)
            elif role == "structs in":
                made = f"Sequence[{pascal(kind)}]"
            elif role == "array out":
                made = ARRAYS["float" if self.is_rows(kind) else kind]
            else:
                made = "ArrayLike"
            listed.append([one, f"Optional[{made}]" if optional else made, optional])
        for place, entry in enumerate(listed):
            entry[2] = all(later[2] for later in listed[place:])
        for role, one in roles:
            if role == "struct out":
                listed.append([one, f"Optional[{pascal(one.type.name)}]", True])
            elif role == "structs out":
                listed.append([one, f"Optional[Sequence[{pascal(one.type.name)}]]", True])
        return listed

    def results(self, function, roles):
        """(expression, type of Python) of what Python's function returns."""
        found = []
        counts = {one.name for role, one in roles if role == "scalar"}
        result = function.result
        owner = next((one.name + "_" for role, one in roles if role == "handle"), "py::none()")
        if result is not None and result.name != "bendy_status":
            if result.name in self.api.handles:
                kept = ", ".join(one.name + "_" for role, one in roles if role in ("handle", "bytes"))
                found.append((f"own<{result.name}>(result, {{{kept}}})", pascal(result.name)))
            elif result.is_pointer and result.name == "char":
                found.append(("text_result(result)", "Optional[str]"))
            elif result.is_pointer and "count" in counts:
                found.append((f"array_result({owner}, result, Kind::{NUMBERS[result.name][0]}, count)", ARRAYS[result.name]))
            elif result.is_pointer:
                found.append((f"pointer_result({owner}, result, Kind::{NUMBERS[result.name][0]})", "Optional[Pointer]"))
            elif function.may_be_none:
                found.append(("index_result(result)", "Optional[int]"))
            else:
                found.append(("py::cast(result)", NUMBERS[result.name][1]))
        takes_count = result is not None and result.is_pointer and "count" in counts
        for role, one in roles:
            if role == "scalar" and not (takes_count and one.name == "count"):
                found.append((f"py::cast({one.name})", NUMBERS[one.type.name][1]))
            elif role == "fixed out":
                found.append((f"std::move({one.name}.array)", ARRAYS[one.type.name]))
            elif role == "struct out":
                found.append((f"{one.name}.object", pascal(one.type.name)))
            elif role == "structs out":
                found.append((f"{one.name}.objects()", f"List[{pascal(one.type.name)}]"))
        return found

    def function_source(self, function):
        roles = self.plan(function)
        listed = self.parameters(roles)
        native = {}
        for role, one in roles:
            if role == "number" and one.type.name != "uint32_t":
                native[one.name] = "double" if one.type.name in ("float", "double") else f"std::{one.type.name}"
            elif role == "text":
                native[one.name] = "const std::string&"
        arguments = ", ".join(f"{native.get(one.name, 'const py::object&')} {one.name}_" for one, _, _ in listed)
        before, passed = [], []
        nulls = {one.name: f"Null::{'allowed' if one.may_be_null else 'refused'}" for _, one in roles}
        has_workers = any(one.name == "worker" for _, one in roles)
        handles = [one.name + "_" for role, one in roles if role == "handle"]
        rooms = []
        for role, one in roles:
            name, kind = one.name, one.type.name
            null = nulls[name]
            passes = name if role == "number" or role == "room" else f"{name}.get()"
            if role == "number":
                if one.enum in self.api.enums:
                    before.append(f"const std::uint32_t {name} = word_argument({name}_, \"{name}\", {words_name(one.enum)});")
                elif kind == "uint32_t":
                    before.append(f"const std::uint32_t {name} = index_argument({name}_, \"{name}\");")
                elif kind in ("float", "double") and function.can_fail:
                    before.append(f"const {kind} {name} = finite_{kind}({name}_, \"{name}\");")
                else:
                    before.append(f"const auto {name} = static_cast<{kind}>({name}_);")
            elif role == "text":
                passes = f"{name}_.c_str()"
            elif role == "bytes":
                before.append(f"const Buffer {name}({name}_);")
            elif role == "size":
                passes = "bytes.size()"
            elif role == "handle":
                writes = "false" if one.type.is_const or has_workers else "true"
                before.append(f"const Using<{kind}> {name}({name}_, \"{name}\", {null}, {writes});")
            elif role in ("fixed in", "array in", "free array"):
                number = "float" if self.is_rows(kind) else kind
                before.append(f"const Numbers<{number}> {name}({name}_, \"{name}\", {one.count}, {null});")
                if role == "free array":
                    before += self.length_check(function, one, handles[0])
                if role == "array in":
                    rooms.append(one)
                if self.is_rows(kind):
                    passes = f"reinterpret_cast<const {kind}*>({name}.get())"
            elif role == "fixed out":
                before.append(f"Fresh<{kind}> {name}({one.count});")
            elif role == "array out":
                number = "float" if self.is_rows(kind) else kind
                before.append(f"const Memory<{number}> {name}({name}_, \"{name}\", {null});")
                rooms.append(one)
                if self.is_rows(kind):
                    passes = f"reinterpret_cast<{kind}*>({name}.get())"
            elif role == "scalar":
                before.append(f"{kind} {name}{{}};")
                passes = "&" + name
            elif role == "struct in":
                before.append(f"const In<{kind}> {name}({name}_, \"{name}\", {null});")
            elif role == "structs in":
                before.append(f"const InList<{kind}> {name}({name}_, \"{name}\");")
                rooms.append(one)
            elif role == "struct out":
                before.append(f"Out<{kind}> {name}({name}_, \"{name}\", {{{', '.join(handles)}}});")
            passed.append(passes)
        room = next((one for role, one in roles if role == "room"), None)
        if room is not None:
            listed_rooms = ", ".join(f"room({one.name}, {self.width(one)}, \"{one.name}\")" for one in rooms)
            before.append(f"const auto {room.name} = static_cast<{room.type.name}>(room_of({{{listed_rooms}}}));")
        for role, one in roles:
            if role == "structs out":
                before.append(f"OutList<{one.type.name}> {one.name}({one.name}_, \"{one.name}\", {room.name});")
        if function.can_fail:
            before.append("Failure error;")
            passed.append("error.get()")
        call = f"{function.name}({', '.join(passed)})"
        gives = function.result is not None and function.result.name != "bendy_status"
        call = f"released([&] {{ return {call}; }});" if function.can_fail else f"{call};"
        after = [f"{f'auto* const result' if function.result.is_pointer else 'const auto result'} = {call}" if gives else call]
        if function.can_fail:
            after.append("error.check();")
        results = [expression for expression, _ in self.results(function, roles)]
        if len(results) == 1:
            after.append(f"return py::object({results[0]});")
        elif results:
            after.append(f"return py::object(py::make_tuple({', '.join(results)}));")
        names = "".join(f", py::arg({quoted(python_name(one.name))})" + " = py::none()" * may_miss for one, _, may_miss in listed)
        body = "\n".join("            " + line for line in before + after)
        return (f"    module.def(\n        \"{bare(function.name)}\",\n        []({arguments}) {{\n{body}\n        }}{names},\n"
                f"        {quoted(in_python(function.doc))});")

    def length_check(self, function, one, owner):
        """The statements that check the length of an array that the function does not take."""
        if not one.length:
            raise SystemExit(f"{function.name}: how many {one.name}? Say \"bendy_NAME numbers\"")
        name, field = one.length
        if not field:
            return [f"{one.name}.check_size({name}(model_of({owner})), \"{one.name}\");"]
        part = bare(name)
        return [f"{name} its_{part}{{}};", f"its_{part}.size = sizeof its_{part};",
                f"if (bendy_get_{part}(model_of({owner}), {part}, &its_{part}, nullptr) == BENDY_OK)",
                f"    {one.name}.check_size(its_{part}.{field}, \"{one.name}\");"]

    def is_only_for_c(self, function):
        return "Only for C" in function.doc

    def functions(self):
        frees = {function.name for function in self.frees.values()}
        return [one for one in self.api.functions.values() if one.name not in frees and not self.is_only_for_c(one)]

    def source(self):
        lines = ["// Made from bendy.h by bindings/make_python.py.", '#include "c_layer.h"', "", "namespace bendy::python::c {",
                 "namespace {", ""]
        for enum in self.api.enums.values():
            if enum.is_list:
                lines.append(f"constexpr const char* {words_name(enum.name)}[]{{{', '.join(map(quoted, enum.words))}}};")
        lines += ["", "}  // namespace", ""]
        lines += [self.struct_source(struct) for struct in self.structs.values()]
        lines += ["void bind_made(py::module_& module) {", "    bind_base(module);"]
        lines += [f"    bind_struct<{name}>(module);" for name in self.structs]
        for name, doc in self.api.handles.items():
            arguments = [quoted(pascal(name)), quoted(bare(name).replace("_", " ")), quoted(in_python(doc)), "&" + self.frees[name].name]
            lines.append(f"    bind_handle<{name}>(module, {', '.join(arguments)});")
        for enum in self.api.enums.values():
            if not enum.is_list:
                lines += [f"    module.attr(\"{name[len('BENDY_'):]}\") = {number};" for name, number, _ in enum.values]
        lines += [self.function_source(one) for one in self.functions()]
        lines += ["}", "", "}  // namespace bendy::python::c"]
        return "\n".join(lines) + "\n"

    def stub(self):
        lines = ['"""Made from bendy.h by bindings/make_python.py: the C API as the module bendy._bendy.c has it."""', "",
                 "from typing import Any, List, Literal, Optional, Sequence, SupportsIndex, Tuple, Union", "", "import numpy as np",
                 "from numpy.typing import ArrayLike, NDArray", "", "Buffer = Any"]
        for enum in self.api.enums.values():
            if enum.is_list:
                lines.append(f"{pascal(enum.name)}Word = Literal[{', '.join(map(quoted, enum.words))}]")
            else:
                lines += [f"{name[len('BENDY_'):]}: int" for name, _, _ in enum.values]
        lines += ["", "class Struct: ...", "class Handle: ...", "", "class Pointer:",
                  "    def array(self, *shape: int) -> NDArray[Any]: ..."]

        def docstring(doc, indent):
            return textwrap.indent(textwrap.fill(f'"""{in_python(doc)}"""', 120), indent) if doc else indent + "..."
        for struct in self.structs.values():
            lines += ["", f"class {pascal(struct.name)}(Struct):"]
            if struct.doc:
                lines.append(docstring(struct.doc, "    "))
            fields = list(self.fields(struct))
            given = "".join(f", {name}: {self.python_type(one, has)} = ..." for name, one, has in fields)
            lines.append(f"    def __init__(self, *{given}) -> None: ...")
            for name, one, has in fields:
                lines += ["    @property", f"    def {name}(self) -> {self.python_type(one, has)}:", docstring(one.doc, " " * 8)]
        for name, doc in self.api.handles.items():
            lines += ["", f"class {pascal(name)}(Handle):", docstring(doc, "    ")]
        for function in self.functions():
            roles = self.plan(function)
            listed = ", ".join(f"{python_name(one.name)}: {kind}" + " = ..." * may_miss for one, kind, may_miss in self.parameters(roles))
            results = [kind for _, kind in self.results(function, roles)]
            result = "None" if not results else results[0] if len(results) == 1 else f"Tuple[{', '.join(results)}]"
            lines += ["", f"def {bare(function.name)}({listed}) -> {result}:", docstring(function.doc, "    ")]
        return "\n".join(lines) + "\n"

    # The options of a struct, written out in the package's own functions.

    def default(self, one, value, given):
        kind = self.kind(one)
        if given or kind in ("reference", "memory", "pointer") or value == "BENDY_NONE":
            return "None"
        if kind in ("flag", "inverse_flag"):
            return str((value != "0") == (kind == "flag"))
        if kind == "word":
            enum = self.api.enums[one.enum]
            return quoted(next(word for word, (name, _, _) in zip(enum.words, enum.values) if name == value))
        if isinstance(value, list):
            return f"({', '.join(number.rstrip('f') for number in value)})"
        return value.rstrip("f") if kind == "f32" else value

    def options(self, name):
        """(name, type, default, help) of each option of a struct, or of `convert`."""
        if name == "convert_options":
            for name, _, default, _, text in convert_options.read():
                yield name, None, default, convert_options.with_names(text, lambda found: found.replace("-", "_"))
            return
        struct = self.api.structs[name]
        defaults = dict(zip((one.name for one in struct.fields), struct.defaults))
        for python, one, given in self.fields(struct):
            kind = "Optional[ArrayLike]" if given else "str" if self.kind(one) == "word" else self.python_type(one)
            doc = re.sub(r"; elsewhere: .*", "", in_python(one.doc))
            if self.kind(one) in ("flag", "inverse_flag"):
                doc = re.sub("^1: ", "True: " if self.kind(one) == "flag" else "False: ", doc)
            elif self.kind(one) == "word":
                doc = ", ".join(self.api.enums[one.enum].words)
            yield python, kind, self.default(one, defaults[one.name], given), doc

    def expand(self, text):
        return self.expand_options(self.expand_classes(text))

    def expand_options(self, text):
        """Replaces `**options: "bendy_NAME"`, or "convert_options", in a signature; in the function's docstring a line `**options`, and in its body `**options`
        in a call."""
        pieces = re.split(r"(?=^ *def )", text, flags=re.MULTILINE)
        for place, piece in enumerate(pieces):
            found = re.search(r"\*\*options: \"(\w+)\"", piece)
            if not found:
                continue
            options = list(self.options(found[1]))
            before = piece[:found.start()]
            star = "" if re.search(r"\*[,\w]", before[before.index("("):]) else "*, "
            by_hand = set(re.findall(r"\b(\w+):", before))
            signature = star + ", ".join(f"{name}: {kind} = {value}" if kind else f"{name}={value}" for name, kind, value, _ in options
                                         if name not in by_hand)
            column = len(before.rpartition("\n")[2])
            # Lines break between options.
            signature = textwrap.fill(re.sub(r"(?<!,) ", "\0", signature), 130 - column, break_long_words=False, break_on_hyphens=False)
            signature = signature.replace("\n", "\n" + " " * column).replace("\0", " ")
            piece = before + signature + piece[found.end():]
            indent = re.search(r"^( *)\*\*options$", piece, re.MULTILINE)[1]
            listed = "\n".join(textwrap.fill(f"{name}: {doc}.", 120, initial_indent=indent, subsequent_indent=indent + "    ")
                               for name, _, _, doc in options)
            piece = re.sub(r"^ *\*\*options$", lambda _: listed, piece, count=1, flags=re.MULTILINE)
            handles = {f"Optional[{pascal(one)}]" for one in self.api.handles}
            passed = [f'getattr({name}, "_handle", {name})' if kind in handles else name for name, kind, _, _ in options]
            pieces[place] = piece.replace("**options", ", ".join(passed))
        return "".join(pieces)

    # Properties and methods that follow, in the package's own classes.

    def expand_classes(self, text):
        """Replaces `follows: "bendy_HANDLE"` in a class."""
        pieces = re.split(r"(?=^class )", text, flags=re.MULTILINE)
        for place, piece in enumerate(pieces):
            found = re.search(r'^    follows: "(bendy_\w+)"\n', piece, re.MULTILINE)
            if not found:
                continue
            by_hand = set(re.findall(r"^    def (\w+)\(", piece, re.MULTILINE))
            made = [one for one in follow(self.api, found[1], re.compile("Only for C")).values()
                    if one.name not in by_hand and not (isinstance(one, Method) and one.out)]
            of = re.search(r"^class (\w+)", piece)[1]
            lines = [line for one in made for line in (self.method(one, of) if isinstance(one, Method) else self.property(one)) + [""]]
            listed = "\n".join("    " + line if line else "" for line in lines[:-1])
            pieces[place] = piece[:found.start()] + listed + "\n" + piece[found.end():]
        return "".join(pieces)

    def property(self, one):
        call = f"c.{bare(one.function.name)}(self._handle)"
        result = one.field and self.kind(one.field) == "word" and "str" or one.field and self.python_type(one.field)
        result = result or ("bool" if one.is_flag else NUMBERS[one.function.result.name][1])
        value = f"{call}.{one.name}" if one.field else f"bool({call})" if one.is_flag else call
        doc = re.sub("^1: ", "True: ", self.in_package(one.doc)) if one.is_flag else self.in_package(one.doc)
        if one.field and one.field.enum:
            doc = f"{re.sub(f'^an? {pascal(one.field.enum)}:? ?', '', doc) or 'one of'}: {', '.join(self.api.enums[one.field.enum].words)}"
        lines = ["@property", f"def {one.name}(self) -> {result}:", *self.docstring(doc), f"    return {value}"]
        if one.setter:
            lines += ["", f"@{one.name}.setter", f"def {one.name}(self, {one.name}: {result}) -> None:",
                      f"    c.{bare(one.setter.name)}(self._handle, {one.name})"]
        return lines

    def method(self, one, of):
        taken = "".join(", " + self.taken(given) for given in one.taken)
        passed = "".join(", " + self.passed(given) for given in one.given)
        raised = ["KeyError", "IndexError"] * any(given.name in PARTS for given in one.given) + ["ValueError"] * bool(one.given)
        subject = one.function.parameters[0].name
        doc = self.in_package(documentation(one.function).replace(f"`{subject}`", f"the {subject}"))
        is_changed = one.function.result.name == "bendy_status"
        result = of if is_changed else NUMBERS[one.function.result.name][1]
        call = f"c.{bare(one.function.name)}(self._handle{passed})"
        return [f"def {one.name}(self{taken}) -> {result}:", *self.docstring(doc, f"Raises {', '.join(raised)}." if raised else ""),
                *([f"    {call}", "    return self"] if is_changed else [f"    return {call}"])]

    def taken(self, one):
        if one.enum or one.name in PARTS:
            kind = "str" if one.enum else f"Union[str, SupportsIndex, {pascal('bendy_' + one.name)}]"
        else:
            kind = "ArrayLike" if one.length else pascal(one.type.name) if one.type.name in self.api.handles else "float"
        default = None if one.default is None else quoted(one.default) if one.enum else repr(float(one.default))
        kind, default = (f"Optional[{kind}]", "None") if one.may_be_null else (kind, default)
        return f"{one.name}: {kind}" + (f" = {default}" if default else "")

    def passed(self, one):
        if one.name in PARTS:
            return f'self._character.find("{one.name}", {one.name})'
        if one.type.name not in self.api.handles:
            return one.name
        return f'getattr({one.name}, "_handle", {one.name})' if one.may_be_null else f"{one.name}._handle"

    def in_package(self, doc):
        """A comment with the names of the package's classes."""
        words = {name: word for enum in self.api.enums.values() for (name, _, _), word in zip(enum.values, enum.words)}

        def of_function(found):
            function = self.api.functions.get(found[0])
            handle = function and class_of(function, self.api)
            return f"{pascal(handle)}.{name_of(function, handle)}" if handle else pascal(found[0])
        doc = re.sub(r"\b(?:BENDY_NONE|NULL)\b", "None", doc)
        doc = re.sub(r"\bBENDY_\w+", lambda found: f"`{words.get(found[0], found[0])}`", doc)
        doc = re.sub(r"\bbendy_\w+", of_function, doc)
        return doc

    def docstring(self, *sentences):
        doc = " ".join(sentence[:1].upper() + sentence[1:] + "." * (sentence[-1] != ".") for sentence in sentences if sentence)
        return textwrap.wrap(f'"""{doc}"""', 116, initial_indent="    ", subsequent_indent="    ")


def main():
    header, what, source, target = sys.argv[1:]
    maker = Maker(read(header))
    if what == "made":
        Path(source).write_text(maker.source(), encoding="utf-8")
        Path(target).write_text(maker.stub(), encoding="utf-8")
    else:
        expanded = maker.expand(Path(source).read_text(encoding="utf-8"))
        Path(target).unlink(missing_ok=True)  # it may have been a link to the source
        Path(target).write_text(expanded, encoding="utf-8")


if __name__ == "__main__":
    main()
