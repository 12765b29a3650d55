#!/usr/bin/env python3
"""Holds the Blender add-on and its records against Blender:

    blender_test.py records|files --source SOURCE_DIR [--bendy PROGRAM] [--corpus FOLDER] [--blender PROGRAM]

Makes the example characters, and runs each check_*.py of this folder inside Blender; what each one asks stands at its top.
records: what the add-on writes into glTF; files: imports and exports of .bendy files, by the program. Exit 0: all is well; 1:
something is not; 77: there is no Blender, or not 3.4 or later, or its Python lacks numpy, which its glTF exporter needs.
"""

import argparse
import ast
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from pathlib import Path

from attached import attached_character
from strange_rig import strange_rig

SKIPPED = 77
# A distribution's Blender looks for its Python by PATH, and one of a virtual environment would mislead it.
ENVIRONMENT = {**os.environ, "PATH": os.defpath, "PYTHONDONTWRITEBYTECODE": "1"}
NOISE = re.compile(r"^(Blender quit|Blender \d|Read blend|Info: |.* \| (INFO|ERROR): (?!.*fail)|\s*$)")
SAID = ("Limit Rotation: ", "IK limits: ", "Cases of ", "Export: ", "Spaces: ", "Reports: ", "Settings: ", "Import", "Round trip", "  - ")
# Of the corpus: 24 joints, 3 clips; a hand with cubic keys and a mirrored armature; STEP, LINEAR and cubic keys on objects, and on
# joints; clips that move some of the joints; morph targets. CONVERT: with proposed chains, whose tips are beside Blender's bones.
CORPUS = ("models/fox.glb", "models/left_hand_high.glb", "models/interpolation_test/InterpolationTest.gltf",
          "generated/mixed_interpolation.glb", "generated/partial_clips.glb", "models/morph_stress_test.gltf")
CONVERT = ("convert", "--quiet", "--auto-rig")


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


def check_records(runner, folder):
    tests = Path("tests") / "blender"
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
    runner.run("cases.json", tests / "make_cases.py", runner.source / tests / "cases.json", "check")
    runner.run("settings", tests / "check_settings.py")
    runner.run("keys", tests / "check_thin_keys.py")
    check_zip(runner, folder)


def check_zip(runner, folder):
    """What the preferences install: all modules, the licence, and the manifest, which says what __init__.py says."""
    subprocess.run([runner.source / "bindings" / "blender" / "make_zip.sh", folder], check=True)
    package = runner.source / "bindings" / "blender" / "bendy_rig"
    with zipfile.ZipFile(folder / "bendy_rig.zip") as archive:
        names = set(archive.namelist())
        manifest = tomllib.loads(archive.read("bendy_rig/blender_manifest.toml").decode())
    bl_info = next(ast.literal_eval(node.value) for node in ast.parse((package / "__init__.py").read_text()).body
                   if isinstance(node, ast.Assign) and node.targets[0].id == "bl_info")
    is_well = (names == {f"bendy_rig/{path.name}" for path in package.iterdir() if path.suffix in (".py", ".toml")} | {"bendy_rig/LICENSE"}
               and (manifest["id"], manifest["name"], manifest["tagline"]) == ("bendy_rig", bl_info["name"], bl_info["description"])
               and manifest["version"] == ".".join(map(str, bl_info["version"])))
    print(f"{'ok  ' if is_well else 'FAIL'} bendy_rig.zip")
    if not is_well:
        print(f"     {sorted(names)}, {manifest}, {bl_info}")
        runner.failed.append("bendy_rig.zip")


def check_files(runner, folder, bendy, corpus):
    tests, out, files = Path("tests") / "blender", folder / "out", []
    out.mkdir()
    for character in ("tentacle", "mannequin"):
        blend, file = folder / f"{character}.blend", folder / f"{character}.bendy"
        bendy("convert", "--quiet", runner.source / "examples" / f"{character}.glb", "-o", file)
        files.append(file)
        if character == "mannequin":  # roles that nobody would find
            files.append(folder / "roles.bendy")
            roles = ("jaw=mixamorig:Neck", "hips=", "tail:3=mixamorig:LeftToeBase", "tail:1=Body")
            bendy("edit", file, "-o", files[-1], *(f"--role={role}" for role in roles))
        if runner.run(f"{character}: made", f"examples/blender/make_{character}.py", folder / f"{character}.glb", blend):
            runner.run(f"{character}: import", tests / "check_import.py", bendy.program, file, out, blend=blend)
    rig = folder / "strange.rig.json"
    rig.write_text(json.dumps(strange_rig()), encoding="utf-8")
    files.append(folder / "strange.bendy")
    bendy("convert", "--quiet", runner.source / "examples" / "tentacle.glb", "--rig", rig, "-o", files[-1])
    for path, text in zip((folder / "attached.gltf", folder / "attached.rig.json"), attached_character()):
        path.write_text(text, encoding="utf-8")
    files.append(folder / "attached.bendy")
    bendy("convert", "--quiet", folder / "attached.gltf", "--rig", folder / "attached.rig.json", "-o", files[-1])
    if corpus and (corpus / "visible").is_dir():
        for name in CORPUS:
            files.append(folder / f"{Path(name).stem}.bendy")
            bendy(*CONVERT, corpus / "visible" / name, "-o", files[-1])
    else:
        print("no corpus: the examples only")
    runner.run("round trips", tests / "check_round_trip.py", bendy.program, out, *files)
    runner.run("the block of docs/languages.md", tests / "check_languages.py", bendy.program, runner.source / "docs/languages.md", folder)
    (folder / "kept").mkdir()
    runner.run("what Blender does not know", tests / "check_kept.py", bendy.program, folder / "kept")
    (folder / "errors").mkdir()
    runner.run("import errors", tests / "check_import_errors.py", bendy.program, files[0], runner.source / "examples" / "tentacle.glb",
               folder / "errors")


class Bendy:
    def __init__(self, program):
        self.program = program.resolve()

    def __call__(self, *arguments):
        subprocess.run([self.program, *map(str, arguments)], check=True, stderr=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("part", choices=("records", "files"))
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--bendy", type=Path)
    parser.add_argument("--corpus", type=Path)
    parser.add_argument("--blender", default="blender")
    options = parser.parse_args()
    runner = Runner(find_blender(options.blender), options.source.resolve())
    with tempfile.TemporaryDirectory() as name:
        if options.part == "records":
            check_records(runner, Path(name))
        else:
            check_files(runner, Path(name), Bendy(options.bendy), options.corpus)
    if runner.failed:
        print(f"failed: {', '.join(runner.failed)}")
    return 1 if runner.failed else 0


if __name__ == "__main__":
    sys.exit(main())
