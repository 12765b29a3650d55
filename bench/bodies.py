#!/usr/bin/env python3
"""Judges what the converter finds out about bodies: python3 bodies.py FOLDER|MAKER=PATTERN...

FOLDER has clones of the repositories that bodies.json lists, called OWNER+NAME; those that are missing are said and left out.
PATTERN is a glob of files of one maker, as in "Quaternius=q/*.glb". An animal, a thing and a file without a skeleton count, too:
they must not get the roles of a human. Prints a table, in which bodies of one maker with the same numbers share a line:

- limbs: of the 12 joints of the limbs that have roles of a human, how many have names that say the same, and how many of these are
  on the side that their names say; a name that says nothing does not count. Joints of rigs that rigs.json lists are compared with
  what a person said there.
- stands: where the pose comes from, `rest` if it is the rest pose; degrees from upright of the trunk (hip joints to head) and of the
  legs (feet to hip joints); degrees about the vertical from +Z to where the body looks.

The packages bendy and numpy must be installed. Exits with 1 if a role or a side is wrong.
"""

import collections
import fnmatch
import glob
import hashlib
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import bendy
import numpy
from roles import BONES, expected

WORDS = {"upper_leg": r"thigh|up_?leg|upper_?leg|hip$|^leg_?(1|joint_?1)$", "lower_leg": r"knee|calf|shin|low(er)?_?leg|^leg$",
         "foot": r"foot|ankle|^leg_?joint_?[35]$", "upper_arm": r"upper_?arm|up_?arm|^arm$|shldr|^shoulder$",
         "lower_arm": r"fore_?arm|low(er)?_?arm|elbow", "hand": r"hand|wrist|palm"}
# The values of STND's evidence, in the order of spec/chunks/STND.md.
EVIDENCE = ("told", "bind matrices", "a clip", "rest, turned", "a T, assumed")
RIGS = {rig["sha256"]: rig for rig in json.loads(pathlib.Path(__file__).with_name("rigs.json").read_text(encoding="utf-8"))}


def plain(name):
    """The name in lower case without a prefix, numbers of copies and the side; and the side that it says."""
    name = re.sub(r"^.*:|^(DEF|ORG|J_Bip|CC_Base|Bip\d*|b|def)[-_ ]", "", name)
    name = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower()
    name = re.sub(r"^([lr])(?=(buttock|hip|knee|foot|shoulder|elbow|hand|thigh|shin|shldr|forearm)$)", r"\1_", name)
    parts = [part for part in re.split(r"[-_. ]+|(?<=l)(?=eft)\b", name) if part and not re.fullmatch(r"0\d+|c|bip|joint", part)]
    sides = {part[0] for part in parts if part in ("l", "r", "left", "right")}
    rest = "_".join(part for part in parts if part not in ("l", "r", "left", "right"))
    return rest, {"l": "left", "r": "right"}.get(sides.pop() if len(sides) == 1 else "", "")


def judged(roles, joints, rig):
    """Of the joints of the limbs: how many have roles, how many the right ones, how many the right sides; and what is wrong."""
    limbs = {role: name for role, name in roles.items() if role in BONES[3:]}
    right, sides, wrong = 0, 0, []
    wanted = expected(rig) if rig and rig["bones"] != "none" else None
    for role, name in limbs.items():
        side, part = role.split("_", 1)
        if wanted:
            is_right = is_side = wanted[role] in (name, f"#{joints[role]}")
        else:
            word, said = plain(name)
            says = [other for other, pattern in WORDS.items() if re.search(pattern, word)]
            if word == "leg" and f"{side}_lower_leg" not in limbs:
                says = ["upper_leg"]  # of a toy's leg, which is one joint
            is_right, is_side = part in says if says else None, said == side if said else None
        right += is_right is True
        sides += is_side is True
        wrong += [f"{role} is {name}"] if is_right is False or is_side is False else []
    return len(limbs), right, sides, wrong


def angle(way, towards):
    return math.degrees(math.acos(numpy.clip(way @ towards / numpy.linalg.norm(way), -1, 1)))


