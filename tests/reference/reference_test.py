#!/usr/bin/env python3
"""docs/cli.md, the man pages and the completions: nothing is missing, and other programs take them."""

import argparse
import difflib
import os
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ARGUMENTS = argparse.Namespace()


def run(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, timeout=60, **options)


def options_of(command):
    """The options on a page of help, read without the generator's reader."""
    page = run(ARGUMENTS.bendy, *command, "--help").stdout
    return [name for names in re.findall(r"^  (-\S+)", page, re.M) for name in names.split(",")]


class Case(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        made = run(ARGUMENTS.source / "scripts/make_reference.py", "--bendy", ARGUMENTS.bendy, "--man", cls.folder / "man",
                   "--completions", cls.folder / "completions", "--markdown", cls.folder / "cli.md",
                   env={**os.environ, "SOURCE_DATE_EPOCH": "1790000000"})
        if made.returncode != 0 or made.stderr:
            raise AssertionError(made.stderr)
        page = run(ARGUMENTS.bendy, "--help").stdout.split("Subcommands:")[1]
        cls.commands = re.findall(r"^  ([a-z]+) ", page, re.M)

    def setUp(self):
        self.assertIn("convert", self.commands)


class Page(Case):
    def test_page_in_docs_is_what_the_program_says(self):
        kept = ARGUMENTS.source / "docs/cli.md"
        if not ARGUMENTS.viewer:
            self.skipTest("built without the viewer: the commands that draw have no options")
        change = list(difflib.unified_diff(kept.read_text(encoding="utf-8").splitlines(),
                                           (self.folder / "cli.md").read_text(encoding="utf-8").splitlines(),
                                           "docs/cli.md", "what the program says", lineterm="", n=0))
        if change:
            self.fail("\n".join(change) + "\nMake it anew: scripts/make_reference.py --bendy PROGRAM --markdown docs/cli.md")

    def test_files_are_of_arguments_that_there_are(self):
        sys.path.insert(0, str(ARGUMENTS.source / "scripts"))
        from reference.files import FILES  # after the path is known
        if not ARGUMENTS.viewer:
            self.skipTest("built without the viewer: the commands that draw have no arguments")
        for command, name in FILES:
            with self.subTest(command=command, name=name):
                self.assertRegex(run(ARGUMENTS.bendy, command, "--help").stdout, rf"(?m)^  (-\w,)?{name} ")


class Complete(Case):
    """Every option stands in every output, in its command's part."""

    def check(self, text, command, form):
        options = options_of([command])
        self.assertTrue(options)
        for option in options:
            with self.subTest(command=command, option=option):
                self.assertRegex(text, r"(?<![\w-])" + re.escape(form(option)) + r"(?![\w-])")

    def test_page(self):
        sections = dict(re.findall(r"^## bendy (\w+)\n(.*?)(?=^## |\Z)", (self.folder / "cli.md").read_text(), re.M | re.S))
        self.assertEqual(list(sections), self.commands)
        for command, section in sections.items():
            self.check(section + "`-h` `--help`", command, lambda option: option)

    def test_man_pages(self):
        self.assertEqual({file.name for file in (self.folder / "man").iterdir()},
                         {"bendy.1", *(f"bendy-{command}.1" for command in self.commands)})
        for command in self.commands:
            self.check((self.folder / f"man/bendy-{command}.1").read_text().replace("\\-", "-").replace("\\fB", " "), command,
                       lambda option: option)

    def test_bash(self):
        text = (self.folder / "completions/bendy").read_text()
        for command in self.commands:
            part = re.search(rf"^        {command}\)\n(.*?);;\n            esac", text, re.M | re.S)
            self.check(part.group(1), command, lambda option: option)

    def test_zsh(self):
        text = (self.folder / "completions/_bendy").read_text()
        for command in self.commands:
            part = re.search(rf"^                {command}\)\n(.*?);;", text, re.M | re.S)
            self.check(re.sub(r"'\([^)]*\)|'\*|\[", " ", part.group(1)), command, lambda option: option)

    def test_fish(self):
        text = (self.folder / "completions/bendy.fish").read_text()
        for command in self.commands:
            lines = "\n".join(line.split(" -d '")[0] for line in text.splitlines() if f"'__bendy_is {command}'" in line)
            self.check(lines, command, lambda option: ("-l " if option.startswith("--") else "-s ") + option.lstrip("-"))


class Man(Case):
    def check(self, *command):
        if not shutil.which(command[0]):
            self.skipTest(f"{command[0]} is not installed")
        for file in sorted((self.folder / "man").iterdir()):
            done = run(*command, file)
            with self.subTest(file=file.name):
                self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_groff_warns_of_nothing(self):
        self.check("groff", "-man", "-Tutf8", "-ww", "-z")

    def test_mandoc_warns_of_nothing(self):
        self.check("mandoc", "-T", "lint", "-W", "warning")

    def test_it_reads_as_written(self):
        if not shutil.which("groff"):
            self.skipTest("groff is not installed")
        text = run("groff", "-man", "-Tascii", "-P-c", "-P-bou", "-rLL=300n", self.folder / "man/bendy-convert.1").stdout
        self.assertRegex(text, r"bendy-convert - convert characters \(\.gltf, ")
        self.assertRegex(text, r"\n +--images embed\|link\n +embed: copy image files into the output; .*Default: embed\.\n")
        self.assertRegex(text, r"\n +bendy convert fox\.glb -o build/fox\.bendy\n")


class Shell(Case):
    """The shells asked what they would propose."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.here = cls.folder / "here"
        (cls.here / "inner").mkdir(parents=True)
        for name in ("fox.glb", "a b.bendy", "notes.txt", "fox.obj"):
            (cls.here / name).touch()

    def check(self, propose):
        self.assertEqual(propose("bendy", "con"), {"convert"})
        self.assertEqual(propose("bendy", "convert", "--ima"), {"--images"})
        self.assertEqual(propose("bendy", "inspect", "--ima"), set())
        self.assertEqual(propose("bendy", "convert", "--images", ""), {"embed", "link"})
        self.assertEqual(propose("bendy", "convert", "--images", "l"), {"link"})
        self.assertEqual(propose("bendy", "convert", ""), {"fox.glb", "a b.bendy", "inner"})
        self.assertEqual(propose("bendy", "pose", "a b.bendy", "-o", "f"), {"fox.obj"})
        self.assertEqual(propose("bendy", "convert", "--scene", "f"), set())

    def test_bash(self):
        def propose(*words):
            script = f"source {self.folder}/completions/bendy; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _bendy; "
            done = run("bash", "--norc", "-c", script + 'printf "%s\\n" "${COMPREPLY[@]}"', "bash", *words, cwd=self.here)
            self.assertEqual(done.stderr, "")
            return {line for line in done.stdout.splitlines() if line}

        self.check(propose)
        self.assertEqual(propose("bendy", "convert", "--images", "=", "e"), {"embed"})
        self.assertEqual(propose("bendy", "convert", "--images", "="), {"embed", "link"})
        self.assertEqual(propose("bendy", "--v"), {"--version"})

    def test_fish(self):
        if not shutil.which("fish"):
            self.skipTest("fish is not installed")

        def propose(*words):
            line = " ".join(word.replace(" ", "\\ ") for word in words)
            done = run("fish", "--no-config", "-c", f"source {self.folder}/completions/bendy.fish; complete -C '{line}'", cwd=self.here,
                       env={**os.environ, "HOME": str(self.folder)})
            self.assertEqual(done.stderr, "")
            return {found.split("\t")[0].rstrip("/").replace("\\ ", " ") for found in done.stdout.splitlines()}

        self.check(propose)

    def test_zsh(self):
        if not shutil.which("zsh"):
            self.skipTest("zsh is not installed")
        self.assertIn("--images", self.type_in_zsh("bendy convert --ima\t"))
        self.assertIn("bendy convert fox.glb", self.type_in_zsh("bendy convert f\t"))
        self.assertIn("fox.obj", self.type_in_zsh("bendy pose a -o f\t"))
        self.assertIn("--images link", self.type_in_zsh("bendy convert --images l\t"))
        self.assertIn("bendy validate", self.type_in_zsh("bendy val\t"))

    def type_in_zsh(self, keys):
        """What a terminal shows when that is typed at a prompt."""
        process, terminal = pty.fork()
        if process == 0:
            os.chdir(self.here)
            os.execvpe("zsh", ["zsh", "-f", "-i"], {**os.environ, "TERM": "dumb", "HOME": str(self.folder), "PS1": "> "})
        try:
            def read_until(wanted):
                seen = ""
                end = time.monotonic() + 30
                while wanted not in seen and time.monotonic() < end:
                    if select.select([terminal], [], [], 0.1)[0]:
                        seen += os.read(terminal, 4096).decode(errors="replace")
                return seen
            os.write(terminal, f"fpath=({self.folder}/completions $fpath); autoload -U compinit; compinit -D -u; echo rea''dy\n".encode())
            self.assertIn("ready", read_until("ready\r"))
            os.write(terminal, (keys + "\x01echo '\x05' sho''wn\n").encode())
            return read_until("shown\r")
        finally:
            os.close(terminal)
            os.waitpid(process, 0)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bendy", required=True)
    parser.add_argument("--source", required=True, type=Path)
    parser.add_argument("--viewer", action="store_true", help="the program was built with it")
    _, rest = parser.parse_known_args(namespace=ARGUMENTS)
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
