"""The program built without the viewer: what draws says so, all else works."""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

BENDY = ""
SOURCE = pathlib.Path()


def bendy(*arguments):
    return subprocess.run([BENDY, *map(str, arguments)], capture_output=True, text=True, timeout=120)


class WithoutViewer(unittest.TestCase):
    def test_what_draws_says_so(self):
        for arguments in (["view"], ["view", SOURCE / "examples" / "tentacle.glb"],
                          ["render", SOURCE / "examples" / "tentacle.glb", "-o", "out.png"]):
            result = bendy(*arguments)
            self.assertEqual(result.returncode, 1, arguments)
            self.assertEqual(result.stdout, "")
            self.assertRegex(result.stderr, r".*built without the viewer \(BENDY_VIEWER=OFF\)")
        self.assertFalse(pathlib.Path("out.png").exists())

    def test_the_rest_works(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "tentacle.bendy"
            result = bendy("convert", SOURCE / "examples" / "tentacle.glb", "-o", out)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(bendy("validate", out).returncode, 0)


def main():
    global BENDY, SOURCE  # the test cases find them here
    parser = argparse.ArgumentParser()
    parser.add_argument("--bendy", required=True)
    parser.add_argument("--source", required=True, type=pathlib.Path)
    options, rest = parser.parse_known_args()
    BENDY = os.path.abspath(options.bendy)
    SOURCE = options.source.resolve()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
