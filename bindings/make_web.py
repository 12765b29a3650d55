#!/usr/bin/env python3
"""Makes what the WebAssembly module and its TypeScript share, from the C header: make_web.py BENDY_H FOLDER SOURCE...

exports.txt   the functions that the module exports, for emscripten: those that the TypeScript sources, or classes.ts, call
bindings.ts   their types; the words of the enumerations; each struct as an object, with its documentation, and what reads or writes
              it; the class Calls, whose methods take and return such objects and throw
classes.ts    the bases of the classes for handles, with the properties and methods that follow from the header
layout.c      assertions about the structs' sizes and their fields' places, for the compiler
"""

import re
import sys
from pathlib import Path

import describe
from web_calls import Call
from web_classes import Base, classes
from web_structs import Structs, camel, comment, pascal, short


def raw_types(functions):
    """The interface of what the module exports."""

    def raw(kind, is_pointer):
        return "void" if kind is None else "bigint" if kind.name in ("uint64_t", "int64_t") and not is_pointer else "number"

    lines = ["export interface Functions {", "  memory: WebAssembly.Memory;", "  malloc(size: number): number;",
             "  free(at: number): void;", "  _initialize(): void;"]
    for function in functions:
        listed = ", ".join(f"{one.name}: {raw(one.type, one.type.is_pointer or one.count)}" for one in function.parameters)
        lines.append(f"  {function.name}({listed}): {raw(function.result, function.result and function.result.is_pointer)};")
    return lines + ["}", ""]


def words(structs):
    lines = []
    for enum in structs.api.enums.values():
        if enum.is_list:
            name = short(enum.name)
            listed = ", ".join(f"'{word}'" for word in enum.words)
            doc = [structs.phrase(enum.doc)]
            doc += [f"`{word}`: {note[0]}{structs.phrase(note)[1:]}" for word, (_, _, note) in zip(enum.words, enum.values) if note]
            lines += [f"export const {camel(name)}Words = [{listed}] as const;", *comment(" ".join(doc).strip()),
                      f"export type {pascal(name)} = (typeof {camel(name)}Words)[number];", ""]
    return lines


def calls(structs, functions):
    lines = ["/** The functions of bendy.h, with objects and lists instead of addresses. They throw the error of a failed call. */",
             "export class Calls {", "  readonly #runtime: Runtime;", "", "  constructor(runtime: Runtime) {",
             "    this.#runtime = runtime;", "  }"]
    for function in functions:
        if function.result:  # a function that frees an object is called with its address
            lines += ["", *Call(structs, function).lines()]
    return lines + ["}"]


def checks(layouts):
    lines = ["#include <bendy.h>", ""]
    for name, layout in layouts.items():
        lines.append(f"_Static_assert(sizeof({name}) == {layout.size}, \"{name}\");")
        lines += [f"_Static_assert(offsetof({name}, {field}) == {at}, \"{name}.{field}\");" for field, at in layout.places.items()]
    return lines


def called(structs, source):
    """The names of the functions that the sources call, and the bases that their classes have."""
    bases = [Base(structs, handle, source) for handle in structs.api.handles]
    return set(re.findall(r"\bbendy_\w+", source)).union(*(base.functions for base in bases)), bases


def main():
    api = describe.read(sys.argv[1])
    folder = Path(sys.argv[2])
    source = "".join(Path(source).read_text(encoding="utf-8") for source in sys.argv[3:])
    structs = Structs(api, source)
    names, bases = called(structs, source)
    functions = [function for function in api.functions.values() if function.name in names]
    bindings = ["// Made from bendy.h by bindings/make_web.py.", "import { checkNumber, type PointLike, type RotationLike } from '../numbers.js';",
                "import type { Handle, Runtime } from '../runtime.js';", "",
                *raw_types(functions), "function orNull(index: number): number | null {", "  return index === 0xffffffff ? null : index;",
                "}", "", *words(structs), *structs.all(), *calls(structs, functions)]
    exports = ["_malloc", "_free", *(f"_{function.name}" for function in functions)]
    for name, lines in (("bindings.ts", bindings), ("classes.ts", classes(structs, bases)), ("exports.txt", exports),
                        ("layout.c", checks(structs.layouts))):
        text = "\n".join(lines) + "\n"
        if not (folder / name).exists() or (folder / name).read_text(encoding="utf-8") != text:  # an unchanged file causes no linking
            (folder / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
