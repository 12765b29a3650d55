#!/usr/bin/env python3
"""Makes a release twice and compares the bytes; then installs each artefact into an empty place and makes the first pose with it.

    release_test.py [--release FOLDER] [--second FOLDER] [CLASS...]

--release and --second are releases that are there already. The second one is packed again from the same builds: that compilers
give the same bytes is tried by a second clone, see packaging/README.md.
"""

import argparse
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "scripts/release"))
from project import VERSION  # noqa: E402

OPTIONS = argparse.Namespace()
EXAMPLE = ROOT / "examples/mannequin.glb"
CLIP, SECONDS = "Walk", 0.35
# Of the first vertex, in metres: kernels differ in the last digits.
TOLERANCE = 1e-5


def run(*command, timeout=900, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, timeout=timeout, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: {done.returncode}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done.stdout


def make_release(folder):
    run(ROOT / "scripts/release.sh", "--allow-changes", folder, timeout=4 * 3600)
    return folder


def the_file(pattern):
    found = list(OPTIONS.release.glob(pattern))
    if len(found) != 1:
        raise AssertionError(f"{pattern}: {found}")
    return found[0]


def extract(archive, folder):
    """Extracts into a folder; returns the one folder or file in it, or the folder."""
    opened = zipfile.ZipFile(archive) if archive.suffix == ".zip" else tarfile.open(archive)
    with opened:
        opened.extractall(folder)
    inside = list(folder.iterdir())
    return inside[0] if len(inside) == 1 else folder


class Twice(unittest.TestCase):
    def test_the_same_bytes(self):
        first, second = (dict(reversed(line.split("  ")) for line in (folder / "SHA256SUMS").read_text().splitlines())
                         for folder in (OPTIONS.release, OPTIONS.second))
        self.assertGreater(len(first), 10)
        self.assertEqual({name for name in first.keys() | second.keys() if first.get(name) != second.get(name)}, set())


class Papers(unittest.TestCase):
    """Checksums, the bill of materials, the notes."""

    def test_checksums(self):
        run("sha256sum", "-c", "--strict", "SHA256SUMS", cwd=OPTIONS.release)
        listed = {line.split("  ")[1] for line in (OPTIONS.release / "SHA256SUMS").read_text().splitlines()}
        self.assertEqual(listed, {path.name for path in OPTIONS.release.glob("[!.]*")} - {"SHA256SUMS"})

    def test_bill_of_materials(self):
        document = json.loads(the_file("*.spdx.json").read_text(encoding="utf-8"))
        packages = {package["SPDXID"]: package for package in document["packages"]}
        self.assertEqual(len(packages), len(document["packages"]))
        contained = {}
        for relation in document["relationships"]:
            self.assertIn(relation["relatedSpdxElement"], packages)
            contained.setdefault(relation["spdxElementId"], []).append(packages[relation["relatedSpdxElement"]]["name"])
        described = set(contained.pop("SPDXRef-DOCUMENT"))
        others = {"SHA256SUMS", "RELEASE_NOTES.md", the_file("*.spdx.json").name}
        self.assertEqual(described, {path.name for path in OPTIONS.release.glob("[!.]*")} - others)
        for package in packages.values():
            self.assertRegex(package["SPDXID"], r"^SPDXRef-[A-Za-z0-9.-]+$")
            self.assertTrue(package["versionInfo"])
            if "packageFileName" in package:
                data = (OPTIONS.release / package["packageFileName"]).read_bytes()
                self.assertEqual(package["checksums"][0]["checksumValue"], hashlib.sha256(data).hexdigest())
        program = contained["SPDXRef-" + the_file("*-linux-x86_64.tar.gz").name.replace("_", "-")]
        self.assertLessEqual({"Zstandard", "CLI11", "the GNU C Library"}, set(program))
        self.assertNotIn("three.js", program)

    def test_notes(self):
        text = (OPTIONS.release / "RELEASE_NOTES.md").read_text(encoding="utf-8")
        self.assertTrue(text.startswith(f"# Bendy {VERSION}\n"))
        self.assertIn("### Converting", text)
        self.assertIn(the_file("*.whl").name, text)


class Case(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="bendy-release-")
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        shutil.copy(EXAMPLE, self.folder)

    def expect_vertex(self, found):
        """The first vertex of the pose that all artefacts make; taken from the first program that is asked."""
        wanted = Case.__dict__.get("vertex")
        if wanted is None:
            Case.vertex = wanted = pose_by([extract_program("linux-x86_64", self.folder / "first") / "bendy"], self.folder)
        for one, other in zip(found, wanted, strict=True):
            self.assertAlmostEqual(one, other, delta=TOLERANCE)


def extract_program(system, folder):
    return extract(the_file(f"bendy-{VERSION}-{system}.*"), folder)


def pose_by(program, folder, **options):
    """Converts the example and poses it, by a program; returns the first vertex."""
    for name in ("mannequin.bendy", "pose.json"):
        (folder / name).unlink(missing_ok=True)
    run(*program, "convert", "mannequin.glb", "-q", cwd=folder, **options)
    run(*program, "pose", "mannequin.bendy", "--clip", CLIP, "--time", SECONDS, "-o", "pose.json", cwd=folder, **options)
    return json.loads((folder / "pose.json").read_text(encoding="utf-8"))["meshes"][0]["positions"][:3]


class Programs(Case):
    """The archives of the program, each with its licences."""

    def check(self, system, program, *runner, **options):
        place = extract_program(system, self.folder / system)
        self.assertEqual({path.name for path in place.iterdir()}, {program, "LICENSE", "NOTICES.txt"})
        self.expect_vertex(pose_by([*runner, place / program], self.folder, **options))
        return hashlib.sha256((self.folder / "mannequin.bendy").read_bytes()).hexdigest()

    def test_all_write_the_same_file(self):
        linux = self.check("linux-x86_64", "bendy", env={})
        self.assertEqual(linux, self.check("linux-aarch64", "bendy", "qemu-aarch64", "-L", "/nothing"))
        self.assertEqual(linux, self.check("windows-x86_64", "bendy.exe", ROOT / "cmake/run_wine.sh"))


class Packages(Case):
    def test_debian(self):
        for package in OPTIONS.release.glob("*.deb"):
            run("dpkg-deb", "-x", package, self.folder / "root")
        self.expect_vertex(pose_by([self.folder / "root/usr/bin/bendy"], self.folder))
        source = self.folder / "version.c"
        source.write_text('#include <bendy.h>\n#include <stdio.h>\nint main(void) { puts(bendy_version_string()); return 0; }\n')
        flags = run("pkg-config", "--cflags", "--libs", "bendy", env={**os.environ, "PKG_CONFIG_SYSROOT_DIR": str(self.folder / "root"),
                                                                     "PKG_CONFIG_PATH": str(next((self.folder / "root").rglob("bendy.pc")).parent)}).split()
        run("cc", source, "-o", self.folder / "version", *flags)
        library = next((self.folder / "root").rglob("libbendy.so.0")).parent
        self.assertEqual(run(self.folder / "version", env={"LD_LIBRARY_PATH": str(library)}).strip(), VERSION)

    def test_wheel(self):
        run("/usr/bin/python3", "-m", "venv", "--system-site-packages", "--without-pip", self.folder / "venv")  # numpy is the system's
        python = self.folder / "venv/bin/python"
        run("/usr/bin/python3", "-m", "pip", "--python", python, "install", "--no-index", "--no-deps", "--quiet", the_file("*.whl"))
        said = run(python, "-c", f"import bendy\nprint(bendy.__file__, *bendy.open('mannequin.glb').sample({CLIP!r}, {SECONDS}).skin()[0])", cwd=self.folder)
        self.assertTrue(said.startswith(str(self.folder)), said)
        self.expect_vertex([float(word) for word in said.split()[1:]])

    def test_npm(self):
        (self.folder / "package.json").write_text('{"type": "module"}')
        run("npm", "install", "--offline", "--no-audit", "--no-fund", "--silent", the_file("bendy-*.tgz"), cwd=self.folder)
        (self.folder / "pose.js").write_text("import { readFileSync } from 'node:fs';\nimport { Model } from 'bendy';\nimport { convert } from 'bendy/tools';\n"
                                             "const model = await Model.open((await convert(readFileSync('mannequin.glb'))).bytes);\n"
                                             f"console.log(...model.sample('{CLIP}', {SECONDS}).skin().positions.slice(0, 3));\n")
        self.expect_vertex([float(word) for word in run("node", "pose.js", cwd=self.folder).split()])

    def test_two_files(self):
        extract(the_file("*-two-files.zip"), self.folder / "two")
        (self.folder / "two/main.cpp").write_text('#include "bendy_runtime.h"\n#include <cstdio>\n#include <vector>\n'
                                                  "int main(int, char** arguments) {\n    auto model = bendy::Model::open(arguments[1]);\n    if (!model) return 1;\n"
                                                  "    bendy::Pose pose(*model);\n    std::vector<glm::vec3> at(model->vertex_count());\n"
                                                  f'    if (!bendy::sample(pose, model->clip("{CLIP}"), {SECONDS}f) || !bendy::skin(pose, {{.out = {{.positions = at}}}})) return 1;\n'
                                                  '    std::printf("%.9g %.9g %.9g", at[0].x, at[0].y, at[0].z);\n}\n')
        run("c++", "-std=c++20", "-O1", "main.cpp", "bendy_runtime.cpp", "-o", "main", cwd=self.folder / "two")
        pose_by([extract_program("linux-x86_64", self.folder / "program") / "bendy"], self.folder)
        self.expect_vertex([float(word) for word in run(self.folder / "two/main", self.folder / "mannequin.bendy").split()])

    def test_blender(self):
        program = extract_program("linux-x86_64", self.folder / "program") / "bendy"
        pose_by([program], self.folder)
        environment = {**os.environ, "PATH": f"{program.parent}:{os.defpath}", "BLENDER_USER_SCRIPTS": str(self.folder / "scripts"),
                       "BLENDER_USER_CONFIG": str(self.folder / "config"), "PYTHONDONTWRITEBYTECODE": "1"}
        said = run("blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", HERE / "first_pose_in_blender.py", "--",
                   the_file("bendy_rig-*.zip"), self.folder / "mannequin.bendy", env=environment)
        self.assertRegex(said, r"\nturned [1-9]\d* bones\n")

    def test_sources(self):
        place = extract(the_file(f"bendy-{VERSION}.tar.gz"), self.folder / "sources")
        for name in ("README.md", "LICENSE", "scripts/release.sh", "format/CMakeLists.txt"):
            self.assertTrue((place / name).is_file(), name)
        run(place / "scripts/amalgamate.py", self.folder / "two")
        self.assertIn(f"Bendy's runtime {VERSION}", (self.folder / "two/bendy_runtime.h").read_text(encoding="utf-8"))


class Pages(Case):
    """By Chromium, through node."""

    def test_page_and_gallery(self):
        site = extract(the_file("*-site.tar.gz"), self.folder / "site")
        for name in ("index.html", "page.html", "docs/tour.html", "gallery/index.html", "spec/versions.html"):
            self.assertTrue((site / name).is_file(), name)
        self.assertEqual((site / "page.html").read_bytes(), the_file("*-page.html").read_bytes())
        said = run("node", HERE / "gallery.mjs", site / "gallery", the_file("*-page.html"))
        count = len(re.findall(r'<li><a href=', (site / "gallery/index.html").read_text(encoding="utf-8")))
        self.assertEqual(said.split()[-2:], [str(count), "good"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--release", type=Path)
    parser.add_argument("--second", type=Path)
    _, rest = parser.parse_known_args(namespace=OPTIONS)
    work = ROOT / "build/release-check"
    OPTIONS.release = (OPTIONS.release or make_release(work / "first")).resolve()
    if OPTIONS.second is None and (not rest or "Twice" in rest):
        OPTIONS.second = make_release(work / "second")
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)


if __name__ == "__main__":
    main()
