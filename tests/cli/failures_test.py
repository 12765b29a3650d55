#!/usr/bin/env python3
"""Lets calls of the system and of malloc fail beneath the program, and stops it between them: the old outputs stay, all of
them, no other file does, and the program ends by itself and says why.

    failures_test.py --bendy PROGRAM --source SOURCE_DIR --failing-calls LIBRARY [unittest's own arguments]
"""

import argparse
import os
import resource
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

    def bendy(self, *arguments, fail=None, at=1, how="error", more=None, **options):
        environment = dict(os.environ) | (more or {})
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

    def stopped(self, *arguments, fail, at=1, do):
        """Runs a command that is stopped at a call, and continued after do(process): exit status and standard error."""
        environment = os.environ | {"LD_PRELOAD": LIBRARY, "BENDY_FAIL": fail, "BENDY_FAIL_AT": str(at), "BENDY_FAIL_HOW": "stop"}
        process = subprocess.Popen([BENDY, *(SOURCE / one if isinstance(one, Path) else one for one in arguments)],
                                   cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   env=environment)
        _, status = os.waitpid(process.pid, os.WUNTRACED)
        if not os.WIFSTOPPED(status):
            process.returncode = os.waitstatus_to_exitcode(status)
            self.fail(f"{arguments} was not stopped: {process.stderr.read()}")
        do(process)
        process.send_signal(signal.SIGCONT)
        _, errors = process.communicate(timeout=120)
        return process.returncode, errors.decode()

    def together(self):
        """Commands that write several files, with those files: some are there already, and bendy has written them."""
        (self.folder / "in.bendy").write_bytes((SOURCE / SEEDS / "rope.bendy").read_bytes())
        (self.folder / "m.gltf").write_bytes((SOURCE / SEEDS / "rope.gltf").read_bytes())
        frames = ("in.bendy", "--clip", "0", "--frames", "8..10@50")
        lines = [(("export", "in.bendy", "-q", "-o", "a.gltf"), ["a.gltf", "a.bin"]),
                 (("convert", "m.gltf", "-q", "-o", "m.bendy", "--depfile", "m.d"), ["m.bendy", "m.d"]),
                 (("pose", *frames, "-o", "p##.obj"), ["p08.obj", "p09.obj", "p10.obj"])]
        if HAS_VIEWER:
            lines.append((("render", *frames, "--size", "16x16", "-o", "r##.png"), ["r08.png", "r09.png", "r10.png"]))
        for line, names in lines:
            for is_old in (True, False):
                with self.subTest(command=line[0], is_old=is_old):
                    before = dict.fromkeys(names)
                    if is_old:
                        self.assertEqual(self.bendy(*line, cwd=self.folder).returncode, 0)
                        for name in names:
                            with (self.folder / name).open("ab") as file:
                                file.write(b"\n ")
                            before[name] = (self.folder / name).read_bytes()
                    yield line, names, before
                for name in names:
                    (self.folder / name).unlink(missing_ok=True)

    def contents(self, names):
        return {name: (self.folder / name).read_bytes() if (self.folder / name).exists() else None for name in names}

    def nothing_is_beside(self):
        self.assertEqual([entry.name for entry in self.folder.iterdir() if entry.name.startswith(".")], [])

    def test_several_outputs_are_replaced_together_or_not_at_all(self):
        for line, names, before in self.together():
            for fail, at in (("open", 2), ("write", 2), ("fsync", 2), ("close", 2), ("rename", 1), ("rename", 2)):
                with self.subTest(fail=fail, at=at):
                    result = self.bendy(*line, fail=fail, at=at, how="once", cwd=self.folder)
                    self.assertEqual(result.returncode, 1, result.stderr)
                    self.assertRegex(result.stderr.decode(), rf"^bendy: error: ({'|'.join(names)}): .*No space left on device\n$"
                                     if fail != "close" else "Input/output error")
                    self.assertEqual(self.contents(names), before)
                    self.nothing_is_beside()

    def test_several_outputs_without_hard_links(self):
        for line, names, before in self.together():
            # Renames: the first file to its second name, the new one over it, the same of the other file.
            for at in (3, 4) if any(before.values()) else ():
                environment = {"BENDY_FAIL_LINK": "1"}
                result = self.bendy(*line, fail="rename", at=at, how="once", cwd=self.folder, more=environment)
                self.assertEqual(result.returncode, 1, result.stderr)
                self.assertEqual(self.contents(names), before)
                self.nothing_is_beside()
            self.assertEqual(self.bendy(*line, fail="link", cwd=self.folder).returncode, 0)
            for name in names:
                self.assertNotIn(self.contents(names)[name], (None, before[name]))
            self.nothing_is_beside()

    def test_an_interrupt_comes_before_all_outputs_are_replaced_or_after(self):
        for line, names, before in self.together():
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                status, _ = self.stopped(*line, fail="fsync", at=2, do=lambda process, n=number: process.send_signal(n))
                self.assertEqual(status, -number)
                self.assertEqual(self.contents(names), before)
                self.nothing_is_beside()
            status, _ = self.stopped(*line, fail="rename", at=2, do=lambda process: process.send_signal(signal.SIGINT))
            self.assertEqual(status, -signal.SIGINT)
            after = self.contents(names)
            for name in names:
                self.assertNotIn(after[name], (None, before[name]))
            self.nothing_is_beside()

    def test_an_interrupt_leaves_no_other_file(self):
        for arguments, output, before in self.writers():
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGPIPE):
                status, errors = self.stopped(*arguments, fail="write", do=lambda process, n=number: process.send_signal(n))
                self.assertEqual(status, -number, errors)
                self.expect_as_it_was(output, before)

    def test_an_ignored_hangup_stays_ignored(self):
        output = self.folder / "out.bendy"
        signal.signal(signal.SIGHUP, signal.SIG_IGN)
        self.addCleanup(signal.signal, signal.SIGHUP, signal.SIG_DFL)
        status, errors = self.stopped(*WRITERS["convert"], output, fail="write", do=lambda process: process.send_signal(signal.SIGHUP))
        self.assertEqual((status, errors), (0, ""))
        self.assertTrue(output.exists())

    def test_an_interrupted_batch_counts_all_that_it_has_written(self):
        (self.folder / "in").mkdir()
        for name in "abcd":
            (self.folder / "in" / f"{name}.gltf").write_bytes((SOURCE / SEEDS / "rope.gltf").read_bytes())
        # Stopped in the rename of the second output, which is finished.
        for number in (signal.SIGINT, signal.SIGHUP):
            status, errors = self.stopped("convert", "in", "-o", "out", "-j", "1", fail="rename", at=2,
                                          do=lambda process, n=number: process.send_signal(n))
            self.assertEqual(status, -number, errors)
            written = sorted(path.name for path in (self.folder / "out").glob("*.bendy"))
            self.assertIn(f"bendy: interrupted: {len(written)} of 4 files converted", errors)
            self.assertGreaterEqual(len(written), 2)
            self.assertEqual([path for path in (self.folder / "out").glob(".bendy-*")], [])
            again = self.bendy("convert", "in", "-o", "out", cwd=self.folder).stdout.decode()
            self.assertRegex(again, rf"up to date +{len(written)}\n")
            shutil.rmtree(self.folder / "out")

    def test_a_file_that_becomes_shorter_is_an_error_that_names_it(self):
        name = "short\x9b \u202e.bendy"
        file = self.folder / name
        whole = (SOURCE / SEEDS / "rope.bendy").read_bytes()
        other = SOURCE / SEEDS / "rope_lod.bendy"
        for line in (("inspect", name), ("inspect", name, "--json"), ("validate", name), ("pose", name), ("dump", name), ("rig", name),
                     ("diff", name, other), ("diff", name, other, "--tolerance", "1mm"), ("export", name, "-o", "out.glb"),
                     ("edit", name, "-o", "out.bendy", "--strip", "clips")):
            with self.subTest(line=line):
                file.write_bytes(whole)
                status, errors = self.stopped(*map(str, line), fail="map", do=lambda _: os.truncate(file, 0))
                self.assertEqual(status, 2 if line[0] == "diff" else 1, errors)
                self.assertEqual(errors.splitlines()[-1], "bendy: error: short\\u009b \\u202e.bendy: became shorter while it was read")
                self.assertEqual([entry.name for entry in self.folder.iterdir()], [name])

    def test_commands_that_work_for_long_have_their_file_in_memory(self):
        file = self.folder / "m.bendy"
        for line in (("render", "m.bendy", "-o", "m.png", "--size", "16x16"), ("bench", "m.bendy", "--rounds", "1")):
            if line[0] == "render" and not HAS_VIEWER:
                continue
            file.write_bytes((SOURCE / SEEDS / "rope.bendy").read_bytes())
            result = self.bendy(*line, fail="map", how="kill", cwd=self.folder)
            # bench maps it, but only where it measures just that.
            self.assertEqual(result.returncode, -signal.SIGKILL if line[0] == "bench" else 0, result.stderr)

    def test_too_many_open_files_are_said(self):
        for name in ("rope.gltf", "rope.bendy"):
            (self.folder / name).write_bytes((SOURCE / SEEDS / name).read_bytes())
        for line in (("inspect", "rope.bendy"), ("validate", "rope.bendy"), ("pose", "rope.bendy"), ("export", "rope.bendy", "-o", "x.glb"),
                     ("edit", "rope.bendy", "-i", "--strip", "clips"), ("dump", "rope.bendy"), ("bench", "rope.bendy"),
                     ("diff", "rope.bendy", "rope.bendy"), ("render", "rope.bendy", "-o", "x.png"), ("convert", "rope.gltf")):
            with self.subTest(line=line):
                if line[0] == "render" and not HAS_VIEWER:
                    continue
                result = self.bendy(*line, fail="read", cwd=self.folder)
                self.assertEqual(result.returncode, 2 if line[0] == "diff" else 1)
                self.assertRegex(result.stderr.decode(), r"^bendy: error: rope\.(bendy|gltf): .*Too many open files\n$")
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["rope.bendy", "rope.gltf"])

    def test_a_sequence_of_any_length_takes_few_open_files_and_little_memory(self):
        self.bendy("convert", "-q", Path("examples/tentacle.glb"), "-o", str(self.folder / "in.bendy"))

        def peak(frames):
            """Kilobytes that the program has taken at most."""
            # AddressSanitizer keeps what is freed: not here.
            kept = ":".join(filter(None, (os.environ.get("ASAN_OPTIONS"), "quarantine_size_mb=0", "thread_local_quarantine_size_kb=0")))
            process = subprocess.Popen([BENDY, "pose", "in.bendy", "--clip", "0", "--frames", f"0..{frames - 1}@1000", "-o", "p#.ply"],
                                       cwd=self.folder, env=os.environ | {"ASAN_OPTIONS": kept}, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, stdout=subprocess.PIPE,
                                       preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (24, 24)))
            process.stdout.close()
            errors = process.stderr.read()
            process.stderr.close()
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(process.returncode, 0, errors)
            self.assertEqual(len(list(self.folder.glob("p*.ply"))), frames)
            self.nothing_is_beside()
            return usage.ru_maxrss

        few = peak(10)
        size = (self.folder / "p0.ply").stat().st_size
        self.assertGreater(size, 50_000)
        self.assertLess(peak(100) - few, 100 * size / 1024 / 4)  # that is names

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
        at, failures, last = 1, 0, 0
        while True:
            result = self.bendy(*arguments, str(output), fail="malloc", at=at)
            with self.subTest(at=at):
                self.assertIn(result.returncode, (0, 1), result.stderr)  # ended by itself
                if result.returncode == 1:
                    self.assertRegex(result.stderr.decode(), r"^bendy: error: (.*: )?not enough memory\n$")
                    self.assertEqual(list(self.folder.iterdir()), [])
                    failures += 1
                else:
                    self.assertEqual(output.read_bytes(), expected)
                    output.unlink()
            if result.returncode == 0 and at > 200 and failures == last:
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
