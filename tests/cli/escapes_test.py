#!/usr/bin/env python3
"""Text from files, where the program shows it and where it writes it for another program: nothing in it does more than be
read.

    escapes_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import time
import unicodedata
import unittest
import urllib.parse
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from gltf_file import GltfFile  # noqa: E402
from program import BENDY, Case, main  # noqa: E402

# Every letter of Unicode that controls, separates lines or paragraphs, or turns the direction of writing.
FORBIDDEN = {chr(c) for c in range(0x110000) if unicodedata.category(chr(c)) in ("Cc", "Zl", "Zp")
             or unicodedata.bidirectional(chr(c)) in ("LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI")}
FORBIDDEN |= {"\u200e", "\u200f", "\u061c"}
EVIL = "".join(sorted(FORBIDDEN - {"\0"})) + "]0;PWNED</script>\"'\\"
SHOWN = ("狐", "é", "👩‍👧", "اب")  # letters that stay


def evil_file(path):
    file = GltfFile(scenes=[{"nodes": [0], "name": EVIL}], extensionsUsed=[EVIL], images=[{"uri": EVIL, "name": EVIL}],
                    textures=[{"source": 0, "name": EVIL}],
                    materials=[{"name": EVIL, "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
                                "extensions": {EVIL: {EVIL: EVIL}}}],
                    nodes=[{"name": EVIL, "children": [1, 2], "extras": {EVIL: EVIL}}, {"name": "".join(SHOWN) + EVIL, "mesh": 0},
                           {"name": "n" * 100_000, "camera": 0}],
                    cameras=[{"name": EVIL, "type": EVIL}])
    file.document["asset"] |= {"generator": EVIL, "copyright": EVIL}
    corners = file.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "VEC3")
    file.document["meshes"] = [{"name": EVIL, "extras": {"targetNames": [EVIL]}, "weights": [0.5], "primitives": [
        {"attributes": {"POSITION": corners, "_" + EVIL: corners}, "material": 0, "targets": [{"POSITION": corners}]}]}]
    times = file.add([(0.5,), (1.5,)], "SCALAR")
    values = file.add([(0, 0, 0), (4, 0, 0)], "VEC3")
    file.document["animations"] = [{"name": EVIL, "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                                    "samplers": [{"input": times, "output": values}]}]
    return file.write(path)


class Shown(Case):
    def setUp(self):
        super().setUp()
        evil_file(self.folder / "a.gltf")
        self.bendy("convert", "a.gltf")
        (self.folder / "b.gltf").write_text((self.folder / "a.gltf").read_text().replace("4.0", "5.0"))
        self.bendy("convert", "b.gltf", "--auto-rig")
        self.assertEqual(self.files(), ["a.bendy", "a.gltf", "b.bendy", "b.gltf"])

    def expect_text(self, arguments, sent):
        text = sent.decode()  # is UTF-8
        self.assertEqual(set(text) & FORBIDDEN - {"\n"}, set(), (arguments, text[:2000]))
        return text

    def said(self, *arguments, **options):
        result = self.bendy(*arguments, **options)
        self.assertIn(result.returncode, (0, 1, 2), arguments)
        out = self.expect_text(arguments, result.stdout)
        for line in (out + self.expect_text(arguments, result.stderr)).splitlines():
            if not line.startswith((" ", "{", '"')):
                self.assertLess(len(line), 3000, arguments)
        return out

    def test_no_command_shows_more_than_letters(self):
        (self.folder / "wrong.json").write_text(json.dumps({EVIL: 1}))
        (self.folder / "wrong.gltf").write_text((self.folder / "a.gltf").read_text().replace('"bufferView": 0', '"bufferView": 9'))
        for line in (("convert", "a.gltf"), ("convert", "a.gltf", "--auto-rig", "--auto-skin", "--compact"),
                     ("convert", "wrong.gltf"), ("convert", "a.gltf", "--rig", "wrong.json", "-o", "c.bendy"),
                     ("convert", "a.gltf", "b.gltf", "-o", "out"), ("convert", "a.gltf", "--scene", EVIL),
                     ("inspect", "a.bendy"), ("inspect", "a.bendy", "--chunk", EVIL), ("validate", "a.bendy"),
                     ("diff", "a.bendy", "b.bendy"), ("diff", "a.bendy", "b.bendy", "--tolerance", "1mm"),
                     ("rig", "a.bendy", "-o", "a.rig.json"), ("edit", "a.bendy", "-o", "e.bendy", "--strip", "clips"),
                     ("edit", "a.bendy", "-o", "e.bendy", "--merge", "b.bendy"), ("edit", "a.bendy", "-o", "e.bendy", "--extract", EVIL),
                     ("edit", "a.bendy", "-o", "e.bendy", "--rename-joint", "*=x*"),
                     ("edit", "a.bendy", "-o", "e.bendy", "--rename-joints", "wrong.json"),
                     ("export", "a.bendy", "-o", "x.glb", "--force"), ("export", "a.bendy", "-o", "x.x", "--force"),
                     ("pose", "a.bendy", "--clip", "none"), ("pose", "a.bendy", "--clip", EVIL), ("pose", "a.bendy"),
                     ("pose", "a.bendy", "--reach", EVIL + "=1,2,3"), ("bench", "a.bendy", "--rounds", "1"),
                     ("render", "a.bendy", "-o", "a.png", "--size", "8x8"), ("assemble", "wrong.json", "-o", "w.bendy")):
            with self.subTest(line=line[:4]):
                self.said(*line)
        self.assertIn("".join(SHOWN), self.said("inspect", "a.bendy").replace("\\u200d", "\u200d"))

    def test_json_has_the_same_text_and_shows_letters_only(self):
        for line in (("inspect", "a.bendy", "--json"), ("validate", "a.bendy", "--json"), ("diff", "a.bendy", "b.bendy", "--json"),
                     ("convert", "a.gltf", "--json"), ("bench", "a.bendy", "--json", "--rounds", "1")):
            with self.subTest(line=line):
                said = self.said(*line)
                self.assertTrue(json.loads(said))
                if line[0] == "inspect":
                    self.assertTrue(any(EVIL in text for text in texts_in(json.loads(said))))

    def test_a_terminal_gets_results_that_show_letters_only(self):
        for line in (("dump", "a.bendy"), ("rig", "b.bendy"), ("pose", "a.bendy")):
            with self.subTest(line=line):
                status, sent = on_terminal(self.folder, *line)
                self.assertEqual(status, 0)
                self.expect_text(line, re.sub(rb"\r\x1b\[K|\r[^\r\n]*(?=\r[^\n])", b"", sent).replace(b"\r\n", b"\n"))
        status, sent = on_terminal(self.folder, "dump", "a.bendy")
        start = sent.index(b"{")
        self.done("dump", "a.bendy", "-o", "a.json")
        self.assertEqual(json.loads(sent[start:].replace(b"\r\n", b"\n")), json.loads((self.folder / "a.json").read_bytes()))

    def test_bytes_that_are_not_utf8(self):
        name = b"\xff\xc0\x80\xed\xa0\x80.bendy"
        shutil.copy(self.folder / "a.bendy", os.fsencode(self.folder) + b"/" + name)
        self.assertIn("\\xff\\xc0\\x80\\xed\\xa0\\x80.bendy: ", self.said("inspect", name))
        self.assertIn("\\xff", self.said("validate", name, "--json").replace("\ufffd", "\\xff"))

    def test_a_line_of_obj_ends_where_it_ends(self):
        file = GltfFile(scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}])
        corners = file.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "VEC3")
        file.document["meshes"] = [{"name": "a\nv 9 9 9\\", "primitives": [{"attributes": {"POSITION": corners}}]}]
        file.write(self.folder / "m.gltf")
        self.done("convert", "m.gltf", "-q")
        lines = self.done("pose", "m.bendy").decode().splitlines()
        self.assertIn("o a\\x0av 9 9 9\\ ", lines)
        self.assertEqual(sum(line.startswith("v ") for line in lines), 3)

    def test_a_suggested_command_is_one_command(self):
        for name in ("a b.gltf", "a';touch x;'.gltf", "$(touch x).gltf", "`touch x`.gltf", 'a"b.gltf', "a\\b.gltf", "a!b.gltf", "~a.gltf"):
            with self.subTest(name=name):
                shutil.copy(self.folder / "a.gltf", self.folder / name)
                self.assertIn(b"bendy", self.bendy("inspect", name).stderr)
                result = self.bendy("convert", name, "-o", f"{name}.fbx")
                self.assertEqual(result.returncode, 2)
                command = result.stderr.decode().splitlines()[0].split(": ")[-1]
                words = [word for word in shlex.split(command) if word != "&&"]
                self.assertEqual((words[0], words[2]), ("bendy", name), command)


def texts_in(value):
    """All texts in a JSON value."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, (list, dict)):
        for part in value.values() if isinstance(value, dict) else value:
            yield from texts_in(part)


