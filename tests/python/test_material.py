"""Materials: everything that a file stores, under the names of the C API."""

import json
import math

import bendy
import numpy as np
import pytest

TRANSFORM = {"offset": [0.25, 0.5], "rotation": 0.5, "scale": [2, 3], "texCoord": 1}
TEXTURES = ("base_colour", "metallic_roughness", "normal", "occlusion", "emissive")
MATERIALS = [
    {
        "name": "Coat",
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.5, 0.25, 0.125, 0.75], "metallicFactor": 0.25, "roughnessFactor": 0.5,
            "baseColorTexture": {"index": 1, "extensions": {"KHR_texture_transform": TRANSFORM}},
            "metallicRoughnessTexture": {"index": 0}},
        "normalTexture": {"index": 2, "scale": 0.5, "texCoord": 1},
        "occlusionTexture": {"index": 0, "strength": 0.25},
        "emissiveTexture": {"index": 1}, "emissiveFactor": [1, 0.5, 0.25],
        "alphaMode": "MASK", "alphaCutoff": 0.75, "doubleSided": True,
        "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 2}}},
        "extras": {"cloth": "wool"}},
    {"extensions": {"KHR_materials_unlit": {}}, "alphaMode": "BLEND"}]


@pytest.fixture
def materials():
    image = {"uri": "data:image/png;base64,iVBORw0KGgo="}
    source = {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{}], "materials": MATERIALS, "images": [image],
              "textures": [{"source": 0}] * 3,
              "extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_unlit", "KHR_texture_transform"]}
    return bendy.convert(json.dumps(source).encode()).open().materials


def test_factors_and_modes(materials):
    coat, other = materials
    assert coat.base_colour == (0.5, 0.25, 0.125, 0.75) and coat.emissive == (1.0, 0.5, 0.25)
    assert (coat.metallic, coat.roughness, coat.normal_scale, coat.occlusion_strength, coat.alpha_cutoff) == (0.25, 0.5, 0.5, 0.25, 0.75)
    assert (coat.alpha_mode, coat.double_sided, coat.unlit) == ("mask", True, False)
    assert (other.alpha_mode, other.double_sided, other.unlit) == ("blend", False, True)


def test_every_texture_and_its_coordinates(materials):
    coat, other = materials
    uses = [getattr(coat, f"{name}_texture") for name in TEXTURES]
    assert all(isinstance(use, bendy.TextureUse) for use in uses)
    assert [(use.texture, use.set) for use in uses] == [(1, 1), (0, 0), (2, 1), (0, 0), (1, 0)]
    assert {name: use.texture for name, use in coat.textures.items()} == dict(zip(TEXTURES, (1, 0, 2, 0, 1)))
    assert other.textures == {} and other.normal_texture is None


def test_transforms_are_those_of_the_specification(materials):
    use = materials["Coat"].base_colour_texture
    assert (use.offset, use.scale, use.rotation) == ((0.25, 0.5), (2.0, 3.0), 0.5)
    u, v = 0.3, 0.7
    expected = (math.cos(0.5) * 2 * u + math.sin(0.5) * 3 * v + 0.25, -math.sin(0.5) * 2 * u + math.cos(0.5) * 3 * v + 0.5)
    moved = use.transform([[u, v], [0, 0]])
    assert moved.dtype == np.float32 and moved == pytest.approx(np.array([expected, (0.25, 0.5)]), abs=1e-6)
    assert use.matrix @ (u, v, 1) == pytest.approx((*expected, 1))
    assert (materials["Coat"].emissive_texture.matrix == np.identity(3)).all()
    with pytest.raises(ValueError):
        use.transform([1, 2, 3])


def test_extensions_and_extras_are_data(materials):
    coat, other = materials
    assert coat.extensions["KHR_materials_clearcoat"] == {"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 2}}
    assert coat.extras == {"cloth": "wool"}
    assert other.extensions == {} and other.extras is None
