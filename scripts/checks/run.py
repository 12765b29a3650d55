#!/usr/bin/env python3
"""Runs the project's checks, which scripts/checks/steps.py lists.

    scripts/test.sh                       builds the program and runs its tests
    scripts/test.sh gate                  the gate, what a change must pass: these tests and more; goes on where it stopped
    scripts/test.sh all                   the outer ring: everything else; goes on where it stopped
    scripts/test.sh all --since REVISION  the steps of the outer ring that the files changed since then can break
    scripts/test.sh STEP...               these steps, and the builds that they need; options after -- are ctest's: scripts/test.sh tests -- -R Skin
    scripts/test.sh --list                the steps of each ring

Stops at the first step that fails, and says how to run it alone.
"""

import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import affected
from results import read_results
from steps import STEPS, ctest_command, named

ROOT = Path(__file__).resolve().parents[2]
RECORD = ROOT / "build/checks"
# One place in so many is visited by the tests of damage in the gate, another one for each commit: tests/mutation/places.h.
PLACES = 7
# What the words that stand for several steps mean.
RINGS = {"test": ("test",), "gate": ("test", "gate"), "all": ("all",)}


def clock(seconds):
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"


def git(*arguments, **options):
    return subprocess.run(["git", *arguments], cwd=ROOT, check=True, capture_output=True, text=True, **options).stdout.strip()


def tree_now():
    """The id of a git tree of the sources, committed or not."""
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "GIT_INDEX_FILE": str(Path(folder, "index"))}
        git("read-tree", "HEAD", env=environment)
        git("add", "--all", env=environment)
        return git("write-tree", env=environment)


class Passed:
    """The steps that have passed, each with the tree on which it passed."""

    def __init__(self, tree):
        self.tree = tree
        self.file = RECORD / "passed.json"
        self.steps = json.loads(self.file.read_text(encoding="utf-8")) if self.file.exists() else {}

    def has(self, step):
        return self.steps.get(step.name, {}).get("tree") == self.tree

    def add(self, step, seconds):
        self.steps[step.name] = {"tree": self.tree, "seconds": round(seconds, 1)}
        part = self.file.with_suffix(".part")
        part.write_text(json.dumps(self.steps, indent=1), encoding="utf-8")
        part.replace(self.file)


def environment_of(step):
    environment = dict(os.environ)
    if step.ring in RINGS["gate"]:
        # The gate downloads nothing: scripts/setup.sh has done so.
        environment |= {"npm_config_offline": "true", "http_proxy": "http://127.0.0.1:9", "https_proxy": "http://127.0.0.1:9"}
        environment.setdefault("BENDY_PLACES", f"{int(git('rev-parse', 'HEAD')[:8], 16) % PLACES}/{PLACES}")
    return environment | step.environment


def run_step(step, tests_of_step, ctest_options):
    """Runs a step's commands and its tests; returns the failures and the command that runs them alone, or None."""
    environment = environment_of(step)
    for command in step.commands:
        if subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode != 0:
            return shlex.join(command), f"scripts/test.sh {step.name}"
    for tests in tests_of_step:
        results = RECORD / f"{step.name}_{tests.preset}.xml"
        results.unlink(missing_ok=True)
        command = ctest_command(tests, results, ctest_options)
        status = subprocess.run(command, cwd=ROOT, env=environment | tests.environment, check=False).returncode
        failed, skipped = read_results(results, ROOT / "tests/skipped.txt")
        for name, why in skipped:
            print(f"{name}: skipped, and tests/skipped.txt does not allow it: {why}")
        wrong = [*failed, *(name for name, _ in skipped)]
        if status != 0 or wrong:
            alone = f" -- -R '^{re.escape(wrong[0].split()[0])}'" if wrong else ""
            return wrong[0] if wrong else shlex.join(command), f"scripts/test.sh {step.name}{alone}"
    return None


