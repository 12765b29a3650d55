#!/usr/bin/env python3
"""Makes the outer layer of the C API from bendy.h: make_c.py BENDY_H FOLDER [--check]

calls.h     the functions that the sources of c/ define: each has its arguments checked already, and structs with defaults filled in
calls.cpp   the functions of bendy.h that can fail: they check their arguments, the same way everywhere, and call those of calls.h;
            and those that free a handle or count parts
fields.h    the first sizes of the structs that have grown; for each struct that crosses the boundary, how its fields are checked, and
            how they are copied: to a C++ struct that has all their names, and from one that may lack some

--check compares what is in FOLDER with what would be written."""

import argparse
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import describe  # noqa: E402

# A parameter with one of these names is the index of a part: of the model, or of the preceding clip, mesh or texture.
PARTS = dict.fromkeys(("joint", "clip", "chain", "morph_target", "mesh", "submesh", "joint_submesh", "material", "texture", "constraint"))
PARTS.update(track="clip", marker="clip", curve="clip", frame_sequence="clip", stream="mesh", image="texture")
# Handles that do not belong to a model.
WITHOUT_MODEL = ("bendy_playback", "bendy_fade", "bendy_retarget_state")
HEAD = "// Made from bendy.h by bindings/make_c.py.\n"


def words(name):
    return name.replace("_", " ")


def is_unit_quaternion(one):
    return one.count == 4 and one.type.name in ("float", "double") and (one.doc.startswith("unit quaternion") or one.name in ("rotation", "R"))


class Call:
    """A function that can fail: its checks, and the call that follows them."""

    def __init__(self, api, function):
        self.api, self.function = api, function
        self.parameters = function.parameters[:-1]
        self.checks, self.arguments, self.taken, self.puts = [], [], [], []
        self.subject = None  # the handle that others must share a model with
        self.owner = None  # the preceding handle whose parts are named
        for one in self.parameters:
            self.arguments.append(one.name)
            self.check(one)

    def require(self, expression):
        self.checks.append(f"if (const bendy_status status = {expression}) return status;")

    def check(self, one):
        kind = one.type.name
        if kind in self.api.handles:
            self.check_handle(one)
        elif kind in self.api.structs:
            self.check_struct(one)
        elif one.type.is_pointer or one.count or kind in self.api.callbacks:
            self.check_numbers(one)
        elif one.enum:
            self.require(f'check_value({one.name}, {self.api.enums[one.enum].values[-1][0]} + 1, "{one.name}", "{one.enum}", error)')
        elif one.name in PARTS:
            container = PARTS[one.name]
            owner = f', "the {container}"' if container else ""
            self.require(f'check_index({one.name}, parts(*{self.owner}).{one.name}({container or ""}), "{words(one.name)}", error{owner})')
        elif kind in ("float", "double"):
            check = "check_fraction" if one.is_fraction else "check_number" if one.doc.startswith("not NaN") else "check_finite"
            self.require(f'{check}({one.name}, "{one.name}", error)')

    def check_handle(self, one):
        if not one.may_be_null:
            self.require(f'check_pointer({one.name}, "{one.name}", error)')
        if one.type.name in WITHOUT_MODEL or "of another model" in one.doc:
            return
        if self.subject and one.type.name != "bendy_model":
            self.require(f'check_same_model({one.name}, *{self.subject}, "{one.name}", "{self.subject}", error)')
        if not one.may_be_null:
            self.subject = self.subject or one.name
            self.owner = one.name

    def check_struct(self, one):
        struct = self.api.structs[one.type.name]
        if self.function.is_list(one):  # checked where it is read
            return
        if not one.type.is_const:
            check = "check_out" if struct.has_size else "check_pointer"
            if not one.may_be_null or struct.has_size:
                test = f"{one.name} == nullptr ? BENDY_OK : " if one.may_be_null else ""
                self.require(f'{test}{check}({one.name}, "{one.name}", error)')
            self.checks.append(f"{struct.name} made_{one.name}{{}};")
            self.arguments[-1] = f"made_{one.name}"
            put = f"put(*{one.name}, made_{one.name});" if struct.has_size else f"*{one.name} = made_{one.name};"
            self.puts.append(f"if ({one.name} != nullptr) {put}" if one.may_be_null else put)
            self.taken.append(one.name)
            return
        if not one.may_be_null:
            self.require(f'check_pointer({one.name}, "{one.name}", error)')
        if struct.has_size:
            initial = f" = {struct.name.upper()}_INIT" if struct.defaults else "{}"
            self.checks.append(f"{struct.name} taken_{one.name}{initial};")
            self.require(f'take({one.name}, "{one.name}", taken_{one.name}, error)')
            self.arguments[-1] = f"taken_{one.name}"
        else:
            self.arguments[-1] = f"*{one.name}"
        self.taken.append(one.name)
        if has_checks(self.api, struct):
            self.require(f"check_fields({self.arguments[-1]}, error)")

    def check_numbers(self, one):
        if one.may_be_null:
            if one.count and one.type.is_const:
                self.require(f'{one.name} == nullptr ? BENDY_OK : {self.check_array(one)}')
            return
        self.require(f'check_pointer({one.name}, "{one.name}", error)')
        if one.count and one.type.is_const:
            self.require(self.check_array(one))

    def check_array(self, one):
        if is_unit_quaternion(one):
            return f"check_rotation({one.name}, error)"
        return f'check_finite(std::span({one.name}, {one.count}), "{one.name}", error)'

    @property
    def out(self):
        """(type, name, value on failure) of the result; None if it is a status."""
        result = self.function.result
        if result.name == "bendy_status":
            return None
        if result.is_pointer:
            return str(result), "made", "nullptr"
        return str(result), "made", "BENDY_NONE"

    def inner_declaration(self):
        listed = []
        for one in self.parameters:
            kind = one.type.name
            if one.name in self.taken:
                listed.append(f"{'const ' if one.type.is_const else ''}{kind}& {one.name}")
            else:
                listed.append(f"{one.type}{'*' if one.count else ''} {one.name}")
        if self.out:
            listed.append(f"{self.out[0]}& {self.out[1]}")
        return f"bendy_status {self.function.name.removeprefix('bendy_')}({', '.join(listed + ['bendy_error* error'])});"

    def definition(self):
        function = self.function
        listed = ", ".join(f"{one.type}{'*' if one.count else ''} {one.name}" for one in function.parameters)
        arguments = self.arguments + ([self.out[1]] if self.out else []) + ["error"]
        inner = f"bendy::capi::{function.name.removeprefix('bendy_')}({', '.join(arguments)})"
        if self.puts:
            inner = f"if (const bendy_status status = {inner}) return status; {' '.join(self.puts)} return BENDY_OK;"
        else:
            inner = f"return {inner};"
        call = f"guarded(error, [&]() -> bendy_status {{ {' '.join(self.checks)} {inner} }});"
        if not self.out:
            return f"{function.result} {function.name}({listed}) {{ return {call} }}\n"
        kind, name, value = self.out
        return f"{kind} {function.name}({listed}) {{ {kind} {name} = {value}; {call} return {name}; }}\n"


