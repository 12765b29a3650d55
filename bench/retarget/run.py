#!/usr/bin/env python3
"""Judges retargeting on characters of other makers, each to each.

    bench/retarget/run.py --chars FOLDER... [--bendy PROGRAM] [--work FOLDER] [--from PART] [--to PART] [--kind KIND]
        [--no-limits] [--json FILE]

The folders have the files that bench/rigs.json lists, by source, commit, digest and licence. Each that has "clips" there is
converted with --auto-rig, or without limits; the clips that the list names are put on each other rig of its kind by
`bendy edit --retarget`, as usual and without limits and planting, and from there back; `bendy export` writes all of it as glTF,
and judge.mjs judges that with three.js. Prints tables; --json also writes the figures.
"""

import argparse
import hashlib
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parents[1] / "scripts"))
from own_folder import work_folder  # noqa: E402

RIGS = HERE.parent / "rigs.json"
FREE = ("--limits", "off", "--free-feet")
SURFACE = ("--strip", "meshes", "--strip", "textures", "--strip", "materials")


class Bench:
    def __init__(self, bendy, folders, work, rigging, limits):
        self.bendy, self.folders, self.work, self.rigging, self.limits = bendy, folders, work, rigging, limits

    def run(self, *arguments):
        result = subprocess.run([self.bendy, *map(str, arguments)], capture_output=True, text=True, check=False)
        if result.returncode != 0:
            raise RuntimeError(result.stderr.strip())
        return result.stdout + result.stderr

    def export(self, path):
        self.run("export", "-q", path, "-o", path.with_suffix(".glb"))
        return str(path.with_suffix(".glb"))

    def find(self, rig):
        """The rig's file, checked."""
        path = next((folder / rig["file"] for folder in self.folders if (folder / rig["file"]).exists()), None)
        if not path:
            sys.exit(f"{rig['file']} of {rig['source']} is in none of {', '.join(map(str, self.folders))}")
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        if digest != rig["sha256"]:
            sys.exit(f"{path}: its sha256 is {digest}, expected {rig['sha256']}")
        return path

    def prepare(self, rig):
        """The rig's file; a bendy file of its joints, one with its clips, and one with them as glTF."""
        path = self.find(rig)
        name = path.stem
        whole, target, source = (self.work / f"{name}.{kind}.bendy" for kind in ("whole", "target", "source"))
        self.run("convert", "-q", *self.rigging, path, "-o", whole)
        self.run("edit", "-q", whole, "-o", target, *SURFACE, "--strip", "clips")
        made = {"name": name, "rig": rig, "original": str(path), "target": target}
        if rig.get("clips"):
            self.run("edit", "-q", whole, "-o", source, *SURFACE, *(f"--keep-clip={clip}" for clip in rig["clips"]))
            made |= {"source": source, "export": self.export(source)}
            if path.suffix == ".bvh":
                made["original"] = made["export"]
        return made

    def retarget(self, source, target):
        """Jobs for the judge: one for each clip."""
        stem = self.work / f"{source['name']}_on_{target['name']}"
        full, free, back = (stem.with_suffix(f".{kind}.bendy") for kind in ("full", "free", "back"))
        said = self.run("edit", target["target"], "-o", full, "--retarget", source["source"], "--limits", self.limits, "--rests-measured")
        self.run("edit", "-q", target["target"], "-o", free, "--retarget", source["source"], *FREE, "--rests-measured")
        self.run("edit", "-q", source["target"], "-o", back, "--retarget", full, *FREE, "--rests-measured")
        files = {"full": self.export(full), "free": self.export(free), "back": self.export(back)}
        for path in (full, free, back):
            path.unlink()
        held = dict(re.findall(r'retargeted clip "(.*?)":.*?limits acted in (\d+ of \d+) frame', said))
        return [{"pair": f"{source['name']} > {target['name']}", "kind": kind_of(target["rig"]), "clip": clip,
                 "source": source["original"], "roles": source["export"],
                 "stands": {"from": stands_as(source), "to": stands_as(target)}, "acted": held.get(clip, ""),
                 "held_out": bool(source["rig"].get("held_out") or target["rig"].get("held_out")), **files}
                for clip in source["rig"]["clips"]]

    def beside_vrm(self, source, target):
        """A clip as a VRM animation on a VRM avatar: how far Bendy is from three-vrm-animation. Only bones of both count: it
        leaves out turns of others, whereas Bendy gives them to the next bone."""
        motion, made, exported = (self.work / f"vrm.{suffix}" for suffix in ("vrma", "bendy", "glb"))
        text, rest = split_glb(pathlib.Path(source["export"]).read_bytes())
        have = {bone["bone"] for bone in split_glb(pathlib.Path(target["original"]).read_bytes())[0]["extensions"]["VRM"]["humanoid"]["humanBones"]}
        roles = {node["extensions"]["BENDY_joint_role"]["role"]: k for k, node in enumerate(text["nodes"])
                 if "BENDY_joint_role" in node.get("extensions", {})}
        roles = {role: k for role, k in roles.items() if role in have and "Thumb" not in role}  # VRM 0 calls thumbs otherwise
        text["extensionsUsed"] = ["VRMC_vrm_animation"]
        text["extensions"] = {"VRMC_vrm_animation": {"specVersion": "1.0", "humanoid": {
            "humanBones": {role: {"node": k} for role, k in roles.items()}}}}
        for node in text["nodes"]:
            node.pop("extensions", None)
        for clip in text["animations"]:
            clip["channels"] = [c for c in clip["channels"] if c["target"]["node"] in roles.values() and (
                c["target"]["path"] == "rotation" or (c["target"]["path"] == "translation" and c["target"]["node"] == roles["hips"]))]
        motion.write_bytes(join_glb(text, rest))
        self.run("edit", "-q", target["target"], "-o", made, "--retarget", f"{motion}:#0", "--rests-alike", *FREE)
        self.run("export", "-q", made, "-o", exported)
        result = subprocess.run(["node", "vrm.mjs", target["original"], motion.name, exported.name], cwd=self.work, check=True,
                                capture_output=True, text=True)
        for path in (motion, made, exported):
            path.unlink()
        return json.loads(result.stdout)

    def own(self, rig):
        """Whether a rig's own clips come back as the same bytes, but for contact curves."""
        again = self.work / f"{rig['name']}.again.bendy"
        self.run("edit", "-q", rig["target"], "-o", again, "--retarget", rig["source"], "--limits", "off")
        result = subprocess.run([self.bendy, "diff", rig["source"], again], capture_output=True, text=True, check=False)
        again.unlink()
        return [line for line in result.stdout.splitlines() if line.startswith(("+", "-", "~")) and "/CURV" not in line]


