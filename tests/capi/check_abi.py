#!/usr/bin/env python3
"""Holds libbendy against bindings/c/abi.txt, what programs have been built against: check_abi.py --header H --library SO --list TXT --cc CC

The functions that the library shows, with their symbol versions, and that the header declares; the sizes of structs, places of fields
and values of constants, as a C compiler has them (64-bit machines). --renew writes the list. What stands in it after a release may be
added to, and a struct that begins with its size may grow; any other line that goes or changes needs a new soname."""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path


def declared(header):
    """(functions, {struct: fields}, constants) of the header."""
    text = re.sub(r"/\*.*?\*/", "", header, flags=re.S)
    functions = re.findall(r"^BENDY_API [^;(]*?(bendy_\w+)\(", text, re.M)
    structs = {}
    for name, body in re.findall(r"typedef struct (bendy_\w+) \{(.*?)\} \1;", text, re.S):
        structs[name] = re.findall(r"(\w+)(?:\[\w+\])?;", body)
    enums = re.findall(r"typedef enum \w+ \{(.*?)\}", text, re.S)
    constants = [name for body in enums for name in re.findall(r"BENDY_\w+", body)]
    return functions, structs, constants + ["BENDY_NONE"]


def compiled(header_path, structs, constants, cc):
    """Lines for structs and constants, from a program that the compiler makes."""
    prints = []
    for struct, fields in structs.items():
        prints.append(f'printf("struct {struct} %zu\\n", sizeof({struct}));')
        for field in fields:
            prints.append(f'printf("field {struct}.{field} at %zu, %zu bytes\\n", offsetof({struct}, {field}), sizeof((({struct}*)0)->{field}));')
    prints += [f'printf("constant {name} %ld\\n", (long){name});' for name in constants]
    source = "#include <bendy.h>\n#include <stdio.h>\nint main(void) {\n" + "\n".join(prints) + "\nreturn 0;\n}\n"
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "abi.c")
        file.write_text(source)
        subprocess.run([cc, "-std=c99", "-Wall", "-Wextra", "-Werror", f"-I{header_path.parent}", file, "-o", Path(folder, "abi")], check=True)
        return subprocess.run([Path(folder, "abi")], check=True, capture_output=True, text=True).stdout.splitlines()


def exported(library):
    """({function: symbol version}, other symbols) that the library shows."""
    lines = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout.splitlines()
    symbols = [(line.split()[1], *line.split()[2].replace("@@", "@").partition("@")[::2]) for line in lines]
    return ({name: version for kind, name, version in symbols if kind == "T"},
            [name for kind, name, _ in symbols if kind not in "TA"])


def grown(known, lines):
    """The lines of structs that begin with their size, and that are larger now."""
    sizes = dict(line.split()[1:] for line in lines if line.startswith("struct "))
    may_grow = {line.split()[1].split(".")[0] for line in lines if re.match(r"field \w+\.size at 0,", line)}
    old = [line.split() for line in known if line.startswith("struct ")]
    return {f"struct {name} {size}" for _, name, size in old if name in may_grow and int(sizes.get(name, 0)) > int(size)}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--header", type=Path, required=True)
    parser.add_argument("--library", required=True)
    parser.add_argument("--list", type=Path, required=True)
    parser.add_argument("--cc", required=True)
    parser.add_argument("--renew", action="store_true")
    arguments = parser.parse_args()

    functions, structs, constants = declared(arguments.header.read_text())
    shown, others = exported(arguments.library)
    faults = [f"{name}: the library shows it, the header does not declare it" for name in sorted(set(shown) - set(functions))]
    faults += [f"{name}: the header declares it, the library does not show it" for name in sorted(set(functions) - set(shown))]
    faults += [f"{name}: is no function, and must not be shown" for name in others]

    lines = [f"function {name} {shown.get(name)}" for name in sorted(functions)] + compiled(arguments.header, structs, constants, arguments.cc)
    if arguments.renew:
        arguments.list.write_text("\n".join(lines) + "\n")
    known = arguments.list.read_text().splitlines()
    faults += [f"{line}: in {arguments.list.name}, and no more so: programs that are built break" for line in known
               if line not in set(lines) | grown(known, lines)]
    faults += [f"{line}: not in {arguments.list.name}; --renew adds it" for line in lines if line not in set(known)]
    for fault in faults:
        print(fault)
    return 1 if faults or not functions or not structs else 0


if __name__ == "__main__":
    sys.exit(main())