def plain_definition(function):
    """The definition of a function that cannot fail and whose form tells what it does: it frees a handle, or counts parts."""
    names = [one.name for one in function.parameters]
    listed = ", ".join(f"{one.type} {one.name}" for one in function.parameters)
    if function.result is None and len(names) == 1:
        return f"void {function.name}({listed}) {{ delete {names[0]}; }}\n"
    part = function.name.removeprefix("bendy_").removesuffix("_count")
    if names[:1] != ["model"] or part not in PARTS or names[1:] != list(filter(None, [PARTS[part]])):
        return None
    is_there = "model != nullptr" + "".join(f" && {name} < parts(*model).{name}()" for name in names[1:])
    return f"uint32_t {function.name}({listed}) {{ return {is_there} ? static_cast<uint32_t>(parts(*model).{part}({', '.join(names[1:])})) : 0; }}\n"


def fields_of(struct):
    return [one for one in struct.fields if one.name not in ("size", "reserved")]


def has_checks(api, struct):
    return any(one.enum or one.type.name in ("float", "double") and not one.type.is_pointer
               or one.type.name in api.structs and not one.type.is_pointer and has_checks(api, api.structs[one.type.name])
               for one in fields_of(struct))


def field_checks(api, struct):
    names = {one.name for one in struct.fields}
    lines = []
    for one in fields_of(struct):
        at = f"from.{one.name}"
        if one.type.is_pointer:
            continue
        if one.enum:
            check = f'check_value({at}, {api.enums[one.enum].values[-1][0]} + 1, "{one.name}", "{one.enum}", error)'
        elif one.type.name in api.structs:
            if not has_checks(api, api.structs[one.type.name]):
                continue
            check = f"check_fields({at}, error)"
        elif one.type.name not in ("float", "double"):
            continue
        elif is_unit_quaternion(one):
            check = f"check_rotation({at}, error)"
        elif one.is_fraction and not one.count:
            check = f'check_fraction({at}, "{one.name}", error)'
        else:
            check = f'check_finite({at}, "{one.name}", error)'
        if f"has_{one.name}" in names:
            check = f"from.has_{one.name} == 0 ? BENDY_OK : {check}"
        lines.append(f"if (const bendy_status status = {check}) return status;")
    return lines


