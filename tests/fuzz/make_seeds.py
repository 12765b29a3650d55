#!/usr/bin/env python3
"""Gathers what the fuzz targets begin with.

    tests/fuzz/make_seeds.py BENDY OUT [FOLDER...]

OUT/bendy gets bendy files: the program BENDY's conversions of glTF files that are made here, and of those of the FOLDERs
with their buffers packed into them, and the specification's and the tests' own; OUT/codec the leaves of these; OUT/rig their
rig files; OUT/text their text forms; OUT/x X-files; OUT/md2 Quake II models; OUT/bvh Biovision files; OUT/convert sources of all formats, each with
several sets of options. Only small files: a fuzzer finds more in a thousand small ones than in one large one.
"""

import argparse
import base64
import hashlib
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "cli"))

from bvh_file import walk  # noqa: E402
from chunk_file import Chunk  # noqa: E402
from gltf_file import GltfFile, strange_file  # noqa: E402
from md2_file import md2_file  # noqa: E402

LARGEST = 48_000  # bytes
PACKED = 8  # what fuzz_codec takes for a packed clip: the number after the last codec's
# The tails of fuzz_convert's input: switches in two bytes, a bound, a number; convert_input.cpp.
TAILS = tuple(struct.pack("<HBB", *tail) for tail in (
    (0, 0, 0), (0b0000_0101, 0, 1), (0b0011_0010, 0, 2), (0b1001_1001, 1, 3), (0b0111_1111, 7, 4), (0b1101_0000_1001, 3, 16)))
OPTIONS = ([], ["--compact"], ["--lod"], ["--lod", "--compact"], ["--auto-rig"], ["--keep-order"])


# What other writers' files have and ours do not.
X_FILES = [
    """xof 0302txt 0064
// a remark
template Odd { <00000000-0000-0000-0000-000000000000> array Vector a[n]; [...] }
Header { 1; 0; 1; }
Material Red { 1;0;0;1;; 5; 1;1;1;; 0;0;0;; TextureFilename { "a\\\\b.bmp"; } }
Frame A { Mesh M { 5; 0;0;0;, 1;0;0;, 1;1;0;, 0;1;0;, 2;2;2;; 2; 4;0,3,2,1;, 3;0,1,4;;
 MeshNormals { 2; 0;0;1;, 0;1;-1.#IND00;; 2; 4;0,0,0,1;, 3;1,1,1;; }
 MeshVertexColors { 1; 2; 0.5;0.25;0;1;;; } MeshMaterialList { 2; 1; 1; { Red } Material { 0;1;0;0.5;; 30; 0;0;0;; 0;0;0;; } }
 XSkinMeshHeader { 1; 1; 1; } SkinWeights { "B"; 2; 0,4; 0.5,1; 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1;; } } Frame B { } }
AnimationSet S { Animation { { B } AnimationOptions { 0; 1; }
 AnimationKey { 4; 2; 0;16;1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1;;, 9;16;0,0,-1,0,0,1,0,0,1,0,0,0,2,3,4,1;;; } } }
""",
    """xof 0303txt 0032
Frame A { Frame B { FrameTransformMatrix {1,0,0,0,0,1,0,0,0,0,1,0,0,1,0,1;;} BendyConstraint { "euler_box";"XYZ";"every_pose";0;0.1;0,0,0,1;-1,-1,-1;1,1,1;-3.402823466e38,0,0;1,1,1;0,0,0;0,0,0; } Frame C { BendyName { "c%20d"; } } } }
BendyIkChain { "reach";"A";"C";"";"";"ccd";0;10;0;0.001;0,0,1;0;0,0,0;0,0,0,1;1;0;1;0;0;"";1;"B";0.5;; }
AnimationSet S { Animation { {B} AnimationKey { 0; 2; 0;4;-1,0,0,0;;, 4800;4;-0.7,0.7,0,0;;; } AnimationKey {2;1;0;3;0,1,0;;;} } }
BendyClip { "S"; "Real name"; }
""",
]


def binary_x_file():
    """A frame with a matrix, in tokens."""
    def name(text):
        return struct.pack("<HI", 1, len(text)) + text
    matrix = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1)
    return (b"xof 0303bin 0032" + name(b"Frame") + name(b"F") + struct.pack("<H", 10)
            + name(b"FrameTransformMatrix") + struct.pack("<HHI16f", 10, 7, 16, *matrix) + struct.pack("<H", 11)
            + name(b"Mesh") + struct.pack("<HHIHI9fHI5I", 10, 3, 3, 7, 9, *range(9), 6, 5, 1, 3, 0, 1, 2)
            + struct.pack("<HH", 11, 11))


