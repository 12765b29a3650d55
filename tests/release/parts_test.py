#!/usr/bin/env python3
"""The parts of scripts/release.sh that need no build: archives, notes, the add-on's manifest, versions, the pages of the gallery."""

import hashlib
import os
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


class Parts(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

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
