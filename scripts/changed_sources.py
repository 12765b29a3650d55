#!/usr/bin/env python3
"""Prints the sources that have changed, and those that include what has: scripts/changed_sources.py [REVISION]

Since REVISION; if it is not given, since BENDY_SINCE of the environment, or else since the branch left origin's; on that branch
itself, since four hours before its newest commit. A change of clang-tidy's settings touches every source.
"""

import collections
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
STRETCH = 4 * 60 * 60  # seconds


def git(*arguments):
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else ""


def base():
    if since := os.environ.get("BENDY_SINCE"):
        return since
    head = git("rev-parse", "HEAD")
    fork = git("merge-base", "HEAD", "origin/HEAD") or git("merge-base", "HEAD", "origin/main")
    if fork and fork != head:
        return fork
    newest = int(git("show", "--no-patch", "--format=%ct", "HEAD"))
    return git("rev-list", "--max-count=1", f"--before={newest - STRETCH}", "HEAD") or git("rev-list", "--max-parents=0", "HEAD")


def main():
    since = sys.argv[1] if len(sys.argv) > 1 else base()
    files = [file for file in git("ls-files", "*.cpp", "*.h", "*.def").splitlines() if (ROOT / file).exists()]
    sources = [file for file in files if file.endswith(".cpp")]
    if not git("rev-parse", "--verify", "--quiet", f"{since}^{{commit}}"):
        print(f"{since}: no such revision, so all sources count as changed", file=sys.stderr)
        print("\n".join(sources))
        return
    changed = set(git("diff", "--name-only", since).splitlines()) | set(git("ls-files", "--others", "--exclude-standard").splitlines())
    if ".clang-tidy" in changed:
        print("\n".join(sources))
        return
    # The included files as written, by the last part of their paths: a name that two files share counts for both.
    includers = collections.defaultdict(set)
    for file in files:
        for name in INCLUDE.findall((ROOT / file).read_text(encoding="utf-8")):
            includers[name.split("/")[-1]].add((file, name))
    touched = {file for file in changed if file.endswith((".cpp", ".h", ".def"))}
    queue = sorted(touched)
    for file in queue:
        for includer, name in includers[file.split("/")[-1]]:
            if includer not in touched and ("/" + file).endswith("/" + name.removeprefix("../")):
                touched.add(includer)
                queue.append(includer)
    print("\n".join(file for file in sources if file in touched))


if __name__ == "__main__":
    main()
