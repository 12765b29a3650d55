#!/usr/bin/env python3
"""`bendy edit` as a user runs it. What comes out is looked at by the tests' own reader of chunks, and posed.

    edit_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import atexit
import json
import os
import shutil
import struct
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from bvh_file import walk  # noqa: E402
from chunk_file import Chunk  # noqa: E402
from gltf_file import GltfFile, humans_file  # noqa: E402
from program import SOURCE, Case, main  # noqa: E402

FORMS = {"plain": [], "compact": ["--compact"], "lod": ["--lod"], "lod_compact": ["--lod", "--compact"]}
PLAIN = {**os.environ, "BENDY_KERNEL": "plain"}
MADE = Path(tempfile.mkdtemp(prefix="bendy_edit_"))
atexit.register(shutil.rmtree, MADE)


def whole(chunk, data):
    """The chunk's bytes as they lie in the file, header and all."""
    return data[chunk.offset : chunk.offset + 16 + chunk.padded_size()]


def chunks_of(path):
    """Every leaf of a file as it lies there: (path of ids, bytes)."""
    data = path.read_bytes()
    leaves = []

    def visit(chunk, place):
        here = place + "/" + chunk.letters
        if chunk.children is None:
            leaves.append((here, whole(chunk, data)))
        for child in chunk.children or []:
            visit(child, here)

    visit(Chunk.read(data), "")
    return leaves


def glb_with(path, change):
    """A copy of a .glb whose JSON is changed."""
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + length])
    change(document)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    return struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest


class EditCase(Case):
    def made(self, name, form="plain"):
        """An example in one form; made once for all tests."""
        path = MADE / f"{name}.{form}.bendy"
        if not path.exists():
            self.done("convert", "-q", SOURCE / "examples" / f"{name}.glb", "-o", path, *FORMS[form])
        return path

    def edit(self, path, *arguments, name="edited.bendy"):
        """The edited file, which is valid; what was printed stands in self.told and self.warned."""
        result = self.bendy("edit", path, "-o", name, *arguments)
        self.assertEqual(result.returncode, 0, (arguments, result.stderr))
        self.told = result.stdout.decode()
        self.warned = result.stderr.decode()
        out = self.folder / name
        self.assertEqual(self.done("validate", out), b"", arguments)
        return out

    def pose(self, path, *arguments):
        self.done("pose", path, *arguments, "-o", "pose.json", env=PLAIN)
        return json.loads((self.folder / "pose.json").read_text())

    def clips(self, path):
        root = Chunk.read(path.read_bytes())
        objects = [chunk for chunk in root.children if chunk.letters == "OBJE"]
        return [child.children[0].payload.decode() for child in objects[0].children if child.letters == "CYCL"]

    def joints(self, path):
        return [joint["name"] for joint in self.pose(path)["joints"]]

    def worlds(self, path, *arguments):
        return {joint["name"]: joint["world"] for joint in self.pose(path, *arguments)["joints"]}


