#!/usr/bin/env python3
"""Makes the small files of this folder: good files of every kind, for the tests that damage them.

    make_seeds.py --bendy PROGRAM [--out FOLDER]

They are committed, and made again only where a kind is added: what the converter writes may change, what it has written
stays good. Their sources, and how each is converted, are of use by themselves: see tests/determinism.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parent.parent / "cli"))
from chunk_file import Chunk  # noqa: E402
from gltf_file import GltfFile  # noqa: E402

QUARTER = 0.5 ** 0.5
TURNS = [(0, 0, 0, 1), (0, 0, QUARTER, QUARTER), (0.6, 0, 0, 0.8), (0, 0.28, 0, 0.96), (0.48, 0.6, 0, 0.64)]
IMAGE = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="


def rope(path, joints=4, rings=4, keys=4, step=1):
    """A skinned tube of three-sided rings, and two clips. Of its vertices, neighbours in the tube are `step` apart."""
    file = GltfFile(scenes=[{"nodes": [joints, 0]}])
    file.document["nodes"] = [
        {"name": f"bone{k}", "translation": [0, 0.5 if k else 0, 0], **({"children": [k + 1]} if k + 1 < joints else {})}
        for k in range(joints)] + [{"mesh": 0, "skin": 0}]
    corners, normals, bones, weights = [], [], [], []
    for ring in range(rings):
        along = ring * (joints - 1) / (rings - 1)
        lower = min(int(along), joints - 2)
        for x, z in ((0.1, 0), (-0.05, 0.075), (-0.05, -0.075)):
            corners.append((x, along * 0.5, z))
            normals.append((1.0 if x > 0 else -0.6, 0.0, 0.0 if x > 0 else (0.8 if z > 0 else -0.8)))
            bones.append((lower, lower + 1, 0, 0))
            weights.append((1 - (along - lower), along - lower, 0, 0))
    triangles = []
    for ring in range(rings - 1):
        for side in range(3):
            a, b = ring * 3 + side, ring * 3 + (side + 1) % 3
            triangles += [(a,), (b,), (a + 3,), (b,), (b + 3,), (a + 3,)]
    number = [vertex * step % len(corners) for vertex in range(len(corners))]
    order = sorted(range(len(corners)), key=number.__getitem__)
    corners, normals, bones, weights = ([stream[k] for k in order] for stream in (corners, normals, bones, weights))
    triangles = [(number[vertex],) for vertex, in triangles]
    inverse = [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.5 * k, 0, 1) for k in range(joints)]
    attributes = {"POSITION": file.add(corners, "VEC3"), "NORMAL": file.add(normals, "VEC3"),
                  "JOINTS_0": file.add(bones, "VEC4", 5121), "WEIGHTS_0": file.add(weights, "VEC4")}
    file.document["meshes"] = [{"name": "skin", "primitives": [
        {"attributes": attributes, "indices": file.add(triangles, "SCALAR", 5123), "material": 0}]}]
    file.document["materials"] = [{"name": "grey", "pbrMetallicRoughness": {"metallicFactor": 0.5}}]
    file.document["skins"] = [{"joints": list(range(joints)), "inverseBindMatrices": file.add(inverse, "MAT4")}]
    times = file.add([(k / 8,) for k in range(keys)], "SCALAR")
    two_times = file.add([(0.25,), (1.0,)], "SCALAR")
    turns = file.add([TURNS[k % len(TURNS)] for k in range(keys)], "VEC4")
    moves = file.add([(0, k / 16, -k / 32) for k in range(keys)], "VEC3")
    cubic = file.add([(0, 0, 0, 0), TURNS[1], (0, 0, 0.5, 0), (0, 0.5, 0, 0), TURNS[2], (0, 0, 0, 0)], "VEC4")
    sizes = file.add([(1, 1, 1), (1, 1.5, 1)], "VEC3")
    file.document["animations"] = [
        {"name": "wave", "samplers": [{"input": times, "output": turns}, {"input": times, "output": moves}],
         "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}},
                      {"sampler": 1, "target": {"node": 0, "path": "translation"}}]},
        {"name": "bend",
         "samplers": [{"input": two_times, "output": cubic, "interpolation": "CUBICSPLINE"},
                      {"input": two_times, "output": sizes, "interpolation": "STEP"}],
         "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}},
                      {"sampler": 1, "target": {"node": 1, "path": "scale"}}]}]
    return file.write(path)


def plate(path):
    """A plate of nine vertices with three targets, one of them sparse by its content, and their weights moving."""
    file = GltfFile(scenes=[{"nodes": [0]}], nodes=[{"name": "plate", "mesh": 0}])
    corners = [(x / 2, 0, z / 2) for z in range(3) for x in range(3)]
    triangles = [(at,) for z in range(2) for x in range(2)
                 for at in (z * 3 + x, z * 3 + x + 1, z * 3 + x + 3, z * 3 + x + 1, z * 3 + x + 4, z * 3 + x + 3)]
    raised = [(0, (at % 4) / 8, 0) for at in range(9)]
    sparse = [(0, 0.25, 0) if at == 4 else (0, 0, 0) for at in range(9)]
    tilted = [(0.25, 0, 0)] * 9
    uvs = [(x / 2, z / 2) for z in range(3) for x in range(3)]
    normals = file.add([(0, 1, 0)] * 9, "VEC3")
    file.document["meshes"] = [{
        "name": "plate", "weights": [0, 0.5, 0], "extras": {"targetNames": ["wave", "dot", "slide"]},
        "primitives": [{"attributes": {"POSITION": file.add(corners, "VEC3"), "NORMAL": normals,
                                       "TEXCOORD_0": file.add(uvs, "VEC2")},
                        "indices": file.add(triangles, "SCALAR", 5121),
                        "targets": [{"POSITION": file.add(raised, "VEC3"), "NORMAL": file.add(tilted, "VEC3")},
                                    {"POSITION": file.add(sparse, "VEC3")},
                                    {"POSITION": file.add(tilted, "VEC3")}]}]}]
    times = file.add([(0,), (0.5,), (1,)], "SCALAR")
    weights = file.add([(0,), (0.5,), (0,), (1,), (0,), (0.25,), (0,), (1,), (1,)], "SCALAR")
    file.document["animations"] = [{"name": "talk", "samplers": [{"input": times, "output": weights}],
                                    "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}]
    return file.write(path)


def robot(path):
    """Rigid parts, one of them mirrored, lines and points, materials with textures."""
    file = GltfFile(
        scenes=[{"nodes": [0]}],
        nodes=[{"name": "body", "mesh": 0, "children": [1, 2]},
               {"name": "arm.L", "mesh": 1, "translation": [0.5, 1, 0], "rotation": list(TURNS[2])},
               {"name": "arm.R", "mesh": 1, "translation": [-0.5, 1, 0], "scale": [-1, 1, 1], "extras": {"side": 2}}],
        images=[{"uri": IMAGE, "name": "dot"}], samplers=[{"wrapS": 33648, "magFilter": 9728}],
        textures=[{"source": 0, "sampler": 0}],
        materials=[{"name": "metal", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "alphaMode": "MASK",
                    "alphaCutoff": 0.25},
                   {"name": "glow", "emissiveFactor": [1, 0.5, 0], "doubleSided": True, "extras": [1, 2]}])
    corners = file.add([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], "VEC3")
    uvs = file.add([(0, 0), (1, 0), (0, 1), (1, 1)], "VEC2")
    colours = file.add([(255, 0, 0, 255), (0, 255, 0, 255), (0, 0, 255, 255), (51, 51, 51, 255)], "VEC4", 5121)
    file.document["accessors"][colours]["normalized"] = True
    square = file.add([(0,), (1,), (2,), (2,), (1,), (3,)], "SCALAR", 5121)
    line = file.add([(0,), (3,)], "SCALAR", 5121)
    file.document["meshes"] = [
        {"name": "body", "primitives": [
            {"attributes": {"POSITION": corners, "TEXCOORD_0": uvs, "COLOR_0": colours}, "indices": square,
             "material": 0},
            {"attributes": {"POSITION": corners}, "indices": line, "mode": 1}]},
        {"name": "arm", "primitives": [{"attributes": {"POSITION": corners, "TEXCOORD_0": uvs}, "indices": square,
                                        "material": 1}]}]
    times = file.add([(0,), (1,)], "SCALAR")
    moves = file.add([(0.5, 1, 0), (0.5, 2, 0)], "VEC3")
    file.document["animations"] = [{"name": "lift", "samplers": [{"input": times, "output": moves}],
                                    "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]}]
    return file.write(path)


def rig(path):
    """Constraints and chains for the rope."""
    path.write_text("""{
  "bendy_rig": 1,
  "joints": {
    "bone1": {"model": "euler_box", "x": [-45, 45], "y": [-10, 10], "z": [-90, 90]},
    "bone2": [{"model": "hinge", "x": [0, 120]},
              {"model": "swing_twist_ellipse", "scope": "ik_only", "x": [-30, 30], "y": [-20, 20], "z": [-25, 25]}],
    "bone3": {"model": "largest_angle", "angle": 30}
  },
  "chains": [
    {"name": "all", "start": "bone0", "effector": "bone3"},
    {"name": "tip", "start": "bone2", "effector": "bone3", "solver": "fabrik", "weights": {"bone3": 0.5}}
  ]
}
""", encoding="utf-8")
    return path


def make_sources(folder):
    """The sources by name, in `folder`."""
    return {"rope": rope(folder / "rope.gltf"), "plate": plate(folder / "plate.gltf"),
            "robot": robot(folder / "robot.gltf"),
            "long": rope(folder / "long.gltf", joints=3, rings=3, keys=40),
            "tangle": rope(folder / "tangle.gltf", joints=10, rings=8, step=7),
            "chain": rope(folder / "chain.gltf", joints=10, rings=2, keys=2),
            "rig": rig(folder / "rig.json")}


def conversions(sources):
    """Each seed's name with its source and options."""
    rigged = ["--rig", str(sources["rig"])]
    return {
        "rope": ("rope", []), "rope_compact": ("rope", ["--compact"]), "rope_lod": ("rope", ["--lod"]),
        "rope_compact_lod": ("rope", ["--compact", "--lod"]),
        "rope_rigged": ("rope", rigged), "rope_rigged_compact": ("rope", [*rigged, "--max-error", "1mm"]),
        "plate": ("plate", []), "plate_compact": ("plate", ["--compact"]), "plate_lod": ("plate", ["--lod"]),
        "robot": ("robot", []), "robot_compact": ("robot", ["--compact"]),
        "long_compact": ("long", ["--compact"]), "long_exact": ("long", []),
        "chain_compact": ("chain", ["--compact"]),
        "tangle": ("tangle", []), "tangle_kept": ("tangle", ["--keep-order"]),
    }


