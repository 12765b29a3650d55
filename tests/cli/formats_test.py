#!/usr/bin/env python3
"""The formats that `bendy convert` reads and `bendy export` writes.

    formats_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import base64
import json
import os
import re
import shutil
import struct
import sys
import unittest
import unittest.mock
from pathlib import Path

from jsonschema import Draft202012Validator

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from bvh_file import Bvh, walk, with_a_knee  # noqa: E402
from chunk_file import Chunk  # noqa: E402
from md2_file import Md2, md2_file, player_names, tube_md2  # noqa: E402
from mesh_file import read_obj  # noqa: E402
from program import SOURCE, Case, main  # noqa: E402


class ReadableFormats(Case):
    def test_documentation_lists_what_the_program_reads(self):
        listed = re.search(r"^Convert characters \((.*?)\)", self.done("convert", "--help").decode())[1]

        def paragraph(file, beginning):
            text = (SOURCE / file).read_text(encoding="utf-8")
            return text[text.index(beginning):].split("\n\n")[0]

        page = paragraph("docs/convert.md", "`bendy convert` reads")
        self.assertEqual(", ".join(re.findall(r"`(\.\w+)`", page)), listed)
        dropped = re.findall(r" (\.\w+)", paragraph("docs/web.md", "`scripts/web.sh` also makes"))
        self.assertEqual(set(dropped), {*listed.split(", "), ".bendy"})
        for file in ("bindings/python/bendy/__init__.py", "bindings/web/src/tools/index.ts"):
            self.assertIn(f"Converts another format ({listed})", (SOURCE / file).read_text(encoding="utf-8"))
        self.assertIn(f"a file of another format ({listed})", paragraph("bindings/python/bendy/__init__.py", "\ndef open(source"))


class FromBendy(Case):
    def test_a_file_converts_to_itself(self):
        for name in ("mannequin", "tentacle"):
            shutil.copy(self.convert(name), self.folder / "in.glb")  # told by its content
            self.done("convert", "in.glb", "-o", "out.bendy", "--exact")
            self.assertEqual((self.folder / "out.bendy").read_bytes(), self.convert(name).read_bytes())

    def test_what_is_left_out_is_named(self):
        result = self.bendy("convert", "-q", SOURCE / "spec" / "examples" / "every_chunk.bendy", "-o", "out.bendy")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"fixed frames are written as timed keys", result.stderr)

    def test_the_input_stays(self):
        shutil.copy(self.convert(), self.folder / "in.bendy")
        self.assertIn("is an input as well", self.failed("convert", "in.bendy"))

    def test_a_damaged_file_is_refused_with_its_place(self):
        data = bytearray(self.convert().read_bytes())
        data[40] ^= 1
        (self.folder / "bad.bendy").write_bytes(data)
        self.assertIn("HEAD/VERS, offset 16", self.failed("convert", "bad.bendy", "-o", "out.bendy", file="bad.bendy"))
        self.assertEqual(self.files(), ["bad.bendy"])


class Export(Case):
    def test_the_export_converts_to_the_same_bytes(self):
        for name in ("mannequin", "tentacle"):
            shutil.copy(self.convert(name), self.folder / f"{name}.bendy")
            self.assertIn(f"{name}.glb: ", self.done("export", f"{name}.bendy").decode())
            self.assertEqual(self.done("convert", "-q", f"{name}.glb", "-o", "again.bendy"), b"")
            self.assertEqual((self.folder / "again.bendy").read_bytes(), self.convert(name).read_bytes())

    def test_json_with_the_numbers_beside_it(self):
        self.done("export", self.convert(), "-o", "a b.gltf", "-q")
        self.assertEqual(self.files(), ["a b.bin", "a b.gltf"])
        document = json.loads((self.folder / "a b.gltf").read_text())
        self.assertEqual(document["buffers"], [{"byteLength": (self.folder / "a b.bin").stat().st_size, "uri": "a%20b.bin"}])
        self.done("convert", "-q", "a b.gltf", "-o", "again.bendy")
        self.assertEqual((self.folder / "again.bendy").read_bytes(), self.convert().read_bytes())

    def schemas(self):
        folder = SOURCE / "spec" / "gltf"
        return [Draft202012Validator(json.loads((folder / name).read_text(encoding="utf-8")))
                for name in ("node.BENDY_joint_limits.schema.json", "glTF.BENDY_ik_chains.schema.json")]

    def rig_of(self, document):
        """The extensions of the nodes and of the root that hold the rig, checked by the schemas."""
        of_nodes, of_root = self.schemas()
        limits = [node.get("extensions", {}).get("BENDY_joint_limits") for node in document["nodes"]]
        for limit in filter(None, limits):
            of_nodes.validate(limit)
        of_root.validate(document["extensions"]["BENDY_ik_chains"])
        self.assertLessEqual({"BENDY_ik_chains", "BENDY_joint_limits"}, set(document["extensionsUsed"]))
        return limits, document["extensions"]["BENDY_ik_chains"]

    def test_the_rig_stands_in_extensions_and_can_be_edited_there(self):
        self.done("export", self.convert(), "-o", "m.gltf", "-q")
        document = json.loads((self.folder / "m.gltf").read_text())
        limits, chains = self.rig_of(document)
        rig = json.loads(self.done("rig", self.convert()))
        self.assertEqual(sum(limit is not None for limit in limits), len(rig["joints"]))
        self.assertEqual([chain["name"] for chain in chains["chains"]], [chain["name"] for chain in rig["chains"]])
        self.assertNotIn("bendy_rig", document["scenes"][0].get("extras", {}))
        chains["chains"] = chains["chains"][:1]
        (self.folder / "m.gltf").write_text(json.dumps(document))
        self.done("convert", "m.gltf", "-o", "m.bendy", "-q")
        self.assertEqual(len(json.loads(self.done("rig", "m.bendy"))["chains"]), 1)

    def test_a_rig_in_the_extras_is_still_read(self):
        self.done("export", self.convert(), "-o", "m.gltf", "-q")
        document = json.loads((self.folder / "m.gltf").read_text())
        del document["extensions"], document["extensionsUsed"]
        for node in document["nodes"]:
            node.pop("extensions", None)
        document["scenes"][0].setdefault("extras", {})["bendy_rig"] = json.loads(self.done("rig", self.convert()))
        (self.folder / "m.gltf").write_text(json.dumps(document))
        self.done("convert", "-q", "m.gltf", "-o", "again.bendy")
        self.assertEqual((self.folder / "again.bendy").read_bytes(), self.convert().read_bytes())

    def test_a_broken_chain_is_named_and_the_rest_converts(self):
        self.done("export", self.convert("tentacle"), "-o", "t.gltf", "-q")
        document = json.loads((self.folder / "t.gltf").read_text())
        document["extensions"]["BENDY_ik_chains"]["chains"][0]["start"] = "nobody"
        (self.folder / "t.gltf").write_text(json.dumps(document))
        result = self.bendy("convert", "t.gltf", "-q")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"extensions.BENDY_ik_chains.chains[0].start: chain left out: it must be a whole number", result.stderr)

    def test_the_samples_of_the_extensions_come_back_as_they_are(self):
        for name in ("arm", "every_field"):
            sample = SOURCE / "spec" / "gltf" / f"{name}.gltf"
            result = self.bendy("convert", sample, "-q", "-o", f"{name}.bendy")
            self.assertEqual((result.returncode, result.stderr), (0, b""))
            self.done("export", f"{name}.bendy", "-q", "-o", f"{name}.gltf")
            # The nodes of the samples are in pre-order of `nodes`, except for the arm's target.
            before, after = (json.loads(path.read_text(encoding="utf-8")) for path in (sample, self.folder / f"{name}.gltf"))
            numbers = {node["name"]: number for number, node in enumerate(after["nodes"])}
            limits, chains = self.rig_of(after)
            old_limits, old_chains = self.rig_of(before)
            for number, node in enumerate(before["nodes"]):
                self.assertEqual(limits[numbers[node["name"]]], old_limits[number])
                role = node.get("extensions", {}).get("BENDY_joint_role")
                self.assertEqual(after["nodes"][numbers[node["name"]]].get("extensions", {}).get("BENDY_joint_role"), role)
            for chain in old_chains["chains"]:
                for member in ("start", "effector", "target", "pole"):
                    if member in chain:
                        chain[member] = numbers[before["nodes"][chain[member]]["name"]]
                for weight in chain.get("weights", []):
                    weight["node"] = numbers[before["nodes"][weight["node"]]["name"]]
            self.assertEqual(chains, old_chains)

    def test_a_file_with_the_extensions_has_its_rig_there(self):
        document = json.loads((SOURCE / "spec" / "gltf" / "arm.gltf").read_text(encoding="utf-8"))
        document["nodes"][3]["extras"] = {"rig_joint": {"limits": [{"model": "locked"}]}}
        (self.folder / "arm.gltf").write_text(json.dumps(document))
        (self.folder / "rig.json").write_text(json.dumps({"bendy_rig": 1, "joints": {"LowerArm": {"model": "locked"}}}))
        self.done("convert", "-q", "arm.gltf", "--rig", "rig.json", "-o", "arm.bendy")
        rig = json.loads(self.done("rig", "arm.bendy"))
        self.assertEqual((sorted(rig["joints"]), rig["joints"]["LowerArm"]["model"]), (["LowerArm", "UpperArm"], "locked"))

    def test_roles_are_kept_by_gltf_and_lost_by_x_unless_found_again(self):
        self.done("convert", "-q", SOURCE / "examples" / "mannequin.glb", "-o", "found.bendy")
        self.done("edit", "-q", "found.bendy", "--role", "jaw=mixamorig:LeftEye", "-o", "said.bendy")
        for suffix in (".glb", ".x"):
            for name in ("found", "said"):
                is_lost = suffix == ".x" and name == "said"
                result = self.bendy("export", f"{name}.bendy", "-o", f"{name}{suffix}")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(b"roles of joints left out" in result.stderr, is_lost, (name, suffix))
                self.done("convert", "-q", f"{name}{suffix}", "-o", f"{name}_again.bendy")
                roles = [json.loads(self.done("rig", file))["roles"] for file in (f"{name}.bendy", f"{name}_again.bendy")]
                self.assertEqual(roles[0] != roles[1], is_lost, (name, suffix))

    def test_every_kind_of_chunk(self):
        source = SOURCE / "spec" / "examples" / "every_chunk.bendy"
        result = self.bendy("export", source, "-o", "every.glb")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(b"levels of detail left out", result.stderr)
        self.done("convert", "every.glb", "-o", "every.bendy")
        result = self.bendy("diff", source, "every.bendy", "--tolerance", "0.001mm")
        # glTF hangs a mesh that no joint carries into the scene by a node.
        self.assertEqual(result.stdout.splitlines(), [b'+ joint "wing": only in B', b"tolerance 0.001 mm; not measured: the skeletons differ"])

    def triangles(self, path, *arguments):
        """Of each mesh, the places of its triangles' corners in the middle of the walk, sorted."""
        self.done("pose", path, "--clip", "Walk", "--time", "0.25", *arguments, "-o", "posed.json")
        meshes = json.loads((self.folder / "posed.json").read_text(encoding="utf-8"))["meshes"]
        corners = [[mesh["positions"][3 * i:3 * i + 3] for i in mesh["indices"]] for mesh in meshes]
        return [sorted(list(zip(*[iter(places)] * 3))) for places in corners]

    def test_one_level_of_detail(self):
        path = self.shared / "levels_to_export.bendy"
        self.done("convert", "--quiet", "--lod", SOURCE / "examples" / "mannequin.glb", "-o", path)
        with unittest.mock.patch.dict(os.environ, BENDY_KERNEL="plain"):
            for share in ("0.5", "0.1", "0"):
                ours = self.triangles(path, "--lod", share)
                for name in ("level.glb", "level.x"):
                    result = self.bendy("export", path, "--lod", share, "-o", name)
                    self.assertEqual(result.returncode, 0, result.stderr)
                    self.assertNotIn(b"levels of detail", result.stderr)
                    self.done("convert", "--quiet", "--force", name, "-o", "level.bendy")
                    theirs = self.triangles("level.bendy")
                    if name == "level.glb":
                        self.assertEqual(theirs, ours)
                    self.assertEqual([len(mesh) for mesh in theirs], [len(mesh) for mesh in ours])
        result = self.bendy("export", self.convert(), "--lod", "0.5", "-o", "whole.glb")
        self.assertIn(b"the file has no levels of detail", result.stderr)
        self.assertIn("--lod", self.misused("export", path, "--lod", "nan"))

    def test_what_cannot_be_exported(self):
        (self.folder / "bad.bendy").write_bytes(self.convert().read_bytes()[:1000])
        self.failed("export", "bad.bendy", "-o", "bad.glb", file="bad.bendy")
        self.assertEqual(self.files(), ["bad.bendy"])
        shutil.copy(self.convert(), self.folder / "same.glb")
        self.assertIn("is an input as well", self.failed("export", "same.glb", file="same.glb"))
        self.failed("export", self.convert(), "-o", "no/such/folder.glb")
        self.assertIn("--format", self.misused("export", "x.bendy", "--format", "fbx"))


