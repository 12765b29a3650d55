"""Makes small glTF files for tests."""

import base64
import json
import struct


class GltfFile:
    """A glTF document with one buffer, embedded as a data URI."""

    def __init__(self, **top):
        self.data = b""
        self.document = {"asset": {"version": "2.0"}, "scene": 0, "bufferViews": [], "accessors": [], **top}

    def add(self, numbers, kind, component_type=5126):
        """A new accessor's number. numbers: a list of tuples."""
        letter = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}[component_type]
        flat = [number for element in numbers for number in element]
        piece = struct.pack(f"<{len(flat)}{letter}", *flat)
        self.document["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(piece)})
        self.data += piece + bytes(-len(piece) % 4)
        self.document["accessors"].append({
            "bufferView": len(self.document["bufferViews"]) - 1, "componentType": component_type,
            "count": len(numbers), "type": kind,
            "min": [min(column) for column in zip(*numbers)], "max": [max(column) for column in zip(*numbers)]})
        return len(self.document["accessors"]) - 1

    def write(self, path):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode("ascii")
        if self.data:
            self.document["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        self.document = {key: value for key, value in self.document.items() if value != []}
        path.write_text(json.dumps(self.document), encoding="utf-8")
        return path


HUMAN = {"Hips": (None, (0, 1, 0)), "Spine": ("Hips", (0, 1.1, 0)), "Neck": ("Spine", (0, 1.5, 0)), "Head": ("Neck", (0, 1.6, 0)),
         **{side + part: (None if parent is None else parent if parent in ("Hips", "Spine") else side + parent, (sign * x, y, z))
            for side, sign in (("Left", 1), ("Right", -1))
            for part, parent, (x, y, z) in (
                ("Arm", "Spine", (0.2, 1.45, 0)), ("ForeArm", "Arm", (0.5, 1.45, 0)), ("Hand", "ForeArm", (0.75, 1.45, 0)),
                ("UpLeg", "Hips", (0.1, 0.95, 0)), ("Leg", "UpLeg", (0.1, 0.5, 0)), ("Foot", "Leg", (0.1, 0.1, 0)))}}


def humans_file(path, roots):
    """Joints of a human below each root, side by side, without a mesh."""
    nodes = []
    for number, root in enumerate(roots):
        first = len(nodes)
        nodes.append({"name": root, "translation": [2 * number, 0, 0], "children": [first + 1]})
        order = list(HUMAN)
        for name, (parent, place) in HUMAN.items():
            above = HUMAN[parent][1] if parent else (0, 0, 0)
            children = [first + 1 + order.index(each) for each in order if HUMAN[each][0] == name]
            nodes.append({"name": name, "translation": [a - b for a, b in zip(place, above)],
                          **({"children": children} if children else {})})
    roots = [number for number, node in enumerate(nodes) if node["name"] in roots]
    return GltfFile(nodes=nodes, scenes=[{"nodes": roots}]).write(path)


def named_file(path, names):
    """A character whose joints, clips and scenes have these names. Each joint lies at its number on the x axis; a clip moves
    the first one to the clip's number, and a scene begins with the joint of its number."""
    numbers = range(len(names))
    file = GltfFile(nodes=[{"name": name, "translation": [number, 0, 0]} for number, name in enumerate(names)],
                    scenes=[{"name": names[first], "nodes": sorted(numbers, key=lambda number: number != first)}
                            for first in numbers])
    times = file.add([(0,), (1,)], "SCALAR")
    file.document["animations"] = [
        {"name": name, "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
         "samplers": [{"input": times, "output": file.add([(number, 0, 0)] * 2, "VEC3")}]}
        for number, name in enumerate(names)]
    return file.write(path)


def read_name_keys(path):
    """tests/format/name_keys.txt: the names, and a dict of what each text refers to: a number, "ambiguous" or "absent"."""
    lines = [line.split() for line in path.read_text().splitlines() if not line.startswith("//")]
    keys = {line[0]: int(line[1]) if line[1].isdigit() else line[1] for line in lines if line[0] != "names"}
    return next(line[1:] for line in lines if line[0] == "names"), keys


def strange_file(path):
    """A character with names that a terminal must not see as they are, unnamed things, lines, points and a mirror."""
    file = GltfFile(
        scenes=[{"nodes": [0]}],
        nodes=[{"name": "root\x1b[31m\nbendy: error: forged", "children": [1, 2]},
               {"name": "\u624b \u00e9", "mesh": 0, "translation": [0, 1, 0]},
               {"mesh": 1, "scale": [-1, 1, 1]}])
    corners = file.add([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.1, 0.2, 0.3)], "VEC3")
    normals = file.add([(0, 0, 1)] * 4, "VEC3")
    triangle = file.add([(0,), (1,), (2,)], "SCALAR", 5123)
    lines = file.add([(0,), (3,)], "SCALAR", 5123)
    points = file.add([(3,)], "SCALAR", 5123)
    file.document["meshes"] = [
        {"name": "bell\x07\x7f", "primitives": [{"attributes": {"POSITION": corners}, "indices": triangle},
                                               {"attributes": {"POSITION": corners}, "indices": lines, "mode": 1},
                                               {"attributes": {"POSITION": corners}, "indices": points, "mode": 0}]},
        {"name": 'quote " and \\ and \u00fc',
         "primitives": [{"attributes": {"POSITION": corners, "NORMAL": normals}, "indices": triangle}]}]
    times = file.add([(0.5,), (1.5,)], "SCALAR")
    values = file.add([(0, 0, 0), (4, 0, 0)], "VEC3")
    animation = {"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                 "samplers": [{"input": times, "output": values}]}
    file.document["animations"] = [{"name": "slide\tnow", **animation}, animation, {"name": "0", **animation}]
    return file.write(path)
