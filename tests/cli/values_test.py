#!/usr/bin/env python3
"""Files whose structure is good and whose numbers are not: every command that needs the numbers refuses them with the place, as
`bendy validate` does; `bendy inspect` shows them.

    values_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import json
import struct
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from chunk_file import Chunk  # noqa: E402
from program import SOURCE, Case, has_viewer, main  # noqa: E402

NAN, INFINITE = float("nan"), float("inf")
ROPE = SOURCE / "tests" / "seeds" / "rope_rigged.bendy"
ROTATION, TRANSLATION, SCALE = 0, 16, 28  # where a REST has them


class BadValues(Case):
    def bad(self, *changes):
        """Writes a file with other numbers in it and right sums; each change: a kind of chunk, which one of them, the byte in
        its payload, from the end if it is negative, and the numbers."""
        tree = Chunk.read(ROPE.read_bytes())
        for letters, which, at, *numbers in changes:
            chunk = [chunk for _, chunk in tree.walk() if chunk.letters == letters][which]
            payload = bytearray(chunk.payload)
            struct.pack_into(f"<{len(numbers)}f", payload, at % len(payload), *numbers)
            chunk.payload = bytes(payload)
        (self.folder / "bad.bendy").write_bytes(tree.write())

    def commands(self):
        yield ("pose", "bad.bendy")
        yield ("pose", "bad.bendy", "--clip", "0", "--frames", "0..2@10", "-o", "p#.obj")
        yield ("bench", "bad.bendy", "--rounds", "1")
        yield ("export", "bad.bendy", "-o", "out.glb")
        yield ("edit", "bad.bendy", "--strip", "markers", "-o", "out.bendy")
        yield ("convert", "bad.bendy", "-o", "out.bendy")
        yield ("rig", "bad.bendy")
        if has_viewer():
            yield ("render", "bad.bendy", "--size", "16x16", "-o", "out.png")

    def test_numbers_that_are_none_are_refused_with_their_place(self):
        for change in (("REST", 2, TRANSLATION, NAN), ("REST", 1, SCALE, INFINITE), ("REST", 1, ROTATION, 0, 0, 0, 0),
                       ("KEYV", 0, 0, NAN), ("TIME", 1, -4, INFINITE), ("PALT", 0, -4, NAN), ("POSI", 0, -4, NAN), ("LIMT", 0, 48, NAN)):
            with self.subTest(change=change):
                self.bad(change)
                fault = json.loads(self.bendy("validate", "bad.bendy", "--json").stdout)[0]["faults"][0]
                self.assertTrue(fault["path"].endswith(change[0]) or change[0] == "TIME", fault)
                place = f"({fault['path']}, offset {fault['offset']})"
                for line in self.commands():
                    self.assertIn(place, self.failed(*line, file="bad.bendy"), line)
                self.assertEqual(self.files(), ["bad.bendy"])

    def test_inspect_shows_them_and_fails(self):
        self.bad(("REST", 2, TRANSLATION, NAN))
        result = self.bendy("inspect", "bad.bendy")
        self.assertEqual(result.returncode, 1)
        lines = [line for line in result.stdout.decode().splitlines() if "FAULT" in line]
        self.assertRegex("\n".join(lines), r"^ *\d+ +\d+ +REST  FAULT: element 0 is not a finite number(  .*)?$")
        self.assertIn("CYCL", result.stdout.decode())
        self.assertRegex(result.stderr.decode(), r"^bendy: error: bad\.bendy: .*\(HEAD/OBJE/SKIN\[1\]/SKIN/PIVO/REST, offset \d+\)\n$")
        result = self.bendy("inspect", "bad.bendy", "--json")
        self.assertEqual(result.returncode, 1)
        document = json.loads(result.stdout)
        self.assertIsNone(document["summary"])
        self.assertEqual([(entry["id"], entry["fault"]) for entry in document["chunks"] if "fault" in entry],
                         [("REST", "element 0 is not a finite number")])
        self.failed("inspect", "bad.bendy", "--summary", file="bad.bendy")
        result = self.bendy("inspect", "bad.bendy", "--html", "page.html")
        self.assertEqual(result.returncode, 1)
        self.assertIn("is not a finite number", (self.folder / "page.html").read_text())

    def test_a_clip_from_elsewhere_is_refused_too(self):
        self.bad(("KEYV", 0, 0, NAN))
        line = self.failed("edit", self.convert(), "--retarget", "bad.bendy", "-o", "out.bendy")
        self.assertIn("is not a finite number", line)

    def test_poses_out_of_range_are_no_results(self):
        self.bad(("REST", 1, SCALE, 1e30, 1e30, 1e30), ("REST", 2, TRANSLATION, 1e30, 1e30, 1e30))
        for line in self.commands():
            if line[0] not in ("pose", "render"):
                continue
            self.assertIn("out of a float's range", self.failed(*line, file="bad.bendy"), line)


if __name__ == "__main__":
    main()
