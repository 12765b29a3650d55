#!/usr/bin/env python3
"""`bendy diff`: which differences it finds and how it prints them.

    diff_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import json
import math
import re
import struct
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from chunk_file import Chunk  # noqa: E402
from mesh_file import floats  # noqa: E402
from program import SOURCE, Case, main  # noqa: E402


class Diff(Case):
    def edited(self, change, source=None, name="edited.bendy"):
        """A copy of a file with a change made to its tree, and right sums."""
        root = Chunk.read((source or self.convert()).read_bytes())
        change(root)
        path = self.folder / name
        path.write_bytes(root.write())
        self.assertEqual(self.done("validate", path), b"")
        return path

    def differ(self, *arguments):
        """The lines that are printed of two files that differ."""
        result = self.bendy("diff", *arguments)
        self.assertEqual((result.returncode, result.stderr), (1, b""), result)
        lines = result.stdout.decode().splitlines()
        self.assertTrue(lines)
        return lines

    def trouble(self, *arguments):
        result = self.bendy("diff", *arguments)
        self.assertEqual((result.returncode, result.stdout), (2, b""), result)
        self.assertEqual(len(result.stderr.decode().splitlines()), 1)
        return result.stderr.decode()

    @staticmethod
    def set_bytes(path, offset, data):
        def change(root):
            chunk = root.find(path)
            chunk.payload = chunk.payload[:offset] + data + chunk.payload[offset + len(data):]
        return change

    def test_a_file_is_like_itself(self):
        for path in self.good_files():
            self.assertEqual(self.done("diff", path, path), b"")
            self.assertTrue(json.loads(self.done("diff", path, path, "--json"))["same"])

    def test_a_field_is_named_with_both_values(self):
        path = self.edited(self.set_bytes("HEAD/OBJE/SKIN/PIVO/REST", 16, struct.pack("<f", 0.125)))
        self.assertEqual(self.differ(self.convert(), path),
                         ['! HEAD/OBJE/SKIN/PIVO/REST "Mannequin": translation: 0 0 0 -> 0.125 0 0'])
        self.assertEqual(self.differ(path, self.convert()),
                         ['! HEAD/OBJE/SKIN/PIVO/REST "Mannequin": translation: 0.125 0 0 -> 0 0 0'])

    def test_streams_say_how_many_how_much_and_where(self):
        def change(root):
            self.set_bytes("HEAD/OBJE/VECT/POSI", 16 + 12 * 5 + 4, struct.pack("<f", 100))(root)
            self.set_bytes("HEAD/OBJE/VECT/POSI", 16 + 12 * 9, struct.pack("<3f", 7, 8, 9))(root)
        line, = self.differ(self.convert(), self.edited(change))
        self.assertRegex(line, r'^! HEAD/OBJE/VECT/POSI "Body": 4 of 10,389 numbers differ, by up to 9\d\.\d+; '
                               r"the first: element 5, component 1: \S+ -> 100$")

    def test_roles_are_compared_joint_by_joint(self):
        changed = self.folder / "roles.bendy"
        self.done("edit", self.convert(), "--role", "jaw=mixamorig:Head", "--role", "neck=", "-o", changed)
        self.assertEqual(self.differ(self.convert(), changed),
                         ['! HEAD/OBJE/ROLE "Scene": joint 7 "mixamorig:Neck": "neck" -> none',
                          '! HEAD/OBJE/ROLE "Scene": joint 8 "mixamorig:Head": "head" -> "jaw"'])
        tail = self.folder / "tail.bendy"
        self.done("edit", changed, "--role", "tail:2=mixamorig:Neck", "-o", tail)
        self.assertEqual(self.differ(changed, tail), ['! HEAD/OBJE/ROLE "Scene": joint 7 "mixamorig:Neck": none -> "tail 2"'])

    def test_texts_are_shown(self):
        def change(root):
            root.find("HEAD/OBJE/CYCL/NAME").payload = b"Wave\n"
        self.assertEqual(self.differ(self.convert(), self.edited(change)),
                         ['! HEAD/OBJE/CYCL/NAME "Idle": text: "Idle" -> "Wave\\x0a"'])

    def test_one_clip_more_is_one_difference(self):
        def change(root):
            clips = [chunk for chunk in root.find("HEAD/OBJE").children if chunk.letters == "CYCL"]
            new = Chunk("CYCL", children=[Chunk("NAME", b"New"), clips[0].children[1]])
            new.children += [chunk for chunk in clips[0].children if chunk.letters in ("TRAK", "TIME", "KEYV")]
            objects = root.find("HEAD/OBJE").children
            objects.insert(objects.index(clips[0]), new)
            version = root.find("HEAD/VERS")
            count, = struct.unpack_from("<I", version.payload, 32)
            version.payload = version.payload[:32] + struct.pack("<I", count + 1) + version.payload[36:]
        path = self.edited(change)
        self.assertEqual(self.differ(self.convert(), path),
                         ["! HEAD/VERS: clips: 2 -> 3", '+ HEAD/OBJE/CYCL "New": only in B'])
        self.assertEqual(self.differ(path, self.convert()),
                         ["! HEAD/VERS: clips: 3 -> 2", '- HEAD/OBJE/CYCL "New": only in A'])

    def test_another_order_is_said(self):
        def change(root):
            children = root.find("HEAD/OBJE").children
            places = [place for place, chunk in enumerate(children) if chunk.letters == "CYCL"]
            children[places[0]], children[places[1]] = children[places[1]], children[places[0]]
        self.assertEqual(self.differ(self.convert(), self.edited(change)),
                         ['! HEAD/OBJE/CYCL[1] "Walk" (in B: HEAD/OBJE/CYCL): is in another order'])

    def test_tracks_are_paired_by_what_they_animate(self):
        def change(root):
            table = root.find("HEAD/OBJE/CYCL[1]/TRAK")
            rows = [table.payload[at : at + 24] for at in range(0, len(table.payload), 24)]
            table.payload = b"".join(rows[1:][::-1])
        lines = self.differ(self.convert(), self.edited(change))
        self.assertEqual(len(lines), 1)
        self.assertRegex(lines[0], r'^- HEAD/OBJE/CYCL\[1\] "Walk": track joint \d+ \w+: only in A$')

    def test_keys_are_compared_track_by_track(self):
        def change(root):
            self.set_bytes("HEAD/OBJE/CYCL/TIME", 0, struct.pack("<f", 0.001))(root)
        lines = self.differ(self.convert(), self.edited(change))
        self.assertTrue(all(": times: 1 of " in line and line.endswith("element 0: 0 -> 0.001") for line in lines))

    def test_other_keys_with_the_same_course_are_within_a_tolerance(self):
        """Keys in the middle of straight lines."""
        def change(root):
            chunk = root.find("HEAD/OBJE/CYCL")
            parts = {part.letters: part for part in chunk.children}
            times, values = floats(parts["TIME"].payload), floats(parts["KEYV"].payload)
            rows = [list(struct.unpack_from("<IBBHIIQ", parts["TRAK"].payload, at))
                    for at in range(0, len(parts["TRAK"].payload), 24)]
            row = next(row for row in rows if row[1] == 1 and row[2] == 1 and row[4] >= 2)
            keys, first_time, first_value = row[4:]
            own_times, own_values = times[first_time:][:keys], values[first_value:][: keys * 4]
            a, b = own_values[:4], own_values[4:8]
            sign = 1 if sum(x * y for x, y in zip(a, b)) > 0 else -1
            middle = [x + sign * y for x, y in zip(a, b)]
            length = math.sqrt(sum(x * x for x in middle))
            own_values[4:4] = [x / length for x in middle]
            own_times[1:1] = [(own_times[0] + own_times[1]) / 2]
            row[4:] = keys + 1, len(times), len(values)
            parts["TIME"].payload += struct.pack(f"<{len(own_times)}f", *own_times)
            parts["KEYV"].payload += struct.pack(f"<{len(own_values)}f", *own_values)
            parts["TRAK"].payload = b"".join(struct.pack("<IBBHIIQ", *row) for row in rows)
        path = self.edited(change)
        self.assertTrue(any(": keys: " in line for line in self.differ(self.convert(), path)))
        self.done("diff", self.convert(), path, "--tolerance", "0.01mm")

    def test_another_type_of_numbers_is_a_field(self):
        """Numbers from 0 to 1 as u16 and as floats: what another writer may choose."""
        def coords(kind, count, data):
            record = struct.pack("<BBHIII", kind, int(kind != 5), 2, count // 2, 0, 0)
            return Chunk("TEXC", record + data)
        def change(as_floats):
            def change(root):
                mesh = root.find("HEAD/OBJE/VECT")
                count = 2 * struct.unpack_from("<I", root.find("HEAD/OBJE/VECT/VINF").payload)[0]
                whole = [(7 * place) % 65536 for place in range(count)]
                mesh.children = [chunk for chunk in mesh.children if chunk.letters != "TEXC"]
                if as_floats:
                    part = coords(5, count, struct.pack(f"<{count}f", *((n + 0.25) / 65535 for n in whole)))
                else:
                    part = coords(2, count, struct.pack(f"<{count}H", *whole))
                mesh.children.append(part)
            return change
        base = self.edited(change(True), name="base.bendy")
        path = self.edited(change(False))
        lines = self.differ(base, path)
        self.assertTrue(any("component_type: 5 -> 2" in line for line in lines))

    def test_sparse_and_dense_targets_are_the_same_displacements(self):
        def change(root):
            for path, chunk in root.walk():
                if chunk.letters != "TARG":
                    continue
                parts = {part.letters: part for part in chunk.children}
                if "INDX" not in parts:
                    continue
                vertices, = struct.unpack_from("<I", root.find(path.rpartition("/")[0] + "/VINF").payload)
                width = "H" if parts["INDX"].payload[0] == 2 else "I"
                touched = [index for index, in struct.iter_unpack("<" + width, parts["INDX"].payload[16:])]
                for letters in ("POSI", "NORM", "TANG"):
                    if letters not in parts:
                        continue
                    numbers = [0.0] * (3 * vertices)
                    for place, three in zip(touched, struct.iter_unpack("<3f", parts[letters].payload[16:])):
                        numbers[3 * place : 3 * place + 3] = three
                    head = parts[letters].payload[:4] + struct.pack("<I", vertices) + parts[letters].payload[8:16]
                    parts[letters].payload = head + struct.pack(f"<{len(numbers)}f", *numbers)
                chunk.children.remove(parts["INDX"])
                return
            self.fail("no sparse target")
        path = self.edited(change)
        self.assertTrue(any("INDX" in line for line in self.differ(self.convert(), path)))
        self.done("diff", self.convert(), path, "--tolerance", "0.001mm")
        self.done("diff", path, self.convert(), "--tolerance", "0.001mm")

    def test_unknown_chunks_are_compared_as_bytes(self):
        base = self.edited(lambda root: root.children.append(Chunk("ZZZZ", b"0123456789")), name="base.bendy")
        other = self.edited(self.set_bytes("HEAD/ZZZZ", 3, b"x4y"), base)
        self.assertEqual(self.differ(base, other), ["! HEAD/ZZZZ: 2 of 10 bytes differ, the first at 3"])
        self.assertEqual(self.differ(self.convert(), base), ["+ HEAD/ZZZZ: only in B"])

    def test_json_says_the_same(self):
        path = self.edited(self.set_bytes("HEAD/OBJE/SKIN/PIVO/REST", 16, struct.pack("<f", 0.125)))
        result = self.bendy("diff", self.convert(), path, "--json")
        self.assertEqual(result.returncode, 1)
        report = json.loads(result.stdout)
        self.assertFalse(report["same"])
        self.assertEqual(report["differences"], [{
            "kind": "value", "pathInA": "HEAD/OBJE/SKIN/PIVO/REST", "pathInB": "HEAD/OBJE/SKIN/PIVO/REST",
            "name": "Mannequin", "part": "translation", "a": [0.0, 0.0, 0.0], "b": [0.125, 0.0, 0.0]}])

    def exact_and_compact(self):
        """The mannequin exactly and compactly, and the worst error in millimetres that the converter has printed."""
        exact = self.convert()
        text = self.done("convert", SOURCE / "examples/mannequin.glb", "--compact", "-o", "compact.bendy").decode()
        return exact, self.folder / "compact.bendy", text

    def test_a_compact_file_is_the_exact_one_within_the_printed_bound(self):
        exact, compact, text = self.exact_and_compact()
        bound, worst = re.search(r"error +at most (\S+ mm); worst measured (\S+) mm", text).groups()
        self.differ(exact, compact)
        for pair in ((exact, compact), (compact, exact)):
            self.assertIn("; worst measured ", self.done("diff", *pair, "--tolerance", bound).decode())
        report = json.loads(self.done("diff", exact, compact, "--tolerance", "0.005%", "--json"))
        self.assertTrue(report["same"])
        self.assertAlmostEqual(1000 * report["worst"], float(worst), delta=0.01 * float(worst))
        self.assertIn('mesh "Body"', report["worstPlace"])
        lines = self.differ(exact, compact, "--tolerance", f"{float(worst) / 10}mm")
        self.assertTrue(lines[0].startswith('! mesh "Body", vertex '), lines)
        self.done("convert", compact, "--exact", "-o", "decoded.bendy")
        self.done("diff", exact, "decoded.bendy", "--tolerance", bound)

    def test_characters_differ_by_what_is_named(self):
        def rest(root):
            self.set_bytes("HEAD/OBJE/SKIN/SKIN/PIVO/REST", 16, struct.pack("<f", 0.125))(root)
        path = self.edited(rest)
        lines = self.differ(self.convert(), path, "--tolerance", "1mm")
        self.assertTrue(any(re.match(r'! joint ".*", at rest: .* mm apart', line) for line in lines), lines)
        def vertex(root):
            self.set_bytes("HEAD/OBJE/VECT/POSI", 16 + 12 * 5 + 4, struct.pack("<f", 0.9))(root)
        lines = self.differ(self.convert(), self.edited(vertex), "--tolerance", "1mm")
        self.assertTrue(lines[0].startswith('! mesh "Body", vertex 5, at rest: '), lines)
        report = json.loads(self.bendy("diff", self.convert(), path, "--tolerance", "1mm", "--json").stdout)
        self.assertEqual((report["same"], report["differences"][0]["kind"]), (False, "distance"))

    def test_damaged_files_and_wrong_command_lines_are_trouble(self):
        good = self.convert()
        data = bytearray(good.read_bytes())
        data[4000] ^= 1
        (self.folder / "bad.bendy").write_bytes(data)
        for pair in ((good, "bad.bendy"), ("bad.bendy", good)):
            self.assertIn("bendy: error: bad.bendy: ", self.trouble(*pair))
        self.assertIn("missing.bendy", self.trouble(good, "missing.bendy"))
        self.assertIn("not a bendy file", self.trouble(SOURCE / "README.md", good))
        self.misused("diff", good)
        for wrong in ("-1", "0", "1e-4", "nan", "inf", "much", "1 parsec", "-1mm", ""):
            self.misused("diff", good, good, "--tolerance", wrong)

    def test_many_differences_are_counted(self):
        """A thousand are listed."""
        def tree(text):
            base = Chunk.read(self.convert("tentacle").read_bytes())
            base.children += [Chunk("ZZZZ", text + str(n).encode()) for n in range(1500)]
            return base
        for name in (b"a", b"b"):
            (self.folder / name.decode()).write_bytes(tree(name).write())
        lines = self.differ("a", "b")
        self.assertEqual((len(lines), lines[-1]), (1001, "500 more differences"))


if __name__ == "__main__":
    main()
