#!/usr/bin/env python3
"""Converts every file of the corpus, poses what converts at every time its reference lists, and compares.

    run_corpus.py --bendy PROGRAM --corpus FOLDER [--only ID] [--no-poses]

A file that is to be accepted must convert, validate, give itself when it is converted again, and match its reference within 1e-5 of the bounding-box diagonal, the
rest pose tracked; one that is to be refused must give one line of error, exit status 1 and no output; the others may do
either. Nothing may crash, hang, or write a number that is not finite. Prints the figures; exit status 1 if a file fails.
"""

import argparse
import concurrent.futures
import gzip
import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

TOLERANCE = 1e-5
SECONDS = 120  # for one command; all of them take well under one
MEMORY = 8 << 30  # address space of one command


def is_sanitized(program):
    return b"__asan_init" in Path(program).read_bytes()


def make_runner(program):
    # AddressSanitizer reserves terabytes of address space, so that build runs without the limit.
    limit = None if is_sanitized(program) else lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))

    def run(*arguments):
        return subprocess.run(
            [program, *map(str, arguments)], capture_output=True, timeout=SECONDS, preexec_fn=limit, check=False
        )

    return run


class Outcome:
    """What became of one file."""

    def __init__(self, entry):
        self.entry = entry
        self.converted = False
        self.message = ""
        self.frames = 0
        self.worst = 0.0
        self.faults = []

    @property
    def must_convert(self):
        return self.entry["expected"] == "accept" or self.entry.get("shouldAccept", False)

    @property
    def must_refuse(self):
        return self.entry["expected"] == "reject"


def check_refusal(outcome, result, output):
    lines = result.stderr.decode("utf-8", "replace").strip().splitlines()
    errors = [line for line in lines if line.startswith("bendy: error: ")]
    outcome.message = errors[0] if errors else ""
    if len(errors) != 1:
        outcome.faults.append(f"{len(errors)} error lines, 1 is right")
    if any(output.parent.iterdir()):
        outcome.faults.append("a refused file left an output behind")
    if outcome.must_convert:
        outcome.faults.append("must convert: " + outcome.message)


def compare_poses(outcome, run, corpus, bendy_file, folder):
    reference = corpus / outcome.entry["ref"]
    with gzip.open(reference, "rt", encoding="utf-8") as stream:
        content = json.load(stream)
    rest = folder / "rest.ply"
    jobs = []
    for number, frame in enumerate(content["frames"]):
        mesh = rest if frame["clip"] < 0 else folder / f"{number}.ply"
        clip = [] if frame["clip"] < 0 else ["--clip", frame["clip"], "--time", repr(frame["t"])]
        result = run("pose", bendy_file, *clip, "-o", mesh)
        if result.returncode != 0:
            outcome.faults.append("pose: " + result.stderr.decode("utf-8", "replace").strip())
            return
        jobs.append({"ref": str(reference), "clip": "rest" if frame["clip"] < 0 else frame["clip"], "time": frame["t"],
                     "mesh": str(mesh), "rest": str(rest), "tol": TOLERANCE})
        if not content["hasTriangles"]:
            jobs[-1]["prims"] = "all"
    batch = folder / "jobs.json"
    batch.write_text(json.dumps(jobs))
    result = subprocess.run(["node", str(corpus / "oracle" / "compare.mjs"), "--batch", str(batch), "--json"],
                            capture_output=True, check=False)
    try:
        answers = json.loads(result.stdout)
    except json.JSONDecodeError:
        outcome.faults.append("compare: " + result.stderr.decode("utf-8", "replace").strip())
        return
    for answer in answers:
        verdict = answer["result"]
        outcome.frames += 1
        error = verdict.get("max")
        if isinstance(error, (int, float)):
            outcome.worst = max(outcome.worst, error)
        if not verdict["pass"]:
            outcome.faults.append(f"clip {answer['clip']} at {answer['time']}: {verdict.get('checks')} {verdict.get('notes')}")


def try_file(run, corpus, entry, poses):
    outcome = Outcome(entry)
    with tempfile.TemporaryDirectory(prefix="bendy_corpus_") as name:
        folder = Path(name)
        output = folder / "out.bendy"
        try:
            result = run("convert", corpus / "visible" / entry["file"], "-o", output)
            if result.returncode not in (0, 1):
                outcome.faults.append(f"convert ended with {result.returncode}: {result.stderr[-400:]!r}")
                return outcome
            if result.returncode == 1:
                check_refusal(outcome, result, output)
                return outcome
            outcome.converted = True
            if outcome.must_refuse:
                outcome.faults.append("must be refused: " + entry.get("reason", ""))
                return outcome
            validated = run("validate", output)
            if validated.returncode != 0:
                outcome.faults.append("validate: " + validated.stdout.decode("utf-8", "replace").strip())
            inspected = run("inspect", output)
            if inspected.returncode != 0:
                outcome.faults.append("inspect: " + inspected.stderr.decode("utf-8", "replace").strip())
            again = folder / "again.bendy"
            run("convert", output, "-o", again)
            if not again.exists() or again.read_bytes() != output.read_bytes():
                outcome.faults.append("converted again it is another file")
            if entry.get("ref") and poses:
                compare_poses(outcome, run, corpus, output, folder)
        except subprocess.TimeoutExpired as expired:
            outcome.faults.append(f"ran longer than {SECONDS} s: {expired.cmd[1]}")
    return outcome


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bendy", required=True)
    parser.add_argument("--corpus", required=True, type=Path)
    parser.add_argument("--only")
    parser.add_argument("--no-poses", action="store_true", help="convert, validate and inspect only")
    options = parser.parse_args()

    corpus = options.corpus.resolve()
    entries = json.loads((corpus / "visible" / "manifest.json").read_text(encoding="utf-8"))["files"]
    if options.only:
        entries = [entry for entry in entries if entry["id"] == options.only]
    run = make_runner(os.path.abspath(options.bendy))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as workers:
        outcomes = list(workers.map(lambda entry: try_file(run, corpus, entry, not options.no_poses), entries))

    failed = [outcome for outcome in outcomes if outcome.faults]
    for outcome in failed:
        print(f"FAILED {outcome.entry['id']} ({outcome.entry['file']})")
        for fault in outcome.faults[:5]:
            print(f"    {fault}")
    converted = [outcome for outcome in outcomes if outcome.converted]
    refused = [outcome for outcome in outcomes if outcome.message]
    due = sum(outcome.must_convert for outcome in outcomes)
    due_refused = sum(outcome.must_refuse for outcome in outcomes)
    print(f"files        {len(outcomes)}")
    print(f"converted    {len(converted)} ({sum(o.converted and o.must_convert for o in outcomes)} of {due} that must)")
    print(f"refused      {len(refused)} ({sum(bool(o.message) and o.must_refuse for o in outcomes)} of {due_refused} that must)")
    compared = [outcome for outcome in outcomes if outcome.frames]
    if compared:
        worst = max(compared, key=lambda outcome: outcome.worst)
        print(f"poses        {sum(o.frames for o in compared)} frames of {len(compared)} files compared")
        print(f"worst error  {worst.worst:.2e} of the bounding-box diagonal, in {worst.entry['id']} (allowed: {TOLERANCE:.0e})")
    print(f"failed       {len(failed)}")
    return 1 if failed or not outcomes else 0


if __name__ == "__main__":
    sys.exit(main())
