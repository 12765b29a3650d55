#!/usr/bin/env python3
"""Checks every #include of the project against the table below: check_includes.py SOURCE_DIR"""

import re
import sys
from pathlib import Path

# A folder, and those whose headers it may use beside its own. `bendy/NAME/` is where the folder NAME has its public headers.
MAY_USE = {
    "format": set(),
    "format/json": set(),
    "format/extensions": {"format", "format/json"},
    "runtime": {"format"},
    "converter": {"format", "format/json", "format/extensions"},
    "tools/diff": {"format"},
    "tools/edit": {"format", "format/extensions"},
    "tools/text_form": {"format"},
    "tools/motion": {"format", "runtime", "tools/edit"},
    "tools/stages": {"format", "runtime"},
    "tools/viewer": {"format", "format/json", "runtime"},
    "tools/reports": {"format", "format/json", "runtime", "converter", "tools/diff"},
    "tools/cli": {"format", "format/json", "runtime", "converter", "tools/diff", "tools/edit", "tools/motion", "tools/text_form", "tools/stages",
                  "tools/viewer", "tools/reports"},
    "bindings/c": {"format", "runtime"},
    "bindings/python": {"format", "format/json", "runtime", "converter", "tools/diff", "tools/edit", "tools/motion", "tools/text_form", "tools/viewer",
                        "tools/reports"},
    "bindings/web": {"format", "format/json", "runtime", "converter", "tools/diff", "tools/edit", "tools/motion", "tools/text_form", "tools/reports"},
}
FOLDER_OF = {folder.split("/")[-1]: folder for folder in MAY_USE}
# Folders of runtime/src and converter/src, and those that each may use beside its own.
ROOMS = {
    "runtime": {
        "math": set(),
        "plan": {"math"},
        "kernels": {"math", "plan"},
        "model": {"math", "plan"},
        "pose": {"math", "plan", "kernels", "model"},
        "play": {"math", "plan", "kernels", "model", "pose"},
        "ik": {"math", "plan", "kernels", "model", "pose"},
        "skin": {"math", "plan", "kernels", "model", "pose"},
        "retarget": {"math", "plan", "model", "pose", "ik"},
    },
    "converter": {
        "scene": set(),
        "scene/source": {"scene"},
        "rigging/humanoid": {"scene"},
        "rigging/rig": {"scene", "scene/source"},
        "optimise": {"scene"},
        "optimise/passes": {"scene", "rigging/rig"},
        "optimise/collapse": {"scene", "optimise/passes"},
        "optimise/compact": {"scene", "scene/source", "optimise", "optimise/passes"},
        "optimise/compare": {"scene", "optimise", "optimise/collapse"},
        "formats/bendy_file": {"scene", "scene/source", "rigging/rig", "optimise/passes"},
        "formats/gltf": {"scene", "scene/source", "rigging/rig"},
        "formats/gltf_out": {"scene", "scene/source", "rigging/rig", "rigging/humanoid", "optimise", "optimise/passes", "formats/gltf"},
        "formats/x": {"scene", "scene/source", "rigging/rig"},
        "formats/x_out": {"scene", "scene/source", "rigging/humanoid", "optimise/passes", "formats/x"},
        "formats/md2": {"scene", "scene/source"},
        "formats/bvh": {"scene", "scene/source"},
        "convert": {"scene", "scene/source", "rigging/rig", "rigging/humanoid", "optimise", "optimise/passes", "optimise/collapse",
                    "optimise/compact"},
    },
}
# The floors of the converter, from the ground up, each with the public headers that it fills: nothing includes a floor above its own.
FLOORS = {
    "scene": {"report.h", "scene.h", "source_format.h"},
    "rigging": {"write_rig.h"},
    "optimise": {"compare_characters.h", "error_bound.h"},
    "formats": {"export.h", "import.h"},
    "convert": {"build_chunks.h", "convert.h"},
}
# header: the folders that may include it
PRIVATE = {
    "tiny_gltf.h": "converter/src/formats/gltf/",
    "zlib.h": "converter/src/formats/x/",
    "meshoptimizer.h": ("converter/src/", "format/src/"),
    "draco/": "converter/src/",
    "nlohmann/": ("format/json/src/", "tools/cli/files/"),
    "rapidjson/": "tools/text_form/src/",
    "CLI/": "tools/cli/",
    "epoxy/": "tools/viewer/src/",
    "utf8cpp/": ("converter/src/", "tools/cli/", "tools/reports/"),
    "GLFW/": "tools/viewer/src/",
    "imgui.h": "tools/viewer/src/",
    "backends/": "tools/viewer/src/",
    "png.h": "tools/viewer/src/",
    "pybind11/": "bindings/python/src/",
    "gtest/": "tests/",
}
# What format and runtime may take from outside: the C++ library and the system have no folder in their names.
EMBEDDABLE_MAY_USE = ("bendy/", "glm/", "sys/")


def floor_of(path: str):
    """The number and name of a floor of the converter, from the path of a file or what an #include says; None for other paths."""
    path = path.removeprefix("converter/src/")
    folder, _, header = path.rpartition("/")
    is_public = folder.removeprefix("converter/include/") == "bendy/converter"
    for number, (floor, public) in enumerate(FLOORS.items()):
        if (header in public) if is_public else path.startswith(f"{floor}/"):
            return number, floor
    return None


def faults_of(source: Path):
    faults = []
    seen = 0
    for folder, allowed in MAY_USE.items():
        for file in sorted((source / folder).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            name = file.relative_to(source).as_posix()
            if any(name.startswith(f"{inner}/") for inner in MAY_USE if inner.startswith(f"{folder}/")):
                continue  # a folder in this one, with a line of its own
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                match = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
                if not match:
                    continue
                seen += 1
                header = match.group(1)
                place = f"{name}:{number}: {header}"
                for private, where in PRIVATE.items():
                    if header.startswith(private) and not name.startswith(where):
                        faults.append(f"{place}: may be included from {where} only")
                project = re.match(r"(?:bendy/|(?=reports/))(\w+)(?:\.h|/)", header)
                used = FOLDER_OF.get(project.group(1)) if project else None
                if project and used != folder and used not in allowed:
                    faults.append(f"{place}: {folder} may not use {project.group(1)}")
                own_floor = floor_of(name) if folder == "converter" else None
                floor = floor_of(header) if own_floor else None
                if floor and floor > own_floor:
                    faults.append(f"{place}: {own_floor[1]} is below {floor[1]}")
                room = header.rpartition("/")[0]
                rooms = ROOMS.get(folder, {})
                if room in rooms and name.startswith(f"{folder}/src/"):
                    own = "/".join(name.split("/")[2:-1])
                    if room != own and room not in rooms[own]:
                        faults.append(f"{place}: {own} may not use {room}")
                    continue
                if folder in ("format", "runtime") and "/" in header and not header.startswith(EMBEDDABLE_MAY_USE):
                    faults.append(f"{place}: {folder} may use the C++ library and GLM only")
    if seen == 0:
        faults.append(f"no #include found under {source}: is this the source folder?")
    return faults


def main():
    faults = faults_of(Path(sys.argv[1]))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
