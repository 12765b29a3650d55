#!/usr/bin/env python3
"""The program built without the viewer: what draws says so, all else works.

    without_viewer_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import sys
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from program import SOURCE, Case, main  # noqa: E402


class WithoutViewer(Case):
    def test_what_draws_says_so(self):
        for arguments in (["view"], ["view", SOURCE / "examples" / "tentacle.glb"],
                          ["render", SOURCE / "examples" / "tentacle.glb", "-o", "out.png"]):
            self.assertRegex(self.failed(*arguments), r".*built without the viewer \(BENDY_VIEWER=OFF\); the Debian package")
        self.assertEqual(self.files(), [])

    def test_the_rest_works(self):
        self.done("convert", SOURCE / "examples" / "tentacle.glb", "-o", "tentacle.bendy")
        self.done("validate", "tentacle.bendy")


if __name__ == "__main__":
    main()
