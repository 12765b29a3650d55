#!/usr/bin/env python3
"""Runs the program as a user does and looks at its exit status, its streams and its files.

    cli_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import argparse
import contextlib
import json
import math
import os
import platform
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock
import urllib.parse
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from chunk_file import Chunk  # noqa: E402
from gltf_file import GltfFile, strange_file  # noqa: E402
from md2_file import Md2, md2_file, player_names, tube_md2  # noqa: E402
from schema import is_valid  # noqa: E402

BENDY = ""
SOURCE = Path()
COMMANDS = ("convert", "export", "inspect", "validate", "pose", "rig", "diff", "edit", "dump", "assemble", "bench")
# How to run a program that can write no more than 5000 bytes: a limit stands for the full disk, and the signal that
# comes with it stays ignored.
FULL_DISK = {"restore_signals": False,
             "preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000))}


def floats(data):
    return list(struct.unpack(f"<{len(data) // 4}f", data))


def as_float(text):
    """A decimal number as the float that it means."""
    return struct.unpack("<f", struct.pack("<f", float(text)))[0]


def read_obj(text):
    """Positions, normals, faces, lines and points, each a list of tuples; indices count from 0."""
    found = {"o": [], "v": [], "vn": [], "f": [], "l": [], "p": []}
    for line in text.splitlines():
        keyword, _, rest = line.partition(" ")
        if keyword in ("v", "vn"):
            found[keyword].append(tuple(as_float(number) for number in rest.split()))
        elif keyword in ("f", "l", "p"):
            corners = [corner.split("//") for corner in rest.split()]
            assert all(corner[0] == corner[-1] for corner in corners), line
            found[keyword].append(tuple(int(corner[0]) - 1 for corner in corners))
        elif keyword == "o":
            found["o"].append(rest)
        else:
            assert keyword == "#", line
    return found


def read_ply(data):
    """Positions, normals and faces of a binary PLY."""
    head, _, body = data.partition(b"end_header\n")
    lines = head.decode("ascii").splitlines()
    assert lines[0] == "ply" and lines[1] == "format binary_little_endian 1.0", lines[:2]
    elements = {}
    for line in lines[2:]:
        words = line.split()
        if words[0] == "element":
            elements[words[1]] = (int(words[2]), [])
            last = words[1]
        elif words[0] == "property":
            elements[last][1].append(tuple(words[1:]))
    at = 0
    result = {}
    for name, (count, properties) in elements.items():
        rows = []
        for _ in range(count):
            row = []
            for kind, *rest in properties:
                if kind == "list":
                    length = body[at]
                    row += struct.unpack_from(f"<{length}I", body, at + 1)
                    at += 1 + 4 * length
                else:
                    row += struct.unpack_from("<f" if kind == "float" else "<I", body, at)
                    at += 4
            rows.append(tuple(row))
        result[name] = rows
    assert at == len(body), "bytes are left over"
    return result


def in_full(shown, path):
    """A line with a path as it is shown, the steps that "... N more ..." stands for filled in from the real one."""
    match = re.search(r"\.\.\. (\d+) more \.\.\.", shown)
    if not match:
        return shown
    before = shown[shown.rfind("(", 0, match.start()) + 1 : match.start()].count("/")
    return shown.replace(match.group(), "/".join(path.split("/")[before : before + int(match.group(1))]))


class Case(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.shared = Path(tempfile.mkdtemp(prefix="bendy_cli_"))
        cls.addClassCleanup(shutil.rmtree, cls.shared)

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(dir=self.shared))

    def bendy(self, *arguments, **options):
        return subprocess.run([BENDY, *arguments], cwd=self.folder, capture_output=True, timeout=120, check=False,
                              **options)

    def done(self, *arguments, **options):
        """Runs what must work: its standard output; nothing but warnings may stand on standard error."""
        result = self.bendy(*arguments, **options)
        self.assertEqual(result.returncode, 0, (arguments, result.stderr))
        for line in result.stderr.decode().splitlines():
            self.assertTrue(line.startswith("bendy: warning: "), line)
        return result.stdout

    def failed(self, *arguments, file=None, **options):
        """Runs what must fail for its input: the one line of error; standard output stays empty."""
        result = self.bendy(*arguments, **options)
        self.assertEqual(result.returncode, 1, (arguments, result.stderr))
        self.assertEqual(result.stdout, b"")
        lines = result.stderr.decode().splitlines()
        self.assertEqual(len(lines), 1, lines)
        self.assertTrue(lines[0].startswith("bendy: error: " + (f"{file}: " if file is not None else "")), lines[0])
        return lines[0]

    def misused(self, *arguments):
        """Runs a wrong command line: what is said of it."""
        result = self.bendy(*arguments)
        self.assertEqual(result.returncode, 2, (arguments, result.stderr))
        self.assertEqual(result.stdout, b"")
        text = result.stderr.decode()
        self.assertTrue(text.startswith("bendy: error: "), text)
        return text

    def files(self):
        return sorted(entry.name for entry in self.folder.iterdir())

    def convert(self, name="mannequin"):
        """A converted example; made once for each class."""
        path = self.shared / f"{name}.bendy"
        if not path.exists():
            self.done("convert", SOURCE / "examples" / f"{name}.glb", "-o", path)
        return path

    def strange(self):
        path = self.shared / "strange.bendy"
        if not path.exists():
            self.done("convert", strange_file(self.shared / "strange.gltf"), "-o", path)
        return path

    def good_files(self):
        examples = sorted((SOURCE / "spec" / "examples").glob("*.bendy"))
        self.assertGreater(len(examples), 2)
        return [self.convert(), self.convert("tentacle"), self.strange(), *examples]


class CommandLine(Case):
    def test_help_of_each_command_has_an_example(self):
        for command in COMMANDS:
            text = self.done(command, "--help").decode()
            self.assertIn(f"Example: bendy {command} ", text)
            self.assertEqual(text, self.done(command, "-h").decode())

    def test_help_lists_the_commands(self):
        text = self.done("--help").decode()
        for command in COMMANDS:
            self.assertIn(f"  {command} ", text)

    def test_version(self):
        self.assertRegex(self.done("--version").decode(), r"^bendy \d+\.\d+\.\d+\n$")

    def test_no_command_is_wrong(self):
        self.assertIn("--help", self.misused())

    def test_an_unknown_command_is_named(self):
        self.assertIn("dance", self.misused("dance"))
        self.assertIn("dance", self.misused("dance", "a.bendy"))

    def test_an_unknown_option_is_named(self):
        self.assertIn("--bogus", self.misused("--bogus"))
        for command in COMMANDS:
            files = [self.convert()] * (2 if command == "diff" else 1)
            self.assertIn("--bogus", self.misused(command, "--bogus", *files))

    def test_a_file_is_needed(self):
        for command in COMMANDS:
            self.misused(command)

    def test_one_file_too_many_is_named(self):
        for command in ("inspect", "pose", "rig", "bench"):
            self.assertIn("second.bendy", self.misused(command, self.convert(), "second.bendy"))

    def test_what_a_user_typed_cannot_forge_lines(self):
        self.assertNotIn("\nbendy: error: forged", self.misused("x\nbendy: error: forged"))

    def test_missing_and_empty_files_and_folders_fail_in_one_line(self):
        (self.folder / "empty").write_bytes(b"")
        (self.folder / "folder").mkdir()
        for command in ("convert", "inspect", "pose", "rig", "bench"):
            for name in ("missing", "empty", "folder", "empty/below", "missing/below"):
                if (command, name) == ("convert", "folder"):
                    continue  # it has nothing to convert
                line = self.failed(command, name, file=name)
                self.assertGreater(len(line), len(f"bendy: error: {name}: "))
        self.assertEqual(self.files(), ["empty", "folder"])

    def test_a_text_file_is_no_bendy_file(self):
        (self.folder / "text").write_text("hello, world, this is no bendy file at all\n")
        for command in ("inspect", "pose", "rig", "bench"):
            self.assertIn("not a bendy file", self.failed(command, "text", file="text"))

    @unittest.skipUnless(os.path.exists("/dev/full"), "there is no /dev/full")
    def test_a_full_standard_output_fails(self):
        for arguments in (("inspect", self.convert()), ("inspect", self.convert(), "--json"), ("pose", self.convert()),
                          ("inspect", self.convert(), "--hex"), ("rig", self.convert())):
            with open("/dev/full", "wb") as full:
                result = subprocess.run([BENDY, *arguments], stdout=full, stderr=subprocess.PIPE, timeout=120,
                                        check=False)
            self.assertEqual(result.returncode, 1)
            self.assertIn(b"bendy: error: ", result.stderr)

    def test_names_that_are_not_utf8_do_not_break_json(self):
        path = os.fsencode(self.folder) + b"/\xff\xfe.bendy"
        shutil.copy(self.convert("tentacle"), path)
        self.assertIn("\ufffd", json.loads(self.done("inspect", path, "--json"))["file"])
        self.assertIn("\ufffd", json.loads(self.done("validate", path, "--json"))[0]["file"])
        self.done("pose", path, "-o", "out.json")
        self.assertIn("\ufffd", json.loads((self.folder / "out.json").read_bytes())["file"])


class Convert(Case):
    def test_the_output_stands_beside_the_input_by_default(self):
        (self.folder / "in").mkdir()
        for name in ("one.glb", "two.v2.glb", "three"):
            shutil.copy(SOURCE / "examples" / "tentacle.glb", self.folder / "in" / name)
            self.done("convert", self.folder / "in" / name)
        self.assertEqual(sorted(entry.name for entry in (self.folder / "in").iterdir()),
                         ["one.bendy", "one.glb", "three", "three.bendy", "two.v2.bendy", "two.v2.glb"])
        self.assertEqual(self.files(), ["in"])
        self.assertEqual(self.done("validate", "in/one.bendy", "in/two.v2.bendy", "in/three.bendy"), b"")

    def test_writes_where_it_is_told_and_nothing_else(self):
        (self.folder / "deeper").mkdir()
        self.done("convert", SOURCE / "examples" / "tentacle.glb", "-o", "deeper/any.name")
        self.assertEqual([path.name for path in self.folder.rglob("*")], ["deeper", "any.name"])
        self.done("convert", SOURCE / "examples" / "tentacle.glb", "--output", "long.bendy")
        self.assertEqual((self.folder / "long.bendy").read_bytes(), (self.folder / "deeper" / "any.name").read_bytes())

    def test_convert_compact(self):
        source = SOURCE / "examples" / "mannequin.glb"
        exact = self.done("convert", source, "-o", "exact.bendy")
        text = self.done("convert", source, "-o", "small.bendy", "--compact").decode()
        self.assertRegex(text, r"total +[\d,]+ +[\d,]+\n")
        self.assertRegex(text, r"error +at most [\d.e-]+ mm; worst met [\d.e-]+ mm")
        self.assertNotIn(b"at most", exact)
        sizes = {name: (self.folder / f"{name}.bendy").stat().st_size for name in ("exact", "small")}
        self.assertLess(sizes["small"], sizes["exact"] / 2)
        self.done("validate", "small.bendy")
        self.assertIn(b"error at most", self.done("inspect", "small.bendy"))
        self.done("convert", source, "-o", "coarse.bendy", "--max-error", "1mm")
        self.assertLess((self.folder / "coarse.bendy").stat().st_size, sizes["small"])
        for bound, words in (("0.1", "no unit"), ("1in", "no unit of"), ("-1mm", "not above zero"), ("much", "no error bound")):
            self.assertIn(words, self.misused("convert", source, "--max-error", bound))

    def test_the_summary_says_what_is_in_the_file(self):
        text = self.done("convert", SOURCE / "examples" / "mannequin.glb", "-o", "m.bendy").decode()
        for words in ("m.bendy", "joints         65\n", "4,504 vertices", "Idle", "Walk", "Blink", "Smile",
                      "materials      5: ", "textures       1: ", f"{(self.folder / 'm.bendy').stat().st_size:,} bytes"):
            self.assertIn(words, text)
        self.assertEqual(self.done("convert", SOURCE / "examples" / "mannequin.glb", "-o", "m.bendy", "--quiet"), b"")
        self.assertEqual(self.done("convert", SOURCE / "examples" / "mannequin.glb", "-o", "m.bendy", "-q"), b"")

    def test_the_same_input_gives_the_same_bytes(self):
        for name in ("mannequin", "tentacle"):
            for output in ("one", "two"):
                self.done("convert", SOURCE / "examples" / f"{name}.glb", "-o", output)
            self.assertEqual((self.folder / "one").read_bytes(), (self.folder / "two").read_bytes())

    def test_replaces_an_older_file(self):
        (self.folder / "out.bendy").write_bytes(b"old")
        self.done("convert", SOURCE / "examples" / "tentacle.glb", "-o", "out.bendy")
        self.assertEqual(self.done("validate", "out.bendy"), b"")

    def test_a_bad_input_leaves_no_output_and_an_old_one_untouched(self):
        good = (SOURCE / "examples" / "tentacle.glb").read_bytes()
        (self.folder / "bad.glb").write_bytes(good[: len(good) // 2])
        self.failed("convert", "bad.glb", file="bad.glb")
        self.assertEqual(self.files(), ["bad.glb"])
        (self.folder / "bad.bendy").write_bytes(b"old")
        self.failed("convert", "bad.glb", "-o", "bad.bendy", file="bad.glb")
        self.assertEqual(self.files(), ["bad.bendy", "bad.glb"])
        self.assertEqual((self.folder / "bad.bendy").read_bytes(), b"old")

    def test_the_input_is_never_overwritten(self):
        source = self.folder / "a.glb"
        shutil.copy(SOURCE / "examples" / "tentacle.glb", source)
        before = source.read_bytes()
        (self.folder / "link.bendy").symlink_to(source)
        os.link(source, self.folder / "hard.bendy")
        for output in ("a.glb", "./a.glb", source, "link.bendy", "hard.bendy"):
            self.failed("convert", "a.glb", "-o", output, file=output)
        self.assertEqual(self.files(), ["a.glb", "hard.bendy", "link.bendy"])
        self.assertEqual(source.read_bytes(), before)
        shutil.move(source, self.folder / "same.bendy")  # here the default output is the input
        self.failed("convert", "same.bendy", file="same.bendy")
        self.assertEqual((self.folder / "same.bendy").read_bytes(), before)

    def test_an_output_that_cannot_be_written_is_named(self):
        (self.folder / "folder").mkdir()
        (self.folder / "file").write_bytes(b"")
        for output in ("missing/out.bendy", "file/out.bendy"):
            self.failed("convert", SOURCE / "examples" / "tentacle.glb", "-o", output, file=output)
        self.assertEqual(self.files(), ["file", "folder"])

    def test_a_full_disk_leaves_nothing_behind(self):
        (self.folder / "old.bendy").write_bytes(b"old")
        for output in ("old.bendy", "new.bendy"):
            self.failed("convert", SOURCE / "examples" / "tentacle.glb", "-o", output, file=output, **FULL_DISK)
        self.assertEqual(self.files(), ["old.bendy"])
        self.assertEqual((self.folder / "old.bendy").read_bytes(), b"old")

    def test_options_are_checked(self):
        self.assertIn("glue", self.misused("convert", "a.glb", "--images", "glue"))
        line = self.failed("convert", SOURCE / "examples" / "tentacle.glb", "--scene", "no such scene", "-o", "x")
        self.assertIn("no such scene", line)
        self.assertEqual(self.files(), [])
        self.done("convert", SOURCE / "examples" / "tentacle.glb", "--scene", "0", "-o", "x")

    def test_what_is_left_out_is_named_on_standard_error(self):
        (self.folder / "camera.gltf").write_text(json.dumps({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"camera": 0}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]}))
        result = self.bendy("convert", "camera.gltf")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stderr.decode(), r"(?i)^bendy: warning: camera\.gltf: .*camera")
        self.assertNotIn(b"warning", result.stdout)

    def test_what_is_proposed_is_listed_on_standard_error(self):
        nodes = [{"name": "Hips", "translation": [0, 1, 0], "children": [1, 4]}]
        for name, x in (("Left", 0.1), ("Right", -0.1)):
            at = len(nodes)
            nodes += [{"name": f"{name}UpLeg", "translation": [x, 0, 0], "children": [at + 1]},
                      {"name": f"{name}Leg", "translation": [0, -0.45, 0], "children": [at + 2]},
                      {"name": f"{name}Foot", "translation": [0, -0.45, 0]}]
        (self.folder / "legs.gltf").write_text(json.dumps(
            {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": nodes}))
        result = self.bendy("convert", "legs.gltf", "--auto-rig")
        self.assertEqual(result.returncode, 0)
        lines = result.stderr.decode().splitlines()
        self.assertIn("bendy: proposed: chain LeftLeg: LeftUpLeg > LeftLeg > LeftFoot, two_bone, "
                      "knee points forward", lines)
        self.assertIn("bendy: proposed: left knee, LeftLeg: hinge about (1.00, 0.00, 0.00), 0 to 135 degrees", lines)
        self.assertTrue(all(line.startswith("bendy: proposed: ") for line in lines), lines)
        self.assertNotIn(b"proposed", result.stdout)
        self.done("validate", "legs.bendy")
        self.assertEqual(self.bendy("convert", "legs.gltf").stderr, b"")

    def test_a_foot_beside_its_leg_comes_along(self):
        nodes = [{"name": "Root", "children": [1, 6, 7]}, {"name": "Hips", "translation": [0, 1, 0], "children": [2, 4]}]
        for name, x in (("Left", 0.1), ("Right", -0.1)):
            at = len(nodes)
            nodes += [{"name": f"{name}UpLeg", "translation": [x, 0, 0], "children": [at + 1]},
                      {"name": f"{name}Leg", "translation": [0, -0.45, 0.02]}]
        nodes += [{"name": f"{name}Foot", "translation": [x, 0.1, 0]} for name, x in (("Left", 0.1), ("Right", -0.1))]
        (self.folder / "robot.gltf").write_text(json.dumps(
            {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": nodes}))
        self.assertEqual(self.bendy("convert", "robot.gltf", "--auto-rig").returncode, 0)
        result = self.bendy("pose", "robot.bendy", "--reach", "LeftLeg=0.15,0.3,0.2", "-o", "robot.json")
        self.assertEqual(result.returncode, 0)
        joints = {joint["name"]: joint["world"][12:15]
                  for joint in json.loads((self.folder / "robot.json").read_text())["joints"]}
        for found, expected in ((joints["LeftFoot"], [0.15, 0.3, 0.2]), (joints["RightFoot"], [-0.1, 0.1, 0])):
            for number, wanted in zip(found, expected):
                self.assertAlmostEqual(number, wanted, delta=1e-3)

    def test_names_are_escaped_in_the_summary(self):
        text = self.done("convert", strange_file(self.folder / "strange.gltf")).decode()
        self.assertIn("slide\\x09now", text)
        self.assertFalse(any(ord(c) < 0x20 and c != "\n" for c in text))


class LinkedImages(Case):
    """--images link: URIs are relative to where they stand, and a dangling one is said."""

    def setUp(self):
        super().setUp()
        (self.folder / "lk").mkdir()
        file = GltfFile(scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}], images=[{"uri": "the%20axe.png"}],
                        textures=[{"source": 0}],
                        materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])
        positions = file.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "VEC3")
        file.document["meshes"] = [{"primitives": [{"attributes": {"POSITION": positions}, "material": 0}]}]
        file.write(self.folder / "lk" / "m.gltf")
        (self.folder / "lk" / "the axe.png").write_bytes(b"\x89PNG\r\n\x1a\n")

    def links(self, path):
        root = Chunk.read((self.folder / path).read_bytes())
        return [chunk.payload.decode() for _, chunk in root.walk() if chunk.letters == "LINK"]

    def test_is_relative_to_the_output(self):
        for output, uri in (("m.bendy", "lk/the%20axe.png"), ("lk/m.bendy", "the%20axe.png"),
                            ("out/m.bendy", "../lk/the%20axe.png")):
            (self.folder / output).parent.mkdir(exist_ok=True)
            result = self.bendy("convert", "lk/m.gltf", "-o", output, "--images", "link")
            self.assertEqual(result.returncode, 0)
            self.assertEqual(self.links(output), [uri])
            self.assertEqual(b"viewer does not follow it" in result.stderr, output == "out/m.bendy")
            self.assertEqual(self.bendy("validate", output).stderr, b"")

    def test_of_a_batch_is_relative_to_each_output(self):
        self.done("convert", "lk", "-o", "out", "--images", "link")
        self.assertEqual(self.links("out/m.bendy"), ["../lk/the%20axe.png"])

    def test_follows_the_file(self):
        self.done("convert", "lk/m.gltf", "-o", "m.bendy", "--images", "link")
        (self.folder / "out").mkdir()
        self.done("convert", "m.bendy", "-o", "out/again.bendy")
        self.assertEqual(self.links("out/again.bendy"), ["../lk/the%20axe.png"])
        self.done("export", "out/again.bendy", "-o", "lk/back.gltf")
        document = json.loads((self.folder / "lk" / "back.gltf").read_text())
        self.assertEqual(document["images"][0]["uri"], "the%20axe.png")
        self.done("export", "out/again.bendy", "-o", "back.x")
        self.assertIn('"lk/the axe.png"', (self.folder / "back.x").read_text())

    def test_that_dangles_is_a_warning(self):
        (self.folder / "lk" / "the axe.png").unlink()
        result = self.bendy("convert", "lk/m.gltf", "-o", "m.bendy", "--images", "link")
        self.assertIn(b"linked image does not exist: 'the%20axe.png'", result.stderr)
        result = self.bendy("validate", "m.bendy")
        self.assertEqual((result.returncode, result.stdout), (0, b""))
        self.assertEqual(result.stderr.decode(), "bendy: warning: m.bendy: HEAD/TEXT/LINK: linked image does not "
                                                 "exist: lk/the%20axe.png\n")
        (entry,) = json.loads(self.bendy("validate", "m.bendy", "--json").stdout)
        self.assertTrue(entry["valid"])
        self.assertEqual([warning["path"] for warning in entry["warnings"]], ["HEAD/TEXT/LINK"])
        (self.folder / "lk" / "the axe.png").write_bytes(b"")
        (entry,) = json.loads(self.bendy("validate", "m.bendy", "--json").stdout)
        self.assertEqual(entry["warnings"], [])

    def test_elsewhere_is_not_looked_at(self):
        text = (self.folder / "lk" / "m.gltf").read_text().replace("the%20axe.png", "https://example.org/a.png")
        (self.folder / "lk" / "m.gltf").write_text(text)
        self.assertEqual(self.bendy("convert", "lk/m.gltf", "-o", "m.bendy", "--images", "link").stderr, b"")
        self.assertEqual(self.links("m.bendy"), ["https://example.org/a.png"])
        self.assertEqual(self.bendy("validate", "m.bendy").stderr, b"")


class ConvertBatch(Case):
    """Several files and folders at once."""

    def setUp(self):
        super().setUp()
        self.write_model("in/a.gltf")
        self.write_model("in/deeper/b.GLTF")
        shutil.copy(SOURCE / "examples" / "tentacle.glb", self.folder / "in" / "deeper" / "c.glb")

    def write_model(self, place):
        """A triangle with its corners and a picture in files beside it."""
        path = self.folder / place
        path.parent.mkdir(parents=True, exist_ok=True)
        path.with_suffix(".bin").write_bytes(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
        path.with_suffix(".png").write_bytes(b"\x89PNG\r\n\x1a\n" + place.encode())
        path.write_text(json.dumps({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"name": place, "mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
            "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
            "textures": [{"source": 0}], "images": [{"uri": path.stem + ".png"}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": path.stem + ".bin"}]}))
        return path

    def batch(self, *arguments, status=0):
        """Runs it: which inputs were converted, the table's numbers, the lines of standard error."""
        result = self.bendy("convert", *arguments)
        self.assertEqual(result.returncode, status, (arguments, result.stderr))
        lines = result.stdout.decode().splitlines()
        converted = sorted(line.split(" -> ")[0] for line in lines if " -> " in line)
        table = dict(re.findall(r"^  (files|converted|up to date|failed|time) +([\d.]+)", "\n".join(lines), re.M))
        self.assertEqual(list(table), ["files", "converted", "up to date", "failed", "time"], lines)
        self.assertEqual(int(table["converted"]), len(converted))
        return converted, table, result.stderr.decode().splitlines()

    def outputs(self, folder="out"):
        return sorted(str(path.relative_to(self.folder / folder)) for path in (self.folder / folder).rglob("*.bendy"))

    def test_outputs_have_the_places_of_the_inputs_and_the_bytes_of_single_conversions(self):
        for jobs in ("1", "3"):
            for folder in ("in", "in/"):
                out = f"out{jobs}{len(folder)}"
                converted, table, _ = self.batch(folder, "-o", out, "--jobs", jobs)
                self.assertEqual(converted, ["in/a.gltf", "in/deeper/b.GLTF", "in/deeper/c.glb"])
                self.assertEqual((table["files"], table["up to date"], table["failed"]), ("3", "0", "0"))
                self.assertEqual(self.outputs(out), ["a.bendy", "deeper/b.bendy", "deeper/c.bendy"])
                for name in converted:
                    self.done("convert", name, "-o", "single.bendy")
                    place = Path(name).relative_to("in").with_suffix(".bendy")
                    self.assertEqual((self.folder / out / place).read_bytes(),
                                     (self.folder / "single.bendy").read_bytes())

    def test_compact_files_too_are_those_of_single_conversions(self):
        # meshoptimizer keeps settings in variables of its own
        options = ("--compact", "--max-error", "1mm")
        for number in range(3):
            shutil.copy(SOURCE / "examples" / "tentacle.glb", self.folder / "in" / f"{number}.glb")
        self.batch("in", "-o", "out", "-j", "3", *options)
        self.done("convert", SOURCE / "examples" / "tentacle.glb", "-o", "single.bendy", *options)
        for number in range(3):
            self.assertEqual((self.folder / "out" / f"{number}.bendy").read_bytes(),
                             (self.folder / "single.bendy").read_bytes())

    def test_files_go_by_their_names(self):
        self.batch("in/a.gltf", "in/deeper/c.glb", "in/deeper/../a.gltf", "-o", "out")
        self.assertEqual(self.outputs(), ["a.bendy", "c.bendy"])
        (self.folder / "one").mkdir()
        self.batch("in/a.gltf", "-o", "one")  # a single file into a folder that is there
        self.batch("in/a.gltf", "-o", "two/")  # or is said to be one
        self.assertEqual([self.outputs("one"), self.outputs("two")], [["a.bendy"], ["a.bendy"]])

    def test_only_what_has_changed_is_converted(self):
        everything = ["in/a.gltf", "in/deeper/b.GLTF", "in/deeper/c.glb"]
        self.assertEqual(self.batch("in", "-o", "out")[0], everything)
        converted, table, errors = self.batch("in", "-o", "out")
        self.assertEqual((converted, table["up to date"], errors), ([], "3", []))
        self.assertEqual(self.batch("./in", "-o", self.folder / "out")[0], [])  # the same, written otherwise
        self.assertEqual(self.batch("in", "-o", "out", "--force")[0], everything)
        self.assertEqual(self.batch("in", "-o", "out", "--lod")[0], everything)  # other options
        self.assertEqual(self.batch("in", "-o", "out")[0], everything)

        os.utime(self.folder / "in" / "a.bin", ns=(1, 1))  # older than the output, but another one
        self.assertEqual(self.batch("in", "-o", "out")[0], ["in/a.gltf"])
        (self.folder / "in" / "deeper" / "b.png").write_bytes(b"another")
        self.assertEqual(self.batch("in", "-o", "out")[0], ["in/deeper/b.GLTF"])
        (self.folder / "in" / "deeper" / "b.png").unlink()  # an image may be missing
        self.assertEqual(self.batch("in", "-o", "out")[0], ["in/deeper/b.GLTF"])
        self.assertEqual(self.batch("in", "-o", "out")[0], [])
        (self.folder / "in" / "deeper" / "b.png").write_bytes(b"here it is")
        self.assertEqual(self.batch("in", "-o", "out")[0], ["in/deeper/b.GLTF"])

        (self.folder / "out" / "a.bendy").write_bytes(b"spoilt")
        (self.folder / "out" / "deeper" / "c.bendy").unlink()
        self.assertEqual(self.batch("in", "-o", "out")[0], ["in/a.gltf", "in/deeper/c.glb"])
        self.done("validate", "out/a.bendy")
        self.write_model("else/a.gltf")  # another file for the same output
        self.assertEqual(self.batch("else", "-o", "out")[0], ["else/a.gltf"])

    def test_the_rig_file_counts_as_read(self):
        (self.folder / "rig.json").write_text('{"bendy_rig": 1}')
        options = ("in/a.gltf", "-o", "out/", "--rig", "rig.json")
        self.assertEqual(len(self.batch(*options)[0]), 1)
        self.assertEqual(len(self.batch(*options)[0]), 0)
        (self.folder / "rig.json").write_text('{"bendy_rig": 1, "chains": []}')
        self.assertEqual(len(self.batch(*options)[0]), 1)

    def test_a_record_that_cannot_be_read_is_made_anew(self):
        self.batch("in", "-o", "out")
        record = self.folder / "out" / ".bendy_batch.json"
        good = record.read_text()
        for text in ("", "{", "[]", good[: len(good) // 2], good.replace("sources", "source"), good.replace('"', "7")):
            record.write_text(text)
            self.assertEqual(len(self.batch("in", "-o", "out")[0]), 3, text)
            self.assertEqual(len(self.batch("in", "-o", "out")[0]), 0, text)

    def test_a_bad_file_stops_nothing_else(self):
        (self.folder / "in" / "bad.glb").write_bytes(b"glTF")
        converted, table, errors = self.batch("in", "missing.glb", "-o", "out", "-j", "2", status=1)
        self.assertEqual(len(converted), 3)
        self.assertEqual((table["files"], table["failed"]), ("5", "2"))
        self.assertEqual(self.outputs(), ["a.bendy", "deeper/b.bendy", "deeper/c.bendy"])
        told = sorted(line for line in errors if line.startswith("bendy: error: "))
        self.assertEqual(len(told), 2)
        self.assertIn("in/bad.glb: GLB header truncated", told[0])
        self.assertIn("missing.glb: there is no such file", told[1])
        converted, table, _ = self.batch("in", "missing.glb", "-o", "out", status=1)  # tried again, the others not
        self.assertEqual((converted, table["up to date"], table["failed"]), ([], "3", "2"))

    def test_outputs_that_clash_are_an_error_before_anything_is_done(self):
        shutil.copy(self.folder / "in" / "deeper" / "c.glb", self.folder / "in" / "a.glb")
        shutil.copy(self.folder / "in" / "deeper" / "c.glb", self.folder / "in" / "deeper" / "b.glb")
        result = self.bendy("convert", "in", "-o", "out")
        lines = result.stderr.decode().splitlines()
        self.assertEqual((result.returncode, result.stdout, len(lines)), (1, b"", 2), lines)
        for place in ("a", "deeper/b"):
            line = next(line for line in lines if f"out/{place}.bendy: both " in line)
            self.assertIn(f"in/{place}.gl", line)
        self.assertEqual(self.files(), ["in"])
        self.done("convert", "in/a.gltf", "-o", "a.bendy")
        before = (self.folder / "a.bendy").read_bytes()
        self.assertIn("input as well", self.failed("convert", "a.bendy", "-o", "./", file="./a.bendy"))
        self.assertEqual((self.folder / "a.bendy").read_bytes(), before)

    def test_wrong_command_lines(self):
        self.assertIn("--depfile", self.misused("convert", "in", "-o", "out", "--depfile", "d"))
        self.assertIn("--jobs", self.misused("convert", "in", "-o", "out", "--jobs", "0"))
        (self.folder / "file").write_bytes(b"")
        self.failed("convert", "in", "-o", "file", file="file")
        (self.folder / "empty").mkdir()
        result = self.bendy("convert", "empty", "-o", "out", "-q")
        self.assertEqual((result.returncode, result.stdout), (0, b""))
        self.assertIn(b"empty: has no file to convert (.gltf, .glb, .vrm", result.stderr)

    def test_an_output_that_cannot_be_written_is_one_failure(self):
        (self.folder / "out").mkdir()
        (self.folder / "out" / "deeper").write_bytes(b"a file where a folder should be")
        converted, table, errors = self.batch("in", "-o", "out", status=1)
        self.assertEqual((converted, table["failed"]), (["in/a.gltf"], "2"))
        self.assertTrue(all("out/deeper: " in line for line in errors if "error" in line), errors)

    def test_an_interrupt_leaves_whole_outputs_only(self):
        for number in range(40):
            shutil.copy(SOURCE / "examples" / "tentacle.glb", self.folder / "in" / f"{number}.glb")
        with subprocess.Popen([BENDY, "convert", "in", "-o", "out", "-j", "2", "--compact"], cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            process.stdout.readline()  # the first file is done
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=120)
        self.assertEqual(process.returncode, -signal.SIGINT)
        self.assertRegex(errors.decode().splitlines()[-1], r"^bendy: interrupted: \d+ of 43 files converted$")
        left = self.outputs()
        self.assertTrue(0 < len(left) < 43, left)
        self.assertEqual([path.name for path in (self.folder / "out").rglob(".bendy-*")], [])
        self.done("validate", *[f"out/{name}" for name in left])
        for path in (self.folder / "in").rglob("*.gl*"):  # what was done by then is known
            if str(path.relative_to(self.folder / "in").with_suffix(".bendy")) not in left:
                path.unlink()
        self.assertGreater(int(self.batch("in", "-o", "out", "--compact")[1]["up to date"]), 0)

    def test_a_terminal_shows_a_bar(self):
        ours, its = os.openpty()
        result = subprocess.run([BENDY, "convert", "in", "-o", "out"], cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=its, timeout=120, check=False)
        os.close(its)
        shown = b""
        with contextlib.suppress(OSError):  # Linux says so at the end
            while piece := os.read(ours, 4096):
                shown += piece
        os.close(ours)
        self.assertEqual(result.returncode, 0)
        self.assertRegex(shown.decode(), r"converting \[#{40}\] 3/3, [\d.]+ files/s")
        self.assertEqual(result.stdout.count(b" -> "), 3)
        self.assertIn(b"  converted ", result.stdout)

    def test_names_are_escaped(self):
        self.write_model("in/x\x1b[31m.gltf")
        for status in (0, 1):
            result = self.bendy("convert", "in", "-o", "out", "--force")
            self.assertEqual(result.returncode, status)
            self.assertNotIn(b"\x1b", result.stdout + result.stderr)
            (self.folder / "in" / "x\x1b[31m.bin").unlink(missing_ok=True)

    @unittest.skipUnless(sys.platform == "linux", "file names elsewhere are Unicode")
    def test_names_that_are_not_utf8(self):
        shutil.copy(self.folder / "in" / "a.gltf", os.fsencode(self.folder) + b"/in/\xff.gltf")
        for count in (4, 1):  # the record cannot hold it, so it is converted again
            result = self.bendy("convert", "in", "-o", "out")
            self.assertEqual((result.returncode, result.stdout.count(b" -> ")), (0, count))


class ConvertDepfile(Case):
    def write_odd_model(self):
        """A model in files whose names are hard to write in a rule."""
        self.name = "odd $name #1\\ .bin"
        (self.folder / self.name).write_bytes(bytes(36))
        (self.folder / "picture.png").write_bytes(b"\x89PNG\r\n\x1a\n")
        (self.folder / "rig.json").write_text('{"bendy_rig": 1}')
        (self.folder / "m.gltf").write_text(json.dumps({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "images": [{"uri": "picture.png"}, {"uri": "missing.png"}, {"uri": "data:image/png;base64,iVBORw=="}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": urllib.parse.quote(self.name)}]}))

    def test_it_lists_what_was_read(self):
        self.write_odd_model()
        self.done("convert", "m.gltf", "-o", "out.bendy", "--depfile", "d", "--rig", "rig.json")
        self.assertEqual((self.folder / "d").read_text(),
                         "out.bendy: \\\n  m.gltf \\\n  rig.json \\\n"
                         "  odd\\ $$name\\ \\#1\\\\\\ .bin \\\n  picture.png\n")
        self.done("convert", "m.gltf", "-o", "out.bendy", "--depfile", "d", "--images", "link")
        self.assertNotIn("picture", (self.folder / "d").read_text())
        self.done("convert", SOURCE / "examples" / "tentacle.glb", "-o", "a #b.bendy", "--depfile", "d")
        self.assertTrue((self.folder / "d").read_text().startswith("a\\ \\#b.bendy: \\\n  /"))

    def test_a_failure_writes_none(self):
        self.failed("convert", "missing.gltf", "-o", "out.bendy", "--depfile", "d", file="missing.gltf")
        self.assertEqual(self.files(), [])
        self.failed("convert", SOURCE / "examples" / "tentacle.glb", "-o", "x", "--depfile", "no/d", file="no/d")
        self.failed("convert", SOURCE / "examples" / "tentacle.glb", "-o", "x\ny", "--depfile", "d", file="d")

    def test_make_and_ninja_read_it(self):
        (self.folder / "Makefile").write_text(
            f"make.bendy: m.gltf\n\t{BENDY} convert m.gltf -o $@ --depfile make.d -q\n-include make.d\n")
        (self.folder / "build.ninja").write_text(
            f"rule convert\n  command = {BENDY} convert $in -o $out --depfile $out.d -q\n"
            "  depfile = $out.d\n  deps = gcc\nbuild ninja.bendy: convert m.gltf\n")
        self.write_odd_model()
        for tool in ("make", "ninja"):
            with self.subTest(tool):
                if not shutil.which(tool):
                    self.skipTest(f"there is no {tool}")
                output = self.folder / f"{tool}.bendy"

                def is_made_again():
                    before = output.stat().st_mtime_ns if output.exists() else None
                    subprocess.run([tool], cwd=self.folder, check=True, capture_output=True, timeout=120)
                    return output.stat().st_mtime_ns != before

                self.assertEqual([is_made_again(), is_made_again()], [True, False])
                for name in (self.name, "picture.png"):
                    later = output.stat().st_mtime_ns + 10_000_000
                    os.utime(self.folder / name, ns=(later, later))
                    time.sleep(0.02)
                    self.assertEqual([is_made_again(), is_made_again()], [True, False], name)


class ConvertAutoSkin(Case):
    def write_model(self):
        """Two bones, one on the other, and a mesh beside them: two corners by the lower one, four by the upper one."""
        file = GltfFile(scenes=[{"nodes": [0, 2]}],
                        nodes=[{"name": "Low", "children": [1]}, {"name": "High", "translation": [0, 1, 0]},
                               {"name": "Body", "mesh": 0}])
        corners = file.add([(0.1, 0, 0), (0.1, 0.9, 0), (0.1, 1.1, 0), (0.1, 1.5, 0), (0.2, 2, 0), (0, 9, 0)], "VEC3")
        file.document["meshes"] = [{"name": "body", "primitives": [{"attributes": {"POSITION": corners}}]}]
        return file.write(self.folder / "m.gltf")

    def test_vertices_are_bound_and_counted(self):
        result = self.bendy("convert", self.write_model(), "--auto-skin")
        self.assertEqual(result.returncode, 0)
        self.assertEqual(result.stderr.decode(),
                         "bendy: proposed: skin of mesh 'body': 6 vertices bound to 2 joints\n")
        self.assertIn(b"up to 1 influence a vertex", result.stdout)
        self.done("validate", "m.bendy")
        result = self.bendy("convert", "m.gltf", "--skeleton", "High")
        self.assertIn(b"6 vertices bound to 1 joint\n", result.stderr)
        self.assertIn('"Higher"; did you mean "High"?', self.failed("convert", "m.gltf", "--skeleton", "Higher", file="m.gltf"))

    def test_nothing_to_bind_is_a_warning(self):
        result = self.bendy("convert", SOURCE / "examples" / "tentacle.glb", "-o", "t.bendy", "--auto-skin")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"no vertices bound: every mesh has a skin", result.stderr)
        self.assertEqual((self.folder / "t.bendy").read_bytes(), self.convert("tentacle").read_bytes())


class Inspect(Case):
    def tree_of(self, lines):
        """The lines of the chunk tree, which stand below the summary and a heading."""
        return lines[lines.index("      offset         size  chunk") + 1 :]

    def test_the_text_shows_every_chunk_with_its_place(self):
        for path in self.good_files():
            lines = self.done("inspect", path, "--all").decode().splitlines()
            chunks = list(Chunk.read(path.read_bytes()).walk())
            self.assertIn(f"{path.stat().st_size:,} bytes", lines[0])
            lines = self.tree_of(lines)
            self.assertEqual(len(lines), len(chunks))
            for line, (_, chunk) in zip(lines, chunks):
                offset, size, letters = line.split()[:3]
                self.assertEqual((int(offset), int(size), letters), (chunk.offset, chunk.size(), chunk.letters))

    def test_the_short_text_folds_details_away(self):
        folded = self.tree_of(self.done("inspect", self.convert()).decode().splitlines())
        everything = self.tree_of(self.done("inspect", self.convert(), "--all").decode().splitlines())
        self.assertLess(len(folded), len(everything) / 2)
        places = [line.split()[0] for line in everything]
        self.assertTrue(all(line.split()[0] in places for line in folded))
        self.assertIn("mixamorig:LeftHand", "\n".join(folded))
        self.assertIn("Walk", "\n".join(folded))

    def test_json_has_every_chunk_with_its_place(self):
        for path in self.good_files():
            data = path.read_bytes()
            document = json.loads(self.done("inspect", path, "--json"))
            self.assertEqual(document["bytes"], len(data))
            self.assertTrue(document["file"].endswith(path.name))
            chunks = list(Chunk.read(data).walk())
            self.assertEqual(len(document["chunks"]), len(chunks))
            paths = []
            for number, (entry, (chunk_path, chunk)) in enumerate(zip(document["chunks"], chunks)):
                self.assertEqual(entry["number"], number)
                self.assertEqual((entry["id"], entry["offset"], entry["size"]),
                                 (chunk.letters, chunk.offset, chunk.size()))
                self.assertEqual(entry["container"], chunk.children is not None)
                self.assertEqual(int(entry["sum"], 16), struct.unpack_from("<I", data, chunk.offset + 4)[0])
                self.assertIsInstance(entry["meaning"], str)
                paths.append(chunk_path)
                if number == 0:
                    self.assertIsNone(entry["parent"])
                else:
                    self.assertEqual(paths[entry["parent"]], chunk_path.rpartition("/")[0])

    def test_json_has_the_fields_of_records(self):
        data = self.convert().read_bytes()
        root = Chunk.read(data)
        chunks = json.loads(self.done("inspect", self.convert(), "--json"))["chunks"]
        entries = {entry["offset"]: entry for entry in chunks}
        fields = lambda path: entries[root.find(path).offset]["fields"]  # noqa: E731
        version = fields("HEAD/VERS")
        self.assertEqual((version["objects"], version["joints"], version["cycles"]), (1, 65, 2))
        self.assertTrue(version["generator"].startswith("bendy "))
        self.assertEqual(fields("HEAD/OBJE/SKIN/NAME"), {"text": root.find("HEAD/OBJE/SKIN/NAME").payload.decode()})
        for path, chunk in root.walk():
            if chunk.letters == "REST":
                self.assertEqual([as_float(c) for c in fields(path)["translation"]], floats(chunk.payload[16:28]))
            if chunk.letters == "TRAK":
                tracks = fields(path)["tracks"]
                self.assertEqual([(t["target"], t["keys"], t["first_value"]) for t in tracks],
                                 [(t[0], t[4], t[6]) for t in struct.iter_unpack("<IBBHIIQ", chunk.payload)])

    def test_hex_is_the_chunks_bytes(self):
        path = self.convert("tentacle")
        data = path.read_bytes()
        root = Chunk.read(data)
        for where in ("HEAD", "HEAD/VERS", "HEAD/OBJE/SKIN/NAME", "HEAD/OBJE/SKIN/SKIN/PIVO/REST", "HEAD/MATE[1]"):
            chunk = root.find(where)
            shown = b""
            for line in self.done("inspect", path, "--chunk", where, "--hex").decode().splitlines():
                offset, _, rest = line.strip().partition("  ")
                self.assertEqual(int(offset, 16), chunk.offset + len(shown))
                shown += bytes.fromhex(rest[:35])
            self.assertEqual(shown, data[chunk.offset : chunk.offset + 16 + chunk.size()])

    def test_one_chunk_by_path_and_by_offset(self):
        path = self.convert()
        root = Chunk.read(path.read_bytes())
        for where in ("HEAD/OBJE/CYCL[1]", "HEAD/OBJE/SKIN", "HEAD/OBJE/VECT[1]/TARG[1]/NAME", "HEAD"):
            chunk = root.find(where)
            for name in (where, f"@{chunk.offset}", f"@{chunk.offset + 15}"):
                entries = json.loads(self.done("inspect", path, "--chunk", name, "--json"))["chunks"]
                self.assertEqual([entry["offset"] for entry in entries], [inner.offset for _, inner in chunk.walk()])
                self.assertIsNone(entries[0]["parent"])
        lines = self.done("inspect", path, "--chunk", "HEAD/OBJE/CYCL[1]").decode()
        self.assertIn("Walk", lines)
        self.assertNotIn("Idle", lines)

    def test_a_path_to_nothing_fails(self):
        for where in ("HEAD/NONE", "HEAD/OBJE[1]", "OBJE", "HEAD/", "/HEAD", "HEAD/VERS/NAME", "HEAD/OBJE/SKIN[x]",
                      "HEAD/OBJE/SKIN[-1]", "HEAD/OBJE/SKIN[4294967296]", "@99999999", "@", "@-1", "@1x", "\x1b[31m"):
            for more in ([], ["--json"], ["--hex"], ["--all"]):
                line = self.failed("inspect", self.convert(), "--chunk", where, *more, file=self.convert())
                self.assertNotIn("\x1b", line)

    def test_json_and_hex_exclude_each_other(self):
        self.misused("inspect", self.convert(), "--json", "--hex")

    def test_names_are_escaped(self):
        for more in ([], ["--all"], ["--chunk", "HEAD/OBJE/SKIN"], ["--hex"]):
            text = self.done("inspect", self.strange(), *more).decode()
            self.assertFalse(any((ord(c) < 0x20 and c != "\n") or ord(c) == 0x7F for c in text))
            self.assertNotIn("\nbendy: error: forged", text)
        text = self.done("inspect", self.strange()).decode()
        self.assertIn("\\x1b[31m", text)
        self.assertIn("\u624b \u00e9", text)
        chunks = json.loads(self.done("inspect", self.strange(), "--json"))["chunks"]
        names = [entry["fields"]["text"] for entry in chunks if entry["id"] == "NAME"]
        self.assertIn("root\x1b[31m\nbendy: error: forged", names)

    def test_a_damaged_file_is_shown_with_a_warning(self):
        data = bytearray(self.convert("tentacle").read_bytes())
        data[Chunk.read(bytes(data)).find("HEAD/OBJE/SKIN/NAME").offset + 16] ^= 1
        (self.folder / "bad.bendy").write_bytes(data)
        result = self.bendy("inspect", "bad.bendy")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"SKIN", result.stdout)
        self.assertRegex(result.stderr.decode(), r"^bendy: warning: bad\.bendy: .*HEAD/OBJE/SKIN/NAME")

    def test_a_file_without_structure_fails_with_its_place(self):
        data = self.convert("tentacle").read_bytes()
        (self.folder / "cut.bendy").write_bytes(data[:1000])
        for more in ([], ["--json"], ["--hex"], ["--chunk", "HEAD/VERS"]):
            self.assertRegex(self.failed("inspect", "cut.bendy", *more, file="cut.bendy"), r"\(HEAD, offset 0\)$")


INFINITY = float("inf")
FREE = (-INFINITY, INFINITY)
NONE = 0xFFFFFFFF


def limit(model, *ranges, order=0, scope=0, flags=0, soft_zone=0.0, translation=(FREE, FREE, FREE),
          stiffness=(0, 0, 0), preferred=(0, 0, 0)):
    """A LIMT; the ranges of X, Y, Z are (minimum, maximum) in degrees."""
    ranges = [*ranges, FREE, FREE, FREE][:3]
    return Chunk("LIMT", struct.pack(
        "<4B23f", model, order, scope, flags, soft_zone, 0, 0, 0, 1,
        *(math.radians(low) for low, _ in ranges), *(math.radians(high) for _, high in ranges),
        *(low for low, _ in translation), *(high for _, high in translation), *stiffness, *preferred))


def chain(start, effector, name=None, target=NONE, pole=NONE, solver=0, flags=0, iterations=0, priority=0,
          tolerance=0.0, pole_vector=(0, 0, 0), pole_angle=0.0, tip=(0, 0, 0), tip_rotation=(0, 0, 0, 1),
          position=1.0, rotation=0.0, influence=1.0, stretch=0.0, compress=0.0):
    info = struct.pack("<4I2BHB3x17f", start, effector, target, pole, solver, flags, iterations, priority, tolerance,
                       *pole_vector, pole_angle, *tip, *tip_rotation, position, rotation, influence, stretch, compress)
    names = [] if name is None else [Chunk("NAME", name.encode())]
    return Chunk("IKCH", children=[*names, Chunk("KINF", info)])


def pull(number, weight):
    return Chunk("PULL", struct.pack("<If", number, weight))

    def test_joints_of_compact_files_have_their_names(self):
        self.done("convert", SOURCE / "examples/mannequin.glb", "--compact", "-q", "-o", "compact.bendy")
        joints = [re.search(r'SKIN .*?(?=, limits|, extras|$)', line).group()
                  for line in self.done("inspect", "compact.bendy").decode().splitlines() if " SKIN " in line]
        exact = [re.search(r'SKIN .*?(?=, limits|, extras|$)', line).group()
                 for line in self.done("inspect", self.convert()).decode().splitlines() if " SKIN " in line]
        self.assertEqual(joints, exact)
        self.assertTrue(any('SKIN 3  "mixamorig:Hips"  at ' in line for line in joints))


class InspectRig(Case):
    """Constraints and IK chains, as inspect shows them."""

    def joints(self, root):
        """The joints of a file with one object, in their order, and the number of each name."""
        joints = [joint for _, joint in root.walk() if joint.letters == "SKIN"]
        names = [next((c.payload.decode() for c in joint.children if c.letters == "NAME"), "") for joint in joints]
        return joints, names.index

    def pivot(self, joint):
        return next(chunk for chunk in joint.children if chunk.letters == "PIVO")

    def line(self, root, where, good=True):
        """What inspect says of one chunk."""
        path = self.folder / "rig.bendy"
        path.write_bytes(root.write())
        result = self.bendy("validate", path)
        self.assertEqual(result.returncode, 0 if good else 1, result.stdout)
        line = self.done("inspect", path, "--chunk", where, "--all").decode().splitlines()[1]
        return re.fullmatch(r" *\d+ +\d+  \w{4}(?: \d+)?(?:  (.*))?", line)[1]

    def limit_line(self, chunk, good=True):
        root = Chunk.read((SOURCE / "spec" / "examples" / "one_joint.bendy").read_bytes())
        root.find("HEAD/OBJE/SKIN/PIVO").children.append(chunk)
        return self.line(root, "HEAD/OBJE/SKIN/PIVO/LIMT", good)

    def test_limits_are_in_degrees(self):
        for chunk, text in (
                (limit(0), "free"),
                (limit(1), "locked"),
                (limit(2, (0, 150)), "hinge 0 to 150 deg"),
                (limit(2), "hinge free"),
                (limit(2, (-INFINITY, 150)), "hinge up to 150 deg"),
                (limit(2, (-12.5, INFINITY)), "hinge from -12.5 deg"),
                (limit(3, (-35, 35), (-20, 20), (-25, 25), scope=1, flags=2),
                 "swing-twist ellipse, twist -35 to 35 deg, swing -20 to 20 and -25 to 25 deg, IK only, proposed"),
                (limit(4, FREE, FREE, (-25, 25)), "swing-twist pyramid, twist free, swing free and -25 to 25 deg"),
                (limit(4), "swing-twist pyramid, twist free, swing free and free"),
                (limit(5, (-1, 2), (-3, 4), (-5, 6), order=5), "Euler box ZYX -1 to 2, -3 to 4 and -5 to 6 deg"),
                (limit(6, (0, 30)), "largest angle 30 deg"),
                (limit(6), "largest angle free"),
                (limit(1, translation=((0, 0),) * 3), "locked, no translation"),
                (limit(0, translation=((0, 0), FREE, (-0.5, 0.25))),
                 "free, translation 0 to 0, free and -0.5 to 0.25 m"),
                (limit(0, scope=2, flags=1), "free, all but IK, approximated"),
                (limit(2, (10, 20), flags=5), "hinge 10 to 20 deg, approximated, rest outside"),
                (limit(0, stiffness=(0, 0.5, 1), soft_zone=math.radians(5), preferred=(math.radians(30), 0, 0)),
                 "free, stiffness 0 0.5 1, soft zone 5 deg, preferred 30 0 0 deg")):
            self.assertEqual(self.limit_line(chunk), text)

    def test_limits_without_sense_are_shown(self):
        self.assertEqual(self.limit_line(limit(99), good=False), "?")
        self.assertEqual(self.limit_line(limit(5, order=99), good=False), "Euler box ? free, free and free")
        self.assertEqual(self.limit_line(limit(2, (float("nan"), 1)), good=False), "hinge nan to 1 deg")
        self.assertEqual(self.limit_line(Chunk("LIMT", b"\x02"), good=False), "hinge free")

    def test_a_joint_says_what_limits_it(self):
        root = Chunk.read((SOURCE / "spec" / "examples" / "one_joint.bendy").read_bytes())
        where = "HEAD/OBJE/SKIN"
        self.assertEqual(self.line(root, where), '"pole"  at 0 1 0, 1 triangles')
        root.find(where + "/PIVO").children.append(limit(2, (0, 150)))
        root.find(where + "/PIVO").children.append(limit(1, scope=1))
        root.find(where).children.append(Chunk("EXTN", b"{}"))
        self.assertEqual(self.line(root, where), '"pole"  at 0 1 0, 1 triangles, '
                                                 'limits: hinge 0 to 150 deg | locked, IK only, extensions')

    def test_a_joint_without_a_place_starts_with_what_it_has(self):
        root = Chunk.read((SOURCE / "spec" / "examples" / "one_joint.bendy").read_bytes())
        joint = root.find("HEAD/OBJE/SKIN")
        joint.children.remove(self.pivot(joint))
        self.assertEqual(self.line(root, "HEAD/OBJE/SKIN", good=False), '"pole"  1 triangles')

    def test_chains_name_their_joints(self):
        root = Chunk.read(self.convert().read_bytes())
        joints, number = self.joints(root)
        arm = [number(f"mixamorig:Left{part}") for part in ("Arm", "ForeArm", "Hand")]
        hips, head = number("mixamorig:Hips"), number("mixamorig:Head")
        at = root.find("HEAD/OBJE").children
        at[:] = [chunk for chunk in at if chunk.letters != "IKCH"]
        for joint in joints:
            self.pivot(joint).children[:] = [c for c in self.pivot(joint).children if c.letters != "PULL"]
        at += [chain(arm[0], arm[2], "IK_LeftArm", solver=2),
               chain(arm[0], arm[2], solver=4, target=head, pole=hips, position=0.75, rotation=0.5, influence=0.25,
                     flags=3),
               chain(hips, arm[2], solver=3),
               chain(arm[1], arm[1], "wrist\x1b", solver=5)]
        self.pivot(joints[arm[0]]).children.append(pull(0, 0.5))
        self.pivot(joints[arm[1]]).children += [pull(1, 0.125), pull(3, 0.25)]
        path = "mixamorig:LeftArm{} > mixamorig:LeftForeArm{} > mixamorig:LeftHand, "
        self.assertEqual(self.line(root, "HEAD/OBJE/IKCH"), '"IK_LeftArm"  ' + path.format(" (0.5)", "") + "two-bone")
        self.assertEqual(self.line(root, "HEAD/OBJE/IKCH[1]"),
                         path.format("", " (0.125)") + "FABRIK, target mixamorig:Head, pole mixamorig:Hips, "
                         "position 0.75, rotation 0.5, influence 0.25, approximated, proposed")
        self.assertRegex(self.line(root, "HEAD/OBJE/IKCH[2]"),
                         r"^mixamorig:Hips > \.\.\. \d more \.\.\. > mixamorig:LeftForeArm > mixamorig:LeftHand, CCD$")
        self.assertEqual(self.line(root, "HEAD/OBJE/IKCH[3]"), '"wrist\\x1b"  mixamorig:LeftForeArm (0.25), aim')
        pivot = next(where for where, chunk in root.walk() if chunk is self.pivot(joints[arm[0]]))
        self.assertEqual(self.line(root, pivot + "/PULL"), "0.5 in IK_LeftArm")
        pivot = next(where for where, chunk in root.walk() if chunk is self.pivot(joints[arm[1]]))
        self.assertEqual(self.line(root, pivot + "/PULL"), "0.125 in chain 1")
        self.assertEqual(self.line(root, pivot + "/PULL[1]"), "0.25 in wrist\\x1b")

    def test_a_chain_says_how_it_is_solved(self):
        root = Chunk.read(self.convert("tentacle").read_bytes())
        at = root.find("HEAD/OBJE").children
        at[:] = [chunk for chunk in at if chunk.letters != "IKCH"] + [
            chain(0, 0, iterations=1000, priority=7, tolerance=0.25, pole_vector=(0, 0, 1), pole_angle=math.pi / 2,
                  tip=(0, 0.5, 0), tip_rotation=(0, 1, 0, 0), stretch=0.5, compress=0.125)]
        for joint in self.joints(root)[0]:
            self.pivot(joint).children[:] = [c for c in self.pivot(joint).children if c.letters != "PULL"]
        short = self.line(root, "HEAD/OBJE/IKCH")
        self.assertTrue(short.endswith(", any solver"), short)
        self.assertEqual(self.line(root, "HEAD/OBJE/IKCH/KINF"),
                         short + ", at most 1,000 iterations, priority 7, tolerance 0.25 m, pole vector 0 0 1, "
                         "pole angle 90 deg, tip 0 0.5 0 m, tip rotation 0 1 0 0, stretch 0.5, compress 0.125")

    def test_chains_without_sense_are_shown(self):
        root = Chunk.read((SOURCE / "spec" / "examples" / "every_chunk.bendy").read_bytes())
        at = root.find("HEAD/OBJE").children
        at += [chain(1, 0), chain(NONE, 99, solver=200, target=5), Chunk("IKCH", children=[]),
               Chunk("IKCH", children=[Chunk("KINF", b"")])]
        self.pivot(root.find("HEAD/OBJE/SKIN")).children += [pull(5, 0.5), Chunk("PULL", b"")]
        line = lambda where: self.line(root, where, good=False)  # noqa: E731
        self.assertEqual(line("HEAD/OBJE/IKCH[1]"), "tip is not above root, any solver")
        self.assertEqual(line("HEAD/OBJE/IKCH[2]"),
                         "no joint 4294967295 is not above no joint 99, ?, target no joint 5")
        self.assertEqual(line("HEAD/OBJE/IKCH[3]"), None)
        self.assertEqual(line("HEAD/OBJE/IKCH[4]"), "root, any solver")
        self.assertEqual(line("HEAD/OBJE/SKIN/PIVO/PULL[1]"), "0.5 in no chain 5")

    def test_a_rope_with_many_chains_takes_no_time(self):
        joint = Chunk("SKIN", children=[Chunk("PIVO", children=[Chunk("REST", struct.pack("<10f", *[0.0] * 10))])])
        data = joint.write()
        for _ in range(3000):  # Chunk.write recurses, so the rope is made by hand
            body = joint.children[0].write() + data
            head = b"SKIN" + bytes(4) + struct.pack("<Q", len(body) | 1 << 48)
            data = head + body
        body = data + chain(0, 3000).write() * 3000
        body = b"OBJE" + bytes(4) + struct.pack("<Q", len(body) | 1 << 48) + body
        (self.folder / "rope.bendy").write_bytes(b"HEAD" + bytes(4) + struct.pack("<Q", len(body) | 1 << 48) + body)
        text = self.done("inspect", "rope.bendy").decode()
        self.assertEqual(text.count("joint 0 > ... 2,998 more ... > joint 2999 > joint 3000"), 3000)

    def test_json_has_no_infinities(self):
        root = Chunk.read((SOURCE / "spec" / "examples" / "every_chunk.bendy").read_bytes())
        (self.folder / "rig.bendy").write_bytes(root.write())
        text = self.done("inspect", "rig.bendy", "--json")
        chunks = json.loads(text, parse_constant=self.fail)["chunks"]
        (fields,) = [entry["fields"] for entry in chunks if entry["id"] == "LIMT"]
        payload = root.find("HEAD/OBJE/SKIN/SKIN/PIVO/LIMT").payload
        self.assertEqual((fields["model"], fields["frame"]), (3, [0.5] * 4))
        self.assertEqual([as_float(angle) for angle in fields["rotation_min"]], floats(payload[24:36]))
        self.assertEqual([fields["translation_min"], fields["translation_max"]], [[None] * 3] * 2)
        (fields,) = [entry["fields"] for entry in chunks if entry["id"] == "KINF"]
        self.assertEqual([fields[key] for key in ("start", "effector", "target", "solver")], [0, 1, NONE, 3])
        self.assertEqual(fields["tip_offset"], [0, 1, 0])
        (fields,) = [entry["fields"] for entry in chunks if entry["id"] == "PULL"]
        self.assertEqual(fields, {"chain": 0, "weight": 0.5})


class Validate(Case):
    def test_a_path_is_whole_in_json(self):
        joint = Chunk("SKIN", children=[])  # without its PIVO
        for _ in range(20):
            joint = Chunk("SKIN", children=[joint])
        (self.folder / "deep.bendy").write_bytes(Chunk("HEAD", children=[Chunk("OBJE", children=[joint])]).write())
        (entry,) = json.loads(self.bendy("validate", "deep.bendy", "--json").stdout)
        self.assertIn("HEAD/OBJE" + 21 * "/SKIN", [fault["path"] for fault in entry["faults"]])
        self.assertIn(b"(HEAD/OBJE/SKIN/SKIN/SKIN/SKIN/... 11 more .../SKIN/",
                      self.bendy("validate", "deep.bendy").stdout)

    def test_good_files_are_silent(self):
        files = self.good_files()
        self.assertEqual(self.done("validate", *files), b"")
        report = json.loads(self.done("validate", "--json", *files))
        self.assertEqual([entry["file"] for entry in report], [str(file) for file in files])
        for entry in report:
            self.assertIs(entry["valid"], True)
            self.assertEqual(entry["faults"], [])

    def faults(self, data, name="bad.bendy"):
        """What is said of a broken file, from JSON; the text must say the same."""
        (self.folder / name).write_bytes(data)
        text = self.bendy("validate", name)
        self.assertEqual(text.returncode, 1)
        self.assertEqual(text.stderr, b"")
        result = self.bendy("validate", name, "--json")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr, b"")
        (entry,) = json.loads(result.stdout)
        self.assertEqual(entry["file"], name)
        self.assertIs(entry["valid"], False)
        lines = text.stdout.decode().splitlines()
        self.assertEqual(len(lines), len(entry["faults"]))
        for line, fault in zip(lines, entry["faults"]):
            self.assertTrue(line.startswith(f"{name}: {fault['code']}: {fault['message']} ("), line)
            self.assertTrue(line.endswith(f"offset {fault['offset']})"), line)
            self.assertIn(fault["path"], in_full(line, fault["path"]))  # JSON has it whole
            self.assertIn(fault["class"], ("malformed", "invalid", "unsupported", "io"))
        return entry["faults"]

    def test_every_cut_is_found(self):
        data = self.convert("tentacle").read_bytes()
        for size in (1, 15, 16, 17, 79, 1000, len(data) // 2, len(data) - 16, len(data) - 1):
            (fault,) = self.faults(data[:size])
            self.assertEqual(fault["class"], "malformed")
            self.assertEqual(fault["offset"], 0)
            if size >= 16:
                self.assertEqual((fault["code"], fault["path"]), ("TRUNCATED", "HEAD"))
        (fault,) = self.faults(data + bytes(16))
        self.assertEqual(fault["code"], "TRAILING_BYTES")

    def test_a_flipped_bit_is_found_where_it_is(self):
        data = self.convert("tentacle").read_bytes()
        leaves = [(path, chunk) for path, chunk in Chunk.read(data).walk() if chunk.children is None and chunk.payload]
        for path, chunk in leaves[:: max(1, len(leaves) // 25)]:
            broken = bytearray(data)
            broken[chunk.offset + 16 + len(chunk.payload) // 2] ^= 0x10
            faults = self.faults(bytes(broken))
            sums = [fault for fault in faults if fault["code"] == "SUM_MISMATCH"]
            places = [(fault["path"], fault["offset"]) for fault in sums]
            self.assertEqual(places, [(path, chunk.offset)])

    def test_a_wrong_value_with_right_sums_is_found_where_it_is(self):
        root = Chunk.read(self.convert("tentacle").read_bytes())
        self.assertEqual(root.write(), self.convert("tentacle").read_bytes())
        where = "HEAD/OBJE/SKIN/SKIN/PIVO/REST"
        rest = root.find(where)
        rest.payload = struct.pack("<4f", 0, 0, 0, 2) + rest.payload[16:]
        (fault,) = self.faults(root.write())
        self.assertEqual((fault["code"], fault["class"]), ("ROTATION_NOT_UNIT", "invalid"))
        self.assertEqual((fault["path"], fault["offset"]), (where, rest.offset))

    def test_all_faults_are_listed(self):
        root = Chunk.read(self.convert("tentacle").read_bytes())
        rests = [(path, chunk) for path, chunk in root.walk() if chunk.letters == "REST"]
        for _, chunk in rests:
            chunk.payload = chunk.payload[:16] + struct.pack("<f", float("nan")) + chunk.payload[20:]
        faults = self.faults(root.write())
        self.assertEqual([fault["code"] for fault in faults], ["NOT_FINITE"] * len(rests))
        for fault, (path, _) in zip(faults, rests):
            self.assertEqual(in_full(fault["path"], path), path)
        self.assertEqual([fault["offset"] for fault in faults], [chunk.offset for _, chunk in rests])

    def test_several_files_are_told_apart(self):
        (self.folder / "bad.bendy").write_bytes(b"nonsense")
        shutil.copy(self.convert("tentacle"), self.folder / "good.bendy")
        result = self.bendy("validate", "good.bendy", "bad.bendy", "good.bendy")
        self.assertEqual(result.returncode, 1)
        self.assertIn(b"bad.bendy: NOT_A_BENDY_FILE: ", result.stdout)
        self.assertNotIn(b"good.bendy", result.stdout)
        report = json.loads(self.bendy("validate", "good.bendy", "bad.bendy", "--json").stdout)
        self.assertEqual([(entry["file"], entry["valid"]) for entry in report],
                         [("good.bendy", True), ("bad.bendy", False)])

    def test_files_that_cannot_be_read_are_errors(self):
        (self.folder / "folder").mkdir()
        (self.folder / "bad.bendy").write_bytes(b"")
        shutil.copy(self.convert("tentacle"), self.folder / "good.bendy")
        for name in ("missing.bendy", "folder"):
            self.failed("validate", name, file=name)
            result = self.bendy("validate", "good.bendy", name, "bad.bendy")  # goes on with the rest
            self.assertEqual(result.returncode, 1)
            self.assertIn(name.encode(), result.stderr)
            self.assertIn(b"bad.bendy", result.stdout)
            (entry,) = json.loads(self.bendy("validate", name, "--json").stdout)
            self.assertIs(entry["valid"], False)
            self.assertEqual(entry["faults"][0]["class"], "io")

    def test_names_are_escaped(self):
        root = Chunk.read(self.convert("tentacle").read_bytes())
        name = "a\x1b[2Jb\n.bendy"
        (self.folder / name).write_bytes(root.write()[:-16])
        text = self.bendy("validate", name).stdout.decode()
        self.assertNotIn("\x1b", text)
        self.assertEqual(text.count("\n"), 1)


class PoseCommand(Case):
    def pose(self, path, *arguments):
        """The same pose in all three formats; JSON comes back, the others must agree with it."""
        for name in ("out.obj", "out.ply", "out.json"):
            self.assertEqual(self.done("pose", path, *arguments, "-o", name), b"")
        document = json.loads((self.folder / "out.json").read_text(encoding="utf-8"))
        obj = read_obj((self.folder / "out.obj").read_text(encoding="utf-8"))
        ply = read_ply((self.folder / "out.ply").read_bytes())
        positions, faces, normals = [], [], []
        for mesh in document["meshes"]:
            base = len(positions)
            numbers = [as_float(number) for number in mesh["positions"]]
            positions += list(zip(*[iter(numbers)] * 3))
            faces += [tuple(base + index for index in face) for face in zip(*[iter(mesh["indices"])] * 3)]
            here = [as_float(number) for number in mesh["normals"]]
            normals += list(zip(*[iter(here)] * 3)) if here else [(0.0, 0.0, 0.0)] * (len(positions) - base)
        has_normals = any(mesh["normals"] for mesh in document["meshes"])
        self.assertEqual(obj["v"], positions)
        self.assertEqual(obj["f"], faces)
        self.assertEqual(obj["vn"], normals if has_normals else [])
        self.assertEqual([vertex[:3] for vertex in ply["vertex"]], positions)
        self.assertEqual([vertex[3:] for vertex in ply["vertex"]], normals if has_normals else [()] * len(positions))
        self.assertEqual(ply["face"], faces)
        self.assertEqual(ply.get("edge", []), obj["l"])
        self.assertEqual(len(obj["o"]), len(document["meshes"]))
        self.assertEqual(self.done("pose", path, *arguments), (self.folder / "out.obj").read_bytes())
        return document

    def test_levels_of_detail(self):
        # Wide kernels add up a vertex's bones in an order that depends on its neighbours; the plain one does not.
        environment = unittest.mock.patch.dict(os.environ, BENDY_KERNEL="plain")
        environment.start()
        self.addCleanup(environment.stop)
        path = self.shared / "levels.bendy"
        summary = self.done("convert", "--lod", SOURCE / "examples" / "mannequin.glb", "-o", path).decode()
        self.assertRegex(summary, r"levels +100 % [\d,]+, 50 % [\d,]+ \(.*, fewest [\d,]+ triangles \(.* mm off\)\n")
        self.assertEqual(self.done("validate", path), b"")
        self.assertRegex(self.done("inspect", path).decode(), r"LODD .*pools?, .*down to .*error at most")
        whole = self.pose(path, "--clip", "Walk", "--time", "0.25")
        exact = self.pose(self.convert(), "--clip", "Walk", "--time", "0.25")

        def places(document):
            return [sorted((tuple(mesh["positions"][3 * i:3 * i + 3]) for i in mesh["indices"]))
                    for mesh in document["meshes"]]

        self.assertEqual(places(whole), places(exact))
        triangles = sum(len(mesh["indices"]) // 3 for mesh in whole["meshes"])
        for share in ("0.5", "0.25"):
            some = self.pose(path, "--clip", "Walk", "--time", "0.25", "--lod", share)
            count = sum(len(mesh["indices"]) // 3 for mesh in some["meshes"])
            self.assertLessEqual(count, float(share) * triangles)
            self.assertGreater(count, 0.8 * float(share) * triangles)
            for few, many in zip(some["meshes"], whole["meshes"]):
                self.assertEqual(few["positions"], many["positions"][:len(few["positions"])])
            self.assertLess(sum(len(mesh["positions"]) for mesh in some["meshes"]),
                            sum(len(mesh["positions"]) for mesh in whole["meshes"]))

    def test_vertices_are_sorted_by_bones_when_asked(self):
        environment = unittest.mock.patch.dict(os.environ, BENDY_KERNEL="plain")
        environment.start()
        self.addCleanup(environment.stop)
        path = self.shared / "sorted.bendy"
        self.done("convert", "--sort-vertices", SOURCE / "examples" / "mannequin.glb", "-o", path)
        self.assertEqual(self.done("validate", path), b"")
        moved = self.pose(path, "--clip", "Walk", "--time", "0.25")
        exact = self.pose(self.convert(), "--clip", "Walk", "--time", "0.25")
        self.assertNotEqual(moved["meshes"][0]["positions"], exact["meshes"][0]["positions"])
        for ours, theirs in zip(moved["meshes"], exact["meshes"]):
            places = [[mesh["positions"][3 * i:3 * i + 3] for i in mesh["indices"]] for mesh in (ours, theirs)]
            self.assertEqual(*places)  # triangle by triangle
        for other in ("--lod", "--compact", "--max-error=1mm"):
            self.assertIn("--sort-vertices", self.misused("convert", "x.glb", "--sort-vertices", other))

    def test_levels_of_detail_must_be_shares(self):
        for share in ("-0.1", "1.5", "nan", "inf", "much"):
            self.assertIn("--lod", self.misused("pose", self.convert(), "--lod=" + share))

    def test_a_file_without_levels_is_written_whole_with_a_warning(self):
        result = self.bendy("pose", self.convert(), "--lod", "0.5")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"no levels of detail", result.stderr)
        self.assertEqual(result.stdout, self.done("pose", self.convert()))

    def test_json_has_the_layout_that_is_promised(self):
        for arguments, clip, time in (([], None, 0), (["--clip", "Walk", "--time", "0.25"], "Walk", 0.25),
                                      (["--clip", "1"], "Walk", 0)):
            document = self.pose(self.convert(), *arguments)
            self.assertEqual(list(document), ["file", "clip", "time", "joints", "meshes"])
            self.assertEqual((document["file"], document["clip"], document["time"]), ("mannequin.bendy", clip, time))
            self.assertEqual(len(document["joints"]), 65)
            for joint in document["joints"]:
                self.assertEqual(list(joint), ["name", "world"])
                self.assertEqual(len(joint["world"]), 16)
                self.assertEqual(joint["world"][3::4], [0, 0, 0, 1])  # column-major
            self.assertEqual([mesh["name"] for mesh in document["meshes"]], ["Body", "Head"])
            for mesh in document["meshes"]:
                self.assertEqual(list(mesh), ["name", "positions", "normals", "indices"])
                self.assertEqual(len(mesh["positions"]) % 3, 0)
                self.assertEqual(len(mesh["normals"]), len(mesh["positions"]))
                self.assertEqual(len(mesh["indices"]) % 3, 0)
                self.assertLess(max(mesh["indices"]), len(mesh["positions"]) // 3)
            self.assertEqual(sum(len(mesh["positions"]) // 3 for mesh in document["meshes"]), 4504)
            self.assertEqual(sum(len(mesh["indices"]) // 3 for mesh in document["meshes"]), 8052)

    def test_the_formats_agree_on_every_example(self):
        for path in [self.convert("tentacle"), self.strange(), SOURCE / "spec" / "examples" / "every_chunk.bendy",
                     SOURCE / "spec" / "examples" / "one_joint.bendy"]:
            self.pose(path)
        self.pose(self.convert("tentacle"), "--clip", "Reach", "--time", "0.5")
        self.pose(SOURCE / "spec" / "examples" / "every_chunk.bendy", "--clip", "wave", "--time", "0.5")

    def test_the_rest_pose_by_hand(self):
        document = self.pose(self.strange())
        self.assertEqual([joint["name"] for joint in document["joints"]],
                         ["root\x1b[31m\nbendy: error: forged", "\u624b \u00e9", ""])
        self.assertEqual(document["joints"][1]["world"], [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1])
        first, second = document["meshes"]
        self.assertEqual(first["positions"][:9], [0, 1, 0, 1, 1, 0, 0, 2, 0])
        self.assertEqual(first["normals"], [])
        self.assertEqual(second["positions"][3:6], [-1, 0, 0])
        self.assertEqual(second["normals"][:3], [0, 0, 1])
        # A mirrored triangle still shows the side that its normal points to.
        a, b, c = (second["positions"][3 * index : 3 * index + 2] for index in second["indices"])
        self.assertGreater((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]), 0)
        obj = read_obj((self.folder / "out.obj").read_text(encoding="utf-8"))
        self.assertEqual((len(obj["l"]), len(obj["p"])), (1, 1))
        self.assertEqual(obj["v"][obj["l"][0][1]], (as_float(0.1), as_float(1.2), as_float(0.3)))

    def test_clips_by_number_and_by_name(self):
        at = lambda *arguments: self.done("pose", self.convert(), *arguments)  # noqa: E731
        self.assertEqual(at("--clip", "Walk", "--time", "0.3"), at("--clip", "1", "--time", "0.3"))
        self.assertNotEqual(at("--clip", "Walk", "--time", "0.3"), at("--clip", "Idle", "--time", "0.3"))
        self.assertNotEqual(at("--clip", "Walk", "--time", "0.3"), at())
        for clip in ("slide\tnow", "0", "1", "2"):
            document = self.pose(self.strange(), "--clip", clip, "--time", "1")
            self.assertEqual(document["joints"][0]["world"][12], 2)

    def test_times_outside_the_clip_are_held(self):
        for time, expected in (("-5", 0), ("0", 0), ("0.5", 0), ("0.75", 1), ("1.5", 4), ("1e30", 4)):
            document = self.pose(self.strange(), "--clip", "0", "--time", time)
            self.assertEqual(document["joints"][0]["world"][12], expected, time)

    def test_an_unknown_clip_lists_those_that_are_there(self):
        for clip in ("Run", "walk", "2", "-1", "", "0x1", "1.0", "99999999999999999999999"):
            line = self.failed("pose", self.convert(), "--clip", clip, "-o", "out.obj", file=self.convert())
            self.assertIn("Idle", line)
            self.assertIn("Walk", line)
        line = self.failed("pose", SOURCE / "spec" / "examples" / "one_joint.bendy", "--clip", "0")
        self.assertIn("none", line)
        line = self.failed("pose", self.strange(), "--clip", "x\x1b")
        self.assertNotIn("\x1b", line)
        self.assertIn("slide\\x09now", line)
        self.assertEqual(self.files(), [])

    def test_times_must_be_finite_numbers_and_need_a_clip(self):
        self.assertIn("--clip", self.misused("pose", self.convert(), "--time", "1"))
        for time in ("nan", "inf", "-inf", "soon", "", "1e99", "0.5s"):
            self.assertIn("--time", self.misused("pose", self.convert(), "--clip", "Walk", "--time", time))

    def test_outputs_end_in_a_known_format(self):
        for output in ("out", "out.obj.txt", ".obj", "json"):
            self.assertIn(".ply", self.misused("pose", self.convert(), "-o", output))
        self.assertIn("would be FBX", self.misused("pose", self.convert(), "-o", "out.fbx"))
        self.assertEqual(self.files(), [])

    def test_no_output_is_left_by_a_failure(self):
        (self.folder / "old.obj").write_bytes(b"old")
        self.failed("pose", self.convert(), "-o", "missing/out.obj", file="missing/out.obj")
        for output in ("old.obj", "new.json"):
            self.failed("pose", self.convert(), "-o", output, file=output, **FULL_DISK)
        (self.folder / "cut.bendy").write_bytes(self.convert().read_bytes()[:5000])
        self.failed("pose", "cut.bendy", "-o", "cut.obj", file="cut.bendy")
        self.assertEqual(self.files(), ["cut.bendy", "old.obj"])
        self.assertEqual((self.folder / "old.obj").read_bytes(), b"old")

    def test_a_file_without_an_object_fails(self):
        self.assertIn("OBJE", self.failed("pose", SOURCE / "spec" / "examples" / "smallest.bendy"))

    def test_names_are_escaped_in_obj(self):
        text = self.done("pose", self.strange()).decode()
        self.assertFalse(any((ord(c) < 0x20 and c != "\n") or ord(c) == 0x7F for c in text))
        self.assertIn("o bell\\x07\\x7f", text)
        names = [mesh["name"] for mesh in self.pose(self.strange())["meshes"]]
        self.assertEqual(names, ["bell\x07\x7f", 'quote " and \\ and \u00fc'])

    def test_a_damaged_file_is_refused_with_its_place(self):
        data = bytearray(self.convert("tentacle").read_bytes())
        chunk = Chunk.read(bytes(data)).find("HEAD/OBJE/VECT/POSI")
        data[chunk.offset + 100] ^= 1
        (self.folder / "bad.bendy").write_bytes(data)
        line = self.failed("pose", "bad.bendy", file="bad.bendy")
        self.assertRegex(line, rf"\(HEAD/OBJE/VECT/POSI, offset {chunk.offset}\)$")

    def test_a_pose_out_of_range_is_refused(self):
        root = Chunk.read((SOURCE / "spec" / "examples" / "one_joint.bendy").read_bytes())
        rest = root.find("HEAD/OBJE/SKIN/PIVO/REST")
        rest.payload = rest.payload[:16] + struct.pack("<6f", 3e38, 0, 0, 3e38, 1, 1) + rest.payload[40:]
        points = root.find("HEAD/OBJE/VECT/POSI")
        points.payload = points.payload[:16] + struct.pack("<f", 3e38) + points.payload[20:]
        (self.folder / "far.bendy").write_bytes(root.write())
        self.failed("pose", "far.bendy", "-o", "far.obj", file="far.bendy")
        self.assertEqual(self.files(), ["far.bendy"])


class Bench(Case):
    """Which steps are there and for what they are stated; never how long they take."""

    def stages(self, path, *arguments):
        report = json.loads(self.done("bench", path, "--rounds", "1", "--json", *arguments))
        for stage in report["stages"]:
            for times in stage["perItem"].values():
                self.assertGreater(times["leastNs"], 0.0)
                self.assertGreaterEqual(times["medianNs"], times["leastNs"])
        return report, {stage["name"]: stage for stage in report["stages"]}

    def test_steps_of_a_character_with_everything(self):
        path = self.shared / "all.bendy"
        self.done("convert", "--quiet", "--lod", SOURCE / "examples" / "mannequin.glb", "-o", path)
        report, stages = self.stages(path)
        self.assertEqual((report["joints"], report["targets"], report["cycle"]), (65, 2, "Idle"))
        self.assertEqual(list(stages), [
            "open, sums checked", "open, sums not checked", "open to the first pose", "sample, next frame",
            "sample, random time", "blend two poses", "local to model", "local to model and palettes",
            "skin positions", "skin positions, normals", "a whole frame", "inbetween, all targets", "reach",
            "switch the level of detail"])
        self.assertEqual(stages["sample, next frame"]["items"], 65)
        self.assertEqual(stages["skin positions"]["items"], report["vertices"])
        self.assertEqual(stages["reach"]["items"], 4)
        self.assertLess(stages["inbetween, all targets"]["items"], report["vertices"])

    def test_steps_that_a_file_has_not_are_left_out(self):
        path = self.shared / "lone.bendy"
        self.done("convert", "--quiet", SOURCE / "examples" / "tentacle.glb", "-o", path)
        _, stages = self.stages(path, "--clip", "Wave")
        self.assertIn("sample, next frame", stages)
        self.assertNotIn("inbetween, all targets", stages)
        self.assertNotIn("switch the level of detail", stages)

    def test_kernels_stand_side_by_side_on_one_page(self):
        path = self.convert()
        best = self.stages(path)[0]["stages"][0]["perItem"]
        self.assertEqual(len(best), 1)
        page = self.done("bench", path, "--kernel", "plain", "--rounds", "1").decode()
        self.assertRegex(page, r"joints, [\d,]+ vertices")
        self.assertRegex(page, r"\n +plain\n")
        self.assertRegex(page, r"\nlocal to model +\d[\d.]* [num]?s \(\d[\d.]* [num]?s\)  a joint\n")
        self.assertLess(len(page.splitlines()), 25)
        _, stages = self.stages(path, "--kernel", "plain", "--kernel", *best)
        self.assertEqual(set(stages["local to model"]["perItem"]), {"plain", *best})

    def test_wrong_options(self):
        path = self.convert()
        self.assertIn("dance", self.misused("bench", path, "--kernel", "dance"))
        foreign = "avx2" if platform.machine() == "aarch64" else "neon"
        self.assertRegex(self.misused("bench", path, "--kernel", foreign), rf"{foreign} does not run here; these do: .*plain")
        self.misused("bench", path, "--rounds", "0")
        self.assertIn("Dance", self.failed("bench", path, "--clip", "Dance", file=path))


class Rig(Case):
    def write(self, rig, name="rig.json"):
        (self.folder / name).write_text(rig if isinstance(rig, str) else json.dumps(rig))
        return name

    def convert_with(self, rig, *more, source="tentacle"):
        """The rig of an example that was converted with a rig file; warnings in `self.warnings`."""
        result = self.bendy("convert", SOURCE / "examples" / f"{source}.glb", "--rig", self.write(rig), "-q", "-o",
                            "out.bendy", *more)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.warnings = result.stderr.decode().splitlines()
        self.assertEqual(self.done("validate", "out.bendy"), b"")
        return json.loads(self.done("rig", "out.bendy"))

    def refused(self, rig):
        """What is said of a rig file that cannot be used."""
        line = self.failed("convert", SOURCE / "examples" / "tentacle.glb", "--rig", self.write(rig), "-o", "x.bendy",
                           file="rig.json")
        self.assertFalse((self.folder / "x.bendy").exists())
        return line.removeprefix("bendy: error: rig.json: ")

    def test_a_rig_that_is_put_back_gives_the_same_file(self):
        for name in ("mannequin", "tentacle"):
            self.done("rig", self.convert(name), "-o", "rig.json")
            rig = json.loads((self.folder / "rig.json").read_text())
            self.assertEqual(rig["complete"], True)
            self.assertGreater(len(rig["joints"]), 5)
            self.assertGreater(len(rig["chains"]), 0)
            self.assertEqual((self.folder / "rig.json").read_bytes(), self.done("rig", self.convert(name)))
            self.done("convert", SOURCE / "examples" / f"{name}.glb", "--rig", "rig.json", "-o", "again.bendy")
            self.assertEqual((self.folder / "again.bendy").read_bytes(), self.convert(name).read_bytes())

    def test_the_summary_tells_constraints_and_chains(self):
        text = self.done("convert", SOURCE / "examples" / "mannequin.glb", "-o", "m.bendy").decode()
        chunks = [chunk.letters for _, chunk in Chunk.read((self.folder / "m.bendy").read_bytes()).walk()]
        self.assertIn(f"\n  rig            {chunks.count('LIMT')} constraints, 4 chains: IK_LeftArm, IK_RightArm, ", text)
        text = self.done("convert", SOURCE / "examples" / "mannequin.glb", "-o", "m.bendy", "--rig",
                         self.write({"bendy_rig": 1, "complete": True})).decode()
        self.assertNotIn("  rig  ", text)

    def test_globs_names_and_numbers(self):
        rig = self.convert_with({"bendy_rig": 1, "complete": True, "joints": {
            "seg_0[123]": {"model": "hinge", "x": [0, 30]}, "*_0?": {"model": "locked"}, "seg_02": [],
            "#0": {"model": "largest_angle", "angle": 90}, "seg_03*": {"model": "free"}, "Nose": []}})
        self.assertEqual({name: limit["model"] for name, limit in rig["joints"].items()},
                         {"TentacleRig": "largest_angle", "seg_03": "free",
                          **{f"seg_0{i}": "locked" for i in (0, 1, 4, 5, 6, 7, 8, 9)}})
        self.assertNotIn("chains", rig)
        self.assertEqual([line.rpartition("rig.json: ")[2] for line in self.warnings],
                         ["joints.'seg_0[123]': no joint takes 'seg_0[123]'", "joints.Nose: no joint takes 'Nose'"])

    def test_what_the_rig_file_leaves_open_the_extras_say(self):
        before = json.loads(self.done("rig", self.convert("tentacle")))
        rig = self.convert_with({"bendy_rig": 1, "joints": {"seg_03": [], "seg_04": {"model": "locked"}}, "chains": [
            {"name": "other", "start": "seg_00", "effector": "seg_02", "extras": {"note": [1]}}]})
        joints = dict(before["joints"], seg_04={"model": "locked"})
        del joints["seg_03"]
        self.assertEqual(rig["joints"], joints)
        self.assertEqual([chain["name"] for chain in rig["chains"]], ["other", "IK_tip"])
        self.assertEqual(rig["chains"][0]["extras"], {"note": [1]})
        rig = self.convert_with({"bendy_rig": 1, "chains": [{"name": "IK_tip", "start": "seg_00", "effector": "seg_02"}]})
        self.assertEqual(rig["chains"], [{"name": "IK_tip", "start": "seg_00", "effector": "seg_02"}])
        self.assertEqual(rig["joints"], before["joints"])

    def test_faults_are_told_with_their_place(self):
        self.assertEqual(self.refused({"bendy_rig": 1, "joints": {"*Knee*": {"model": "hinge", "x": ["a", 1]}}}),
                         "joints.'*Knee*'.x[0]: a number is due, not 'a'")
        self.assertEqual(self.refused({"bendy_rig": 1, "chains": [{"name": "c", "start": "nose", "effector": "#1"}]}),
                         "chains[0].start: there is no joint 'nose'")
        self.assertRegex(self.refused('{\n  "bendy_rig" 1}'), r"^invalid JSON at line 2, column 15 \(byte \d+\): ")
        self.assertIn("nested deeper", self.refused('{"bendy_rig": ' + "[" * 100_000))
        self.assertIn("1e+400", self.refused('{"bendy_rig": 1e+400}'))
        self.assertIn("there is no text", self.refused(""))
        self.assertNotIn("\x1b", self.refused({"bendy_rig": 1, "joints": {"\x1b[31m[": {}}}))

    def test_rig_files_that_cannot_be_read_are_named(self):
        (self.folder / "folder").mkdir()
        for name in ("missing.json", "folder"):
            self.failed("convert", SOURCE / "examples" / "tentacle.glb", "--rig", name, "-o", "x", file=name)
        self.assertEqual(self.files(), ["folder"])

    def test_a_damaged_file_is_refused_with_its_place(self):
        data = bytearray(self.convert("tentacle").read_bytes())
        chunk = Chunk.read(bytes(data)).find("HEAD/OBJE/SKIN/PIVO/REST")
        data[chunk.offset + 20] ^= 1
        (self.folder / "bad.bendy").write_bytes(data)
        self.assertRegex(self.failed("rig", "bad.bendy", file="bad.bendy"), rf"offset {chunk.offset}\)$")

    def test_an_output_that_cannot_be_written_is_named(self):
        self.failed("rig", self.convert("tentacle"), "-o", "missing/rig.json", file="missing/rig.json")
        self.assertEqual(self.files(), [])

    def schema_says(self, rig):
        schema = json.loads((SOURCE / "spec" / "rig.schema.json").read_text())
        return is_valid(rig, schema, schema)

    def test_the_schema_accepts_what_is_written_and_the_example(self):
        for name in ("mannequin", "tentacle"):
            self.assertTrue(self.schema_says(json.loads(self.done("rig", self.convert(name)))))
        example = (SOURCE / "spec" / "rig.md").read_text().partition("```json\n")[2].partition("```")[0]
        self.assertTrue(self.schema_says(json.loads(example)))

    def test_the_schema_and_the_program_agree(self):
        schema = json.loads((SOURCE / "spec" / "rig.schema.json").read_text())
        parts = schema["$defs"]
        models = parts["constraint"]["properties"]["model"]["enum"]
        samples = [None, True, 0, 1, 2, -1, 0.5, 70000, "", "x", [], {}, [1], [0, 0], [-1, 1], [None, None], [0, 0, 0],
                   [0, 0, 1], [2, 0, 0], [0, 0, 0, 1], {"x": [0, 1]}, {"w": [0, 1]}, {"seg_00": 1}, {"seg_01": 2},
                   {"model": "free"}, [{"model": "free"}]]
        rigs = [None, [], {}, {"bendy_rig": 2}, {"bendy_rig": 1, "joint": {}}]
        for key in schema["properties"]:
            rigs += [{"bendy_rig": 1, key: sample} for sample in samples]
        for key, rule in {**parts["constraint"]["properties"], "unknown": {}}.items():
            for model in models if key in ("order", "x", "y", "z", "angle") else ("hinge",):
                for sample in samples + rule.get("enum", []):
                    rigs.append({"bendy_rig": 1, "joints": {"seg_00": {"model": model, key: sample}}})
        for key, rule in {**parts["chain"]["properties"], "unknown": {}}.items():
            chain = {"name": "c", "start": "seg_00", "effector": "seg_01"}
            rigs += [{"bendy_rig": 1, "chains": [{**chain, key: s}]} for s in samples + rule.get("enum", [])]
            if key in chain:
                rigs.append({"bendy_rig": 1, "chains": [{k: v for k, v in chain.items() if k != key}]})
        # What a schema cannot say: joints that are there, ranges in order that hold 0 where they must, no zero rotation.
        beyond = re.compile(r"there is no joint|nor above it|is above the maximum|must hold 0|is no rotation|no such joint")
        agreed = {True: 0, False: 0}
        for rig in rigs:
            self.write(rig)
            result = self.bendy("convert", self.row(), "--rig",
                                "rig.json", "-q", "-o", "out.bendy")
            if result.returncode == 1 and beyond.search(result.stderr.decode()):
                continue
            self.assertEqual(result.returncode == 0, self.schema_says(rig), (rig, result.stderr))
            agreed[result.returncode == 0] += 1
        self.assertGreater(min(agreed.values()), 100)

    def row(self):
        """A small file with the joints that the samples name."""
        path = self.shared / "row.gltf"
        if not path.exists():
            path.write_text(json.dumps({"asset": {"version": "2.0"}, "nodes": [
                {"name": "seg_00", "children": [1]}, {"name": "seg_01", "children": [2]}, {"name": "x"}]}))
        return path


class Markers(Case):
    STEPS = [{"time": 0.25, "name": "left"}, {"time": 0.75, "name": "right"}]

    def write(self, markers, **members):
        (self.folder / "rig.json").write_text(json.dumps({"bendy_rig": 1, "markers": markers, **members}))
        return "rig.json"

    def marked(self, markers, source="mannequin", out="marked.bendy", **members):
        self.done("convert", self.convert(source), "--rig", self.write(markers, **members), "-q", "-o", out)
        self.assertEqual(self.done("validate", out), b"")
        return out

    def test_they_are_seen_in_every_report(self):
        self.marked({"Walk": self.STEPS})
        text = self.done("inspect", "marked.bendy").decode()
        self.assertRegex(text, r'CYCL 1  "Walk"  0 to 1 s, 59 tracks, repeats, 2 markers\n')
        self.assertIn('2 markers: "left" at 0.25 s, "right" at 0.75 s', text)
        chunks = json.loads(self.done("inspect", "marked.bendy", "--json"))["chunks"]
        self.assertEqual([chunk["fields"] for chunk in chunks if chunk["id"] == "MARK"],
                         [{"markers": [{"seconds": 0.25, "name": "left"}, {"seconds": 0.75, "name": "right"}]}])
        self.done("inspect", "marked.bendy", "--html", "m.html")
        self.assertIn('"markers":[[0.25,"left"],[0.75,"right"]]', (self.folder / "m.html").read_text())

    def test_the_rig_file_gives_the_same_bytes(self):
        self.marked({"Walk": {"right": 0.75, "left": 0.25}, "#0": []})
        rig = json.loads(self.done("rig", "marked.bendy", "-o", "again.json") or (self.folder / "again.json").read_text())
        self.assertEqual(rig["markers"], {"Walk": self.STEPS})
        schema = json.loads((SOURCE / "spec" / "rig.schema.json").read_text())
        self.assertTrue(is_valid(rig, schema, schema))
        self.done("convert", self.convert(), "--rig", "again.json", "-q", "-o", "again.bendy")
        self.assertEqual((self.folder / "again.bendy").read_bytes(), (self.folder / "marked.bendy").read_bytes())

    def test_from_gltf_and_back_the_chunks_are_the_same(self):
        self.done("export", self.marked({"Walk": self.STEPS}), "-o", "m.gltf", "-q")
        document = json.loads((self.folder / "m.gltf").read_text())
        extras = next(a["extras"] for a in document["animations"] if a["name"] == "Walk")
        self.assertEqual(extras["markers"], self.STEPS)
        self.assertNotIn("markers", document["scenes"][0]["extras"]["bendy_rig"])
        for form in (self.STEPS, {"right": 0.75, "left": [0.25]}, json.dumps(self.STEPS)):
            extras["markers"] = form
            (self.folder / "m.gltf").write_text(json.dumps(document))
            self.done("convert", "m.gltf", "-q", "-o", "once.bendy")
            self.assertEqual((self.folder / "once.bendy").read_bytes(), (self.folder / "marked.bendy").read_bytes())

    def test_compact_and_lod_files_keep_them(self):
        self.marked({"Walk": self.STEPS})
        self.done("convert", "marked.bendy", "--compact", "--lod", "-q", "-o", "small.bendy")
        self.assertEqual(json.loads(self.done("rig", "small.bendy"))["markers"], {"Walk": self.STEPS})
        self.done("diff", "marked.bendy", "small.bendy", "--tolerance", "1%")
        self.done("edit", "small.bendy", "-o", "bare.bendy", "--strip", "markers")
        self.assertNotIn("markers", json.loads(self.done("rig", "bare.bendy")))
        result = self.bendy("diff", "small.bendy", "bare.bendy", "--tolerance", "1%")
        self.assertEqual(result.returncode, 1)
        self.assertIn(b'! cycle "Walk": markers: 2 -> 0\n', result.stdout)

    def test_differences_are_told_one_by_one(self):
        self.marked({"Walk": self.STEPS})
        self.marked({"Walk": {"left": 0.25, "hit": 0.5}}, out="other.bendy")
        result = self.bendy("diff", "marked.bendy", "other.bendy")
        self.assertEqual(result.returncode, 1)
        self.assertEqual([line.split(": ", 1)[1] for line in result.stdout.decode().splitlines()],
                         ["marker 1: seconds: 0.75 -> 0.5", 'marker 1: name: "right" -> "hit"'])

    def test_what_is_wrong_in_a_rig_file(self):
        for markers, message in (
                ({"Walk": [{"time": 1.5, "name": "late"}]},
                 "markers.Walk[0]: 1.5 s is outside the cycle, which lasts from 0.0 s to 1.0 s"),
                ({"Walk": {"step": "soon"}}, "markers.Walk.step: a number is due, not 'soon'"),
                ([], "markers: it must be an object, not array")):
            line = self.failed("convert", self.convert(), "--rig", self.write(markers), "-o", "x.bendy")
            self.assertEqual(line, f"bendy: error: rig.json: {message}")
            self.assertFalse((self.folder / "x.bendy").exists())
        result = self.bendy("convert", self.convert(), "--rig", self.write({"Fly": []}), "-q", "-o", "x.bendy")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"rig.json: markers.Fly: no cycle takes 'Fly'", result.stderr)


class Diff(Case):
    def edited(self, change, source=None, name="edited.bendy"):
        """A copy of a file with a change made to its tree, and right sums."""
        root = Chunk.read((source or self.convert()).read_bytes())
        change(root)
        path = self.folder / name
        path.write_bytes(root.write())
        self.assertEqual(self.done("validate", path), b"")
        return path

    def differ(self, *arguments):
        """The lines that are printed of two files that differ."""
        result = self.bendy("diff", *arguments)
        self.assertEqual((result.returncode, result.stderr), (1, b""), result)
        lines = result.stdout.decode().splitlines()
        self.assertTrue(lines)
        return lines

    def trouble(self, *arguments):
        result = self.bendy("diff", *arguments)
        self.assertEqual((result.returncode, result.stdout), (2, b""), result)
        self.assertEqual(len(result.stderr.decode().splitlines()), 1)
        return result.stderr.decode()

    @staticmethod
    def set_bytes(path, offset, data):
        def change(root):
            chunk = root.find(path)
            chunk.payload = chunk.payload[:offset] + data + chunk.payload[offset + len(data):]
        return change

    def test_a_file_is_like_itself(self):
        for path in self.good_files():
            self.assertEqual(self.done("diff", path, path), b"")
            self.assertTrue(json.loads(self.done("diff", path, path, "--json"))["same"])

    def test_a_field_is_named_with_both_values(self):
        path = self.edited(self.set_bytes("HEAD/OBJE/SKIN/PIVO/REST", 16, struct.pack("<f", 0.125)))
        self.assertEqual(self.differ(self.convert(), path),
                         ['! HEAD/OBJE/SKIN/PIVO/REST "Mannequin": translation: 0 0 0 -> 0.125 0 0'])
        self.assertEqual(self.differ(path, self.convert()),
                         ['! HEAD/OBJE/SKIN/PIVO/REST "Mannequin": translation: 0.125 0 0 -> 0 0 0'])

    def test_streams_say_how_many_how_much_and_where(self):
        def change(root):
            self.set_bytes("HEAD/OBJE/VECT/POSI", 16 + 12 * 5 + 4, struct.pack("<f", 100))(root)
            self.set_bytes("HEAD/OBJE/VECT/POSI", 16 + 12 * 9, struct.pack("<3f", 7, 8, 9))(root)
        line, = self.differ(self.convert(), self.edited(change))
        self.assertRegex(line, r'^! HEAD/OBJE/VECT/POSI "Body": 4 of 10,389 numbers differ, by up to 9\d\.\d+; '
                               r"the first: element 5, component 1: \S+ -> 100$")

    def test_texts_are_shown(self):
        def change(root):
            root.find("HEAD/OBJE/CYCL/NAME").payload = b"Wave\n"
        self.assertEqual(self.differ(self.convert(), self.edited(change)),
                         ['! HEAD/OBJE/CYCL/NAME "Idle": text: "Idle" -> "Wave\\x0a"'])

    def test_one_cycle_more_is_one_difference(self):
        def change(root):
            cycles = [chunk for chunk in root.find("HEAD/OBJE").children if chunk.letters == "CYCL"]
            new = Chunk("CYCL", children=[Chunk("NAME", b"New"), cycles[0].children[1]])
            new.children += [chunk for chunk in cycles[0].children if chunk.letters in ("TRAK", "TIME", "KEYV")]
            objects = root.find("HEAD/OBJE").children
            objects.insert(objects.index(cycles[0]), new)
            version = root.find("HEAD/VERS")
            count, = struct.unpack_from("<I", version.payload, 32)
            version.payload = version.payload[:32] + struct.pack("<I", count + 1) + version.payload[36:]
        path = self.edited(change)
        self.assertEqual(self.differ(self.convert(), path),
                         ["! HEAD/VERS: cycles: 2 -> 3", '+ HEAD/OBJE/CYCL "New": only in B'])
        self.assertEqual(self.differ(path, self.convert()),
                         ["! HEAD/VERS: cycles: 3 -> 2", '- HEAD/OBJE/CYCL "New": only in A'])

    def test_another_order_is_said(self):
        def change(root):
            children = root.find("HEAD/OBJE").children
            places = [place for place, chunk in enumerate(children) if chunk.letters == "CYCL"]
            children[places[0]], children[places[1]] = children[places[1]], children[places[0]]
        self.assertEqual(self.differ(self.convert(), self.edited(change)),
                         ['! HEAD/OBJE/CYCL[1] "Walk" (in B: HEAD/OBJE/CYCL): stands in another order'])

    def test_tracks_are_paired_by_what_they_animate(self):
        def change(root):
            table = root.find("HEAD/OBJE/CYCL[1]/TRAK")
            rows = [table.payload[at : at + 24] for at in range(0, len(table.payload), 24)]
            table.payload = b"".join(rows[1:][::-1])
        lines = self.differ(self.convert(), self.edited(change))
        self.assertEqual(len(lines), 1)
        self.assertRegex(lines[0], r'^- HEAD/OBJE/CYCL\[1\] "Walk": track joint \d+ \w+: only in A$')

    def test_keys_are_compared_track_by_track(self):
        def change(root):
            self.set_bytes("HEAD/OBJE/CYCL/TIME", 0, struct.pack("<f", 0.001))(root)
        lines = self.differ(self.convert(), self.edited(change))
        self.assertTrue(all(": times: 1 of " in line and line.endswith("element 0: 0 -> 0.001") for line in lines))

    def test_other_keys_with_the_same_course_are_within_a_tolerance(self):
        """Keys in the middle of straight lines."""
        def change(root):
            chunk = root.find("HEAD/OBJE/CYCL")
            parts = {part.letters: part for part in chunk.children}
            times, values = floats(parts["TIME"].payload), floats(parts["KEYV"].payload)
            rows = [list(struct.unpack_from("<IBBHIIQ", parts["TRAK"].payload, at))
                    for at in range(0, len(parts["TRAK"].payload), 24)]
            row = next(row for row in rows if row[1] == 1 and row[2] == 1 and row[4] >= 2)
            keys, first_time, first_value = row[4:]
            own_times, own_values = times[first_time:][:keys], values[first_value:][: keys * 4]
            a, b = own_values[:4], own_values[4:8]
            sign = 1 if sum(x * y for x, y in zip(a, b)) > 0 else -1
            middle = [x + sign * y for x, y in zip(a, b)]
            length = math.sqrt(sum(x * x for x in middle))
            own_values[4:4] = [x / length for x in middle]
            own_times[1:1] = [(own_times[0] + own_times[1]) / 2]
            row[4:] = keys + 1, len(times), len(values)
            parts["TIME"].payload += struct.pack(f"<{len(own_times)}f", *own_times)
            parts["KEYV"].payload += struct.pack(f"<{len(own_values)}f", *own_values)
            parts["TRAK"].payload = b"".join(struct.pack("<IBBHIIQ", *row) for row in rows)
        path = self.edited(change)
        self.assertTrue(any(": keys: " in line for line in self.differ(self.convert(), path)))
        self.done("diff", self.convert(), path, "--tolerance", "0.01mm")

    def test_another_type_of_numbers_is_a_field(self):
        """Numbers from 0 to 1 as u16 and as floats: what another writer may choose."""
        def coords(kind, count, data):
            record = struct.pack("<BBHIII", kind, int(kind != 5), 2, count // 2, 0, 0)
            return Chunk("TEXC", record + data)
        def change(as_floats):
            def change(root):
                pool = root.find("HEAD/OBJE/VECT")
                count = 2 * struct.unpack_from("<I", root.find("HEAD/OBJE/VECT/VINF").payload)[0]
                whole = [(7 * place) % 65536 for place in range(count)]
                pool.children = [chunk for chunk in pool.children if chunk.letters != "TEXC"]
                if as_floats:
                    part = coords(5, count, struct.pack(f"<{count}f", *((n + 0.25) / 65535 for n in whole)))
                else:
                    part = coords(2, count, struct.pack(f"<{count}H", *whole))
                pool.children.append(part)
            return change
        base = self.edited(change(True), name="base.bendy")
        path = self.edited(change(False))
        lines = self.differ(base, path)
        self.assertTrue(any("component_type: 5 -> 2" in line for line in lines))

    def test_sparse_and_dense_targets_are_the_same_displacements(self):
        def change(root):
            for path, chunk in root.walk():
                if chunk.letters != "TARG":
                    continue
                parts = {part.letters: part for part in chunk.children}
                if "INDX" not in parts:
                    continue
                vertices, = struct.unpack_from("<I", root.find(path.rpartition("/")[0] + "/VINF").payload)
                width = "H" if parts["INDX"].payload[0] == 2 else "I"
                touched = [index for index, in struct.iter_unpack("<" + width, parts["INDX"].payload[16:])]
                for letters in ("POSI", "NORM", "TANG"):
                    if letters not in parts:
                        continue
                    numbers = [0.0] * (3 * vertices)
                    for place, three in zip(touched, struct.iter_unpack("<3f", parts[letters].payload[16:])):
                        numbers[3 * place : 3 * place + 3] = three
                    head = parts[letters].payload[:4] + struct.pack("<I", vertices) + parts[letters].payload[8:16]
                    parts[letters].payload = head + struct.pack(f"<{len(numbers)}f", *numbers)
                chunk.children.remove(parts["INDX"])
                return
            self.fail("no sparse target")
        path = self.edited(change)
        self.assertTrue(any("INDX" in line for line in self.differ(self.convert(), path)))
        self.done("diff", self.convert(), path, "--tolerance", "0.001mm")
        self.done("diff", path, self.convert(), "--tolerance", "0.001mm")

    def test_unknown_chunks_are_compared_as_bytes(self):
        base = self.edited(lambda root: root.children.append(Chunk("ZZZZ", b"0123456789")), name="base.bendy")
        other = self.edited(self.set_bytes("HEAD/ZZZZ", 3, b"x4y"), base)
        self.assertEqual(self.differ(base, other), ["! HEAD/ZZZZ: 2 of 10 bytes differ, the first at 3"])
        self.assertEqual(self.differ(self.convert(), base), ["+ HEAD/ZZZZ: only in B"])

    def test_json_says_the_same(self):
        path = self.edited(self.set_bytes("HEAD/OBJE/SKIN/PIVO/REST", 16, struct.pack("<f", 0.125)))
        result = self.bendy("diff", self.convert(), path, "--json")
        self.assertEqual(result.returncode, 1)
        report = json.loads(result.stdout)
        self.assertFalse(report["same"])
        self.assertEqual(report["differences"], [{
            "kind": "value", "pathInA": "HEAD/OBJE/SKIN/PIVO/REST", "pathInB": "HEAD/OBJE/SKIN/PIVO/REST",
            "name": "Mannequin", "part": "translation", "a": [0.0, 0.0, 0.0], "b": [0.125, 0.0, 0.0]}])

    def twins(self):
        """The mannequin exactly and compactly, and the worst error in millimetres that the converter has printed."""
        exact = self.convert()
        text = self.done("convert", SOURCE / "examples/mannequin.glb", "--compact", "-o", "compact.bendy").decode()
        return exact, self.folder / "compact.bendy", text

    def test_a_compact_file_is_its_exact_twin_within_the_printed_bound(self):
        exact, compact, text = self.twins()
        bound, worst = re.search(r"error +at most (\S+ mm); worst met (\S+) mm", text).groups()
        self.differ(exact, compact)
        for pair in ((exact, compact), (compact, exact)):
            self.assertIn("; worst met ", self.done("diff", *pair, "--tolerance", bound).decode())
        report = json.loads(self.done("diff", exact, compact, "--tolerance", "0.005%", "--json"))
        self.assertTrue(report["same"])
        self.assertAlmostEqual(1000 * report["worst"], float(worst), delta=0.01 * float(worst))
        self.assertIn('mesh "Body"', report["worstPlace"])
        lines = self.differ(exact, compact, "--tolerance", f"{float(worst) / 10}mm")
        self.assertTrue(lines[0].startswith('! mesh "Body", vertex '), lines)
        self.done("convert", compact, "-o", "decoded.bendy")
        self.done("diff", exact, "decoded.bendy", "--tolerance", bound)

    def test_characters_differ_by_what_is_named(self):
        def rest(root):
            self.set_bytes("HEAD/OBJE/SKIN/SKIN/PIVO/REST", 16, struct.pack("<f", 0.125))(root)
        path = self.edited(rest)
        lines = self.differ(self.convert(), path, "--tolerance", "1mm")
        self.assertTrue(any(re.match(r'! joint ".*", at rest: .* mm apart', line) for line in lines), lines)
        def vertex(root):
            self.set_bytes("HEAD/OBJE/VECT/POSI", 16 + 12 * 5 + 4, struct.pack("<f", 0.9))(root)
        lines = self.differ(self.convert(), self.edited(vertex), "--tolerance", "1mm")
        self.assertTrue(lines[0].startswith('! mesh "Body", vertex 5, at rest: '), lines)
        report = json.loads(self.bendy("diff", self.convert(), path, "--tolerance", "1mm", "--json").stdout)
        self.assertEqual((report["same"], report["differences"][0]["kind"]), (False, "distance"))

    def test_damaged_files_and_wrong_command_lines_are_trouble(self):
        good = self.convert()
        data = bytearray(good.read_bytes())
        data[4000] ^= 1
        (self.folder / "bad.bendy").write_bytes(data)
        for pair in ((good, "bad.bendy"), ("bad.bendy", good)):
            self.assertIn("bendy: error: bad.bendy: ", self.trouble(*pair))
        self.assertIn("missing.bendy", self.trouble(good, "missing.bendy"))
        self.assertIn("not a bendy file", self.trouble(SOURCE / "README.md", good))
        self.misused("diff", good)
        for wrong in ("-1", "0", "1e-4", "nan", "inf", "much", "1 parsec", "-1mm", ""):
            self.misused("diff", good, good, "--tolerance", wrong)

    def test_many_differences_are_counted(self):
        """A thousand are listed."""
        def tree(text):
            base = Chunk.read(self.convert("tentacle").read_bytes())
            base.children += [Chunk("ZZZZ", text + str(n).encode()) for n in range(1500)]
            return base
        for name in (b"a", b"b"):
            (self.folder / name.decode()).write_bytes(tree(name).write())
        lines = self.differ("a", "b")
        self.assertEqual((len(lines), lines[-1]), (1001, "500 more differences"))


class FromBendy(Case):
    def test_a_file_converts_to_itself(self):
        for name in ("mannequin", "tentacle"):
            shutil.copy(self.convert(name), self.folder / "in.glb")  # told by its content
            self.done("convert", "in.glb", "-o", "out.bendy", "--exact")
            self.assertEqual((self.folder / "out.bendy").read_bytes(), self.convert(name).read_bytes())

    def test_what_is_left_out_is_named(self):
        result = self.bendy("convert", "-q", SOURCE / "spec" / "examples" / "every_chunk.bendy", "-o", "out.bendy")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"fixed frames are written as timed keys", result.stderr)

    def test_the_input_stays(self):
        shutil.copy(self.convert(), self.folder / "in.bendy")
        self.assertIn("is an input as well", self.failed("convert", "in.bendy"))

    def test_a_damaged_file_is_refused_with_its_place(self):
        data = bytearray(self.convert().read_bytes())
        data[40] ^= 1
        (self.folder / "bad.bendy").write_bytes(data)
        self.assertIn("HEAD/VERS, offset 16", self.failed("convert", "bad.bendy", "-o", "out.bendy", file="bad.bendy"))
        self.assertEqual(self.files(), ["bad.bendy"])


class Export(Case):
    def test_the_export_converts_to_the_same_bytes(self):
        for name in ("mannequin", "tentacle"):
            shutil.copy(self.convert(name), self.folder / f"{name}.bendy")
            self.assertIn(f"{name}.glb: ", self.done("export", f"{name}.bendy").decode())
            self.assertEqual(self.done("convert", "-q", f"{name}.glb", "-o", "again.bendy"), b"")
            self.assertEqual((self.folder / "again.bendy").read_bytes(), self.convert(name).read_bytes())

    def test_json_with_the_numbers_beside_it(self):
        self.done("export", self.convert(), "-o", "a b.gltf", "-q")
        self.assertEqual(self.files(), ["a b.bin", "a b.gltf"])
        document = json.loads((self.folder / "a b.gltf").read_text())
        self.assertEqual(document["buffers"], [{"byteLength": (self.folder / "a b.bin").stat().st_size, "uri": "a%20b.bin"}])
        self.done("convert", "-q", "a b.gltf", "-o", "again.bendy")
        self.assertEqual((self.folder / "again.bendy").read_bytes(), self.convert().read_bytes())

    def test_the_rig_stands_in_the_extras_and_can_be_edited_there(self):
        self.done("export", self.convert(), "-o", "m.gltf", "-q")
        document = json.loads((self.folder / "m.gltf").read_text())
        rig = document["scenes"][0]["extras"]["bendy_rig"]
        self.assertEqual(rig, json.loads(self.done("rig", self.convert())))
        rig["chains"] = rig["chains"][:1]
        (self.folder / "m.gltf").write_text(json.dumps(document))
        self.done("convert", "m.gltf", "-o", "m.bendy", "-q")
        self.assertEqual(len(json.loads(self.done("rig", "m.bendy"))["chains"]), 1)

    def test_a_broken_rig_is_named_and_the_rest_converts(self):
        self.done("export", self.convert("tentacle"), "-o", "t.gltf", "-q")
        document = json.loads((self.folder / "t.gltf").read_text())
        document["scenes"][0]["extras"]["bendy_rig"]["chains"][0]["start"] = "nobody"
        (self.folder / "t.gltf").write_text(json.dumps(document))
        result = self.bendy("convert", "t.gltf", "-q")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"scene.extras.bendy_rig.chains[0].start: rig left out: there is no joint", result.stderr)

    def test_every_kind_of_chunk(self):
        source = SOURCE / "spec" / "examples" / "every_chunk.bendy"
        result = self.bendy("export", source, "-o", "every.glb")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(b"levels of detail left out", result.stderr)
        self.done("convert", "every.glb", "-o", "every.bendy")
        result = self.bendy("diff", source, "every.bendy", "--tolerance", "0.001mm")
        # glTF hangs a mesh that no joint carries into the scene by a node.
        self.assertEqual(result.stdout.splitlines(), [b'+ joint "wing": only in B', b"tolerance 0.001 mm; worst met 0 mm"])

    def triangles(self, path, *arguments):
        """Of each mesh, the places of its triangles' corners in the middle of the walk, sorted."""
        self.done("pose", path, "--clip", "Walk", "--time", "0.25", *arguments, "-o", "posed.json")
        meshes = json.loads((self.folder / "posed.json").read_text(encoding="utf-8"))["meshes"]
        corners = [[mesh["positions"][3 * i:3 * i + 3] for i in mesh["indices"]] for mesh in meshes]
        return [sorted(list(zip(*[iter(places)] * 3))) for places in corners]

    def test_one_level_of_detail(self):
        path = self.shared / "levels_to_export.bendy"
        self.done("convert", "--quiet", "--lod", SOURCE / "examples" / "mannequin.glb", "-o", path)
        with unittest.mock.patch.dict(os.environ, BENDY_KERNEL="plain"):
            for share in ("0.5", "0.1", "0"):
                ours = self.triangles(path, "--lod", share)
                for name in ("level.glb", "level.x"):
                    result = self.bendy("export", path, "--lod", share, "-o", name)
                    self.assertEqual(result.returncode, 0, result.stderr)
                    self.assertNotIn(b"levels of detail", result.stderr)
                    self.done("convert", "--quiet", "--force", name, "-o", "level.bendy")
                    theirs = self.triangles("level.bendy")
                    if name == "level.glb":
                        self.assertEqual(theirs, ours)
                    self.assertEqual([len(mesh) for mesh in theirs], [len(mesh) for mesh in ours])
        result = self.bendy("export", self.convert(), "--lod", "0.5", "-o", "whole.glb")
        self.assertIn(b"no levels of detail in it", result.stderr)
        self.assertIn("--lod", self.misused("export", path, "--lod", "nan"))

    def test_what_cannot_be_exported(self):
        (self.folder / "bad.bendy").write_bytes(self.convert().read_bytes()[:1000])
        self.failed("export", "bad.bendy", "-o", "bad.glb", file="bad.bendy")
        self.assertEqual(self.files(), ["bad.bendy"])
        shutil.copy(self.convert(), self.folder / "same.glb")
        self.assertIn("is an input as well", self.failed("export", "same.glb", file="same.glb"))
        self.failed("export", self.convert(), "-o", "no/such/folder.glb")
        self.assertIn("--format", self.misused("export", "x.bendy", "--format", "fbx"))


class XFiles(Case):
    def test_an_x_file_holds_the_rig_and_converts(self):
        shown = self.done("export", self.convert("tentacle"), "-o", "t.x").decode()
        self.assertIn("t.x: ", shown)
        text = (self.folder / "t.x").read_text()
        self.assertTrue(text.startswith("xof 0303txt 0032\n"))
        self.assertIn("BendyIkChain {\n", text)
        self.done("convert", "-q", "t.x", "-o", "again.bendy")
        before = json.loads(self.done("rig", self.convert("tentacle")))
        after = json.loads(self.done("rig", "again.bendy"))
        self.assertGreater(len(before["chains"]), 0)
        self.assertEqual(before, after)

    def test_the_format_goes_before_the_name(self):
        self.done("export", self.convert("tentacle"), "--format", "x", "-q", "-o", "odd.name")
        self.assertTrue((self.folder / "odd.name").read_text().startswith("xof "))

    def test_embedded_images_are_written_beside(self):
        shown = self.done("export", self.convert(), "-o", "m.x").decode()
        self.assertIn("images beside it: m_0.png", shown)
        self.assertTrue((self.folder / "m_0.png").read_bytes().startswith(b"\x89PNG"))
        self.done("convert", "-q", "m.x", "-o", "again.bendy")
        self.assertIn("IMAG", self.done("inspect", "again.bendy").decode())

    def test_what_is_wrong_in_an_x_file_has_line_and_column(self):
        (self.folder / "bad.x").write_text("xof 0303txt 0032\nMesh {\n 1; 1;2;oops; 0;}\n")
        message = self.failed("convert", "bad.x", file="bad.x")
        self.assertIn("line 3, column 9: a number is due here, not 'oops'", message)
        (self.folder / "packed.x").write_bytes(b"xof 0303tzip0032" + b"\x40" + bytes(31))
        self.assertIn("byte 20: a compressed block of 0 bytes", self.failed("convert", "packed.x", file="packed.x"))
        (self.folder / "other.x").write_bytes(b"solid")
        self.assertIn("no X-file", self.failed("convert", "other.x", file="other.x"))
        self.assertIn("glTF files only", self.failed("convert", "bad.x", "--scene", "0", file="bad.x"))


class QuakeModels(Case):
    def test_frames_become_targets_and_cycles(self):
        md2_file(self.folder / "man.md2")
        shown = self.done("convert", "man.md2").decode()
        self.assertIn("morph targets  3: stand02, run1, run2", shown)
        self.assertIn("clips          2: stand 0.2 s, run 0.2 s", shown)
        self.done("pose", "man.bendy", "--clip", "run", "--time", "0.1", "-o", "up.obj")
        heights = sorted({corner[1] for corner in read_obj((self.folder / "up.obj").read_text())["v"]})
        # The fourth frame: 3 units up, and from 0 to 2 of its own.
        self.assertEqual([round(height * 32, 4) for height in heights], [3, 5])

    def corners(self, file, clip, seconds):
        """Of all triangles, in model space."""
        self.done("pose", file, "--clip", clip, "--time", repr(seconds), "-o", "pose.json")
        mesh = json.loads((self.folder / "pose.json").read_text())["meshes"][0]
        places = [mesh["positions"][k:k + 3] for k in range(0, len(mesh["positions"]), 3)]
        return [places[index] for index in mesh["indices"]]

    def assert_at(self, model, file, clip, seconds, frame, after=None, fraction=0.0):
        found, wanted = self.corners(file, clip, seconds), model.corners(frame, after, fraction)
        if file == "small.bendy":  # its triangles stand in another order: axis by axis
            found, wanted = ([sorted(axis) for axis in zip(*corners)] for corners in (found, wanted))
        for here, there in zip(found, wanted, strict=True):
            for a, b in zip(here, there):
                self.assertAlmostEqual(a, b, delta=1e-6 * (1 + abs(b)), msg=f"{clip} at {seconds}")

    def test_poses_are_those_of_the_file(self):
        model = Md2(tube_md2(self.folder / "man.md2", player_names()))
        self.done("convert", "man.md2")
        frames = Chunk.read((self.folder / "man.bendy").read_bytes()).find("HEAD/OBJE/VECT/FRMS").write()
        self.assertLess(len(frames), 198 * (40 + 4 * 48), "as small as the model has them")
        self.done("export", "man.bendy", "-o", "man.glb")
        self.done("convert", "man.glb", "-o", "glb.bendy")
        self.done("convert", "man.md2", "--compact", "-o", "small.bendy")
        for file in ("man.bendy", "glb.bendy", "small.bendy"):
            for frame in (0, 3, 5):
                self.assert_at(model, file, "run", frame / 10, 40 + frame)
            self.assert_at(model, file, "run", 0.125, 41, 42, 0.25)
            self.assert_at(model, file, "run", 0.5625, 45, 40, 0.625)  # around
            self.assert_at(model, file, "run", 0.6, 40)
            self.assert_at(model, file, "stand", 3.9375, 39, 0, 0.375)  # to the pool's own shape
            self.assert_at(model, file, "stand", 0.03125, 0, 1, 0.3125)
            self.assert_at(model, file, "death2", 0.4375, 188, 189, 0.375)
            self.assert_at(model, file, "death2", 0.5, 189)

    def test_players_clips(self):
        tube_md2(self.folder / "man.md2", player_names(), sides=3, rings=2)
        self.done("convert", "man.md2")
        tree = json.loads(self.done("dump", "man.bendy"))
        clips = {}
        for chunk in next(chunk["OBJE"] for chunk in tree["HEAD"] if "OBJE" in chunk):
            if "CYCL" not in chunk:
                continue
            leaves = {name: value for child in chunk["CYCL"] for name, value in child.items()}
            play = leaves["PLAY"]["plays"][0]
            clips[leaves["NAME"]] = (play["first"], play["frames"], play["closed"], leaves["CINF"]["loop"], leaves["CINF"]["end"])
        wanted = {"stand": (0, 40, 1), "run": (40, 6, 1), "attack": (46, 8, 0), "pain1": (54, 4, 0), "pain2": (58, 4, 0),
                  "pain3": (62, 4, 0), "jump": (66, 6, 0), "flip": (72, 12, 0), "salute": (84, 11, 0), "taunt": (95, 17, 0),
                  "wave": (112, 11, 0), "point": (123, 12, 0), "crstnd": (135, 19, 1), "crwalk": (154, 6, 1),
                  "crattak": (160, 9, 0), "crpain": (169, 4, 0), "crdeath": (173, 5, 0), "death1": (178, 6, 0),
                  "death2": (184, 6, 0), "death3": (190, 8, 0)}
        self.assertEqual({name: values[:3] for name, values in clips.items()}, wanted)
        for first, frames, closed, loop, end in clips.values():
            self.assertEqual(loop, closed)
            self.assertAlmostEqual(end, (frames if closed else frames - 1) / 10, places=6)

    def test_frames_come_through_everything(self):
        tube_md2(self.folder / "man.md2", player_names()[:60])
        self.done("convert", "man.md2")
        before = (self.folder / "man.bendy").read_bytes()
        self.done("convert", "man.bendy", "-o", "again.bendy")
        self.assertEqual((self.folder / "again.bendy").read_bytes(), before)
        self.done("dump", "man.bendy", "-o", "man.json")
        self.done("assemble", "man.json", "-o", "back.bendy")
        self.assertEqual((self.folder / "back.bendy").read_bytes(), before)
        for options in (["--lod"], ["--compact"], ["--lod", "--compact"]):
            self.done("convert", "man.md2", *options, "-o", "other.bendy")
            self.done("validate", "other.bendy")
            self.done("diff", "man.bendy", "other.bendy", "--tolerance", "0.1mm")
            if options == ["--compact"]:
                self.assertLess((self.folder / "other.bendy").stat().st_size, len(before))
        shown = self.done("inspect", "man.bendy").decode()
        self.assertIn("59 frames of 48 places", shown)
        self.assertIn("6 frames of pool 0 from frame 40, closed", shown)
        self.done("inspect", "man.bendy", "--html", "page.html")

    def test_frames_are_edited(self):
        model = Md2(tube_md2(self.folder / "man.md2", player_names()[:60]))
        self.done("convert", "man.md2")
        self.done("edit", "man.bendy", "-o", "named.bendy", "--rename", "target:run2=stride")
        self.assertIn("stride", json.dumps(json.loads(self.done("dump", "named.bendy"))))
        self.assert_at(model, "named.bendy", "run", 0.1, 41)
        self.done("edit", "man.bendy", "-o", "fewer.bendy", "--strip", "cycle:stand")
        self.assert_at(model, "fewer.bendy", "run", 0.5625, 45, 40, 0.625)
        self.done("edit", "man.bendy", "-o", "none.bendy", "--strip", "cycles")
        self.done("edit", "none.bendy", "-o", "back.bendy", "--merge", "man.bendy")
        self.assert_at(model, "back.bendy", "stand", 3.9375, 39, 0, 0.375)
        tube_md2(self.folder / "other.md2", [f"other{k}" for k in range(60)])
        self.done("convert", "other.md2")
        self.assertIn("animate nothing that is here", self.failed("edit", "other.bendy", "-o", "no.bendy", "--merge", "man.bendy"))
        message = self.failed("edit", "man.bendy", "-o", "no.bendy", "--strip", "target:run2")
        self.assertIn("can only be stripped together", message)
        self.done("edit", "man.bendy", "-o", "still.bendy", "--strip", "targets")
        self.assertNotIn("FRMS", self.done("inspect", "still.bendy").decode())

    def test_what_is_wrong_has_its_byte(self):
        path = md2_file(self.folder / "man.md2")
        path.write_bytes(path.read_bytes()[:150])
        self.assertIn("byte 64: the file is truncated", self.failed("convert", "man.md2", file="man.md2"))


def main():
    global BENDY, SOURCE  # the test cases find them here
    parser = argparse.ArgumentParser()
    parser.add_argument("--bendy", required=True)
    parser.add_argument("--source", required=True, type=Path)
    options, rest = parser.parse_known_args()
    BENDY = os.path.abspath(options.bendy)
    SOURCE = options.source.resolve()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
