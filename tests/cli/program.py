"""The program under test, and the base of its test cases. The scripts that import this are run as

    SCRIPT --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from gltf_file import strange_file

_parser = argparse.ArgumentParser()
_parser.add_argument("--bendy", required=True)
_parser.add_argument("--source", required=True, type=Path)
_options, REST = _parser.parse_known_args()  # REST: arguments of the script itself, and unittest's
BENDY = os.path.abspath(_options.bendy)
SOURCE = _options.source.resolve()
# How to run a program that can write no more than 5000 bytes: a limit stands for the full disk, and the signal that
# comes with it stays ignored.
FULL_DISK = {"restore_signals": False,
             "preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000))}


# An environment in which `inspect --html` finds no OpenGL: its pictures take a second, and most tests do not look at them.
WITHOUT_PICTURES = os.environ | {"__EGL_VENDOR_LIBRARY_DIRS": "/nonexistent"}


def main(arguments=REST):
    unittest.main(argv=[sys.argv[0], *arguments])


def has_viewer():
    result = subprocess.run([BENDY, "render", "--help"], capture_output=True, text=True, check=False)
    return "--size" in result.stdout


class Case(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.shared = Path(tempfile.mkdtemp(prefix="bendy_tests_"))
        cls.addClassCleanup(shutil.rmtree, cls.shared)

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(dir=self.shared))

    def bendy(self, *arguments, **options):
        return subprocess.run([BENDY, *arguments], cwd=self.folder, capture_output=True, timeout=120, check=False,
                              **options)

    def done(self, *arguments, **options):
        """Runs what must work: its standard output; nothing but warnings may stand on standard error."""
        result = self.bendy(*arguments, **options)
        self.assertEqual(result.returncode, 0, (arguments, result.stderr))
        for line in result.stderr.decode().splitlines():
            self.assertTrue(line.startswith("bendy: warning: "), line)
        return result.stdout

    def failed(self, *arguments, file=None, **options):
        """Runs what must fail for its input: the one line of error; standard output stays empty."""
        result = self.bendy(*arguments, **options)
        self.assertEqual(result.returncode, 1, (arguments, result.stderr))
        self.assertEqual(result.stdout, b"")
        lines = result.stderr.decode().splitlines()
        self.assertEqual(len(lines), 1, lines)
        self.assertTrue(lines[0].startswith("bendy: error: " + (f"{file}: " if file is not None else "")), lines[0])
        return lines[0]

    def misused(self, *arguments):
        """Runs a wrong command line: what is said of it."""
        result = self.bendy(*arguments)
        self.assertEqual(result.returncode, 2, (arguments, result.stderr))
        self.assertEqual(result.stdout, b"")
        text = result.stderr.decode()
        self.assertTrue(text.startswith("bendy: error: "), text)
        return text

    def files(self):
        return sorted(entry.name for entry in self.folder.iterdir())

    def convert(self, name="mannequin"):
        """A converted example; made once for each class."""
        path = self.shared / f"{name}.bendy"
        if not path.exists():
            self.done("convert", SOURCE / "examples" / f"{name}.glb", "-o", path)
        return path

    def strange(self):
        path = self.shared / "strange.bendy"
        if not path.exists():
            self.done("convert", strange_file(self.shared / "strange.gltf"), "-o", path)
        return path

    def good_files(self):
        examples = sorted((SOURCE / "spec" / "examples").glob("*.bendy"))
        self.assertGreater(len(examples), 2)
        return [self.convert(), self.convert("tentacle"), self.strange(), *examples]
