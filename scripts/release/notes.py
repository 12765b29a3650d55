"""The notes of a release: what CHANGELOG.md says of the version, and its files."""

import re

from project import ROOT, VERSION

HEADING = re.compile(r"^## (.+)$", re.M)


def changes(text, version):
    """The part of the change log about a version, without its heading."""
    parts = HEADING.split(text)
    for heading, body in zip(parts[1::2], parts[2::2]):
        if heading.split()[0] == version:
            return body.strip()
    raise SystemExit(f"CHANGELOG.md has no part for {version}")


def make(folder, what):
    """what: {name of a file: what it is}"""
    rows = [f"| {name} | {text} | {(folder / name).stat().st_size:,} |" for name, text in what.items()]
    table = "\n".join(["| file | what it is | bytes |", "|---|---|---:|", *rows])
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    notes = f"# Bendy {VERSION}\n\n{table}\n\n`sha256sum -c SHA256SUMS` checks the files.\n\n{changes(text, VERSION)}\n"
    (folder / "RELEASE_NOTES.md").write_text(notes, encoding="utf-8")