def stand(model, joints):
    """Degrees from upright of trunk and legs, and from +Z to the front; nothing without legs and a head."""
    places = model.pose().stand().matrices[:, :3, 3]
    at = {role: places[number] for role, number in joints.items()}
    between = lambda part: 0.5 * (at[f"left_{part}"] + at[f"right_{part}"])  # noqa: E731
    if not {"head", "left_upper_leg", "right_upper_leg", "left_lower_leg", "right_lower_leg"} <= at.keys():
        return None
    tops, feet = between("upper_leg"), between("foot" if {"left_foot", "right_foot"} <= at.keys() else "lower_leg")
    up = numpy.array([0, 1, 0])
    left = at["left_upper_leg"] - at["right_upper_leg"]
    return angle(at["head"] - tops, up), angle(tops - feet, up), math.degrees(math.atan2(-left[2], left[0]))


def line_of(path):
    """The cells of a body's line from the third on, and what is wrong."""
    made = bendy.convert(path)
    model = made.open()
    joints = {joint.role: joint.number for joint in model.joints if joint.role != "none" and joint.role_place == 0}
    roles = {role: model.joints[number].name for role, number in joints.items()}
    rig = RIGS.get(hashlib.sha256(path.read_bytes()).hexdigest())
    limbs, right, sides, wrong = judged(roles, joints, rig)
    if not limbs:
        return ("animal" if roles else "none", *[""] * 6), wrong
    if rig and rig["bones"] == "none":
        wrong.append("it is not human")
    found = stand(model, joints)
    records = [chunk for chunk in bendy.inspect(made).walk() if chunk.id == "STND"]
    pose = EVIDENCE[records[0].fields["evidence"]] if records else "rest"
    angles = [f"{round(number) or 0}" for number in found] if found else [""] * 3
    return (limbs, right, sides, pose, *angles), wrong


def show(clone, commit, path):
    """A file's bytes; none where the clone lacks them, as of files that Git LFS keeps."""
    return subprocess.run(["git", "-C", clone, "show", f"{commit}:{path}"], capture_output=True, check=False).stdout


def listed(clones):
    """The files that bodies.json lists, with their makers, each while it is asked for."""
    for entry in json.loads(pathlib.Path(__file__).with_suffix(".json").read_text(encoding="utf-8")):
        name, commit = entry["source"].removeprefix("github:").split("@")
        clone = clones / name.replace("/", "+")
        if not clone.exists():
            print(f"{name} is not there", file=sys.stderr)
            continue
        tree = subprocess.run(["git", "-C", clone, "ls-tree", "-rz", "--name-only", commit], capture_output=True, text=True, check=True)
        for path in tree.stdout.split("\0"):
            if not any(fnmatch.fnmatchcase(path, pattern) for pattern in entry["paths"]):
                continue
            with tempfile.TemporaryDirectory() as folder:
                data = show(clone, commit, path)
                file = pathlib.Path(folder, pathlib.Path(path).name)
                file.write_bytes(data)
                if file.suffix == ".gltf":  # the files beside it
                    document = json.loads(data)
                    for uri in (one.get("uri", "data:") for one in document.get("buffers", []) + document.get("images", [])):
                        if not uri.startswith("data:"):
                            file.with_name(uri).write_bytes(show(clone, commit, f"{path.rpartition('/')[0]}/{uri}"))
                    file = file.rename(file.with_name(f"{path.split('/')[-2]}.gltf")) if file.stem == "model" else file
                if data:
                    yield entry["maker"], file


def files_of(arguments):
    for argument in arguments:
        if "=" not in argument:
            yield from listed(pathlib.Path(argument))
            continue
        maker, pattern = argument.split("=", 1)
        for path in sorted(glob.glob(pattern)):
            yield maker, pathlib.Path(path)


def main(arguments):
    makers, faults, lines = collections.Counter(), [], {}
    for maker, path in files_of(arguments):
        cells, wrong = line_of(path)
        lines.setdefault((maker, cells), []).append(path.name)
        makers[maker] += 1
        faults += [f"{path.name}: {fault}" for fault in wrong]
    print("| body | maker | limbs | right | sides | stands in | trunk | legs | looks |\n|---|---|---|---|---|---|---|---|---|")
    for (maker, cells), names in lines.items():
        more = f" and {len(names) - 1} more" if len(names) > 1 else ""
        print(f"| {names[0]}{more} | {maker} | {' | '.join(map(str, cells))} |")
    print(*faults, f"\n{sum(makers.values())} bodies of {len(makers)} makers, {len(faults)} faults", sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
