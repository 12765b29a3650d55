"""Reads what `bendy --help` and `bendy COMMAND --help` print, in the form that CLI11 gives it, into Command and Option."""

import re
import subprocess
from dataclasses import dataclass, field

from reference.files import FILES, READABLE


@dataclass
class Option:
    """An option, a flag or, if it has no dashes, a positional argument."""

    names: list[str]
    kind: str = ""  # TEXT, FOLDER, FLOAT, INT, UINT; "" for a flag
    choices: list[str] = field(default_factory=list)
    range: str = ""
    default: str = ""
    repeated: bool = False
    required: bool = False
    needs: list[str] = field(default_factory=list)
    excludes: list[str] = field(default_factory=list)
    about: str = ""
    files: list[str] | None = None  # None: no file; []: any; else the extensions, with their dots
    group: str = ""  # its heading in the help; "" for the first one, and for a positional argument

    @property
    def is_flag(self):
        return not self.kind

    @property
    def value(self):
        """The placeholder for the value on a page."""
        if self.choices:
            return "|".join(self.choices)
        if self.files is not None:
            return "FOLDER" if self.kind == "FOLDER" else "FILE"
        return {"FLOAT": "NUMBER", "INT": "N", "UINT": "N"}.get(self.kind, self.kind)

    @property
    def brief(self):
        """The first part of the description, for a menu."""
        return self.about.split(";")[0]

    @property
    def notes(self):
        """The notes on its line other than its description, as sentences without a full stop."""
        notes = []
        if self.default:
            notes.append(f"Default: {self.default}")
        if self.range:
            notes.append(f"From {self.range.replace(' - ', ' to ')}")
        if self.needs:
            notes.append(f"Needs {', '.join(self.needs)}")
        if self.excludes:
            notes.append(f"Not with {', '.join(self.excludes)}")
        if self.repeated and self.names[0].startswith("-") and "may be repeated" not in self.about:
            notes.append("May be repeated")
        if self.required and self.names[0].startswith("-"):
            notes.append("Always needed")
        return notes


@dataclass
class Command:
    """One command, or the program, whose name is then empty."""

    name: str
    about: str
    arguments: list[Option]
    options: list[Option]
    footer: list[str]  # lines
    commands: list["Command"] = field(default_factory=list)

    @property
    def groups(self):
        """Pairs of heading and options: those under "Options", after the positional arguments, have no heading."""
        groups = {"": [*self.arguments]}
        for option in self.options:
            groups.setdefault(option.group, []).append(option)
        return groups.items()

    @property
    def usage(self):
        """The usage after `bendy`."""
        if self.commands:
            return "COMMAND [OPTIONS] ..."
        words = [self.name, "[OPTIONS]"]
        for argument in self.arguments:
            word = argument.names[0] + ("..." if argument.repeated else "")
            words.append(word if argument.required else f"[{word}]")
        return " ".join(words)

    @property
    def prose(self):
        return [line for line in self.footer if line and not self._is_example(line)]

    @property
    def examples(self):
        return [line.removeprefix("Example:").strip() for line in self.footer if self._is_example(line)]

    @staticmethod
    def _is_example(line):
        return line.startswith(("Example:", "         bendy "))


SECTIONS = {"Positionals:": "arguments", "Options:": "options", "Subcommands:": "commands"}
GROUP = re.compile(r"([A-Z][^:]*):")  # the heading of further options
COLUMN = 30  # where CLI11 begins the description of an option

# The left side of an option's line: names, TYPE:{a,b}=default, ..., REQUIRED, Needs: ..., Excludes: ...
LEFT = re.compile(r"""(?P<names>\S+)
    (?:\ (?P<kind>[A-Z]+)
        (?::\{(?P<choices>[^}]*)\})?
        (?::(?:[A-Z]+\ in\ \[(?P<range>[^\]]*)\]|[^\s=]+))?
        (?:=(?P<default>\S+))?)?
    (?P<repeated>\ \.\.\.)?
    (?P<required>\ REQUIRED)?
    (?:\ Needs:(?P<needs>(?:\ --\S+)+))?
    (?:\ Excludes:(?P<excludes>(?:\ --\S+)+))?""", re.VERBOSE)


class UnknownHelp(Exception):
    """The program's help has a form that this reader does not support."""


def read_program(program):
    """The Command of the whole program, with those of its commands."""
    whole, names = read_page(_help(program), "")
    whole.commands = [read_page(_help(program, name), name)[0] for name in names]
    readable = _readable(whole.commands)
    for option in (option for command in whole.commands for option in command.arguments + command.options):
        if option.files:
            option.files = [suffix for each in option.files for suffix in (readable if each == READABLE else [each])]
    return whole


def _readable(commands):
    """The suffixes that `bendy convert` reads: its help lists them in brackets."""
    for command in commands:
        if command.name == "convert":
            return re.search(r"\((\..*?)\)", command.about)[1].split(", ")
    return []


def read_page(text, name):
    """The Command on one page of help, and the names of the commands that it lists."""
    lines = text.splitlines()
    command = Command(name, lines[0], [], [], [])
    names = []
    section = None
    group = ""
    for line, following in zip(lines[1:], [*lines[2:], ""]):
        if line in SECTIONS:
            section = SECTIONS[line]
        elif section == "options" and (heading := GROUP.fullmatch(line)):
            group = heading[1]
        elif section and line.startswith(" " * COLUMN):
            continue  # was read with the line before
        elif section and line.startswith("  "):
            left, about = _split(line, following)
            if section == "commands":
                names.append(left)
            else:
                option = _read_option(left, about, name)
                option.group = group
                getattr(command, section).append(option)
        elif line and not line.startswith("Usage: "):
            command.footer.append(line)
            section = None
    return command, names


def _help(program, *command):
    done = subprocess.run([program, *command, "--help"], capture_output=True, text=True, check=True)
    return done.stdout


def _split(line, following):
    """The text left and right of the column; if the left one is too long, the right one is on the following line."""
    if following.startswith(" " * COLUMN):
        return line.strip(), following.strip()
    return line[:COLUMN].strip(), line[COLUMN:].strip()


def _read_option(left, about, command):
    match = LEFT.fullmatch(left)
    if not match:
        raise UnknownHelp(f"bendy {command} --help: what is {left!r}?")
    of = match.groupdict()
    option = Option(of["names"].split(","), of["kind"] or "", (of["choices"] or "").split(",") if of["choices"] else [],
                    of["range"] or "", of["default"] or "", bool(of["repeated"]), bool(of["required"]),
                    (of["needs"] or "").split(), (of["excludes"] or "").split(), about)
    if not option.is_flag and not option.choices:
        option.files = _files_of(option, command)
    return option


def _files_of(option, command):
    if option.kind == "FOLDER":
        return []
    for name in option.names:
        if (command, name) in FILES:
            return FILES[command, name].split()
    return None if option.names[0].startswith("-") and "--output" not in option.names else []
