#!/usr/bin/env python3
"""`bendy convert` of several files and folders.

    convert_batch_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import contextlib
import json
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from program import BENDY, SOURCE, Case, main  # noqa: E402


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
        uri = path.stem.replace("\x1b", "%1b")  # a URI has no control characters
        path.parent.mkdir(parents=True, exist_ok=True)
        path.with_suffix(".bin").write_bytes(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
        path.with_suffix(".png").write_bytes(b"\x89PNG\r\n\x1a\n" + place.encode())
        path.write_text(json.dumps({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"name": place, "mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
            "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
            "textures": [{"source": 0}], "images": [{"uri": uri + ".png"}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": uri + ".bin"}]}))
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
        self.assertIn("in/bad.glb: the GLB header is truncated", told[0])
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


if __name__ == "__main__":
    main()
