#!/usr/bin/env python3
"""Measures how far bones of standing bodies differ between rigs: bench/retarget/standing_bones.py [--bendy PROGRAM] FILE...

The files are humans of different makers, of any kind that the program converts. Of each pair of bodies, the angle between a
bone's directions is taken, in the axes of the bodies, in their standing poses. Prints for each bone the number of bodies and
the median, the 95th percentile and the largest angle. Files without a whole human are left out. Needs only Python 3.
"""

import argparse
import itertools
import math
import pathlib
import sys
import tempfile

import run

BONES = {
    "collarbone": ("leftShoulder", "leftUpperArm"), "foot": ("leftFoot", "leftToes"), "neck": ("neck", "head"),
    "spine to neck": ("spine", "neck"),
    **{f"{bone} to the next": (bone, None) for bone in ("spine", "chest", "upperChest")},
}
SPINE = ("spine", "chest", "upperChest", "neck", "head")


def times(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def rotated(q, v):
    return times(times(q, (*v, 0.0)), (-q[0], -q[1], -q[2], q[3]))[:3]


def less(a, b):
    return tuple(x - y for x, y in zip(a, b, strict=True))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v):
    length = math.sqrt(dot(v, v))
    return tuple(x / length for x in v) if length > 1e-6 else None


def places(document):
    """role -> place in the standing pose"""
    nodes = document["nodes"]
    told = document.get("extensions", {}).get("BENDY_standing_pose", {}).get("rotations", [])
    turned = {one["node"]: (*one["rotation"], math.sqrt(max(0.0, 1.0 - dot(one["rotation"], one["rotation"])))) for one in told}
    found = {}
    todo = [(root, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), 1.0) for scene in document["scenes"] for root in scene["nodes"]]
    while todo:
        number, place, turn, scale = todo.pop()
        node = nodes[number]
        place = tuple(a + scale * b for a, b in zip(place, rotated(turn, node.get("translation", (0, 0, 0))), strict=True))
        turn = turned.get(number) or times(turn, node.get("rotation", (0, 0, 0, 1)))
        scale *= node.get("scale", (1.0,))[0]
        if "BENDY_joint_role" in node.get("extensions", {}):
            found[node["extensions"]["BENDY_joint_role"]["role"]] = place
        todo += [(child, place, turn, scale) for child in node.get("children", [])]
    return found


def directions(place):
    """bone -> left, up, forward of its direction; empty unless all bones of a human are there"""
    if not {"head", "leftFoot", "rightFoot", "leftUpperLeg", "rightUpperLeg"} <= set(place):
        return {}
    up = unit(less(place["head"], tuple((a + b) / 2 for a, b in zip(place["leftFoot"], place["rightFoot"], strict=True))))
    axis = max(range(3), key=lambda k: abs(up[k]))
    if abs(up[axis]) > math.cos(math.radians(35)):
        up = tuple(math.copysign(float(k == axis), up[axis]) for k in range(3))
    across = less(place["leftUpperLeg"], place["rightUpperLeg"])
    left = unit(less(across, tuple(dot(across, up) * x for x in up)))
    axes = (left, up, cross(left, up))
    found = {}
    for bone, (begin, end) in BONES.items():
        if end is None and begin in SPINE:
            end = next((role for role in SPINE[SPINE.index(begin) + 1 :] if role in place), None)
        way = unit(less(place[end], place[begin])) if begin in place and end in place else None
        if way:
            found[bone] = tuple(dot(way, axis) for axis in axes)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bendy", default=run.HERE.parent.parent / "build/release/cli/bendy", type=pathlib.Path)
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    options = parser.parse_args()
    bodies = []
    with tempfile.TemporaryDirectory() as folder:
        bench = run.Bench(options.bendy.resolve(), [], pathlib.Path(folder), (), "off")
        whole, body = (bench.work / name for name in ("whole.bendy", "body.bendy"))
        for path in options.files:
            try:
                bench.run("convert", "-q", path, "-o", whole)
                bench.run("edit", "-q", whole, "-o", body, *run.SURFACE, "--strip", "clips")
            except RuntimeError as problem:
                print(f"{path}: {problem}", file=sys.stderr)
                continue
            document, _ = run.split_glb(pathlib.Path(bench.export(body)).read_bytes())
            if found := directions(places(document)):
                bodies.append(found)
    print("| bone | bodies | median | 95th percentile | largest |\n|---|---|---|---|---|")
    for bone in BONES:
        ways = [body[bone] for body in bodies if bone in body]
        angles = sorted(math.degrees(math.acos(max(-1.0, min(1.0, dot(a, b))))) for a, b in itertools.combinations(ways, 2))
        if angles:
            print(f"| {bone} | {len(ways)} | {angles[len(angles) // 2]:.0f} | {angles[int(0.95 * len(angles))]:.0f} | {angles[-1]:.0f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
