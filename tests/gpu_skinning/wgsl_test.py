#!/usr/bin/env python3
"""Runs examples/gpu_skinning/skinning.wgsl in headless Chromium, and compares its vertices with those of `skin`.

    wgsl_test.py --source SOURCE_DIR [--corpus FOLDER]

The streams go there as the files store them, and the palettes as bendy_bone_matrices has them. Exit status 77 where there is no
Chromium; PYTHONPATH has the package bendy.
"""

import argparse
import base64
import struct
import sys
from pathlib import Path

import numpy as np

sys.dont_write_bytecode = True  # nothing into the source tree
HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "pictures"))
import browser  # noqa: E402

import bendy  # noqa: E402
from bendy._bendy import c  # noqa: E402

SKIPPED = 77
TOLERANCE = 1e-5  # of the longer of 1 and the character's diagonal
FLAGS = ("--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader")
CORPUS = ("models/fox.glb", "models/cesium_man.gltf", "models/robot.glb", "generated/joints8.glb", "generated/joints_300.glb",
          "generated/attributes_zoo.glb", "generated/weights_u8_joints_u8.glb")


def text_of(array):
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode()


def parameters_of(**fields):
    """The uniform block Skinning: a matrix, then the fields in their order."""
    return base64.b64encode(struct.pack("<64x12I", *fields.values())).decode()


def by_columns(rows):
    """(N, 3, 4) to (N, 16)."""
    whole = np.tile(np.eye(4, dtype=np.float32), (len(rows), 1, 1))
    whole[:, :3] = rows
    return whole.swapaxes(1, 2).reshape(-1, 16)


def morphs_of(mesh, weights):
    for target, weight in zip(mesh.morph_targets, weights):
        for stream in ("positions", "normals"):
            displacements = getattr(target, stream)
            if displacements is None or weight == 0:
                continue
            parameters = struct.pack("<3If", len(displacements), 4, 3, weight)
            yield {"stream": stream, "elements": len(displacements), "parameters": base64.b64encode(parameters).decode(),
                   "displaced": text_of(np.asarray(target.vertices, np.uint32)), "displacements": text_of(displacements)}


def skinned_parts(pose, mesh):
    """The bones and weights of a mesh as they are stored, and its palette."""
    return mesh.stored["bones"], mesh.stored["weights"], pose.palette(mesh)


def rigid_parts(pose, mesh):
    """The same for a mesh without bones: its vertices follow one matrix, or each its joint, and joint J does not move."""
    movers = np.empty(mesh.vertices, np.uint32)
    c.get_movers(mesh._character.handle, mesh._number, movers)
    matrices = np.concatenate([pose.matrices, np.eye(4, dtype=np.float32)[None]])[:, :3]
    movers = np.minimum(movers, len(matrices) - 1)
    if (movers == movers[0]).all():
        return None, None, matrices[movers[:1]]
    return movers[:, None], None, matrices


class Case:
    """A mesh in a pose, by one method."""

    def __init__(self, name, pose, mesh, method):
        self.name, self.method = name, method
        bones, weights, palette = (rigid_parts if mesh.is_rigid else skinned_parts)(pose, mesh)
        streams = {**mesh.stored, **({} if bones is None else {"bones": bones})}
        is_dual = method == "dual_quaternion"
        self.job = {
            "vertices": mesh.vertices, "bones": len(palette), "palette": text_of(by_columns(palette)),
            "streams": {name: text_of(streams.get(name, np.zeros(4, np.float32)))
                        for name in ("positions", "normals", "tangents", "bones", "weights")},
            "morphs": list(morphs_of(mesh, pose.morph_weights[mesh.first_morph_target:])),
            "parameters": parameters_of(
                vertices=mesh.vertices, influences=0 if bones is None else bones.shape[1],
                bone_bytes=0 if bones is None else bones.itemsize, weight_bytes=0 if weights is None else weights.itemsize,
                first_entry=0, entries=len(palette),
                bones_used=len(palette), topmost=int(np.argmin(mesh.palette)) if is_dual else 0, by_columns=1, dual=int(is_dual),
                has_normals=int("normals" in streams), has_tangents=int("tangents" in streams))}
        if is_dual:
            self.job["places"] = text_of(np.linalg.inv(mesh.inverse_bind.astype(np.float64))[:, :3, 3].astype(np.float32))
        self.wanted = np.concatenate(pose.skin(mesh, normals=True, tangents=True, method=method), axis=1)

    def error(self, answer):
        difference = np.abs(np.frombuffer(answer, np.float32).reshape(-1, 10) - self.wanted)
        positions = self.wanted[:, :3]
        difference[:, :3] /= max(1.0, float(np.linalg.norm(positions.max(axis=0) - positions.min(axis=0))))
        return float(difference.max())


def cases_of(file):
    model = bendy.open(file)
    pose = bendy.Pose(model)
    pose.morph_weights = [0.5 + 0.3 * k for k in range(len(pose.morph_weights))]
    poses = [("rest", pose)] + [(clip.name, model.sample(clip, 0.4 * clip.start + 0.6 * clip.end)) for clip in model.clips]
    for name, posed in poses:
        for mesh in model.meshes:
            for method in ("linear",) if mesh.is_rigid else ("linear", "dual_quaternion"):
                yield Case(f"{file.stem}, {name}, {mesh.name or 'a mesh'}, {method}", posed, mesh, method)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", required=True, type=Path)
    parser.add_argument("--corpus", type=Path)
    options = parser.parse_args()
    if browser.CHROMIUM is None:
        print("no Chromium")
        return SKIPPED
    files = [options.source / "examples/mannequin.glb", options.source / "examples/tentacle.glb"]
    files += [options.corpus / "visible" / name for name in CORPUS] if options.corpus else []
    cases = [case for file in files for case in cases_of(file)]
    answers, problems, console = browser.run_page(HERE, [case.job for case in cases], 300, flags=FLAGS,
                                                  files=[options.source / "examples/gpu_skinning/skinning.wgsl"])
    worst = 0.0
    for number, case in enumerate(cases):
        error = case.error(answers[number]) if number in answers else float("inf")
        worst = max(worst, error)
        print(f"{case.name}: {error:.2g}")
        if not error <= TOLERANCE:
            problems.append(f"{case.name}: {error:.2g}, allowed are {TOLERANCE:g}")
    print(f"{len(cases)} meshes in poses, at most {worst:.2g}", *problems, *(console if problems else ()), sep="\n")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
