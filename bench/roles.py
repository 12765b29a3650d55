#!/usr/bin/env python3
"""Judges the roles that the converter finds: python3 roles.py BENDY RIGS.json FOLDER

RIGS.json lists rigs with what a person says: the joints of the 15 bones that VRM requires, in the order of BONES, those of
the right side with `right` in place of `left`; or "none": the converter must say nothing, or no human. FOLDER holds their
files. One line for each rig; exit 1 if a bone is wrong. Files with another digest are refused. Needs only Python 3.
"""

import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile

LIMBS = ("upper_leg", "lower_leg", "foot", "upper_arm", "lower_arm", "hand")
BONES = ("hips", "spine", "head", *(f"{side}_{bone}" for side in ("left", "right") for bone in LIMBS))


def expected(rig):
    """role -> joint, from the list of the middle and left joints and the words of the sides"""
    middle, left = rig["bones"][:3], rig["bones"][3:]
    before, after = rig.get("sides", ["", ""])
    right = rig.get("right") or [name.replace(before, after) for name in left]
    return dict(zip(BONES, [*middle, *left, *right], strict=True))


def found(bendy, path):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder, "out.bendy")
        subprocess.run([bendy, "convert", path, "-o", out], check=True, capture_output=True)
        return json.loads(subprocess.run([bendy, "rig", out], check=True, capture_output=True).stdout).get("roles", {})


def main(bendy, rigs, folder):
    wrong = right = 0
    print("| rig | joints asked for | right | other roles |\n|---|---|---|---|")
    for rig in json.loads(pathlib.Path(rigs).read_text(encoding="utf-8")):
        path = pathlib.Path(folder, rig["file"])
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        if digest != rig["sha256"]:
            sys.exit(f"{path}: its sha256 is {digest}, expected {rig['sha256']}")
        roles = found(bendy, path)
        wanted = {} if rig["bones"] == "none" else expected(rig)
        faults = [f"{role} is {roles.get(role)}, not {joint}" for role, joint in wanted.items() if roles.get(role) != joint]
        if not wanted:
            faults = [f"{role} is {roles[role]}" for role in BONES[3:] if role in roles]
        wrong += len(faults)
        right += len(wanted) - len(faults) if wanted else 0
        print(f"| {rig['file']} | {len(wanted)} | {len(wanted) - len(faults) if wanted else 'none' if not faults else 'human!'} | "
              f"{len(set(roles) - set(wanted))} |" + "".join(f"\n  {fault}" for fault in faults))
    print(f"\n{right} bones right, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
