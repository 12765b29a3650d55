#!/usr/bin/env python3
"""What the program says to people: mistyped words, missing arguments and folders, summaries, what a terminal shows.

    messages_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import fcntl
import json
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from gltf_file import GltfFile, named_file, read_name_keys, strange_file  # noqa: E402
from program import BENDY, SOURCE, Case, main  # noqa: E402

COMMANDS = ("convert", "inspect", "validate", "pose", "render", "rig", "diff", "dump", "assemble", "edit", "export", "view", "bench")
COLOUR = "\x1b["


class MessageCase(Case):
    def bendy(self, *arguments, **options):
        return subprocess.run([BENDY, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=300,
                              check=False, **options)

    def done(self, *arguments):
        result = self.bendy(*arguments)
        self.assertEqual(result.returncode, 0, (arguments, result.stderr))
        return result.stdout

    def refused(self, status, *arguments):
        """The first line that is said of what must not work; the others, if any."""
        result = self.bendy(*arguments)
        self.assertEqual(result.returncode, status, (arguments, result.stdout, result.stderr))
        first, *rest = result.stderr.splitlines()
        self.assertTrue(first.startswith("bendy: error: "), first)
        return first.removeprefix("bendy: error: "), rest

    def converted(self, name="mannequin", *options):
        path = self.shared / f"{name}{'_'.join(options)}.bendy"
        if not path.exists():
            self.done("convert", SOURCE / f"examples/{name}.glb", "-o", path, "-q", *options)
        return path

    def on_terminal(self, *arguments, columns=70, environment=None, pause=None):
        """Runs it with standard output and error on one terminal: exit status, and what that was sent. pause: seconds after
        which the program is stopped for a while."""
        ours, its = os.openpty()
        fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        plain = {name: value for name, value in os.environ.items() if name != "NO_COLOR"}
        process = subprocess.Popen([BENDY, *map(str, arguments)], cwd=self.folder, stdout=its, stderr=its,
                                   env={**plain, "TERM": "xterm", **(environment or {})})
        os.close(its)
        if pause is not None:
            time.sleep(pause)
            process.send_signal(signal.SIGSTOP)
            time.sleep(1.2)
            process.send_signal(signal.SIGCONT)
        sent = b""
        try:
            while piece := os.read(ours, 65536):
                sent += piece
        except OSError:  # Linux says so at the end
            pass
        os.close(ours)
        return process.wait(timeout=300), sent.decode().replace("\r\n", "\n")


class CommandLine(MessageCase):
    def test_mistyped_commands(self):
        for typed, meant in (("cnvert", "convert"), ("inspct", "inspect"), ("Render", "render"), ("converts", "convert")):
            line, rest = self.refused(2, typed, "a.glb")
            self.assertEqual(line, f'there is no command {typed}; did you mean "{meant}"?')
            self.assertEqual(rest, ["Try `bendy --help`."])
        self.assertEqual(self.refused(2, "xyzzyx")[0], "there is no command xyzzyx")

    def test_a_file_in_place_of_a_command(self):
        file = self.converted()
        self.assertEqual(self.refused(2, file)[0], f"a command is missing before {file}: inspect, view or another")

    def test_mistyped_options(self):
        line, rest = self.refused(2, "convert", "--compcat", "a.glb")
        self.assertEqual(line, 'there is no option --compcat; did you mean "--compact"?')
        self.assertEqual(rest, ["Try `bendy convert --help`."])
        # The option is what is wrong, whatever else is missing because of it.
        self.assertEqual(self.refused(2, "render", "--ouput=x.png")[0], 'there is no option --ouput; did you mean "--output"?')
        self.assertEqual(self.refused(2, "--vresion")[0], 'there is no option --vresion; did you mean "--version"?')
        # The dashes alone do not make two options alike.
        self.assertEqual(self.refused(2, "rig", "--clip", "Walk")[0], "there is no option --clip")
        self.assertNotIn("--script", self.refused(2, "view", "--scrip")[0])  # for tests only

    def test_words_that_are_no_choice(self):
        line, _ = self.refused(2, "pose", self.converted(), "--reach", "a=1,2,3", "--solver", "fabrk")
        self.assertEqual(line, '--solver: "fabrk" is not a choice; did you mean "fabrik"? choose one of chain, pull, two_bone, '
                               "ccd, fabrik, aim and least_squares")
        self.assertIn("choose one of embed and link", self.refused(2, "convert", "a.glb", "--images", "nonsense")[0])

    def test_missing_arguments_are_named_as_the_usage_has_them(self):
        for arguments, what in ((("diff",), "A and B are missing"), (("diff", "a.bendy"), "B is missing"),
                                (("render",), "FILE and --output are missing"), (("render", "a.bendy"), "--output is missing"),
                                (("render", "-o", "x.png"), "FILE is missing"), (("convert",), "IN is missing"),
                                (("pose", "a.bendy", "--clip"), "--clip needs a value")):
            line, rest = self.refused(2, *arguments)
            self.assertEqual(line, what)
            self.assertEqual(rest, [f"Try `bendy {arguments[0]} --help`."])

    def test_arguments_too_many_are_named_in_the_order_given(self):
        self.assertEqual(self.refused(2, "inspect", "a", "b", "c", "d")[0], "too many arguments: b, c and d")
        self.assertEqual(self.refused(2, "inspect", "a", "b")[0], "one argument too many: b")

    def test_help_is_a_command_too(self):
        self.assertEqual(self.done("help"), self.done("--help"))
        self.assertEqual(self.done("help", "help"), self.done("--help"))
        for command in COMMANDS:
            self.assertEqual(self.done("help", command), self.done(command, "--help"), command)
        self.assertEqual(self.refused(2, "help", "cnvert")[0], 'there is no command cnvert; did you mean "convert"?')

    def test_no_hint_has_a_placeholder(self):
        for arguments in ((), ("cnvert",), ("--bogus",), *((command, "--bogus") for command in COMMANDS)):
            self.assertNotIn("COMMAND", self.bendy(*arguments).stderr)


class Names(MessageCase):
    def test_clips(self):
        line, _ = self.refused(1, "pose", self.converted(), "--clip", "Wlak")
        self.assertIn('there is no clip "Wlak"; did you mean "Walk"? There are "Idle" and "Walk"', line)
        line, _ = self.refused(1, "pose", self.converted(), "--clip", "Somersault")
        self.assertIn('there is no clip "Somersault"; there are "Idle" and "Walk"', line)
        line, _ = self.refused(1, "bench", SOURCE / "spec/examples/one_joint.bendy", "--clip", "x")
        self.assertIn("there are none (`bendy edit --retarget`", line)

    def test_chains_by_their_own_names_and_by_their_joints(self):
        line, _ = self.refused(1, "pose", self.converted(), "--reach", "IK_LeftArn=0,1,0")
        self.assertIn('there is no IK chain "IK_LeftArn"; did you mean "IK_LeftArm"? There are ', line)
        line, _ = self.refused(1, "pose", self.converted(), "--reach", "mixamorig:LeftHnd=0,1,0")
        self.assertIn('did you mean "mixamorig:LeftHand"?', line)

    def test_joints_and_scenes(self):
        line, _ = self.refused(1, "convert", SOURCE / "examples/mannequin.glb", "-o", "x.bendy", "--skeleton", "mixamorig:Hisp")
        self.assertIn('there is no joint "mixamorig:Hisp"; did you mean "mixamorig:Hips"?', line)
        file = GltfFile(scenes=[{"name": "Town", "nodes": [0]}, {"name": "Country", "nodes": [0]}], nodes=[{"name": "one"}])
        file.document["meshes"] = []
        del file.document["meshes"], file.document["bufferViews"], file.document["accessors"]
        (self.folder / "two.gltf").write_text(json.dumps(file.document))
        line, _ = self.refused(1, "convert", "two.gltf", "--scene", "Twon")
        self.assertIn('there is no scene "Twon"; did you mean "Town"? There are "Town" and "Country"', line)

    def test_one_reading_of_names_and_numbers(self):
        names, keys = read_name_keys(SOURCE / "tests/format/name_keys.txt")
        source = named_file(self.folder / "named.gltf", names)
        self.done("convert", source, "-o", "named.bendy", "-q")
        out = ("-o", "out.bendy", "-q")

        def place(*arguments):
            """Where the first joint is."""
            return json.loads(self.done("pose", *arguments, "--format", "json"))["joints"][0]["world"][12]

        def clips():
            return [clip["name"] for clip in json.loads(self.done("inspect", "out.bendy", "--json"))["summary"]["clips"]]

        for key, expected in keys.items():
            by_kind = {"clip": ("pose", "named.bendy", f"--clip={key}"),
                       "scene": ("convert", source, *out, f"--scene={key}"),
                       "joint": ("edit", "named.bendy", *out, f"--extract={key}")}
            strip = ("edit", "named.bendy", *out, f"--strip=clip:{key}")
            rename = ("edit", "named.bendy", *out, f"--rename=clip:{key}=new")
            if isinstance(expected, str):
                for kind, command in by_kind.items():
                    said = (f'{kind} "{key}" is ambiguous: ={key} is the {kind} with this name, #{key} the {kind} with this number'
                            if expected == "ambiguous" else f"there is no {kind} ")
                    self.assertIn(said, self.refused(1, *command)[0], key)
                self.refused(1, *strip)
                self.refused(2 if key == "=" else 1, *rename)  # "==new" has no old name
                continue
            self.assertEqual(place(*by_kind["clip"][1:]), expected, key)
            self.done(*by_kind["scene"])
            self.assertEqual(place("out.bendy"), expected, key)
            meant = [k for k, name in enumerate(names)
                     if k == expected or (not key.startswith("#") and name == key.removeprefix("="))]
            self.done(*strip)
            self.assertEqual(clips(), [name for k, name in enumerate(names) if k not in meant], key)
            self.done(*rename)
            self.assertEqual(clips(), ["new" if k in meant else name for k, name in enumerate(names)], key)
        self.assertEqual(place("named.bendy", "--clip", "=Run"), 2)
        self.done("edit", "named.bendy", *out, "--extract", "#5")
        self.assertIn("2 joints are called", self.refused(1, "edit", "named.bendy", *out, "--extract", "=Run")[0])

    def test_names_from_a_file_cannot_forge_lines(self):
        self.done("convert", strange_file(self.folder / "strange.gltf"), "-o", "strange.bendy", "-q")
        result = self.bendy("pose", "strange.bendy", "--clip", "slide\tnwo")
        self.assertEqual(len(result.stderr.splitlines()), 1)
        self.assertIn(r'did you mean "slide\x09now"?', result.stderr)


class Folders(MessageCase):
    def test_a_missing_folder_is_named_before_the_work(self):
        model, glb = self.converted(), SOURCE / "examples/mannequin.glb"
        for arguments in (("convert", glb), ("pose", model), ("rig", model), ("dump", model), ("export", model),
                          ("edit", model, "--strip", "extras"), ("render", model)):
            output = {"pose": "no/where/x.obj", "export": "no/where/x.glb", "render": "no/where/x.png"}.get(
                arguments[0], "no/where/x")
            line, rest = self.refused(1, *arguments, "-o", output)
            self.assertEqual(line, f"{output}: there is no folder no/where: make it first")
            self.assertEqual(rest, [])
        self.assertIn("there is no folder no: ", self.refused(1, "convert", glb, "-o", "x.bendy", "--depfile", "no/d")[0])
        self.assertIn("there is no folder no: ", self.refused(1, "inspect", model, "--html", "no/x.html")[0])
        (self.folder / "file").write_bytes(b"")
        self.assertIn("file is a file, not a folder", self.refused(1, "rig", model, "-o", "file/x.json")[0])
        self.assertEqual(os.listdir(self.folder), ["file"])

    def test_the_folder_of_a_batch_is_made(self):
        shutil.copy(SOURCE / "examples/tentacle.glb", self.folder / "a.glb")
        shutil.copy(SOURCE / "examples/tentacle.glb", self.folder / "b.glb")
        self.done("convert", "a.glb", "b.glb", "-o", "new/deep")
        self.assertTrue((self.folder / "new/deep/b.bendy").exists())


class Summaries(MessageCase):
    def test_inspect_begins_with_what_convert_printed(self):
        said = self.done("convert", SOURCE / "examples/mannequin.glb", "-o", "m.bendy")
        inspected = self.done("inspect", "m.bendy")
        summary = self.done("inspect", "m.bendy", "--summary")
        self.assertEqual(summary, said)
        self.assertTrue(inspected.startswith(summary + "\n      offset "), inspected[:2000])
        self.assertTrue(summary.startswith(f"m.bendy: {(self.folder / 'm.bendy').stat().st_size:,} bytes, "), summary)
        self.assertIn("\n  clips          2: Idle 3 s, Walk 1 s\n", summary)
        self.assertIn("\n  morph targets  2: Blink, Smile\n", summary)
        self.assertRegex(summary, r"\n  meshes         2 with 4,504 vertices, 8,052 triangles, up to 3 influences a vertex\n")
        self.assertRegex(summary, r"\n  bounds         [\d.]+ x [\d.]+ x [\d.]+ m, from \S+ \S+ \S+ to \S+ \S+ \S+\n")
        self.assertRegex(summary, r"\n  bytes          skeleton [\d,]+, .*positions [\d,]+, .*clips [\d,]+")

    def test_json_has_everything_by_name(self):
        document = json.loads(self.done("inspect", self.converted(), "--json"))
        summary = document["summary"]
        self.assertEqual(list(document), ["file", "bytes", "summary", "chunks"])
        self.assertEqual([clip["name"] for clip in summary["clips"]], ["Idle", "Walk"])
        self.assertEqual([clip["seconds"] for clip in summary["clips"]], [3, 1])
        self.assertEqual(len(summary["joints"]), 65)
        chunks = document["chunks"]
        names = [entry["fields"]["text"] for entry in chunks
                 if entry["id"] == "NAME" and chunks[entry["parent"]]["id"] == "SKIN"]
        self.assertEqual(sorted(joint["name"] for joint in summary["joints"] if joint["name"]), sorted(names))
        for joint in summary["joints"]:
            self.assertTrue(joint["parent"] is None or joint["parent"] < joint["number"])
        self.assertEqual({target for mesh in summary["meshes"] for target in mesh["morphTargets"]}, {"Blink", "Smile"})
        self.assertEqual(sum(mesh["triangles"] for mesh in summary["meshes"]), 8052)
        self.assertIn("IK_LeftArm", [chain["name"] for chain in summary["chains"]])
        self.assertEqual((len(summary["materials"]), len(summary["textures"])), (5, 1))
        self.assertEqual(sum(summary["bytesByKind"].values()), document["bytes"])
        self.assertEqual(summary["levels"], [])

    def test_bounds_hold_the_posed_vertices_and_touch_them(self):
        bounds = json.loads(self.done("inspect", self.converted(), "--json", "--summary"))["summary"]["bounds"]
        corners = [tuple(map(float, line.split()[1:4])) for line in self.done("pose", self.converted()).splitlines()
                   if line.startswith("v ")]
        for axis in range(3):
            self.assertAlmostEqual(bounds["min"][axis], min(c[axis] for c in corners), delta=1e-5)
            self.assertAlmostEqual(bounds["max"][axis], max(c[axis] for c in corners), delta=1e-5)

    def test_summary_json_is_the_summary_alone(self):
        both = json.loads(self.done("inspect", self.converted(), "--json"))
        alone = json.loads(self.done("inspect", self.converted(), "--json", "--summary"))
        self.assertEqual(list(alone), ["file", "bytes", "summary"])
        self.assertEqual(alone["summary"], both["summary"])
        self.assertNotIn("summary", json.loads(self.done("inspect", self.converted(), "--json", "--chunk", "HEAD/VERS")))

    def test_files_with_little_in_them(self):
        for path in sorted((SOURCE / "spec/examples").glob("*.bendy")):
            summary = self.done("inspect", path, "--summary")
            self.assertIn(path.name, summary)
            json.loads(self.done("inspect", path, "--summary", "--json"), parse_constant=self.fail)
        self.done("convert", strange_file(self.folder / "strange.gltf"), "-o", "s.bendy", "-q")
        summary = self.done("inspect", "s.bendy", "--summary")
        times = "1 s (0.5 to 1.5 s)"
        self.assertIn(rf"slide\x09now {times}, #1 {times}, 0 {times}", summary)
        self.assertFalse(any(ord(c) < 0x20 and c != "\n" for c in summary))
        self.assertEqual([c["name"] for c in json.loads(self.done("inspect", "s.bendy", "--json"))["summary"]["clips"]],
                         ["slide\tnow", "", "0"])

    def test_a_damaged_file_has_a_tree_and_no_summary(self):
        data = bytearray(self.converted("tentacle").read_bytes())
        data[-20] ^= 1
        (self.folder / "bad.bendy").write_bytes(data)
        result = self.bendy("inspect", "bad.bendy")
        self.assertEqual(result.returncode, 1)
        self.assertTrue(result.stdout.startswith("bad.bendy, "))
        self.assertIn("  FAULT: ", result.stdout)
        self.assertIsNone(json.loads(self.bendy("inspect", "bad.bendy", "--json").stdout)["summary"])
        self.assertTrue(self.refused(1, "inspect", "bad.bendy", "--summary")[0].startswith("bad.bendy: "))

    def test_levels_of_detail_are_listed(self):
        said = self.done("convert", SOURCE / "examples/mannequin.glb", "--lod", "-o", "l.bendy")
        line = next(line for line in said.splitlines() if line.startswith("  levels "))
        self.assertRegex(line, r"^  levels         100 % 8,052, 50 % [\d,]+ \([\d.e-]+ mm off\), 25 % [\d,]+ \(.*\), "
                               r"10 % [\d,]+ \(.*\), fewest [\d,]+ triangles? \(.*\)$")
        levels = json.loads(self.done("inspect", "l.bendy", "--json", "--summary"))["summary"]["levels"]
        self.assertEqual([level["share"] for level in levels], [1, 0.5, 0.25, 0.1, 0])
        for before, after in zip(levels, levels[1:]):
            self.assertLess(after["triangles"], before["triangles"])
            self.assertLess(after["vertices"], before["vertices"])
            self.assertGreater(after["error"], before["error"])
        for level in levels:  # what `pose --lod` writes
            faces = sum(line.startswith("f ") for line in self.done("pose", "l.bendy", "--lod", level["share"]).splitlines())
            self.assertEqual(faces, level["triangles"])


class Terminal(MessageCase):
    def test_no_line_of_inspect_wraps(self):
        for columns in (40, 79, 200):
            for arguments in (("inspect", self.converted()), ("inspect", self.converted(), "--all")):
                status, text = self.on_terminal(*arguments, columns=columns)
                self.assertEqual(status, 0)
                lines = re.sub(r"\x1b\[[\d;]*m", "", text).splitlines()
                tree = lines[next(k for k, line in enumerate(lines) if line.startswith("      offset")):]
                self.assertGreater(len(tree), 30)
                self.assertLessEqual(max(map(len, tree)), columns)
                self.assertEqual(any(line.endswith("...") for line in tree), True)
        status, text = self.on_terminal("inspect", self.converted(), "--summary", columns=79)
        self.assertLessEqual(max(len(line) for line in re.sub(r"\x1b\[[\d;]*m", "", text).splitlines()), 79)
        whole = self.done("inspect", self.converted(), "--summary")
        self.assertEqual(re.sub(r"\x1b\[[\d;]*m", "", text).split(), whole.split())  # folded, nothing is cut

    def test_wide_letters_take_two_columns(self):
        file = GltfFile(scenes=[{"nodes": [0]}], nodes=[{"name": "\u624b" * 60}])
        del file.document["bufferViews"], file.document["accessors"]
        (self.folder / "wide.gltf").write_text(json.dumps(file.document))
        self.done("convert", "wide.gltf", "-q")
        _, text = self.on_terminal("inspect", "wide.bendy", columns=60)
        line = next(line for line in re.sub(r"\x1b\[[\d;]*m", "", text).splitlines() if " SKIN 0" in line)
        self.assertLessEqual(len(line) + line.count("\u624b"), 60)
        self.assertTrue(line.endswith("..."))

    def test_a_pipe_gets_whole_lines_without_colour(self):
        text = self.done("inspect", self.converted())
        self.assertNotIn(COLOUR, text)
        self.assertGreater(max(map(len, text.splitlines())), 100)

    def test_errors_and_warnings_are_coloured_on_a_terminal(self):
        _, text = self.on_terminal("inspect", "missing.bendy")
        self.assertTrue(text.startswith("bendy: \x1b[1;31merror:\x1b[0m missing.bendy: "), text)
        _, text = self.on_terminal("cnvert")
        self.assertTrue(text.startswith("bendy: \x1b[1;31merror:\x1b[0m there is no command cnvert"), text)
        _, text = self.on_terminal("pose", self.converted("tentacle"), "--lod", "0.5", "-o", "x.obj")
        self.assertIn("bendy: \x1b[1;33mwarning:\x1b[0m ", text)
        _, text = self.on_terminal("inspect", self.converted("tentacle"))
        self.assertIn("\x1b[1mSKIN\x1b[0m", text)

    def test_colour_is_left_out_where_it_is_not_wanted(self):
        for environment in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
            for arguments in (("inspect", "missing.bendy"), ("inspect", self.converted("tentacle")), ("cnvert",)):
                _, text = self.on_terminal(*arguments, environment=environment)
                self.assertNotIn(COLOUR, text)
        _, text = self.on_terminal("inspect", "missing.bendy", environment={"NO_COLOR": ""})  # as if it were not set
        self.assertIn(COLOUR, text)
        self.assertNotIn(COLOUR, self.bendy("inspect", "missing.bendy").stderr)

    def test_long_work_shows_how_far_it_is(self):
        arguments = ("convert", SOURCE / "examples/mannequin.glb", "--lod", "-o", "c.bendy")
        status, text = self.on_terminal(*arguments, pause=0.15)
        self.assertEqual(status, 0)
        self.assertRegex(text, r"\rconverting mannequin\.glb (\[#* *\] +\d+ %, )?0:0\d")
        self.assertRegex(text, r"\r\x1b\[Kbendy: ")  # which then goes away
        for line in text.split("\r"):
            self.assertLess(len(line.split("\x1b")[0]), 70)
        _, text = self.on_terminal(*arguments, "-q", pause=0.15)
        self.assertNotIn("converting", text)
        self.assertNotIn("converting", self.bendy(*arguments).stderr)


class Batches(MessageCase):
    def setUp(self):
        super().setUp()
        for place in ("a.glb", "b.glb", "deep/c.glb"):
            (self.folder / "in" / place).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / "examples/tentacle.glb", self.folder / "in" / place)

    def lines(self, text):
        return [line for line in text.splitlines() if " -> " in line]

    def test_a_line_for_each_file_in_order(self):
        shutil.copy(SOURCE / "examples/mannequin.glb", self.folder / "in/a.glb")  # the longest comes first
        for jobs in ("1", "3"):
            lines = self.lines(self.done("convert", "in", "-o", f"out{jobs}", "-j", jobs))
            self.assertEqual([line.split()[0] for line in lines], ["in/a.glb", "in/b.glb", "in/deep/c.glb"])
            for line in lines:
                self.assertRegex(line, rf"^in/(\S+)\.glb -> out{jobs}/\1\.bendy  [\d,]+ bytes  (1 warning  )?\d+\.\d s$")
        self.assertEqual(self.done("convert", "in", "-o", "out1", "--force", "-q"), "")

    def test_warnings_are_counted_and_stand_with_their_file(self):
        file = GltfFile(scenes=[{"nodes": [0]}], nodes=[{"name": "one", "camera": 0}],
                        cameras=[{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}])
        del file.document["bufferViews"], file.document["accessors"]
        (self.folder / "in/b.gltf").write_text(json.dumps(file.document))
        (self.folder / "in/b.glb").unlink()
        result = self.bendy("convert", "in", "-o", "out", "-j", "3")
        self.assertEqual(result.returncode, 0)
        count = sum("in/b.gltf" in line for line in result.stderr.splitlines())
        self.assertGreater(count, 0)
        self.assertRegex(self.lines(result.stdout)[1], rf"^in/b\.gltf -> .* bytes  {count} warnings?  ")

    def test_without_an_output_each_goes_beside_its_source(self):
        said = self.done("convert", "in/a.glb", "in/deep/c.glb")
        self.assertIn("in/a.glb -> in/a.bendy  ", said)
        self.assertTrue((self.folder / "in/deep/c.bendy").exists())
        self.assertNotIn(" -> ", self.done("convert", "in/a.glb", "in/deep/c.glb"))  # both are up to date
        said = self.done("convert", "in")  # a.bendy is known as an output, deep/c.bendy as that of another folder
        self.assertIn("in/b.glb -> in/b.bendy  ", said)
        self.assertNotIn("in/a.glb", said)
        self.assertNotIn(" -> ", self.done("convert", "in"))
        self.assertNotIn(" -> ", self.done("convert", self.folder / "in"))  # the same, written otherwise
        (self.folder / "in/b.bendy").write_bytes(b"spoilt")
        self.assertEqual([line.split()[0] for line in self.lines(self.done("convert", "in"))], ["in/b.glb"])
        self.assertEqual(self.lines(self.done("convert", "in", "--lod"))[0].split()[0], "in/a.glb")  # other options
        single = self.folder / "single.bendy"
        self.done("convert", "in/a.glb", "-o", single, "--lod")
        self.assertEqual((self.folder / "in/a.bendy").read_bytes(), single.read_bytes())

    def test_beside_the_sources_names_may_clash_and_inputs_are_safe(self):
        shutil.copy(self.folder / "in/a.glb", self.folder / "in/a.vrm")
        result = self.bendy("convert", "in/a.glb", "in/a.vrm")
        self.assertEqual((result.returncode, result.stdout), (1, ""))
        self.assertIn("in/a.bendy: both in/a.glb and in/a.vrm would be written there", result.stderr)
        self.done("convert", "in/b.glb")
        before = (self.folder / "in/b.bendy").read_bytes()
        self.assertIn("is an input as well as an output", self.bendy("convert", "in/b.glb", "in/b.bendy").stderr)
        self.assertEqual((self.folder / "in/b.bendy").read_bytes(), before)

    def test_a_terminal_shows_the_lines_and_a_bar_with_the_time(self):
        status, text = self.on_terminal("convert", "in", "-o", "out", columns=120)
        self.assertEqual(status, 0)
        self.assertRegex(text, r"\rconverting \[#* *\] \d/3[^\r]*, \d+:\d\d")
        self.assertEqual(len(re.findall(r" -> out/\S+  [\d,]+ bytes", text)), 3)


if __name__ == "__main__":
    main()