def character(path, interpolation):
    """Three joints, two influences a vertex, two targets, tracks and curves on everything, limits and a chain in the extras."""
    file = GltfFile(
        scenes=[{"nodes": [0, 3], "extras": {"rig_ik": {"chains": [
            {"name": "Back", "start": "Hips", "effector": "Head", "solver": "ccd", "weights": {"Spine": 0.5}}]}}}],
        nodes=[{"name": "Hips", "children": [1], "extras": {"mine": [1, 2]}},
               {"name": "Spine", "children": [2], "translation": [0, 1, 0],
                "extras": {"rig_joint": {"limits": [{"model": "hinge", "x": [-1, 1]}], "stiffness": [0, 0.5, 0]}}},
               {"name": "Head", "translation": [0, 1, 0], "rotation": [0, 0, 0.6, 0.8],
                "extras": {"rig_joint": {"euler_limits": [{"space": "rest", "order": "XYZ", "x": [-0.5, 2], "y": [0, 0]}]}}},
               {"name": "Body", "mesh": 0, "skin": 0}])
    corners = [(x * 0.1, y * 0.5, 0.05 * x * y) for y in range(5) for x in range(3)]
    count = len(corners)
    triangles = [(k,) for y in range(4) for x in range(2)
                 for k in (y * 3 + x, y * 3 + x + 1, y * 3 + x + 3, y * 3 + x + 1, y * 3 + x + 4, y * 3 + x + 3)]
    attributes = {
        "POSITION": file.add(corners, "VEC3"),
        "NORMAL": file.add([(0, 0, 1)] * count, "VEC3"),
        "TANGENT": file.add([(1, 0, 0, -1)] * count, "VEC4"),
        "TEXCOORD_0": file.add([(x, y) for x, y, _ in corners], "VEC2"),
        "COLOR_0": file.add([(255, k, 0, 255) for k in range(count)], "VEC4", 5121),
        "JOINTS_0": file.add([(k % 3, (k + 1) % 3, 0, 0) for k in range(count)], "VEC4", 5121),
        "WEIGHTS_0": file.add([(0.75, 0.25, 0, 0)] * count, "VEC4")}
    file.document["accessors"][attributes["COLOR_0"]]["normalized"] = True
    touched = file.document["accessors"][file.add([(2,), (7,)], "SCALAR", 5123)]["bufferView"]
    moves = file.document["accessors"][file.add([(0, 1, 0), (1, 0, 0)], "VEC3")]["bufferView"]
    targets = [{"POSITION": file.add([(0, 0, 0.1)] * count, "VEC3")}, {"POSITION": file.add([(0, 0, 0)] * count, "VEC3")}]
    file.document["accessors"][targets[1]["POSITION"]]["sparse"] = {
        "count": 2, "indices": {"bufferView": touched, "componentType": 5123}, "values": {"bufferView": moves}}
    file.document["meshes"] = [{"name": "Body", "weights": [0.25, 0], "primitives": [
        {"attributes": attributes, "targets": targets, "material": 0,
         "indices": file.add(triangles, "SCALAR", 5123)}]}]
    identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    file.document["skins"] = [{"joints": [0, 1, 2], "skeleton": 0,
                               "inverseBindMatrices": file.add([tuple(identity)] * 3, "MAT4")}]
    times = file.add([(0.0,), (0.5,), (1.0,)], "SCALAR")
    copies = 3 if interpolation == "CUBICSPLINE" else 1
    rotations = [(0, 0, 0, 1), (0.6, 0, 0, 0.8), (0, 0.28, 0, 0.96)]
    values = {
        "rotation": file.add([r for r in rotations for _ in range(copies)], "VEC4"),
        "translation": file.add([(k, 1, 0) for k in range(3) for _ in range(copies)], "VEC3"),
        "scale": file.add([(1, 1 + k, 1) for k in range(3) for _ in range(copies)], "VEC3"),
        "weights": file.add([(k * 0.1,) for k in range(6 * copies)], "SCALAR")}
    paths = list(values)
    file.document["animations"] = [{
        "name": "Move",
        "samplers": [{"input": times, "output": values[path], "interpolation": interpolation} for path in paths],
        "channels": [{"sampler": k, "target": {"node": 3 if path == "weights" else 1, "path": path}}
                     for k, path in enumerate(paths)]}]
    animation = file.document["animations"][0]
    for pointer, width in (("/materials/0/alphaCutoff", "SCALAR"), ("/nodes/1/extras/mine", "VEC2"), ("/extras/wind", "VEC3"),
                           ("/textures/0/extras/x", "VEC4"), ("/meshes/0/weights", "weights"), ("/nodes/0/scale", "scale")):
        components = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}.get(width)
        output = values.get(width) or file.add([(k * 0.3,) * components for k in range(3) for _ in range(copies)], width)
        animation["channels"].append({"sampler": len(animation["samplers"]), "extras": {"name": "Curve"}, "target": {
            "path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}})
        animation["samplers"].append({"input": times, "output": output, "interpolation": interpolation})
    file.document["materials"] = [{
        "name": "Cloth", "alphaMode": "MASK", "doubleSided": True, "extensions": {"KHR_materials_unlit": {}},
        "pbrMetallicRoughness": {"baseColorTexture": {
            "index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0], "rotation": 1}}}}}]
    file.document["textures"] = [{"source": 0, "sampler": 0}]
    file.document["samplers"] = [{"magFilter": 9729, "wrapS": 33071}]
    file.document["images"] = [{"uri": "data:image/png;base64," + base64.b64encode(b"\x89PNG\r\n\x1a\n").decode()}]
    file.document["extensionsUsed"] = ["KHR_animation_pointer", "KHR_materials_unlit", "KHR_texture_transform"]
    return file.write(path)


def packed(path):
    """A glTF file as .glb, with everything that it refers to in its BIN chunk; nothing if that cannot be."""
    data = path.read_bytes()
    document, bin_chunk = data, b""
    try:
        if data[:4] == b"glTF":
            length = struct.unpack_from("<I", data, 12)[0]
            document, bin_chunk = data[20:20 + length], data[28 + length:]
        return pack(json.loads(document), bin_chunk, path.parent)
    except (struct.error, ValueError, KeyError, IndexError, TypeError, AttributeError, OSError):
        return None  # it is wrong in itself, and goes in as it is


def pack(root, bin_chunk, folder):
    all_bytes, starts = b"", []
    for number, buffer in enumerate(root.get("buffers", [])):
        uri = buffer.get("uri")
        if uri is None:
            piece = bin_chunk if number == 0 else bytes(buffer["byteLength"])
        elif uri.startswith("data:"):
            piece = base64.b64decode(uri.split(",", 1)[1] + "==")
        else:
            piece = (folder / urllib.parse.unquote(uri)).read_bytes()
        starts.append(len(all_bytes))
        all_bytes += piece + bytes(-len(piece) % 4)
    for view in root.get("bufferViews", []):
        moved = [view] + [extension for extension in view.get("extensions", {}).values() if "buffer" in extension]
        for part in moved:
            part["byteOffset"] = part.get("byteOffset", 0) + starts[part["buffer"]]
            part["buffer"] = 0
    if starts:
        root["buffers"] = [{"byteLength": len(all_bytes)}]
    for image in root.get("images", []):
        if not image.get("uri", "data:").startswith("data:"):
            image["uri"] = "data:image/png;base64,iVBORw0KGgo="
    text = json.dumps(root).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text
    if all_bytes:
        body += struct.pack("<II", len(all_bytes), 0x004E4942) + all_bytes
    return struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body


def keep(folder, data):
    if data is not None and len(data) <= LARGEST:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / hashlib.sha256(data).hexdigest()[:16]).write_bytes(data)


def keep_conversion(folder, source, rig=b""):
    """A source as fuzz_convert takes it, with two sets of options: others for each source, and all for what has a rig."""
    if source is None or len(source) + len(rig) > LARGEST // 8:
        return
    first = hashlib.sha256(source).digest()[0]
    tails = TAILS if rig else [TAILS[(first + k) % len(TAILS)] for k in (0, 2)]
    for tail in tails:
        keep(folder, source + rig + tail + struct.pack("<I", len(rig)))


def gather(bendy, out, folders, work):
    sources = [strange_file(work / "strange.gltf")]
    sources += [character(work / f"{name}.gltf", name) for name in ("STEP", "LINEAR", "CUBICSPLINE")]
    sources += [ROOT / name for name in ("examples/tentacle.glb", "examples/mannequin.glb", "spec/gltf/every_field.gltf")]
    for folder in folders:
        sources += sorted(file for suffix in ("glb", "gltf", "vrm") for file in folder.rglob(f"*.{suffix}"))
    for source in sources:
        if source.stat().st_size > 2 * LARGEST:
            continue
        keep_conversion(out / "convert", packed(source))
        if source.suffix == ".gltf" or packed(source) is None:
            keep_conversion(out / "convert", source.read_bytes())
        for options in OPTIONS:
            converted = work / "converted.bendy"
            done = subprocess.run([bendy, "convert", source, "-o", converted, *options], capture_output=True, check=False)
            if done.returncode == 0:
                keep(out / "bendy", converted.read_bytes())
                rig = subprocess.run([bendy, "rig", converted], capture_output=True, check=False)
                if rig.returncode == 0:
                    keep(out / "rig", rig.stdout)
                    if "--auto-rig" in options:
                        keep_conversion(out / "convert", packed(source), rig.stdout)
                keep_texts(bendy, out / "text", converted)
                written = work / "written.x"
                exported = subprocess.run([bendy, "export", converted, "-o", written], capture_output=True, check=False)
                if exported.returncode == 0:
                    keep(out / "x", written.read_bytes())
    for text in X_FILES:
        keep(out / "x", text.encode())
    keep(out / "x", binary_x_file())
    for names in (("only",), ("stand01", "stand02", "run1"), ("pain101", "pain102", "pain201")):
        keep(out / "md2", md2_file(work / "model.md2", names).read_bytes())
    for text in (walk(3), walk(0), walk(1).replace("\n", "\r\n").replace("  ", "\t")):
        keep(out / "bvh", text.encode())
        human = work / "human.bvh"
        human.write_text(text)
        for options in (["--auto-rig"], ["--compact"]):
            subprocess.run([bendy, "convert", "-q", human, "-o", work / "human.bendy", *options], check=True, capture_output=True)
            keep(out / "bendy", (work / "human.bendy").read_bytes())
    for folder in ("x", "md2", "bvh"):
        for file in sorted((out / folder).iterdir()):
            keep_conversion(out / "convert", file.read_bytes())
    for folder in ("spec", "tests"):
        for file in sorted((ROOT / folder).rglob("*.bendy")):
            keep(out / "bendy", file.read_bytes())
            keep_texts(bendy, out / "text", file)
    for file in sorted((out / "bendy").iterdir()):
        if int(file.name, 16) % 8 == 0:
            keep_conversion(out / "convert", file.read_bytes())
        keep_leaves(out / "codec", file.read_bytes())


def keep_texts(bendy, folder, file):
    for options in ([], ["--decode"]):
        text = subprocess.run([bendy, "dump", file, *options], capture_output=True, check=False)
        if text.returncode == 0:
            keep(folder, text.stdout)


def keep_leaves(folder, data):
    """Each leaf as fuzz_codec takes it: a codec, a stride, a head, a byte that is left out, the payload."""
    try:
        chunks = [chunk for _, chunk in Chunk.read(data).walk() if chunk.children is None]
    except (struct.error, UnicodeError, RecursionError):
        return  # it is wrong on purpose
    for chunk in chunks:
        codec = chunk.flags >> 8
        if chunk.letters == "PACK" and codec == 0:
            keep(folder, bytes([PACKED, 255, 0, 0]) + chunk.payload)
        elif codec != 0:
            keep(folder, bytes([codec % PACKED, 0, 0, 0]) + chunk.payload)
        elif chunk.letters in ("POSI", "INDX", "WGHT"):
            for tried, stride in ((1, 4), (2, 12), (3, 4), (4, 2), (7, 4)):
                keep(folder, bytes([tried, stride, 16, 0]) + chunk.payload)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bendy", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("folders", type=pathlib.Path, nargs="*")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        gather(arguments.bendy, arguments.out, arguments.folders, pathlib.Path(work))
    for folder in sorted(arguments.out.iterdir()):
        files = list(folder.iterdir())
        print(f"{folder}: {len(files)} files, {sum(file.stat().st_size for file in files):,} bytes")


main()
