#!/usr/bin/env python3
"""Runs scripts/demo.sh as a newcomer does, and what it says to try next."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LINES, COLUMNS = 24, 80  # of a screen
MADE = {"out/mannequin.bendy": b"HEAD", "out/walk.png": b"\x89PNG\r\n\x1a\n", "out/mannequin.html": b"<!doctype html>"}
WINDOW_SECONDS = "10"
ENDED_BY_TIMEOUT = 124


def run(*command, **options):
    return subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, **options)


class Demo(unittest.TestCase):
    def test_what_it_makes_prints_and_says(self):
        for name in MADE:
            (ROOT / name).unlink(missing_ok=True)
        done = run("scripts/demo.sh")
        self.assertEqual(done.returncode, 0, done.stdout)
        lines = done.stdout.splitlines()
        rows = sum(max(1, -(-len(line) // COLUMNS)) for line in lines)
        self.assertLess(rows, LINES, "more than a screen, with the line of the prompt:\n" + done.stdout)
        self.assertNotRegex(done.stdout.lower(), "warning|error|debconf|dpkg")
        for name, start in MADE.items():
            self.assertIn(name, done.stdout)
            self.assertEqual((ROOT / name).read_bytes()[:len(start)].lower(), start.lower(), name)
        commands = [line.split() for line in lines[lines.index("Try next:") + 1:] if line]
        self.assertEqual(len(commands), 3)
        for command in commands:
            if command[1] == "view":  # stays until somebody closes it
                tried = run("xvfb-run", "-a", "timeout", WINDOW_SECONDS, *command, env={**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"})
                self.assertEqual(tried.returncode, ENDED_BY_TIMEOUT, tried.stdout)
                continue
            output = ROOT / command[command.index("-o") + 1]
            output.unlink(missing_ok=True)
            tried = run(*command)
            self.assertEqual(tried.returncode, 0, tried.stdout)
            self.assertTrue(output.is_file())

    def test_a_failure_shows_the_end_of_the_log(self):
        with tempfile.TemporaryDirectory() as folder:
            fake = Path(folder) / "cmake"
            fake.write_text("#!/bin/sh\nseq 1 100\necho this cmake cannot\nexit 3\n")
            fake.chmod(0o755)
            done = run("scripts/demo.sh", env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"})
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stdout, re.compile("^this cmake cannot$", re.MULTILINE))
        self.assertIn("The whole log is out/demo.log", done.stdout)
        self.assertIsNone(re.search("^10$", done.stdout, re.MULTILINE), "the whole log was shown")


if __name__ == "__main__":
    if not shutil.which("xvfb-run"):
        sys.exit("no xvfb-run: scripts/setup.sh all installs it")
    unittest.main()
