#!/usr/bin/env python3
"""`bendy inspect`: text, JSON and bytes of chunks, constraints and IK chains.

    inspect_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
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
from gltf_file import GltfFile  # noqa: E402
from mesh_file import as_float, floats  # noqa: E402
from program import SOURCE, Case, main  # noqa: E402

INFINITY = float("inf")
FREE = (-INFINITY, INFINITY)
NONE = 0xFFFFFFFF


class Inspect(Case):
    def tree_of(self, lines):
        """The lines of the chunk tree, which stand below the summary and a heading."""
        return lines[lines.index("      offset         size  chunk") + 1 :]

    def test_the_text_shows_every_chunk_with_its_place(self):
        for path in self.good_files():
            lines = self.done("inspect", path, "--all").decode().splitlines()
            chunks = list(Chunk.read(path.read_bytes()).walk())
            self.assertIn(f"{path.stat().st_size:,} bytes", lines[0])
            lines = self.tree_of(lines)
            self.assertEqual(len(lines), len(chunks))
            for line, (_, chunk) in zip(lines, chunks):
                offset, size, letters = line.split()[:3]
                self.assertEqual((int(offset), int(size), letters), (chunk.offset, chunk.size(), chunk.letters))

    def test_the_short_text_folds_details_away(self):
        folded = self.tree_of(self.done("inspect", self.convert()).decode().splitlines())
        everything = self.tree_of(self.done("inspect", self.convert(), "--all").decode().splitlines())
        self.assertLess(len(folded), len(everything) / 2)
        places = [line.split()[0] for line in everything]
        self.assertTrue(all(line.split()[0] in places for line in folded))
        self.assertIn("mixamorig:LeftHand", "\n".join(folded))
        self.assertIn("Walk", "\n".join(folded))

    def test_a_clip_of_curves_alone_has_no_zero_tracks(self):
        file = GltfFile(scenes=[{"nodes": [0]}], nodes=[{"name": "lamp"}], extensionsUsed=["KHR_animation_pointer"])
        sampler = {"input": file.add([(0,), (1,)], "SCALAR"), "output": file.add([(0,), (1,)], "SCALAR")}
        file.document["animations"] = [{"name": "glow", "samplers": [sampler], "channels": [{"sampler": 0, "target": {
            "path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/extras/glow"}}}}]}]
        file.write(self.folder / "lamp.gltf")
        self.done("convert", "lamp.gltf", "-o", "lamp.bendy")
        self.assertRegex(self.done("inspect", "lamp.bendy").decode(), r'CYCL 0  "glow"  0 to 1 s, 1 curve\n')
        told = self.done("edit", "lamp.bendy", "-o", "two.bendy", "--merge", "lamp.bendy", "--same-name", "number").decode()
        self.assertIn('merged clip "glow.001": 1 curve\n', told)

    def test_json_has_every_chunk_with_its_place(self):
        for path in self.good_files():
            data = path.read_bytes()
            document = json.loads(self.done("inspect", path, "--json"))
            self.assertEqual(document["bytes"], len(data))
            self.assertTrue(document["file"].endswith(path.name))
            chunks = list(Chunk.read(data).walk())
            self.assertEqual(len(document["chunks"]), len(chunks))
            paths = []
            for number, (entry, (chunk_path, chunk)) in enumerate(zip(document["chunks"], chunks)):
                self.assertEqual(entry["number"], number)
                self.assertEqual((entry["id"], entry["offset"], entry["size"]),
                                 (chunk.letters, chunk.offset, chunk.size()))
                self.assertEqual(entry["container"], chunk.children is not None)
                self.assertEqual(int(entry["sum"], 16), struct.unpack_from("<I", data, chunk.offset + 4)[0])
                self.assertIsInstance(entry["meaning"], str)
                paths.append(chunk_path)
                if number == 0:
                    self.assertIsNone(entry["parent"])
                else:
                    self.assertEqual(paths[entry["parent"]], chunk_path.rpartition("/")[0])

    def test_json_has_the_fields_of_records(self):
        data = self.convert().read_bytes()
        root = Chunk.read(data)
        chunks = json.loads(self.done("inspect", self.convert(), "--json"))["chunks"]
        entries = {entry["offset"]: entry for entry in chunks}
        fields = lambda path: entries[root.find(path).offset]["fields"]  # noqa: E731
        version = fields("HEAD/VERS")
        self.assertEqual((version["objects"], version["joints"], version["clips"]), (1, 65, 2))
        self.assertTrue(version["generator"].startswith("bendy "))
        self.assertEqual(fields("HEAD/OBJE/SKIN/NAME"), {"text": root.find("HEAD/OBJE/SKIN/NAME").payload.decode()})
        for path, chunk in root.walk():
            if chunk.letters == "REST":
                self.assertEqual([as_float(c) for c in fields(path)["translation"]], floats(chunk.payload[16:28]))
            if chunk.letters == "TRAK":
                tracks = fields(path)["tracks"]
                self.assertEqual([(t["target"], t["keys"], t["first_value"]) for t in tracks],
                                 [(t[0], t[4], t[6]) for t in struct.iter_unpack("<IBBHIIQ", chunk.payload)])

    def test_hex_is_the_chunks_bytes(self):
        path = self.convert("tentacle")
        data = path.read_bytes()
        root = Chunk.read(data)
        for where in ("HEAD", "HEAD/VERS", "HEAD/OBJE/SKIN/NAME", "HEAD/OBJE/SKIN/SKIN/PIVO/REST", "HEAD/MATE[1]"):
            chunk = root.find(where)
            shown = b""
            for line in self.done("inspect", path, "--chunk", where, "--hex").decode().splitlines():
                offset, _, rest = line.strip().partition("  ")
                self.assertEqual(int(offset, 16), chunk.offset + len(shown))
                shown += bytes.fromhex(rest[:35])
            self.assertEqual(shown, data[chunk.offset : chunk.offset + 16 + chunk.size()])

    def test_one_chunk_by_path_and_by_offset(self):
        path = self.convert()
        root = Chunk.read(path.read_bytes())
        for where in ("HEAD/OBJE/CYCL[1]", "HEAD/OBJE/SKIN", "HEAD/OBJE/VECT[1]/TARG[1]/NAME", "HEAD"):
            chunk = root.find(where)
            for name in (where, f"@{chunk.offset}", f"@{chunk.offset + 15}"):
                entries = json.loads(self.done("inspect", path, "--chunk", name, "--json"))["chunks"]
                self.assertEqual([entry["offset"] for entry in entries], [inner.offset for _, inner in chunk.walk()])
                self.assertIsNone(entries[0]["parent"])
        lines = self.done("inspect", path, "--chunk", "HEAD/OBJE/CYCL[1]").decode()
        self.assertIn("Walk", lines)
        self.assertNotIn("Idle", lines)

    def test_a_path_to_nothing_fails(self):
        for where in ("HEAD/NONE", "HEAD/OBJE[1]", "OBJE", "HEAD/", "/HEAD", "HEAD/VERS/NAME", "HEAD/OBJE/SKIN[x]",
                      "HEAD/OBJE/SKIN[-1]", "HEAD/OBJE/SKIN[4294967296]", "@99999999", "@", "@-1", "@1x", "\x1b[31m"):
            for more in ([], ["--json"], ["--hex"], ["--all"]):
                line = self.failed("inspect", self.convert(), "--chunk", where, *more, file=self.convert())
                self.assertNotIn("\x1b", line)

    def test_json_and_hex_exclude_each_other(self):
        self.misused("inspect", self.convert(), "--json", "--hex")

    def test_names_are_escaped(self):
        for more in ([], ["--all"], ["--chunk", "HEAD/OBJE/SKIN"], ["--hex"]):
            text = self.done("inspect", self.strange(), *more).decode()
            self.assertFalse(any((ord(c) < 0x20 and c != "\n") or ord(c) == 0x7F for c in text))
            self.assertNotIn("\nbendy: error: forged", text)
        text = self.done("inspect", self.strange()).decode()
        self.assertIn("\\x1b[31m", text)
        self.assertIn("\u624b \u00e9", text)
        chunks = json.loads(self.done("inspect", self.strange(), "--json"))["chunks"]
        names = [entry["fields"]["text"] for entry in chunks if entry["id"] == "NAME"]
        self.assertIn("root\x1b[31m\nbendy: error: forged", names)

    def test_a_damaged_file_is_shown_and_is_an_error(self):
        data = bytearray(self.convert("tentacle").read_bytes())
        data[Chunk.read(bytes(data)).find("HEAD/OBJE/SKIN/NAME").offset + 16] ^= 1
        (self.folder / "bad.bendy").write_bytes(data)
        result = self.bendy("inspect", "bad.bendy")
        self.assertEqual(result.returncode, 1)
        self.assertIn(b"SKIN", result.stdout)
        self.assertRegex(result.stdout.decode(), r"\n +\d+ +\d+ +NAME  FAULT: the checksum does not match")
        self.assertRegex(result.stderr.decode(), r"^bendy: error: bad\.bendy: .*HEAD/OBJE/SKIN/NAME")

    def test_an_object_inside_of_an_unknown_chunk_is_none(self):
        head = Chunk.read((SOURCE / "spec/examples/smallest.bendy").read_bytes())
        head.children.append(Chunk("WXYZ", children=[Chunk("OBJE", children=[])]))
        (self.folder / "none.bendy").write_bytes(head.write())
        self.assertEqual(self.done("validate", "none.bendy"), b"")
        self.assertIn(b", no object\n", self.done("inspect", "none.bendy"))

    def test_a_file_without_structure_fails_with_its_place(self):
        data = self.convert("tentacle").read_bytes()
        (self.folder / "cut.bendy").write_bytes(data[:1000])
        for more in ([], ["--json"], ["--hex"], ["--chunk", "HEAD/VERS"]):
            self.assertRegex(self.failed("inspect", "cut.bendy", *more, file="cut.bendy"), r"\(HEAD, offset 0\)$")

    def test_joints_of_compact_files_have_their_names(self):
        self.done("convert", SOURCE / "examples/mannequin.glb", "--compact", "-q", "-o", "compact.bendy")
        joints = [re.search(r'SKIN .*?(?=, constraint|, extras|$)', line).group()
                  for line in self.done("inspect", "compact.bendy").decode().splitlines() if " SKIN " in line]
        exact = [re.search(r'SKIN .*?(?=, constraint|, extras|$)', line).group()
                 for line in self.done("inspect", self.convert()).decode().splitlines() if " SKIN " in line]
        self.assertEqual(joints, exact)
        self.assertTrue(any('SKIN 3  "mixamorig:Hips"  at ' in line for line in joints))


def limit(model, *ranges, order=0, scope=0, flags=0, soft_zone=0.0, translation=(FREE, FREE, FREE),
          stiffness=(0, 0, 0), preferred=(0, 0, 0)):
    """A LIMT; the ranges of X, Y, Z are (minimum, maximum) in degrees."""
    ranges = [*ranges, FREE, FREE, FREE][:3]
    return Chunk("LIMT", struct.pack(
        "<4B23f", model, order, scope, flags, soft_zone, 0, 0, 0, 1,
        *(math.radians(low) for low, _ in ranges), *(math.radians(high) for _, high in ranges),
        *(low for low, _ in translation), *(high for _, high in translation), *stiffness, *preferred))


def chain(start, effector, name=None, target=NONE, pole=NONE, solver=0, flags=0, iterations=0, priority=0,
          tolerance=0.0, pole_vector=(0, 0, 0), pole_angle=0.0, tip=(0, 0, 0), tip_rotation=(0, 0, 0, 1),
          position=1.0, rotation=0.0, influence=1.0, stretch=0.0, compress=0.0):
    info = struct.pack("<4I2BHB3x17f", start, effector, target, pole, solver, flags, iterations, priority, tolerance,
                       *pole_vector, pole_angle, *tip, *tip_rotation, position, rotation, influence, stretch, compress)
    names = [] if name is None else [Chunk("NAME", name.encode())]
    return Chunk("IKCH", children=[*names, Chunk("KINF", info)])


def pull(number, weight):
    return Chunk("PULL", struct.pack("<If", number, weight))


class InspectRig(Case):
    """Constraints and IK chains, as inspect shows them."""

    def joints(self, root):
        """The joints of a file with one object, in their order, and the number of each name."""
        joints = [joint for _, joint in root.walk() if joint.letters == "SKIN"]
        names = [next((c.payload.decode() for c in joint.children if c.letters == "NAME"), "") for joint in joints]
        return joints, names.index

    def pivot(self, joint):
        return next(chunk for chunk in joint.children if chunk.letters == "PIVO")

    def line(self, root, where, good=True):
        """What inspect says of one chunk."""
        path = self.folder / "rig.bendy"
        path.write_bytes(root.write())
        result = self.bendy("validate", path)
        self.assertEqual(result.returncode, 0 if good else 1, result.stdout)
        result = self.bendy("inspect", path, "--chunk", where, "--all")
        self.assertEqual(result.returncode, 0 if good else 1, result.stderr)
        line = result.stdout.decode().splitlines()[1]
        return re.fullmatch(r" *\d+ +\d+  \w{4}(?: \d+)?(?:  FAULT: .*?)?(?:  (.*))?", line)[1]

    def limit_line(self, chunk, good=True):
        root = Chunk.read((SOURCE / "spec" / "examples" / "one_joint.bendy").read_bytes())
        root.find("HEAD/OBJE/SKIN/PIVO").children.append(chunk)
        return self.line(root, "HEAD/OBJE/SKIN/PIVO/LIMT", good)

    def test_limits_are_in_degrees(self):
        for chunk, text in (
                (limit(0), "free"),
                (limit(1), "locked"),
                (limit(2, (0, 150)), "hinge 0 to 150 deg"),
                (limit(2), "hinge free"),
                (limit(2, (-INFINITY, 150)), "hinge up to 150 deg"),
                (limit(2, (-12.5, INFINITY)), "hinge from -12.5 deg"),
                (limit(3, (-35, 35), (-20, 20), (-25, 25), scope=1, flags=2),
                 "swing-twist ellipse, twist -35 to 35 deg, swing -20 to 20 and -25 to 25 deg, IK only, proposed"),
                (limit(4, FREE, FREE, (-25, 25)), "swing-twist pyramid, twist free, swing free and -25 to 25 deg"),
                (limit(4), "swing-twist pyramid, twist free, swing free and free"),
                (limit(5, (-1, 2), (-3, 4), (-5, 6), order=5), "Euler box ZYX -1 to 2, -3 to 4 and -5 to 6 deg"),
                (limit(6, (0, 30)), "largest angle 30 deg"),
                (limit(6), "largest angle free"),
                (limit(1, translation=((0, 0),) * 3), "locked, no translation"),
                (limit(0, translation=((0, 0), FREE, (-0.5, 0.25))),
                 "free, translation 0 to 0, free and -0.5 to 0.25 m"),
                (limit(0, scope=2, flags=1), "free, all but IK, approximated"),
                (limit(2, (10, 20), flags=5), "hinge 10 to 20 deg, approximated, rest outside"),
                (limit(0, stiffness=(0, 0.5, 1), soft_zone=math.radians(5), preferred=(math.radians(30), 0, 0)),
                 "free, stiffness 0 0.5 1, soft zone 5 deg, preferred 30 0 0 deg")):
            self.assertEqual(self.limit_line(chunk), text)

    def test_limits_without_sense_are_shown(self):
        self.assertEqual(self.limit_line(limit(99), good=False), "?")
        self.assertEqual(self.limit_line(limit(5, order=99), good=False), "Euler box ? free, free and free")
        self.assertEqual(self.limit_line(limit(2, (float("nan"), 1)), good=False), "hinge nan to 1 deg")
        self.assertEqual(self.limit_line(Chunk("LIMT", b"\x02"), good=False), "hinge free")

    def test_a_joint_says_what_limits_it(self):
        root = Chunk.read((SOURCE / "spec" / "examples" / "one_joint.bendy").read_bytes())
        where = "HEAD/OBJE/SKIN"
        self.assertEqual(self.line(root, where), '"pole"  at 0 1 0, 1 triangles')
        root.find(where + "/PIVO").children.append(limit(2, (0, 150)))
        root.find(where + "/PIVO").children.append(limit(1, scope=1))
        root.find(where).children.append(Chunk("EXTN", b"{}"))
        self.assertEqual(self.line(root, where), '"pole"  at 0 1 0, 1 triangles, '
                                                 'constraint: hinge 0 to 150 deg | locked, IK only, extensions')

    def test_a_joint_without_a_place_starts_with_what_it_has(self):
        root = Chunk.read((SOURCE / "spec" / "examples" / "one_joint.bendy").read_bytes())
        joint = root.find("HEAD/OBJE/SKIN")
        joint.children.remove(self.pivot(joint))
        self.assertEqual(self.line(root, "HEAD/OBJE/SKIN", good=False), '"pole"  1 triangles')

    def test_chains_name_their_joints(self):
        root = Chunk.read(self.convert().read_bytes())
        joints, number = self.joints(root)
        arm = [number(f"mixamorig:Left{part}") for part in ("Arm", "ForeArm", "Hand")]
        hips, head = number("mixamorig:Hips"), number("mixamorig:Head")
        at = root.find("HEAD/OBJE").children
        at[:] = [chunk for chunk in at if chunk.letters != "IKCH"]
        for joint in joints:
            self.pivot(joint).children[:] = [c for c in self.pivot(joint).children if c.letters != "PULL"]
        at += [chain(arm[0], arm[2], "IK_LeftArm", solver=2),
               chain(arm[0], arm[2], solver=4, target=head, pole=hips, position=0.75, rotation=0.5, influence=0.25,
                     flags=3),
               chain(hips, arm[2], solver=3),
               chain(arm[1], arm[1], "wrist\x1b", solver=5)]
        self.pivot(joints[arm[0]]).children.append(pull(0, 0.5))
        self.pivot(joints[arm[1]]).children += [pull(1, 0.125), pull(3, 0.25)]
        path = "mixamorig:LeftArm{} > mixamorig:LeftForeArm{} > mixamorig:LeftHand, "
        self.assertEqual(self.line(root, "HEAD/OBJE/IKCH"), '"IK_LeftArm"  ' + path.format(" (0.5)", "") + "two-bone")
        self.assertEqual(self.line(root, "HEAD/OBJE/IKCH[1]"),
                         path.format("", " (0.125)") + "FABRIK, target mixamorig:Head, pole mixamorig:Hips, "
                         "position 0.75, rotation 0.5, influence 0.25, approximated, proposed")
        self.assertRegex(self.line(root, "HEAD/OBJE/IKCH[2]"),
                         r"^mixamorig:Hips > \.\.\. \d more \.\.\. > mixamorig:LeftForeArm > mixamorig:LeftHand, CCD$")
        self.assertEqual(self.line(root, "HEAD/OBJE/IKCH[3]"), '"wrist\\x1b"  mixamorig:LeftForeArm (0.25), aim')
        pivot = next(where for where, chunk in root.walk() if chunk is self.pivot(joints[arm[0]]))
        self.assertEqual(self.line(root, pivot + "/PULL"), "0.5 in IK_LeftArm")
        pivot = next(where for where, chunk in root.walk() if chunk is self.pivot(joints[arm[1]]))
        self.assertEqual(self.line(root, pivot + "/PULL"), "0.125 in chain 1")
        self.assertEqual(self.line(root, pivot + "/PULL[1]"), "0.25 in wrist\\x1b")

    def test_a_chain_says_how_it_is_solved(self):
        root = Chunk.read(self.convert("tentacle").read_bytes())
        at = root.find("HEAD/OBJE").children
        at[:] = [chunk for chunk in at if chunk.letters != "IKCH"] + [
            chain(0, 0, iterations=1000, priority=7, tolerance=0.25, pole_vector=(0, 0, 1), pole_angle=math.pi / 2,
                  tip=(0, 0.5, 0), tip_rotation=(0, 1, 0, 0), stretch=0.5, compress=0.125)]
        for joint in self.joints(root)[0]:
            self.pivot(joint).children[:] = [c for c in self.pivot(joint).children if c.letters != "PULL"]
        short = self.line(root, "HEAD/OBJE/IKCH")
        self.assertTrue(short.endswith(", any solver"), short)
        self.assertEqual(self.line(root, "HEAD/OBJE/IKCH/KINF"),
                         short + ", at most 1,000 iterations, priority 7, tolerance 0.25 m, pole vector 0 0 1, "
                         "pole angle 90 deg, tip 0 0.5 0 m, tip rotation 0 1 0 0, stretch 0.5, compress 0.125")

    def test_chains_without_sense_are_shown(self):
        root = Chunk.read((SOURCE / "spec" / "examples" / "every_chunk.bendy").read_bytes())
        at = root.find("HEAD/OBJE").children
        at += [chain(1, 0), chain(NONE, 99, solver=200, target=5), Chunk("IKCH", children=[]),
               Chunk("IKCH", children=[Chunk("KINF", b"")])]
        self.pivot(root.find("HEAD/OBJE/SKIN")).children += [pull(5, 0.5), Chunk("PULL", b"")]
        line = lambda where: self.line(root, where, good=False)  # noqa: E731
        self.assertEqual(line("HEAD/OBJE/IKCH[1]"), "tip is not above root, any solver")
        self.assertEqual(line("HEAD/OBJE/IKCH[2]"),
                         "no joint 4294967295 is not above no joint 99, ?, target no joint 5")
        self.assertEqual(line("HEAD/OBJE/IKCH[3]"), None)
        self.assertEqual(line("HEAD/OBJE/IKCH[4]"), "root, any solver")
        self.assertEqual(line("HEAD/OBJE/SKIN/PIVO/PULL[1]"), "0.5 in no chain 5")

    def test_a_rope_with_many_chains_takes_no_time(self):
        joint = Chunk("SKIN", children=[Chunk("PIVO", children=[Chunk("REST", struct.pack("<10f", *[0.0] * 10))])])
        data = joint.write()
        for _ in range(3000):  # Chunk.write recurses, so the rope is made by hand
            body = joint.children[0].write() + data
            head = b"SKIN" + bytes(4) + struct.pack("<Q", len(body) | 1 << 48)
            data = head + body
        body = data + chain(0, 3000).write() * 3000
        body = b"OBJE" + bytes(4) + struct.pack("<Q", len(body) | 1 << 48) + body
        (self.folder / "rope.bendy").write_bytes(b"HEAD" + bytes(4) + struct.pack("<Q", len(body) | 1 << 48) + body)
        text = self.bendy("inspect", "rope.bendy").stdout.decode()
        self.assertEqual(text.count("joint 0 > ... 2,998 more ... > joint 2999 > joint 3000"), 3000)

    def test_json_has_no_infinities(self):
        root = Chunk.read((SOURCE / "spec" / "examples" / "every_chunk.bendy").read_bytes())
        (self.folder / "rig.bendy").write_bytes(root.write())
        text = self.done("inspect", "rig.bendy", "--json")
        chunks = json.loads(text, parse_constant=self.fail)["chunks"]
        (fields,) = [entry["fields"] for entry in chunks if entry["id"] == "LIMT"]
        payload = root.find("HEAD/OBJE/SKIN/SKIN/PIVO/LIMT").payload
        self.assertEqual((fields["model"], fields["frame"]), (3, [0.5] * 4))
        self.assertEqual([as_float(angle) for angle in fields["rotation_min"]], floats(payload[24:36]))
        self.assertEqual([fields["translation_min"], fields["translation_max"]], [[None] * 3] * 2)
        (fields,) = [entry["fields"] for entry in chunks if entry["id"] == "KINF"]
        self.assertEqual([fields[key] for key in ("start", "effector", "target", "solver")], [0, 1, NONE, 3])
        self.assertEqual(fields["tip_offset"], [0, 1, 0])
        (fields,) = [entry["fields"] for entry in chunks if entry["id"] == "PULL"]
        self.assertEqual(fields, {"chain": 0, "weight": 0.5})


if __name__ == "__main__":
    main()
