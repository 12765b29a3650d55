"""Materials, their uses of textures, and textures."""

from __future__ import annotations

import math
from typing import Any, Dict, List, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._bendy import c, floats
from ._items import Floats, WithExtras, parse_json

_FIELDS = [name for name, value in vars(c.TextureUse).items() if isinstance(value, property)]


class TextureUse(c.TextureUse):
    """How a material uses a texture. `texture` is its number, `set` that of the texture coordinates; offset, scale and rotation
    change the coordinates, as in KHR_texture_transform."""

    def __init__(self, use: c.TextureUse) -> None:
        super().__init__(**{name: getattr(use, name) for name in _FIELDS})

    @property
    def matrix(self) -> NDArray[np.float64]:
        """(3, 3), [row, column]: the coordinates of the image, u, v, 1, are this times those of the mesh."""
        cosine, sine = math.cos(self.rotation), math.sin(self.rotation)
        (width, height), (u, v) = self.scale, self.offset
        return np.array([[cosine * width, sine * height, u], [-sine * width, cosine * height, v], [0.0, 0.0, 1.0]])

    def transform(self, coordinates: ArrayLike) -> Floats:
        """The coordinates of the image for those of a mesh: (N, 2) float32, fresh."""
        matrix = self.matrix
        return np.float32(floats(coordinates, (None, 2), "coordinates") @ matrix[:2, :2].T + matrix[:2, 2])


class Material(WithExtras, c.Material):
    """A metallic-roughness material; colours are linear, those of base_colour and emissive textures sRGB."""

    _kind = "material"

    @property
    def textures(self) -> Dict[str, TextureUse]:
        """Its uses of textures: base_colour, metallic_roughness, normal, occlusion and emissive, as far as it has them."""
        uses = {"base_colour": self.base_colour_texture, "metallic_roughness": self.metallic_roughness_texture,
                "normal": self.normal_texture, "occlusion": self.occlusion_texture, "emissive": self.emissive_texture}
        return {name: use for name, use in uses.items() if use is not None}

    @property
    def base_colour_texture(self) -> Optional[TextureUse]:
        """Multiplied with base_colour; None if there is none."""
        return _used(super().base_colour_texture)

    @property
    def metallic_roughness_texture(self) -> Optional[TextureUse]:
        """Green is multiplied with roughness, blue with metallic; None if there is none."""
        return _used(super().metallic_roughness_texture)

    @property
    def normal_texture(self) -> Optional[TextureUse]:
        """In tangent space, x and y times normal_scale; None if there is none."""
        return _used(super().normal_texture)

    @property
    def occlusion_texture(self) -> Optional[TextureUse]:
        """Red is the occlusion, by occlusion_strength; None if there is none."""
        return _used(super().occlusion_texture)

    @property
    def emissive_texture(self) -> Optional[TextureUse]:
        """Multiplied with emissive; None if there is none."""
        return _used(super().emissive_texture)

    @property
    def extensions(self) -> Dict[str, Any]:
        """The extensions of glTF that the other members do not express, by name, as JSON: KHR_materials_clearcoat, ... Numbers of
        textures in them are the model's. Raises ValueError if the file has something else there."""
        found = parse_json(super().extensions)
        return {} if found is None else found


def _used(use: c.TextureUse) -> Optional[TextureUse]:
    return None if use.texture is None else TextureUse(use)


class Texture(WithExtras, c.Texture):
    """One or more encodings of an image."""

    _kind = "texture"

    @property
    def images(self) -> List[Dict[str, Any]]:
        """In order of preference: a dict with type (png, jpeg, ktx2, webp, avif, other), bytes ((size,) uint8 without a copy, or None),
        uri (or None), same_as (the number of the texture whose image it is, or None)."""
        images = []
        for place in range(super().images):
            image = c.get_image(self._character.handle, self._number, place)
            images.append({
                "type": image.media, "uri": image.uri or None,
                "same_as": None if (image.texture, image.image) == (self._number, place) else image.texture,
                "bytes": None if image.bytes is None or image.byte_count == 0 else image.bytes.array(image.byte_count)})
        return images
