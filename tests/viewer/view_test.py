#!/usr/bin/env python3
"""Runs `bendy render` and `bendy view` as a user does, with software rendering.

    view_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]

With BENDY_NEW_PICTURES=1 the reference pictures are written again: look at them before you keep them.
"""

import argparse
import functools
import json
import math
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parent.parent / "cli"),
                str(Path(__file__).parent.parent / "pictures")]
from chunk_file import Chunk  # noqa: E402
from made_files import ALL_MAPS, Made  # noqa: E402
from png_file import read_png, write_png  # noqa: E402
from surfaces_file import surfaces  # noqa: E402

BENDY = ""
SOURCE = Path()
SOFTWARE = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"}


def bendy(*arguments, env=None):
    return subprocess.run([BENDY, *map(str, arguments)], capture_output=True, text=True, timeout=300,
                          env=env or SOFTWARE)


@functools.cache
def prepare():
    """The folder of all classes with the converted examples, and why no picture can be drawn, if none can."""
    folder = Path(tempfile.mkdtemp(prefix="bendy-view-"))
    unittest.addModuleCleanup(shutil.rmtree, folder)
    for name in ("tentacle", "mannequin"):
        done = bendy("convert", SOURCE / f"examples/{name}.glb", "-o", folder / f"{name}.bendy", "-q")
        assert done.returncode == 0, done.stderr
    (folder / "surfaces.gltf").write_text(surfaces(), encoding="utf-8")
    done = bendy("convert", folder / "surfaces.gltf", "-q")
    assert done.returncode == 0, done.stderr
    probe = bendy("render", folder / "tentacle.bendy", "-o", folder / "probe.png", "--size", "8x8")
    return folder, probe.stderr.strip() if "no OpenGL 3.3 here" in probe.stderr else ""


