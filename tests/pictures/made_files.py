"""Makes glTF files of a ball, or of an open cup, that each show one thing about a material."""

import base64
import math
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent.parent / folder) for folder in ("cli", "viewer")]
from gltf_file import GltfFile  # noqa: E402
from png_file import write_png  # noqa: E402

SIDE = 32  # texels of a map


def picture(texel):
    """A PNG as a URI: texel(x, y) with both from 0 to 1 gives three or four bytes."""
    texels = [texel((x + 0.5) / SIDE, (y + 0.5) / SIDE) for y in range(SIDE) for x in range(SIDE)]
    data = write_png(SIDE, SIDE, len(texels[0]), bytes(min(255, max(0, round(v))) for t in texels for v in t))
    return "data:image/png;base64," + base64.b64encode(data).decode()


def wave(x, turns):
    return 0.5 + 0.5 * math.sin(2 * math.pi * turns * x)


def bump(x, y):
    """A normal map's texel for a surface of smooth hills."""
    dx, dy = 0.9 * math.cos(8 * math.pi * x), -0.9 * math.cos(4 * math.pi * y)
    long = math.sqrt(dx * dx + dy * dy + 1)
    return tuple(127.5 + 127.5 * v / long for v in (-dx, -dy, 1))


MAPS = {
    "base_colour": lambda x, y: (230 * wave(x, 2), 60 + 180 * y, 220 - 180 * wave(y, 3), 255),
    "metallic_roughness": lambda x, y: (17, 40 + 200 * wave(x, 2), 255 * wave(y, 2)),
    "normal": bump,
    "occlusion": lambda x, y: (40 + 215 * wave(x + y, 3), 200, 10),
    "emissive": lambda x, y: (220 * wave(x, 4) ** 4, 150 * wave(y, 4) ** 4, 30),
    "holes": lambda x, y: (240, 200 * wave(y, 2), 60, 255 * wave(x, 3) * wave(y, 2)),
    "arrows": lambda x, y: (255 * x, 255 * y, 255 * (x > 0.8 or y < 0.1)),
}


def place(u, v, cup):
    """A point of the unit ball, or of its lower three quarters, by its coordinates."""
    down = math.pi * (0.35 + 0.65 * v if cup else v)
    turn = 2 * math.pi * u
    return (math.sin(turn) * math.sin(down), math.cos(down), math.cos(turn) * math.sin(down))


def ball(file, cup=False, without=(), tangents=False, colours=0, second=False):
    """Attributes and indices of a ball of 32 x 20 squares; (u, v) runs round it and down."""
    across, down = 32, 20
    corners = [(i / across, j / down) for j in range(down + 1) for i in range(across + 1)]
    points = [place(u, v, cup) for u, v in corners]
    attributes = {"POSITION": file.add(points, "VEC3"), "NORMAL": file.add(points, "VEC3"),
                  "TEXCOORD_0": file.add([(2 * u, v) for u, v in corners], "VEC2")}
    if tangents:
        attributes["TANGENT"] = file.add(
            [(math.cos(2 * math.pi * u), 0, -math.sin(2 * math.pi * u), 1) for u, v in corners], "VEC4")
    if colours:
        rgba = [(wave(u, 3), wave(v, 2), 0.8, 0.3 + 0.7 * v)[:colours] for u, v in corners]
        attributes["COLOR_0"] = file.add(rgba, f"VEC{colours}")
    if second:
        attributes["TEXCOORD_1"] = file.add([(0.3 + 0.7 * v, 3 * u) for u, v in corners], "VEC2")
    for name in without:
        del attributes[name]
    faces = []
    for j in range(down):
        for i in range(across):
            a, b = j * (across + 1) + i, (j + 1) * (across + 1) + i
            faces += [(a,), (b,), (a + 1,), (a + 1,), (b,), (b + 1,)]
    return attributes, file.add(faces, "SCALAR", 5123)


