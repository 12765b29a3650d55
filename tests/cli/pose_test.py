#!/usr/bin/env python3
"""`bendy pose`: OBJ, PLY and JSON of a pose.

    pose_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import json
import math
import os
import struct
import sys
import time
import unittest
import unittest.mock
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from chunk_file import Chunk  # noqa: E402
from mesh_file import as_float, read_obj, read_ply  # noqa: E402
from program import FULL_DISK, SOURCE, Case, main  # noqa: E402
sys.path.insert(0, str(Path(__file__).parent.parent / "seeds"))
import make_seeds  # noqa: E402


class PoseCommand(Case):
    def pose(self, path, *arguments):
        """The same pose in all three formats; JSON comes back, the others must agree with it."""
        for name in ("out.obj", "out.ply", "out.json"):
            self.assertEqual(self.done("pose", path, *arguments, "-o", name), b"")
        document = json.loads((self.folder / "out.json").read_text(encoding="utf-8"))
        obj = read_obj((self.folder / "out.obj").read_text(encoding="utf-8"))
        ply = read_ply((self.folder / "out.ply").read_bytes())
        positions, faces, normals = [], [], []
        for mesh in document["meshes"]:
            base = len(positions)
            numbers = [as_float(number) for number in mesh["positions"]]
            positions += list(zip(*[iter(numbers)] * 3))
            faces += [tuple(base + index for index in face) for face in zip(*[iter(mesh["indices"])] * 3)]
            here = [as_float(number) for number in mesh["normals"]]
            normals += list(zip(*[iter(here)] * 3)) if here else [(0.0, 0.0, 0.0)] * (len(positions) - base)
        has_normals = any(mesh["normals"] for mesh in document["meshes"])
        self.assertEqual(obj["v"], positions)
        self.assertEqual(obj["f"], faces)
        self.assertEqual(obj["vn"], normals if has_normals else [])
        self.assertEqual([vertex[:3] for vertex in ply["vertex"]], positions)
        self.assertEqual([vertex[3:] for vertex in ply["vertex"]], normals if has_normals else [()] * len(positions))
        self.assertEqual(ply["face"], faces)
        self.assertEqual(ply.get("edge", []), obj["l"])
        self.assertEqual(len(obj["o"]), len(document["meshes"]))
        self.assertEqual(self.done("pose", path, *arguments), (self.folder / "out.obj").read_bytes())
        return document

    def test_levels_of_detail(self):
        # Wide kernels add up a vertex's bones in an order that depends on its neighbours; the plain one does not.
        environment = unittest.mock.patch.dict(os.environ, BENDY_KERNEL="plain")
        environment.start()
        self.addCleanup(environment.stop)
        path = self.shared / "levels.bendy"
        summary = self.done("convert", "--lod", SOURCE / "examples" / "mannequin.glb", "-o", path).decode()
        self.assertRegex(summary, r"levels +100 % [\d,]+, 50 % [\d,]+ \(.*, fewest [\d,]+ triangles \(.* mm off\)\n")
        self.assertEqual(self.done("validate", path), b"")
        self.assertRegex(self.done("inspect", path).decode(), r"LODD .*meshes?, .*down to .*error at most")
        whole = self.pose(path, "--clip", "Walk", "--time", "0.25")
        exact = self.pose(self.convert(), "--clip", "Walk", "--time", "0.25")

        def places(document):
            return [sorted((tuple(mesh["positions"][3 * i:3 * i + 3]) for i in mesh["indices"]))
                    for mesh in document["meshes"]]

        self.assertEqual(places(whole), places(exact))
        triangles = sum(len(mesh["indices"]) // 3 for mesh in whole["meshes"])
        for share in ("0.5", "0.25"):
            some = self.pose(path, "--clip", "Walk", "--time", "0.25", "--lod", share)
            count = sum(len(mesh["indices"]) // 3 for mesh in some["meshes"])
            self.assertLessEqual(count, float(share) * triangles)
            self.assertGreater(count, 0.8 * float(share) * triangles)
            for few, many in zip(some["meshes"], whole["meshes"]):
                self.assertEqual(few["positions"], many["positions"][:len(few["positions"])])
            self.assertLess(sum(len(mesh["positions"]) for mesh in some["meshes"]),
                            sum(len(mesh["positions"]) for mesh in whole["meshes"]))

    def test_vertices_that_were_sorted_come_in_the_order_of_the_source(self):
        environment = unittest.mock.patch.dict(os.environ, BENDY_KERNEL="plain")
        environment.start()
        self.addCleanup(environment.stop)
        source, exact, stored = (self.shared / name for name in ("bent.gltf", "bent.bendy", "kept.bendy"))
        make_seeds.rope(source, joints=10, rings=8, step=7)
        self.done("convert", source, "-o", exact)
        self.done("convert", "--keep-order", source, "-o", stored)
        self.assertEqual(self.done("validate", exact), b"")
        streams = [Chunk.read(path.read_bytes()).find("HEAD/OBJE/VECT/POSI").payload for path in (exact, stored)]
        self.assertNotEqual(*streams)
        for suffix in ("json", "obj", "ply"):
            posed = []
            for path in (exact, stored):
                out = path.with_suffix("." + suffix)
                self.done("pose", path, "--clip", "#0", "--time", "0.25", "-o", out)
                posed.append(out.read_bytes().replace(path.name.encode(), b""))
            self.assertEqual(*posed)
        self.done("export", exact, "-o", exact.with_suffix(".glb"))
        self.done("export", stored, "-o", stored.with_suffix(".glb"))
        self.assertEqual(exact.with_suffix(".glb").read_bytes(), stored.with_suffix(".glb").read_bytes())
        again = self.shared / "again.bendy"
        for options, original in (([], exact), (["--keep-order"], stored)):
            for path in (exact, stored):
                self.done("convert", "--force", *options, path, "-o", again)
                self.assertEqual(again.read_bytes(), original.read_bytes())
        for other in ("--lod", "--compact", "--max-error=1mm"):
            self.assertIn("--keep-order", self.misused("convert", "x.glb", "--keep-order", other))

    def test_frames_of_a_clip(self):
        path = self.convert()
        for suffix in ("obj", "ply", "json"):
            self.done("pose", path, "--clip", "Walk", "--frames", "8..11@25", "-o", f"run_###.{suffix}")
            files = sorted(file.name for file in self.folder.glob(f"run_*.{suffix}"))
            self.assertEqual(files, [f"run_{frame:03}.{suffix}" for frame in range(8, 12)])
            for frame in range(8, 12):
                self.done("pose", path, "--clip", "Walk", "--time", str(frame / 25), "-o", f"one.{suffix}")
                self.assertEqual((self.folder / f"run_{frame:03}.{suffix}").read_bytes(),
                                 (self.folder / f"one.{suffix}").read_bytes(), frame)

    def test_the_number_of_a_frame_replaces_the_last_run_of_signs(self):
        for name, file in (("#.obj", "12.obj"), ("a#b##.obj", "a#b12.obj"), ("#####_x.obj", "00012_x.obj")):
            self.done("pose", self.convert(), "--clip", "Walk", "--frames", "12..12@100", "-o", name)
            self.assertTrue((self.folder / file).is_file(), file)

    def test_the_clips_curves_and_targets_of_every_frame(self):
        said = self.bendy("pose", self.convert(), "--clip", "Walk", "--frames", "0..3@10", "--reach",
                          "IK_LeftArm=0.1,1.25,-0.2", "-o", "r#.json")
        self.assertEqual(said.returncode, 0)
        self.assertRegex(said.stderr, rb"falls short of its target by up to .* of 4 poses")
        documents = [json.loads((self.folder / f"r{frame}.json").read_text()) for frame in range(4)]
        self.assertEqual([document["time"] for document in documents], [0, 0.1, 0.2, 0.3])
        self.assertEqual(len({document["reaches"][0]["distance"] for document in documents}), 4)

    def test_frames_follow_one_another_and_are_the_same_in_every_range(self):
        model = self.convert()

        def frames(first, last):
            self.bendy("pose", model, "--clip", "Idle", "--frames", f"{first}..{last}@60", "--reach", "IK_LeftArm=-0.2,1.5,0.3", "-o", "s#.json")
            return [json.loads((self.folder / f"s{frame}.json").read_text()) for frame in range(first, last + 1)]
        whole = frames(0, 60)
        self.assertEqual(frames(40, 44), whole[40:45])

        def turned(a, b):
            """The largest angle between the joints of two poses, degrees."""
            cosines = []
            for one, other in zip(a["joints"], b["joints"]):
                axes = [[[float(n) for n in joint["world"][4 * k:4 * k + 3]] for k in range(3)] for joint in (one, other)]
                trace = sum(sum(p * q for p, q in zip(u, v)) / math.hypot(*u) / math.hypot(*v) for u, v in zip(*axes))
                cosines.append((trace - 1) / 2)
            return math.degrees(math.acos(min(1.0, min(cosines))))
        self.assertLess(max(turned(one, other) for one, other in zip(whole, whole[1:])), 6.0)

    def test_a_solver_that_makes_one_step_says_so(self):
        for solver, is_said in (("pull", True), ("ccd", False)):
            said = self.bendy("pose", self.convert(), "--reach", "IK_LeftArm=0.1,1.25,-0.2", "--solver", solver, "-o", "p.obj")
            self.assertEqual(said.returncode, 0)
            self.assertRegex(said.stderr, rb"falls short of its target by \d+ mm")
            self.assertEqual(said.stderr.endswith(b": pull makes a single step in each pose; the other solvers finish\n"), is_said)

    def test_frames_outside_the_clip_are_said(self):
        result = self.bendy("pose", self.convert(), "--clip", "Walk", "--frames", "0..2@1", "-o", "o#.obj")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"1 of 3 frames are outside the clip, which lasts from 0 to 1", result.stderr)

    def test_frames_that_make_no_sense(self):
        start = ("pose", self.convert(), "--clip", "Walk", "-o", "o#.obj", "--frames")
        for frames in ("5", "0..5", "5@30", "0..5@", "0..5@0", "0..5@-1", "0..5@nan", "0..5@inf", "-1..5@30", "1.5..3@30",
                       "0..5@30x", "5..4@30", "0..100000@30", "0..99999999999@30", "..", "@", "a..b@c"):
            self.assertIn("--frames", self.misused(*start, frames))
        self.assertIn("--clip", self.misused("pose", "x.bendy", "--frames", "0..5@30", "-o", "o#.obj"))
        self.assertIn("--time", self.misused(*start, "0..5@30", "--time", "0"))
        for output in (["-o", "o.obj"], ["-o", "-"], ["-o", "a#/o.obj"], []):
            said = self.misused("pose", "x.bendy", "--clip", "Walk", "--frames", "0..5@30", *output)
            self.assertIn("must have # where the frame's number goes", said)

    def test_a_frame_is_never_the_input(self):
        path = self.convert()
        (self.folder / "in_2.obj").symlink_to(path)
        said = self.bendy("pose", path, "--clip", "Walk", "--frames", "0..3@30", "-o", "in_#.obj")
        self.assertEqual(said.returncode, 1)
        self.assertFalse((self.folder / "in_0.obj").exists())

    def test_levels_of_detail_must_be_shares(self):
        for share in ("-0.1", "1.5", "nan", "inf", "much"):
            self.assertIn("--lod", self.misused("pose", self.convert(), "--lod=" + share))

    def test_a_file_without_levels_is_written_whole_with_a_warning(self):
        result = self.bendy("pose", self.convert(), "--lod", "0.5")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"no levels of detail", result.stderr)
        self.assertEqual(result.stdout, self.done("pose", self.convert()))

    def test_json_has_the_layout_that_is_promised(self):
        for arguments, clip, time in (([], None, 0), (["--clip", "Walk", "--time", "0.25"], "Walk", 0.25),
                                      (["--clip", "1"], "Walk", 0)):
            document = self.pose(self.convert(), *arguments)
            self.assertEqual(list(document), ["file", "clip", "time", "joints", "meshes"])
            self.assertEqual((document["file"], document["clip"], document["time"]), ("mannequin.bendy", clip, time))
            self.assertEqual(len(document["joints"]), 65)
            for joint in document["joints"]:
                self.assertEqual(list(joint), ["name", "world"])
                self.assertEqual(len(joint["world"]), 16)
                self.assertEqual(joint["world"][3::4], [0, 0, 0, 1])  # column-major
            self.assertEqual([mesh["name"] for mesh in document["meshes"]], ["Body", "Head"])
            for mesh in document["meshes"]:
                self.assertEqual(list(mesh), ["name", "positions", "normals", "indices"])
                self.assertEqual(len(mesh["positions"]) % 3, 0)
                self.assertEqual(len(mesh["normals"]), len(mesh["positions"]))
                self.assertEqual(len(mesh["indices"]) % 3, 0)
                self.assertLess(max(mesh["indices"]), len(mesh["positions"]) // 3)
            self.assertEqual(sum(len(mesh["positions"]) // 3 for mesh in document["meshes"]), 4504)
            self.assertEqual(sum(len(mesh["indices"]) // 3 for mesh in document["meshes"]), 8052)

    def test_the_formats_agree_on_every_example(self):
        for path in [self.convert("tentacle"), self.strange(), SOURCE / "spec" / "examples" / "every_chunk.bendy",
                     SOURCE / "spec" / "examples" / "one_joint.bendy"]:
            self.pose(path)
        self.pose(self.convert("tentacle"), "--clip", "Reach", "--time", "0.5")
        self.pose(SOURCE / "spec" / "examples" / "every_chunk.bendy", "--clip", "wave", "--time", "0.5")

    def test_the_rest_pose_by_hand(self):
        document = self.pose(self.strange())
        self.assertEqual([joint["name"] for joint in document["joints"]],
                         ["root\x1b[31m\nbendy: error: forged", "\u624b \u00e9", ""])
        self.assertEqual(document["joints"][1]["world"], [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1])
        first, second = document["meshes"]
        self.assertEqual(first["positions"][:9], [0, 1, 0, 1, 1, 0, 0, 2, 0])
        self.assertEqual(first["normals"], [])
        self.assertEqual(second["positions"][3:6], [-1, 0, 0])
        self.assertEqual(second["normals"][:3], [0, 0, 1])
        # A mirrored triangle still shows the side that its normal points to.
        a, b, c = (second["positions"][3 * index : 3 * index + 2] for index in second["indices"])
        self.assertGreater((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]), 0)
        obj = read_obj((self.folder / "out.obj").read_text(encoding="utf-8"))
        self.assertEqual((len(obj["l"]), len(obj["p"])), (1, 1))
        self.assertEqual(obj["v"][obj["l"][0][1]], (as_float(0.1), as_float(1.2), as_float(0.3)))

    def test_clips_by_number_and_by_name(self):
        at = lambda *arguments: self.done("pose", self.convert(), *arguments)  # noqa: E731
        self.assertEqual(at("--clip", "Walk", "--time", "0.3"), at("--clip", "1", "--time", "0.3"))
        self.assertNotEqual(at("--clip", "Walk", "--time", "0.3"), at("--clip", "Idle", "--time", "0.3"))
        self.assertNotEqual(at("--clip", "Walk", "--time", "0.3"), at())
        for clip in ("slide\tnow", "#0", "1", "2", "=0"):
            document = self.pose(self.strange(), "--clip", clip, "--time", "1")
            self.assertEqual(document["joints"][0]["world"][12], 2)

    def test_times_outside_the_clip_are_held(self):
        for time, expected in (("-5", 0), ("0", 0), ("0.5", 0), ("0.75", 1), ("1.5", 4), ("1e30", 4)):
            document = self.pose(self.strange(), "--clip", "#0", "--time", time)
            self.assertEqual(document["joints"][0]["world"][12], expected, time)

    def test_an_unknown_clip_lists_those_that_are_there(self):
        for clip in ("Run", "walk", "2", "-1", "", "0x1", "1.0", "99999999999999999999999"):
            line = self.failed("pose", self.convert(), "--clip", clip, "-o", "out.obj", file=self.convert())
            self.assertIn("Idle", line)
            self.assertIn("Walk", line)
        line = self.failed("pose", SOURCE / "spec" / "examples" / "one_joint.bendy", "--clip", "0")
        self.assertIn("none", line)
        line = self.failed("pose", self.strange(), "--clip", "x\x1b")
        self.assertNotIn("\x1b", line)
        self.assertIn("slide\\x09now", line)
        self.assertEqual(self.files(), [])

    def test_times_must_be_finite_numbers_and_need_a_clip(self):
        self.assertIn("--clip", self.misused("pose", self.convert(), "--time", "1"))
        for time in ("nan", "inf", "-inf", "soon", "", "1e99", "0.5s"):
            self.assertIn("--time", self.misused("pose", self.convert(), "--clip", "Walk", "--time", time))

    def test_outputs_end_in_a_known_format(self):
        for output in ("out", "out.obj.txt", ".obj", "json"):
            self.assertIn(".ply", self.misused("pose", self.convert(), "-o", output))
        self.assertIn("would be FBX", self.misused("pose", self.convert(), "-o", "out.fbx"))
        self.assertEqual(self.files(), [])

    def test_no_output_is_left_by_a_failure(self):
        (self.folder / "old.obj").write_bytes(b"old")
        self.failed("pose", self.convert(), "-o", "missing/out.obj", file="missing/out.obj")
        for output in ("old.obj", "new.json"):
            self.failed("pose", self.convert(), "-o", output, file=output, **FULL_DISK)
        (self.folder / "cut.bendy").write_bytes(self.convert().read_bytes()[:5000])
        self.failed("pose", "cut.bendy", "-o", "cut.obj", file="cut.bendy")
        self.assertEqual(self.files(), ["cut.bendy", "old.obj"])
        self.assertEqual((self.folder / "old.obj").read_bytes(), b"old")

    def test_a_file_without_an_object_fails(self):
        self.assertIn("OBJE", self.failed("pose", SOURCE / "spec" / "examples" / "smallest.bendy"))

    def test_names_are_escaped_in_obj(self):
        text = self.done("pose", self.strange()).decode()
        self.assertFalse(any((ord(c) < 0x20 and c != "\n") or ord(c) == 0x7F for c in text))
        self.assertIn("o bell\\x07\\x7f", text)
        names = [mesh["name"] for mesh in self.pose(self.strange())["meshes"]]
        self.assertEqual(names, ["bell\x07\x7f", 'quote " and \\ and \u00fc'])

    def test_a_damaged_file_is_refused_with_its_place(self):
        data = bytearray(self.convert("tentacle").read_bytes())
        chunk = Chunk.read(bytes(data)).find("HEAD/OBJE/VECT/POSI")
        data[chunk.offset + 100] ^= 1
        (self.folder / "bad.bendy").write_bytes(data)
        line = self.failed("pose", "bad.bendy", file="bad.bendy")
        self.assertRegex(line, rf"\(HEAD/OBJE/VECT/POSI, offset {chunk.offset}\)$")

    def test_a_pose_out_of_range_is_refused(self):
        root = Chunk.read((SOURCE / "spec" / "examples" / "one_joint.bendy").read_bytes())
        rest = root.find("HEAD/OBJE/SKIN/PIVO/REST")
        rest.payload = rest.payload[:16] + struct.pack("<6f", 3e38, 0, 0, 3e38, 1, 1) + rest.payload[40:]
        points = root.find("HEAD/OBJE/VECT/POSI")
        points.payload = points.payload[:16] + struct.pack("<f", 3e38) + points.payload[20:]
        (self.folder / "far.bendy").write_bytes(root.write())
        self.failed("pose", "far.bendy", "-o", "far.obj", file="far.bendy")
        self.assertEqual(self.files(), ["far.bendy"])


if __name__ == "__main__":
    main()