def on_terminal(folder, *arguments):
    """Exit status, and what a terminal on standard output was sent."""
    ours, its = os.openpty()
    process = subprocess.Popen([BENDY, *arguments], cwd=folder, stdout=its, stderr=subprocess.DEVNULL,
                               env={**os.environ, "TERM": "xterm", "NO_COLOR": "1"})
    os.close(its)
    sent = b""
    try:
        while piece := os.read(ours, 65536):
            sent += piece
    except OSError:  # Linux says so at the end
        pass
    os.close(ours)
    return process.wait(timeout=300), sent


# What Make or Ninja would take for something else.
REFUSED = (";", "|", "&", "<", ">", "*", "?", "[", "=", "'", '"', "`", "^", "\n", "\t", "\x01")
WRITTEN = (" ", "#", "$", "%", ":", "+", ",", "@", "!", "{", "}", "(", ")", "]", "é", "狐")


class Depfiles(Case):
    def write_model(self, image):
        """A model that names an image, and that image."""
        file = GltfFile(scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}], textures=[{"source": 0}],
                        images=[{"uri": urllib.parse.quote(image)}],
                        materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])
        corners = file.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "VEC3")
        file.document["meshes"] = [{"primitives": [{"attributes": {"POSITION": corners}, "material": 0}]}]
        file.write(self.folder / "m.gltf")
        (self.folder / image).write_bytes(b"\x89PNG\r\n\x1a\n")

    def names(self, letters):
        for letter in letters:
            yield from (f"a{letter}b.png", f"{letter}b.png", f"a{letter}")

    def test_a_name_that_would_be_read_otherwise_is_refused(self):
        for name in (*self.names(REFUSED), "a;touch${IFS}PWNED;.png", "a \\", "a\\", "a:", "a ", "a(b)", "a\\:b", "x|touch y", "~root", "~a.png"):
            with self.subTest(name=name):
                self.write_model(name)
                line = self.failed("convert", "m.gltf", "-o", "m.bendy", "--depfile", "m.d", file="m.d")
                self.assertIn("cannot hold the file name", line)
                self.assertEqual({"m.bendy", "m.d"} & set(self.files()), set())  # neither of them
                (self.folder / name).unlink()
        self.write_model("a.png")
        for target in ("a;b.bendy", "a%b.bendy", "x\ny.bendy"):
            self.failed("convert", "m.gltf", "-o", target, "--depfile", "m.d", file="m.d")

    def test_make_and_ninja_read_the_names_that_are_written(self):
        (self.folder / "Makefile").write_text(f"make.bendy: m.gltf\n\t@{BENDY} convert m.gltf -o $@ --depfile make.d -q\n-include make.d\n")
        (self.folder / "build.ninja").write_text(
            f"rule convert\n  command = {BENDY} convert $in -o $out --depfile $out.d -q\n"
            "  depfile = $out.d\n  deps = gcc\nbuild ninja.bendy: convert m.gltf\n")
        names = [name for name in self.names(WRITTEN) if not name.endswith((" ", ":"))] + ["a~", "a\\b.png", "a\\ b.png", "a (1).png"]
        for tool in ("make", "ninja"):
            if not shutil.which(tool):
                continue
            output = self.folder / f"{tool}.bendy"
            for name in names:
                with self.subTest(tool=tool, name=name):
                    self.write_model(name)
                    self.expect_rebuilt(tool, output, name)

    def expect_rebuilt(self, tool, output, name):
        """The tool makes the output again when the image has changed, and only then."""
        def is_made_again():
            before = output.stat().st_mtime_ns if output.exists() else None
            result = subprocess.run([tool], cwd=self.folder, check=False, capture_output=True, timeout=120)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            return output.stat().st_mtime_ns != before

        is_made_again()
        self.assertFalse(is_made_again())
        later = output.stat().st_mtime_ns + 10_000_000
        os.utime(self.folder / name, ns=(later, later))
        time.sleep(0.02)
        self.assertEqual([is_made_again(), is_made_again()], [True, False])

    def test_two_outputs_are_one_change(self):
        self.write_model("a.png")
        (self.folder / "m.bendy").write_bytes(b"old")
        (self.folder / "m.d").mkdir()
        self.failed("convert", "m.gltf", "-o", "m.bendy", "--depfile", "m.d", file="m.d")
        self.assertEqual((self.folder / "m.bendy").read_bytes(), b"old")
        self.assertEqual(self.files(), ["a.png", "m.bendy", "m.d", "m.gltf"])


if __name__ == "__main__":
    unittest.TestCase.maxDiff = None
    main()