def two_objects(one, other):
    """A file with the objects of two files without materials and textures of their own."""
    first, second = Chunk.read(one), Chunk.read(other)
    first.children.append(next(chunk for chunk in second.children if chunk.letters == "OBJE"))
    version, added = bytearray(first.children[0].payload), second.children[0].payload
    for at, size in ((12, 4), (16, 4), (20, 4), (24, 8), (32, 4), (36, 4)):
        total = sum(int.from_bytes(bytes(part[at:at + size]), "little") for part in (version, added))
        version[at:at + size] = total.to_bytes(size, "little")
    first.children[0].payload = bytes(version)
    return first.write()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bendy", required=True)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        sources = make_sources(Path(folder))
        for name, (source, options) in conversions(sources).items():
            subprocess.run([arguments.bendy, "convert", "-q", sources[source], "-o", arguments.out / f"{name}.bendy",
                            *options], check=True)
        for name in ("rope", "plate", "robot"):  # for tests of the converter
            (arguments.out / f"{name}.gltf").write_bytes(sources[name].read_bytes())
        (arguments.out / "rope.rig.json").write_bytes(sources["rig"].read_bytes())
    plain = (arguments.out / "plate.bendy").read_bytes()
    (arguments.out / "two_objects.bendy").write_bytes(two_objects(plain, plain))
    for path in sorted(arguments.out.glob("*.bendy")):
        subprocess.run([arguments.bendy, "validate", path], check=True)
        print(f"{path.stat().st_size:6} {path.name}")


if __name__ == "__main__":
    main()
