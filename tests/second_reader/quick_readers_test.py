#!/usr/bin/env python3
"""Compares the two readers of spec/readers with `bendy pose`, and holds them to what spec/quick.md tells them to refuse.

    quick_readers_test.py --bendy PROGRAM --cc COMPILER --source FOLDER --work FOLDER [--corpus FOLDER] [--readers FOLDER]

The examples, and the characters of the corpus where it is there, are converted exactly. Both readers then print each at
two times of its first clip, or in the rest pose. Names, parents and clips are those of `bendy inspect`; matrices and
positions are those of `bendy pose` within TOLERANCE of the character's largest coordinate. Of the conformance files, both
refuse the malformed and the unsupported ones, and read the valid ones or say that they do not read such a thing. They
refuse a file that is cut, that has a changed byte, or that is compact. Exit status 1 if anything differs.
"""

import argparse
import contextlib
import importlib.util
import io
import json
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
from own_folder import work_folder  # noqa: E402

TOLERANCE = 1e-6  # of the character's largest coordinate, at least 1: some units in the last place of an f32
PLACES = 50  # at which a small file is cut and changed
SHARES = (0.31, 0.77)  # of a clip: the times that are compared
LEFT_OUT = "this reader "  # does not read such a thing, or reads raw payloads only


class Readers:
    """Both readers as functions of arguments: exit status, output, errors. The one in Python runs in this process."""

    def __init__(self, folder, compiler, work):
        self.program = work / "quick_reader"
        source = folder / "quick_reader.c"
        flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O1"]
        subprocess.run([compiler, *flags, source, "-lm", "-o", self.program], check=True)
        spec = importlib.util.spec_from_file_location("quick_reader", folder / "quick_reader.py")
        self.module = importlib.util.module_from_spec(spec)
        sys.dont_write_bytecode = True
        spec.loader.exec_module(self.module)

    def c(self, *arguments):
        done = subprocess.run([self.program, *map(str, arguments)], capture_output=True, check=False)
        return done.returncode, done.stdout.decode("utf-8", "replace"), done.stderr.decode("utf-8", "replace")

    def python(self, *arguments):
        output = io.StringIO()
        try:
            with contextlib.redirect_stdout(output):
                self.module.main(*map(str, arguments))
        except SystemExit as ended:
            return 1, output.getvalue(), str(ended)
        except Exception as error:  # whatever it is, a reader must not end so
            return 2, output.getvalue(), repr(error)
        return 0, output.getvalue(), ""


class Printed:
    """What a reader printed."""

    def __init__(self, text):
        self.names = {"material": [], "joint": [], "clip": [], "mesh": []}
        self.rows = {"material": [], "joint": [], "clip": []}
        self.poses = []  # (matrices, positions), one after another
        for line in text.splitlines():
            word, *rest = line.split(" ", 1)
            numbers = {"material": 12, "joint": 14, "clip": 3, "pose": 1, "world": 16, "vertex": 3}.get(word, 0)
            values = [float(value) for value in rest[0].split(" ")[:numbers]] if numbers else []
            if word in self.names:
                self.names[word].append(" ".join(rest[0].split(" ")[numbers:]) if rest else "")
            if word in self.rows:
                self.rows[word].append(values)
            elif word == "pose":
                self.poses.append(([], []))
            elif word in ("world", "vertex"):
                self.poses[-1][word == "vertex"].extend(values)


def shown(name):
    return "".join(character if character >= " " else "?" for character in name)


