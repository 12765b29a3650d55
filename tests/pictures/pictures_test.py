#!/usr/bin/env python3
"""Compares what `bendy render` draws with what three.js draws of the same glTF file.

    pictures_test.py --bendy PROGRAM --source SOURCE_DIR --work FOLDER [--npm NPM] [--corpus FOLDER] [--only NAME...]
                     [--keep FOLDER] [FILE.glb...]

Made files with one kind of material each, the examples, and characters of the corpus where it is given; or only the files
named. --keep writes each pair and its difference, eight times as bright, side by side. Exit status 77 where there is no
Chromium, no OpenGL, or the package of package-lock.json cannot be had.
"""

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "viewer"), str(HERE.parents[1] / "scripts")]
import browser  # noqa: E402
from compare_pictures import Difference, side_by_side  # noqa: E402
from made_files import MADE  # noqa: E402
from own_folder import work_folder  # noqa: E402
from png_file import read_png, write_png  # noqa: E402

SKIPPED = 77
SOFTWARE = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"}
MADE_SIZE = (200, 150)
CHARACTER_SIZE = (400, 300)  # finer: details smaller than a pixel are no matter of the material
BACKGROUND = "#3a6b52"

# Name: path below the corpus, the number of a clip and a time, or None for the rest pose.
CORPUS = {
    "fox": ("models/fox.glb", 2, 0.4),
    "cesium_man": ("models/cesium_man.gltf", 0, 0.7),
    "robot": ("models/robot.glb", 6, 0.3),
    "left_hand": ("models/left_hand_high.glb", None, None),
    "rigged_simple": ("models/rigged_simple.gltf", 0, 1.0),
    "morph_stress": ("models/morph_stress_test.gltf", 1, 1.2),
    "morph_primitives": ("models/morph_primitives_test/MorphPrimitivesTest.gltf", None, None),
    "morph_cube": ("models/animated_morph_cube/AnimatedMorphCube.gltf", 0, 1.0),
    "interpolation": ("models/interpolation_test/InterpolationTest.gltf", 4, 0.6),
    "box_animated": ("models/box_animated.gltf", 0, 1.5),
    "parent_inverse": ("models/parent_inverse_anim/06_parent-inverse-anim.gltf", 0, 0.5),
    "texture_transform": ("models/texture_transform_test/TextureTransformTest.gltf", None, None),
    "two_coordinates": ("models/box_texcoords/boxTexcoords.gltf", None, None),
}


class Case:
    """One picture of both."""

    def __init__(self, name, file, pitch=11, yaw=34, distance=1, clip=None, time=None, size=CHARACTER_SIZE):
        self.name, self.file, self.clip, self.time = name, file, clip, time
        self.job = {"file": str(file), "width": size[0], "height": size[1], "yaw": yaw, "pitch": pitch,
                    "distance": distance, "background": BACKGROUND}
        if clip is not None:
            self.job |= {"clip": clip, "time": time}
        self.ours = None

    def render(self, bendy, work):
        """An error, or nothing."""
        converted, out = work / f"{self.name}.bendy", work / f"{self.name}.png"
        job = self.job
        pose = ["--clip", str(self.clip), "--time", str(self.time)] if self.clip is not None else []
        for arguments in (["convert", "-q", self.file, "-o", converted],
                          ["edit", converted, "-i", "-q", "--strip", "roles"],  # which say where the front is: three.js looks along -Z
                          ["render", converted, "-o", out, "--size", f"{job['width']}x{job['height']}",
                           "--camera", f"{job['yaw']},{job['pitch']},{job['distance']}", "--background", BACKGROUND, *pose]):
            done = subprocess.run([bendy, *map(str, arguments)], capture_output=True, text=True, timeout=120, env=SOFTWARE,
                                  check=False)
            if done.returncode != 0 or arguments[0] == "render" and done.stderr:
                return f"{arguments[0]}: {done.stderr.strip()}"
        self.ours = read_png(out.read_bytes())
        return None


