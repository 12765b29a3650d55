#!/usr/bin/env python3
"""Lets calls of the system and of malloc fail beneath the program: the old output stays, no other file does, and the
program ends by itself and says why.

    failures_test.py --bendy PROGRAM --source SOURCE_DIR --failing-calls LIBRARY [unittest's own arguments]
"""

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from program import BENDY, REST, SOURCE, has_viewer, main  # noqa: E402

LIBRARY = ""
SEEDS = Path("tests/seeds")
HAS_VIEWER = has_viewer()

# Every command that writes a file, without the file.
WRITERS = {
    "convert": ("convert", "-q", SEEDS / "rope.gltf", "-o"),
    "convert --compact": ("convert", "-q", SEEDS / "plate.gltf", "--compact", "-o"),
    "convert of a bendy file": ("convert", "-q", SEEDS / "rope.bendy", "-o"),
    "pose": ("pose", SEEDS / "rope.bendy", "-o"),
    "rig": ("rig", SEEDS / "rope_rigged.bendy", "-o"),
    "inspect --html": ("inspect", SEEDS / "rope.bendy", "--html"),
    "dump": ("dump", SEEDS / "rope.bendy", "-o"),
    "edit": ("edit", SEEDS / "rope.bendy", "--rename-joint", "*=j*", "-o"),
    "render": ("render", SEEDS / "rope.bendy", "--size", "16x16", "-o"),
}
# Every command that prints its result.
PRINTERS = (
    ("inspect", SEEDS / "rope.bendy"), ("inspect", SEEDS / "rope.bendy", "--json"), ("validate", "--json", SEEDS / "rope.bendy"),
    ("pose", SEEDS / "rope.bendy"), ("rig", SEEDS / "rope_rigged.bendy"), ("convert", SEEDS / "rope.gltf", "-o", "OUT"),
    ("diff", SEEDS / "rope.bendy", SEEDS / "rope_lod.bendy"), ("diff", "--json", SEEDS / "rope.bendy", SEEDS / "rope_lod.bendy"),
    ("bench", SEEDS / "rope.bendy", "--rounds", "1"), ("--help",), ("--version",),
)
ENDINGS = {"convert": ".bendy", "pose": ".obj", "rig": ".json", "dump": ".json", "edit": ".bendy", "inspect": ".html", "render": ".png"}


