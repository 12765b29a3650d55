#!/usr/bin/env python3
"""`bendy edit` of several files and folders, and `--retarget` of a folder.

    edit_batch_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import json
import shutil
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from bvh_file import walk  # noqa: E402
from chunk_file import Chunk  # noqa: E402
from program import SOURCE, Case, main  # noqa: E402


def add_inputs(folder):
    """A mannequin that is a bendy file, and a tentacle that is none, below it."""
    (folder / "in" / "deeper").mkdir(parents=True)
    shutil.copy(SOURCE / "examples" / "tentacle.glb", folder / "in" / "deeper" / "b.glb")


def clips_of(path):
    objects = [chunk for chunk in Chunk.read(path.read_bytes()).children if chunk.letters == "OBJE"]
    return [child.children[0].payload.decode() for child in objects[0].children if child.letters == "CYCL"]


class EditBatch(Case):
    """The same changes to many files."""

    def setUp(self):
        super().setUp()
        add_inputs(self.folder)
        self.done("convert", "-q", SOURCE / "examples" / "mannequin.glb", "-o", "in/a.bendy")

    def files(self, folder):
        return {str(path.relative_to(self.folder / folder)): path.read_bytes()
                for path in (self.folder / folder).rglob("*") if path.is_file()}

    def test_files_of_a_folder_keep_their_places_and_are_those_of_single_edits(self):
        told = self.done("edit", "in", "-o", "out/", "--strip", "clips").decode()
        self.assertEqual(sorted(self.files("out")), ["a.bendy", "deeper/b.bendy"])
        self.assertEqual([line.split("  ")[0] for line in told.splitlines() if " -> " in line],
                         ["in/a.bendy -> out/a.bendy", "in/deeper/b.glb -> out/deeper/b.bendy"])
        self.done("edit", "in/deeper/b.glb", "-o", "single.bendy", "--strip", "clips")
        self.assertEqual(self.files("out")["deeper/b.bendy"], (self.folder / "single.bendy").read_bytes())

    def test_any_number_of_jobs_gives_the_same_bytes_and_report(self):
        told = []
        for jobs in ("1", "3"):
            told.append(self.done("edit", "in", "-o", "out" + jobs + "/", "-j", jobs, "--strip", "clips", "--json")
                        .decode().replace("out" + jobs, "out"))
        self.assertEqual(self.files("out1"), self.files("out3"))
        self.assertEqual(told[0], told[1])
        reports = [json.loads(line) for line in told[0].splitlines()]
        self.assertEqual([report["input"] for report in reports], ["in/a.bendy", "in/deeper/b.glb"])

    def test_what_fails_is_named_and_the_others_are_written(self):
        whole = (self.folder / "in" / "a.bendy").read_bytes()
        (self.folder / "in" / "broken.bendy").write_bytes(whole[: len(whole) // 2])
        result = self.bendy("edit", "in", "-o", "out/", "--strip", "clips", "--json")
        self.assertEqual(result.returncode, 1)
        (error,) = result.stderr.decode().splitlines()
        self.assertTrue(error.startswith("bendy: error: in/broken.bendy: "), error)
        self.assertEqual(sorted(self.files("out")), ["a.bendy", "deeper/b.bendy"])
        failed = [report for report in map(json.loads, result.stdout.decode().splitlines()) if "error" in report]
        self.assertEqual([report["error"]["file"] for report in failed], ["in/broken.bendy"])

    def test_in_place_replaces_bendy_files_only(self):
        before = self.files("in")
        result = self.bendy("edit", "in", "-i", "--strip", "clips")
        self.assertEqual(result.returncode, 1)
        (error,) = result.stderr.decode().splitlines()
        self.assertTrue(error.startswith("bendy: error: in/deeper/b.glb: "), error)
        self.assertEqual(clips_of(self.folder / "in/a.bendy"), [])
        self.assertEqual(self.files("in")["deeper/b.glb"], before["deeper/b.glb"])

    def test_nothing_is_overwritten_or_taken_for_a_folder(self):
        before = self.files("in")
        self.assertIn("is an input as well", self.failed("edit", "in/a.bendy", "in", "-o", "in", "--strip", "clips"))
        shutil.copy(self.folder / "in" / "deeper" / "b.glb", self.folder / "in" / "a.glb")
        self.assertIn("both", self.failed("edit", "in", "-o", "out/", "--strip", "clips"))
        (self.folder / "in" / "a.glb").unlink()
        self.assertEqual(self.files("in"), before)
        self.assertFalse((self.folder / "out").exists())
        self.misused("edit", "in", "in/a.bendy", "-o", "out.bendy", "--strip", "clips")
        self.misused("edit", "in", "-o", "-", "--strip", "clips")
        self.misused("edit", "in", "-", "-o", "out/", "--strip", "clips")

    def test_strict_writes_those_without_a_warning(self):
        shutil.copy(self.folder / "in" / "a.bendy", self.folder / "in" / "c.bendy")
        self.done("edit", "in/c.bendy", "-i", "--rename-joint", "mixamorig:Head=Skull")
        result = self.bendy("edit", "in/a.bendy", "in/c.bendy", "-o", "out/", "--strict", "--same-name", "replace",
                            "--merge", "in/a.bendy")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(sorted(self.files("out")), ["a.bendy"])


class RetargetFolder(Case):
    """All clips of a folder on all characters of another one."""

    def setUp(self):
        super().setUp()
        add_inputs(self.folder)
        self.done("convert", "-q", SOURCE / "examples" / "mannequin.glb", "-o", "in/a.bendy")
        (self.folder / "clips").mkdir()
        for name in ("one", "two"):
            (self.folder / "clips" / f"{name}.bvh").write_text(walk(3))

    def test_all_clips_go_on_all_characters(self):
        shutil.copy(self.folder / "in" / "a.bendy", self.folder / "in" / "deeper" / "c.bendy")
        self.done("edit", "in/a.bendy", "in/deeper/c.bendy", "-o", "out/", "--retarget", "clips")
        for name in ("a", "c"):
            self.assertEqual(clips_of(self.folder / f"out/{name}.bendy"), ["Idle", "Walk", "one", "two"])

    def test_files_that_cannot_be_retargeted_are_left_out_with_a_warning(self):
        shutil.copy(SOURCE / "examples" / "tentacle.glb", self.folder / "clips" / "other.glb")
        result = self.bendy("edit", "in/a.bendy", "-o", "out.bendy", "--retarget", "clips")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stderr.decode(), "left out: retargeting clips/other.glb: the source does not say")
        self.assertEqual(clips_of(self.folder / "out.bendy"), ["Idle", "Walk", "one", "two"])
        result = self.bendy("edit", "in/a.bendy", "-o", "strict.bendy", "--retarget", "clips", "--strict")
        self.assertEqual(result.returncode, 1)
        self.assertFalse((self.folder / "strict.bendy").exists())

    def test_a_folder_without_anything_is_an_error(self):
        (self.folder / "empty").mkdir()
        self.assertIn("no file with clips", self.failed("edit", "in/a.bendy", "-o", "x.bendy", "--retarget", "empty"))
        for path in (self.folder / "clips").iterdir():
            path.write_text("HIERARCHY\n")
        self.assertIn("like all files", self.failed("edit", "in/a.bendy", "-o", "x.bendy", "--retarget", "clips"))
        self.assertFalse((self.folder / "x.bendy").exists())

    def test_the_report_has_the_numbers_of_each_clip(self):
        report = json.loads(self.done("edit", "in/a.bendy", "-o", "x.bendy", "--retarget", "clips", "--json"))
        self.assertEqual([(one["source"], one["clip"]) for one in report["retargeted"]],
                         [("clips/one.bvh", "one"), ("clips/two.bvh", "two")])
        for one in report["retargeted"]:
            self.assertGreater(one["frames"], 0)
            self.assertLess(one["directions"]["mean_degrees"], one["directions"]["degrees"])
            self.assertEqual(one["pops"], [])


if __name__ == "__main__":
    main()