class WithFolder(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder, problem = prepare()
        if problem:
            raise unittest.SkipTest(problem)

    def render(self, name, *arguments, out="out.png"):
        """The picture as read_png gives it."""
        path = self.folder / out
        path.unlink(missing_ok=True)
        done = bendy("render", self.folder / f"{name}.bendy", "-o", path, *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return read_png(path.read_bytes())

    def refused(self, status, text, *arguments):
        out = self.folder / "refused.png"
        done = bendy("render", *arguments, *([] if "-o" in arguments else ["-o", out]))
        self.assertEqual(done.returncode, status, done.stderr)
        self.assertIn(text, done.stderr)
        self.assertFalse(out.exists())


def difference(a, b):
    """Mean difference of a channel, and the share of pixels that differ by more than 24."""
    assert a[:3] == b[:3], (a[:3], b[:3])
    n = a[2]
    apart = [abs(x - y) for x, y in zip(a[3], b[3])]
    far = sum(1 for at in range(0, len(apart), n) if max(apart[at:at + n]) > 24)
    return sum(apart) / len(apart), far / (len(apart) // n)


class Render(WithFolder):
    def test_size_and_default_size(self):
        self.assertEqual(self.render("tentacle")[:2], (1024, 768))
        self.assertEqual(self.render("tentacle", "--size", "100x41")[:2], (100, 41))

    def test_says_which_opengl_draws(self):
        done = bendy("render", self.folder / "tentacle.bendy", "-o", self.folder / "o.png", "--size", "9x9", "-v")
        self.assertRegex(done.stderr, r"^bendy: drawing with EGL [^:]*: .+\n$")

    def test_transparent_background(self):
        width, height, channels, pixels = self.render("tentacle", "--size", "80x60", "--background", "transparent")
        self.assertEqual(channels, 4)
        self.assertEqual(pixels[:4], bytes(4))
        alphas = pixels[3::4]
        self.assertGreater(alphas.count(255), 100)

    def test_background_colour(self):
        pixels = self.render("tentacle", "--size", "80x60", "--background", "#3366cc")[3]
        self.assertTrue(all(abs(a - b) <= 1 for a, b in zip(pixels[:3], (0x33, 0x66, 0xcc))), pixels[:3])

    def test_a_character_beside_another_one(self):
        """Each half is the picture of one of the two alone, at the same time of its own clip."""
        view = ["--size", "80x60", "--clip", "Walk", "--time", "0.3", "--camera", "20,5"]
        width, height, channels, both = self.render("mannequin", *view, "--beside",
                                                    f"{self.folder / 'mannequin.bendy'}:Idle")
        self.assertEqual((width, height), (160, 60))
        row = 80 * channels
        rows = [both[at:at + 2 * row] for at in range(0, len(both), 2 * row)]
        right = self.render("mannequin", *view)
        left = self.render("mannequin", *view[:3], "Idle", *view[4:])
        self.assertEqual(b"".join(line[row:] for line in rows), right[3])
        self.assertEqual(b"".join(line[:row] for line in rows), left[3])
        same = self.render("mannequin", *view, "--beside", self.folder / "mannequin.bendy")[3]
        self.assertEqual(same[:row], same[row:2 * row])
        strip = self.render("mannequin", *view[:4], "--frames", "4", "--beside", self.folder / "mannequin.bendy")
        self.assertEqual(strip[:2], (320, 120))
        self.refused(1, "no clip", self.folder / "mannequin.bendy", *view, "--beside", self.folder / "tentacle.bendy")
        self.refused(1, "gone.bendy", self.folder / "mannequin.bendy", *view, "--beside", "gone.bendy")

    def test_each_option_changes_the_picture(self):
        plain = self.render("mannequin", "--size", "160x120", "--clip", "Walk", "--time", "0.3")
        for option in (["--bones"], ["--axes"], ["--constraints"], ["--wireframe"], ["--camera", "180,10"],
                       ["--camera", "34,11,2"], ["--background", "white"]):
            with self.subTest(option=option):
                other = self.render("mannequin", "--size", "160x120", "--clip", "Walk", "--time", "0.3", *option)
                self.assertGreater(difference(plain, other)[0], 0.1)
        other = self.render("mannequin", "--size", "160x120", "--clip", "Walk", "--time", "0.6")
        self.assertGreater(difference(plain, other)[0], 0.1)

    def test_the_camera_is_about_the_front_of_whoever_has_roles(self):
        glb = (SOURCE / "examples/mannequin.glb").read_bytes()
        length = struct.unpack_from("<I", glb, 12)[0]
        document = json.loads(glb[20:20 + length])
        document["nodes"].append({"children": document["scenes"][0]["nodes"], "rotation": [0, 1, 0, 0]})
        document["scenes"][0]["nodes"] = [len(document["nodes"]) - 1]
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        whole = struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(glb) - 20 - length, len(text), 0x4E4F534A) + text
        (self.folder / "turned.glb").write_bytes(whole + glb[20 + length:])
        self.assertEqual(bendy("convert", self.folder / "turned.glb", "-q").returncode, 0)
        done = bendy("edit", self.folder / "turned.bendy", "-o", self.folder / "nobody.bendy", "--strip", "roles")
        self.assertEqual(done.returncode, 0, done.stderr)
        view = ("--size", "120x160", "--camera", "60,10")
        front = self.render("mannequin", *view)
        self.assertLess(difference(front, self.render("turned", *view))[0], 0.05)
        self.assertGreater(difference(front, self.render("nobody", *view))[0], 0.5)

    def test_full_detail_is_the_default(self):
        one = self.render("mannequin", "--size", "160x120", "--lod", "1")
        self.assertEqual(one, self.render("mannequin", "--size", "160x120"))
        levels = self.folder / "levels.bendy"
        done = bendy("convert", SOURCE / "examples/mannequin.glb", "-o", levels, "-q", "--lod")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotEqual(self.render("levels", "--size", "160x120", "--lod", "0.1"),
                            self.render("levels", "--size", "160x120"))

    def test_levels_that_a_file_has_not_are_said(self):
        for options in (["--lod", "0.5"], ["--lod", "0", "--frames", "2"]):
            done = bendy("render", self.folder / "tentacle.bendy", "-o", self.folder / "o.png", "--size", "16x16", *options)
            self.assertEqual(done.returncode, 0)
            self.assertEqual(done.stderr, f"bendy: warning: {self.folder}/tentacle.bendy: the file has no levels of detail: "
                             "full detail is used (bendy convert --lod makes them)\n")

    def test_contact_sheet(self):
        sheet = self.render("tentacle", "--frames", "5", "--size", "40x30")
        self.assertEqual(sheet[:2], (120, 60))

    def test_empty_cells_of_a_sheet_are_background(self):
        for background, channels, colour in (("white", 3, b"\xff\xff\xff"), ("#3366cc", 3, b"\x33\x66\xcc"),
                                             ("transparent", 4, bytes(4)), (None, 3, None)):
            options = ["--background", background] if background else []
            sheet = self.render("tentacle", "--frames", "5", "--size", "40x30", *options)
            self.assertEqual(sheet[2], channels)
            if colour is None:  # the default: as where a picture shows none of the character
                colour = sheet[3][:channels]
            for y in range(30, 60):
                row = sheet[3][(y * 120 + 80) * channels:(y * 120 + 120) * channels]
                self.assertEqual(row, colour * 40, background)

    def test_a_file_without_a_surface_shows_its_skeleton(self):
        done = bendy("edit", self.folder / "mannequin.bendy", "--strip", "meshes", "-o", self.folder / "none.bendy", "-q")
        self.assertEqual(done.returncode, 0, done.stderr)
        # A mesh whose vertices stay, and of which no triangle is left.
        root = Chunk.read((self.folder / "mannequin.bendy").read_bytes())
        without = [root]
        for chunk in without:
            chunk.children = [child for child in chunk.children if child.letters != "POLY"]
            without += [child for child in chunk.children if child.children]
        (self.folder / "empty.bendy").write_bytes(root.write())
        self.assertEqual(bendy("validate", self.folder / "empty.bendy").stdout, "")
        for name in ("none", "empty"):
            plain = self.render(name, "--size", "200x300", "--clip", "Walk", "--time", "0.3", "--camera", "0,0")
            back = plain[3][:3]
            drawn = [at // 3 for at in range(0, len(plain[3]), 3) if plain[3][at:at + 3] != back]
            rows = [at // 200 for at in drawn]
            self.assertGreater(len(drawn), 300)
            self.assertGreater(max(rows) - min(rows), 170)  # the camera is fitted to it
            self.assertGreater(min(rows), 2)
            self.assertLess(max(rows), 298)
            self.assertEqual(plain, self.render(name, "--size", "200x300", "--clip", "Walk", "--time", "0.3", "--camera",
                                                "0,0", "--bones"))
            sheet = self.render(name, "--size", "60x80", "--clip", "Walk", "--frames", "2")
            left, right = (b"".join(sheet[3][(y * 120 + x) * 3:(y * 120 + x + 60) * 3] for y in range(80)) for x in (0, 60))
            self.assertNotEqual(left, right)

    def test_sources_are_converted_on_the_fly(self):
        self.render("tentacle", "--size", "80x60", "--clip", "Wave", "--time", "0.5")
        out = self.folder / "from_glb.png"
        done = bendy("render", SOURCE / "examples/tentacle.glb", "-o", out, "--size", "80x60", "--clip", "Wave", "--time", "0.5")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(out.read_bytes(), (self.folder / "out.png").read_bytes())
        said = bendy("convert", "-q", SOURCE / "examples/tentacle.glb", "-o", self.folder / "again.bendy").stderr
        self.assertEqual(done.stderr, said)

    def test_maps_that_cannot_be_shown(self):
        """Without its images a surface is plain, and its colour a check; it neither glows nor has bumps."""
        path = Made("metallic_roughness", "normal", "occlusion", "emissive").write(self.folder / "lost.gltf")
        document = json.loads(path.read_text())
        plain = dict(document, images=[])
        plain["materials"] = [{"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 1}}]
        del plain["textures"], plain["images"]
        document["images"] = [{"uri": "data:image/png;base64,AAAA"}] * 4
        pictures = []
        for content, warnings in ((document, 4), (plain, 0)):
            path.write_text(json.dumps(content), encoding="utf-8")
            self.assertEqual(bendy("convert", path, "-q").returncode, 0)
            out = self.folder / "lost.png"
            done = bendy("render", self.folder / "lost.bendy", "-o", out, "--size", "80x60")
            self.assertEqual((done.returncode, done.stderr.count("cannot be shown")), (0, warnings), done.stderr)
            pictures.append(read_png(out.read_bytes()))
        self.assertTrue(pictures[0] == pictures[1])

    def test_bmp_and_tga_textures(self):
        header = bytes((0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 24, 0x20))
        texels = bytes((0, 0, 255) * 2 + (0, 255, 0) * 2)  # blue green red: two red ones over two green ones
        (self.folder / "skin.tga").write_bytes(header + texels)
        bitmap = struct.pack("<2sIHHI", b"BM", 70, 0, 0, 54) + struct.pack("<IiiHHIIiiII", 40, 2, -2, 1, 24, 0, 16, 0, 0, 0, 0)
        (self.folder / "skin.bmp").write_bytes(bitmap + texels[:6] + b"\0\0" + texels[6:] + b"\0\0")
        pictures = []
        for ending in ("tga", "bmp"):
            (self.folder / "square.x").write_text(
                "xof 0303txt 0032 Mesh { 4; 0;0;0;, 1;0;0;, 1;1;0;, 0;1;0;; 1; 4;0,3,2,1;;\n"
                "MeshTextureCoords { 4; 0;1;, 1;1;, 1;0;, 0;0;; }\n"
                'MeshMaterialList { 1; 1; 0; Material { 1;1;1;1;; 0; 0;0;0;; 0;0;0;; TextureFilename { "skin.%s"; } } } }'
                % ending)
            done = bendy("convert", self.folder / "square.x", "-o", self.folder / "square.bendy", "-q")
            self.assertEqual(done.returncode, 0, done.stderr)
            width, height, channels, pixels = self.render("square", "--size", "60x60", "--camera", "0,0")
            upper, lower = (pixels[channels * (y * width + 30):][:3] for y in (18, 42))
            self.assertGreater(upper[0], 2 * upper[1], ending)
            self.assertGreater(lower[1], 2 * lower[0], ending)
            pictures.append(pixels)
        self.assertTrue(pictures[0] == pictures[1])

    def test_the_first_picture_is_as_the_second(self):
        """Textures that are loaded while a material is being set must not change what it has been given before."""
        Made(*ALL_MAPS, stands_still=True).write(self.folder / "maps.gltf")
        self.assertEqual(bendy("convert", self.folder / "maps.gltf", "-q").returncode, 0)
        width, height, channels, pixels = self.render("maps", "--clip", "0", "--frames", "2", "--size", "80x60")
        self.assertEqual((width, height), (160, 60))
        rows = [pixels[channels * width * y:channels * width * (y + 1)] for y in range(height)]
        cells = [b"".join(row[half * 80 * channels:(half + 1) * 80 * channels] for row in rows) for half in (0, 1)]
        self.assertGreater(len(set(cells[0])), 50)
        self.assertEqual(cells[0], cells[1])
        still = self.render("maps", "--clip", "0", "--time", "0", "--size", "80x60")
        self.assertEqual(still[3], cells[1])

    def test_animations(self):
        for ending, start in ((".gif", b"GIF89a"), (".webp", b"RIFF")):
            out = self.folder / f"a{ending}"
            done = bendy("render", self.folder / "tentacle.bendy", "-o", out, "--frames", "4", "--size", "40x30")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertEqual(out.read_bytes()[:len(start)], start)

    def test_a_range_of_frames(self):
        file = self.folder / "tentacle.bendy"
        start = ("render", file, "--clip", "Wave", "--size", "40x30")
        done = bendy(*start, "--frames", "3..5@10", "-o", self.folder / "f_##.png")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(sorted(path.name for path in self.folder.glob("f_*.png")), ["f_03.png", "f_04.png", "f_05.png"])
        for frame in (3, 4, 5):
            one = self.folder / "one.png"
            self.assertEqual(bendy(*start, "--time", str(frame / 10), "-o", one).returncode, 0)
            self.assertEqual(one.read_bytes(), (self.folder / f"f_{frame:02}.png").read_bytes(), frame)
        self.assertEqual(self.render("tentacle", "--clip", "Wave", "--size", "40x30", "--frames", "3..5@10")[:2], (80, 60))
        done = bendy(*start, "--frames", "0..4@10", "-o", self.folder / "r.gif")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        delays = re.findall(rb"\x21\xf9\x04.(..)", (self.folder / "r.gif").read_bytes(), re.DOTALL)
        self.assertEqual([int.from_bytes(delay, "little") for delay in delays], [10] * 5)

    def test_wrong_command_lines(self):
        file = self.folder / "tentacle.bendy"
        for option, text in ((["--size", "0x5"], "--size"), (["--size", "9000x10"], "8192"), (["--size", "5"], "--size"),
                             (["--camera", "1"], "--camera"), (["--camera", "1,2,0"], "--camera"),
                             (["--background", "mauve"], "--background"), (["--lod", "2"], "--lod"),
                             (["--frames", "0"], "--frames"), (["--frames", "1001"], "--frames"), (["--frames", "3x"], "--frames"),
                             (["--frames", "0..1000@9"], "a # in OUT.png makes a file of each"), (["--frames", "2..1@9"], "--frames"),
                             (["--clip", "Wave", "--time", "1", "--frames", "0..1@9"], "--time"),
                             (["--frames", "1000", "--size", "1000x1000"], "--frames"), (["-o", "x.bmp"], "--output"), (["--time", "1"], "--clip"),
                             (["--clip", "Wave", "--time", "nan"], "--time")):
            with self.subTest(option=option):
                self.refused(2, text, file, *option)

    def test_bad_input(self):
        self.refused(1, 'there is no clip "Run"; there are "Reach" and "Wave"', self.folder / "tentacle.bendy", "--clip", "Run")
        self.refused(1, "error: ", self.folder / "missing.bendy")
        bad = self.folder / "bad.bendy"
        bad.write_bytes((self.folder / "tentacle.bendy").read_bytes()[:5000])
        self.refused(1, "bad.bendy: ", bad)
        self.refused(1, "there is no clip for --frames; OUT.png without --frames shows the rest pose", self.folder / "surfaces.bendy", "--frames", "3")

    def test_an_output_that_cannot_be_written(self):
        done = bendy("render", self.folder / "tentacle.bendy", "-o", self.folder / "none/out.png", "--size", "9x9")
        self.assertEqual(done.returncode, 1)

    def test_images_outside_the_files_folder_are_not_read(self):
        gltf = json.loads(surfaces())
        inner = self.folder / "inner"
        inner.mkdir(exist_ok=True)
        png = write_png(1, 1, 3, b"\x20\xff\x20")
        (self.folder / "secret.png").write_bytes(png)
        (inner / "a b.png").write_bytes(png)
        for uri, warning in (("../secret.png", "not read from outside its folder"), ("a%20b.png", "")):
            gltf["images"] = [{"uri": uri}]
            (inner / "links.gltf").write_text(json.dumps(gltf), encoding="utf-8")
            done = bendy("convert", inner / "links.gltf", "--images", "link", "-q")
            self.assertEqual(done.returncode, 0, done.stderr)
            done = bendy("render", inner / "links.bendy", "-o", self.folder / "o.png", "--size", "20x20")
            self.assertEqual(done.returncode, 0)
            self.assertIn(warning, done.stderr)
            self.assertEqual(done.stderr == "", warning == "", done.stderr)

    def test_a_file_whose_link_has_a_control_character_is_refused(self):
        gltf = json.loads(surfaces())
        gltf["images"] = [{"uri": "a%20b.png"}]
        inner = self.folder / "inner"
        inner.mkdir(exist_ok=True)
        (inner / "tab.gltf").write_text(json.dumps(gltf), encoding="utf-8")
        for name in ("a\tb.png", "ab.png"):
            (inner / name).write_bytes(write_png(1, 1, 3, b"\x20\xff\x20"))
        bendy("convert", inner / "tab.gltf", "--images", "link", "-q")
        bendy("dump", inner / "tab.bendy", "-o", inner / "tab.json")
        text = (inner / "tab.json").read_text(encoding="utf-8")
        self.assertEqual(text.count("a%20b.png"), 1)
        (inner / "tab.json").write_text(text.replace("a%20b.png", "a\\tb.png"), encoding="utf-8")
        bendy("assemble", inner / "tab.json", "-o", inner / "tab.bendy", "--allow-invalid")
        done = bendy("validate", inner / "tab.bendy")
        self.assertRegex(done.stdout, r": LINK_CONTROL: .*\(HEAD/TEXT/LINK,")
        done = bendy("render", inner / "tab.bendy", "-o", self.folder / "o.png", "--size", "20x20")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"belongs to a control character.*\(HEAD/TEXT/LINK,")


class Reach(WithFolder):
    """`render` takes what `pose` takes to change a pose after the clip."""

    def draw(self, *arguments, file="mannequin.bendy", out="reach.png"):
        path = self.folder / out
        path.unlink(missing_ok=True)
        done = bendy("render", self.folder / file, "-o", path, "--size", "160x120", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return path.read_bytes(), done.stderr

    @staticmethod
    def red_pixels(png):
        """Places in the colour of targets."""
        width, _, n, pixels = read_png(png)
        return {(at // n % width, at // n // width) for at in range(0, len(pixels), n)
                if pixels[at] > 170 and pixels[at] > 2.1 * max(pixels[at + 1], pixels[at + 2])}

    def test_the_chain_reaches_and_the_target_is_seen(self):
        plain, _ = self.draw()
        self.assertEqual(self.red_pixels(plain), set())
        reached, said = self.draw("--reach", "IK_LeftLeg=0.1,0.3,0.3")
        self.assertRegex(said, r"^bendy: reach: IK_LeftLeg \(moves [^)]+\) reaches its target, to [^\n]*mm\n$")
        self.assertGreater(len(self.red_pixels(reached)), 8)
        other, _ = self.draw("--reach", "IK_LeftLeg=0.1,0.5,0.3")
        self.assertNotEqual(self.red_pixels(reached), self.red_pixels(other))

    def test_the_pose_is_that_of_pose(self):
        # The same joints as `pose` gives, drawn from the same file posed and made a rest pose would be a long way round;
        # what it says of the distance is the solver's own.
        for options in ([], ["--ignore-constraints"], ["--solver", "ccd"], ["--constrain"]):
            goal = ["--clip", "Walk", "--time", "0.3", "--reach", "IK_LeftArm=0.1,1.25,-0.2", *options]
            _, said = self.draw(*goal)
            posed = bendy("pose", self.folder / "mannequin.bendy", *goal)
            self.assertEqual(said, posed.stderr)
            self.assertNotEqual(said, "")

    def test_each_option_changes_the_picture(self):
        pictures = [self.draw(*options)[0] for options in (
            ["--reach", "IK_LeftArm=0.1,1.25,-0.2"], ["--reach", "IK_LeftArm=0.1,1.25,-0.2", "--ignore-constraints"],
            ["--reach", "IK_LeftArm=0.1,1.25,-0.2", "--solver", "pull"], [])]
        self.assertEqual(len(set(pictures)), 4)

    def test_what_falls_short_is_said_and_is_no_failure(self):
        for goal, text in (("IK_LeftArm=3,1.2,0", r"falls short of its target by \d+ mm: it is farther away than the chain is long"),):
            picture, said = self.draw("--reach", goal)
            self.assertRegex(said, rf"^bendy: warning: .*mannequin.bendy: reach: IK_LeftArm \(moves [^)]+\) {text}\n$")
            self.assertGreater(len(self.red_pixels(picture)), 8)  # however far it is, it is in the picture
            done = bendy("pose", self.folder / "mannequin.bendy", "--reach", goal, "-o", self.folder / "short.json")
            self.assertEqual((done.returncode, done.stderr), (0, said))
            (entry,) = json.loads((self.folder / "short.json").read_bytes())["reaches"]
            self.assertEqual(list(entry), ["chain", "target", "distance", "reached"])
            self.assertEqual((entry["chain"], entry["reached"]), ("IK_LeftArm", False))
            self.assertEqual([round(number, 6) for number in entry["target"]], [3, 1.2, 0])
            shown = int(said.partition("target by ")[2].partition(" mm")[0])
            self.assertAlmostEqual(1000 * entry["distance"], shown, delta=0.51)

    def test_an_aim_that_falls_short_is_told_in_degrees(self):
        goal = ["--reach", "IK_LeftArm=1,1.2,-3", "--solver", "aim"]
        _, said = self.draw(*goal)
        self.assertRegex(said, r"^bendy: warning: .*: reach: IK_LeftArm \(moves [^)]+\) falls short of its target by [\d.]+ degrees\n$")
        done = bendy("pose", self.folder / "mannequin.bendy", *goal, "-o", self.folder / "aim.json")
        self.assertEqual((done.returncode, done.stderr), (0, said))
        (entry,) = json.loads((self.folder / "aim.json").read_bytes())["reaches"]
        self.assertEqual(list(entry), ["chain", "target", "distance", "angle", "reached"])
        shown = float(said.partition("target by ")[2].partition(" degrees")[0])
        self.assertAlmostEqual(math.degrees(entry["angle"]), shown, delta=0.51)

    def test_json_of_pose_tells_what_was_reached(self):
        out = self.folder / "reached.json"
        for goal, keys in (("IK_LeftLeg=0.1,0.3,0.3", ["chain", "target", "distance", "reached"]),
                           ("IK_LeftLeg=0.1,0.3,0.3,0,0,0,1",
                            ["chain", "target", "rotation", "distance", "angle", "reached"])):
            done = bendy("pose", self.folder / "mannequin.bendy", "--reach", goal, "--reach", "IK_RightLeg=-0.1,0.2,0.2", "-o", out)
            self.assertEqual(done.returncode, 0, done.stderr)
            document = json.loads(out.read_bytes())
            self.assertEqual(list(document), ["file", "clip", "time", "reaches", "joints", "meshes"])
            first, second = document["reaches"]
            self.assertEqual(list(first), keys)
            self.assertEqual(second["chain"], "IK_RightLeg")
            self.assertTrue(second["reached"])
            self.assertLess(second["distance"], 1e-3)
        bendy("pose", self.folder / "mannequin.bendy", "-o", out)
        self.assertEqual(list(json.loads(out.read_bytes())), ["file", "clip", "time", "joints", "meshes"])

    def test_sheets_and_animations_reach_in_every_frame(self):
        goal = ["--clip", "Walk", "--reach", "IK_LeftArm=0.3,1.2,0.4"]
        sheet, said = self.draw(*goal, "--frames", "3", "--camera", "20,5")
        self.assertRegex(said, r"in all 3 poses|in \d of 3 poses")
        self.assertEqual(said.count("\n"), 1)
        width = 160
        cells = [{(x, y) for x, y in self.red_pixels(sheet) if (x // width, y // 120) == cell}
                 for cell in ((0, 0), (1, 0), (0, 1))]
        places = [{(x % width, y % 120) for x, y in cell} for cell in cells]
        for cell in places:
            self.assertGreater(len(cell), 8)
        middles = [(sum(x for x, _ in cell) / len(cell), sum(y for _, y in cell) / len(cell)) for cell in places]
        for x, y in middles[1:]:  # the camera stands still, and so does the target
            self.assertAlmostEqual(x, middles[0][0], delta=4)
            self.assertAlmostEqual(y, middles[0][1], delta=4)
        for ending in (".gif", ".webp"):
            _, said = self.draw(*goal, "--frames", "2", out="reach" + ending)
            self.assertIn("2 poses", said)

    def test_wrong_requests(self):
        file = self.folder / "mannequin.bendy"
        for options, text in ((["--solver", "ccd"], "--reach"), (["--ignore-constraints"], "--reach"),
                              (["--reach", "IK_LeftArm=1,2"], "--reach"), (["--reach", "IK_LeftArm=0,1,0,0,0,0,3"], "quaternion"),
                              (["--reach", "IK_LeftArm=0,1,0", "--solver", "magic"], "--solver")):
            self.refused(2, text, file, *options)
        self.refused(1, 'there is no IK chain "Tail"', file, "--reach", "Tail=0,1,0")


class Pictures(WithFolder):
    """Small pictures that somebody has looked at. Another driver rounds otherwise: hence the tolerance."""

    def check(self, name, picture):
        reference = Path(__file__).parent / "pictures" / f"{name}.png"
        if os.environ.get("BENDY_NEW_PICTURES"):
            reference.parent.mkdir(exist_ok=True)
            reference.write_bytes((self.folder / "out.png").read_bytes())
        mean, far = difference(picture, read_png(reference.read_bytes()))
        self.assertLess(mean, 1.0, f"mean difference of {name}")
        self.assertLess(far, 0.01, f"share of pixels of {name} that differ")

    def test_tentacle(self):
        self.check("tentacle", self.render("tentacle", "--size", "320x240", "--clip", "Wave", "--time", "0.5"))

    def test_mannequin_with_bones_and_limits(self):
        self.check("mannequin", self.render("mannequin", "--size", "320x240", "--clip", "Walk", "--time", "0.3",
                                            "--bones", "--constraints"))

    def test_a_reach_that_falls_short_over_a_walk(self):
        out = self.folder / "out.png"
        done = bendy("render", self.folder / "mannequin.bendy", "-o", out, "--size", "320x240", "--clip", "Walk", "--time",
                     "0.3", "--reach", "IK_LeftArm=0.75,1.5,0.6", "--bones", "--camera", "20,8")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.check("reach", read_png(out.read_bytes()))

    def test_surfaces(self):
        self.check("surfaces", self.render("surfaces", "--size", "320x240", "--camera", "0,0"))

    def test_surfaces_by_their_colours(self):
        width, height, channels, pixels = self.render("surfaces", "--size", "320x160", "--camera", "0,0")

        def at(column, row, x=0.5, y=0.5):
            left = int(width * 0.5 + (column - 2 + x) * 75)
            top = int(height * 0.5 + (row - 1 + y) * 75)
            place = channels * (top * width + left)
            return pixels[place:place + 3]

        back = pixels[:3]
        red, gold, green, blue = at(0, 0), at(1, 0), at(2, 1), at(3, 1)
        self.assertGreater(red[0], 2 * red[1])
        self.assertGreater(gold[0], gold[2])
        self.assertEqual(at(2, 0, 0.72, 0.72), back)  # masked away
        self.assertEqual(at(3, 0, 0.72, 0.72), back)  # blended away
        self.assertNotEqual(at(3, 0, 0.3, 0.3), back)
        self.assertGreater(green[1], max(green[0], green[2]))  # emissive
        self.assertGreater(blue[2], blue[0])  # the back of a double-sided square


class Window(WithFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        if not shutil.which("Xvfb"):
            raise unittest.SkipTest("Xvfb is not there: no display for the window")
        cls.server = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", "1400x1000x24", "-nolisten", "tcp"],
                                      stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        cls.addClassCleanup(cls.stop_server)
        cls.env = {**SOFTWARE, "DISPLAY": ":" + cls.server.stdout.readline().strip()}
        cls.env.pop("WAYLAND_DISPLAY", None)

    @classmethod
    def stop_server(cls):
        cls.server.terminate()
        cls.server.wait(10)
        cls.server.stdout.close()

    def play(self, *commands, file=None):
        """The state after each command."""
        script = self.folder / "script"
        script.write_text("\n".join(commands) + "\n", encoding="utf-8")
        done = bendy("view", *([file] if file else []), "--script", script, env=self.env)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.stderr = done.stderr
        states = [json.loads(line) for line in done.stdout.splitlines()]
        for state in states:
            self.assertLessEqual(state.get("violation", 0), 1e-5)
        return states

    def test_demo_keys(self):
        states = self.play("wait 0", "key B", "key F", "key I", "key P", "key R", "key T", "key H", "key Esc", "key B")
        self.assertEqual(len(states), 9)  # closed by Esc
        names = ["bones", "forward", "inverse", "paused", "turntable", "wireframe"]
        self.assertTrue(states[0]["demo"])
        for name in names:
            self.assertFalse(states[0][name], name)
        for number, name in enumerate(names, 1):
            self.assertTrue(states[number][name], name)
            self.assertFalse(states[number - 1][name], name)
        self.assertFalse(states[3]["forward"])
        self.assertTrue(states[0]["help"])
        self.assertFalse(states[7]["help"])
        self.assertTrue(states[8]["quits"])

    def test_demo_moves_the_target_as_it_is_seen_and_it_pulls(self):
        # As it stands, after the turntable, after orbiting with the mouse, and from high above.
        for turn in ((), ("key R", "wait 2.5", "key R"), ("drag 900 700 300 700",), ("drag 900 300 700 650",),
                     ("drag 900 300 100 200", "key R", "wait 1", "key R")):
            states = self.play(*turn, "key I", "key Left", "key Up", "key Right", "key Down", "key PgDn", "key PgUp")[len(turn):]
            places = [state["targets"][0]["pixels"] for state in states]
            for before, after, axis, sign in zip(places, places[1:], (0, 1, 0, 1), (-1, -1, 1, 1)):
                self.assertGreater(sign * (after[axis] - before[axis]), 3, turn)
                self.assertLess(abs(after[1 - axis] - before[1 - axis]), 2, turn)
            away = [self.depth(state) for state in states]
            self.assertLess(away[5], away[4] - 1e-3, turn)  # PgDn: nearer
            self.assertGreater(away[6], away[5] + 1e-3, turn)
        pulled = self.play("key I", "key Left", "key Up", "key PgDn", "hold Down 0.5", "wait 6", "wait 0")[5]
        target = pulled["targets"][0]
        self.assertLess(sum((a - b) ** 2 for a, b in zip(target["tip"], target["position"])) ** 0.5, 0.05)

    @staticmethod
    def depth(state):
        """Of the target, along the direction in which the camera looks."""
        yaw, pitch = state["yaw"], state["pitch"]
        outwards = (math.sin(yaw) * math.cos(pitch), math.sin(pitch), math.cos(yaw) * math.cos(pitch))
        return -sum(a * b for a, b in zip(state["targets"][0]["position"], outwards))

    def test_demo_moves_the_tentacle_by_hand(self):
        for turn in ((), ("key R", "wait 2", "key R"), ("drag 900 700 300 700",)):
            states = self.play(*turn, "key F", "wait 1", "hold Right 0.6", "wait 0.1", "hold Left 1.2", "wait 0.1")[len(turn):]
            tips = [state["targets"][0]["tip_pixels"] for state in states]
            self.assertGreater(tips[3][0], tips[1][0] + 10, turn)
            self.assertLess(tips[5][0], tips[1][0] - 10, turn)

    def test_demo_bends_one_joint_by_hand(self):
        for turn in ((), ("key R", "wait 2.5", "key R"), ("drag 900 700 300 700",)):
            states = self.play(*turn, "key Tab", "wait 1", "key Tab", "key Tab", "hold Left 0.1", "wait 0", "hold Right 0.2",
                               "key Shift+Tab", "key Shift+Tab", "key Shift+Tab", "key Shift+Tab")[len(turn):]
            self.assertEqual([state["joint"] for state in states],
                             ["seg_01", "seg_01", "seg_02", *["seg_03"] * 4, "seg_02", "seg_01", "", "seg_09"])
            self.assertTrue(states[0]["forward"])
            before, bent, back = states[3], states[5], states[6]
            joints = [[link["position"] for link in state["links"]] for state in (before, bent)]
            self.assertEqual(joints[0][:3], joints[1][:3])  # up to seg_03 nothing moves
            for here, there in zip(joints[0][3:], joints[1][3:]):
                self.assertNotEqual(here, there)
            tips = [state["targets"][0]["tip_pixels"][0] for state in (before, bent, back)]
            self.assertLess(tips[1], tips[0] - 5)
            self.assertGreater(tips[2], tips[1] + 5)

    def test_demo_shows_the_chosen_joint(self):
        first, second = self.folder / "joint2.png", self.folder / "joint5.png"
        self.play("key Tab", "wait 1", "key Tab", f"picture {first}", "key Tab", "key Tab", "key Tab", f"picture {second}")
        marks = []
        for path in (first, second):
            width, _, n, pixels = read_png(path.read_bytes())
            rows = [at // n // width for at in range(0, len(pixels), n)
                    if pixels[at] > 200 and 130 < pixels[at + 1] < 235 and pixels[at + 2] < 110]
            self.assertGreater(len(rows), 60)
            marks.append(sum(rows) / len(rows))
        self.assertLess(marks[1], marks[0] - 40)  # further up the tentacle

    def test_a_file_without_a_surface_shows_its_bones(self):
        source = json.loads((SOURCE / "tests/seeds/rope.gltf").read_text(encoding="utf-8"))
        for key in ("meshes", "skins"):
            source.pop(key, None)
        for node in source["nodes"]:
            for key in ("mesh", "skin"):
                node.pop(key, None)
        (self.folder / "bare.gltf").write_text(json.dumps(source), encoding="utf-8")
        states = self.play("wait 0", "key B", f"drop {self.folder / 'tentacle.bendy'}", file=self.folder / "bare.gltf")
        self.assertEqual([state["bones"] for state in states], [True, False, False])

    def test_files_of_other_kinds_are_named(self):
        fbx = self.folder / "a.fbx"
        fbx.write_bytes(b"Kaydara FBX Binary  " + bytes(20))
        state, = self.play(f"drop {fbx}", file=self.folder / "tentacle.bendy")
        self.assertIn("is an FBX file, which bendy does not read: export it", state["message"])
        for name, text in ((fbx, "is an FBX file"), (self.folder, "is a folder, not a file"),
                           (self.folder / "missing.glb", "there is no such file")):
            done = bendy("view", name, env=self.env)
            self.assertEqual(done.returncode, 1)
            self.assertTrue(done.stderr.startswith(f"bendy: error: {name}: {text}"), done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1)

    def test_a_file_with_numbers_that_are_none_is_refused(self):
        tree = Chunk.read((self.folder / "tentacle.bendy").read_bytes())
        chunk = next(chunk for _, chunk in tree.walk() if chunk.letters == "KEYV")
        chunk.payload = struct.pack("<f", math.nan) + chunk.payload[4:]
        bad = self.folder / "nan.bendy"
        bad.write_bytes(tree.write())
        state, = self.play(f"drop {bad}", file=self.folder / "tentacle.bendy")
        self.assertRegex(state["message"], r"element 0 is not a finite number \(HEAD/OBJE/CYCL/KEYV, offset \d+\)$")
        done = bendy("view", bad, env=self.env)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, rf"^bendy: error: {bad}: element 0 is not a finite number \(HEAD/OBJE/CYCL/KEYV, offset \d+\)\n$")

    def test_demo_turntable_and_animation(self):
        states = self.play("wait 0", "wait 0.5", "key R", "wait 0.5", "key P", "wait 0.5")
        self.assertAlmostEqual(states[1]["time"], 0.5, places=2)
        self.assertEqual(states[0]["yaw"], states[1]["yaw"])
        self.assertAlmostEqual(states[3]["yaw"] - states[2]["yaw"], 0.4, places=2)
        self.assertEqual(states[4]["time"], states[5]["time"])

    def test_demo_picture(self):
        out = self.folder / "demo.png"
        self.play("key B", "key I", f"picture {out}")
        width, height, _, pixels = read_png(out.read_bytes())
        self.assertEqual((width, height), (1280, 800))
        self.assertGreater(len(set(zip(pixels[0::3], pixels[1::3], pixels[2::3]))), 200)

    def test_a_target_is_dragged_with_the_mouse(self):
        first, = self.play("wait 0", file=self.folder / "mannequin.bendy")
        number, target = next((k, t) for k, t in enumerate(first["targets"]) if t["pixels"][0] > 500)
        x, y, _ = target["pixels"]
        state, = self.play(f"drag {x} {y} {x + 40} {y - 30}", file=self.folder / "mannequin.bendy")
        moved = state["targets"][number]
        self.assertTrue(moved["on"])
        self.assertAlmostEqual(moved["pixels"][0], x + 40, delta=1.5)
        self.assertAlmostEqual(moved["pixels"][1], y - 30, delta=1.5)
        self.assertEqual(state["yaw"], first["yaw"])

    def test_mouse_orbits_and_keys_toggle(self):
        states = self.play("wait 0", "drag 700 740 760 740", "key B", "key C", "key X", "key T", "key P", "key R", "key Esc",
                           file=self.folder / "mannequin.bendy")
        self.assertNotEqual(states[0]["yaw"], states[1]["yaw"])
        for number, name in enumerate(("bones", "constraints", "axes", "wireframe", "paused", "turntable", "quits"), 2):
            self.assertTrue(states[number][name], name)
            self.assertFalse(states[number - 1][name], name)

    def test_dropped_files_open(self):
        states = self.play(f"drop {SOURCE / 'examples/mannequin.glb'}", f"drop {self.folder / 'tentacle.bendy'}",
                           f"drop {self.folder / 'missing.glb'}", f"drop {self.folder / 'script'}", "wait 0.1")
        self.assertEqual([state["title"] for state in states], ["mannequin.glb"] + 4 * ["tentacle.bendy"])
        self.assertFalse(states[0]["demo"])
        self.assertIn("missing.glb", states[2]["message"])
        self.assertNotEqual(states[3]["message"], "")

    def test_standard_input_opens(self):
        script = self.folder / "script"
        script.write_text("wait 0.1\n", encoding="utf-8")
        for name in (SOURCE / "examples/tentacle.glb", self.folder / "tentacle.bendy"):
            with open(name, "rb") as stream:
                done = subprocess.run([BENDY, "view", "-", "--script", script], stdin=stream, capture_output=True,
                                      text=True, timeout=300, env=self.env)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertFalse(json.loads(done.stdout.splitlines()[0])["demo"])

    def test_real_keys(self):
        if not shutil.which("xdotool"):
            self.skipTest("xdotool is not there: no real keys")
        with subprocess.Popen([BENDY, "view", "--trace"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              env=self.env) as program:
            try:
                self.assertFalse(json.loads(program.stdout.readline())["bones"])

                def tool(*arguments):
                    subprocess.run(["xdotool", *arguments], env=self.env, check=True, timeout=60,
                                   stdout=subprocess.DEVNULL)

                tool("search", "--sync", "--onlyvisible", "--name", "Bendy")
                tool("mousemove", "600", "400")
                for key, name in (("b", "bones"), ("t", "wireframe"), ("i", "inverse"), ("r", "turntable")):
                    tool("key", key)
                    self.assertTrue(json.loads(program.stdout.readline())[name], name)
                before = json.loads(self.press(tool, program, "Left"))["targets"][0]["pixels"]
                after = json.loads(self.press(tool, program, "Left"))["targets"][0]["pixels"]
                self.assertLess(after[0], before[0])
                tool("key", "Escape")
                self.assertTrue(json.loads(program.stdout.readline())["quits"])
                self.assertEqual(program.wait(30), 0)
                self.assertEqual(program.stderr.read(), "")
            finally:
                program.kill()

    @staticmethod
    def press(tool, program, key):
        tool("key", key)
        return program.stdout.readline()

    def test_what_cannot_be_shown(self):
        done = bendy("view", self.folder / "missing.bendy", env=self.env)
        self.assertEqual(done.returncode, 1)
        self.assertIn("missing.bendy", done.stderr)
        done = bendy("view", env={**SOFTWARE, "DISPLAY": ":987", "WAYLAND_DISPLAY": ""})
        self.assertEqual(done.returncode, 1)
        self.assertIn("no display", done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)


def main():
    global BENDY, SOURCE
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bendy", required=True)
    parser.add_argument("--source", type=Path, required=True)
    arguments, rest = parser.parse_known_args()
    BENDY, SOURCE = str(Path(arguments.bendy).resolve()), arguments.source.resolve()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
