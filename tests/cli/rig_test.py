#!/usr/bin/env python3
"""`bendy rig` and rig files; curves and markers through every command.

    rig_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import json
import sys
from pathlib import Path

from jsonschema import Draft202012Validator

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from chunk_file import Chunk  # noqa: E402
from program import SOURCE, Case, main  # noqa: E402


class Rig(Case):
    def write(self, rig, name="rig.json"):
        (self.folder / name).write_text(rig if isinstance(rig, str) else json.dumps(rig))
        return name

    def convert_with(self, rig, *more, source="tentacle"):
        """The rig of an example that was converted with a rig file; warnings in `self.warnings`."""
        result = self.bendy("convert", SOURCE / "examples" / f"{source}.glb", "--rig", self.write(rig), "-q", "-o",
                            "out.bendy", *more)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.warnings = result.stderr.decode().splitlines()
        self.assertEqual(self.done("validate", "out.bendy"), b"")
        return json.loads(self.done("rig", "out.bendy"))

    def refused(self, rig):
        """What is said of a rig file that cannot be used."""
        line = self.failed("convert", SOURCE / "examples" / "tentacle.glb", "--rig", self.write(rig), "-o", "x.bendy",
                           file="rig.json")
        self.assertFalse((self.folder / "x.bendy").exists())
        return line.removeprefix("bendy: error: rig.json: ")

    def test_a_rig_that_is_put_back_gives_the_same_file(self):
        for name in ("mannequin", "tentacle"):
            self.done("rig", self.convert(name), "-o", "rig.json")
            rig = json.loads((self.folder / "rig.json").read_text())
            self.assertEqual(rig["complete"], True)
            self.assertGreater(len(rig["joints"]), 5)
            self.assertGreater(len(rig["chains"]), 0)
            self.assertEqual((self.folder / "rig.json").read_bytes(), self.done("rig", self.convert(name)))
            self.done("convert", SOURCE / "examples" / f"{name}.glb", "--rig", "rig.json", "-o", "again.bendy")
            self.assertEqual((self.folder / "again.bendy").read_bytes(), self.convert(name).read_bytes())

    def test_the_summary_tells_constraints_and_chains(self):
        text = self.done("convert", SOURCE / "examples" / "mannequin.glb", "-o", "m.bendy").decode()
        chunks = [chunk.letters for _, chunk in Chunk.read((self.folder / "m.bendy").read_bytes()).walk()]
        self.assertIn(f"\n  rig            {chunks.count('LIMT')} constraints, 4 chains: IK_LeftArm, IK_RightArm, ", text)
        text = self.done("convert", SOURCE / "examples" / "mannequin.glb", "-o", "m.bendy", "--rig",
                         self.write({"bendy_rig": 1, "complete": True})).decode()
        self.assertNotIn("  rig  ", text)

    def test_globs_names_and_numbers(self):
        rig = self.convert_with({"bendy_rig": 1, "complete": True, "joints": {
            "seg_0[123]": {"model": "hinge", "x": [0, 30]}, "*_0?": {"model": "locked"}, "seg_02": [],
            "#0": {"model": "largest_angle", "angle": 90}, "seg_03*": {"model": "free"}, "Nose": []}})
        self.assertEqual({name: limit["model"] for name, limit in rig["joints"].items()},
                         {"TentacleRig": "largest_angle", "seg_03": "free",
                          **{f"seg_0{i}": "locked" for i in (0, 1, 4, 5, 6, 7, 8, 9)}})
        self.assertNotIn("chains", rig)
        self.assertEqual([line.rpartition("rig.json: ")[2] for line in self.warnings],
                         ["joints.'seg_0[123]': no joint takes 'seg_0[123]'", "joints.Nose: no joint takes 'Nose'"])

    def test_what_the_rig_file_leaves_open_the_extras_say(self):
        before = json.loads(self.done("rig", self.convert("tentacle")))
        rig = self.convert_with({"bendy_rig": 1, "joints": {"seg_03": [], "seg_04": {"model": "locked"}}, "chains": [
            {"name": "other", "start": "seg_00", "effector": "seg_02", "extras": {"note": [1]}}]})
        joints = dict(before["joints"], seg_04={"model": "locked"})
        del joints["seg_03"]
        self.assertEqual(rig["joints"], joints)
        self.assertEqual([chain["name"] for chain in rig["chains"]], ["other", "IK_tip"])
        self.assertEqual(rig["chains"][0]["extras"], {"note": [1]})
        rig = self.convert_with({"bendy_rig": 1, "chains": [{"name": "IK_tip", "start": "seg_00", "effector": "seg_02"}]})
        self.assertEqual(rig["chains"], [{"name": "IK_tip", "start": "seg_00", "effector": "seg_02"}])
        self.assertEqual(rig["joints"], before["joints"])

    def test_faults_are_told_with_their_place(self):
        self.assertEqual(self.refused({"bendy_rig": 1, "joints": {"*Knee*": {"model": "hinge", "x": ["a", 1]}}}),
                         "joints.'*Knee*'.x[0]: expected a number, found 'a'")
        self.assertEqual(self.refused({"bendy_rig": 1, "chains": [{"name": "c", "start": "nose", "effector": "#1"}]}),
                         "chains[0].start: there is no joint 'nose'")
        self.assertRegex(self.refused('{\n  "bendy_rig" 1}'), r"^invalid JSON at line 2, column 15 \(byte \d+\): ")
        self.assertIn("nested deeper", self.refused('{"bendy_rig": ' + "[" * 100_000))
        self.assertIn("1e+400", self.refused('{"bendy_rig": 1e+400}'))
        self.assertIn("the text is empty", self.refused(""))
        self.assertNotIn("\x1b", self.refused({"bendy_rig": 1, "joints": {"\x1b[31m[": {}}}))

    def test_rig_files_that_cannot_be_read_are_named(self):
        (self.folder / "folder").mkdir()
        for name in ("missing.json", "folder"):
            self.failed("convert", SOURCE / "examples" / "tentacle.glb", "--rig", name, "-o", "x", file=name)
        self.assertEqual(self.files(), ["folder"])

    def test_a_damaged_file_is_refused_with_its_place(self):
        data = bytearray(self.convert("tentacle").read_bytes())
        chunk = Chunk.read(bytes(data)).find("HEAD/OBJE/SKIN/PIVO/REST")
        data[chunk.offset + 20] ^= 1
        (self.folder / "bad.bendy").write_bytes(data)
        self.assertRegex(self.failed("rig", "bad.bendy", file="bad.bendy"), rf"offset {chunk.offset}\)$")

    def test_an_output_that_cannot_be_written_is_named(self):
        self.failed("rig", self.convert("tentacle"), "-o", "missing/rig.json", file="missing/rig.json")
        self.assertEqual(self.files(), [])


class Curves(Case):
    """Named curves: from a rig file, and from glTF's KHR_animation_pointer, to every place that has them."""

    CURVES = [{"clip": "Walk", "name": "FootDown", "path": "/extras/FootDown", "interpolation": "step",
               "times": [0, 0.25, 0.75], "values": [0, 1, 0]},
              {"clip": "Walk", "path": "extras/grip", "target": {"joint": "mixamorig:Hips"}, "times": [0, 1],
               "values": [0, 0.25, 1, 0.75]}]

    def write(self, curves, name="rig.json", **members):
        (self.folder / name).write_text(json.dumps({"bendy_rig": 1, "curves": curves, **members}))
        return name

    def curved(self, curves=None, out="curved.bendy"):
        rig = self.write(self.CURVES if curves is None else curves)
        self.done("convert", self.convert("mannequin"), "--rig", rig, "-q", "-o", out)
        self.assertEqual(self.done("validate", out), b"")
        return out

    def test_pose_prints_their_values(self):
        posed = json.loads(self.done("pose", self.curved(), "--clip", "Walk", "--time", "0.5", "--format", "json"))
        self.assertEqual(posed["curves"][0], {"name": "FootDown", "path": "/extras/FootDown", "value": [1]})
        self.assertEqual(posed["curves"][1]["value"], [0.5, 0.5])
        self.assertEqual(list(posed["curves"][1]["target"]), ["joint"])
        self.assertNotIn("curves", json.loads(self.done("pose", "curved.bendy", "--format", "json")))

    def test_the_rig_file_gives_the_same_bytes(self):
        self.curved()
        rig = json.loads(self.done("rig", "curved.bendy"))
        self.assertEqual(rig["curves"], self.CURVES)
        schema = json.loads((SOURCE / "spec" / "rig.schema.json").read_text())
        self.assertTrue(Draft202012Validator(schema).is_valid(rig))
        (self.folder / "again.json").write_text(json.dumps(rig))
        self.done("convert", self.convert("mannequin"), "--rig", "again.json", "-q", "-o", "again.bendy")
        self.assertEqual((self.folder / "again.bendy").read_bytes(), (self.folder / "curved.bendy").read_bytes())

    def test_to_gltf_and_back_the_bytes_are_the_same(self):
        self.done("export", self.curved(), "-o", "c.gltf", "-q")
        document = json.loads((self.folder / "c.gltf").read_text())
        self.assertIn("KHR_animation_pointer", document["extensionsUsed"])
        document["extensionsRequired"] = ["KHR_animation_pointer"]
        (self.folder / "c.gltf").write_text(json.dumps(document))
        self.done("convert", "c.gltf", "-q", "-o", "once.bendy")
        self.assertEqual((self.folder / "once.bendy").read_bytes(), (self.folder / "curved.bendy").read_bytes())

    def test_compact_files_say_their_error(self):
        times = [k / 64 for k in range(64)]
        curves = [*self.CURVES, {"clip": "Walk", "name": "w", "path": "/extras/w", "times": times,
                                 "values": [(k * 37 % 64) ** 2 / 10 for k in range(64)]}]
        text = self.done("convert", self.curved(curves), "--compact", "-o", "small.bendy").decode()
        self.assertRegex(text, r"curves +1 of 3 packed; largest error 0\.000\d+ % of the range of values")
        report = json.loads(self.done("convert", "curved.bendy", "--compact", "--json", "-o", "small2.bendy"))
        self.assertEqual(report["compact"]["curves"]["count"], 3)
        self.assertEqual(report["compact"]["curves"]["packed"], 1)
        self.assertLess(report["compact"]["curves"]["largestError"], 0.51 / 65535)
        self.done("diff", "curved.bendy", "small.bendy", "--tolerance", "1%")

    def test_a_change_is_a_difference(self):
        self.curved()
        changed = [{**self.CURVES[0], "values": [0, 1, 0.5]}, self.CURVES[1]]
        result = self.bendy("diff", "curved.bendy", self.curved(changed, "changed.bendy"), "--tolerance", "1%")
        self.assertEqual(result.returncode, 1)
        self.assertIn(b'curve "FootDown": up to 0.5 apart, at 0.75 s', result.stdout)