class Strip(EditCase):
    # part: the ids that may go, and the leaves that may change.
    PARTS = {
        "textures": ({"TEXT"}, {"SURF", "EXTN"}),
        "materials": ({"MATE"}, {"POLY", "JNTS"}),
        "meshes": ({"VECT", "POLY", "LODD"}, {"JNTS", "TRAK", "TIME", "KEYV"}),
        "targets": ({"TARG"}, {"TRAK", "TIME", "KEYV"}),
        "clips": ({"CYCL"}, set()),
        "markers": ({"MARK"}, set()),
        "chains": ({"IKCH", "PULL"}, set()),
        "constraints": ({"LIMT"}, set()),
        "lod": ({"LODD"}, set()),
        "extras": ({"EXTR", "MORE"}, set()),
        "extensions": ({"EXTN"}, set()),
    }

    def test_nothing_but_the_part_goes_and_the_rest_keeps_its_bytes(self):
        for name, form in (("tentacle", "plain"), ("tentacle", "lod_compact"), ("mannequin", "plain"),
                           ("mannequin", "compact"), ("mannequin", "lod")):
            source = self.made(name, form)
            before = chunks_of(source)
            for part, (gone, changed) in self.PARTS.items():
                after = set(chunks_of(self.edit(source, "--strip", part)))
                for place, data in before:
                    ids = place.split("/")[1:]
                    if gone.isdisjoint(ids):
                        if ids[-1] not in changed | {"VERS"}:
                            self.assertIn((place, data), after, (name, form, part, place))
                for place, data in after:
                    self.assertTrue(gone.isdisjoint(place.split("/")) or "SKIN/MATE" in place, (part, place))

    def test_the_pose_does_not_change(self):
        for name, form in (("mannequin", "plain"), ("mannequin", "lod_compact")):
            source = self.made(name, form)
            clip = ["--clip", "Walk", "--time", "0.3"]
            expected = self.pose(source, *clip)
            for part in ("textures", "materials", "chains", "constraints", "lod", "extras"):
                found = self.pose(self.edit(source, "--strip", part), *clip)
                self.assertEqual(found["joints"], expected["joints"], part)
                self.assertEqual(found["meshes"], expected["meshes"], part)

    def test_one_by_name(self):
        source = self.made("mannequin")
        self.assertEqual(self.clips(self.edit(source, "--strip", "clip:Idle")), ["Walk"])
        self.assertEqual(self.clips(self.edit(source, "--strip", "clip:W*")), ["Idle"])
        self.assertEqual(self.clips(self.edit(source, "--strip", "clip:#1")), ["Idle"])
        meshes = self.pose(self.edit(source, "--strip", "mesh:Head"))["meshes"]
        self.assertEqual([mesh["name"] for mesh in meshes], ["Body"])
        expected = self.pose(source, "--clip", "Walk", "--time", "0.3")
        found = self.pose(self.edit(source, "--strip", "mesh:Head"), "--clip", "Walk", "--time", "0.3")
        self.assertEqual(found["joints"], expected["joints"])
        self.assertEqual(found["meshes"], [mesh for mesh in expected["meshes"] if mesh["name"] == "Body"])

    def test_one_target_takes_its_weights_along(self):
        for form in ("plain", "compact"):
            source = self.made("mannequin", form)
            names = [chunk.children[0].payload.decode() for _, chunk in Chunk.read(source.read_bytes()).walk()
                     if chunk.letters == "TARG"]
            self.assertEqual(len(names), 2)
            without = [self.edit(source, "--strip", f"target:{name}", name=f"{name}.bendy") for name in names]
            time = ["--clip", "Idle", "--time", "0.4"]
            rest = self.pose(self.edit(source, "--strip", "targets"), *time)["meshes"]
            both = self.pose(source, *time)["meshes"]
            one, other = (self.pose(path, *time)["meshes"] for path in without)
            for a, b, none, sum_ in zip(one, other, rest, both):
                for x, y, z, w in zip(a["positions"], b["positions"], none["positions"], sum_["positions"]):
                    self.assertAlmostEqual(x + y - z, w, delta=2e-6)

    def test_of_two_humans_in_a_file_it_is_said_which_one_is_taken(self):
        both = humans_file(self.folder / "both.gltf", ["Anna", "Bert"])
        (self.folder / "bert.json").write_text('{"bendy_rig": 1, "roles": {"hips": "#18"}}')
        walk = f"{self.made('mannequin')}:Walk"
        for arguments, taken, other in (([], '"Anna" (#0)', '"Bert" (#17)'), (["--rig", "bert.json"], '"Bert" (#17)', '"Anna" (#0)')):
            result = self.bendy("convert", both, "-o", "both.bendy", *arguments)
            self.assertEqual(result.returncode, 0, result.stderr)
            is_told = b"2 characters, below the joints 'Anna' (#0) and 'Bert' (#17)" in result.stderr
            self.assertEqual(is_told, not arguments, result.stderr)
            result = self.bendy("edit", "both.bendy", "-o", "out.bendy", "--retarget", walk)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(f"the target is the character below the joint {taken}; its file has {other} beside it", result.stderr.decode())
        alone = humans_file(self.folder / "alone.gltf", ["Anna"])
        result = self.bendy("convert", alone, "-o", "alone.bendy")
        self.assertEqual(result.stderr, b"")

    def test_mistakes_are_explained(self):
        source = self.made("mannequin")
        self.assertIn('there is no clip "Wlak"; did you mean "Walk"?',
                      self.failed("edit", source, "-o", "x.bendy", "--strip", "clip:Wlak"))
        self.assertIn('there is no joint "LeftArm"; did you mean "mixamorig:LeftArm"?',
                      self.failed("edit", source, "-o", "x.bendy", "--extract", "LeftArm"))
        self.assertIn('did you mean "clips"?', self.misused("edit", source, "-o", "x.bendy", "--strip", "clisp"))
        self.assertIn("clip:NAME", self.misused("edit", source, "-o", "x.bendy", "--strip", "clip"))
        self.assertIn("takes no name", self.misused("edit", source, "-o", "x.bendy", "--strip", "lod:x"))
        self.assertIn("nothing to do", self.misused("edit", source, "-o", "x.bendy"))
        self.assertEqual(self.files(), [])

    def test_a_damaged_file_is_refused_and_an_old_output_kept(self):
        data = bytearray(self.made("tentacle").read_bytes())
        data[40] ^= 1
        (self.folder / "bad.bendy").write_bytes(data)
        (self.folder / "out.bendy").write_bytes(b"old")
        self.assertIn("HEAD/VERS, offset 16", self.failed("edit", "bad.bendy", "-o", "out.bendy", "--strip", "lod"))
        self.assertEqual((self.folder / "out.bendy").read_bytes(), b"old")

    def test_a_file_may_be_edited_in_place(self):
        path = self.folder / "fox.bendy"
        path.write_bytes(self.made("tentacle").read_bytes())
        self.done("edit", path, "--strip", "clips", "--in-place")
        self.assertEqual(self.done("validate", path), b"")
        self.assertEqual(self.clips(path), [])
        self.assertEqual(self.files(), ["fox.bendy"])


