#!/usr/bin/env python3
"""Judges retargeting from odd rest poses.

    bench/retarget/odd_rests.py --chars FOLDER... [--bendy PROGRAM] [--work FOLDER] [--from NAME...] [--to NAME...] [--json FILE]

The folders have the files that bench/rigs.json lists. Clips of SOURCES are told from each of RESTS by turn_rests.mjs, which is
the bench's own; the program has to find out what stands. They are put on BODIES without limits and planting, and compare.mjs
compares the directions of bones with those of the control: the same motion from the ordinary rest pose on the same body. Bones
whose rest directions say nothing take the source's directions instead, so there is a second figure: off the control or the
source, whichever is less. Files that have an odd rest pose, "odd_rest" in the list, are compared with themselves at the rest pose
of another file of the maker, if the list names one; if not, their limbs are compared with the source's. Prints a table: of all
bodies the worst.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import run

SOURCES = ("mannequin", "Xbot", "cmu_12_01_walk", "jumping")
BODIES = ("mannequin", "k_Knight", "m2m_human-sintel", "robot", "01_03", "cryptovoxels")
RESTS = ("collarbones_up", "feet_down", "spine_bent", "lies", "along_x", "in_clip")
WANTED = 3.0  # degrees


def told(bench, source, rest):
    """A bendy file of the source's clips as told from another rest pose; None if the source lacks the bones."""
    moved = bench.work / f"{source['name']}_{pathlib.Path(rest).stem}.odd.glb"
    moved.unlink(missing_ok=True)
    subprocess.run(["node", "turn_rests.mjs", source["export"], rest, moved.name], cwd=bench.work, check=True, stdout=subprocess.DEVNULL)
    if not moved.exists():
        return None
    bench.run("convert", "-q", moved, "-o", moved.with_suffix(".bendy"))
    return moved.with_suffix(".bendy")


def tell(bench, source, rigs):
    """The source's motion, by names of rest poses; "control" is the ordinary one, if that is known."""
    if "odd_rest" not in source["rig"]:
        made = {rest: told(bench, source, rest) for rest in RESTS}
        return {"control": told(bench, source, "as_is"), **{rest: path for rest, path in made.items() if path}}
    if not source["rig"]["odd_rest"]:
        return {"own": source["source"]}
    other = bench.find(rigs[pathlib.Path(source["rig"]["odd_rest"]).stem])
    stands, own = (bench.work / f"{source['name']}_{kind}.bendy" for kind in ("other", "told"))
    bench.run("convert", "-q", other, "-o", stands)
    bench.run("edit", "-q", source["source"], "-o", own, "--stand-as", stands)
    return {"control": told(bench, source, str(other)), "own": source["source"], "--stand-as": own}


def job_of(bench, source, body, made):
    """The job for compare.mjs: the clip from each rest pose on one body."""
    files = {}
    for rest, path in made.items():
        out = bench.work / f"{path.stem}_on_{body['name']}.bendy"
        bench.run("edit", "-q", body["target"], "-o", out, "--retarget", f"{path}:{source['rig']['clips'][0]}", *run.FREE)
        files[rest] = bench.export(out)
        out.unlink()
    return {"name": source["name"], "body": body["name"], "source": source["export"], "clip": source["rig"]["clips"][0],
            "control": files.pop("control", None), "others": files}


def compared(jobs, work):
    path = work / "odd_jobs.json"
    path.write_text(json.dumps(jobs))
    result = subprocess.run(["node", "compare.mjs", path.name], cwd=work, check=True, stdout=subprocess.PIPE, text=True)
    return [{**job, "found": json.loads(line)} for job, line in zip(jobs, result.stdout.splitlines(), strict=True)]


def row(lines, rest):
    """The worst of all bodies."""
    found = {line["body"]: line["found"][rest] for line in lines}
    cells = []
    for figures in (found, {body: one["either"] for body, one in found.items()}):
        body = max(figures, key=lambda name: figures[name]["most"])
        worst = figures[body]
        within = sum(one["most"] <= WANTED for one in figures.values())
        cells.append(f"{worst['most']:7.2f} {max(one['p99'] for one in figures.values()):7.2f} {within}/{len(figures)} "
                     + f"{body}, {worst['bone']} {worst['at']:.2f}".ljust(54))
    return " ".join([f"{lines[0]['name']} {rest}".ljust(44), *cells])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--chars", required=True, nargs="+", type=pathlib.Path)
    parser.add_argument("--bendy", default=run.HERE.parent.parent / "build/release/cli/bendy", type=pathlib.Path)
    parser.add_argument("--work", default="build/bench-odd-rests", type=run.work_folder)
    parser.add_argument("--from", dest="sources", nargs="+", help="instead of SOURCES and the files with odd rest poses")
    parser.add_argument("--to", dest="bodies", nargs="+", default=BODIES)
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    bench = run.Bench(options.bendy.resolve(), [*options.chars, run.HERE.parent.parent / "examples"], options.work, (), "off")
    run.install(bench.work)
    rigs = {pathlib.Path(rig["file"]).stem: rig for rig in json.loads(run.RIGS.read_text(encoding="utf-8"))}
    chosen = options.sources or [*SOURCES, *(name for name, rig in rigs.items() if "odd_rest" in rig)]
    with ThreadPoolExecutor(os.cpu_count()) as workers:
        names = list(dict.fromkeys([*chosen, *options.bodies]))
        prepared = dict(zip(names, workers.map(bench.prepare, [rigs[name] for name in names]), strict=True))
        made = dict(zip(chosen, workers.map(lambda name: tell(bench, prepared[name], rigs), chosen), strict=True))
        pairs = [(source, body) for source in chosen for body in options.bodies]
        jobs = list(workers.map(lambda pair: job_of(bench, prepared[pair[0]], prepared[pair[1]], made[pair[0]]), pairs))
    lines = compared(jobs, bench.work)
    if options.json:
        options.json.write_text(json.dumps(lines, indent=1))
    head = ["off the control: most, p99, bodies within 3".ljust(76), "off the control or the source"]
    print(" ".join(["".ljust(44), *head]))
    for source in chosen:
        own = [line for line in lines if line["name"] == source]
        for rest in own[0]["found"]:
            print(row(own, rest))
    return 0


if __name__ == "__main__":
    sys.exit(main())
