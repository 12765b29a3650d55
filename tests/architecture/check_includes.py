#!/usr/bin/env python3
"""Holds every #include of the project against the edges of ARCHITECTURE.md: check_includes.py SOURCE_DIR"""

import re
import sys
from pathlib import Path

# folder: the bendy/ include folders it may use beside its own
MAY_USE = {
    "format": set(),
    "runtime": {"format"},
    "capi": {"format", "runtime"},
    "extensions": {"format"},
    "converter": {"format", "extensions"},
    "diff": {"format"},
    "edit": {"format", "extensions"},
    "viewer": {"format", "runtime"},
    "text_form": {"format"},
    "stages": {"format", "runtime"},
    "cli": {"format", "runtime", "converter", "diff", "edit", "viewer", "text_form", "stages"},
    "python": {"format", "runtime", "converter", "diff", "edit", "text_form", "viewer"},
}
# Rooms of runtime/src and converter/src, and those that each may use beside its own. What lies in converter/src itself,
# in no room, all of them may use.
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
    },
    "converter": {
        "": set(),
        "source": set(),
        "humanoid": set(),
        "rig": {"source"},
        "passes": {"rig"},
        "collapse": {"passes"},
        "compact": {"source", "passes"},
        "compare": {"collapse"},
        "bendy_file": {"source", "rig", "passes"},
        "gltf": {"source", "rig"},
        "gltf_out": {"source", "rig", "passes", "gltf"},
        "x": {"source", "rig"},
        "x_out": {"source", "passes", "x"},
        "md2": {"source"},
        "convert": {"source", "rig", "humanoid", "passes", "collapse", "compact"},
    },
}
# header: the folders that may include it
PRIVATE = {
    "tiny_gltf.h": "converter/src/gltf/",
    "zlib.h": "converter/src/x/",
    "meshoptimizer.h": ("converter/src/", "format/src/"),
    "draco/": "converter/src/",
    "nlohmann/": ("extensions/src/", "converter/src/", "cli/", "viewer/src/"),
    "rapidjson/": "text_form/src/",
    "CLI/": "cli/",
    "epoxy/": "viewer/src/",
    "utf8cpp/": ("converter/src/", "cli/"),
    "GLFW/": "viewer/src/",
    "imgui.h": "viewer/src/",
    "backends/": "viewer/src/",
    "png.h": "viewer/src/",
    "pybind11/": "python/src/",
    "gtest/": "tests/",
}
# What format and runtime may take from outside: the C++ library and the system have no folder in their names.
EMBEDDABLE_MAY_USE = ("bendy/", "glm/", "sys/")


def faults_of(source: Path):
    faults = []
    seen = 0
    for folder, allowed in MAY_USE.items():
        for file in sorted((source / folder).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            name = file.relative_to(source).as_posix()
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
                project = re.match(r"bendy/(\w+)(?:\.h|/)", header)
                if project and project.group(1) != folder and project.group(1) not in allowed:
                    faults.append(f"{place}: {folder} may not use {project.group(1)}")
                room = header.split("/")[0] if "/" in header else ""
                rooms = ROOMS.get(folder, {})
                if room in rooms and name.startswith(f"{folder}/src/"):
                    own = "/".join(name.split("/")[2:-1])
                    if room not in ("", own) and room not in rooms[own]:
                        faults.append(f"{place}: {own or 'src'} may not use {room}")
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
