#!/usr/bin/env python3
"""Reads tools/reports/convert_options.def, the one description of the options of `convert`, for Python and TypeScript.

convert_options.py TARGET.ts    the interface ProgramOptions and the names in it, of which ConvertOptions of bendy/tools is made
"""

import re
import sys
import textwrap
from pathlib import Path

REPORTS = Path(__file__).resolve().parents[1] / "tools/reports"
TYPES = {"flag": "boolean", "word": "string", "path": "string", "number": "number"}


def text_of(literals):
    """The text of adjacent string literals."""
    return "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', literals))


def read():
    """(name, kind, default, words that it may be, help) of each option; a default of Python, None if there is none."""
    by_key = text_of(re.search(r"kByKey = (.*?);", (REPORTS / "convert_options.h").read_text(encoding="utf-8"), re.DOTALL)[1])
    text = (REPORTS / "convert_options.def").read_text(encoding="utf-8")
    listed = re.findall(r'^BENDY_CONVERT_OPTION\((\w+), (\w+), (.*?), (".*?"), ".*?", ".*?",\s*(.*?)\)$', text, re.MULTILINE | re.DOTALL)
    assert len(listed) == len(re.findall("^BENDY_CONVERT_OPTION", text, re.MULTILINE)), "an option that is not read"
    defaults = {"{}": "None", "false": "False", "true": "True"}
    return [(name, kind, defaults.get(default, default), text_of(words).split(), text_of(help).replace("{key}", by_key))
            for kind, name, default, words, help in listed]


def camel(name):
    return re.sub(r"[_-](\w)", lambda found: found[1].upper(), name)


def with_names(text, rename):
    """A help text with the names of options as another language has them."""
    return re.sub(r"--([a-z]+(?:-[a-z]+)*)", lambda found: rename(found[1]), text)


def typescript():
    lines = ["// Made from tools/reports/convert_options.def by bindings/convert_options.py.",
             "/** The options of `bendy convert` that decide which bytes come out. */", "export interface ProgramOptions {"]
    for name, kind, _, words, text in read():
        kind = " | ".join(f"'{word}'" for word in words) or TYPES[kind]
        first = text[0] if text.partition(":")[0] in words else text[0].upper()
        lines += textwrap.wrap(f"/** {first}{with_names(text[1:], camel)}. */", 130, initial_indent="  ", subsequent_indent="   * ")
        lines.append(f"  {camel(name)}?: {kind};")
    names = ", ".join(f"'{camel(name)}'" for name, *_ in read())
    lines += ["}", "", "/** Their names. */",
              *textwrap.wrap(f"export const programOptions: readonly (keyof ProgramOptions)[] = [{names}];", 130, subsequent_indent="  ")]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(typescript(), encoding="utf-8")
