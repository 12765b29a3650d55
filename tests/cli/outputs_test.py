#!/usr/bin/env python3
"""What `bendy` may write over, what it takes from standard input and gives to standard output, and which names it
refuses: each for every subcommand (docs/decisions/0031).

    outputs_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import json
import os
import pty
import re
import shutil
import struct
import subprocess
import sys
import unittest
import zlib
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from gltf_file import GltfFile  # noqa: E402
from md2_file import md2_file  # noqa: E402
from program import BENDY, SOURCE, WITHOUT_PICTURES, Case, main  # noqa: E402

FOREIGN = b"of somebody else"
SIZE = ("--size", "16x16")


def png_chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


# One red pixel.
PNG = (b"\x89PNG\r\n\x1a\n" + png_chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0))
       + png_chunk(b"IDAT", zlib.compress(b"\0\xff\0\0")) + png_chunk(b"IEND", b""))


class Writer:
    """A subcommand that writes a file. `kind`: what it reads; `suffixes`: what it writes, the first by default."""

    def __init__(self, command, kind, suffixes, arguments=(), option="-o", default=None):
        self.command, self.kind, self.suffixes = command, kind, suffixes
        self.arguments, self.option, self.default = tuple(arguments), option, default

    def line(self, source, output=None):
        line = (self.command, source, *self.arguments)
        return line if output is None else (*line, self.option, output)


WRITERS = {
    "convert": Writer("convert", "glb", [".bendy"], default="in.bendy"),
    "export": Writer("export", "bendy", [".glb", ".gltf", ".x"], default="in.glb"),
    "assemble": Writer("assemble", "json", [".bendy"], default="in.bendy"),
    "edit": Writer("edit", "bendy", [".bendy"], ["--strip", "clips"]),
    "dump": Writer("dump", "bendy", [".json", ".txt"]),
    "rig": Writer("rig", "bendy", [".json"]),
    "pose": Writer("pose", "bendy", [".obj", ".ply", ".json"]),
    "render": Writer("render", "bendy", [".png"], SIZE),
    "inspect": Writer("inspect", "bendy", [".html", ".htm"], option="--html"),
}
# Suffixes with a meaning; and whose command, in the hint, makes such a file.
MEANINGS = {".bendy": "convert", ".glb": "export", ".gltf": "export", ".x": "export", ".obj": "pose", ".ply": "pose",
            ".json": "dump", ".html": "inspect", ".png": "render", ".GLB": "export", ".Bendy": "convert",
            ".fbx": "export", ".FBX": "export", ".vrm": "export", ".usdz": "export", ".blend": "export",
            ".md2": "export", ".dae": "export", ".jpg": "render", ".mp4": "render", ".zip": "export"}


class OutputCase(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.made = {"glb": SOURCE / "examples" / "tentacle.glb"}
        for kind, line in (("bendy", ("convert", cls.made["glb"])), ("json", ("dump", cls.shared / "in.bendy"))):
            cls.made[kind] = cls.shared / f"in.{kind}"
            subprocess.run([BENDY, *line, "-o", cls.made[kind]], check=True, capture_output=True, timeout=120)
        probe = subprocess.run([BENDY, "render", cls.made["bendy"], "-o", cls.shared / "probe.png", *SIZE],
                               capture_output=True, timeout=120, check=False)
        cls.draws = probe.returncode == 0

    def writers(self):
        for name, writer in WRITERS.items():
            if name == "render" and not self.draws:
                continue
            for entry in self.folder.iterdir():
                entry.unlink()
            yield writer

    def source(self, writer, suffix=None):
        """A copy of what the subcommand reads, named in.SUFFIX."""
        path = self.folder / f"in{suffix or '.' + writer.kind}"
        shutil.copy(self.made[writer.kind], path)
        return path

    def is_right(self, writer, path):
        """Whether a file is what the subcommand makes."""
        return path.read_bytes() == self.result(writer, path.suffix)

    def result(self, writer, suffix):
        """What the subcommand writes to a file with that suffix."""
        key = (writer.command, suffix)
        if key not in self.results:
            path = self.shared / f"{writer.command}_result{suffix}"
            self.done_loudly(*writer.line(self.made[writer.kind], path))
            self.results[key] = path.read_bytes()
        return self.results[key]

    results = {}

    def bendy(self, *arguments, **options):
        return super().bendy(*arguments, **options, env=WITHOUT_PICTURES if arguments[0] == "inspect" else None)

    def done_loudly(self, *arguments, **options):
        result = self.bendy(*arguments, **options)
        self.assertEqual(result.returncode, 0, (arguments, result.stderr))
        return result


class InputAsOutput(OutputCase):
    def test_no_output_is_the_input_by_whatever_name(self):
        for writer in self.writers():
            for suffix in writer.suffixes:
                for entry in self.folder.iterdir():
                    entry.unlink()
                source = self.source(writer, suffix)
                before = source.read_bytes()
                hard, soft = (self.folder / f"{kind}{suffix}" for kind in ("hard", "soft"))
                os.link(source, hard)
                soft.symlink_to(source.name)
                for given in (source.name, "soft" + suffix):
                    for output in (source.name, f"./{source.name}", source, hard.name, soft.name):
                        line = self.failed(*writer.line(given, output), file=output)
                        self.assertIn("is an input as well as an output", line)
                self.assertEqual(source.read_bytes(), before)
                self.assertEqual(len(self.files()), 3)

    def test_the_default_output_is_not_the_input(self):
        for writer in self.writers():
            if writer.default:
                source = self.source(writer, Path(writer.default).suffix)
                before = source.read_bytes()
                for force in ((), ("--force",)):
                    self.failed(*writer.line(source.name), *force, file=source.name)
                self.assertEqual((source.read_bytes(), len(self.files())), (before, 1))

    def test_nor_is_it_the_file_that_standard_input_reads(self):
        for writer in self.writers():
            source = self.source(writer, writer.suffixes[0])
            before = source.read_bytes()
            with source.open("rb") as stream:
                self.assertIn("it is standard input", self.failed(*writer.line("-", source.name), stdin=stream))
            self.assertEqual(source.read_bytes(), before)

    def test_standard_output_is_not_the_input(self):
        for writer in self.writers():
            source = self.source(writer)
            before = source.read_bytes()
            with source.open("ab") as stream:
                result = subprocess.run([BENDY, *writer.line(source.name, "-")], cwd=self.folder,
                                        stdout=stream, stderr=subprocess.PIPE, timeout=120, check=False)
            self.assertEqual(result.returncode, 1)
            self.assertIn(b"standard output: is an input as well as an output", result.stderr)
            self.assertEqual(source.read_bytes(), before)

    def model_with_files(self):
        """A glTF file with its numbers and a picture in files beside it; and a rig file."""
        (self.folder / "numbers.bendy").write_bytes(bytes(36))
        (self.folder / "picture.png").write_bytes(PNG)
        (self.folder / "rig.bendy").write_text('{"bendy_rig": 1}')
        (self.folder / "m.gltf").write_text(json.dumps({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
            "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
            "textures": [{"source": 0}], "images": [{"uri": "picture.png"}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": "numbers.bendy"}]}))

    def test_files_that_the_input_refers_to_are_inputs(self):
        self.model_with_files()
        os.link(self.folder / "picture.png", self.folder / "hard.bendy")
        before = {path.name: path.read_bytes() for path in self.folder.iterdir()}
        for output in ("numbers.bendy", "hard.bendy", "rig.bendy"):
            for more in ((), ("--force",)):
                line = self.failed("convert", "m.gltf", "--rig", "rig.bendy", *more, "-o", output, file=output)
                self.assertIn("is an input as well as an output", line)
        os.link(self.folder / "numbers.bendy", self.folder / "numbers.d")
        self.failed("convert", "m.gltf", "-o", "out.bendy", "--depfile", "numbers.d", file="numbers.d")
        (self.folder / "numbers.d").unlink()
        self.assertEqual({path.name: path.read_bytes() for path in self.folder.iterdir()}, before)
        shutil.copy(self.made["bendy"], self.folder / "edited.bendy")
        (self.folder / "names.bendy").write_text("{}")
        self.failed("edit", "edited.bendy", "--rename-joints", "names.bendy", "-o", "names.bendy", file="names.bendy")

    def test_a_picture_does_not_replace_a_texture_that_it_shows(self):
        if not self.draws:
            self.skipTest("nothing draws here")
        self.model_with_files()
        self.done_loudly("convert", "m.gltf", "-q", "--images", "link", "-o", "linked.bendy")
        before = (self.folder / "picture.png").read_bytes()
        line = self.failed("render", "linked.bendy", *SIZE, "-o", "picture.png", file="picture.png")
        self.assertIn("is an input as well as an output", line)
        self.assertEqual((self.folder / "picture.png").read_bytes(), before)

    def test_a_file_is_edited_in_place_where_that_is_said(self):
        source = self.source(WRITERS["edit"])
        before = source.read_bytes()
        self.failed("edit", source.name, "--strip", "clips", "-o", source.name, file=source.name)
        self.assertEqual(source.read_bytes(), before)
        self.done("edit", source.name, "--strip", "clips", "--in-place")
        self.assertTrue(self.is_right(WRITERS["edit"], source))
        self.assertIn("--in-place", self.misused("edit", source.name, "--strip", "clips"))
        self.assertIn("--in-place", self.misused("edit", source.name, "--strip", "clips", "-i", "-o", "out.bendy"))
        self.assertIn("--in-place", self.misused("edit", "-", "--strip", "clips", "-i"))


class TwoOutputs(OutputCase):
    def test_two_outputs_are_two_files(self):
        source = self.source(WRITERS["convert"])
        (self.folder / "there").write_bytes(b"old")
        (self.folder / "link").symlink_to("there")
        (self.folder / "ahead").symlink_to("new")
        for output, depfile in (("new", "new"), ("new", "./new"), ("there", "link"), ("new", "ahead"), ("ahead", "new")):
            self.assertIn("written twice", self.failed("convert", source.name, "-o", output, "--depfile", depfile))
        self.assertEqual(self.files(), ["ahead", "in.glb", "link", "there"])
        self.assertEqual((self.folder / "there").read_bytes(), b"old")
        self.done("convert", source.name, "-q", "-o", os.devnull, "--depfile", os.devnull)  # nothing is lost there

    def test_one_of_them_may_take_standard_output(self):
        source = self.source(WRITERS["convert"])
        rule = self.done("convert", "-q", source.name, "-o", "out.bendy", "--depfile", "-")
        self.assertEqual(rule, b"out.bendy: \\\n  in.glb\n")
        self.assertIn("--depfile", self.misused("convert", source.name, "-o", "-", "--depfile", "out.d"))


class Foreign(OutputCase):
    def test_an_output_that_is_named_replaces_what_is_there(self):
        for writer in self.writers():
            source = self.source(writer)
            for suffix in writer.suffixes:
                if (writer.command, suffix) in {("export", ".gltf"), ("export", ".x")}:
                    continue  # files beside them: below
                output = self.folder / f"out{suffix}"
                output.write_bytes(FOREIGN)
                self.done_loudly(*writer.line(source.name, output.name))
                self.assertNotEqual(output.read_bytes(), FOREIGN)

    def test_a_default_output_replaces_only_what_bendy_wrote(self):
        for writer in self.writers():
            if not writer.default:
                continue
            source = self.source(writer)
            output = self.folder / writer.default
            kind = writer.suffixes[0]
            ours = self.result(writer, kind)
            foreign = [FOREIGN, b"", b"HEAD", b"glTF", b"xof 0303txt 0032\n// bendy\n", b"{}", ours[:70]]
            if kind == ".bendy":
                foreign.append(ours[:80] + b"Bendy's rival 2.0".ljust(32, b"\0") + ours[112:])
                foreign.append(ours[:80] + b"bendy rival 2.0".ljust(32, b"\0") + ours[112:])
                foreign.append(ours[:80] + bytes(32) + ours[112:])
            else:
                foreign.append(self.made["glb"].read_bytes())  # Blender's
            for content in foreign:
                output.write_bytes(content)
                line = self.failed(*writer.line(source.name), file=output.name)
                self.assertIn("bendy did not write it: --force", line)
                self.assertEqual(output.read_bytes(), content)
                self.done_loudly(*writer.line(source.name), "--force")
                self.assertEqual(output.read_bytes(), ours)
            self.done_loudly(*writer.line(source.name))  # over its own
            self.assertEqual(output.read_bytes(), ours)
            target = self.folder / "elsewhere"
            target.write_bytes(FOREIGN)
            output.unlink()
            output.symlink_to(target)
            self.failed(*writer.line(source.name), file=output.name)
            self.assertEqual(target.read_bytes(), FOREIGN)

    def test_the_source_of_an_export_stays(self):
        shutil.copy(self.made["glb"], self.folder / "fox.glb")
        before = (self.folder / "fox.glb").read_bytes()
        self.done("convert", "fox.glb", "-q")
        self.failed("export", "fox.bendy", file="fox.glb")
        self.assertEqual((self.folder / "fox.glb").read_bytes(), before)

    def test_an_exported_file_says_who_wrote_it_and_converts_to_the_same_bytes(self):
        data = self.made["glb"].read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        document = json.loads(data[20 : 20 + length])
        assets = [{"version": "2.0", "generator": name} for name in
                  ("maker 1 (beta)", "bendy 0.1 (old)", "bendies 0.1", "bendy tools", "(source: x)", "", "ü")]
        assets += [{"version": "2.0"}, {"version": "2.0", "copyright": "me"},
                   {"copyright": "me", "generator": "maker", "version": "2.0"}]
        for asset in assets:
            document["asset"] = asset
            text = json.dumps(document).encode()
            text += b" " * (-len(text) % 4)
            rest = data[20 + length :]
            (self.folder / "a.glb").write_bytes(
                struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest)
            self.done("convert", "-q", "a.glb", "-o", "a.bendy")
            self.done("export", "-q", "a.bendy", "-o", "b.glb")
            exported = (self.folder / "b.glb").read_bytes()
            shown = json.loads(exported[20 : 20 + struct.unpack_from("<I", exported, 12)[0]])["asset"]
            self.assertRegex(shown["generator"], r"^bendy \d+\.\d+\.\d+ \(source")
            source = asset.get("generator", "unnamed")
            self.assertIn(source, shown["generator"])
            self.done("convert", "-q", "b.glb", "-o", "c.bendy")
            self.assertEqual((self.folder / "c.bendy").read_bytes(), (self.folder / "a.bendy").read_bytes(), asset)

    def test_however_often_and_by_whatever_version_it_names_itself_once(self):
        version = self.bendy("--version").stdout.decode().split()[-1]
        file = GltfFile(nodes=[{"name": "a"}], scenes=[{"nodes": [0]}])
        for generator, wanted in (("maker", " (source: maker)"), ("bendy 0.2.0 (source: bendy 0.1.0 (source: maker (x)))", " (source: maker (x))"),
                                  ("bendy 9.1-rc.2 (source unnamed)", " (source unnamed)"), ("bendy 0.1.0", ""),
                                  ("bendy 0.2 (source: bendy 0.1 (source unnamed))", " (source unnamed)"),
                                  ("bendy 0.2 (source: bendy 0.1)", ""), (None, " (source unnamed)")):
            file.document["asset"] = {"version": "2.0", **({"generator": generator} if generator else {})}
            file.write(self.folder / "0.gltf")
            for turn in range(4):
                self.done("convert", "-q", f"{turn}.gltf", "-o", f"{turn}.bendy")
                self.done("export", "-q", f"{turn}.bendy", "-o", f"{turn + 1}.gltf")
                asset = json.loads((self.folder / f"{turn + 1}.gltf").read_text())["asset"]
                self.assertEqual(asset, {"version": "2.0", "generator": f"bendy {version}{wanted}"}, (generator, turn))
            self.assertEqual((self.folder / "0.bendy").read_bytes(), (self.folder / "3.bendy").read_bytes())

    def refused(self, file, *arguments):
        """The error about a file, behind warnings."""
        result = self.bendy(*arguments)
        self.assertEqual((result.returncode, result.stdout), (1, b""))
        line = result.stderr.decode().splitlines()[-1]
        self.assertTrue(line.startswith(f"bendy: error: {file}: "), line)
        return line

    def test_what_goes_beside_an_export_replaces_only_its_own(self):
        shutil.copy(self.made["bendy"], self.folder / "a.bendy")
        mannequin = self.convert()
        for output, beside, source in (("o p.gltf", "o p.bin", "a.bendy"), ("o.x", "o_0.png", mannequin)):
            (self.folder / beside).write_bytes(FOREIGN)
            self.assertIn("bendy did not write it", self.refused(beside, "export", source, "-o", output))
            self.assertFalse((self.folder / output).exists())
            self.assertEqual((self.folder / beside).read_bytes(), FOREIGN)
            self.done_loudly("export", source, "-o", output, "--force")
            self.assertNotEqual((self.folder / beside).read_bytes(), FOREIGN)
            self.done_loudly("export", source, "-o", output)  # of the file that bendy wrote
            text = (self.folder / output).read_text()
            other = text.replace(beside.replace(" ", "%20"), "other" + Path(beside).suffix)
            self.assertNotEqual(other, text)
            for content in (other, text.replace("bendy", "maker")):
                (self.folder / output).write_text(content)
                self.refused(beside, "export", source, "-o", output)
                self.assertEqual((self.folder / output).read_text(), content)

    def test_nothing_beside_an_export_is_the_input(self):
        for output, beside in (("o.gltf", "o.bin"), ("o.x", "o_0.png")):
            shutil.copy(self.convert(), self.folder / beside)
            before = (self.folder / beside).read_bytes()
            for force in ((), ("--force",)):
                self.refused(beside, "export", beside, "-o", output, *force)
            self.assertEqual((self.folder / beside).read_bytes(), before)
            self.assertFalse((self.folder / output).exists())

    def test_batches_replace_only_what_bendy_wrote(self):
        (self.folder / "in").mkdir()
        for name in "ab":
            shutil.copy(self.made["glb"], self.folder / "in" / f"{name}.glb")
        (self.folder / "out").mkdir()
        foreign = self.folder / "out" / "a.bendy"
        foreign.write_bytes(FOREIGN)
        result = self.bendy("convert", "in", "-o", "out")
        self.assertEqual(result.returncode, 1)
        self.assertIn(b"out/a.bendy: is there, and bendy did not write it: --force replaces it", result.stderr)
        self.assertEqual(foreign.read_bytes(), FOREIGN)
        good = (self.folder / "out" / "b.bendy").read_bytes()
        self.done("convert", "in", "-o", "out", "--force")
        self.assertEqual(foreign.read_bytes(), good)
        (self.folder / "out" / ".bendy_batch.json").unlink()  # now only the file itself says whose it is
        self.done("convert", "in", "-o", "out")
        self.assertEqual(foreign.read_bytes(), good)

    def test_batches_keep_their_inputs(self):
        (self.folder / "out").mkdir()
        shutil.copy(self.made["glb"], self.folder / "a.glb")
        shutil.copy(self.made["glb"], self.folder / "b.glb")
        os.link(self.folder / "b.glb", self.folder / "out" / "a.bendy")
        (self.folder / "rig.json").write_text('{"bendy_rig": 1}')
        os.link(self.folder / "rig.json", self.folder / "out" / ".bendy_batch.json")
        before = (self.folder / "b.glb").read_bytes()
        for force in ((), ("--force",)):
            result = self.bendy("convert", "a.glb", "b.glb", "--rig", "rig.json", "-o", "out", *force)
            self.assertEqual(result.returncode, 1)
            for name in ("a.bendy", ".bendy_batch.json"):
                self.assertIn(f"out/{name}: is an input as well as an output".encode(), result.stderr)
        self.assertEqual((self.folder / "b.glb").read_bytes(), before)
        self.assertEqual((self.folder / "rig.json").read_text(), '{"bendy_rig": 1}')


class StandardStreams(OutputCase):
    def test_a_dash_as_input_gives_what_the_file_gives(self):
        for writer in self.writers():
            data = self.made[writer.kind].read_bytes()
            suffix = writer.suffixes[0]
            self.done_loudly(*writer.line("-", "out" + suffix), input=data)
            if writer.command != "inspect":  # whose page is named for the input
                self.assertEqual((self.folder / ("out" + suffix)).read_bytes(), self.nameless(writer), writer.command)

    def test_a_dash_as_output_gives_what_the_file_has(self):
        for writer in self.writers():
            source = self.made[writer.kind]
            result = self.done_loudly(*writer.line(source, "-"))
            self.assertEqual(result.stdout, self.result(writer, writer.suffixes[0]), writer.command)
            for line in result.stderr.decode().splitlines():
                self.assertNotIn("error", line)
            self.assertEqual(self.files(), [])
            # What is piped in without a name for the output is piped on.
            if writer.default or writer.command in ("dump", "rig", "pose"):
                piped = self.done_loudly(*writer.line("-"), input=source.read_bytes())
                self.assertEqual(piped.stdout, self.nameless(writer))

    def nameless(self, writer):
        """What the subcommand makes of standard input: the name of the file stands in what `pose` writes."""
        result = self.result(writer, writer.suffixes[0])
        return result.replace(b"in.bendy", b"-") if writer.command == "pose" else result

    def test_summaries_then_go_to_standard_error(self):
        for command, words in (("convert", b"standard output: "), ("export", b"standard output: "),
                               ("edit", b"standard output: "), ("inspect", b"standard output: ")):
            writer = WRITERS[command]
            self.assertIn(words, self.done_loudly(*writer.line(self.made[writer.kind], "-")).stderr)
        result = self.done_loudly("convert", self.made["glb"], "--compact", "-o", "-")
        self.assertIn(b"error          at most", result.stderr)
        self.assertTrue(result.stdout.startswith(b"HEAD"))
        self.assertNotIn(b"standard output", self.done_loudly("convert", self.made["glb"], "-q", "-o", "-").stderr)

    def test_commands_that_only_read_take_a_dash(self):
        data = self.made["bendy"].read_bytes()
        name = str(self.made["bendy"])
        for line in (("inspect",), ("inspect", "--json"), ("inspect", "--all"), ("validate",), ("validate", "--json")):
            piped = self.done(*line, "-", input=data).decode().replace('"-"', json.dumps(name))
            named = self.done(*line, name).decode()
            self.assertEqual(piped.replace("standard input: ", "in.bendy: "), named)
        self.assertIn(b"open, sums checked", self.done("bench", "-", "--rounds", "1", input=data))
        self.assertEqual(self.done("diff", "-", name, input=data), b"")
        self.assertEqual(self.done("diff", name, "-", "--tolerance", "1mm", input=data),
                         self.done("diff", name, name, "--tolerance", "1mm"))
        self.assertIn(b"standard input: NOT_A_BENDY_FILE", self.bendy("validate", "-", input=b"x" * 64).stdout)

    def test_a_pipeline(self):
        line = ('cat "$1" | "$0" convert - -o - | "$0" edit - --strip textures -o - | "$0" dump - | "$0" assemble - '
                '| "$0" export - | "$0" convert - -q --compact -o - | "$0" validate - && echo good')
        result = subprocess.run(["sh", "-c", line, BENDY, self.made["glb"]], capture_output=True, timeout=120,
                                check=False, cwd=self.folder)
        self.assertEqual((result.stdout, self.files()), (b"good\n", []), result.stderr)
        line = '"$0" rig "$2" | "$0" convert "$1" --rig - -o - -q | cmp - "$2"'
        result = subprocess.run(["sh", "-c", line, BENDY, self.made["glb"], self.made["bendy"]],
                                capture_output=True, timeout=120, check=False, cwd=self.folder)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, b"", b""))
        rig = self.failed("convert", self.made["glb"], "--rig", "-", "-o", "x.bendy", input=b"{]")
        self.assertTrue(rig.startswith("bendy: error: standard input: "), rig)

    def test_every_kind_of_source_comes_by_pipe(self):
        md2_file(self.folder / "m.md2")
        self.done("export", "-q", self.made["bendy"], "-o", "m.x")
        for name in ("m.md2", "m.x"):
            data = (self.folder / name).read_bytes()
            shutil.copy(self.folder / name, self.folder / ("standard input" + Path(name).suffix))  # MD2 has no names
            self.done("convert", "-q", "standard input" + Path(name).suffix, "-o", "named.bendy")
            self.done("convert", "-q", "-", "--root", ".", "-o", "piped.bendy", input=data)
            self.assertEqual((self.folder / "piped.bendy").read_bytes(), (self.folder / "named.bendy").read_bytes())
        self.done("edit", self.made["bendy"], "--merge", "-", "--same-name", "number", "-o", "merged.bendy",
                  input=self.made["glb"].read_bytes())
        self.assertIn(b"standard input: ", self.bendy("convert", "-", "-o", "x", input=b"{").stderr)

    def test_what_piped_gltf_refers_to_is_in_the_root(self):
        (self.folder / "sub").mkdir()
        self.done("export", "-q", self.made["bendy"], "-o", "sub/m.gltf")
        text = (self.folder / "sub" / "m.gltf").read_bytes()
        self.assertIn("the source has no folder in which to look for 'm.bin': --root FOLDER gives it one",
                      self.failed("convert", "-", "-o", "new.bendy", input=text))
        self.done("convert", "-q", "-", "-o", "out.bendy", "--root", "sub", input=text)
        self.assertEqual((self.folder / "out.bendy").read_bytes(), self.made["bendy"].read_bytes())
        self.assertIn(b"\nv ", self.done("pose", "-", "--root", "sub", input=text))
        (self.folder / "sub" / "m.bin").unlink()
        self.assertIn("m.bin", self.failed("convert", "-", "-o", "new.bendy", "--root", "sub", input=text))

    def test_formats_where_no_name_says_them(self):
        for command, formats in (("pose", ("obj", "ply", "json")), ("render", ("png", "gif", "webp"))):
            writer = WRITERS[command]
            if command == "render" and not self.draws:
                continue
            for form in formats:
                more = ("--clip", "0", "--frames", "2") if form in ("gif", "webp") else ()
                named = self.folder / f"named.{form}"
                self.done_loudly(*writer.line(self.made["bendy"], named), *more)
                piped = self.done_loudly(*writer.line(self.made["bendy"], "-"), *more, "--format", form)
                self.assertEqual(piped.stdout, named.read_bytes())
                self.done_loudly(*writer.line(self.made["bendy"], "odd"), *more, "--format", form)
                self.assertEqual((self.folder / "odd").read_bytes(), named.read_bytes())
                other = formats[formats.index(form) - 1]
                self.assertIn("--format", self.misused(*writer.line(self.made["bendy"], f"x.{other}"), "--format", form))
        self.assertIn("--format", self.misused("export", self.made["bendy"], "--format", "glb", "-o", "x.gltf"))

    def test_two_files_do_not_go_to_standard_output(self):
        for form in ("gltf", "x"):
            self.assertIn("only glb goes to standard output",
                          self.misused("export", self.made["bendy"], "--format", form, "-o", "-"))
        self.assertIn("folder", self.misused("convert", self.made["glb"], self.made["bendy"], "-o", "-"))
        self.assertIn("standard input", self.misused("convert", "-", self.made["glb"], "-o", "out/"))
        self.assertIn("--json", self.misused("convert", self.made["glb"], "--json", "-o", "-"))

    def test_standard_input_is_read_once(self):
        data = self.made["bendy"].read_bytes()
        self.assertIn(b"only once", self.bendy("diff", "-", "-", input=data).stderr)
        self.assertIn("only once", self.failed("convert", "-", "--rig", "-", "-o", "x", input=data))
        self.assertIn("only once", self.failed("edit", "-", "--merge", "-", "-o", "x", input=data))

    def test_a_file_may_be_called_a_dash(self):
        shutil.copy(self.made["bendy"], self.folder / "-")
        self.assertEqual(self.done("validate", "./-"), b"")
        self.done("convert", "-q", "./-", "-o", "./--")
        self.assertEqual(self.files(), ["-", "--"])

    def test_an_empty_pipe_is_bad_input(self):
        for writer in self.writers():
            line = self.failed(*writer.line("-", "out" + writer.suffixes[0]), input=b"")
            self.assertIn("standard input", line)
            self.assertEqual(self.files(), ["out.html"] if writer.command == "inspect" else [])

    @unittest.skipUnless(os.path.exists("/dev/zero"), "there is no /dev/zero")
    def test_a_pipe_without_an_end_is_refused(self):
        with open("/dev/zero", "rb") as stream:
            line = self.failed("inspect", "-", stdin=stream)
        self.assertRegex(line, "standard input: the file cannot be read: File too large")

    def test_a_closed_standard_input_is_bad_input(self):
        line = self.failed("inspect", "-", preexec_fn=lambda: os.close(0))
        self.assertIn("standard input", line)

    def test_a_terminal_takes_no_binary(self):
        for writer in self.writers():
            ours, theirs = pty.openpty()
            result = subprocess.run([BENDY, *writer.line(self.made[writer.kind], "-")], cwd=self.folder,
                                    stdout=theirs, stderr=subprocess.PIPE, timeout=120, check=False) \
                if writer.command in ("convert", "export", "assemble", "edit", "render") else None
            os.close(theirs)
            os.close(ours)
            if result:
                self.assertEqual(result.returncode, 1, writer.command)
                self.assertIn(b"standard output: is a terminal", result.stderr)


class Suffixes(OutputCase):
    def run_hint(self, text):
        """Runs the commands that an error names."""
        commands = text.split("\n")[0].rsplit(": ", 1)[1]
        self.assertTrue(commands.startswith("bendy "), text)
        line = commands.replace("bendy edit in.bendy ...", "bendy edit in.bendy --strip clips")
        script = " && ".join('"$0"' + part[len("bendy"):] for part in line.split(" && "))
        result = subprocess.run(["sh", "-c", script, BENDY], cwd=self.folder, capture_output=True, timeout=120,
                                check=False, env=WITHOUT_PICTURES if "bendy inspect" in line else None)
        self.assertEqual(result.returncode, 0, (commands, result.stderr))
        return commands

    def test_a_suffix_of_another_format_is_refused_with_the_commands(self):
        for writer in self.writers():
            source = self.source(writer)
            for suffix, who in MEANINGS.items():
                if suffix.lower() in writer.suffixes or (writer.command == "render" and suffix == ".jpg"):
                    continue
                text = self.misused(*writer.line(source.name, "out" + suffix))
                self.assertIn("out" + suffix + " would be ", text)
                self.assertEqual(self.files(), [source.name], text)
                self.assertIn(f"bendy {who} ", text)

    def test_the_commands_do_it(self):
        for writer in self.writers():
            for suffix in (".glb", ".obj", ".json", ".html", ".fbx"):
                if suffix in writer.suffixes:
                    continue
                for entry in self.folder.iterdir():
                    entry.unlink()
                source = self.source(writer)
                self.run_hint(self.misused(*writer.line(source.name, "out" + suffix)))
                made = self.folder / f"out{'.glb' if suffix == '.fbx' else suffix}"
                start = {".glb": b"glTF", ".obj": b"#", ".json": b"{", ".html": b"<!", ".fbx": b"glTF"}[suffix]
                self.assertTrue(made.read_bytes().startswith(start), (writer.command, suffix))

    def test_the_name_is_quoted(self):
        shutil.copy(self.made["glb"], self.folder / "a fox's.glb")
        self.run_hint(self.misused("convert", "a fox's.glb", "-o", "my fox.gltf"))
        self.assertIn("my fox.gltf", self.files())

    def test_suffixes_in_capitals_are_those_in_small_letters(self):
        for writer in self.writers():
            for suffix in writer.suffixes:
                self.done_loudly(*writer.line(self.made[writer.kind], "out" + suffix.upper()))
                self.assertEqual((self.folder / f"out{suffix.upper()}").read_bytes()[:8], self.result(writer, suffix)[:8])

    def test_a_suffix_without_a_meaning(self):
        for command in ("convert", "assemble", "edit", "dump", "rig", "inspect"):
            writer = WRITERS[command]
            for name in ("out.character", "out", "out.v2"):
                self.done_loudly(*writer.line(self.made[writer.kind], name))
        for command in ("pose", "render"):
            self.assertIn("must end in", self.misused(*WRITERS[command].line(self.made["bendy"], "out.character")))
        self.assertIn("must end in .glb, .gltf or .x", self.misused("export", self.made["bendy"], "-o", "x.character"))
        self.done("export", "-q", self.made["bendy"], "-o", "plain")
        self.assertTrue((self.folder / "plain").read_bytes().startswith(b"glTF"))
        self.done("export", "-q", self.made["bendy"], "--format", "x", "-o", "x.character")

    def test_other_outputs_of_convert(self):
        source = self.source(WRITERS["convert"]).name
        self.assertIn("rule for Make", self.misused("convert", source, "-o", "a.bendy", "--depfile", "a.glb"))
        self.assertIn("all.bendy/ is a folder", self.misused("convert", source, self.made["bendy"], "-o", "all.bendy"))
        self.assertEqual(self.files(), ["in.glb"])
        self.done("convert", source, "-o", "all.bendy/")
        self.assertEqual(sorted(os.listdir(self.folder / "all.bendy")), [".bendy_batch.json", "in.bendy"])


class Assemble(OutputCase):
    def test_an_invalid_file_is_not_written(self):
        text = self.made["json"].read_text()
        number = re.search(r'"joints": (\d+)', text)
        (self.folder / "a.json").write_text(text.replace(number.group(), f'"joints": {int(number.group(1)) + 1}', 1))
        (self.folder / "a.bendy").write_bytes(self.made["bendy"].read_bytes())
        for output in (("-o", "out.bendy"), ("-o", "-"), ()):
            result = self.bendy("assemble", "a.json", *output)
            self.assertEqual((result.returncode, result.stdout), (1, b""))
            lines = result.stderr.decode().splitlines()
            self.assertRegex(lines[0], r"^a\.json: [A-Z_]+: .*HEAD/VERS, offset \d+")
            self.assertIn("--allow-invalid", lines[-1])
        self.assertEqual(self.files(), ["a.bendy", "a.json"])
        self.assertEqual((self.folder / "a.bendy").read_bytes(), self.made["bendy"].read_bytes())
        self.assertIn(b"has faults", self.done_loudly("assemble", "a.json", "--allow-invalid").stderr)
        told = self.bendy("validate", "a.bendy")
        self.assertEqual(told.returncode, 1)
        self.assertEqual([line.split(": ", 1)[1] for line in told.stdout.decode().splitlines()],
                         [line.split(": ", 1)[1] for line in lines[:-1]])


class Modes(Case):
    def test_a_file_that_is_replaced_keeps_its_mode(self):
        self.addCleanup(os.umask, os.umask(0o022))
        shutil.copy(self.convert("tentacle"), self.folder / "in.bendy")
        for mode in (0o600, 0o640, 0o444, 0o4755, 0o666):
            for name, line in (("in.bendy", ("edit", "in.bendy", "-i", "--rename-joint", "*=*", "-q")),
                               ("out.json", ("dump", "in.bendy", "-o", "out.json")),
                               ("out.gltf", ("export", "in.bendy", "-q", "-o", "out.gltf")),
                               ("out.bin", ("export", "in.bendy", "-q", "-o", "out.gltf")),
                               ("out.bendy", ("convert", "in.bendy", "-q", "-o", "out.bendy"))):
                with self.subTest(mode=oct(mode), command=line[0]):
                    self.done(*line)
                    (self.folder / name).chmod(mode)
                    self.done(*line)
                    self.assertEqual(oct((self.folder / name).stat().st_mode & 0o7777), oct(mode))
        self.done("dump", "in.bendy", "-o", "new.json")
        self.assertEqual((self.folder / "new.json").stat().st_mode & 0o7777, 0o644)

    def test_a_link_leads_to_the_same_file_with_the_same_mode(self):
        (self.folder / "there").mkdir()
        shutil.copy(self.convert("tentacle"), self.folder / "there" / "a.bendy")
        (self.folder / "there" / "a.bendy").chmod(0o600)
        (self.folder / "a.bendy").symlink_to("there/a.bendy")
        self.done("edit", "a.bendy", "-i", "--strip", "clips", "-q")
        self.assertTrue((self.folder / "a.bendy").is_symlink())
        self.assertEqual((self.folder / "there" / "a.bendy").stat().st_mode & 0o7777, 0o600)
        self.assertEqual([entry.name for entry in (self.folder / "there").iterdir()], ["a.bendy"])

    @unittest.skipUnless(hasattr(os, "geteuid") and os.geteuid() == 0, "only root gives files away")
    def test_a_file_that_is_replaced_keeps_its_owner(self):
        shutil.copy(self.convert("tentacle"), self.folder / "in.bendy")
        os.chown(self.folder / "in.bendy", 1234, 5678)
        (self.folder / "in.bendy").chmod(0o640)
        self.done("edit", "in.bendy", "-i", "--strip", "clips", "-q")
        status = (self.folder / "in.bendy").stat()
        self.assertEqual((status.st_uid, status.st_gid, status.st_mode & 0o7777), (1234, 5678, 0o640))


if __name__ == "__main__":
    main()