class Failures(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="bendy_failures_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def bendy(self, *arguments, fail=None, at=1, how="error", **options):
        environment = dict(os.environ)
        if fail:
            environment |= {"LD_PRELOAD": LIBRARY, "BENDY_FAIL": fail, "BENDY_FAIL_AT": str(at), "BENDY_FAIL_HOW": how}
        return subprocess.run([BENDY, *(SOURCE / one if isinstance(one, Path) else one for one in arguments)],
                              stdin=subprocess.DEVNULL, stdout=options.pop("stdout", subprocess.PIPE),
                              stderr=subprocess.PIPE, env=environment, timeout=120, check=False, **options)

    def writers(self):
        """Each command with its output: one that is there already, and one that is not."""
        for name, arguments in WRITERS.items():
            if arguments[0] == "render" and not HAS_VIEWER:
                continue
            for is_old in (True, False):
                output = self.folder / ("out" + ENDINGS[arguments[0]])
                if is_old:
                    output.write_bytes(b"old")
                with self.subTest(command=name, is_old=is_old):
                    yield (*arguments, str(output)), output, b"old" if is_old else None
                for entry in self.folder.iterdir():
                    entry.unlink()

    def expect_as_it_was(self, output, before):
        """The output is what it was, and nothing else is there."""
        self.assertEqual(output.read_bytes() if output.exists() else None, before)
        self.assertEqual([entry for entry in self.folder.iterdir() if entry != output], [])

    def test_every_command_writes_when_nothing_fails(self):
        for arguments, output, _ in self.writers():
            result = self.bendy(*arguments, fail="write", at=1000)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertGreater(output.stat().st_size, 10)
            self.assertEqual(list(self.folder.iterdir()), [output])

    def test_a_write_that_fails_leaves_the_old_file(self):
        for arguments, output, before in self.writers():
            for fail, how in (("open", "error"), ("write", "error"), ("write", "short"), ("fsync", "error"),
                              ("close", "error"), ("rename", "error")):
                result = self.bendy(*arguments, fail=fail, how=how)
                self.assertEqual(result.returncode, 1, (fail, how, result.stderr))
                lines = result.stderr.decode().splitlines()
                self.assertEqual(len(lines), 1, lines)
                self.assertTrue(lines[0].startswith(f"bendy: error: {output}: the file cannot be written: "), lines)
                self.expect_as_it_was(output, before)

    def test_killed_while_writing_the_old_file_is_whole(self):
        # The new bytes may stay beside it, under a name of ours: nobody is left to take them away.
        for arguments, output, before in self.writers():
            for fail in ("write", "fsync", "close", "rename"):
                result = self.bendy(*arguments, fail=fail, how="kill")
                self.assertEqual(result.returncode, -signal.SIGKILL, fail)
                self.assertEqual(output.read_bytes() if output.exists() else None, before)
                for entry in self.folder.iterdir():
                    if entry != output:
                        self.assertRegex(entry.name, r"^\.bendy-\d+-\d+$")
                        entry.unlink()

    @unittest.skipUnless(os.path.exists("/dev/full"), "there is no /dev/full")
    def test_a_full_standard_output_is_an_error_of_every_command(self):
        for arguments in PRINTERS:
            arguments = [str(self.folder / "out.bendy") if one == "OUT" else one for one in arguments]
            with self.subTest(arguments=arguments), open("/dev/full", "wb") as full:
                result = self.bendy(*arguments, stdout=full)
                self.assertEqual(result.returncode, 2 if arguments[0] == "diff" else 1, result.stderr)  # as diff's
                self.assertIn(b"bendy: error: ", result.stderr)

    # The C library's malloc, and so zstd's and all others' too. Not under a sanitizer: it has a malloc of its own.
    def expect_out_of_memory(self, arguments, output, step):
        """Fails one allocation after the other, in steps, until none is left to fail: how many have failed."""
        before = self.bendy(*arguments, str(output))
        self.assertEqual(before.returncode, 0, before.stderr)
        expected = output.read_bytes()
        output.unlink()
        at, failures, last, aborted = 1, 0, 0, 0
        while True:
            result = self.bendy(*arguments, str(output), fail="malloc", at=at)
            with self.subTest(at=at):
                if result.returncode == -signal.SIGABRT and "gltf" in str(arguments):
                    # JSON's destructor takes memory, and where it gets none nothing can be done.
                    self.assertEqual(list(self.folder.iterdir()), [])
                    aborted += 1
                    at += 1 + at // step
                    continue
                self.assertIn(result.returncode, (0, 1), result.stderr)  # ended by itself
                if result.returncode == 1:
                    self.assertRegex(result.stderr.decode(), r"^bendy: error: (.*: )?not enough memory\n$")
                    self.assertEqual(list(self.folder.iterdir()), [])
                    failures += 1
                else:
                    self.assertEqual(output.read_bytes(), expected)
                    output.unlink()
            if result.returncode == 0 and at > 200 and failures == last:
                self.assertLess(aborted, failures / 4)
                return failures
            last = failures
            at += 1 + at // step

    def test_each_allocation_that_fails_is_said(self):
        for name in ("convert", "convert --compact", "convert of a bendy file", "pose"):
            with self.subTest(command=name):
                output = self.folder / ("out" + ENDINGS[WRITERS[name][0]])
                self.assertGreater(self.expect_out_of_memory(WRITERS[name], output, 12), 20)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--failing-calls", required=True)
    parser.add_argument("--sanitized", action="store_true", help="malloc cannot be made to fail")
    options, rest = parser.parse_known_args(REST)
    LIBRARY = options.failing_calls
    if options.sanitized:
        del Failures.test_each_allocation_that_fails_is_said
    main(rest)