def copies(struct):
    """(member of the C++ struct, statements from C, statements to C) for each field."""
    names = {one.name for one in struct.fields}
    for one in fields_of(struct):
        if one.type.is_pointer:
            continue
        if one.name.startswith("has_") and one.name.removeprefix("has_") in names:
            continue
        if f"has_{one.name}" in names:
            yield (one.name, f"if (from.has_{one.name} != 0) assign(from.{one.name}, to.{one.name}.emplace());",
                   f"to.has_{one.name} = from.{one.name} ? 1 : 0; if (from.{one.name}) assign(*from.{one.name}, to.{one.name});")
        elif one.inverse:
            yield one.inverse, f"to.{one.inverse} = from.{one.name} == 0;", f"to.{one.name} = from.{one.inverse} ? 0 : 1;"
        else:
            yield one.name, f"assign(from.{one.name}, to.{one.name});", f"assign(from.{one.name}, to.{one.name});"


def crossing(api, is_const):
    """The structs that functions take, or fill, and those inside them, in the order of the header."""
    found = set()

    def add(name):
        if name in api.structs and name not in found:
            found.add(name)
            for one in api.structs[name].fields:
                add(one.type.name)

    for function in api.functions.values():
        for one in function.parameters:
            if one.type.is_pointer and one.type.is_const == is_const:
                add(one.type.name)
    return [struct for struct in api.structs.values() if struct.name in found and struct.name not in ("bendy_error", "bendy_box")]


def make(api):
    calls = [Call(api, function) for function in api.functions.values() if function.can_fail]
    made = {"calls.h": HEAD + '#pragma once\n#include "handles.h"\n#include <bendy.h>\n#include <cstddef>\n#include <cstdint>\n'
            "// The functions of bendy.h after their arguments are checked. A struct has the size that this library gives it, and fields that the\n"
            "// program does not know have their defaults.\nnamespace bendy::capi {\n"
            + "\n".join(call.inner_declaration() for call in calls) + "\n}\n",
            "calls.cpp": HEAD + '#include "calls.h"\n#include "fail.h"\n#include "fields.h"\n#include "lookup.h"\n#include <bendy.h>\n'
            "#include <cstddef>\n#include <cstdint>\n#include <span>\nusing namespace bendy::capi;\n\n" + "\n".join(filter(None, (Call(api, function).definition() if function.can_fail else plain_definition(function)
                                        for function in api.functions.values())))}
    inputs, outputs = crossing(api, True), crossing(api, False)
    lines = [HEAD + '#pragma once\n#include "assign.h"\n#include "fail.h"\n#include <bendy.h>\n#include <cstddef>\nnamespace bendy::capi {']
    for struct in api.structs.values():
        lines += [f"template <> inline constexpr std::size_t kFirstSize<{struct.name}> = offsetof({struct.name}, {one.name});"
                  for one in struct.fields if one.is_later]
    for struct in api.structs.values():
        members = []
        if struct in inputs and has_checks(api, struct):
            members.append(f"static bendy_status check(const {struct.name}& from, bendy_error* error) {{ "
                           + " ".join(field_checks(api, struct)) + " return BENDY_OK; }")
        if struct in inputs:
            members.append(f"template <class To> static void from_c(const {struct.name}& from, To& to) {{ "
                           + " ".join(take for _, take, _ in copies(struct)) + " }")
        if struct in outputs:
            members.append(f"template <class From> static void to_c(const From& from, {struct.name}& to) {{ "
                           + " ".join(f"if constexpr (requires {{ from.{member}; }}) " + (f"{{ {put} }}" if ";" in put[:-1] else put)
                                      for member, _, put in copies(struct)) + " }")
        if members:
            lines.append(f"template <> struct Fields<{struct.name}> {{ " + "\n".join(members) + " };\n")
    made["fields.h"] = "\n".join(lines) + "\n}\n"
    return made


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("header", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    stale = []
    for name, text in make(describe.read(arguments.header)).items():
        file = arguments.folder / name
        command = ["clang-format", f"--assume-filename={file.resolve()}"]
        text = subprocess.run(command, input=text, check=True, capture_output=True, text=True).stdout
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            stale.append(name)
            if not arguments.check:
                file.write_text(text, encoding="utf-8")
    if arguments.check and stale:
        print(f"{', '.join(stale)}: not what make_c.py makes of {arguments.header.name}; run it")
    return 1 if arguments.check and stale else 0


if __name__ == "__main__":
    sys.exit(main())