class Unknown(EditCase):
    PLACES = ("HEAD", "HEAD/TEXT", "HEAD/MATE", "HEAD/OBJE", "HEAD/OBJE/SKIN", "HEAD/OBJE/SKIN/SKIN[2]/SKIN/PIVO",
              "HEAD/OBJE/VECT", "HEAD/OBJE/CYCL", "HEAD/OBJE/IKCH")
    STEPS = (["--strip", "textures"], ["--strip", "extras"], ["--strip", "clip:Idle"], ["--strip", "lod"],
             ["--strip", "constraints"], ["--rename-joint", "mixamorig:*=*"], ["--extract", "mixamorig:Hips"],
             ["--strip", "meshes"], ["--strip", "targets"])

    @staticmethod
    def strangers(number):
        text = b"%d of a later version" % number
        return [Chunk("X1%02d" % number, text),
                Chunk("Y1%02d" % number, children=[Chunk("EXTR", text), Chunk("SKIN", children=[])])]

    def with_strangers(self, source, flags=0):
        root = Chunk.read(source.read_bytes())
        for number, place in enumerate(self.PLACES):
            parent = root.find(place) if place != "HEAD" else root
            for chunk in self.strangers(number):
                chunk.flags |= flags
                parent.children.insert(len(parent.children) // 2, chunk)
        path = self.folder / "strange.bendy"
        path.write_bytes(root.write())
        return path

    @staticmethod
    def places(path):
        """Of each unknown chunk: its bytes, its parent's id, and the ids of the known siblings around it."""
        data = path.read_bytes()
        found = {}
        for _, parent in Chunk.read(data).walk():
            if parent.letters[:2] in ("X1", "Y1"):
                continue
            for at, child in enumerate(parent.children or []):
                if child.letters[:2] in ("X1", "Y1"):
                    found[child.letters] = (whole(child, data), parent.letters,
                                            [sibling.letters for sibling in parent.children[:at]],
                                            [sibling.letters for sibling in parent.children[at + 1 :]])
        return found

    def test_unknown_chunks_keep_their_bytes_and_places(self):
        for form in ("plain", "lod_compact"):
            path = self.with_strangers(self.made("mannequin", form))
            before = self.places(path)
            self.assertEqual(len(before), 2 * len(self.PLACES))
            for step in self.STEPS:
                after = self.places(self.edit(path, *step))
                for letters, (data, parent, left, right) in before.items():
                    place = self.PLACES[int(letters[2:])]
                    if place.split("/")[-1] in ("TEXT", "VECT", "CYCL", "IKCH") and letters not in after:
                        continue  # it went with its parent
                    self.assertEqual(after[letters][:2], (data, parent), (step, letters))
                    stay_left = [name for name in left if name in after[letters][2]]
                    self.assertEqual([n for n in after[letters][2] if n in stay_left], after[letters][2])
                    for name in set(right) - set(left):
                        self.assertNotIn(name, after[letters][2], (step, letters))
                gone = {self.PLACES[int(letters[2:])].split("/")[-1] for letters in before if letters not in after}
                self.assertLessEqual(gone, {"TEXT", "VECT", "CYCL", "IKCH"} if step[0] != "--rename-joint" else set())

    def test_they_go_when_that_is_asked(self):
        path = self.with_strangers(self.made("mannequin"))
        self.assertEqual(self.places(self.edit(path, "--strip", "unknown")), {})
        self.assertEqual(self.edit(path, "--strip", "unknown").read_bytes(), self.made("mannequin").read_bytes())
        left = self.places(self.edit(path, "--strip", "chunk:X100"))
        self.assertEqual(set(self.places(path)) - set(left), {"X100"})

    def test_required_ones_are_refused(self):
        path = self.with_strangers(self.made("mannequin"), flags=2)
        self.assertIn("required", self.failed("edit", path, "-o", "x.bendy", "--strip", "lod").lower())
        self.assertEqual(self.files(), ["strange.bendy"])


class Rename(EditCase):
    def test_prefixes_and_swaps(self):
        for form in ("plain", "compact"):
            source = self.made("mannequin", form)
            names = self.joints(source)
            found = self.joints(self.edit(source, "--rename-joint", "mixamorig:*=*"))
            self.assertEqual(found, [name.removeprefix("mixamorig:") for name in names])
            self.assertIn('two joints are called "Head" now', self.warned)
            swapped = self.edit(source, "--rename-joint", "ctl_LeftFoot=ctl_RightFoot",
                                "--rename-joint", "ctl_RightFoot=ctl_LeftFoot")
            swap = {"ctl_LeftFoot": "ctl_RightFoot", "ctl_RightFoot": "ctl_LeftFoot"}
            self.assertEqual(self.joints(swapped), [swap.get(name, name) for name in names])
            self.assertEqual(self.edit(swapped, "--rename-joint", "ctl_LeftFoot=ctl_RightFoot", "--rename-joint",
                                       "ctl_RightFoot=ctl_LeftFoot", name="back.bendy").read_bytes(),
                             source.read_bytes())

    def test_tables(self):
        source = self.made("tentacle")
        (self.folder / "table.json").write_text(json.dumps({"seg_00": "Wurzel", "nobody": "x"}))
        self.assertIn("Wurzel", self.worlds(self.edit(source, "--rename-joints", "table.json")))
        self.assertIn('no joint is called "nobody"', self.warned)
        (self.folder / "table.json").write_text("[1]")
        self.assertIn("object", self.failed("edit", source, "-o", "x.bendy", "--rename-joints", "table.json"))

    def test_other_kinds(self):
        source = self.made("mannequin")
        path = self.edit(source, "--rename", "clip:Walk=Go", "--rename", "mesh:Body=Torso", "--rename",
                         "chain:IK_*=Reach *")
        self.assertEqual(self.clips(path), ["Idle", "Go"])
        self.assertEqual({mesh["name"] for mesh in self.pose(path)["meshes"]}, {"Torso", "Head"})
        self.assertIn(b"Reach LeftArm", path.read_bytes())

    def test_things_without_a_name_get_one_by_number(self):
        def forget(document):
            for thing in (*document["nodes"], *document["animations"]):
                thing.pop("name", None)

        for form in ("plain", "compact"):
            nameless = self.folder / "nameless.glb"
            nameless.write_bytes(glb_with(SOURCE / "examples" / "tentacle.glb", forget))
            self.done("convert", "-q", nameless, "-o", "nameless.bendy", *FORMS[form])
            path = self.edit("nameless.bendy", "--rename-joint", "#2=Two")
            self.assertEqual([k for k, name in enumerate(self.joints(path)) if name == "Two"], [2])
            path = self.edit("nameless.bendy", "--rename", "clip:#0=First")
            merged = self.edit("nameless.bendy", "--merge", path, name="merged.bendy")  # by the shape of the tree
            self.assertNotIn("no joint here", self.warned)
            self.assertIn("First", self.told)
            self.assertEqual(self.pose(merged, "--clip", "1", "--time", "0.3")["joints"],
                             self.pose("nameless.bendy", "--clip", "1", "--time", "0.3")["joints"])

    def test_mistakes_are_explained(self):
        source = self.made("mannequin")

        def said(*arguments):
            return self.failed("edit", source, "-o", "x.bendy", *arguments)

        self.assertIn('did you mean "mixamorig:Hips"?', said("--rename-joint", "Hips=Pelvis"))
        self.assertIn('called like "bip*"', said("--rename-joint", "bip*=*"))
        self.assertIn("would be empty", said("--rename-joint", "mixamorig:Hips*=*"))
        self.assertIn("OLD=NEW", self.misused("edit", source, "-o", "x.bendy", "--rename-joint", "Hips"))
        self.assertIn("KIND:OLD=NEW", self.misused("edit", source, "-o", "x.bendy", "--rename", "Hips=x"))
        self.assertIn("one of joint", self.misused("edit", source, "-o", "x.bendy", "--rename", "bone:a=b"))


class Retargeting(EditCase):
    """`--retarget`: what it says, what it refuses, and that nothing is written then."""

    def walker(self, frames=3):
        path = self.folder / "walker.bvh"
        path.write_text(walk(frames))
        return path

    def test_a_motion_goes_on_a_character_with_its_warnings(self):
        made = self.edit(self.made("mannequin"), "--retarget", self.walker())
        self.assertEqual(self.clips(made), ["Idle", "Walk", "walker"])
        self.assertIn("times as long as the source's", self.told)
        self.assertIn('retargeted clip "walker"', self.told)
        self.done("validate", made)

    def test_clips_are_chosen_by_name(self):
        source = self.made("mannequin")
        bare = self.edit(source, "--strip", "clips", name="bare.bendy")
        self.assertEqual(self.clips(self.edit(bare, "--retarget", f"{source}:W*")), ["Walk"])
        self.assertIn("no clip", self.failed("edit", bare, "-o", "x.bendy", "--retarget", f"{source}:Run"))
        self.assertFalse((self.folder / "x.bendy").exists())

    def test_a_taken_name_is_refused_unless_said_otherwise(self):
        source = self.made("mannequin")
        self.assertIn("--same-name", self.failed("edit", source, "-o", "x.bendy", "--retarget", source))
        again = self.edit(source, "--retarget", source, "--same-name", "number", "--limits", "off")
        self.assertEqual(self.clips(again), ["Idle", "Walk", "Idle.001", "Walk.001"])
        self.assertEqual(self.worlds(again, "--clip", "Walk.001", "--time", "0.37"), self.worlds(again, *Merge.CLIP))

    def test_bodies_without_roles_are_refused_with_what_to_write(self):
        source, other = self.made("mannequin"), self.made("tentacle")
        said = self.failed("edit", source, "-o", "x.bendy", "--retarget", other)
        self.assertIn("the source does not say what its joints are", said)
        self.assertIn('{"bendy_rig": 1, "roles": {"hips": "NAME"}}', said)
        self.assertIn("the target does not say", self.failed("edit", other, "-o", "x.bendy", "--retarget", source))
        self.assertFalse((self.folder / "x.bendy").exists())

    def test_strict_writes_nothing_if_there_is_a_warning(self):
        source = self.made("mannequin")
        headless = self.edit(source, "--strip", "clips", "--role", "head=", name="headless.bendy")
        result = self.bendy("edit", headless, "-o", "x.bendy", "--retarget", source, "--strict")
        self.assertEqual((result.returncode, result.stdout), (1, b""))
        warning, error = result.stderr.decode().splitlines()
        self.assertTrue(warning.endswith('nothing here follows 1 joint: "mixamorig:Head"'), warning)
        self.assertTrue(error.endswith("there are warnings, and --strict: nothing is written"), error)
        self.assertFalse((self.folder / "x.bendy").exists())
        self.edit(self.edit(source, "--strip", "clips", name="bare.bendy"), "--retarget", source, "--strict")

    def test_a_json_report_has_what_was_done_and_the_warnings(self):
        source = self.made("mannequin")
        headless = self.edit(source, "--strip", "clips", "--role", "head=", name="headless.bendy")
        out = self.edit(headless, "--retarget", source, "--json")
        report = json.loads(self.told)
        self.assertEqual((report["file"], report["bytes"]), ("edited.bendy", out.stat().st_size))
        self.assertTrue(report["done"][1].startswith('retargeted clip "Idle": '), report)
        self.assertTrue(report["warnings"][0].endswith('nothing here follows 1 joint: "mixamorig:Head"'), report)
        self.assertEqual(self.warned, "")
        self.assertEqual(self.bendy("edit", source, "-o", "-", "--strip", "clips", "--json").returncode, 2)

    def test_damaged_and_missing_files_are_refused(self):
        source = self.made("mannequin")
        whole = source.read_bytes()
        broken = self.folder / "broken.bendy"
        for size in (0, 7, 16, len(whole) // 2, len(whole) - 4):
            broken.write_bytes(whole[:size])
            self.assertIn("broken.bendy", self.failed("edit", source, "-o", "x.bendy", "--retarget", broken))
            self.assertIn("broken.bendy", self.failed("edit", broken, "-o", "x.bendy", "--retarget", source))
        self.assertIn("gone.glb", self.failed("edit", source, "-o", "x.bendy", "--retarget", "gone.glb"))
        self.assertFalse((self.folder / "x.bendy").exists())

    def test_merging_other_units_says_what_to_do(self):
        def in_centimetres(document):
            for node in document["nodes"]:
                if "translation" in node:
                    node["translation"] = [100 * number for number in node["translation"]]

        for name, advice in (("mannequin", "retarget its clips instead: --retarget "), ("tentacle", "apply the scale")):
            large = self.folder / "large.glb"
            large.write_bytes(glb_with(SOURCE / "examples" / f"{name}.glb", in_centimetres))
            bare = self.edit(self.made(name), "--strip", "clips", name="bare.bendy")
            said = self.failed("edit", bare, "-o", "x.bendy", "--merge", large)
            self.assertIn("the skeletons differ in scale", said)
            self.assertIn(advice, said)
        large.write_bytes(glb_with(SOURCE / "examples" / "mannequin.glb", in_centimetres))
        bare = self.edit(self.made("mannequin"), "--strip", "clips", name="bare.bendy")
        self.assertEqual(self.clips(self.edit(bare, "--retarget", large)), ["Idle", "Walk"])
        self.assertIn("0.01 times as long", self.told)


class Standing(EditCase):
    """--stand, --stand-as and --strip standing-pose."""

    def standing(self, path):
        return [leaf for leaf in chunks_of(path) if leaf[0].endswith("/STND")]

    def test_a_frame_of_a_clip_is_how_the_body_stands(self):
        source = self.made("mannequin")
        self.assertEqual(self.standing(source), [])
        told = self.edit(source, "--stand", "Walk@0.35", name="told.bendy")
        self.assertIn("the body stands as told", self.told)
        self.assertEqual(len(self.standing(told)), 1)
        back = self.edit(told, "--strip", "standing-pose", name="back.bendy")
        self.assertEqual(back.read_bytes(), source.read_bytes())
        self.assertEqual(len(self.standing(self.edit(source, "--stand-as", source))), 1)

    def test_it_comes_back_from_gltf_and_from_a_rig_file(self):
        source = self.made("mannequin")
        told = self.edit(source, "--stand", "Walk@0.35", name="told.bendy")
        self.done("export", told, "-o", "told.glb")
        self.done("convert", "told.glb", "-o", "again.bendy")
        self.assertEqual(self.standing(self.folder / "again.bendy"), self.standing(told))
        self.assertIn(b"the standing pose is left out", self.bendy("export", told, "-o", "told.x").stderr)
        self.done("rig", told, "-o", "told.rig.json")
        self.done("convert", source, "--rig", "told.rig.json", "-o", "ruled.bendy")
        self.assertEqual(self.standing(self.folder / "ruled.bendy"), self.standing(told))

    def test_mistakes_are_explained(self):
        source = self.made("mannequin")
        for text in ("Walk", "Walk@", "Walk@soon"):
            self.assertIn("is not CLIP@SECONDS", self.misused("edit", source, "-o", "x.bendy", "--stand", text))
        for text, why in (("Walk@9", "is from 0"), ("Walk@nan", "is from 0"), ("Run@0", "Run")):
            self.assertIn(why, self.failed("edit", source, "-o", "x.bendy", "--stand", text))
        self.assertIn("has no joint", self.failed("edit", source, "-o", "x.bendy", "--stand-as", self.made("tentacle")))
        self.assertIn("--role", self.failed("edit", self.made("tentacle"), "-o", "x.bendy", "--stand-as", source))
        self.assertEqual(self.files(), [])


class Merge(EditCase):
    CLIP = ["--clip", "Walk", "--time", "0.37"]

    def mirrored(self, form="plain", change=None, name="mannequin"):
        """An example with every node's children in the opposite order: other joint numbers."""
        source = self.folder / "mirrored.glb"

        def turn(document):
            for node in document["nodes"]:
                node.get("children", []).reverse()
            for scene in document["scenes"]:
                scene["nodes"].reverse()
            if change:
                change(document)

        source.write_bytes(glb_with(SOURCE / "examples" / f"{name}.glb", turn))
        path = self.folder / f"mirrored.{form}.bendy"
        self.done("convert", "-q", source, "-o", path, *FORMS[form])
        return path

    def test_tracks_find_their_joints_by_name(self):
        source = self.made("mannequin")
        other = self.mirrored()
        self.assertNotEqual(list(self.worlds(source)), list(self.worlds(other)))
        bare = self.edit(source, "--strip", "clips", name="bare.bendy")
        merged = self.edit(bare, "--merge", other)
        self.assertEqual(self.warned, "")
        self.assertEqual(self.pose(merged, *self.CLIP)["joints"], self.pose(source, *self.CLIP)["joints"])
        self.assertEqual(self.pose(merged, *self.CLIP)["meshes"], self.pose(source, *self.CLIP)["meshes"])

    def test_packed_clips_stay_packed(self):
        other = self.mirrored("compact")
        source = self.made("mannequin", "compact")
        merged = self.edit(source, "--strip", "clips", "--merge", other)
        self.assertEqual(self.worlds(merged, *self.CLIP), self.worlds(other, *self.CLIP))
        before = [child.letters for _, chunk in Chunk.read(other.read_bytes()).walk() if chunk.letters == "CYCL"
                  for child in chunk.children]
        after = [child.letters for _, chunk in Chunk.read(merged.read_bytes()).walk() if chunk.letters == "CYCL"
                 for child in chunk.children]
        self.assertEqual(after, before)
        self.assertIn("PACK", after)

    def test_merge_then_strip_gives_the_same_bytes(self):
        for form in FORMS:
            source = self.made("mannequin", form)
            merged = self.edit(source, "--merge", source, "--same-name", "number", name="merged.bendy")
            self.assertEqual(self.clips(merged), ["Idle", "Walk", "Idle.001", "Walk.001"])
            back = self.edit(merged, "--strip", "clip:*.001", name="back.bendy")
            self.assertEqual(back.read_bytes(), source.read_bytes())

    def test_a_taken_name(self):
        source = self.made("mannequin")
        self.assertIn("--same-name", self.failed("edit", source, "-o", "x.bendy", "--merge", source))
        replaced = self.edit(source, "--merge", source, "--same-name", "replace")
        self.assertEqual(replaced.read_bytes(), source.read_bytes())
        renamed = self.edit(source, "--rename", "clip:*=Old *", "--merge", source)
        self.assertEqual(self.clips(renamed), ["Old Idle", "Old Walk", "Idle", "Walk"])

    def test_gltf_files_are_converted_on_the_way(self):
        source = self.made("mannequin")
        merged = self.edit(source, "--strip", "clips", "--merge", SOURCE / "examples" / "mannequin.glb")
        self.assertEqual(merged.read_bytes(), source.read_bytes())

    def test_an_animation_only_file(self):
        source = self.made("mannequin")
        motion = self.edit(source, "--strip", "meshes", "--strip", "textures", "--strip", "materials", name="walk.bendy")
        self.assertLess(len(motion.read_bytes()), len(source.read_bytes()) / 3)
        merged = self.edit(source, "--strip", "clip:Walk", "--merge", motion, "--same-name", "number")
        self.assertEqual(self.worlds(merged, *self.CLIP), self.worlds(source, *self.CLIP))

    def test_missing_joints_are_listed(self):
        other = self.edit(self.made("mannequin"), "--rename-joint", "mixamorig:Left*=links *", name="other.bendy")
        self.edit(self.made("mannequin"), "--strip", "clips", "--merge", other)
        self.assertIn('"links Shoulder"', self.warned)
        self.assertIn("left out", self.told)
        other = self.edit(self.made("mannequin"), "--strip", "meshes", "--rename-joint", "*=x*y", name="other.bendy")
        self.assertIn("none of them is here", self.failed("edit", self.made("mannequin"), "-o", "x.bendy", "--strip",
                                                          "clips", "--merge", other))

    def test_another_rest_pose_is_told_and_rotations_stay(self):
        def turn(document):
            for node in document["nodes"]:
                if node.get("name") == "seg_03":
                    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
                    s = 0.5 ** 0.5  # a quarter turn about X behind it
                    node["rotation"] = [w * s + x * s, y * s + z * s, z * s - y * s, w * s - x * s]

        for form in ("plain", "compact"):
            other = self.mirrored(form, turn, "tentacle")
            source = self.made("tentacle", form)
            clip = ["--clip", "1", "--time", "0.37"]
            merged = self.edit(source, "--strip", "clips", "--merge", other)
            self.assertRegex(self.warned, "rest poses of 1 joint differ.*; if that is another body, retarget its clips instead")
            self.assertIn("turned by 90 degrees", self.warned)
            self.assertEqual("decoded, for another rest pose" in self.told, form == "compact")
            expected = self.worlds(other, *clip)
            for name, world in self.worlds(merged, *clip).items():
                for x, y in zip(world, expected[name]):
                    self.assertAlmostEqual(x, y, delta=1e-5)

    def two_characters(self):
        """Two characters that have joints of the same names below roots of their own, and a motion of such joints."""
        for name, roots in (("two.gltf", ["Alice", "Bob"]), ("motion.gltf", ["Carol"])):
            file = GltfFile(nodes=[], scenes=[{"nodes": [3 * k for k in range(len(roots))]}])
            for k, root in enumerate(roots):
                file.document["nodes"] += [{"name": root, "children": [3 * k + 1]}, {"name": "Hips", "children": [3 * k + 2]},
                                           {"name": f"Tail{k + 1}", "translation": [0, 1, 0]}]
            times = file.add([(0,), (1,)], "SCALAR")
            values = file.add([(0, 1, 0), (0, 3, 0)], "VEC3")
            if len(roots) == 1:
                file.document["animations"] = [{
                    "name": "wag", "samplers": [{"input": times, "output": values}],
                    "channels": [{"sampler": 0, "target": {"node": node, "path": "translation"}} for node in (1, 2)]}]
            file.write(self.folder / name)
            self.done("convert", name)
        return "two.bendy", "motion.bendy"

    def test_what_is_left_out_does_not_change_the_order_of_keys(self):
        """Keys are stored in the order in which tracks use them, as convert does: an export converts to the same bytes."""
        for name, joints in (("here", "BC"), ("there", "ABC")):
            file = GltfFile(nodes=[{"name": joint} for joint in joints], scenes=[{"nodes": list(range(len(joints)))}])
            times = file.add([(0,), (1,)], "SCALAR")
            shared, own = (file.add([(0, height, 0), (0, 3, 0)], "VEC3") for height in (1, 2))
            if name == "there":  # A and C have the same keys
                file.document["animations"] = [{
                    "name": "move", "samplers": [{"input": times, "output": values} for values in (shared, own, shared)],
                    "channels": [{"sampler": node, "target": {"node": node, "path": "translation"}} for node in range(3)]}]
            file.write(self.folder / f"{name}.gltf")
            self.done("convert", "-q", f"{name}.gltf")
        merged = self.edit("here.bendy", "--merge", "there.bendy")
        self.done("export", merged, "-q", "-o", "merged.glb")
        self.done("convert", "merged.glb", "-q", "-o", "again.bendy")
        self.assertEqual(Path(merged).read_bytes(), (self.folder / "again.bendy").read_bytes())

    def test_joints_that_several_have_the_name_of_are_named(self):
        two, motion = self.two_characters()
        self.edit(two, "--merge", motion)  # Tail1 is there once
        self.assertIn('it is not clear which joints here are meant by the tracks of 1 joint: "Hips"; "Hips" is the name of 2 joints '
                      "here (#1, #4) and of 1 joint in the other file (#1); rename all but one here first, as in #4=NEW", self.warned)
        self.assertNotIn("there is no joint here", self.warned)
        gone = ["--rename-joint", "Tail1=Other"]
        self.assertIn('its clips animate 2 joints, and it is not clear which one here is meant: "Hips" is the name of 2 joints here',
                      self.failed("edit", two, "-o", "x.bendy", *gone, "--merge", motion))
        merged = self.edit(two, "--rename-joint", "#4=Hips of Bob", "--merge", motion)
        self.assertNotIn("Hips", self.warned)
        self.assertIn('merged clip "wag": 2 tracks', self.told)
        self.assertEqual([joint["world"][13] for joint in self.pose(merged, "--clip", "wag", "--time", "1")["joints"]], [0, 3, 6, 0, 0, 1])

    def test_weights_go_by_the_names_of_targets(self):
        def swap(document):
            for mesh in document["meshes"]:
                names = mesh.get("extras", {}).get("targetNames")
                if not names:
                    continue
                names.reverse()
                mesh.get("weights", []).reverse()
                for primitive in mesh["primitives"]:
                    primitive["targets"].reverse()

        source = self.made("mannequin")
        other = self.mirrored(change=swap)
        clip = ["--clip", "Idle", "--time", "0.4"]
        merged = self.edit(source, "--strip", "clips", "--merge", other)
        # Its weights now mean the other targets: as the file says that they come from.
        expected = self.pose(other, *clip)["meshes"]
        found = {mesh["name"]: mesh["positions"] for mesh in self.pose(merged, *clip)["meshes"]}
        for mesh in expected:
            for x, y in zip(found[mesh["name"]], mesh["positions"]):
                self.assertAlmostEqual(x, y, delta=1e-6)


class Extract(EditCase):
    def below(self, root, name):
        """The names of a joint and all below it, and its entries of polygons."""
        names = []
        for _, chunk in root.walk():
            if chunk.letters == "SKIN" and any(c.letters == "NAME" and c.payload.decode() == name for c in chunk.children):
                for _, inner in chunk.walk():
                    if inner.letters == "SKIN":
                        names += [c.payload.decode() for c in inner.children if c.letters == "NAME"]
        return names

    def test_what_stays_stays_where_it_was(self):
        inside = self.below(Chunk.read(self.made("mannequin").read_bytes()), "mixamorig:LeftArm")
        self.assertEqual(len(inside), 18)
        for form in FORMS:
            source = self.made("mannequin", form)
            part = self.edit(source, "--extract", "mixamorig:LeftArm")
            for clip in ([], ["--clip", "Walk", "--time", "0.3"], ["--clip", "Idle", "--time", "0.8"]):
                before = self.pose(source, *clip)
                after = self.pose(part, *clip)
                worlds = {joint["name"]: joint["world"] for joint in before["joints"]}
                names = [joint["name"] for joint in after["joints"]]
                self.assertLessEqual(set(inside), set(names))
                self.assertLess(len(names), 30)
                for joint in after["joints"]:
                    self.assertEqual(joint["world"], worlds[joint["name"]], (form, clip))
                body = next(mesh for mesh in before["meshes"] if mesh["name"] == "Body")
                [arm] = after["meshes"]
                there = set(zip(*[iter(body["positions"])] * 3))
                here = list(zip(*[iter(arm["positions"])] * 3))
                self.assertLess(len(here), len(there) / 3)
                self.assertLessEqual(set(here), there)

                def triangles(mesh):
                    corners = list(zip(*[iter(mesh["positions"])] * 3))
                    return {frozenset(corners[k] for k in three) for three in zip(*[iter(mesh["indices"])] * 3)}
                self.assertLessEqual(triangles(arm), triangles(body))

    def test_the_polygons_are_those_of_the_joints(self):
        source = self.made("mannequin")
        root = Chunk.read(source.read_bytes())
        expected = 0
        for path, chunk in root.walk():
            names = [c for c in (chunk.children or []) if c.letters == "NAME"]
            if chunk.letters == "SKIN" and names and names[0].payload == b"mixamorig:LeftForeArm":
                expected = sum(struct.unpack_from("<I", inner.payload, 12)[0] for _, inner in chunk.walk()
                               if inner.letters == "POLY")
        part = self.pose(self.edit(source, "--extract", "mixamorig:LeftForeArm"))
        self.assertEqual(sum(len(mesh["indices"]) for mesh in part["meshes"]), expected)
        self.assertGreater(expected, 0)

    def test_levels_of_detail_go_on_working(self):
        for form in ("lod", "lod_compact"):
            part = self.edit(self.made("mannequin", form), "--extract", "mixamorig:LeftArm")
            full = self.pose(part)["meshes"][0]
            few = self.pose(part, "--lod", "0.3")["meshes"][0]
            self.assertLess(len(few["indices"]), 0.6 * len(full["indices"]))
            self.assertGreater(len(few["indices"]), 0)
            self.assertLess(max(few["indices"]), len(few["positions"]) // 3)

    def test_the_whole_is_a_part(self):
        source = self.made("tentacle")
        part = self.edit(source, "--extract", "TentacleRig")
        self.assertEqual(self.pose(part), {**self.pose(source), "file": self.pose(part)["file"]})

    def test_a_joint_without_polygons(self):
        part = self.edit(self.made("mannequin"), "--extract", "ctl_LeftFoot")
        self.assertIn("no vertices", self.warned)
        self.assertIn("ctl_LeftFoot", self.worlds(part))

    def test_targets_and_eyes(self):
        for form in FORMS:
            source = self.made("mannequin", form)
            part = self.edit(source, "--extract", "mixamorig:Head")
            clip = ["--clip", "Idle", "--time", "0.4"]
            there = {tuple(p) for mesh in self.pose(source, *clip)["meshes"]
                     for p in zip(*[iter(mesh["positions"])] * 3)}
            for mesh in self.pose(part, *clip)["meshes"]:
                self.assertLessEqual(set(zip(*[iter(mesh["positions"])] * 3)), there)


class Differ(EditCase):
    """What `bendy diff` says of edited files."""

    def lines(self, *arguments):
        result = self.bendy("diff", *arguments)
        self.assertEqual((result.returncode, result.stderr), (1, b""), result)
        return result.stdout.decode().splitlines()

    def test_names_in_a_table(self):
        source = self.made("mannequin", "compact")
        path = self.edit(source, "--rename-joint", "mixamorig:Hips=Pelvis")
        [line] = self.lines(source, path)
        self.assertIn('joint 3: "mixamorig:Hips" -> "Pelvis"', line)

    def test_one_clip_less_is_one_difference(self):
        source = self.made("mannequin", "compact")
        path = self.edit(source, "--strip", "clip:Idle")
        lines = self.lines(source, path)
        self.assertEqual(len(lines), 2, lines)
        self.assertIn("clips: 2 -> 1", lines[0])
        self.assertIn('CYCL "Idle": only in A', lines[1])
        report = json.loads(self.bendy("diff", source, path, "--json").stdout)
        self.assertEqual([entry["kind"] for entry in report["differences"]], ["value", "onlyInA"])

    def test_rest_transforms_in_a_table_count(self):
        other = self.folder / "other.glb"

        def move(document):
            node = next(node for node in document["nodes"] if node.get("name") == "seg_03")
            node["translation"] = [x + 0.001 for x in node["translation"]]

        other.write_bytes(glb_with(SOURCE / "examples" / "tentacle.glb", move))
        self.done("convert", "-q", other, "-o", "other.bendy", "--compact")
        lines = self.lines(self.made("tentacle", "compact"), "other.bendy")
        [line] = [line for line in lines if "JNTS" in line]
        self.assertIn('"seg_03": translation:', line)

    def test_levels_count(self):
        source = self.made("tentacle", "lod")
        root = Chunk.read(source.read_bytes())
        table = root.find("HEAD/OBJE/LODD")
        meshes, levels = struct.unpack_from("<II", table.payload)
        first = 16 + 16 * meshes
        error = struct.unpack_from("<f", table.payload, first + 8 * (levels - 1))[0]
        table.payload = (table.payload[: first + 8 * (levels - 1)] + struct.pack("<f", 2 * error + 1)
                         + table.payload[first + 8 * (levels - 1) + 4 :])
        path = self.folder / "changed.bendy"
        path.write_bytes(root.write())
        [line] = self.lines(source, path)
        self.assertIn("errors of the levels: 1 of", line)


if __name__ == "__main__":
    main()