class Test:
    def __init__(self, options):
        self.options = options
        self.faults = 0
        self.worst = 0.0
        self.work = options.work
        self.readers = Readers(options.readers or options.source / "spec/readers", options.cc, options.work)

    def expect(self, condition, message):
        if not condition:
            self.faults += 1
            print(message)

    def bendy(self, *arguments):
        return subprocess.run([self.options.bendy, *map(str, arguments)], capture_output=True, check=False)

    def character(self, file):
        """Compares one exact file; False if it has neither joints nor vertices."""
        summary = json.loads(self.bendy("inspect", "--json", "--summary", file).stdout)["summary"]
        clip = summary["clips"][0] if summary["clips"] else None
        times = [clip["start"] + share * clip["seconds"] for share in SHARES] if clip else [0.0]
        arguments = [file, 0, *times] if clip else [file]
        printed = []
        for name, reader in (("C", self.readers.c), ("Python", self.readers.python)):
            status, output, errors = reader(*arguments)
            self.expect(status == 0, f"{file.name}: the reader in {name} fails: {errors}")
            if status:
                return True
            printed.append(Printed(output))
        for name, found in zip(("C", "Python"), printed):
            expected = {"joint": summary["joints"], "clip": summary["clips"], "material": summary["materials"], "mesh": summary["meshes"]}
            for word, things in expected.items():
                times_printed = len(times) if word == "mesh" else 1
                names = [shown(thing["name"]) for thing in things] * times_printed
                self.expect(found.names[word] == names, f"{file.name}, {name}: {word}: {found.names[word]}, not {names}")
            parents = [-1 if joint["parent"] is None else joint["parent"] for joint in summary["joints"]]
            self.expect([row[0] for row in found.rows["joint"]] == parents, f"{file.name}, {name}: parents")
            ends = [[clip["start"], clip["end"]] for clip in summary["clips"]]
            printed_ends = [[float(f"{number:.6g}") for number in row[:2]] for row in found.rows["clip"]]  # as `inspect` rounds
            self.expect(printed_ends == ends, f"{file.name}, {name}: clips {printed_ends}, not {ends}")
            self.expect(len(found.poses) == len(times), f"{file.name}, {name}: {len(found.poses)} poses")
        self.near(file, "C", "materials", printed[0].rows["material"], printed[1].rows["material"], 1.0)
        self.near(file, "C", "rest transforms", printed[0].rows["joint"], printed[1].rows["joint"], 1.0)
        for place, time in enumerate(times):
            choice = ["--clip", "#0", "--time", repr(time)] if clip else []
            pose = json.loads(self.bendy("pose", "--format", "json", file, *choice).stdout)
            world = [value for joint in pose["joints"] for value in joint["world"]]
            positions = [value for mesh in pose["meshes"] for value in mesh["positions"]]
            size = max([1.0, *map(abs, world), *map(abs, positions)])
            for name, found in zip(("C", "Python"), printed):
                self.near(file, name, f"joints at {time}", [found.poses[place][0]], [world], size)
                self.near(file, name, f"positions at {time}", [found.poses[place][1]], [positions], size)
        return bool(summary["joints"] or summary["meshes"])

    def near(self, file, reader, what, found, expected, size):
        self.expect([len(row) for row in found] == [len(row) for row in expected], f"{file.name}, {reader}: number of {what}")
        differences = (abs(a - b) for row, other in zip(found, expected) for a, b in zip(row, other))
        worst = max(differences, default=0.0) / size
        self.worst = max(self.worst, worst)
        self.expect(worst <= TOLERANCE, f"{file.name}, {reader}: {what} differ by {worst:.3g} of {size:.3g}")

    def both_refuse(self, file, why, *words):
        for name, reader in (("C", self.readers.c), ("Python", self.readers.python)):
            status, _, errors = reader(file)
            self.expect(status == 1, f"{why}: the reader in {name} ends with {status} {errors}")
            self.expect(all(word in errors for word in words), f"{why}: the reader in {name} says only: {errors}")

    def damaged(self):
        good = (self.options.source / "spec/examples/one_joint.bendy").read_bytes()
        file = self.work / "damaged.bendy"
        file.write_bytes(good)
        self.expect(self.readers.c(file)[0] == 0 and self.readers.python(file)[0] == 0, "one_joint.bendy is not read")
        for k in range(PLACES):
            place = k * len(good) // PLACES
            file.write_bytes(good[:place])
            self.both_refuse(file, f"one_joint.bendy cut at {place}")
            file.write_bytes(good[:place] + bytes([good[place] ^ 1 << k % 8]) + good[place + 1 :])
            self.both_refuse(file, f"one_joint.bendy changed at {place}")

    def conformance(self):
        file = self.work / "case.bendy"
        required = 0
        for manifest in sorted((self.options.source / "tests/conformance").glob("*.json")):
            for case in json.loads(manifest.read_text(encoding="utf-8"))["cases"]:
                file.write_bytes(bytes.fromhex(case["bytes"]))
                required += any(fault["code"] == "REQUIRED_CHUNK_UNKNOWN" for fault in case["faults"])
                refused = any(fault["class"] in ("malformed", "unsupported") for fault in case["faults"])
                for name, reader in (("C", self.readers.c), ("Python", self.readers.python)):
                    status, _, errors = reader(file)
                    good = status in ((1,) if refused else (0, 1)) and (status == 0 or errors.count("\n") < 2)
                    if case["valid"]:
                        good = status == 0 or status == 1 and LEFT_OUT in errors
                    self.expect(good, f"{manifest.stem}/{case['name']}: the reader in {name} ends with {status} {errors}")
        self.expect(required, "no conformance file has an unknown chunk with REQUIRED")

    def run(self):
        models = sorted((self.options.source / "examples").glob("*.glb"))
        self.expect(models, "there are no examples")
        compact = self.work / "compact.bendy"
        for model in models:
            self.bendy("convert", "--quiet", "--compact", model, "-o", compact)
            self.both_refuse(compact, f"{model.name}, compact", "codec", "zstd")
        if self.options.corpus:
            files = (self.options.corpus / "visible").rglob("*.gl*")
            models += sorted(file for file in files if file.suffix in (".glb", ".gltf"))
        characters = 0
        for model in models:
            file = self.work / f"{model.parent.name}_{model.name}.bendy"
            if self.bendy("convert", "--quiet", "--keep-order", model, "-o", file).returncode == 0:
                characters += self.character(file)
            else:
                self.expect("examples" not in model.parts, f"{model.name} is not converted")
        self.damaged()
        self.conformance()
        print(f"{characters} characters, worst difference {self.worst:.2g} of the largest coordinate, {self.faults} faults")
        return 1 if self.faults else 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bendy", required=True)
    parser.add_argument("--cc", default="cc")
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--work", type=work_folder, required=True)
    parser.add_argument("--corpus", type=Path, help="left out where there is none")
    parser.add_argument("--readers", type=Path, help="other readers than those of spec/readers: to see that the test can fail")
    options = parser.parse_args()
    shutil.rmtree(options.work)
    options.work.mkdir()
    return Test(options).run()


if __name__ == "__main__":
    sys.exit(main())