def run(steps, asked, passed, ctest_options, keep_going):
    start = time.monotonic()
    failures, times = [], []
    for step in steps:
        began = time.monotonic()
        print(f"\n== {clock(began - start)}  {step.name}: {step.what}", flush=True)
        is_asked = step in asked  # of a step that another one needs, only the builds are needed
        failure = run_step(step, step.tests if is_asked else (), ctest_options)
        took = time.monotonic() - began
        times.append((took, step.name, failure is None))
        if failure is None:
            if is_asked and not ctest_options:
                passed.add(step, took)
            continue
        failures.append((step, *failure))
        if not keep_going:
            break
    print()
    for took, name, is_good in times:
        print(f"{clock(took):>6}  {name}{'' if is_good else '  FAILED'}")
    print(f"{clock(time.monotonic() - start):>6}  together")
    for step, what, alone in failures:
        print(f"\n{step.name} failed: {what}\nRun it alone: {alone}")
    return 1 if failures else 0


def with_needed(steps):
    """The steps, each after those that it needs."""
    chosen = []
    for step in steps:
        for one in (*with_needed(map(named, step.needs)), step):
            if one not in chosen:
                chosen.append(one)
    return chosen


def choose(options):
    """The requested steps, in their order."""
    ring = RINGS.get(options.steps[0] if options.steps else "test")
    if ring is None:
        return [named(name) for name in options.steps]
    steps = [step for step in STEPS if step.ring in ring]
    if options.since is None:
        return steps
    chosen, why = affected.steps_since(ROOT, options.since, steps)
    print(why)
    return chosen


def parse(arguments):
    ctest_options = []
    if "--" in arguments:
        at = arguments.index("--")
        arguments, ctest_options = arguments[:at], arguments[at + 1:]
    parser = argparse.ArgumentParser(prog="scripts/test.sh", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("steps", nargs="*", metavar="gate|all|STEP")
    parser.add_argument("--since", metavar="REVISION", help="with all: only the steps that changes since then can break")
    parser.add_argument("--again", action="store_true", help="with gate and all: also the steps that have passed on these sources")
    parser.add_argument("--keep-going", action="store_true", help="run the other steps after one has failed, too")
    parser.add_argument("--list", action="store_true", help="list the steps")
    options = parser.parse_args(arguments)
    rings = [name for name in options.steps if name in ("gate", "all")]
    unknown = [name for name in options.steps if name not in rings and named(name) is None]
    if unknown:
        parser.error(f"unknown step {unknown[0]}: scripts/test.sh --list shows them")
    if rings and len(options.steps) > 1:
        parser.error(f"{rings[0]} goes with no other step")
    if options.again and not rings:
        parser.error("--again goes with gate and all")
    if options.since and rings != ["all"]:
        parser.error("--since goes with all")
    if options.since and subprocess.run(["git", "rev-parse", "--verify", "--quiet", f"{options.since}^{{commit}}"], cwd=ROOT,
                                        stdout=subprocess.DEVNULL, check=False).returncode != 0:
        parser.error(f"--since: unknown revision {options.since}")
    return options, ctest_options


def main():
    options, ctest_options = parse(sys.argv[1:])
    if options.list:
        for step in STEPS:
            print(f"{step.ring:6}{step.name:15}{step.what}")
        return 0
    RECORD.mkdir(parents=True, exist_ok=True)
    steps = choose(options)
    for packages in dict.fromkeys(step.setup for step in steps):
        subprocess.run(["scripts/setup.sh", packages], cwd=ROOT, check=True)
    passed = Passed(tree_now())
    if options.steps in (["gate"], ["all"]) and not options.again:
        for step in steps:
            if passed.has(step):
                print(f"{step.name}: has passed on these sources")
        steps = [step for step in steps if not passed.has(step)]
    return run(with_needed(steps), steps, passed, ctest_options, options.keep_going)


if __name__ == "__main__":
    sys.exit(main())