def install(work, npm):
    """Puts three.js into the work folder, once; false if it cannot be had."""
    stamp = work / "node_modules" / "installed.json"
    lock = HERE / "package-lock.json"
    for name in ("package.json", "package-lock.json"):
        shutil.copy(HERE / name, work / name)
    if stamp.exists() and stamp.read_bytes() == lock.read_bytes():
        return True
    done = subprocess.run([npm, "ci", "--no-audit", "--no-fund", "--ignore-scripts"], cwd=work, check=False)
    if done.returncode == 0:
        shutil.copy(lock, stamp)
    return done.returncode == 0


def all_cases(arguments, work):
    if arguments.files:
        return [Case(file.stem, file) for file in arguments.files]
    cases = [Case(name, made.write(work / f"{name}.gltf"), made.pitch, distance=0.75, size=MADE_SIZE) for name, made in MADE.items()]
    examples = arguments.source / "examples"
    cases.append(Case("tentacle", examples / "tentacle.glb", clip=1, time=0.5))
    cases.append(Case("mannequin", examples / "mannequin.glb", clip=0, time=0.3))
    for name, (path, clip, time) in CORPUS.items() if arguments.corpus else ():
        cases.append(Case(name, arguments.corpus / "visible" / path, clip=clip, time=time))
    return [case for case in cases if not arguments.only or case.name in arguments.only]


def judge(case, difference):
    """What is wrong, or nothing. Measured with Mesa's llvmpipe beside SwiftShader: made files up to 0.4 and 1, characters up to
    1.3 and 10, which are creases and details as small as a pixel; unlit ones 0 or 1 pixel, at an inner edge."""
    made = MADE.get(case.name)
    if difference.drawn < 500:
        return "next to nothing is drawn"
    if made and made.is_unlit and difference.elsewhere > 4:
        return f"{difference.elsewhere} pixels differ"
    most_mean, most = (0.8, 3) if made else (2.5, 16)
    if difference.mean > most_mean:
        return f"the mean difference is {difference.mean:.2f} of 255"
    if difference.most > most:
        return f"one pixel of 100 differs by {difference.most} of 255 or more"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bendy", required=True)
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--work", type=work_folder, required=True)
    parser.add_argument("--npm", default="npm")
    parser.add_argument("--corpus", type=Path)
    parser.add_argument("--only", nargs="*")
    parser.add_argument("--keep", type=Path)
    parser.add_argument("files", nargs="*", type=Path)
    arguments = parser.parse_args()
    bendy = str(Path(arguments.bendy).resolve())
    work = arguments.work
    pictures = work / "pictures"
    shutil.rmtree(pictures, ignore_errors=True)
    pictures.mkdir(parents=True)
    if browser.CHROMIUM is None:
        print("Chromium is not installed (scripts/setup.sh all installs it)")
        return SKIPPED
    if not install(work, arguments.npm):
        print("three.js cannot be had")
        return SKIPPED
    cases = all_cases(arguments, pictures)
    faults = []
    for case in cases:
        problem = case.render(bendy, pictures)
        if problem and "no OpenGL 3.3 here" in problem:
            print(problem)
            return SKIPPED
        if problem:
            faults.append(f"{case.name}: {problem}")
    drawn, problems, _ = browser.draw([case.job for case in cases], work / "node_modules" / "three")
    faults += problems
    if arguments.keep:
        arguments.keep.mkdir(parents=True, exist_ok=True)
    for case, theirs in zip(cases, drawn):
        if case.ours is None or theirs is None:
            continue
        difference = Difference(case.ours, theirs, bytes.fromhex(BACKGROUND[1:]))
        fault = judge(case, difference)
        print(f"{case.name:26} {difference}{'  <-- ' + fault if fault else ''}")
        if fault:
            faults.append(f"{case.name}: {fault}")
        if arguments.keep:
            (arguments.keep / f"{case.name}.png").write_bytes(write_png(*side_by_side(case.ours, theirs)))
    print(f"{len(cases)} pictures, {len(faults)} faults")
    for fault in faults:
        print("fault:", fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
