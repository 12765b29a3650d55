#!/usr/bin/env python3
"""Makes what the WebAssembly module and its TypeScript share, from the C header: make_bindings.py BENDY_H FOLDER SOURCE...

exports.txt   the functions that the module exports, for emscripten: those that the TypeScript sources call
bindings.ts   their types; the enumerations; for each struct its size, its fields' places and a function that reads it
layout.c      assertions about these sizes and places, for the compiler
"""

import re
import sys
from os.path import commonprefix
from pathlib import Path

# type: size and alignment in bytes, DataView's method
NUMBERS = {"uint32_t": (4, "Uint32"), "int32_t": (4, "Int32"), "float": (4, "Float32"), "size_t": (4, "Uint32"), "double": (8, "Float64"),
           "uint64_t": (8, "BigUint64"), "int64_t": (8, "BigInt64")}
POINTER = "pointer"


def camel(name):
    first, *rest = name.split("_")
    return first + "".join(word[:1].upper() + word[1:] for word in rest)


def pascal(name):
    """bendy_joint: BendyJoint, so that it is not the Joint of the package."""
    return camel("_" + name)


class Struct:
    """fields: (name, type, count): count 0 for a single value; text is a zero-terminated array or a pointer to one."""

    def __init__(self, name, body, structs):
        self.name, self.fields, self.size, self.alignment = name, [], 0, 1
        for declaration in filter(None, (" ".join(text.split()) for text in body.split(";"))):
            constant, kind, star, field, count = re.fullmatch(r"(const )?(\w+)(\*)? (\w+)(?:\[(\d+)\])?", declaration).groups()
            if star:
                kind, size, alignment = "text" if constant and kind == "char" else POINTER, 4, 4
            elif kind == "char":
                kind, size, alignment = "characters", 1, 1
            elif kind in NUMBERS:
                size = alignment = NUMBERS[kind][0]
            else:
                size, alignment = structs[kind].size, structs[kind].alignment
            self.size = -(-self.size // alignment) * alignment
            self.fields.append((field, kind, int(count or 0), self.size))
            self.size += size * int(count or 1)
            self.alignment = max(self.alignment, alignment)
        self.size = -(-self.size // self.alignment) * self.alignment


def read_field(kind, count, at):
    """The expression that reads a field, and its type."""
    if kind == "text":
        return f"runtime.text(runtime.view.getUint32(at + {at}, true))", "string"
    if kind == "characters":
        return f"runtime.text(at + {at})", "string"
    if kind == POINTER:
        return f"runtime.view.getUint32(at + {at}, true)", "number"
    if kind not in NUMBERS:
        return f"read{pascal(kind)}(runtime, at + {at})", pascal(kind)
    width, method = NUMBERS[kind]
    values = [f"runtime.view.get{method}(at + {at + width * i}, true)" for i in range(count or 1)]
    if method.startswith("Big"):
        values = [f"Number({value})" for value in values]
    if count:
        return f"[{', '.join(values)}]", "[" + ", ".join(["number"] * count) + "]"
    return values[0], "number"


def parameter_type(parameter):
    """The TypeScript type of a C parameter or result, and nothing for void."""
    if "*" in parameter or "bendy_pose_member" in parameter:
        return "number"
    if parameter.split()[0] in ("uint64_t", "int64_t"):
        return "bigint"
    return "number"


def main():
    header = Path(sys.argv[1]).read_text(encoding="utf-8")
    folder = Path(sys.argv[2])
    called = set(re.findall(r"\bbendy_\w+", "".join(Path(source).read_text(encoding="utf-8") for source in sys.argv[3:])))
    text = re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)
    text = re.sub(r"^#define(.*\\\n)*.*\n", "", text, flags=re.MULTILINE)

    enums = [(name, re.findall(r"(BENDY_\w+) = (\d+)", body)) for body, name in re.findall(r"typedef enum \w+ \{(.*?)\} (\w+);", text, re.DOTALL)]
    structs = {}
    for body, name in re.findall(r"typedef struct \w+ \{(.*?)\} (\w+);", text, re.DOTALL):
        structs[name] = Struct(name, body, structs)
    functions = []
    for result, name, parameters in re.findall(r"BENDY_API ([\w ]+?\*?) ?(bendy_\w+)\((.*?)\);", text, re.DOTALL):
        if name in called:
            parameters = [" ".join(parameter.split()) for parameter in parameters.split(",")]
            functions.append((name, "" if result == "void" else result, [] if parameters == ["void"] else parameters))

    lines = ["// Made from bendy.h by make_bindings.py.", "import type { Runtime } from '../runtime.js';", "", "export interface Functions {",
             "  memory: WebAssembly.Memory;", "  malloc(size: number): number;", "  free(at: number): void;", "  _initialize(): void;"]
    for name, result, parameters in functions:
        listed = ", ".join(f"{re.findall('[a-zA-Z_0-9]+', parameter)[-1]}: {parameter_type(parameter)}" for parameter in parameters)
        lines.append(f"  {name}({listed}): {parameter_type(result) if result else 'void'};")
    lines += ["}", ""]
    for name, values in enums:
        if [int(number) for _, number in values] == list(range(len(values))):  # not flags
            prefix = commonprefix([value for value, _ in values])
            prefix = prefix[:prefix.rindex("_") + 1]
            words = ", ".join(f"'{value.removeprefix(prefix).lower()}'" for value, _ in values)
            lines.append(f"export const {camel(name.removeprefix('bendy_'))}Words = [{words}] as const;")
    for struct in structs.values():
        fields = [field for field in struct.fields if field[0] not in ("size", "reserved")]
        reads = {field: read_field(kind, count, at) for field, kind, count, at in fields}
        lines += ["", f"export interface {pascal(struct.name)} {{"]
        lines += [f"  {camel(field)}: {kind};" for field, (_, kind) in reads.items()]
        lines += ["}", f"export const {camel(struct.name.removeprefix('bendy_'))}Layout = {{ size: {struct.size}, "
                  + ", ".join(f"{camel(field)}: {at}" for field, _, _, at in fields) + " } as const;",
                  f"export function read{pascal(struct.name)}(runtime: Runtime, at: number): {pascal(struct.name)} {{",
                  "  return {"]
        lines += [f"    {camel(field)}: {value}," for field, (value, _) in reads.items()]
        lines += ["  };", "}"]
    (folder / "bindings.ts").write_text("\n".join(lines) + "\n", encoding="utf-8")

    exports = ["malloc", "free", *(name for name, _, _ in functions)]
    (folder / "exports.txt").write_text("".join(f"_{name}\n" for name in exports), encoding="utf-8")

    checks = ["#include <bendy.h>", ""]
    for struct in structs.values():
        checks.append(f"_Static_assert(sizeof({struct.name}) == {struct.size}, \"{struct.name}\");")
        checks += [f"_Static_assert(offsetof({struct.name}, {field}) == {at}, \"{struct.name}.{field}\");" for field, _, _, at in struct.fields]
    (folder / "layout.c").write_text("\n".join(checks) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
