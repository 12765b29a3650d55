#!/usr/bin/env python3
"""`bendy dump` and `bendy assemble` as a user runs them; spec/text.schema.json checks the texts.

    text_form_test.py --bendy PROGRAM --source SOURCE_DIR [--corpus FOLDER] [unittest's own arguments]
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

from jsonschema import Draft202012Validator

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from chunk_file import Chunk  # noqa: E402
from gltf_file import strange_file  # noqa: E402
from program import REST, SOURCE, Case, main  # noqa: E402

CORPUS = None


class TwinCase(Case):
    def converted(self, name, *options):
        """An example, converted; once for each class."""
        path = self.shared / "-".join([name, *options, ".bendy"]).replace("/", "")
        if not path.exists():
            source = strange_file(self.shared / "strange.gltf") if name == "strange" else SOURCE / "examples" / f"{name}.glb"
            self.done("convert", source, "-o", path, *options)
        return path

    def text_form(self, path, *options):
        """The text of a file as `dump` writes it."""
        text = self.folder / "text_form.bendy.json"
        self.done("dump", path, "-o", text, *options)
        return text

    def assembled(self, text):
        out = self.folder / "out.bendy"
        self.done("assemble", text, "-o", out)
        return out

    def expect_round_trip(self, path):
        self.assertEqual(self.assembled(self.text_form(path)).read_bytes(), Path(path).read_bytes(), path)


def all_chunks(chunks):
    for chunk in chunks:
        yield chunk
        for value in chunk.values():
            if isinstance(value, list) and value and isinstance(value[0], dict):
                yield from all_chunks(value)


class TextForm(TwinCase):
    def small_files(self):
        examples = sorted((SOURCE / "spec" / "examples").glob("*.bendy"))
        self.assertGreater(len(examples), 2)
        return [*examples, self.converted("strange"), self.converted("tentacle", "--compact", "--lod")]

    def files(self):
        return [*self.small_files(), *(self.converted(*arguments) for arguments in (
            ("tentacle",), ("mannequin",), ("mannequin", "--compact"), ("mannequin", "--lod")))]

    def test_converted_files_come_back_byte_for_byte(self):
        for path in self.files():
            self.expect_round_trip(path)

    def test_texts_fit_the_schema(self):
        schema = Draft202012Validator(json.loads((SOURCE / "spec" / "text.schema.json").read_text()))
        schema.check_schema(schema.schema)
        subprocess.run([sys.executable, SOURCE / "tests" / "conformance" / "unpack.py", self.folder / "conformance"],
                       stdout=subprocess.DEVNULL, check=True)
        conformance = sorted((self.folder / "conformance").rglob("*.bendy"))[::40]
        self.assertGreater(len(conformance), 30)
        checked = 0
        for path in [*self.small_files(), *conformance]:
            result = self.bendy("dump", path)
            if result.returncode != 0 and path in conformance:
                continue  # no file that can be walked
            text = json.loads(result.stdout)
            self.assertTrue(schema.is_valid(text), path)
            checked += 1
        self.assertGreaterEqual(checked, 6)
        text = json.loads(self.done("dump", SOURCE / "spec" / "examples" / "every_chunk.bendy"))
        for spoil in (lambda t: t.pop("bendy_text"), lambda t: t["HEAD"][0]["VERS"].pop("major"),
                      lambda t: t["HEAD"][0]["VERS"].update(major=65536), lambda t: t["HEAD"].append({"lower": []}),
                      lambda t: t["HEAD"][1]["BNDS"].update(height="tall"), lambda t: t["HEAD"].append({"XTRA": {"hex": "0"}}),
                      lambda t: t["HEAD"].append({"NAME": "a", "codec": 1})):
            spoilt = json.loads(json.dumps(text))
            spoil(spoilt)
            self.assertFalse(schema.is_valid(spoilt))

    def test_the_schema_is_the_tables(self):
        result = subprocess.run([sys.executable, SOURCE / "spec" / "make_text_schema.py", "--check"], capture_output=True, check=False)
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_the_page_shows_what_dump_writes(self):
        page = (SOURCE / "spec" / "text.md").read_text()
        example = page.partition("```json\n")[2].partition("```")[0]
        self.assertEqual(example, self.done("dump", SOURCE / "spec" / "examples" / "one_joint.bendy").decode())

    def test_the_text_says_what_the_bytes_say(self):
        path = SOURCE / "spec" / "examples" / "every_chunk.bendy"
        root = Chunk.read(path.read_bytes())
        text = json.loads(self.text_form(path).read_text())
        names = [chunk["NAME"].encode() for chunk in all_chunks(text["HEAD"]) if "NAME" in chunk]
        self.assertEqual(names, [chunk.payload for _, chunk in root.walk() if chunk.letters == "NAME"])
        here = [next(key for key in chunk if len(key) == 4) for chunk in all_chunks(text["HEAD"])]
        self.assertEqual(here, [chunk.letters for _, chunk in root.walk()][1:])

    def test_a_limit_and_a_name_are_edited_in_a_compact_file_too(self):
        for options in ((), ("--compact",)):
            path = self.converted("mannequin", *options)
            text = self.text_form(path)
            before = json.loads(text.read_text())
            changed = text.read_text()
            old = next(chunk["LIMT"] for chunk in all_chunks(before["HEAD"]) if "LIMT" in chunk)
            line = f'"rotation_max": [{", ".join(json.dumps(n) for n in old["rotation_max"])}]'
            self.assertTrue(line in changed)
            changed = changed.replace(line, '"rotation_max": [0.125, 0.25, 0.5]', 1)
            self.assertTrue('"mixamorig:Hips"' in changed)
            changed = changed.replace('"mixamorig:Hips"', '"Hüften, zum Beispiel"', 1)
            text.write_text(changed, encoding="utf-8")
            out = self.assembled(text)
            self.assertEqual(self.bendy("validate", out).returncode, 0)
            after = self.text_form(out).read_text(encoding="utf-8")
            self.assertTrue('"rotation_max": [0.125, 0.25, 0.5]' in after)
            self.assertTrue('"Hüften, zum Beispiel"' in after)

    def test_decoded_text_is_shorter_and_means_the_same(self):
        path = self.converted("mannequin", "--compact")
        whole = self.text_form(path).stat().st_size
        text = self.text_form(path, "--decode")
        self.assertLess(text.stat().st_size, whole)
        self.assertFalse('"codec"' in text.read_text())
        out = self.assembled(text)
        self.assertGreater(out.stat().st_size, path.stat().st_size)
        self.done("diff", path, out, "--tolerance", "0.001mm")

    def test_standard_output_and_default_names(self):
        path = self.converted("tentacle")
        copy = self.folder / "copy.bendy"
        copy.write_bytes(path.read_bytes())
        text = self.done("dump", "copy.bendy")
        for name, made in (("a.bendy.json", "a.bendy"), ("b.json", "b.bendy"), ("c.text", "c.text.bendy")):
            (self.folder / name).write_bytes(text)
            self.done("assemble", name)
            self.assertEqual((self.folder / made).read_bytes(), path.read_bytes())
        (self.folder / "d.bendy").write_bytes(text)
        self.assertIn("is an input as well as an output", self.failed("assemble", "d.bendy"))
        self.assertEqual((self.folder / "d.bendy").read_bytes(), text)

    def test_faults_name_line_and_column(self):
        text = self.text_form(SOURCE / "spec" / "examples" / "one_joint.bendy")
        lines = text.read_text().splitlines(keepends=True)
        number = next(n for n, line in enumerate(lines) if '"major"' in line)
        lines[number] = lines[number].replace("0", "-5")
        text.write_text("".join(lines))
        column = lines[number].index("-5") + 1
        out = self.folder / "out.bendy"
        out.write_bytes(b"old")
        self.assertEqual(self.failed("assemble", text, "-o", out),
                         f'bendy: error: {text}:{number + 1}:{column}: "major": the number is out of the range of u16')
        self.assertEqual(out.read_bytes(), b"old")

    def test_what_assembles_and_is_not_valid_is_warned_of_where_it_is_wanted(self):
        text = self.text_form(SOURCE / "spec" / "examples" / "smallest.bendy")
        text.write_text(text.read_text().replace('"objects": 0', '"objects": 1'))
        result = self.bendy("assemble", text, "-o", "out.bendy", "--allow-invalid")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"bendy: warning: out.bendy: the file has faults", result.stderr)

    def test_wrong_sums_are_refused_unless_asked_for(self):
        data = bytearray((SOURCE / "spec" / "examples" / "smallest.bendy").read_bytes())
        data[20] ^= 1  # of VERS
        path = self.folder / "damaged.bendy"
        path.write_bytes(data)
        self.assertIn("--ignore-sums", self.failed("dump", path))
        text = self.folder / "text_form.json"
        self.done("dump", path, "--ignore-sums", "-o", text)
        self.assertEqual(self.assembled(text).read_bytes(), (SOURCE / "spec" / "examples" / "smallest.bendy").read_bytes())

    def test_malformed_files_are_refused(self):
        data = (SOURCE / "spec" / "examples" / "smallest.bendy").read_bytes()
        path = self.folder / "short.bendy"
        path.write_bytes(data[:-16])
        self.assertIn("short.bendy", self.failed("dump", path, "-o", "text_form.json"))
        self.assertFalse((self.folder / "text_form.json").exists())


class Corpus(TwinCase):
    def test_every_file_that_converts_comes_back(self):
        manifest = json.loads((CORPUS / "visible" / "manifest.json").read_text())
        tried = 0
        for number, entry in enumerate(manifest["files"]):
            path = CORPUS / "visible" / entry["file"]
            if not path.is_file() or path.stat().st_size > 300_000:
                continue
            out = self.folder / "converted.bendy"
            options = ["--compact"] if number % 2 else []
            if self.bendy("convert", path, "-o", out, *options).returncode == 0:
                self.expect_round_trip(out)
                tried += 1
        self.assertGreater(tried, 20)
        print(f"{tried} files came back byte for byte")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--corpus", type=Path)
    options, rest = parser.parse_known_args(REST)
    CORPUS = options.corpus
    main(rest or ["TextForm"])
