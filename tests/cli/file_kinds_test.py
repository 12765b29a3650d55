#!/usr/bin/env python3
"""Gives every command every kind of file: what it reads it takes, and of all else it says what it is and what to do.

    file_kinds_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from bvh_file import walk  # noqa: E402
from md2_file import md2_file  # noqa: E402
from program import BENDY, SOURCE, has_viewer, main  # noqa: E402

# Each command with IN where a file goes, once for each place where one goes; GOOD is a bendy file.
COMMANDS = {
    "convert": (["convert", "-q", "IN", "-o", "OUT.bendy"],),
    "inspect": (["inspect", "IN"], ["inspect", "IN", "--json"], ["inspect", "IN", "--html", "OUT.html"]),
    "validate": (["validate", "IN"],),
    "pose": (["pose", "IN", "-o", "OUT.obj"],),
    "render": (["render", "IN", "--size", "16x16", "-o", "OUT.png"],),
    "rig": (["rig", "IN", "-o", "OUT.json"],),
    "diff": (["diff", "IN", "GOOD"], ["diff", "GOOD", "IN"], ["diff", "IN", "GOOD", "--tolerance", "1mm"],
             ["diff", "GOOD", "IN", "--tolerance", "1mm"]),
    "dump": (["dump", "IN", "-o", "OUT.json"],),
    "assemble": (["assemble", "IN", "-o", "OUT.bendy"],),
    "edit": (["edit", "IN", "-o", "OUT.bendy", "--strip", "textures"],
             ["edit", "GOOD", "-o", "OUT.bendy", "--merge", "IN"]),
    "export": (["export", "-q", "IN", "-o", "OUT.glb"],),
    "bench": (["bench", "IN", "--rounds", "1"],),
    "view": (),  # needs a display: tests/viewer/view_test.py
}
HAS_VIEWER = has_viewer()
CONVERTS = {"convert", "pose", "render", "inspect", "validate", "diff", "edit"}  # take what `convert` reads

# Files that `convert` reads, with what they are called.
SOURCES = {"fox.glb": "a glTF binary file", "rope.gltf": "a glTF file", "named.bin": "a glTF binary file",
           "tentacle.x": "a DirectX X-file", "tris.md2": "a Quake II model", "walk.bvh": "a BVH file", "with space.glb": "a glTF binary file"}

FBX = "export it as glTF 2.0 from Blender (File > Import > FBX, then File > Export > glTF 2.0), or convert it with FBX2glTF"
# Files that nothing of ours reads: content, what they are called, and a part of the way in.
FOREIGN = {
    "a.fbx": (b"Kaydara FBX Binary  \0\x1a\0" + bytes(40), "an FBX file", FBX),
    "named_otherwise": (b"Kaydara FBX Binary  \0\x1a\0" + bytes(40), "an FBX file", FBX),
    "text.FBX": (b"; FBX 7.3.0 project file\n; Copyright\n", "an FBX file", FBX),
    "a.usda": (b"#usda 1.0\n(\n)\n", "a USD file", "Universal Scene Description"),
    "a.usdc": (b"PXR-USDC" + bytes(80), "a USD file", "Universal Scene Description"),
    "a.usdz": (b"PK\3\4" + bytes(80), "a USD file", "Universal Scene Description"),
    "a.usd": (b"PXR-USDC" + bytes(80), "a USD file", "glTF 2.0"),
    "a.blend": (b"BLENDER-v300" + bytes(80), "a Blender file", "open it in Blender and export it"),
    "packed.blend": (b"\x28\xb5\x2f\xfd" + bytes(80), "a Blender file", "open it in Blender and export it"),
    "a.dae": (b'<?xml version="1.0"?>\n<COLLADA version="1.4.1">\n</COLLADA>', "a COLLADA file", "COLLADA2GLTF"),
    "collada.xml": (b'\xef\xbb\xbf<?xml version="1.0"?>\n<COLLADA version="1.4.1">', "a COLLADA file", "Import > Collada"),
    "a.obj": (b"# cube\nv 0 0 0\n", "an OBJ file", "without a skeleton"),
    "a.ply": (b"ply\nformat ascii 1.0\n", "a PLY file", "without a skeleton"),
    "a.stl": (b"solid cube\n", "an STL file", "without a skeleton"),
    "a.md3": (b"IDP3" + bytes(100), "a Quake III model (MD3)", "Blender"),
    "a.md5mesh": (b"MD5Version 10\n", "a Doom 3 file (MD5)", "Blender"),
    "page.glb": (b"<!DOCTYPE html>\n", "an HTML page", "download the model itself"),
    "page.bendy": (b"<!DOCTYPE html>\n", "an HTML page", "download the model itself"),
    "pointer.glb": (b"version https://git-lfs.github.com/spec/v1\noid sha256:aa\nsize 1\n", "a Git LFS pointer", "git lfs pull"),
    "picture.bvh": (b"\x89PNG\r\n\x1a\n" + bytes(40), "a picture", "the model that uses it"),
    "rig.json": (b'{"bendy_rig": 1}', "a rig file", "--rig FILE"),
    "model.zip": (b"PK\3\4" + bytes(80), "a ZIP archive", "unpack it"),
    "a.ma": (b"//Maya ASCII 2020 scene\n", "a Maya file", "program that made it"),
}


class FileKinds(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="bendy_kinds_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        glb = SOURCE / "examples" / "tentacle.glb"
        for name in ("fox.glb", "named.bin", "with space.glb"):
            shutil.copy(glb, cls.folder / name)
        shutil.copy(SOURCE / "tests" / "seeds" / "rope.gltf", cls.folder)
        md2_file(cls.folder / "tris.md2")
        (cls.folder / "walk.bvh").write_text(walk())
        for arguments in (("convert", "-q", glb, "-o", "good.bendy"), ("dump", "good.bendy", "-o", "good.json"),
                          ("export", "-q", "good.bendy", "-o", "tentacle.x")):
            result = cls.bendy(*arguments)
            assert result.returncode == 0, result.stderr
        for name, (content, _, _) in FOREIGN.items():
            (cls.folder / name).write_bytes(content)
        (cls.folder / "folder").mkdir()
        cls.before = sorted(cls.folder.iterdir())

    @classmethod
    def bendy(cls, *arguments):
        return subprocess.run([BENDY, *map(str, arguments)], cwd=cls.folder, capture_output=True, text=True,
                              timeout=120, check=False, env={**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"})

    def calls(self, name, skip=()):
        """Every call that reads that file: the command, whether it is an edit's other file, and the result."""
        for command, calls in COMMANDS.items():
            if (command == "render" and not HAS_VIEWER) or command in skip:
                continue
            for call in calls:
                arguments = [{"IN": name, "GOOD": "good.bendy"}.get(word, word) for word in call]
                with self.subTest(arguments=arguments):
                    yield command, "--merge" in call, self.bendy(*arguments)
                for out in self.folder.glob("OUT*"):
                    out.unlink()

    def refused(self, command, result, line):
        """The call failed with that one line of error, and left nothing behind."""
        self.assertEqual(result.returncode, 2 if command == "diff" else 1, result.stderr)
        self.assertEqual((result.stdout, result.stderr), ("", f"bendy: error: {line}\n"))
        self.assertEqual(sorted(self.folder.iterdir()), self.before)

    def test_every_command_is_here(self):
        text = self.bendy("--help").stdout
        commands = [line.split()[0] for line in text.partition("Subcommands:")[2].splitlines() if line.startswith("  ")]
        commands = [name for name in commands if not name.startswith(("-", "Try"))]
        self.assertGreater(len(commands), 10)
        for command in commands:
            if command in COMMANDS:
                continue
            self.assertNotIn("FILE", self.bendy(command, "--help").stdout, f"{command} takes a file and is not tried here")

    def test_what_convert_reads(self):
        for name, kind in SOURCES.items():
            shown = f"'{name}'" if " " in name else name
            for command, is_other, result in self.calls(name):
                if command in CONVERTS or is_other:
                    # Nothing but what the conversion or the command has to say; a file that cannot be merged is another matter.
                    if not is_other:
                        self.assertIn(result.returncode, (0, 1) if command == "diff" else (0,), result.stderr)
                    self.assertNotIn("bendy: error", result.stderr if not is_other else "")
                    self.assertNotIn("convert it first", result.stderr)
                else:
                    self.refused(command, result, f"{name}: is {kind}, not a bendy file; convert it first: bendy convert {shown}")

    def test_what_nothing_reads(self):
        for name, (_, kind, way_in) in FOREIGN.items():
            for command, _, result in self.calls(name):
                self.assertIn(way_in, result.stderr)
                said = result.stderr.partition("\n")[0].partition(": is ")[2]
                self.refused(command, result, f"{name}: is {said}")
                self.assertTrue(said.startswith(f"{kind}, which bendy does not read: "), said)

    def test_an_empty_source(self):
        for name in ("nothing.glb", "nothing.x", "nothing.bvh"):
            (self.folder / name).write_bytes(b"")
            self.addCleanup((self.folder / name).unlink)
            for command in (["convert", name, "-o", "OUT.bendy"], ["pose", name], ["inspect", name]):
                result = self.bendy(*command)
                self.assertEqual((result.returncode, result.stderr), (1, f"bendy: error: {name}: is empty: copy or download it again\n"))
            result = self.bendy("validate", name)
            self.assertEqual((result.returncode, result.stdout), (1, f"{name}: is empty: copy or download it again\n"))

    def test_text_of_a_bendy_file(self):
        for command, _, result in self.calls("good.json"):
            if command == "assemble":
                self.assertEqual(result.returncode, 0, result.stderr)
            else:
                self.refused(command, result, "good.json: is the text of a bendy file; make a bendy file of it first: "
                             "bendy assemble good.json")

    def test_a_bendy_file_whatever_its_name(self):
        for name in ("good.fbx", "good.glb"):
            shutil.copy(self.folder / "good.bendy", self.folder / name)
            self.addCleanup((self.folder / name).unlink)
            for command, is_other, result in self.calls(name):
                if command == "assemble":
                    self.assertEqual(result.stderr, f"bendy: error: {name}: is a bendy file, not the text of one, which "
                                     "`bendy dump` writes\n")
                elif not is_other:
                    self.assertEqual(result.returncode, 0, result.stderr)

    def test_what_is_not_there(self):
        for name in ("missing.bendy", "missing.glb", "none/missing.fbx", "fox.glb/below"):
            for command, _, result in self.calls(name):
                self.refused(command, result, f"{name}: there is no such file")

    def test_folders(self):
        for command, is_other, result in self.calls("folder", skip=("convert",)):  # which converts the files in it
            if command != "edit" or is_other:  # which edits the files in it
                self.refused(command, result, "folder: is a folder, not a file")

    def test_a_warning_of_the_conversion_is_said(self):
        (self.folder / "camera.gltf").write_text(json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "eye", "camera": 0}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]}), encoding="utf-8")
        self.addCleanup((self.folder / "camera.gltf").unlink)
        said = self.bendy("convert", "-q", "camera.gltf", "-o", "OUT.bendy").stderr
        self.addCleanup((self.folder / "OUT.bendy").unlink)
        self.assertIn("bendy: warning: camera.gltf: ", said)
        self.assertEqual(self.bendy("pose", "camera.gltf").stderr, said)

    def test_json_of_validate_says_it_too(self):
        for name, text in (("a.fbx", "is an FBX file"),
                           ("missing.bendy", "there is no such file"), ("folder", "is a folder")):
            result = self.bendy("validate", "--json", name)
            self.assertEqual((result.returncode, result.stderr), (1, ""))
            (entry,) = json.loads(result.stdout)
            self.assertIs(entry["valid"], False)
            self.assertIn(text, entry["faults"][0]["message"])

    def test_validate_says_what_the_importer_found(self):
        triangle = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "eye", "camera": 0}],
                    "extensionsUsed": ["ACME_nowhere"],
                    "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]}
        (self.folder / "good.gltf").write_text(json.dumps(triangle))
        (self.folder / "bad.gltf").write_text(json.dumps({**triangle, "nodes": [{"name": "eye", "camera": 7}]}))
        for name in ("good.gltf", "bad.gltf"):
            self.addCleanup((self.folder / name).unlink)
        result = self.bendy("validate", "good.gltf")
        self.assertEqual((result.returncode, result.stdout), (0, ""))
        self.assertIn("bendy: warning: good.gltf: extensionsUsed[0]: extension not read: 'ACME_nowhere'", result.stderr)
        (entry,) = json.loads(self.bendy("validate", "--json", "good.gltf").stdout)
        self.assertEqual((entry["valid"], entry["faults"], entry["faultsLeftOut"]), (True, [], 0))
        self.assertIn({"path": "extensionsUsed[0]", "message": "extension not read: 'ACME_nowhere'", "count": 1}, entry["warnings"])
        said = self.bendy("convert", "bad.gltf", "-o", "OUT.bendy").stderr
        result = self.bendy("validate", "bad.gltf")
        self.assertEqual((result.returncode, result.stderr), (1, ""))
        self.assertRegex(result.stdout, r"^bad\.gltf: nodes\[0\]\.camera: [^\n]+\n$")
        self.assertEqual(f"bendy: error: {result.stdout}", said)
        result = self.bendy("validate", "--json", "bad.gltf")
        (entry,) = json.loads(result.stdout)
        (fault,) = entry["faults"]
        self.assertEqual((result.returncode, result.stderr, entry["valid"], fault["code"], fault["path"]),
                         (1, "", False, "CONVERSION", "nodes[0].camera"))
        self.assertEqual(f"bad.gltf: {fault['path']}: {fault['message']}\n", self.bendy("validate", "bad.gltf").stdout)

    def test_a_source_is_read_as_convert_makes_it(self):
        self.bendy("convert", "-q", "fox.glb", "-o", "OUT.bendy")
        self.addCleanup((self.folder / "OUT.bendy").unlink)
        ours, theirs = (json.loads(self.bendy("inspect", "--json", name).stdout) for name in ("OUT.bendy", "fox.glb"))
        self.assertEqual(ours["summary"], theirs["summary"])
        self.assertEqual([chunk["sum"] for chunk in ours["chunks"]], [chunk["sum"] for chunk in theirs["chunks"]])
        self.assertEqual(self.bendy("diff", "OUT.bendy", "fox.glb").returncode, 0)
        self.assertEqual(self.bendy("diff", "fox.glb", "OUT.bendy", "--tolerance", "1mm").returncode, 0)
        for name, out in (("OUT.bendy", "OUT1.bendy"), ("fox.glb", "OUT2.bendy")):
            self.assertEqual(self.bendy("edit", name, "-o", out, "--strip", "clips").returncode, 0)
            self.addCleanup((self.folder / out).unlink)
        self.assertEqual((self.folder / "OUT1.bendy").read_bytes(), (self.folder / "OUT2.bendy").read_bytes())
        for name in ("fox.glb", "misnamed.bendy"):  # --in-place replaces bendy files only
            if name != "fox.glb":
                shutil.copy(self.folder / "fox.glb", self.folder / name)
                self.addCleanup((self.folder / name).unlink)
            before = (self.folder / name).read_bytes()
            result = self.bendy("edit", "--in-place", name, "--strip", "clips")
            self.assertNotEqual(result.returncode, 0)
            self.assertEqual((self.folder / name).read_bytes(), before)
        self.assertEqual(result.stderr, "bendy: error: misnamed.bendy: is a glTF binary file, not a bendy file; convert it first: "
                         "bendy convert misnamed.bendy\n")

    def test_one_bad_file_of_several(self):
        result = self.bendy("validate", "good.bendy", "a.fbx", "missing.bendy", "good.bendy")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(len(result.stderr.splitlines()), 2)
        result = self.bendy("convert", "-q", "fox.glb", "a.fbx", "-o", "OUT")
        self.addCleanup(shutil.rmtree, self.folder / "OUT")
        self.assertEqual(result.returncode, 1)
        self.assertIn("bendy: error: a.fbx: is an FBX file, which bendy does not read", result.stderr)
        self.assertEqual([path.name for path in (self.folder / "OUT").glob("*.bendy")], ["fox.bendy"])

    def test_names_cannot_forge_lines(self):
        name = "x\nbendy: error: forged.glb"
        shutil.copy(self.folder / "fox.glb", self.folder / name)
        self.addCleanup((self.folder / name).unlink)
        self.assertEqual(len(self.bendy("inspect", name).stderr.splitlines()), 1)


if __name__ == "__main__":
    main()
