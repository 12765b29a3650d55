#!/usr/bin/env python3
"""Exports characters as glTF and asks others: Khronos' validator, three.js, and bendy itself.

    run_exports.py --bendy PROGRAM --work FOLDER [--corpus FOLDER] [--npm NPM] [--only ID]

Takes the examples and, where it is given, the corpus. glTF, bendy, glTF, bendy: the second bendy file has the bytes of the
first unless the export has named what it could not keep; the validator reports no error, and three.js poses the export as the
references say, within 1e-5 of the bounding-box diagonal. Exit status 77 where the packages of package-lock.json cannot be had.
"""

import argparse
import gzip
import json
import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
from own_folder import work_folder  # noqa: E402

HERE = Path(__file__).resolve().parent
TOLERANCE = 1e-5
SKIPPED = 77


def install(work, npm):
    """Puts the packages into the work folder, once; false if they cannot be had."""
    lock = HERE / "package-lock.json"
    stamp = work / "node_modules" / "installed.json"
    for name in ("package.json", "package-lock.json", "witnesses.mjs"):
        shutil.copy(HERE / name, work / name)
    if stamp.exists() and stamp.read_bytes() == lock.read_bytes():
        return True
    result = subprocess.run([npm, "ci", "--no-audit", "--no-fund", "--ignore-scripts"], cwd=work, check=False)
    if result.returncode == 0:
        shutil.copy(lock, stamp)
    return result.returncode == 0


def differences(first, second):
    """The first place in which two files differ, in words; nothing if they are the same."""
    a, b = first.read_bytes(), second.read_bytes()
    if a == b:
        return None
    at = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
    return f"{len(a)} and {len(b)} bytes, from byte {at} on"


class Asset:
    """One file of the corpus on its way to bendy, to glTF and to bendy again."""

    def __init__(self, bendy, source, reference, folder):
        self.source = source
        self.faults = []
        self.glb = None
        self.frames = []
        folder.mkdir()
        first, glb, second = (folder / name for name in ("first.bendy", "exported.glb", "second.bendy"))

        self.warnings = b""

        def run(*arguments):
            result = subprocess.run([bendy, *map(str, arguments)], capture_output=True, timeout=120, check=False)
            if arguments[0] == "export":
                self.warnings = result.stderr
            if result.returncode != 0:
                self.faults.append(f"{arguments[0]}: {result.stderr.decode(errors='replace').strip()}")
            return result.returncode == 0

        if subprocess.run([bendy, "convert", "-q", source, "-o", first], capture_output=True, check=False).returncode != 0:
            return  # the corpus' own test says whether it may be refused
        if not run("export", "-q", first, "-o", glb):
            return
        self.glb = glb
        if run("convert", "-q", glb, "-o", second):
            difference = differences(first, second)
            if difference and not self.warnings:
                self.faults.append("converted again it is another file: " + difference)
        if reference:
            self.ask_for_poses(reference, folder)

    def ask_for_poses(self, reference, folder):
        with gzip.open(reference, "rt", encoding="utf-8") as stream:
            content = json.load(stream)
        for number, frame in enumerate(content["frames"]):
            is_rest = frame["clip"] < 0
            self.frames.append({
                "clip": frame["clip"], "time": frame["t"], "mesh": str(folder / ("rest.ply" if is_rest else f"{number}.ply")),
                "job": {"ref": str(reference), "clip": "rest" if is_rest else frame["clip"], "time": frame["t"],
                        "rest": str(folder / "rest.ply"), "tol": TOLERANCE,
                        **({} if content["hasTriangles"] else {"prims": "all"})}})


def ask_witnesses(assets, work):
    jobs = work / "jobs.json"
    jobs.write_text(json.dumps([{"file": str(asset.glb), "frames": asset.frames} for asset in assets]))
    result = subprocess.run(["node", "witnesses.mjs", jobs], cwd=work, capture_output=True, check=False)
    if result.returncode != 0:
        sys.exit(result.stderr.decode(errors="replace"))
    for asset, answer in zip(assets, json.loads(result.stdout)):
        asset.faults += ["validator: " + error for error in answer["errors"]]
        if "failed" in answer:
            asset.faults.append("three.js: " + answer["failed"])
            asset.frames = []


def compare_poses(assets, corpus, work):
    jobs = [{**frame["job"], "mesh": frame["mesh"]} for asset in assets for frame in asset.frames]
    batch = work / "compare.json"
    batch.write_text(json.dumps(jobs))
    verdicts = work / "verdicts.json"  # a file: what goes into a pipe is cut when the comparer exits
    with verdicts.open("w") as stream:
        subprocess.run(["node", corpus / "oracle" / "compare.mjs", "--batch", batch, "--json"], stdout=stream, check=False)
    answers = iter(json.loads(verdicts.read_text()))
    worst = 0.0
    for asset in assets:
        for frame, answer in ((frame, next(answers)) for frame in asset.frames):
            verdict = answer["result"]
            if isinstance(verdict.get("max"), (int, float)) and verdict["pass"]:
                worst = max(worst, verdict["max"])
            if not verdict["pass"]:
                asset.faults.append(f"three.js, clip {frame['clip']} at {frame['time']}: {verdict.get('checks')} {verdict.get('notes')}")
    return len(jobs), worst


def sources_of(corpus):
    """By name: the source, and the poses that are expected of it, if anybody has said."""
    sources = {f"example {path.stem}": (path, None) for path in sorted((HERE.parent.parent / "examples").glob("*.glb"))}
    if corpus:
        manifest = json.loads((corpus / "visible" / "manifest.json").read_text(encoding="utf-8"))
        for entry in manifest["files"]:
            sources[entry["id"]] = (corpus / "visible" / entry["file"], corpus / entry["ref"] if entry.get("ref") else None)
    return sources


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bendy", required=True)
    parser.add_argument("--work", required=True, type=work_folder)
    parser.add_argument("--corpus", type=Path)
    parser.add_argument("--npm", default="npm")
    parser.add_argument("--only")
    options = parser.parse_args()
    work = options.work
    if not install(work, options.npm):
        print("npm ci failed: nobody was asked")
        return SKIPPED
    sources = sources_of(options.corpus and options.corpus.resolve())
    if options.only:
        sources = {name: source for name, source in sources.items() if name == options.only}
    shutil.rmtree(work / "files", ignore_errors=True)
    (work / "files").mkdir()
    bendy = os.path.abspath(options.bendy)
    with ThreadPoolExecutor(os.cpu_count()) as workers:
        assets = list(workers.map(lambda name: Asset(bendy, *sources[name], work / "files" / name), sources))
    exported = [asset for asset in assets if asset.glb]
    ask_witnesses(exported, work)
    frames, worst = compare_poses(exported, options.corpus.resolve(), work) if options.corpus else (0, 0.0)
    failed = [asset for asset in assets if asset.faults]
    for asset in failed:
        print(f"FAILED {asset.source}")
        for fault in asset.faults[:5]:
            print(f"    {fault}")
    named = [asset for asset in exported if asset.warnings]
    print(f"exported     {len(exported)} files, {len(named)} of them with warnings")
    print(f"poses        {frames} frames by three.js, worst error {worst:.2e} of the bounding-box diagonal (allowed: {TOLERANCE:.0e})")
    print(f"failed       {len(failed)}")
    if not failed:
        shutil.rmtree(work / "files")
    return 1 if failed or not exported else 0


if __name__ == "__main__":
    sys.exit(main())
