#!/usr/bin/env python3
"""The parts of scripts/release.sh that need no build: archives, notes, the add-on's manifest, versions, the pages of the gallery."""

import argparse
import hashlib
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts/release"), str(ROOT / "scripts"), str(ROOT / "bindings/blender")]
import archives  # noqa: E402
import check_manifest  # noqa: E402
import make_gallery  # noqa: E402
import notes  # noqa: E402
import own_folder  # noqa: E402
import sbom  # noqa: E402
import versions  # noqa: E402

MANIFEST = (ROOT / "bindings/blender/bendy_rig/blender_manifest.toml").read_text(encoding="utf-8")
# What is changed in the manifest, and a part of what is said of it.
WRONG = (
    ('schema_version = "1.0.0"', 'schema_version = "2.0.0"', "schema_version is"), ('"bendy_rig"', '"bendy rig"', "id is"),
    ('"4.2.0"', '"3.4.0"', "before 4.2.0"), ('chains"', 'chains."', "tagline ends"), ('"SPDX:MIT"', '"MIT"', "no SPDX"),
    ('"Rigging"', '"Bones"', "tag Bones"), ("files =", "disks =", "permission disks"), ("Read and", "Read and " + 60 * "x", "characters"),
    ("name =", "nom =", "name is missing"), ('"add-on"', '"theme"', "type is"), ("version = \"0", "version = \"x", "version is"),
    ("license = [", "license = 1 # [", "license is not of type list"), ('id = "', "id = ", "Invalid"),
)


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


class InFolder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name).resolve()


class OwnFolders(InFolder):
    """A script replaces what it has made, and nothing else."""

    def make(self, names=("index.html", "deep/er/page.html"), folder="made", script="scripts/one.py"):
        with own_folder.made_anew(self.folder / folder, script) as fresh:
            for name in names:
                (fresh / name).parent.mkdir(parents=True, exist_ok=True)
                (fresh / name).write_text(name)

    def files(self):
        return {path.relative_to(self.folder).as_posix() for path in self.folder.rglob("*") if path.is_symlink() or path.is_file()}

    def refused(self, *named, **options):
        before = self.files()
        with self.assertRaises(SystemExit) as refusal:
            self.make(**options)
        for name in named:
            self.assertIn(name, str(refusal.exception))
        self.assertEqual(self.files(), before)

    def test_what_was_made_is_replaced(self):
        self.make()
        self.make(("index.html", "other.html"))
        self.assertEqual(self.files(), {"made/.made.json", "made/index.html", "made/other.html"})
        (self.folder / "empty").mkdir()
        self.make(folder="empty")

    def test_anything_else_is_named_and_stays(self):
        self.make()
        for name in ("made/notes.txt", "made/deep/mine/.hidden"):
            (self.folder / name).parent.mkdir(exist_ok=True)
            (self.folder / name).write_text("mine")
            self.refused(name.removeprefix("made/"))
            (self.folder / name).unlink()
        self.refused("deep/mine/")  # a folder, if it is empty
        (self.folder / "made/deep/mine").rmdir()
        (self.folder / "made/index.html").write_text("changed since")
        self.refused("index.html")

    def test_links_are_not_followed(self):
        (self.folder / "far").mkdir()
        (self.folder / "far/away.txt").write_text("mine")
        self.make()
        (self.folder / "made/link").symlink_to(self.folder / "far")
        self.refused("link")
        (self.folder / "made/link").unlink()
        (self.folder / "made/index.html").unlink()
        (self.folder / "made/index.html").symlink_to(self.folder / "far/away.txt")
        self.refused("index.html")

    def test_a_record_is_of_its_script_and_cannot_claim_more(self):
        self.make()
        self.refused("index.html", script="scripts/two.py")
        (self.folder / "mine").mkdir()
        (self.folder / "mine/file.txt").write_text("mine")
        for record in ("", "[1]", "{}", '{"made by": "scripts/one.py", "files": ["file.txt"]}', '{"made by": "scripts/one.py", "files": {"file.txt": 1}}'):
            (self.folder / "mine" / own_folder.MADE).write_text(record)
            self.refused("file.txt", folder="mine")
        (self.folder / "mine/SHA256SUMS").write_text(f"{digest(self.folder / 'mine/file.txt')}  file.txt\n")
        self.refused("file.txt", folder="mine")
        (self.folder / "file").write_text("mine")
        self.refused("is not a folder", folder="file")

    def test_a_failure_leaves_the_old_ones(self):
        self.make()
        before = self.files()
        with self.assertRaises(ValueError), own_folder.made_anew(self.folder / "made", "scripts/one.py") as fresh:
            (fresh / "half.html").write_text("half")
            raise ValueError
        self.assertEqual(self.files(), before)

    def test_many_files_of_others_are_not_all_listed(self):
        for number in range(20):
            (self.folder / f"{number:02}").write_text("mine")
        self.refused("00, 01, 02 and more", folder=".")

    def test_work_folders_are_new_or_below_a_build(self):
        mine = self.folder / "mine"
        mine.mkdir()
        own_folder.work_folder(mine)
        (mine / "file.txt").write_text("mine")
        with self.assertRaises(argparse.ArgumentTypeError):
            own_folder.work_folder(mine)
        (self.folder / "CMakeCache.txt").touch()
        self.assertEqual(own_folder.work_folder(mine), mine)

    def test_scripts_refuse_folders_of_others(self):
        (self.folder / "mine.txt").write_text("mine")
        for script in ("make_gallery.py", "make_site.py", "release/run.py"):
            command = [sys.executable, "-B", ROOT / "scripts" / script]
            allowed = ["--allow-changes"] if script == "release/run.py" else []
            for arguments, status, said in (([*allowed, self.folder], 1, "mine.txt"), (["--help"], 0, "usage"), (["--hlep"], 2, "--hlep")):
                with self.subTest(script=script, arguments=arguments):
                    result = subprocess.run([*command, *arguments], cwd=self.folder, capture_output=True, text=True, check=False)
                    self.assertEqual(result.returncode, status, result.stderr)
                    self.assertIn(said, result.stdout + result.stderr)
                    self.assertEqual(self.files(), {"mine.txt"})


