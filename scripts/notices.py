#!/usr/bin/env python3
"""Prints the licences of the libraries that an artefact contains, or compares their list with what was built.

    scripts/notices.py npm|page|wheel|static|static-aarch64|static-windows    the notices, for the artefact
    scripts/notices.py ARTEFACT --check [BUILD:TARGET... | FILE...]   fails if they and the list differ

packaging/notices/notices.json lists the libraries, beside the texts of their licences. One of the "system" is contained where it is linked
statically only, and one without a licence needs no notice. "debian" or "npm" is the package that has it, for scripts/release/sbom.py. A BUILD folder of ninja tells which headers
and libraries went into a TARGET; a FILE lists the paths of sources of JavaScript, one a line.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TEXTS = ROOT / "packaging/notices"
LIBRARIES = json.loads((TEXTS / "notices.json").read_text(encoding="utf-8"))
ARTEFACTS = ("npm", "page", "wheel", "static", "static-aarch64", "static-windows")


def notices(artefact):
    contained = [library for library in LIBRARIES if artefact in library["in"] and library["licence"]]
    parts = ["Bendy contains the following software of others. The text of each licence is given once, below."]
    for library in contained:
        lines = [library["name"], f"Licence: {library['licence']}", *library["copyright"]]
        parts.append("\n".join(lines + ([library["note"]] if "note" in library else [])))
    for licence in sorted({library["licence"] for library in contained}):
        parts.append(f"{'-' * 80}\n{licence}\n\n" + (TEXTS / f"{licence}.txt").read_text(encoding="utf-8").strip("\n"))
    return "\n\n".join(parts) + "\n"


def ninja(build, *words):
    return subprocess.run(["ninja", "-C", build, "-t", *words], check=True, text=True, stdout=subprocess.PIPE).stdout


def used_by(build, target):
    """The headers and libraries of a target that are not the project's own, as absolute paths."""
    inputs = ninja(build, "inputs", target).split("\n")
    objects = [path for path in inputs if path.endswith((".o", ".obj"))]
    headers = [line.strip() for line in ninja(build, "deps", *objects).split("\n") if line.startswith("    ")] if objects else []
    paths = {str((Path(build) / path).resolve()) for path in headers + inputs}
    return {path for path in paths if not is_own(path)}


def is_own(path):
    """Whether it is a file of the project, made of one, or not of a library at all."""
    inside = path.startswith(f"{ROOT}/") and not re.search(r"/libraries/usr/|/node_modules/", path)
    return inside or not re.match(r"/usr/|.*/libraries/usr/|.*/node_modules/", path)


def used(sources):
    found = set()
    for source in sources:
        if Path(source).is_file():
            found |= {path for path in Path(source).read_text(encoding="utf-8").split("\n") if "/node_modules/" in path}
        else:
            build, target = source.split(":")
            found |= used_by(build, target)
    return found


def check(artefact, sources):
    """Sentences about what the list lacks, and about what it has and nothing uses."""
    paths = used(sources)
    problems, present = [], set()
    for path in sorted(paths):
        # A library of the system counts only where no other has the path.
        names = [library for library in LIBRARIES if re.search(library["found"], path)]
        names = [library for library in names if not library.get("system")] or names
        if not names:
            problems.append(f"{path} belongs to no library of packaging/notices/notices.json")
        for library in names:
            present.add(library["name"])
            is_shared = not artefact.startswith("static") and (library.get("system") or re.search(r"\.so[.\d]*$", path))
            if artefact not in library["in"] and not is_shared:
                problems.append(f"{artefact} contains {library['name']}, which packaging/notices/notices.json does not say: {path}")
    for library in LIBRARIES:
        if artefact in library["in"] and library["name"] not in present:
            problems.append(f"{artefact} does not contain {library['name']}, which packaging/notices/notices.json says")
    return problems


def main():
    words = sys.argv[1:]
    if len(words) == 1 and words[0] in ARTEFACTS:
        sys.stdout.reconfigure(encoding="utf-8")
        print(notices(words[0]), end="")
        return 0
    if len(words) > 2 and words[0] in ARTEFACTS and words[1] == "--check":
        problems = check(words[0], words[2:])
        print("\n".join(problems), file=sys.stderr, end="\n" if problems else "")
        return 1 if problems else 0
    print(__doc__.strip(), file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
