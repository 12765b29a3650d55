#!/usr/bin/env python3
"""`bendy validate`: exit status, and where it finds which error.

    validate_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import json
import re
import shutil
import struct
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from chunk_file import Chunk  # noqa: E402
from program import Case, main  # noqa: E402


def in_full(shown, path):
    """A line with a path as it is shown, the steps that "... N more ..." stands for filled in from the real one."""
    match = re.search(r"\.\.\. (\d+) more \.\.\.", shown)
    if not match:
        return shown
    before = shown[shown.rfind("(", 0, match.start()) + 1 : match.start()].count("/")
    return shown.replace(match.group(), "/".join(path.split("/")[before : before + int(match.group(1))]))


class Validate(Case):
    def test_a_path_is_whole_in_json(self):
        joint = Chunk("SKIN", children=[])  # without its PIVO
        for _ in range(20):
            joint = Chunk("SKIN", children=[joint])
        (self.folder / "deep.bendy").write_bytes(Chunk("HEAD", children=[Chunk("OBJE", children=[joint])]).write())
        (entry,) = json.loads(self.bendy("validate", "deep.bendy", "--json").stdout)
        self.assertIn("HEAD/OBJE" + 21 * "/SKIN", [fault["path"] for fault in entry["faults"]])
        self.assertIn(b"(HEAD/OBJE/SKIN/SKIN/SKIN/SKIN/... 11 more .../SKIN/",
                      self.bendy("validate", "deep.bendy").stdout)

    def test_good_files_are_silent(self):
        files = self.good_files()
        self.assertEqual(self.done("validate", *files), b"")
        report = json.loads(self.done("validate", "--json", *files))
        self.assertEqual([entry["file"] for entry in report], [str(file) for file in files])
        for entry in report:
            self.assertIs(entry["valid"], True)
            self.assertEqual(entry["faults"], [])

    def faults(self, data, name="bad.bendy"):
        """What is said of a broken file, from JSON; the text must say the same."""
        (self.folder / name).write_bytes(data)
        text = self.bendy("validate", name)
        self.assertEqual(text.returncode, 1)
        self.assertEqual(text.stderr, b"")
        result = self.bendy("validate", name, "--json")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr, b"")
        (entry,) = json.loads(result.stdout)
        self.assertEqual(entry["file"], name)
        self.assertIs(entry["valid"], False)
        lines = text.stdout.decode().splitlines()
        self.assertEqual(len(lines), len(entry["faults"]))
        for line, fault in zip(lines, entry["faults"]):
            self.assertTrue(line.startswith(f"{name}: {fault['code']}: {fault['message']} ("), line)
            self.assertTrue(line.endswith(f"offset {fault['offset']})"), line)
            self.assertIn(fault["path"], in_full(line, fault["path"]))  # JSON has it whole
            self.assertIn(fault["class"], ("malformed", "invalid", "unsupported", "io"))
        return entry["faults"]

    def test_every_cut_is_found(self):
        data = self.convert("tentacle").read_bytes()
        for size in (1, 15, 16, 17, 79, 1000, len(data) // 2, len(data) - 16, len(data) - 1):
            (fault,) = self.faults(data[:size])
            self.assertEqual(fault["class"], "malformed")
            self.assertEqual(fault["offset"], 0)
            if size >= 16:
                self.assertEqual((fault["code"], fault["path"]), ("TRUNCATED", "HEAD"))
        (fault,) = self.faults(data + bytes(16))
        self.assertEqual(fault["code"], "TRAILING_BYTES")

    def test_a_flipped_bit_is_found_where_it_is(self):
        data = self.convert("tentacle").read_bytes()
        leaves = [(path, chunk) for path, chunk in Chunk.read(data).walk() if chunk.children is None and chunk.payload]
        for path, chunk in leaves[:: max(1, len(leaves) // 25)]:
            broken = bytearray(data)
            broken[chunk.offset + 16 + len(chunk.payload) // 2] ^= 0x10
            faults = self.faults(bytes(broken))
            sums = [fault for fault in faults if fault["code"] == "SUM_MISMATCH"]
            places = [(fault["path"], fault["offset"]) for fault in sums]
            self.assertEqual(places, [(path, chunk.offset)])

    def test_a_wrong_value_with_right_sums_is_found_where_it_is(self):
        root = Chunk.read(self.convert("tentacle").read_bytes())
        self.assertEqual(root.write(), self.convert("tentacle").read_bytes())
        where = "HEAD/OBJE/SKIN/SKIN/PIVO/REST"
        rest = root.find(where)
        rest.payload = struct.pack("<4f", 0, 0, 0, 2) + rest.payload[16:]
        (fault,) = self.faults(root.write())
        self.assertEqual((fault["code"], fault["class"]), ("ROTATION_NOT_UNIT", "invalid"))
        self.assertEqual((fault["path"], fault["offset"]), (where, rest.offset))

    def test_all_faults_are_listed(self):
        root = Chunk.read(self.convert("tentacle").read_bytes())
        rests = [(path, chunk) for path, chunk in root.walk() if chunk.letters == "REST"]
        for _, chunk in rests:
            chunk.payload = chunk.payload[:16] + struct.pack("<f", float("nan")) + chunk.payload[20:]
        faults = self.faults(root.write())
        self.assertEqual([fault["code"] for fault in faults], ["NOT_FINITE"] * len(rests))
        for fault, (path, _) in zip(faults, rests):
            self.assertEqual(in_full(fault["path"], path), path)
        self.assertEqual([fault["offset"] for fault in faults], [chunk.offset for _, chunk in rests])

    def test_several_files_are_told_apart(self):
        (self.folder / "bad.bendy").write_bytes(b"nonsense")
        shutil.copy(self.convert("tentacle"), self.folder / "good.bendy")
        result = self.bendy("validate", "good.bendy", "bad.bendy", "good.bendy")
        self.assertEqual(result.returncode, 1)
        self.assertIn(b"bad.bendy: NOT_A_BENDY_FILE: ", result.stdout)
        self.assertNotIn(b"good.bendy", result.stdout)
        report = json.loads(self.bendy("validate", "good.bendy", "bad.bendy", "--json").stdout)
        self.assertEqual([(entry["file"], entry["valid"]) for entry in report],
                         [("good.bendy", True), ("bad.bendy", False)])

    def test_files_that_cannot_be_read_are_errors(self):
        (self.folder / "folder").mkdir()
        (self.folder / "bad.bendy").write_bytes(b"")
        shutil.copy(self.convert("tentacle"), self.folder / "good.bendy")
        for name in ("missing.bendy", "folder"):
            self.failed("validate", name, file=name)
            result = self.bendy("validate", "good.bendy", name, "bad.bendy")  # goes on with the rest
            self.assertEqual(result.returncode, 1)
            self.assertIn(name.encode(), result.stderr)
            self.assertIn(b"bad.bendy", result.stdout)
            (entry,) = json.loads(self.bendy("validate", name, "--json").stdout)
            self.assertIs(entry["valid"], False)
            self.assertEqual(entry["faults"][0]["class"], "io")

    def test_names_are_escaped(self):
        root = Chunk.read(self.convert("tentacle").read_bytes())
        name = "a\x1b[2Jb\n.bendy"
        (self.folder / name).write_bytes(root.write()[:-16])
        text = self.bendy("validate", name).stdout.decode()
        self.assertNotIn("\x1b", text)
        self.assertEqual(text.count("\n"), 1)


if __name__ == "__main__":
    main()