class Made:
    """A file with one material: `maps` of MAPS in it, other factors of its pbrMetallicRoughness, what each textureInfo has
    besides its index, and more of the material; then the ball, how it is looked at, its node, the maps' sampler, and whether
    there is a clip in which nothing moves."""

    def __init__(self, *maps, factors=None, use=None, ball=None, pitch=11, scale=None, sampler=None,
                 stands_still=False, **top):
        self.maps, self.ball, self.pitch, self.scale = maps, ball or {}, pitch, scale
        self.stands_still = stands_still
        self.sampler = sampler or {"magFilter": 9729, "minFilter": 9987}
        pbr = {"metallicFactor": 0.0, "roughnessFactor": 0.6, **(factors or {})}
        self.material = {"pbrMetallicRoughness": pbr, **top}
        for index, name in enumerate(maps):
            info = {"index": index, **(use or {})}
            if name in ("base_colour", "holes", "arrows"):
                pbr["baseColorTexture"] = info
            elif name == "metallic_roughness":
                pbr.update(metallicRoughnessTexture=info, metallicFactor=1.0, roughnessFactor=1.0)
            elif name == "occlusion":
                self.material["occlusionTexture"] = {**info, "strength": 0.8}
            else:
                self.material[name + "Texture"] = info
            if name == "emissive":
                self.material["emissiveFactor"] = [1, 1, 1]

    @property
    def is_unlit(self):
        return bool(self.material) and "KHR_materials_unlit" in self.material.get("extensions", {})

    def write(self, path):
        file = GltfFile(
            scenes=[{"nodes": [0]}], nodes=[{"mesh": 0, **({"scale": self.scale} if self.scale else {})}],
            extensionsUsed=["KHR_texture_transform", "KHR_materials_unlit", "KHR_materials_emissive_strength",
                            "KHR_materials_specular", "KHR_materials_ior"])
        attributes, indices = ball(file, **self.ball)
        primitive = {"attributes": attributes, "indices": indices}
        if self.material:
            primitive["material"] = 0
            file.document["materials"] = [self.material]
        file.document["meshes"] = [{"primitives": [primitive]}]
        if self.stands_still:
            keys = {"input": file.add([(0.0,), (1.0,)], "SCALAR"), "output": file.add([(0.0, 0.0, 0.0)] * 2, "VEC3")}
            file.document["animations"] = [
                {"samplers": [keys], "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]
        if self.maps:
            file.document["samplers"] = [self.sampler]
            file.document["textures"] = [{"source": number, "sampler": 0} for number in range(len(self.maps))]
            file.document["images"] = [{"uri": picture(MAPS[name])} for name in self.maps]
        return file.write(path)


def coloured(*rgb, **more):
    return {"baseColorFactor": [*rgb, 1], **more}


def without_material(**more):
    made = Made(**more)
    made.material = None
    return made


ALL_MAPS = ("base_colour", "metallic_roughness", "normal", "occlusion", "emissive")
GREY = coloured(0.6, 0.6, 0.6)
TURNED = {"extensions": {"KHR_texture_transform": {"rotation": 0.5, "scale": [1.5, 1.5], "offset": [0.2, 0.1]}}}
STRETCHED = {"extensions": {"KHR_texture_transform": {"scale": [0.5, 2.5], "offset": [0.1, 0.3]}}}
CLAMPED = {"wrapS": 33648, "wrapT": 33071, "magFilter": 9728, "minFilter": 9728}
PLAIN = {"magFilter": 9729, "minFilter": 9729}  # without mipmaps, of which each driver takes another one
UNLIT = {"extensions": {"KHR_materials_unlit": {}}}
CUP = {"cup": True}

MADE = {
    **{name: Made(name, factors=GREY) for name in ALL_MAPS},
    "all_maps": Made(*ALL_MAPS),
    "all_maps_with_tangents": Made(*ALL_MAPS, ball={"tangents": True}),
    "normal_with_tangents": Made("normal", factors=GREY, ball={"tangents": True}),
    "normal_scaled": Made("normal", factors=GREY, use={"scale": 0.4}),
    "normal_seen_from_behind": Made("normal", factors=GREY, doubleSided=True, ball=CUP, pitch=50),
    "tangents_seen_from_behind": Made("normal", factors=GREY, doubleSided=True, ball={**CUP, "tangents": True}, pitch=50),
    "mask": Made("holes", alphaMode="MASK", alphaCutoff=0.3),
    "mask_double_sided": Made("holes", alphaMode="MASK", doubleSided=True),
    "blend": Made("holes", alphaMode="BLEND"),
    "blend_double_sided": Made("holes", alphaMode="BLEND", doubleSided=True),
    "one_sided": Made("base_colour", ball=CUP, pitch=50),
    "double_sided": Made("base_colour", doubleSided=True, ball=CUP, pitch=50),
    "colours": Made(factors=GREY, ball={"colours": 3}),
    "colours_with_alpha": Made(alphaMode="BLEND", ball={"colours": 4}),
    "transform": Made("arrows", use=TURNED),
    "transform_stretched": Made("arrows", use=STRETCHED),
    "transform_of_normals": Made("normal", factors=GREY, use=TURNED),
    "second_coordinates": Made("arrows", "occlusion", use={"texCoord": 1}, ball={"second": True}),
    "emissive_strength": Made(factors=coloured(0, 0, 0), emissiveFactor=[0.1, 0.2, 0.05],
                              extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 3.5}}),
    "specular": Made("base_colour", extensions={
        "KHR_materials_specular": {"specularFactor": 0.7, "specularColorFactor": [1.0, 0.5, 2.0]}}),
    "without_specular": Made("base_colour", extensions={"KHR_materials_specular": {"specularFactor": 0}}),
    "ior": Made(factors=coloured(0.1, 0.2, 0.4, roughnessFactor=0.3), extensions={"KHR_materials_ior": {"ior": 2.2}}),
    "unlit": Made("base_colour", ball={"colours": 3}, sampler=PLAIN, **UNLIT),
    "unlit_transform": Made("arrows", use=TURNED, sampler=PLAIN, **UNLIT),
    "unlit_second_coordinates": Made("arrows", use={"texCoord": 1}, ball={"second": True}, sampler=PLAIN, **UNLIT),
    "unlit_blend": Made("holes", alphaMode="BLEND", sampler=PLAIN, **UNLIT),
    "unlit_mask": Made("holes", alphaMode="MASK", sampler=PLAIN, **UNLIT),
    "unlit_double_sided": Made("base_colour", doubleSided=True, ball=CUP, pitch=50, sampler=PLAIN, **UNLIT),
    "unlit_factor": Made(factors=coloured(0.05, 0.4, 0.9), **UNLIT),
    "clamped": Made("arrows", use=STRETCHED, sampler=CLAMPED),
    "smooth_metal": Made(factors=coloured(1.0, 0.77, 0.34, metallicFactor=1, roughnessFactor=0.2)),
    "rough_metal": Made(factors=coloured(0.9, 0.6, 0.5, metallicFactor=1, roughnessFactor=0.9)),
    "mirror": Made(factors=coloured(1, 1, 1, metallicFactor=1, roughnessFactor=0)),
    "plastic": Made(factors=coloured(0.7, 0.05, 0.05, roughnessFactor=0.15)),
    "flat": Made(factors=GREY, ball={"without": ("NORMAL",)}),
    "no_material": without_material(),
    "mirrored_node": Made("base_colour", ball=CUP, scale=[-1, 1, 1], pitch=50),
    "stretched_node": Made("base_colour", scale=[0.6, 1.4, 1]),
}