class Parts(InFolder):

    def test_archives_depend_on_names_and_contents_only(self):
        for write in (archives.write_tar, archives.write_zip):
            for round_, seconds in enumerate((1_000_000_000, 1_500_000_000)):
                members = {}
                for name in ("b", "a/c") if round_ else ("a/c", "b"):
                    path = self.folder / f"{round_}/{name}"
                    path.parent.mkdir(parents=True, exist_ok=True)
                    path.write_text(name)
                    path.chmod(0o640 if round_ else 0o600)
                    os.utime(path, (seconds, seconds))
                    members[name] = path
                write(self.folder / f"{round_}.archive", members, 1_700_000_000)
            self.assertEqual(digest(self.folder / "0.archive"), digest(self.folder / "1.archive"), write.__name__)
            (self.folder / "1/b").chmod(0o755)
            write(self.folder / "1.archive", members, 1_700_000_000)
            self.assertNotEqual(digest(self.folder / "0.archive"), digest(self.folder / "1.archive"), write.__name__)

    def test_notes_are_the_part_of_the_version(self):
        text = "# C\n\n## 2.0\n\nnew\n\n## 1.0 (old)\n\n### A\n\n- a\n\n## 0.1\n\nfirst\n"
        self.assertEqual(notes.changes(text, "1.0"), "### A\n\n- a")
        with self.assertRaises(SystemExit):
            notes.changes(text, "3.0")

    def test_manifest_of_the_add_on(self):
        self.assertEqual(check_manifest.faults(MANIFEST), [])
        for old, new, fault in WRONG:
            with self.subTest(new=new):
                self.assertIn(old, MANIFEST)
                self.assertIn(fault, "\n".join(check_manifest.faults(MANIFEST.replace(old, new))))

    def test_every_file_has_the_version(self):
        versions.check_versions()

    def test_libraries_have_licences_of_spdx(self):
        for library in sbom.notices.LIBRARIES:
            if library["licence"]:
                self.assertIn(sbom.licence_of(library), ("Apache-2.0", "BSD-3-Clause", "BSL-1.0", "LGPL-2.1-or-later", "MIT", "ZPL-2.1", "Zlib"))
                self.assertTrue("debian" in library or "npm" in library, library["name"])

    def test_pages_of_the_gallery(self):
        pages = make_gallery.read_pages()
        self.assertGreater(len(pages), 7)
        for name, page in pages.items():
            self.assertIn('<script type="module">', page["content"], name)
            self.assertNotIn("-->", page["content"], name)
        self.assertEqual(make_gallery.imports()["bendy/three"], "./bendy/three/index.js")


if __name__ == "__main__":
    unittest.main()
