"""Pose: sampling, blending, inverse kinematics, skinning."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, NamedTuple, Optional, Sequence, SupportsIndex, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike

from ._bendy import c
from ._body_reach import BodyReach, BodyReached, EffectorTarget
from ._items import Character, Floats, check_units, column_major, floats, row_major
from ._mesh import Lod, Mesh
from ._model import Chain, Clip, Joint

if TYPE_CHECKING:
    from ._model import Model

# Columns of a local transform in the array.
_COLUMNS = {"rotations": slice(0, 4), "translations": slice(4, 7), "scales": slice(7, 10)}
_ALL_LINEAR = c.SkinOptions()


class ReachResult(c.ReachResult):
    """How near a chain came to its target.

    status: reached; out_of_reach: farther away than the chain is long; not_reached: stopped at the nearest solution found; aimed: the tip
    points at the target. distance: metres left between the tip and the target. angle: radians left, if the target has a rotation; for an
    aim, between the tip's Z axis and the line to the target. iterations: number of iterations made.
    """

    def __init__(self, character: Character, chain: int, options: c.ReachOptions) -> None:
        super().__init__()
        self._of = character, chain, options

    @property
    def reached(self) -> bool:
        """Whether the status is reached or aimed."""
        return self.status in ("reached", "aimed")

    def __bool__(self) -> bool:
        return self.reached

    def __repr__(self) -> str:
        character, chain, options = self._of
        solver = c.get_chain(character.handle, chain).solver if options.solver == "any" else options.solver
        left = f"{self.angle:.6g} rad" if solver == "aim" else f"{self.distance:.6g} m"
        return f"<bendy.ReachResult {self.status}, {left} left>"


class ReachRequest(NamedTuple):
    """One chain to move, for Pose.reach_chains: the arguments of Pose.reach. options: a dict of its further ones, or None."""

    chain: Union[str, SupportsIndex, Chain]
    target: ArrayLike
    rotation: Optional[ArrayLike] = None
    options: Optional[dict] = None


class ReachState:
    """What the chains of one character did last. With it (`state` of Pose.reach), chains that reach in frame after frame do not jump: where
    two poses are about equally good, a chain keeps the one that it has; where another one has been better for a tenth of a second, it
    goes there at a limited speed. Each chain reaches once a frame. For one thread at a time."""

    follows: "bendy_reach_state"

    def __init__(self, model: Model) -> None:
        """Knows of no chain. Raises ValueError if the model is closed."""
        self._character: Character = model._get()
        self._handle: c.ReachState = c.reach_state_new(self._character.handle)


class Pose:
    """A model in one position: local transforms, morph target weights, and the matrices and vertices computed from them. For one
    thread at a time: a call while another thread uses the pose raises RuntimeError. Methods that change the pose return it,
    except reach."""

    __slots__ = ("__weakref__", "_character", "_handle", "_skinned")
    follows: "bendy_pose"

    def __init__(self, model: Model) -> None:
        """At rest. Raises ValueError if the model is closed."""
        self._character: Character = model._get()
        self._handle: c.Pose = c.pose_new(self._character.handle)
        self._skinned: Any = None  # the last arguments of skin with `out`, checked

    def copy(self) -> Pose:
        """A copy of this pose."""
        made = Pose.__new__(Pose)
        made._character, made._handle, made._skinned = self._character, c.pose_copy(self._handle), None
        return made

    __copy__ = copy

    def reach(self, chain: Union[str, SupportsIndex, Chain], target: ArrayLike, *, rotation: Optional[ArrayLike] = None,
              **options: "bendy_reach_options") -> ReachResult:
        """Moves an IK chain (its name, number or object) so that its tip reaches `target`, (3,) metres in model space, and there has
        `rotation`, a unit quaternion x, y, z, w. Joints stay within their constraints. A target that is not reached is a result, not an
        error.

        **options

        Raises KeyError, IndexError, ValueError."""
        number, taken = self._character.find("chain", chain), c.ReachOptions(**options)
        return c.reach(self._handle, number, *_target(target, rotation), taken, ReachResult(self._character, number, taken))

    def reach_chains(self, requests: Sequence[ReachRequest]) -> List[ReachResult]:
        """Moves several chains, one after another, and returns a result for each; faster than as many calls of reach, since limbs that do
        not move one another are solved side by side. If one request is wrong, nothing is moved. Raises as reach does."""
        listed, results = [], []
        for request in requests:
            chain, target, rotation, options = ReachRequest(*request)
            given = dict(options or {})
            given["state"] = getattr(given.get("state"), "_handle", given.get("state"))
            number, taken = self._character.find("chain", chain), c.ReachOptions(**given)
            position, wanted = _target(target, rotation)
            listed.append(c.ReachRequest(chain=number, position=position, rotation=wanted, options=taken))
            results.append(ReachResult(self._character, number, taken))
        return c.reach_chains(self._handle, listed, results)

    def reach_body(self, body: BodyReach, targets: Sequence[Union[ArrayLike, EffectorTarget]]) -> BodyReached:
        """Full-body IK: moves the joints between the body's root and its effectors so that each effector is at its target, or as near to it
        as all targets, weighted, allow; within the joints' constraints and starting from the current pose. IK chains play no part.

        targets: one for each effector, (3,) metres in model space or an EffectorTarget. A target that is not reached is a result, not an
        error. Raises ValueError, TypeError; the pose is then as before."""
        listed = [one if isinstance(one, EffectorTarget) else EffectorTarget(one) for one in targets]
        return c.reach_body(self._handle, body._handle, listed, BodyReached())

    def skin(self, mesh: Union[None, str, SupportsIndex, Mesh] = None, *, normals: bool = False, tangents: bool = False,
             method: str = "linear", lod: Optional[Lod] = None, out: Any = None) -> Any:
        """The posed vertices in model space: (N, 3) float32 positions in metres, of all meshes one after another (Mesh.first_vertex) or
        of one `mesh`. With normals, (N, 3) unit, or tangents, (N, 4), a tuple in that order. method: linear or dual_quaternion. lod: a
        level of detail, see Model.lod: a mesh has only the vertices that are left; of all meshes, vertices that are left out are zero.

        Fresh arrays, or those in `out` (one, or a tuple): float32, writeable, of the same shapes; rows may have gaps between them, as in
        interleaved buffers. Raises TypeError, ValueError, KeyError, IndexError."""
        last = self._skinned
        if last is not None:
            known, known_mesh, known_normals, known_tangents, known_method, known_lod, options, vertices, arrays = last
            if (out is known and mesh is known_mesh and normals is known_normals and tangents is known_tangents and method is known_method
                    and lod is known_lod and _are_writeable(arrays)):
                c.skin(self._handle, options, vertices)
                return out
        number = None if mesh is None else self._character.find("mesh", mesh)
        options, count = self._skin_options(number, method, lod)
        wanted = [("positions", 3)] + [("normals", 3)] * bool(normals) + [("tangents", 4)] * bool(tangents)
        if out is None:
            make = np.empty if lod is None else np.zeros
            arrays = [make((count, columns), np.float32) for _, columns in wanted]
            strides = [0] * len(arrays)  # without gaps
        else:
            arrays = [out] if len(wanted) == 1 and not isinstance(out, tuple) else list(out)
            if len(arrays) != len(wanted):
                raise ValueError(f"out must have one array for each of the {len(wanted)} attributes")
            strides = [_stride(array, count, columns, name) for array, (name, columns) in zip(arrays, wanted)]
        places = [place for pair in zip(arrays, strides) for place in pair]
        if tangents and not normals:
            places[2:2] = None, 0
        vertices = c.Vertices(count, *places)
        if isinstance(out, (np.ndarray, tuple)):
            self._skinned = out, mesh, normals, tangents, method, lod, options, vertices, arrays
        c.skin(self._handle, options, vertices)
        return arrays[0] if len(arrays) == 1 else tuple(arrays)

    def _skin_options(self, mesh: Optional[int], method: str, lod: Optional[Lod]) -> Tuple[c.SkinOptions, int]:
        """With the number of vertices."""
        handle = self._character.handle
        if mesh is None and lod is None and method == "linear":
            return _ALL_LINEAR, self._character.vertices
        count = self._character.vertices if mesh is None else c.get_mesh(handle, mesh).vertices
        if lod is None:
            return c.SkinOptions(mesh=mesh, method=method), count
        if lod._character is not self._character:
            raise ValueError("the level of detail belongs to another model")
        if mesh is not None:
            count = c.lod_vertices(lod._handle, mesh)
        return c.SkinOptions(mesh=mesh, method=method, lod=lod._handle), count

    @property
    def matrices(self) -> Floats:
        """(J, 4, 4) float32, [row, column], fresh: joint space to model space."""
        columns = np.empty((self._character.joints, 4, 4), np.float32)
        c.joint_matrices(self._handle, 0, None, columns)
        return columns.swapaxes(1, 2).copy()

    def palette(self, mesh: Union[str, SupportsIndex, Mesh]) -> Floats:
        """(B, 3, 4) float32, fresh: the skinning matrices of a mesh, for skinning elsewhere; the last row, 0 0 0 1, is left out. Empty for
        a rigid mesh. Raises KeyError, IndexError."""
        number = self._character.find("mesh", mesh)
        matrices = np.empty((c.get_mesh(self._character.handle, number).bones, 16), np.float32)
        if len(matrices):
            c.bone_matrices(self._handle, number, matrices)
        return row_major(matrices)[:, :3].copy()

    def socket(self, joint: Union[str, SupportsIndex, Joint], offset: Optional[ArrayLike] = None, *,
               model_to_world: Optional[ArrayLike] = None, keeps_size: bool = True) -> Floats:
        """(4, 4) float32, [row, column], fresh: the matrix of a thing attached to a joint: model_to_world @ joint @ offset.
        keeps_size: without the joint's scale. Raises KeyError, IndexError, ValueError."""
        given = {} if offset is None else {"offset": column_major(offset, "offset")}
        socket = c.Socket(joint=self._character.find("joint", joint), keeps_size=keeps_size, **given)
        world = None if model_to_world is None else column_major(model_to_world, "model_to_world")
        return row_major(c.socket_matrix(self._handle, socket, world))

    @property
    def bounds(self) -> Floats:
        """(2, 3) float32, fresh: minimum and maximum corner of a box around all vertices, metres; the minimum is above the maximum if
        there are none."""
        box = c.bounds_of_pose(self._character.bounds, self._handle)
        return np.float32([box.minimum, box.maximum])

    def _local(self) -> Floats:
        transforms = np.empty((self._character.joints, 10), np.float32)
        c.get_local(self._handle, 0, transforms)
        return transforms

    def _set_local(self, numbers: ArrayLike, name: str) -> None:
        transforms = self._local()
        columns = transforms[:, _COLUMNS[name]]
        columns[:] = floats(numbers, columns.shape, name)
        if name == "rotations":
            check_units(columns, "rotation {}")
        c.set_local(self._handle, 0, transforms)

    @property
    def rotations(self) -> Floats:
        """(J, 4) float32, fresh: unit quaternions x, y, z, w relative to the parent. Assign the whole array; raises ValueError
        for another shape and for anything but unit quaternions."""
        return self._local()[:, _COLUMNS["rotations"]].copy()

    @rotations.setter
    def rotations(self, numbers: ArrayLike) -> None:
        self._set_local(numbers, "rotations")

    @property
    def translations(self) -> Floats:
        """(J, 3) float32, fresh: metres, relative to the parent. Assign the whole array; raises ValueError."""
        return self._local()[:, _COLUMNS["translations"]].copy()

    @translations.setter
    def translations(self, numbers: ArrayLike) -> None:
        self._set_local(numbers, "translations")

    @property
    def scales(self) -> Floats:
        """(J, 3) float32, fresh: along the joints' axes. Assign the whole array; raises ValueError."""
        return self._local()[:, _COLUMNS["scales"]].copy()

    @scales.setter
    def scales(self, numbers: ArrayLike) -> None:
        self._set_local(numbers, "scales")

    @property
    def morph_weights(self) -> Floats:
        """(M,) float32, fresh: usually 0 to 1, of all meshes (Mesh.first_morph_target). Assign the whole array; raises ValueError."""
        weights = np.empty(c.morph_target_count(self._character.handle), np.float32)
        c.get_weights(self._handle, 0, weights)
        return weights

    @morph_weights.setter
    def morph_weights(self, numbers: ArrayLike) -> None:
        c.set_weights(self._handle, 0, floats(numbers, (c.morph_target_count(self._character.handle),), "morph_weights"))

    def __repr__(self) -> str:
        return f"<bendy.Pose of {c.model_name(self._character.handle)!r}, {self._character.joints} joints>"