def stands_as(made):
    """The file whose skins are bound to the pose in which a rig stands; None if it stands at rest."""
    return made["original"] if made["rig"].get("stands_as_bound") else None


def kind_of(rig):
    return rig.get("kind", "human")


def split_glb(data):
    size = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + size]), data[20 + size :]


def join_glb(document, rest):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest


def install(work):
    """the judge, three.js and three-vrm-animation"""
    for path in HERE.glob("*.*js*"):
        shutil.copy(path, work / path.name)
    if not (work / "node_modules" / "@pixiv").exists():
        subprocess.run(["npm", "ci", "--no-audit", "--no-fund", "--ignore-scripts"], cwd=work, check=True, stdout=subprocess.DEVNULL)


def judged(jobs, work):
    """The judge's figures for each job, by as many judges as there are processors."""
    parts = [jobs[k::os.cpu_count()] for k in range(os.cpu_count())]

    def ask(number):
        path = work / f"jobs{number}.json"
        path.write_text(json.dumps(parts[number]))
        result = subprocess.run(["node", "judge.mjs", path.name], cwd=work, check=True, capture_output=True, text=True)
        return [json.loads(line) for line in result.stdout.splitlines()]

    with ThreadPoolExecutor(len(parts)) as workers:
        answers = list(workers.map(ask, range(len(parts))))
    return [{**job, **answer} for part, lines in zip(parts, answers, strict=True) for job, answer in zip(part, lines, strict=True)]


def added(lines, name):
    """The sums of several clips as one."""
    sums = [line[name] for line in lines if name in line]
    worst = max(sums, key=lambda one: one["most"], default={"most": 0.0, "at": None})
    count = sum(one["count"] for one in sums)
    return {"mean": sum(one["total"] for one in sums) / max(count, 1), "most": worst["most"], "at": worst.get("at"),
            "rms": (sum(one["squares"] for one in sums) / max(count, 1)) ** 0.5, "count": count}


