#!/usr/bin/env python3
"""File names of all letters, in every command; and what goes to standard output, byte by byte.

    file_names_test.py --bendy PROGRAM --source SOURCE_DIR     PROGRAM may be a script that runs it in an emulator
"""

import json
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from program import BENDY, SOURCE, main  # noqa: E402

FOLDER = "狐の模型 é"
NAMES = ("лиса", "狐", "Füchsin é", "\U0001F98A")


def split_glb(glb):
    """A GLB's JSON and binary chunk."""
    size = struct.unpack("<I", glb[12:16])[0]
    return json.loads(glb[20:20 + size]), glb[28 + size:]


class FileNames(unittest.TestCase):
    def setUp(self):
        self.outer = tempfile.TemporaryDirectory()
        self.folder = Path(self.outer.name) / FOLDER
        self.folder.mkdir()

    def tearDown(self):
        self.outer.cleanup()

    def run_in_folder(self, *arguments, status=0):
        result = subprocess.run([BENDY, *map(str, arguments)], cwd=self.folder, capture_output=True, timeout=300, check=False)
        self.assertEqual(result.returncode, status, (arguments, result.stderr.decode(errors="replace")))
        return result

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())

    def put(self, name):
        shutil.copy(SOURCE / "examples" / "tentacle.glb", self.folder / f"{name}.glb")

    def test_convert_inspect_validate_and_pose(self):
        for name in NAMES:
            self.put(name)
            result = self.run_in_folder("convert", f"{name}.glb")
            self.assertTrue(result.stdout.startswith(f"{name}.bendy: ".encode()), result.stdout)
            self.run_in_folder("validate", f"{name}.bendy")
            self.assertIn(f"{name}.bendy: ".encode(), self.run_in_folder("inspect", f"{name}.bendy").stdout)
            self.assertEqual(json.loads(self.run_in_folder("inspect", "--json", f"{name}.bendy").stdout)["file"], f"{name}.bendy")
            self.run_in_folder("pose", f"{name}.bendy", "-o", f"{name}.obj")
            self.assertTrue((self.folder / f"{name}.obj").read_bytes().startswith(b"#"))
        self.assertEqual(self.names(), sorted(f"{name}.{kind}" for name in NAMES for kind in ("glb", "bendy", "obj")))

    def test_a_path_from_elsewhere(self):
        self.put("狐")
        out = self.folder / "из.bendy"
        result = subprocess.run([BENDY, "convert", "-q", self.folder / "狐.glb", "-o", out], cwd=SOURCE, capture_output=True, check=False)
        self.assertEqual(result.returncode, 0)
        self.assertIn(f"warning: {self.folder}/狐.glb: ".encode(), result.stderr)
        self.assertEqual(self.names(), ["из.bendy", "狐.glb"])

    def test_files_beside_a_gltf(self):
        document, binary = split_glb((SOURCE / "examples" / "tentacle.glb").read_bytes())
        document["buffers"][0]["uri"] = "%E7%8B%90 é.bin"
        (self.folder / "狐 é.bin").write_bytes(binary)
        (self.folder / "лиса.gltf").write_text(json.dumps(document, ensure_ascii=False), encoding="utf-8")
        self.run_in_folder("convert", "-q", "лиса.gltf")
        self.put("a")
        self.run_in_folder("convert", "-q", "a.glb")
        self.run_in_folder("diff", "лиса.bendy", "a.bendy")

    def test_export_rig_and_edit(self):
        self.put("狐")
        self.run_in_folder("convert", "-q", "狐.glb", "--auto-rig")
        self.run_in_folder("export", "-q", "狐.bendy", "-o", "вон.gltf")
        self.assertIn("вон.bin", self.names())
        self.run_in_folder("convert", "-q", "вон.gltf", "-o", "назад.bendy")
        self.assertEqual((self.folder / "назад.bendy").read_bytes(), (self.folder / "狐.bendy").read_bytes())
        self.run_in_folder("rig", "狐.bendy", "-o", "骨.rig.json")
        self.run_in_folder("convert", "-q", "狐.glb", "--rig", "骨.rig.json", "-o", "с.bendy")
        self.run_in_folder("edit", "狐.bendy", "-o", "имя.bendy", "--rename-joint", "*=корень 根 *")
        self.assertIn("корень 根".encode(), self.run_in_folder("inspect", "имя.bendy").stdout)

    def test_edit_in_place_with_other_files(self):
        self.put("狐")
        self.run_in_folder("convert", "-q", "狐.glb", "-o", "狐.bendy")
        self.run_in_folder("edit", "狐.bendy", "-o", "бег.bendy", "--rename", "clip:*=далее *")
        (self.folder / "имена.json").write_text('{"*": "x *"}', encoding="utf-8")
        self.run_in_folder("edit", "狐.bendy", "-i", "--merge", "бег.bendy", "--rename-joints", "имена.json")
        self.run_in_folder("validate", "狐.bendy")
        self.assertIn("далее".encode(), self.run_in_folder("inspect", "狐.bendy").stdout)
        result = self.run_in_folder("edit", "狐.bendy", "-i", "--merge", "нет.bendy", status=1)
        self.assertIn("нет.bendy".encode(), result.stderr)

    def test_what_is_not_there_is_named(self):
        for command in ("convert", "inspect", "validate"):
            result = self.run_in_folder(command, "нет.bendy", status=1)
            self.assertIn("нет.bendy".encode(), result.stderr)
            self.assertRegex(result.stderr.decode(), "there is no such file")

    def test_output_is_bytes_as_they_are(self):
        self.put("狐")
        self.run_in_folder("convert", "-q", "狐.glb")
        self.run_in_folder("dump", "狐.bendy", "-o", "狐.json")
        text = (self.folder / "狐.json").read_bytes()
        self.assertEqual(self.run_in_folder("dump", "狐.bendy").stdout, text)
        self.assertNotIn(b"\r", text)
        self.assertNotIn(b"\r", self.run_in_folder("inspect", "狐.bendy").stdout)
        before = (self.folder / "狐.bendy").read_bytes()
        self.run_in_folder("assemble", "狐.json", "-o", "вновь.bendy")
        self.assertEqual((self.folder / "вновь.bendy").read_bytes(), before)

    def test_a_file_is_replaced(self):
        self.put("狐")
        (self.folder / "狐.bendy").write_bytes(b"old")
        result = self.run_in_folder("convert", "-q", "狐.glb", status=1)
        self.assertIn("狐.bendy".encode(), result.stderr)
        self.run_in_folder("convert", "-q", "--force", "狐.glb")
        self.run_in_folder("convert", "-q", "狐.glb")  # its own output
        self.run_in_folder("validate", "狐.bendy")
        self.assertEqual(self.names(), ["狐.bendy", "狐.glb"])


if __name__ == "__main__":
    main()