def _are_writeable(arrays: List[np.ndarray]) -> bool:
    for array in arrays:
        if not array.flags.writeable:
            return False
    return True


def _target(target: ArrayLike, rotation: Optional[ArrayLike]) -> Tuple[Floats, Optional[Floats]]:
    position = floats(target, (3,), "target")
    if rotation is None:
        return position, None
    wanted = floats(rotation, (4,), "rotation")
    check_units(wanted, "rotation")
    return position, wanted


def _stride(given: Any, rows: int, columns: int, name: str) -> int:
    """The stride of the rows of an array that the caller gave for vertices, in bytes. Raises TypeError, ValueError."""
    shape = f"({rows}, {columns})"
    if not isinstance(given, np.ndarray) or given.dtype != np.float32:
        raise TypeError(f"out: {name} must be a float32 array of the shape {shape}")
    if given.shape != (rows, columns):
        raise ValueError(f"out: {name} must have the shape {shape}")
    if not given.flags.writeable:
        raise ValueError(f"out: {name} is read-only")
    row, column = given.strides
    if rows and (not given.flags.aligned or column != 4 or row % 4 != 0 or (rows > 1 and row < 4 * columns)):
        raise ValueError(f"out: {name} must have its components next to each other and its rows in order")
    return row if rows > 1 else 4 * columns
