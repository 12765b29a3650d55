"""Makes a glTF file of eight squares, each with another kind of surface."""

import base64
import json
import struct

from png_file import write_png


def checker():
    """8 x 8 squares of red and blue; the lower right quarter is see-through."""
    pixels = bytearray()
    for y in range(8):
        for x in range(8):
            alpha = 0 if x >= 4 and y >= 4 else 255
            pixels += bytes((230, 40, 30, alpha) if (x + y) % 2 else (30, 60, 220, alpha))
    return write_png(8, 8, 4, bytes(pixels))


def surfaces():
    """The file's text. From the top left: rough red, gold, mask, blend, unlit with texture transform, colours of
    vertices, emissive, and one seen from behind that is double-sided."""
    texture = {"index": 0}
    turned = {"index": 0, "extensions": {"KHR_texture_transform": {"rotation": 0.7853982, "scale": [0.5, 0.5]}}}
    materials = [
        {"pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.1, 0.1, 1], "metallicFactor": 0, "roughnessFactor": 0.9}},
        {"pbrMetallicRoughness": {"baseColorFactor": [1.0, 0.77, 0.34, 1], "metallicFactor": 1, "roughnessFactor": 0.3}},
        {"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": texture, "metallicFactor": 0}},
        {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorTexture": texture, "metallicFactor": 0,
                                                        "baseColorFactor": [1, 1, 1, 0.5]}},
        {"extensions": {"KHR_materials_unlit": {}}, "pbrMetallicRoughness": {"baseColorTexture": turned}},
        {"pbrMetallicRoughness": {"metallicFactor": 0}},
        {"emissiveFactor": [0.1, 0.6, 0.2], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}},
        {"doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.5, 0.8, 1], "metallicFactor": 0}},
    ]
    positions, normals, coords, colours, primitives, blob = [], [], [], [], [], b""
    corners = [(-0.45, -0.45), (0.45, -0.45), (0.45, 0.45), (-0.45, 0.45)]
    accessors, views = [], []

    def accessor(data, kind, component, count, extra=None):
        nonlocal blob
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind,
                          **(extra or {})})
        blob += data + b"\0" * (-len(data) % 4)
        return len(accessors) - 1

    for number in range(len(materials)):
        left, top = number % 4 - 1.5, 0.5 - number // 4
        positions = [(left + x, top + y, 0.0) for x, y in corners]
        order = [0, 2, 1, 0, 3, 2] if number == 7 else [0, 1, 2, 0, 2, 3]
        attributes = {
            "POSITION": accessor(b"".join(struct.pack("<3f", *p) for p in positions), "VEC3", 5126, 4,
                                 {"min": [min(p[k] for p in positions) for k in range(3)],
                                  "max": [max(p[k] for p in positions) for k in range(3)]}),
            "NORMAL": accessor(struct.pack("<3f", 0, 0, -1 if number == 7 else 1) * 4, "VEC3", 5126, 4),
            "TEXCOORD_0": accessor(struct.pack("<8f", 0, 1, 1, 1, 1, 0, 0, 0), "VEC2", 5126, 4),
        }
        if number == 5:
            attributes["COLOR_0"] = accessor(struct.pack("<12f", 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1), "VEC3", 5126, 4)
        primitives.append({"attributes": attributes, "material": number,
                           "indices": accessor(struct.pack("<6H", *order), "SCALAR", 5123, 6)})

    def uri(kind, data):
        return f"data:{kind};base64," + base64.b64encode(data).decode()

    return json.dumps({
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_texture_transform", "KHR_materials_unlit"],
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": primitives}],
        "materials": materials, "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"magFilter": 9728, "minFilter": 9728}],
        "images": [{"uri": uri("image/png", checker())}],
        "buffers": [{"byteLength": len(blob), "uri": uri("application/octet-stream", blob)}],
        "bufferViews": views, "accessors": accessors})
