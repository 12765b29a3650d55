#!/usr/bin/env python3
"""The scripts that run the checks: what counts as skipped, what a change touches, which steps it can break."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts/checks"))

import affected  # noqa: E402
import faults  # noqa: E402
import results  # noqa: E402
import run  # noqa: E402
import steps  # noqa: E402

JUNIT = """<testsuite>
<testcase name="good" status="run"><system-out>[  PASSED  ] 1 test.</system-out></testcase>
<testcase name="bad" status="fail"><system-out>skipped=1</system-out></testcase>
<testcase name="gtest.Skips" status="notrun"><system-out>[  SKIPPED ] gtest.Skips (0 ms)</system-out></testcase>
<testcase name="unittest" status="run"><system-out>OK (skipped=2)</system-out></testcase>
<testcase name="pytest" status="run"><system-out>40 passed, 1 skipped in 3.10s</system-out></testcase>
<testcase name="node" status="run"><system-out># skipped 3</system-out></testcase>
<testcase name="disabled" status="disabled"><system-out></system-out></testcase>
<testcase name="quiet" status="run"><system-out># skipped 0
2 unskipped</system-out></testcase>
</testsuite>"""


class Results(unittest.TestCase):
    def read(self, allowed):
        with tempfile.TemporaryDirectory() as folder:
            junit, list_of_allowed = Path(folder, "junit.xml"), Path(folder, "allowed.txt")
            junit.write_text(JUNIT, encoding="utf-8")
            list_of_allowed.write_text(allowed, encoding="utf-8")
            return results.read_results(junit, list_of_allowed)

    def test_every_framework_says_that_it_skips(self):
        failed, skipped = self.read("# nothing\n")
        self.assertEqual(failed, ["bad"])
        self.assertEqual([name for name, _ in skipped], ["gtest.Skips", "unittest", "pytest", "node", "disabled"])

    def test_what_the_list_names_may_skip(self):
        _, skipped = self.read("gtest\\..* there is no display\nnode|pytest not there\n")
        self.assertEqual([name for name, _ in skipped], ["unittest", "disabled"])


class Steps(unittest.TestCase):
    def test_names_are_different_and_needs_exist(self):
        names = [step.name for step in steps.STEPS]
        self.assertEqual(len(names), len(set(names)))
        for step in steps.STEPS:
            self.assertIn(step.ring, ("test", "gate", "all", "asked"))
            for name in step.needs:
                self.assertIsNotNone(steps.named(name), step.name)

    def test_words_that_stand_for_several_steps(self):
        def chosen(*words):
            options, _ = run.parse(words)
            return [step.name for step in run.choose(options)]
        self.assertEqual(chosen(), ["build", "tests", "corpus"])
        self.assertEqual(chosen("gate")[:3], chosen())
        self.assertIn("asan", chosen("gate"))
        self.assertFalse(set(chosen("gate")) & set(chosen("all")))
        self.assertEqual(chosen("tests", "asan"), ["tests", "asan"])

    def test_setup_knows_what_a_ring_needs(self):
        text = (ROOT / "scripts/setup.sh").read_text(encoding="utf-8")
        for step in steps.STEPS:
            self.assertRegex(text, rf"wants [a-z ]*\b{step.setup}\b", step.name)

    def test_a_step_comes_behind_what_it_needs(self):
        chosen = [step.name for step in run.with_needed([steps.named("fuzz"), steps.named("tests")])]
        self.assertEqual(chosen, ["build", "asan", "fuzz", "tests"])

    def test_every_kind_of_fault_has_a_patch_and_every_patch_a_kind(self):
        kinds = {faults.read_header(patch)["Kind"] for patch in (ROOT / "tests/faults").glob("*.patch")}
        self.assertEqual(kinds, set(faults.steps_by_kind()))

    def test_every_patch_applies(self):
        for patch in sorted((ROOT / "tests/faults").glob("*.patch")):
            with self.subTest(patch=patch.name):
                done = subprocess.run(["git", "apply", "--check", patch], cwd=ROOT, capture_output=True, text=True, check=False)
                self.assertEqual(done.stderr, "")


class ChangedSources(unittest.TestCase):
    """In a repository of its own."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        (self.folder / "scripts").mkdir()
        script = (ROOT / "scripts/changed_sources.py").read_text(encoding="utf-8")
        (self.folder / "scripts/changed_sources.py").write_text(script, encoding="utf-8")
        self.write("a/include/bendy/deep.h", "")
        self.write("a/include/bendy/outer.h", "#include <bendy/deep.h>\n")
        self.write("a/src/uses.cpp", "#include <bendy/outer.h>\n")
        self.write("a/src/other.cpp", "#include <vector>\n")
        self.git("init", "--quiet")
        self.commit("first")

    def write(self, name, text):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / name).write_text(text, encoding="utf-8")

    def git(self, *arguments):
        subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@a", *arguments], cwd=self.folder, check=True, capture_output=True)

    def commit(self, message):
        self.git("add", ".")
        self.git("commit", "--quiet", "-m", message)

    def changed(self, since):
        done = subprocess.run([sys.executable, self.folder / "scripts/changed_sources.py", since], check=True, capture_output=True, text=True)
        return done.stdout.split()

    def test_a_header_touches_what_includes_it(self):
        self.assertEqual(self.changed("HEAD"), [])
        self.write("a/include/bendy/deep.h", "// changed\n")
        self.assertEqual(self.changed("HEAD"), ["a/src/uses.cpp"])
        self.commit("second")
        self.assertEqual(self.changed("HEAD~1"), ["a/src/uses.cpp"])

    def test_settings_and_unknown_revisions_touch_all(self):
        self.assertEqual(self.changed("0000000000"), ["a/src/other.cpp", "a/src/uses.cpp"])
        self.write(".clang-tidy", "Checks: '*'\n")
        self.assertEqual(self.changed("HEAD"), ["a/src/other.cpp", "a/src/uses.cpp"])


class Affected(unittest.TestCase):
    def test_folders_reach_what_they_may_include(self):
        allowed = affected.may_use(ROOT)
        self.assertEqual(allowed["format"], {"format"})
        self.assertLessEqual({"tools/cli", "converter", "runtime", "format"}, allowed["tools/cli"])
        self.assertNotIn("converter", allowed["runtime"])

    def test_inputs(self):
        inputs = affected.Inputs()
        inputs.trees.add("tests/cli")
        inputs.folders.add("tests/runtime")
        inputs.files |= {"README.md", "*.toml"}
        for path in ("tests/cli/deep/a.py", "tests/runtime/a.cpp", "README.md", "pyproject.toml"):
            self.assertTrue(inputs.has(path), path)
        for path in ("tests/runtime/deep/a.cpp", "tests/a.cpp", "LICENSE"):
            self.assertFalse(inputs.has(path), path)


if __name__ == "__main__":
    unittest.main()