class XFiles(Case):
    def test_an_x_file_holds_the_rig_and_converts(self):
        shown = self.done("export", self.convert("tentacle"), "-o", "t.x").decode()
        self.assertIn("t.x: ", shown)
        text = (self.folder / "t.x").read_text()
        self.assertTrue(text.startswith("xof 0303txt 0032\n"))
        self.assertIn("BendyIkChain {\n", text)
        self.done("convert", "-q", "t.x", "-o", "again.bendy")
        before = json.loads(self.done("rig", self.convert("tentacle")))
        after = json.loads(self.done("rig", "again.bendy"))
        self.assertGreater(len(before["chains"]), 0)
        self.assertEqual(before, after)

    def test_the_format_goes_before_the_name(self):
        self.done("export", self.convert("tentacle"), "--format", "x", "-q", "-o", "odd.name")
        self.assertTrue((self.folder / "odd.name").read_text().startswith("xof "))

    def test_embedded_images_are_written_beside(self):
        shown = self.done("export", self.convert(), "-o", "m.x").decode()
        self.assertIn("images beside it: m_0.png", shown)
        self.assertTrue((self.folder / "m_0.png").read_bytes().startswith(b"\x89PNG"))
        self.done("convert", "-q", "m.x", "-o", "again.bendy")
        self.assertIn("IMAG", self.done("inspect", "again.bendy").decode())

    def test_what_is_wrong_in_an_x_file_has_line_and_column(self):
        (self.folder / "bad.x").write_text("xof 0303txt 0032\nMesh {\n 1; 1;2;oops; 0;}\n")
        message = self.failed("convert", "bad.x", file="bad.x")
        self.assertIn("line 3, column 9: expected a number, found 'oops'", message)
        (self.folder / "packed.x").write_bytes(b"xof 0303tzip0032" + b"\x40" + bytes(31))
        self.assertIn("byte 20: a compressed block of 0 bytes", self.failed("convert", "packed.x", file="packed.x"))
        (self.folder / "other.x").write_bytes(b"solid")
        self.assertIn("not an X-file", self.failed("convert", "other.x", file="other.x"))
        self.assertIn("glTF files only", self.failed("convert", "bad.x", "--scene", "0", file="bad.x"))


