#!/usr/bin/env python3
"""Bazel rules: sandboxed conversions give the program's bytes, only what changed is converted again, and a cache is shared:
bazel_test.py --bendy PROGRAM --source DIR"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

OPTIONS = argparse.Namespace()

BUILD = """
load("//third_party/bendy:defs.bzl", "bendy_model", "bendy_models")

bendy_models(name = "characters", srcs = ["mannequin.glb", "tentacle.glb"], options = ["--lod"], program = "//third_party/bendy:bendy")
bendy_model(name = "parted", src = "parted.gltf", data = ["parted.bin"], rig = "steps.json", program = "//third_party/bendy:bendy")
"""


class Bazel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="bendy_bazel_"))
        cls.root = cls.folder / "workspace"
        (cls.root / "third_party/bendy").mkdir(parents=True)
        (cls.root / "WORKSPACE").touch()
        shutil.copy(OPTIONS.source / "packaging/bazel/defs.bzl", cls.root / "third_party/bendy/defs.bzl")
        shutil.copy(OPTIONS.bendy, cls.root / "third_party/bendy/bendy")
        (cls.root / "third_party/bendy/BUILD").write_text('exports_files(["bendy"])\n')
        for name in ("mannequin.glb", "tentacle.glb"):
            shutil.copy(OPTIONS.source / "examples" / name, cls.root / name)
        cls.bendy("convert", "mannequin.glb", "-o", "../parted.bendy")
        cls.bendy("export", "../parted.bendy", "-o", "parted.gltf")
        cls.write_rig(0.1)
        (cls.root / "BUILD").write_text(BUILD)

    @classmethod
    def tearDownClass(cls):
        cls.bazel("shutdown")
        subprocess.run(["chmod", "-R", "u+w", cls.folder], check=True)
        shutil.rmtree(cls.folder)

    @classmethod
    def write_rig(cls, seconds):
        (cls.root / "steps.json").write_text('{"bendy_rig": 1, "markers": {"Walk": {"step": %g}}}\n' % seconds)

    @classmethod
    def bendy(cls, *arguments):
        subprocess.run([OPTIONS.bendy, *arguments], cwd=cls.root, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    @classmethod
    def bazel(cls, *arguments):
        """Returns the exit status and what was printed."""
        result = subprocess.run(["bazel", f"--output_user_root={cls.folder / 'root'}", *arguments], cwd=cls.root, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env={**os.environ, "HOME": str(cls.folder)})
        return result.returncode, result.stdout

    def build(self, *arguments):
        """Builds; returns how many actions ran in a sandbox and how many came from the cache."""
        status, printed = self.bazel("build", f"--disk_cache={self.folder / 'cache'}", "--spawn_strategy=sandboxed", *arguments)
        self.assertEqual(status, 0, printed)
        processes = re.findall(r"INFO: \d+ process(?:es)?: (.*)", printed)[-1]
        counts = {kind: int(number) for number, kind in re.findall(r"(\d+) ([\w -]+)", processes)}
        return counts.get("linux-sandbox", 0) + counts.get("processwrapper-sandbox", 0), counts.get("remote cache hit", 0) + counts.get("disk cache hit", 0)

    def test_build(self):
        self.assertEqual(self.build("//:characters", "//:parted"), (3, 0))
        for output, source, *options in (("characters/mannequin", "mannequin.glb", "--lod"),
                                         ("characters/tentacle", "tentacle.glb", "--lod"),
                                         ("parted", "parted.gltf", "--rig", "steps.json")):
            self.bendy("convert", source, "-o", "../expected.bendy", "--force", *options)
            self.assertEqual((self.root / f"bazel-bin/{output}.bendy").read_bytes(),
                             (self.folder / "expected.bendy").read_bytes(), output)

        self.assertEqual(self.build("//:characters", "//:parted"), (0, 0), "nothing has changed")
        self.write_rig(0.2)
        self.assertEqual(self.build("//:characters", "//:parted"), (1, 0), "one rig file has changed")
        self.write_rig(0.1)
        self.assertEqual(self.build("//:characters", "//:parted"), (0, 1), "the first rig again, from the cache")
        self.assertEqual(self.bazel("clean")[0], 0)
        self.assertEqual(self.build("//:characters", "//:parted"), (0, 3), "all from the cache")

    def test_the_page(self):
        page = (OPTIONS.source / "packaging/README.md").read_text(encoding="utf-8")
        (self.root / "page").mkdir()
        (self.root / "page/BUILD").write_text(re.search(r"```starlark\n(.*?)```", page, re.DOTALL)[1])
        for source, name in (("mannequin.glb", "fox.glb"), ("tentacle.glb", "crane.glb"), ("parted.bin", "parted.bin"),
                             ("parted.bin", "hero.bin"), ("steps.json", "hero.rig.json"), ("steps.json", "skin.png")):
            shutil.copy(self.root / source, self.root / "page" / name)
        (self.root / "page/hero.gltf").write_text((self.root / "parted.gltf").read_text().replace("parted.bin", "hero.bin"))
        self.build("//page:characters", "//page:hero")
        for output in ("characters/fox.bendy", "characters/crane.bendy", "hero.bendy"):
            self.bendy("validate", f"bazel-bin/page/{output}")

    def refused(self, target, text):
        (self.root / "wrong").mkdir(exist_ok=True)
        (self.root / "wrong/BUILD").write_text(f'load("//third_party/bendy:defs.bzl", "bendy_model", "bendy_models")\n{target}\n')
        for name in ("parted.gltf", "parted.bin", "mannequin.glb"):
            shutil.copy(self.root / name, self.root / "wrong" / name)
        shutil.copy(self.root / "mannequin.glb", self.root / "wrong/mannequin.vrm")
        status, printed = self.bazel("build", "--spawn_strategy=sandboxed", "//wrong:all")
        self.assertNotEqual(status, 0)
        self.assertIn(text, printed)

    def test_mistakes(self):
        program = 'program = "//third_party/bendy:bendy"'
        self.refused(f'bendy_model(name = "a", src = "parted.gltf", {program})', "parted.bin")
        self.refused(f'bendy_model(name = "a", src = "mannequin.glb", options = ["--rig=x.json"], {program})', "use the attribute rig")
        self.refused(f'bendy_model(name = "a", src = "mannequin.glb", options = ["--force"], {program})', "--force is not for a build")
        self.refused(f'bendy_model(name = "a", src = "parted.bin", {program})', "parted.bin")
        self.refused(f'bendy_models(name = "a", srcs = ["mannequin.glb", "mannequin.vrm"], {program})', "both mannequin.glb and mannequin.vrm")
        self.refused(f'bendy_models(name = "a", srcs = ["mannequin.glb", "Mannequin.vrm"], {program})', "would become a/Mannequin.bendy")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--bendy", type=Path, required=True)
    parser.add_argument("--source", type=Path, required=True)
    OPTIONS, rest = parser.parse_known_args()
    OPTIONS.bendy = OPTIONS.bendy.resolve()
    OPTIONS.source = OPTIONS.source.resolve()
    unittest.main(argv=[sys.argv[0], *rest])
