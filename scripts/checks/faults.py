#!/usr/bin/env python3
"""Replays the faults of tests/faults, each in a clone of the newest commit: the step that CONTRIBUTING.md names for its kind must fail, and
say what the patch says it says.

    scripts/checks/faults.py [--again] [NAME...]    all patches, or these; those that were caught before on the same sources are left out

The clone stays in build/faults, so that each fault compiles only what it changes.
"""

import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path

from steps import named

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "build/faults"
TREE = WORK / "tree"


def git(*arguments, folder=TREE):
    return subprocess.run(["git", *arguments], cwd=folder, check=True, capture_output=True, text=True).stdout.strip()


def read_header(patch):
    text = patch.read_text(encoding="utf-8")
    fields = dict(re.findall(r"^(Kind|What|Symptom|Test): (.*)$", text.split("diff --git")[0], re.MULTILINE))
    missing = {"Kind", "What", "Symptom", "Test"} - set(fields)
    if missing:
        sys.exit(f"{patch.name}: the header has no {', '.join(sorted(missing))}")
    return fields


def steps_by_kind():
    """The table of CONTRIBUTING.md: a kind, the steps that find it."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    table = text[text.index("<!-- the kinds of faults -->"):]
    kinds = {}
    for line in table.splitlines()[2:]:
        if kinds and not line.startswith("|"):
            break
        if match := re.match(r"^\| ([^|`]+?) \| (`[^|]*)\|", line):
            kinds[match[1]] = re.findall(r"`([\w-]+)`", match[2])
    for kind, steps in kinds.items():
        for name in steps:
            if named(name) is None:
                sys.exit(f"CONTRIBUTING.md: {kind}: unknown step {name}")
    return kinds


def make_tree():
    """A clone of the newest commit, without changes, with what it built before."""
    if not TREE.exists():
        WORK.mkdir(parents=True, exist_ok=True)
        subprocess.run(["git", "clone", "--quiet", "--shared", ROOT, TREE], check=True)
        shared = ROOT.parent / "shared"
        if shared.exists():
            (WORK / "shared").symlink_to(shared)
    git("fetch", "--quiet", "origin", git("rev-parse", "HEAD", folder=ROOT))
    git("reset", "--quiet", "--hard", git("rev-parse", "HEAD", folder=ROOT))
    git("clean", "--quiet", "-d", "--force")


def is_caught(patch, fields, step):
    """Whether the step fails in the current tree, with the symptom; keeps its output in build/faults."""
    command = ["scripts/test.sh", step.name]
    if step.tests and fields["Test"].startswith("^"):
        command += ["--", "-R", fields["Test"]]
    environment = {**os.environ, "BENDY_SINCE": "HEAD"}
    done = subprocess.run(command, cwd=TREE, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                          check=False)
    (WORK / f"{patch.stem}_{step.name}.log").write_text(done.stdout, encoding="utf-8")
    return done.returncode != 0 and re.search(fields["Symptom"], done.stdout) is not None


class Caught:
    """The faults that were caught, by the sources and the patch."""

    def __init__(self):
        self.file = WORK / "caught.json"
        self.known = json.loads(self.file.read_text(encoding="utf-8")) if self.file.exists() else {}
        self.tree = git("rev-parse", "HEAD^{tree}")

    def key(self, patch):
        return f"{self.tree} {hashlib.sha256(patch.read_bytes()).hexdigest()}"

    def add(self, patch, step):
        self.known[patch.stem] = {"key": self.key(patch), "step": step}
        self.file.write_text(json.dumps(self.known, indent=1), encoding="utf-8")

    def step_of(self, patch):
        entry = self.known.get(patch.stem, {})
        return entry.get("step") if entry.get("key") == self.key(patch) else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--again", action="store_true", help="also those that were caught before")
    options = parser.parse_args()
    patches = [patch for patch in sorted((ROOT / "tests/faults").glob("*.patch")) if not options.names or patch.stem in options.names]
    kinds = steps_by_kind()
    headers = {patch: read_header(patch) for patch in patches}
    unknown = sorted({fields["Kind"] for fields in headers.values()} - set(kinds))
    if unknown:
        sys.exit(f"CONTRIBUTING.md has no line for these kinds: {', '.join(unknown)}")
    make_tree()
    caught, missed, used = Caught(), [], set()
    # Faults that the same steps find run together, so that a build is made only once.
    for patch in sorted(patches, key=lambda one: (kinds[headers[one]["Kind"]], one.name)):
        fields, began = headers[patch], time.monotonic()
        step = None if options.again else caught.step_of(patch)
        if step is None:
            if subprocess.run(["git", "apply", str(patch)], cwd=TREE, check=False).returncode != 0:
                print(f"{patch.stem}: does not apply to these sources: make it anew, tests/faults/README.md")
                missed.append(patch.stem)
                continue
            step = next((name for name in kinds[fields["Kind"]] if is_caught(patch, fields, named(name))), None)
            git("reset", "--quiet", "--hard")
            git("clean", "--quiet", "-d", "--force")
        if step is None:
            missed.append(patch.stem)
        else:
            caught.add(patch, step)
            used.add((fields["Kind"], step))
        print(f"{patch.stem:34}{fields['Kind']:22}{step or 'NOT CAUGHT':14}{time.monotonic() - began:6.0f} s", flush=True)
    print(f"{len(patches) - len(missed)} of {len(patches)} faults caught")
    if not options.names:
        idle = [f"{kind}: {step}" for kind, steps in kinds.items() for step in steps if (kind, step) not in used]
        if idle:
            print("These steps are named in CONTRIBUTING.md and caught no fault of the kind:", *idle, sep="\n  ")
            return 1
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
