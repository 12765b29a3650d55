#!/usr/bin/env python3
"""Command lines: help, wrong ones, inputs that cannot be read, standard output that cannot be written.

    command_line_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import json
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from program import BENDY, Case, main  # noqa: E402

COMMANDS = ("convert", "export", "inspect", "validate", "pose", "rig", "diff", "edit", "dump", "assemble", "bench")


class CommandLine(Case):
    def test_help_of_each_command_has_an_example(self):
        for command in COMMANDS:
            text = self.done(command, "--help").decode()
            self.assertIn(f"Example: bendy {command} ", text)
            self.assertEqual(text, self.done(command, "-h").decode())

    def test_help_lists_the_commands(self):
        text = self.done("--help").decode()
        for command in COMMANDS:
            self.assertIn(f"  {command} ", text)

    def test_version(self):
        self.assertRegex(self.done("--version").decode(), r"^bendy \d+\.\d+\.\d+\n$")

    def test_no_arguments_ask_for_help(self):
        self.assertEqual(self.done(), self.done("--help"))

    def test_help_of_convert_begins_with_the_common_options(self):
        groups = self.done("convert", "--help").decode().split("\n\n")
        common = next(group for group in groups if group.startswith("Options:\n"))
        for option in ("-o,--output", "--compact", "--max-error", "--auto-rig", "--lod", "-q,--quiet", "-v,--verbose"):
            self.assertIn(f"\n  {option} ", common)
        self.assertNotIn("--ticks-per-second", common)
        self.assertLess(len(common.splitlines()), 16)

    def test_an_unknown_command_is_named(self):
        self.assertIn("dance", self.misused("dance"))
        self.assertIn("dance", self.misused("dance", "a.bendy"))

    def test_an_unknown_option_is_named(self):
        self.assertIn("--bogus", self.misused("--bogus"))
        for command in COMMANDS:
            files = [self.convert()] * (2 if command == "diff" else 1)
            self.assertIn("--bogus", self.misused(command, "--bogus", *files))

    def test_a_file_is_needed(self):
        for command in COMMANDS:
            self.misused(command)

    def test_one_file_too_many_is_named(self):
        for command in ("inspect", "pose", "rig", "bench"):
            self.assertIn("second.bendy", self.misused(command, self.convert(), "second.bendy"))

    def test_what_a_user_typed_cannot_forge_lines(self):
        self.assertNotIn("\nbendy: error: forged", self.misused("x\nbendy: error: forged"))

    def test_missing_and_empty_files_and_folders_fail_in_one_line(self):
        (self.folder / "empty").write_bytes(b"")
        (self.folder / "folder").mkdir()
        for command in ("convert", "inspect", "pose", "rig", "bench"):
            for name in ("missing", "empty", "folder", "empty/below", "missing/below"):
                if (command, name) == ("convert", "folder"):
                    continue  # it has nothing to convert
                line = self.failed(command, name, file=name)
                self.assertGreater(len(line), len(f"bendy: error: {name}: "))
        self.assertEqual(self.files(), ["empty", "folder"])

    def test_a_text_file_is_no_bendy_file(self):
        (self.folder / "text").write_text("hello, world, this is no bendy file at all\n")
        for command in ("inspect", "pose", "rig", "bench"):
            self.assertIn("not a bendy file", self.failed(command, "text", file="text"))

    @unittest.skipUnless(os.path.exists("/dev/full"), "there is no /dev/full")
    def test_a_full_standard_output_fails(self):
        for arguments in (("inspect", self.convert()), ("inspect", self.convert(), "--json"), ("pose", self.convert()),
                          ("inspect", self.convert(), "--hex"), ("rig", self.convert())):
            with open("/dev/full", "wb") as full:
                result = subprocess.run([BENDY, *arguments], stdout=full, stderr=subprocess.PIPE, timeout=120,
                                        check=False)
            self.assertEqual(result.returncode, 1)
            self.assertIn(b"bendy: error: ", result.stderr)

    def test_names_that_are_not_utf8_do_not_break_json(self):
        path = os.fsencode(self.folder) + b"/\xff\xfe.bendy"
        shutil.copy(self.convert("tentacle"), path)
        self.assertIn("\ufffd", json.loads(self.done("inspect", path, "--json"))["file"])
        self.assertIn("\ufffd", json.loads(self.done("validate", path, "--json"))[0]["file"])
        self.done("pose", path, "-o", "out.json")
        self.assertIn("\ufffd", json.loads((self.folder / "out.json").read_bytes())["file"])


if __name__ == "__main__":
    main()