COLUMNS = {
    "free dir": ("freeDirection", "most"), "twist": ("freeTwist", "most"), "dir": ("untouchedDirection", "most"),
    "twist ": ("untouchedTwist", "most"), "mean dir": ("fullDirection", "mean"), "lim %": ("limited", "mean"),
    "viol": ("violated", "most"), "slide0": ("sourceSlide", "mean"), "slide": ("slide", "mean"), "height": ("height", "most"),
    "flip": ("flip", "most"), "back": ("returned", "rms"), "foot": ("footMissed", "most"), "hand": ("handMissed", "most"),
}


def row(name, lines):
    cells = []
    for title, (figure, kind) in COLUMNS.items():
        number = added(lines, figure)[kind] * (100 if title == "lim %" else 1)
        cells.append(f"{number:9.2g}" if title == "viol" else f"{number:9.3f}")
    return f"{name:44} " + " ".join(cells)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--chars", required=True, nargs="+", type=pathlib.Path)
    parser.add_argument("--bendy", default=HERE.parent.parent / "build/release/cli/bendy", type=pathlib.Path)
    parser.add_argument("--work", default="build/bench-retarget", type=work_folder)
    parser.add_argument("--from", dest="source", default="")
    parser.add_argument("--to", dest="target", default="")
    parser.add_argument("--kind", choices=("human", "quadruped", "bird"))
    parser.add_argument("--no-limits", action="store_true")
    parser.add_argument("--limits", choices=("soft", "hard"), default="hard", help="of `bendy edit --retarget`")
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    bench = Bench(options.bendy.resolve(), [*options.chars, HERE.parent.parent / "examples"], options.work,
                  () if options.no_limits else ("--auto-rig",), options.limits)
    install(bench.work)
    listed = [rig for rig in json.loads(RIGS.read_text(encoding="utf-8")) if "clips" in rig
              and "odd_rest" not in rig and options.kind in (None, kind_of(rig))]
    with ThreadPoolExecutor(os.cpu_count()) as workers:
        rigs = list(workers.map(bench.prepare, listed))
        pairs = [(a, b) for a in rigs for b in rigs if "source" in a and a is not b and b["rig"].get("target", True)
                 and kind_of(a["rig"]) == kind_of(b["rig"]) and options.source in a["name"] and options.target in b["name"]]
        jobs = [job for made in workers.map(lambda pair: bench.retarget(*pair), pairs) for job in made]
        own = dict(zip([rig["name"] for rig in rigs if "source" in rig],
                       workers.map(bench.own, [rig for rig in rigs if "source" in rig])))
    lines = judged(jobs, bench.work)
    failed = [line for line in lines if "failed" in line]
    lines = [line for line in lines if "failed" not in line]
    if options.json:
        options.json.write_text(json.dumps(lines, indent=1))
    print(f"{'':44} " + " ".join(f"{title:>9}" for title in COLUMNS))
    for name in dict.fromkeys(line["pair"] for line in lines):
        print(row(name, [line for line in lines if line["pair"] == name]))
    for kind in dict.fromkeys(line["kind"] for line in lines):
        print(row(f"{kind}, held-out pairs", [line for line in lines if line["held_out"] and line["kind"] == kind]))
        print(row(f"{kind}, all", [line for line in lines if line["kind"] == kind]))
    for line in failed:
        print(f"FAILED {line['pair']} {line['clip']}: {line['failed']}")
    for name, other in own.items():
        print(f"{name} on itself: " + ("the same" if not other else f"differs: {other[:3]}"))
    for target in (rig for rig in rigs if rig["original"].endswith(".vrm")):
        for source in (rig for rig in rigs if rig["rig"].get("rests_in_t")):
            print(f"{source['name']} as a VRM animation > {target['name']}: {bench.beside_vrm(source, target)}")
    print(f"{len(rigs)} rigs, {len(dict.fromkeys(line['pair'] for line in lines))} pairs, {len(lines)} clips, "
          f"{sum(line['seconds'] for line in lines):.0f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
