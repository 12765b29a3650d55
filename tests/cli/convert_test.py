#!/usr/bin/env python3
"""`bendy convert` of one file: outputs, summaries, linked images, dependency files, skinning, reports.

    convert_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import json
import os
import re
import shutil
import subprocess
import sys
import time
import urllib.parse
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from chunk_file import Chunk  # noqa: E402
from gltf_file import GltfFile, strange_file  # noqa: E402
from program import BENDY, FULL_DISK, SOURCE, Case, main  # noqa: E402

TENTACLE = SOURCE / "examples" / "tentacle.glb"


class Convert(Case):
    def test_the_output_stands_beside_the_input_by_default(self):
        (self.folder / "in").mkdir()
        for name in ("one.glb", "two.v2.glb", "three"):
            shutil.copy(TENTACLE, self.folder / "in" / name)
            self.done("convert", self.folder / "in" / name)
        self.assertEqual(sorted(entry.name for entry in (self.folder / "in").iterdir()),
                         ["one.bendy", "one.glb", "three", "three.bendy", "two.v2.bendy", "two.v2.glb"])
        self.assertEqual(self.files(), ["in"])
        self.assertEqual(self.done("validate", "in/one.bendy", "in/two.v2.bendy", "in/three.bendy"), b"")

    def test_writes_where_it_is_told_and_nothing_else(self):
        (self.folder / "deeper").mkdir()
        self.done("convert", TENTACLE, "-o", "deeper/any.name")
        self.assertEqual([path.name for path in self.folder.rglob("*")], ["deeper", "any.name"])
        self.done("convert", TENTACLE, "--output", "long.bendy")
        self.assertEqual((self.folder / "long.bendy").read_bytes(), (self.folder / "deeper" / "any.name").read_bytes())

    def test_convert_compact(self):
        source = SOURCE / "examples" / "mannequin.glb"
        exact = self.done("convert", source, "-o", "exact.bendy")
        text = self.done("convert", source, "-o", "small.bendy", "--compact").decode()
        self.assertRegex(text, r"total +[\d,]+ +[\d,]+\n")
        self.assertRegex(text, r"error +at most [\d.e-]+ mm; worst measured [\d.e-]+ mm")
        self.assertNotIn(b"at most", exact)
        sizes = {name: (self.folder / f"{name}.bendy").stat().st_size for name in ("exact", "small")}
        self.assertLess(sizes["small"], sizes["exact"] / 2)
        self.done("validate", "small.bendy")
        self.assertIn(b"error at most", self.done("inspect", "small.bendy"))
        self.done("convert", source, "-o", "coarse.bendy", "--max-error", "1mm")
        self.assertLess((self.folder / "coarse.bendy").stat().st_size, sizes["small"])
        for bound, words in (("0.1", "no unit"), ("1in", "unknown unit"), ("-1mm", "not above zero"), ("much", "not an error bound")):
            self.assertIn(words, self.misused("convert", source, "--max-error", bound))

    def test_what_no_material_uses_is_dropped_and_named(self):
        file = GltfFile(nodes=[{"mesh": 0}], scenes=[{"nodes": [0]}], materials=[{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}])
        attributes = {"POSITION": file.add([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0)], "VEC3"),
                      "TEXCOORD_0": file.add([(number / 8, 0) for number in range(6)], "VEC2")}
        file.document["meshes"] = [{"name": "square", "primitives": [{"attributes": attributes, "material": 0}]}]
        source = file.write(self.folder / "square.gltf")
        self.assertIn(b"6 vertices", self.done("convert", source, "-o", "all.bendy"))
        for options in ([], ["--compact"], ["--lod"]):
            done = self.bendy("convert", source, "-o", "used.bendy", "--drop-unused", *options)
            self.assertEqual(done.returncode, 0)
            self.assertIn(b"4 vertices", done.stdout)
            self.assertIn(b"mesh 'square', TEXCOORD_0: texture coordinates that no material uses are left out", done.stderr)
            self.assertIn(b"vertices that differed in nothing else are merged (2 times)", done.stderr)
            self.done("validate", "used.bendy")

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
        self.done("convert", TENTACLE, "-o", "out.bendy")
        self.assertEqual(self.done("validate", "out.bendy"), b"")

    def test_a_bad_input_leaves_no_output_and_an_old_one_untouched(self):
        good = TENTACLE.read_bytes()
        (self.folder / "bad.glb").write_bytes(good[: len(good) // 2])
        self.failed("convert", "bad.glb", file="bad.glb")
        self.assertEqual(self.files(), ["bad.glb"])
        (self.folder / "bad.bendy").write_bytes(b"old")
        self.failed("convert", "bad.glb", "-o", "bad.bendy", file="bad.glb")
        self.assertEqual(self.files(), ["bad.bendy", "bad.glb"])
        self.assertEqual((self.folder / "bad.bendy").read_bytes(), b"old")

    def test_the_input_is_never_overwritten(self):
        source = self.folder / "a.glb"
        shutil.copy(TENTACLE, source)
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
            self.failed("convert", TENTACLE, "-o", output, file=output)
        self.assertEqual(self.files(), ["file", "folder"])

    def test_a_full_disk_leaves_nothing_behind(self):
        (self.folder / "old.bendy").write_bytes(b"old")
        for output in ("old.bendy", "new.bendy"):
            self.failed("convert", TENTACLE, "-o", output, file=output, **FULL_DISK)
        self.assertEqual(self.files(), ["old.bendy"])
        self.assertEqual((self.folder / "old.bendy").read_bytes(), b"old")

    def test_options_are_checked(self):
        self.assertIn("glue", self.misused("convert", "a.glb", "--images", "glue"))
        line = self.failed("convert", TENTACLE, "--scene", "no such scene", "-o", "x")
        self.assertIn("no such scene", line)
        self.assertEqual(self.files(), [])
        self.done("convert", TENTACLE, "--scene", "0", "-o", "x")

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
        self.assertEqual(result.stderr.decode(),
                         "bendy: proposed: legs.gltf: 2 IK chains (LeftLeg, RightLeg), limits of 6 joints (LeftUpLeg, "
                         "RightUpLeg, LeftLeg, RightLeg, LeftFoot and 1 more); --verbose lists them\n")
        self.assertNotIn(b"proposed", result.stdout)
        result = self.bendy("convert", "legs.gltf", "--auto-rig", "--verbose")
        self.assertEqual(result.returncode, 0)
        lines = result.stderr.decode().splitlines()
        self.assertEqual(len(lines), 8)
        self.assertIn("bendy: proposed: legs.gltf: chain LeftLeg: LeftUpLeg > LeftLeg > LeftFoot, two_bone, "
                      "knee points forward", lines)
        self.assertIn("bendy: proposed: legs.gltf: left knee, LeftLeg: hinge about (1.00, 0.00, 0.00), 0 to 135 degrees",
                      lines)
        self.assertTrue(all(line.startswith("bendy: proposed: legs.gltf: ") for line in lines), lines)
        self.assertNotIn(b"proposed", result.stdout)
        self.assertEqual(self.bendy("convert", "legs.gltf", "--auto-rig", "--quiet").stderr, b"")
        for option, count in (("--force", 1), ("--verbose", 8), ("--quiet", 0)):
            lines = self.bendy("convert", "legs.gltf", "--auto-rig", "-o", f"out{option}/", option).stderr.splitlines()
            self.assertEqual(len(lines), count, lines)
            self.assertTrue(all(line.startswith(b"bendy: proposed: legs.gltf: ") for line in lines), lines)
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


class OtherFiles(Case):
    """What a source names is read from its own folder and below it, and from the root."""

    def setUp(self):
        super().setUp()
        (self.folder / "in" / "sub").mkdir(parents=True)
        (self.folder / "secret").write_bytes(b"-----BEGIN A KEY-----")
        (self.folder / "in" / "link.png").symlink_to("../secret")
        (self.folder / "in" / "folder").symlink_to("..")
        (self.folder / "in" / "skin.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(32))

    def write(self, uri, kind="images"):
        file = GltfFile(scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}])
        corners = file.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "VEC3")
        file.document["meshes"] = [{"primitives": [{"attributes": {"POSITION": corners}, "material": 0}]}]
        file.document["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
        file.document["textures"] = [{"source": 0}]
        file.document["images"] = [{"uri": uri if kind == "images" else "skin.png"}]
        path = file.write(self.folder / "in" / "m.gltf")
        if kind == "buffers":
            file.document["buffers"].append({"uri": uri, "byteLength": 4})
            path.write_text(json.dumps(file.document), encoding="utf-8")
        return "in/m.gltf"

    def outside(self):
        secret = self.folder / "secret"
        return ["../secret", "..%2fsecret", "%2e%2e/secret", "sub/../../secret", "link.png", "folder/secret", str(secret),
                secret.as_uri(), "/etc/passwd", "file:///etc/passwd"]

    def test_an_image_outside_stays_a_link(self):
        for uri in self.outside():
            result = self.bendy("convert", self.write(uri), "-o", "m.bendy")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(f"'{uri}' is outside the source's folder: --root FOLDER allows", result.stderr.decode())
            self.assertNotIn(b"A KEY", (self.folder / "m.bendy").read_bytes())
            self.assertNotIn(b"embedded", result.stdout)
            self.assertIn(uri.encode(), (self.folder / "m.bendy").read_bytes())

    def test_a_buffer_outside_is_an_error_in_every_command(self):
        for uri in self.outside():
            self.assertIn(f"'{uri}' is outside the source's folder: --root FOLDER allows",
                          self.failed("convert", self.write(uri, "buffers"), "-o", "m.bendy", "-q"))
            self.assertIn("is outside", self.failed("pose", "in/m.gltf"))
        self.assertIn(b"is outside", self.bendy("convert", "in", "-o", "out", "-q").stderr)

    def test_a_texture_of_an_x_file_too(self):
        (self.folder / "in" / "m.x").write_text(
            'xof 0303txt 0032\nMesh { 3; 0;0;0;, 1;0;0;, 0;1;0;; 1; 3;0,1,2;; MeshMaterialList { 1; 1; 0;; Material { 1;1;1;1;;'
            ' 0; 0;0;0;; 0;0;0;; TextureFilename { "../secret"; } } } }', encoding="ascii")
        result = self.bendy("convert", "in/m.x", "-o", "m.bendy")
        self.assertIn(b"'../secret' is outside the source's folder: --root FOLDER allows", result.stderr)
        self.assertNotIn(b"A KEY", (self.folder / "m.bendy").read_bytes())
        self.assertIn(b"secret", self.done("convert", "in/m.x", "-o", "m.bendy", "--root", "."))
        self.assertIn(b"A KEY", (self.folder / "m.bendy").read_bytes())

    def test_the_root_allows_more(self):
        for uri in self.outside()[:-2]:
            result = self.bendy("convert", self.write(uri), "-o", "m.bendy", "--root", ".")
            self.assertIn(b"embedded file is not an image of a known kind: ", result.stderr)
            self.assertIn(b"A KEY", (self.folder / "m.bendy").read_bytes())
            self.done("convert", self.write(uri, "buffers"), "-o", "m.bendy", "-q", "--root", self.folder)
            self.done("pose", "in/m.gltf", "--root", ".")
        self.done("convert", "in", "-o", "out", "-q", "--root", ".")
        self.assertIn(b"is outside", self.bendy("convert", "in", "-o", "out", "-q").stderr)  # another root is another recipe
        self.assertIn("--root", self.misused("convert", "in", "--root", "none"))

    def test_what_is_embedded_is_named(self):
        self.assertIn("  embedded       in/skin.png (40 bytes, image/png)\n", self.done("convert", self.write("skin.png")).decode())
        report = json.loads(self.done("convert", "in/m.gltf", "--json"))
        self.assertEqual(report["embedded"], [{"file": "in/skin.png", "bytes": 40, "mediaType": "image/png"}])
        self.assertNotIn("embedded", self.done("convert", "in/m.gltf", "--images", "link").decode())


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
        self.done("convert", TENTACLE, "-o", "a #b.bendy", "--depfile", "d")
        self.assertTrue((self.folder / "d").read_text().startswith("a\\ \\#b.bendy: \\\n  /"))

    def test_a_failure_writes_none(self):
        self.failed("convert", "missing.gltf", "-o", "out.bendy", "--depfile", "d", file="missing.gltf")
        self.assertEqual(self.files(), [])
        self.failed("convert", TENTACLE, "-o", "x", "--depfile", "no/d", file="no/d")
        self.failed("convert", TENTACLE, "-o", "x\ny", "--depfile", "d", file="d")

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
        self.write_model()
        result = self.bendy("convert", "m.gltf", "--auto-skin")
        self.assertEqual(result.returncode, 0)
        self.assertEqual(result.stderr.decode(),
                         "bendy: proposed: m.gltf: skin of mesh 'body': 6 vertices bound to 2 joints\n")
        self.assertIn(b"up to 1 influence a vertex", result.stdout)
        self.done("validate", "m.bendy")
        result = self.bendy("convert", "m.gltf", "--skeleton", "High")
        self.assertIn(b"6 vertices bound to 1 joint\n", result.stderr)
        self.assertIn('"Higher"; did you mean "High"?', self.failed("convert", "m.gltf", "--skeleton", "Higher", file="m.gltf"))

    def test_nothing_to_bind_is_a_warning(self):
        result = self.bendy("convert", TENTACLE, "-o", "t.bendy", "--auto-skin")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"no vertices bound: every mesh has a skin", result.stderr)
        self.assertEqual((self.folder / "t.bendy").read_bytes(), self.convert("tentacle").read_bytes())


class Report(Case):
    """`convert --json`; the members are those that docs/convert.md lists."""

    def documented(self):
        text = (SOURCE / "docs" / "convert.md").read_text(encoding="utf-8")
        table = text[text.index("| member |") :].split("\n\n")[0]
        return {name: row.split("|")[2].strip() for row in table.splitlines()[2:]
                for name in re.findall(r"`(\w+)`", row.split("|")[1])}

    def report(self, *arguments, status=0):
        result = self.bendy("convert", "--json", *arguments)
        self.assertEqual(result.returncode, status, result.stderr)
        reports = [json.loads(line) for line in result.stdout.decode().splitlines()]
        documented = self.documented()
        for report in reports:
            for member in report:
                self.assertIn(member, documented)
            for member, when in documented.items():
                is_due = when == "always" or report["status"] in when.split(", ")
                if when in ("with `--compact`", "with levels of detail"):
                    continue
                self.assertEqual(member in report, is_due, (member, report["status"]))
        self.told = result.stderr.decode()
        return reports

    def test_of_a_file(self):
        source = SOURCE / "examples" / "mannequin.glb"
        [report] = self.report(source, "-o", "m.bendy")
        self.assertEqual(self.told, "")
        self.assertEqual((report["status"], report["input"], report["output"]), ("converted", str(source), "m.bendy"))
        self.assertEqual(report["bytes"], (self.folder / "m.bendy").stat().st_size)
        self.assertEqual((report["joints"], report["vertices"], report["materials"]), (65, 4504, 5))
        self.assertEqual([clip["name"] for clip in report["clips"]], ["Idle", "Walk"])
        self.assertGreater(min(clip["seconds"] for clip in report["clips"]), 0)
        self.assertNotIn("compact", report)
        self.assertEqual(self.report(source, "-o", "n.bendy", "--quiet")[0] | {"output": "m.bendy"}, report)

    def test_compact_and_detail(self):
        [report] = self.report(TENTACLE, "-o", "m.bendy", "--max-error", "1mm", "--lod")
        compact = report["compact"]
        self.assertEqual((compact["maxError"], compact["compactBytes"]), (0.001, report["bytes"]))
        self.assertLessEqual(compact["measuredError"], 0.001)
        self.assertEqual(sum(kind["exactBytes"] for kind in compact["kinds"]), compact["exactBytes"])
        self.assertLess(report["fewestTriangles"], report["triangles"])
        [levels] = [kind["compactBytes"] for kind in compact["kinds"] if kind["kind"] == "LODD"]
        root = Chunk.read((self.folder / "m.bendy").read_bytes())
        [chunk] = [chunk for _, chunk in root.walk() if chunk.letters == "LODD"]
        self.assertEqual(levels, 16 + chunk.padded_size())
        shown = self.done("convert", TENTACLE, "-o", "m.bendy", "--max-error", "1mm", "--lod").decode()
        self.assertRegex(shown, rf"(?m)^  levels of detail +[0-9,]+ +{levels:,}$")
        self.assertNotIn("levels of detail", self.done("convert", TENTACLE, "-o", "m.bendy", "--max-error", "1mm").decode())

    def test_warnings_and_proposals(self):
        self.done("export", "-q", self.convert(), "-o", "m.gltf")
        document = json.loads((self.folder / "m.gltf").read_text())
        for part in (document, *document["nodes"]):
            part.pop("extensions", None)  # the rig
        document["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}]
        document["nodes"][0]["camera"] = 0
        (self.folder / "m.gltf").write_text(json.dumps(document))
        [report] = self.report("m.gltf", "-o", "m.bendy", "--auto-rig")
        self.assertEqual(self.told, "")
        self.assertIn(("nodes[0].camera", 1), [(each["place"], each["count"]) for each in report["warnings"]])
        self.assertTrue(report["proposals"])

    def test_errors(self):
        (self.folder / "bad.glb").write_bytes(b"glTF")
        [report] = self.report("bad.glb", status=1)
        self.assertEqual((report["status"], report["output"]), ("failed", "bad.bendy"))
        self.assertEqual(report["error"]["file"], "bad.glb")
        self.assertIn("the GLB header is truncated", report["error"]["message"])
        self.assertIn("bendy: error: bad.glb: the GLB header is truncated", self.told)
        shutil.copy(TENTACLE, self.folder / "a.glb")
        (self.folder / "a.bendy").write_bytes(b"of somebody else")
        [report] = self.report("a.glb", status=1)
        self.assertEqual(report["error"]["file"], "a.bendy")
        self.assertIn("--force", report["error"]["message"])
        [report] = self.report("a.glb", "-o", "no/such/folder", status=1)
        self.assertEqual(report["error"]["file"], "no/such/folder")
        self.assertIn("there is no folder no/such", report["error"]["message"])

    def test_of_a_batch(self):
        (self.folder / "in").mkdir()
        for name in "abc":
            shutil.copy(TENTACLE, self.folder / "in" / f"{name}.glb")
        (self.folder / "in" / "c.glb").write_bytes(b"glTF")
        reports = self.report("in", "-o", "out", status=1)
        self.assertEqual({report["input"]: report["status"] for report in reports},
                         {"in/a.glb": "converted", "in/b.glb": "converted", "in/c.glb": "failed"})
        reports = self.report("in", "-o", "out", status=1)
        self.assertEqual({report["input"]: report["status"] for report in reports},
                         {"in/a.glb": "upToDate", "in/b.glb": "upToDate", "in/c.glb": "failed"})
        shutil.copy(TENTACLE, self.folder / "in" / "a.gltf")
        reports = self.report("in", "-o", "out", status=1)  # nothing is done: two have one output
        self.assertEqual([(report["status"], report["output"]) for report in reports], [("failed", "out/a.bendy")])


if __name__ == "__main__":
    main()
