#!/usr/bin/env python3
"""Holds the Blender add-on and its records against Blender: blender_test.py --source SOURCE_DIR [--blender PROGRAM]

Makes the example characters, exports them with the add-on, and runs each check_*.py of this folder inside Blender; what each
one asks stands at its top. Exit 0: all is well; 1: something is not; 77: there is no Blender, or not 3.4 or later, or its Python
lacks numpy, which its glTF exporter needs.
"""

import argparse
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77
# A distribution's Blender looks for its Python by PATH, and one of a virtual environment would mislead it.
ENVIRONMENT = {**os.environ, "PATH": os.defpath, "PYTHONDONTWRITEBYTECODE": "1"}
NOISE = re.compile(r"^(Blender quit|Blender \d|Read blend|Info: |.* \| (INFO|ERROR): (?!.*fail)|\s*$)")
SAID = ("Limit Rotation: ", "IK limits: ", "Cases of ", "Export: ", "Spaces: ", "Reports: ", "  - ")   # by the checks


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def find_blender(program):
    blender = shutil.which(program)
    if blender is None:
        skip(f"{program} is not installed (Debian: apt-get install --no-install-recommends blender python3-numpy)")
    found = subprocess.run([blender, "--version"], capture_output=True, text=True, check=False)
    version = re.search(r"Blender (\d+)\.(\d+)", found.stdout)
    if version is None:
        skip(f"{blender} --version says {found.stdout[:80]!r}")
    if tuple(map(int, version.groups())) < (3, 4):
        skip(f"{version.group(0)} is older than 3.4")
    command = [blender, "-b", "-t", "1", "--factory-startup", "--python-exit-code", "1"]
    if subprocess.run([*command, "--python-expr", "import numpy"], capture_output=True, check=False, env=ENVIRONMENT).returncode:
        skip("Blender's glTF exporter needs numpy (Debian: python3-numpy)")
    return blender


class Runner:
    def __init__(self, blender, source):
        self.blender, self.source, self.failed = blender, source, []

    def run(self, title, script, *arguments, blend=None):
        """Runs a script of the project inside Blender. Its lines are printed; all of them if it fails."""
        command = [self.blender, "-b", "-t", "1", "--factory-startup", *([blend] if blend else []), "--python-exit-code", "1",
                   "--python", self.source / script, "--", *arguments]
        result = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                errors="replace", check=False, env=ENVIRONMENT)
        is_well = result.returncode == 0
        print(f"{'ok  ' if is_well else 'FAIL'} {title}")
        if not is_well:
            self.failed.append(title)
        lines = [line for line in result.stdout.splitlines() if not NOISE.match(line)]
        lines = lines[-60:] if not is_well else [line for line in lines if line.startswith(SAID)]
        print("".join(f"     {line}\n" for line in lines), end="", flush=True)
        return is_well


    def same_extras(self, character, made, committed):
        """The file of examples/ has what the add-on writes now."""
        is_same = extras(made) == extras(committed)
        print(f"{'ok  ' if is_same else 'FAIL'} {character}: extras of the file in examples/")
        if not is_same:
            print("     they differ: examples/make.sh makes it again")
            self.failed.append(f"{character}: examples/")


def extras(path):
    data = path.read_bytes()
    document = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])
    return {node["name"]: node["extras"] for node in document["nodes"] if "extras" in node}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--blender", default="blender")
    options = parser.parse_args()
    runner = Runner(find_blender(options.blender), options.source.resolve())
    tests = Path("tests") / "blender"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for character in ("tentacle", "mannequin"):
            glb, blend = folder / f"{character}.glb", folder / f"{character}.blend"
            if not runner.run(f"{character}: made", f"examples/blender/make_{character}.py", glb, blend):
                continue
            runner.same_extras(character, glb, runner.source / "examples" / f"{character}.glb")
            runner.run(f"{character}: extras", tests / "check_export.py", folder / f"{character}_again.glb", blend=blend)
            runner.run(f"{character}: Limit Rotation", tests / "check_limit_rotation.py", glb, blend=blend)
            runner.run(f"{character}: IK limits", tests / "check_ik_limits.py", glb, blend=blend)
        runner.run("spaces", tests / "check_spaces.py")
        (folder / "reports").mkdir()
        runner.run("reports", tests / "check_reports.py", folder / "reports")
        runner.run("cases.json", tests / "make_cases.py", options.source / tests / "cases.json", "check")
    if runner.failed:
        print(f"failed: {', '.join(runner.failed)}")
    return 1 if runner.failed else 0


if __name__ == "__main__":
    sys.exit(main())
