"""Meshes with their streams and morph targets, submeshes, materials, textures, levels of detail."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Optional, SupportsIndex, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _bendy
from ._bendy import c
from ._items import Character, Floats, Items, Part, WithExtras, read_only

if TYPE_CHECKING:
    from ._model import Model


class MorphTarget(Part, c.MorphTarget):
    """Displacements of a mesh's vertices, or a frame of it."""

    _kind = "morph_target"

    def __init__(self, character: Character, mesh: int, first: int, number: int) -> None:
        super().__init__(character, first + number)
        self._mesh, self._number = mesh, number

    def _stored(self) -> Tuple[bool, Optional[NDArray[Any]], Optional[Floats], Optional[Floats]]:
        return _bendy.stored_target(self._character.handle, self._mesh, self._number)

    @property
    def is_frame(self) -> bool:
        """Whether it is a whole shape, as in Quake II models; positions and normals are then None."""
        return self._stored()[0]

    @property
    def vertices(self) -> Optional[NDArray[Any]]:
        """(K,) unsigned: the vertices that it moves, ascending, without a copy; None: all of them, in order."""
        vertices = self._stored()[1]
        return None if vertices is None else vertices.reshape(-1)

    @property
    def positions(self) -> Optional[Floats]:
        """(K, 3) float32, metres: displacements at weight 1, without a copy if stored as floats; None if there are none."""
        return self._stored()[2]

    @property
    def normals(self) -> Optional[Floats]:
        """(K, 3) float32: displacements of normals; None if there are none."""
        return self._stored()[3]


class Mesh(WithExtras, c.Mesh):
    """A mesh with N vertices. Arrays are read-only and keep the file open. They are views of the file, without a copy, if it stores
    floats, as exact files do; compact files are decoded at the first access. `stored` has all streams as they are, never copied."""

    _kind = "mesh"

    def __init__(self, character: Character, number: int) -> None:
        super().__init__(character, number)
        self._arrays: Dict[Tuple[str, int], Floats] = {}  # made on first use
        self._targets: Optional[Items[MorphTarget]] = None

    def _streams(self, kind: str) -> List[Tuple[int, c.Stream]]:
        handle = self._character.handle
        streams = ((number, c.get_stream(handle, self._number, number)) for number in range(c.stream_count(handle, self._number)))
        return [(number, stream) for number, stream in streams if stream.kind == kind]

    def _floats_of(self, number: int, stream: c.Stream) -> Floats:
        if stream.type == "f32" and stream.data is not None:
            return stream.data.array(stream.data_size).view(np.float32).reshape(stream.elements, stream.components)
        array = np.empty((stream.elements, stream.components), np.float32)
        c.get_numbers(self._character.handle, self._number, number, array)
        return read_only(array)

    def _all_floats(self, kind: str) -> Tuple[Floats, ...]:
        made = []
        for place, (number, stream) in enumerate(self._streams(kind)):
            array = self._arrays.get((kind, place))
            if array is None:
                array = self._arrays[kind, place] = self._floats_of(number, stream)
            made.append(array)
        return tuple(made)

    def _floats(self, kind: str) -> Optional[Floats]:
        found = self._arrays.get((kind, 0))
        return found if found is not None else next(iter(self._all_floats(kind)), None)

    @property
    def is_rigid(self) -> bool:
        """Whether it has no bones and weights."""
        return self.influences == 0

    @property
    def positions(self) -> Floats:
        """(N, 3) float32, metres, in mesh space."""
        found = self._floats("positions")
        return read_only(np.empty((0, 3), np.float32)) if found is None else found

    @property
    def normals(self) -> Optional[Floats]:
        """(N, 3) float32, unit length; None if there are none."""
        return self._floats("normals")

    @property
    def tangents(self) -> Optional[Floats]:
        """(N, 4) float32: unit x, y, z and the handedness, +1 or -1; None if there are none."""
        return self._floats("tangents")

    @property
    def texture_coords(self) -> Tuple[Floats, ...]:
        """One (N, 2) float32 array per set."""
        return self._all_floats("texture_coords")

    @property
    def colours(self) -> Tuple[Floats, ...]:
        """One (N, 3) or (N, 4) float32 array per set, 0 to 1, linear."""
        return self._all_floats("colours")

    @property
    def attributes(self) -> Dict[str, Floats]:
        """The author's own attributes by name: (N, components) float32."""
        names = (stream.name for _, stream in self._streams("attribute"))
        return dict(zip(names, self._all_floats("attribute")))

    @property
    def bones(self) -> Optional[NDArray[Any]]:
        """(N, influences) unsigned: indices into `palette`, never copied; None for a rigid mesh."""
        return self.stored.get("bones")

    @property
    def weights(self) -> Optional[Floats]:
        """(N, influences) float32, 0 to 1; None for a rigid mesh."""
        return self._floats("weights")

    @property
    def palette(self) -> NDArray[np.uint32]:
        """(B,) uint32: numbers of the joints that bones refer to."""
        return _bendy.palette(self._character.handle, self._number)

    @property
    def inverse_bind(self) -> Floats:
        """(B, 4, 4) float32, [row, column]: mesh space to joint space at bind time."""
        return _bendy.inverse_bind(self._character.handle, self._number)

    @property
    def indices(self) -> Optional[NDArray[Any]]:
        """(M,) uint16 or uint32: the index list that submeshes are ranges of; None if there is none."""
        found = self.stored.get("indices")
        return None if found is None else found.reshape(-1)

    def triangles(self, share: float = 1.0) -> NDArray[np.uint32]:
        """(T, 3) uint32, fresh: the mesh's triangles, of all submeshes. `share`, 0 to 1, is the level of detail: that share of the
        model's triangles, if the file has a collapse sequence. Raises ValueError."""
        return _triangles(_make_lod(self._character, share), self._character, self._number)

    @property
    def morph_targets(self) -> Items[MorphTarget]:
        """Items of MorphTarget."""
        if self._targets is None:
            targets = [MorphTarget(self._character, self._number, self.first_morph_target, number) for number in range(self.targets)]
            self._targets = Items("morph target", targets, [target.name for target in targets])
        return self._targets

    @property
    def stored(self) -> Dict[str, NDArray[Any]]:
        """All streams by name as stored, never copied: (elements, components) of the file's own type."""
        return _bendy.stored_streams(self._character.handle, self._number)


