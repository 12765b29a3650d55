#!/usr/bin/env python3
"""Makes everything that a release has, in out/release-VERSION or FOLDER, from a clean clone.

    scripts/release.sh [FOLDER]                   all artefacts, release notes, a bill of materials (SPDX), checksums; prints what there is
    scripts/release.sh --only NAME,... [FOLDER]   these artefacts
    scripts/release.sh --without NAME,...         all but these: where a toolchain is missing
    scripts/release.sh --allow-changes            also from sources that are not committed: to try it
    scripts/release.sh --list                     the artefacts

The same commit gives the same bytes, with the same tools. What the tools say goes to build/release-logs.
"""

import argparse
import hashlib
import sys
import time
from pathlib import Path

import notes
import sbom
from artefacts import ARTEFACTS
from project import ROOT, VERSION, git
from versions import check_versions

sys.path.insert(0, str(ROOT / "scripts"))
from own_folder import made_anew  # noqa: E402

LOGS = ROOT / "build/release-logs"
NAMES = [artefact.name for artefact in ARTEFACTS]


def names(text):
    chosen = text.split(",")
    unknown = [name for name in chosen if name not in NAMES]
    if unknown:
        raise argparse.ArgumentTypeError(f"no artefact {unknown[0]}: {', '.join(NAMES)}")
    return chosen


def parse():
    parser = argparse.ArgumentParser(prog="scripts/release.sh", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / f"out/release-{VERSION}")
    parser.add_argument("--only", type=names, default=NAMES, metavar="NAME,...")
    parser.add_argument("--without", type=names, default=[], metavar="NAME,...")
    parser.add_argument("--allow-changes", action="store_true")
    parser.add_argument("--list", action="store_true")
    return parser.parse_args()


def make_artefacts(chosen, folder):
    """Makes them; returns {name of a file: its artefact}, sorted."""
    made = {}
    for artefact in chosen:
        began = time.monotonic()
        log = LOGS / f"{artefact.name}.log"
        log.unlink(missing_ok=True)
        artefact.make(folder, log)
        files = sorted(path.name for pattern in artefact.files for path in folder.glob(pattern))
        if not files:
            raise SystemExit(f"scripts/release.sh: {artefact.name} was not made")
        made |= dict.fromkeys(files, artefact)
        print(f"{artefact.name}: {', '.join(files)} ({time.monotonic() - began:.0f} s)", flush=True)
    return dict(sorted(made.items()))


def write_checksums(folder):
    files = sorted(path for path in folder.iterdir() if path.name != "SHA256SUMS")
    lines = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in files]
    (folder / "SHA256SUMS").write_text("".join(lines), encoding="utf-8")


def main():
    options = parse()
    if options.list:
        print("\n".join(f"{artefact.name:11}{artefact.what}" for artefact in ARTEFACTS))
        return 0
    check_versions()
    if not options.allow_changes and git("status", "--porcelain"):
        sys.exit("scripts/release.sh: there are changes that are not committed; a release is made from a commit")
    chosen = [artefact for artefact in ARTEFACTS if artefact.name in options.only and artefact.name not in options.without]
    with made_anew(options.folder, "scripts/release.sh") as folder:
        LOGS.mkdir(parents=True, exist_ok=True)
        made = make_artefacts(chosen, folder)
        sbom.make(folder, {name: artefact.kind for name, artefact in made.items()})
        notes.make(folder, {name: artefact.what for name, artefact in made.items()} | {sbom.NAME: "what is in these files (SPDX)"})
        write_checksums(folder)
        print()
        for path in sorted(folder.iterdir()):
            print(f"{path.stat().st_size:>12,}  {path.name}")
    left_out = [name for name in NAMES if name not in [artefact.name for artefact in chosen]]
    if left_out:
        print(f"\nLeft out: {', '.join(left_out)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