class BiovisionFiles(Case):
    def test_joints_are_where_another_evaluation_has_them(self):
        text = walk()
        (self.folder / "walk.bvh").write_text(text)
        shown = self.bendy("convert", "walk.bvh", "--unit", "0.0254")
        self.assertEqual((shown.returncode, shown.stderr), (0, b""))
        self.assertIn(b"clips          1: walk 0.3667 s", shown.stdout)
        judge = Bvh(text)
        # The OFFSET has no height: at rest the lowest joint is as high as it is in the lowest quarter of the frames.
        lowest = sorted(min(place[1] for place in judge.places(frame)) for frame in range(len(judge.frames)))
        lift = lowest[len(lowest) // 4] - min(place[1] for place in judge.places(None))
        self.assertGreater(lift, 80)
        for frame in [None, *range(len(judge.frames))]:
            options = [] if frame is None else ["--clip", "walk", "--time", repr(frame * judge.step)]
            self.done("pose", "walk.bendy", *options, "-o", "posed.json")
            joints = json.loads((self.folder / "posed.json").read_text())["joints"]
            for joint, place in zip(joints, judge.places(frame), strict=True):
                lifted = [place[0], place[1] + (lift if frame is None else 0), place[2]]
                for found, expected in zip(joint["world"][12:15], lifted):
                    self.assertAlmostEqual(found, expected * 0.0254, delta=1e-5 * 170 * 0.0254, msg=(frame, joint["name"]))

    def test_dialects_mean_the_same(self):
        text = walk(3)
        (self.folder / "walk.bvh").write_text(text)
        self.done("convert", "walk.bvh", "-q", "-o", "plain.bendy")
        frames = text.index(".0333333\n") + len(".0333333\n")
        for name, other in {
                "tabs and CRLF": re.sub(" +", "\t", text).replace("\n", " \r\n"),
                "mark and case": "\ufeff\n" + text.replace("HIERARCHY", "Hierarchy").replace("rotation", "ROTATION"),
                "braces": text.replace("\n  {", " {").replace("Frames: ", "Frames:").replace("Frame Time:", "Frame Time :"),
                "sites": text.replace("End Site", "Site", 2),
                "lines": text[:frames] + text[frames:].replace(" ", "\n"),
                "plus": text.replace("\n95", "\n+95")}.items():
            (self.folder / "walk.bvh").write_bytes(other.encode())
            self.done("convert", "walk.bvh", "-q", "-o", "other.bendy")
            self.assertEqual((self.folder / "other.bendy").read_bytes(), (self.folder / "plain.bendy").read_bytes(), name)

    def test_roles_are_found_and_the_unit_is_said(self):
        (self.folder / "walk.bvh").write_text(walk())
        self.assertIn(b"units are taken as centimetres; --unit sets", self.bendy("convert", "walk.bvh").stderr)
        roles = json.loads(self.done("rig", "walk.bendy"))["roles"]
        self.assertEqual([roles[role] for role in ("hips", "left_upper_leg", "left_lower_leg", "right_hand")],
                         ["Hips", "LeftUpLeg", "LeftLeg", "RightHand"])
        self.assertIn("BVH files only", self.failed("convert", "walk.bendy", "--unit", "1", "-o", "x.bendy", file="walk.bendy"))

    def test_a_joint_that_moves_in_place_of_the_shin_is_named_and_its_advice_mends_it(self):
        path = self.folder / "walk.bvh"
        path.write_text(with_a_knee())
        warning = self.bendy("convert", path, "--unit", "0.01").stderr.decode()
        self.assertIn("joint 'Knee' has no role but swings by 60 degrees; the left_lower_leg, 'LeftLeg', turns by 0", warning)
        (self.folder / "knee.json").write_text(warning[warning.index("{"):])
        self.assertEqual(self.bendy("convert", path, "--unit", "0.01", "--rig", "knee.json", "-o", "out.bendy").stderr, b"")
        self.assertEqual(json.loads(self.done("rig", "out.bendy"))["roles"]["left_lower_leg"], "Knee")

    def test_what_is_wrong_has_its_line(self):
        (self.folder / "bad.bvh").write_text(walk().replace("OFFSET 0 10 0", "OFFSET 0 ten 0", 1))
        self.assertIn("line 8: expected a number, found 'ten'", self.failed("convert", "bad.bvh", file="bad.bvh"))


def vrm_animation(bones, expressions):
    """Four nodes, of which the third goes along X from 0 to 1 in a second, and the last from 1 to 3."""
    keys = struct.pack("<14f", 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 3, 0, 0)
    return json.dumps({
        "asset": {"version": "2.0"},
        "extensionsUsed": ["VRMC_vrm_animation"],
        "extensions": {"VRMC_vrm_animation": {
            "specVersion": "1.0", "expressions": expressions,
            "humanoid": {"humanBones": {bone: {"node": node} for bone, node in bones.items()}}}},
        "nodes": [{"name": "a", "children": [1, 2, 3]}, {"name": "b"}, {"name": "c"}, {"name": "d"}],
        "animations": [{
            "channels": [{"sampler": i, "target": {"node": i + 2, "path": "translation"}} for i in (0, 1)],
            "samplers": [{"input": 0, "output": 1}, {"input": 0, "output": 2}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                      {"bufferView": 0, "byteOffset": 8, "componentType": 5126, "count": 2, "type": "VEC3"},
                      {"bufferView": 0, "byteOffset": 32, "componentType": 5126, "count": 2, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(keys)}],
        "buffers": [{"byteLength": len(keys), "uri": "data:;base64," + base64.b64encode(keys).decode()}]})


class VrmAnimations(Case):
    def test_bones_have_roles_and_expressions_are_curves(self):
        text = vrm_animation({"hips": 0, "head": 1}, {"preset": {"happy": {"node": 2}}, "custom": {"wink": {"node": 3}}})
        (self.folder / "a.vrma").write_text(text)
        result = self.bendy("convert", "a.vrma")
        self.assertIn(b"only its humanoid and expressions are interpreted: 'VRMC_vrm_animation'", result.stderr)
        self.assertEqual(json.loads(self.done("rig", "a.bendy"))["roles"], {"hips": "a", "head": "b"})

        def weights(file):
            self.done("pose", file, "--clip", "#0", "--time", "0.5", "-o", "posed.json")
            curves = json.loads((self.folder / "posed.json").read_text())["curves"]
            return {curve["name"]: curve["value"] for curve in curves}
        self.assertEqual(weights("a.bendy"), {"happy": [0.5], "wink": [1.0]})  # 0 to 1, and 1 to 3, which is more than all
        self.assertEqual(self.bendy("export", "a.bendy", "-o", "a.glb").stderr, b"")
        self.done("convert", "a.glb", "-q", "-o", "again.bendy")
        self.assertEqual(weights("again.bendy"), weights("a.bendy"))


class QuakeModels(Case):
    def test_frames_become_targets_and_clips(self):
        md2_file(self.folder / "man.md2")
        shown = self.done("convert", "man.md2").decode()
        self.assertIn("morph targets  3: stand02, run1, run2", shown)
        self.assertIn("clips          2: stand 0.2 s, run 0.2 s", shown)
        self.done("pose", "man.bendy", "--clip", "run", "--time", "0.1", "-o", "up.obj")
        heights = sorted({corner[1] for corner in read_obj((self.folder / "up.obj").read_text())["v"]})
        # The fourth frame: 3 units up, and from 0 to 2 of its own.
        self.assertEqual([round(height * 32, 4) for height in heights], [3, 5])
        said = self.failed("edit", "man.bendy", "--resample", "run@60", "-o", "other.bendy", file="man.bendy")
        self.assertIn('clip "run" cannot be resampled: it plays stored frames, which have a rate of their own', said)
        self.assertFalse((self.folder / "other.bendy").exists())

    def test_the_skin_is_found_beside_the_model(self):
        png = b"\x89PNG\r\n\x1a\n" + bytes(60)
        (self.folder / "man.png").write_bytes(png)
        (self.folder / "other.png").write_bytes(png + bytes(8))

        def embedded(*options):
            report = json.loads(self.done("convert", "man.md2", "--json", *options))
            return [(Path(entry["file"]).name, entry["bytes"]) for entry in report["embedded"]]
        md2_file(self.folder / "man.md2", skins=("C:\\models\\man.pcx",))
        self.assertEqual(embedded(), [("man.png", 68)])
        self.assertEqual(embedded("--texture", "other.png"), [("other.png", 76)])
        self.assertEqual(embedded("--texture", "other.png", "--images", "link"), [])
        self.assertIn(b"other.png", (self.folder / "man.bendy").read_bytes())
        md2_file(self.folder / "man.md2", skins=())
        self.assertEqual(embedded(), [])
        self.assertEqual(embedded("--texture", "other.png"), [("other.png", 76)])
        self.assertIn("file not found", self.failed("convert", "man.md2", "--texture", "none.png", file="none.png"))

    def test_the_texture_of_an_x_file_is_found_beside_it(self):
        (self.folder / "man.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(60))
        (self.folder / "a.x").write_text(r"""xof 0303txt 0032
            Frame F { Mesh { 3; 0;0;0;,1;0;0;,0;1;0;; 1; 3;0,1,2;; MeshMaterialList { 1; 1; 0;
            Material { 1;1;1;1;; 0; 0;0;0;; 0;0;0;; TextureFilename { "..\\art\\man.bmp"; } } } } }""")
        report = json.loads(self.done("convert", "a.x", "--json"))
        self.assertEqual([Path(entry["file"]).name for entry in report["embedded"]], ["man.png"])
        self.assertIn("Quake II models only", self.failed("convert", "a.x", "--texture", "man.png", file="a.x"))

    def corners(self, file, clip, seconds):
        """Of all triangles, in model space."""
        self.done("pose", file, "--clip", clip, "--time", repr(seconds), "-o", "pose.json")
        mesh = json.loads((self.folder / "pose.json").read_text())["meshes"][0]
        places = [mesh["positions"][k:k + 3] for k in range(0, len(mesh["positions"]), 3)]
        return [places[index] for index in mesh["indices"]]

    def assert_at(self, model, file, clip, seconds, frame, after=None, fraction=0.0):
        found, wanted = self.corners(file, clip, seconds), model.corners(frame, after, fraction)
        if file == "small.bendy":  # its triangles stand in another order: axis by axis
            found, wanted = ([sorted(axis) for axis in zip(*corners)] for corners in (found, wanted))
        for here, there in zip(found, wanted, strict=True):
            for a, b in zip(here, there):
                self.assertAlmostEqual(a, b, delta=1e-6 * (1 + abs(b)), msg=f"{clip} at {seconds}")

    def test_poses_are_those_of_the_file(self):
        model = Md2(tube_md2(self.folder / "man.md2", player_names()))
        self.done("convert", "man.md2")
        frames = Chunk.read((self.folder / "man.bendy").read_bytes()).find("HEAD/OBJE/VECT/FRMS").write()
        self.assertLess(len(frames), 198 * (40 + 4 * 48), "as small as the model has them")
        self.done("export", "man.bendy", "-o", "man.glb")
        self.done("convert", "man.glb", "-o", "glb.bendy")
        self.done("convert", "man.md2", "--compact", "-o", "small.bendy")
        for file in ("man.bendy", "glb.bendy", "small.bendy"):
            for frame in (0, 3, 5):
                self.assert_at(model, file, "run", frame / 10, 40 + frame)
            self.assert_at(model, file, "run", 0.125, 41, 42, 0.25)
            self.assert_at(model, file, "run", 0.5625, 45, 40, 0.625)  # around
            self.assert_at(model, file, "run", 0.6, 40)
            self.assert_at(model, file, "stand", 3.9375, 39, 0, 0.375)  # to the mesh's own shape
            self.assert_at(model, file, "stand", 0.03125, 0, 1, 0.3125)
            self.assert_at(model, file, "death2", 0.4375, 188, 189, 0.375)
            self.assert_at(model, file, "death2", 0.5, 189)

    def test_players_clips(self):
        tube_md2(self.folder / "man.md2", player_names(), sides=3, rings=2)
        self.done("convert", "man.md2")
        tree = json.loads(self.done("dump", "man.bendy"))
        clips = {}
        for chunk in next(chunk["OBJE"] for chunk in tree["HEAD"] if "OBJE" in chunk):
            if "CYCL" not in chunk:
                continue
            leaves = {name: value for child in chunk["CYCL"] for name, value in child.items()}
            play = leaves["PLAY"]["plays"][0]
            clips[leaves["NAME"]] = (play["first"], play["frames"], play["closed"], leaves["CINF"]["loop"], leaves["CINF"]["end"])
        wanted = {"stand": (0, 40, 1), "run": (40, 6, 1), "attack": (46, 8, 0), "pain1": (54, 4, 0), "pain2": (58, 4, 0),
                  "pain3": (62, 4, 0), "jump": (66, 6, 0), "flip": (72, 12, 0), "salute": (84, 11, 0), "taunt": (95, 17, 0),
                  "wave": (112, 11, 0), "point": (123, 12, 0), "crstnd": (135, 19, 1), "crwalk": (154, 6, 1),
                  "crattak": (160, 9, 0), "crpain": (169, 4, 0), "crdeath": (173, 5, 0), "death1": (178, 6, 0),
                  "death2": (184, 6, 0), "death3": (190, 8, 0)}
        self.assertEqual({name: values[:3] for name, values in clips.items()}, wanted)
        for first, frames, closed, loop, end in clips.values():
            self.assertEqual(loop, closed)
            self.assertAlmostEqual(end, (frames if closed else frames - 1) / 10, places=6)

    def test_frames_come_through_everything(self):
        tube_md2(self.folder / "man.md2", player_names()[:60])
        self.done("convert", "man.md2")
        before = (self.folder / "man.bendy").read_bytes()
        self.done("convert", "man.bendy", "-o", "again.bendy")
        self.assertEqual((self.folder / "again.bendy").read_bytes(), before)
        self.done("dump", "man.bendy", "-o", "man.json")
        self.done("assemble", "man.json", "-o", "back.bendy")
        self.assertEqual((self.folder / "back.bendy").read_bytes(), before)
        for options in (["--lod"], ["--compact"], ["--lod", "--compact"]):
            self.done("convert", "man.md2", *options, "-o", "other.bendy")
            self.done("validate", "other.bendy")
            self.done("diff", "man.bendy", "other.bendy", "--tolerance", "0.1mm")
            if options == ["--compact"]:
                self.assertLess((self.folder / "other.bendy").stat().st_size, len(before))
        shown = self.done("inspect", "man.bendy").decode()
        self.assertIn("59 frames of 48 places", shown)
        self.assertIn("6 frames of mesh 0 from frame 40, closed", shown)
        self.done("inspect", "man.bendy", "--html", "page.html")

    def test_frames_are_edited(self):
        model = Md2(tube_md2(self.folder / "man.md2", player_names()[:60]))
        self.done("convert", "man.md2")
        self.done("edit", "man.bendy", "-o", "named.bendy", "--rename", "target:run2=stride")
        self.assertIn("stride", json.dumps(json.loads(self.done("dump", "named.bendy"))))
        self.assert_at(model, "named.bendy", "run", 0.1, 41)
        self.done("edit", "man.bendy", "-o", "fewer.bendy", "--strip", "clip:stand")
        self.assert_at(model, "fewer.bendy", "run", 0.5625, 45, 40, 0.625)
        self.done("edit", "man.bendy", "-o", "none.bendy", "--strip", "clips")
        self.done("edit", "none.bendy", "-o", "back.bendy", "--merge", "man.bendy")
        self.assert_at(model, "back.bendy", "stand", 3.9375, 39, 0, 0.375)
        tube_md2(self.folder / "other.md2", [f"other{k}" for k in range(60)])
        self.done("convert", "other.md2")
        self.assertIn("animate nothing in this file", self.failed("edit", "other.bendy", "-o", "no.bendy", "--merge", "man.bendy"))
        message = self.failed("edit", "man.bendy", "-o", "no.bendy", "--strip", "target:run2")
        self.assertIn("can only be stripped together", message)
        self.done("edit", "man.bendy", "-o", "still.bendy", "--strip", "targets")
        self.assertNotIn("FRMS", self.done("inspect", "still.bendy").decode())

    def test_what_is_wrong_has_its_byte(self):
        path = md2_file(self.folder / "man.md2")
        path.write_bytes(path.read_bytes()[:150])
        self.assertIn("byte 64: the file is truncated", self.failed("convert", "man.md2", file="man.md2"))


if __name__ == "__main__":
    main()