class Markers(Case):
    STEPS = [{"time": 0.25, "name": "left"}, {"time": 0.75, "name": "right"}]

    def write(self, markers, **members):
        (self.folder / "rig.json").write_text(json.dumps({"bendy_rig": 1, "markers": markers, **members}))
        return "rig.json"

    def marked(self, markers, source="mannequin", out="marked.bendy", **members):
        self.done("convert", self.convert(source), "--rig", self.write(markers, **members), "-q", "-o", out)
        self.assertEqual(self.done("validate", out), b"")
        return out

    def test_they_are_seen_in_every_report(self):
        self.marked({"Walk": self.STEPS})
        text = self.done("inspect", "marked.bendy").decode()
        self.assertRegex(text, r'CYCL 1  "Walk"  0 to 1 s, 59 tracks, repeats, 2 markers\n')
        self.assertIn('2 markers: "left" at 0.25 s, "right" at 0.75 s', text)
        chunks = json.loads(self.done("inspect", "marked.bendy", "--json"))["chunks"]
        self.assertEqual([chunk["fields"] for chunk in chunks if chunk["id"] == "MARK"],
                         [{"markers": [{"seconds": 0.25, "name": "left"}, {"seconds": 0.75, "name": "right"}]}])
        self.done("inspect", "marked.bendy", "--html", "m.html")
        self.assertIn('"markers":[[0.25,"left"],[0.75,"right"]]', (self.folder / "m.html").read_text())

    def test_the_rig_file_gives_the_same_bytes(self):
        self.marked({"Walk": {"right": 0.75, "left": 0.25}, "#0": []})
        rig = json.loads(self.done("rig", "marked.bendy", "-o", "again.json") or (self.folder / "again.json").read_text())
        self.assertEqual(rig["markers"], {"Walk": self.STEPS})
        schema = json.loads((SOURCE / "spec" / "rig.schema.json").read_text())
        self.assertTrue(Draft202012Validator(schema).is_valid(rig))
        self.done("convert", self.convert(), "--rig", "again.json", "-q", "-o", "again.bendy")
        self.assertEqual((self.folder / "again.bendy").read_bytes(), (self.folder / "marked.bendy").read_bytes())

    def test_from_gltf_and_back_the_chunks_are_the_same(self):
        self.done("export", self.marked({"Walk": self.STEPS}), "-o", "m.gltf", "-q")
        document = json.loads((self.folder / "m.gltf").read_text())
        extras = next(a["extras"] for a in document["animations"] if a["name"] == "Walk")
        self.assertEqual(extras["markers"], self.STEPS)
        for form in (self.STEPS, {"right": 0.75, "left": [0.25]}, json.dumps(self.STEPS)):
            extras["markers"] = form
            (self.folder / "m.gltf").write_text(json.dumps(document))
            self.done("convert", "m.gltf", "-q", "-o", "once.bendy")
            self.assertEqual((self.folder / "once.bendy").read_bytes(), (self.folder / "marked.bendy").read_bytes())

    def test_compact_and_lod_files_keep_them(self):
        self.marked({"Walk": self.STEPS})
        self.done("convert", "marked.bendy", "--compact", "--lod", "-q", "-o", "small.bendy")
        self.assertEqual(json.loads(self.done("rig", "small.bendy"))["markers"], {"Walk": self.STEPS})
        self.done("diff", "marked.bendy", "small.bendy", "--tolerance", "1%")
        self.done("edit", "small.bendy", "-o", "bare.bendy", "--strip", "markers")
        self.assertNotIn("markers", json.loads(self.done("rig", "bare.bendy")))
        result = self.bendy("diff", "small.bendy", "bare.bendy", "--tolerance", "1%")
        self.assertEqual(result.returncode, 1)
        self.assertIn(b'! clip "Walk": markers: 2 -> 0\n', result.stdout)

    def test_differences_are_told_one_by_one(self):
        self.marked({"Walk": self.STEPS})
        self.marked({"Walk": {"left": 0.25, "hit": 0.5}}, out="other.bendy")
        result = self.bendy("diff", "marked.bendy", "other.bendy")
        self.assertEqual(result.returncode, 1)
        self.assertEqual([line.split(": ", 1)[1] for line in result.stdout.decode().splitlines()],
                         ["marker 1: seconds: 0.75 -> 0.5", 'marker 1: name: "right" -> "hit"'])

    def test_what_is_wrong_in_a_rig_file(self):
        for markers, message in (
                ({"Walk": [{"time": 1.5, "name": "late"}]},
                 "markers.Walk[0]: 1.5 s is outside the clip, which lasts from 0.0 s to 1.0 s"),
                ({"Walk": {"step": "soon"}}, "markers.Walk.step: expected a number, found 'soon'"),
                ([], "markers: it must be an object, not array")):
            line = self.failed("convert", self.convert(), "--rig", self.write(markers), "-o", "x.bendy")
            self.assertEqual(line, f"bendy: error: rig.json: {message}")
            self.assertFalse((self.folder / "x.bendy").exists())
        result = self.bendy("convert", self.convert(), "--rig", self.write({"Fly": []}), "-q", "-o", "x.bendy")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"rig.json: markers.Fly: no clip takes 'Fly'", result.stderr)


if __name__ == "__main__":
    main()
