#!/usr/bin/env python3
"""`bendy bench`: which stages it times, and how it prints them.

    bench_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import json
import platform
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from program import SOURCE, Case, main  # noqa: E402


class Bench(Case):
    """Which steps are there and for what they are stated; never how long they take."""

    def stages(self, path, *arguments):
        report = json.loads(self.done("bench", path, "--rounds", "1", "--json", *arguments))
        for stage in report["stages"]:
            for times in stage["perItem"].values():
                self.assertGreater(times["leastNs"], 0.0)
                self.assertGreaterEqual(times["medianNs"], times["leastNs"])
        return report, {stage["name"]: stage for stage in report["stages"]}

    def test_steps_of_a_character_with_everything(self):
        path = self.shared / "all.bendy"
        self.done("convert", "--quiet", "--lod", SOURCE / "examples" / "mannequin.glb", "-o", path)
        report, stages = self.stages(path)
        self.assertEqual((report["joints"], report["targets"], report["clip"]), (65, 2, "Idle"))
        self.assertEqual(list(stages), [
            "open, sums checked", "open, sums not checked", "open to the first pose", "sample, next frame",
            "sample, random time", "blend two poses", "local to model", "local to model and palettes",
            "skin positions", "skin positions, normals", "a whole frame", "morph, all targets", "reach",
            "switch the level of detail"])
        self.assertEqual(stages["sample, next frame"]["items"], 65)
        self.assertEqual(stages["skin positions"]["items"], report["vertices"])
        self.assertEqual(stages["reach"]["items"], 4)
        self.assertLess(stages["morph, all targets"]["items"], report["vertices"])

    def test_steps_that_a_file_has_not_are_left_out(self):
        path = self.shared / "lone.bendy"
        self.done("convert", "--quiet", SOURCE / "examples" / "tentacle.glb", "-o", path)
        _, stages = self.stages(path, "--clip", "Wave")
        self.assertIn("sample, next frame", stages)
        self.assertNotIn("morph, all targets", stages)
        self.assertNotIn("switch the level of detail", stages)

    def test_kernels_stand_side_by_side_on_one_page(self):
        path = self.convert()
        best = self.stages(path)[0]["stages"][0]["perItem"]
        self.assertEqual(len(best), 1)
        page = self.done("bench", path, "--kernel", "plain", "--rounds", "1").decode()
        self.assertRegex(page, r"joints, [\d,]+ vertices")
        self.assertRegex(page, r"\n +plain\n")
        self.assertRegex(page, r"\nlocal to model +\d[\d.]* [num]?s \(\d[\d.]* [num]?s\)  a joint\n")
        self.assertLess(len(page.splitlines()), 25)
        _, stages = self.stages(path, "--kernel", "plain", "--kernel", *best)
        self.assertEqual(set(stages["local to model"]["perItem"]), {"plain", *best})

    def test_wrong_options(self):
        path = self.convert()
        self.assertIn("dance", self.misused("bench", path, "--kernel", "dance"))
        foreign = "avx2" if platform.machine() == "aarch64" else "neon"
        self.assertRegex(self.misused("bench", path, "--kernel", foreign), rf"{foreign} does not run here; these do: .*plain")
        self.misused("bench", path, "--rounds", "0")
        self.assertIn("Dance", self.failed("bench", path, "--clip", "Dance", file=path))


if __name__ == "__main__":
    main()