class Submesh(Part, c.Submesh):
    """One draw call: a range of a mesh's index list with one material."""

    _kind = "submesh"


def _make_lod(character: Character, share: float) -> c.Lod:
    if not share >= 0:
        raise ValueError("share must be 0 to 1")
    lod = c.lod_new(character.handle)
    c.lod_set_share(lod, min(share, 1.0))
    return lod


def _triangles(lod: c.Lod, character: Character, mesh: int) -> NDArray[np.uint32]:
    indices = c.lod_indices(lod, mesh)
    parts = [np.empty(0, np.uint32)]
    for number in range(c.submesh_count(character.handle)):
        submesh = c.lod_submesh(lod, number)
        if submesh.mesh == mesh and submesh.topology == "triangles":
            parts.append(indices[submesh.first:submesh.first + submesh.count])
    return np.concatenate(parts).reshape(-1, 3)


class Lod:
    """A model at one level of detail. It never changes, so threads may share it."""

    def __init__(self, model: Model, share: float = 1.0) -> None:
        """About this share of the model's triangles: 1 keeps all, 0 as few as the file's collapse sequence allows; without a sequence,
        all. Raises ValueError."""
        self._character = model._get()
        self._handle = _make_lod(self._character, share)
        self._share = float(share)

    @property
    def share(self) -> float:
        """As requested."""
        return self._share

    @property
    def triangle_count(self) -> int:
        """In all meshes."""
        return c.get_lod(self._handle).triangles

    @property
    def error(self) -> float:
        """Deviation of the surface in metres, as the file states it; 0 at full detail or if it does not."""
        return c.get_lod(self._handle).error

    def vertex_count(self, mesh: Union[str, SupportsIndex, Mesh]) -> int:
        """The number of a mesh's vertices that are left: its first ones. Raises KeyError, IndexError."""
        return c.lod_vertices(self._handle, self._character.find("mesh", mesh))

    def triangles(self, mesh: Union[str, SupportsIndex, Mesh]) -> NDArray[np.uint32]:
        """(T, 3) uint32, fresh: the triangles of a mesh. Raises KeyError, IndexError."""
        return _triangles(self._handle, self._character, self._character.find("mesh", mesh))
