"""Model with its joints, constraints, chains and clips."""

from __future__ import annotations

import html
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Optional, SupportsIndex, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _bendy
from ._bendy import c
from ._errors import Error
from ._items import Character, Floats, Items, Part, Vector3, Vector4, WithExtras, floats, parse_json, read_only, row_major
from ._material import Material, Texture
from ._mesh import Mesh, Submesh

if TYPE_CHECKING:
    from . import Conversion
    from ._pose import Pose


class Joint(WithExtras, c.Joint):
    """A joint of a model. Parents come before their children: `parent` is a number, None for a root. role: what it is in the body,
    "left_foot", or "none"; role_place: its place in a chain such as "tail"."""

    _kind = "joint"

    @property
    def rotation(self) -> Vector4:
        """At rest, relative to the parent: a unit quaternion x, y, z, w."""
        return self.rest.rotation

    @property
    def translation(self) -> Vector3:
        """At rest, relative to the parent: x, y, z in metres."""
        return self.rest.translation

    @property
    def scale(self) -> Vector3:
        """At rest, along the joint's axes: x, y, z."""
        return self.rest.scale

    def __index__(self) -> int:
        return self._number


class Constraint(Part, c.Constraint):
    """The limits of a joint's rotation relative to its rest pose, in the constraint's frame: X is the twist axis, Y and Z are the
    swing axes. Limits are -inf and inf on a free axis."""

    _kind = "constraint"

    @property
    def is_proposed(self) -> bool:
        """Whether it was guessed from the joints' names, not authored."""
        return bool(self.flags & c.PROPOSED)

    def clamp_rotation(self, rotation: ArrayLike) -> Tuple[Floats, float]:
        """The legal rotation that is nearest to a local rotation of the joint, (4,) float32, and the angle between the two in radians, 0 if
        the rotation is legal. Rotations are unit quaternions x, y, z, w. Raises ValueError."""
        clamped, violation = c.clamp_rotation(*self._of_model, c.to_constraint_space(*self._of_model, rotation))
        return c.from_constraint_space(*self._of_model, clamped), violation

    def clamp_translation(self, translation: ArrayLike) -> Floats:
        """The legal local translation of the joint that is nearest to this one: (3,) float32, metres. Raises ValueError."""
        return c.clamp_translation(*self._of_model, translation)

    @property
    def _of_model(self) -> Tuple[c.Model, int]:
        return self._character.handle, self._number

    def __repr__(self) -> str:
        return f"<bendy.Constraint of joint {self.joint}: {self.model}>"


class Chain(WithExtras, c.Chain):
    """An IK chain: the joints on the path from its start to its effector."""

    _kind = "chain"

    def _links(self) -> Tuple[List[int], List[float]]:
        joints, weights = np.empty(super().links, np.uint32), np.empty(super().links, np.float32)
        c.get_links(self._character.handle, self._number, joints, weights)
        return joints.tolist(), weights.tolist()

    @property
    def links(self) -> Tuple[int, ...]:
        """Numbers of the joints from start to effector."""
        return tuple(self._links()[0])

    @property
    def weights(self) -> Dict[int, float]:
        """Weight by joint; joints that are not in it have 1."""
        return {joint: weight for joint, weight in zip(*self._links()) if weight != 1.0}


class Marker:
    """A named time of a clip: a footstep, a hit. seconds: on the clip's time line. name: may be empty."""

    __slots__ = ("name", "seconds")

    def __init__(self, character: Character, clip: int, number: int) -> None:
        marker = c.get_marker(character.handle, clip, number)
        self.name: str = marker.name
        self.seconds: float = marker.seconds

    def __repr__(self) -> str:
        return f"<bendy.Marker {self.name!r} at {self.seconds} s>"


class Track:
    """Keys of one animated property.

    path: translation, rotation, scale or weights. target: number of the joint; for weights, of the mesh. interpolation: step, linear or
    cubic. times: (K,) float32, seconds, ascending. values: (K, components) float32: metres, unit quaternions x, y, z, w, factors or
    weights; for cubic (K, 3, components): in-tangent, value, out-tangent.
    """

    __slots__ = ("interpolation", "path", "target", "times", "values")

    def __init__(self, path: str, target: int, interpolation: str, times: Floats, values: Floats) -> None:
        self.path, self.target, self.interpolation, self.times, self.values = path, target, interpolation, times, values

    def __repr__(self) -> str:
        return f"<bendy.Track {self.path} of {self.target}, {len(self.times)} keys>"


def _shape(keys: int, components: int, interpolation: str) -> Tuple[int, ...]:
    return (keys, 3, components) if interpolation == "cubic" else (keys, components)


class Curve(Part, c.Curve):
    """A named curve: animated numbers other than joints and morph targets."""

    _kind = "curve"

    @property
    def kind(self) -> str:
        """The kind of the target: nothing, joint, material, mesh or texture."""
        return self.target_kind

    @property
    def times(self) -> Floats:
        """(K,) float32, seconds, without a copy."""
        times = super().times
        return read_only(np.empty(0, np.float32)) if times is None else times.array(self.keys)

    @property
    def values(self) -> Floats:
        """(K, components) float32, for cubic (K, 3, components)."""
        values = np.empty(_shape(self.keys, self.components, self.interpolation), np.float32)
        c.get_curve_values(self._character.handle, *self._place, values)
        return read_only(values)

    def sample(self, seconds: float) -> Floats:
        """(components,) float32, fresh: the value at a time of the clip. Raises ValueError for NaN."""
        values = np.empty(self.components, np.float32)
        c.sample_curve(self._character.handle, *self._place, seconds, values)
        return values


class FrameSequence(Part, c.FrameSequence):
    """Whole shapes of a mesh that a clip plays one after another, as in Quake II models: `frames` of them, from frame `first` on. Frame 0
    is the mesh itself, the others are its morph targets from Mesh.first_frame on. closed: the first one follows the last."""

    _kind = "frame_sequence"

    def mix(self, seconds: float) -> c.FrameMix:
        """The frames around a time of the clip: left, right, and fraction, the weight of the right one. Raises ValueError for NaN."""
        return c.mix_frames(self._character.handle, *self._place, seconds)


class Clip(WithExtras, c.Clip):
    """An animation clip. start, end: seconds."""

    _kind = "clip"

    def __init__(self, character: Character, number: int) -> None:
        super().__init__(character, number)
        self._tracks: Optional[Tuple[Track, ...]] = None

    @property
    def seconds(self) -> float:
        """Its length."""
        return self.end - self.start

    @property
    def loop(self) -> bool:
        """Whether it repeats."""
        return self.loops

    @property
    def tracks(self) -> Tuple[Track, ...]:
        """Tuple of Track. Their arrays are views of the file, without a copy, except for packed clips and the times of fixed frames."""
        if self._tracks is None:
            handle = self._character.handle
            tracks = [self._track(c.get_track(handle, self._number, number)) for number in range(c.track_count(handle, self._number))]
            if self.is_packed:
                paths = ("translation", "rotation", "scale")
                tracks += [Track(paths[path], joint, "linear", times, values)
                           for path, joint, times, values in _bendy.unpacked_tracks(handle, self._number)]
            self._tracks = tuple(tracks)
        return self._tracks

    def _track(self, track: c.Track) -> Track:
        if track.times is not None:
            times = track.times.array(track.keys)
        else:
            frames = np.arange(track.keys, dtype=np.float32)
            times = read_only(np.float32(self.start) + frames / np.float32(self.frame_rate))
        values = track.values.array(*_shape(track.keys, track.components, track.interpolation))
        return Track(track.path, track.target, track.interpolation, times, values)

    @property
    def markers(self) -> Tuple[Marker, ...]:
        """Tuple of Marker, ascending by time."""
        count = c.marker_count(self._character.handle, self._number)
        return tuple(Marker(self._character, self._number, number) for number in range(count))

    @property
    def frame_sequences(self) -> Tuple[FrameSequence, ...]:
        """Tuple of FrameSequence."""
        count = c.frame_sequence_count(self._character.handle, self._number)
        return tuple(FrameSequence(self._character, self._number, number) for number in range(count))

    @property
    def curves(self) -> Items[Curve]:
        """Items of Curve; one without a name is found by its path."""
        count = c.curve_count(self._character.handle, self._number)
        curves = [Curve(self._character, self._number, number) for number in range(count)]
        return Items("curve", curves, [curve.name or curve.path for curve in curves])


class Model:
    """A character, as bendy.open returns it: a mapped file. Immutable; threads may share it.

    Arrays of meshes and clips are views of the file: read-only, not copied, and valid as long as they are used, also after close().
    As a context manager it closes itself.
    """

    conversion: Optional[Conversion] = None  # of a source that was converted in memory: the Conversion, with its warnings

    def __init__(self, source: _bendy.Source, object: int = 0, check_sums: bool = True) -> None:
        try:
            handle = c.open_borrowed(source.bytes, c.OpenOptions(object=object, sums_later=not check_sums))
        except Error as error:
            raise _placed(error, source) from None
        self._character: Optional[Character] = Character(handle, source)
        self._lists: Dict[type, Any] = {}  # made on first use

    def _get(self) -> Character:
        character = self._character
        if character is None:
            raise ValueError("the model is closed")
        return character

    def _items(self, made: type) -> Any:
        character, found = self._get(), self._lists.get(made)
        if found is None:
            names = character.names(made._kind)
            found = self._lists.setdefault(made, Items(made._kind, [made(character, number) for number in range(len(names))], names))
        return found

    def _tuple(self, made: type, count: int) -> Any:
        character, found = self._get(), self._lists.get(made)
        return found or self._lists.setdefault(made, tuple(made(character, number) for number in range(count)))

    @property
    def name(self) -> str:
        """The object's name; may be empty."""
        return c.model_name(self._get().handle)

    @property
    def extras(self) -> Any:
        """Application-specific data of the object: parsed JSON, or None."""
        return parse_json(c.model_extras(self._get().handle))

    @property
    def file_extras(self) -> Any:
        """Application-specific data of the whole file: parsed JSON, or None."""
        return parse_json(c.file_extras(self._get().handle))

    @property
    def source(self) -> _bendy.Source:
        """The file's bytes."""
        return self._get().source

    @property
    def joints(self) -> Items[Joint]:
        """Items of Joint, parents before children."""
        return self._items(Joint)

    @property
    def parents(self) -> NDArray[np.int32]:
        """(J,) int32, fresh: the joints' parents; -1 for a root."""
        parents = c.joint_parents(self._get().handle)
        return np.empty(0, np.int32) if parents is None else parents.array(self._get().joints).astype(np.int32)

    @property
    def meshes(self) -> Items[Mesh]:
        """Items of Mesh."""
        return self._items(Mesh)

    @property
    def clips(self) -> Items[Clip]:
        """Items of Clip."""
        return self._items(Clip)

    @property
    def chains(self) -> Items[Chain]:
        """Items of Chain."""
        return self._items(Chain)

    @property
    def materials(self) -> Items[Material]:
        """Items of Material."""
        return self._items(Material)

    @property
    def textures(self) -> Items[Texture]:
        """Items of Texture."""
        return self._items(Texture)

    @property
    def constraints(self) -> Tuple[Constraint, ...]:
        """Tuple of Constraint, ascending by joint."""
        return self._tuple(Constraint, c.constraint_count(self._get().handle))

    @property
    def submeshes(self) -> Tuple[Submesh, ...]:
        """Tuple of Submesh."""
        return self._tuple(Submesh, c.submesh_count(self._get().handle))

    @property
    def vertices(self) -> int:
        """Number of vertices of all meshes."""
        return self._get().vertices

    @property
    def morph_targets(self) -> int:
        """Number of morph targets of all meshes."""
        return c.morph_target_count(self._get().handle)

    @property
    def has_levels(self) -> bool:
        """Whether the file has levels of detail."""
        return bool(c.has_levels(self._get().handle))

    @property
    def closed(self) -> bool:
        """Whether it has been closed."""
        return self._character is None

    def joint(self, joint: Union[str, SupportsIndex, Joint]) -> int:
        """The number of a joint by its name. Raises KeyError."""
        return self._get().find("joint", joint)

    def check_sums(self) -> None:
        """Checks the bytes against their sums, for a model opened with check_sums=False. Raises Error."""
        character = self._get()  # another thread may close the model
        try:
            c.check_sums(character.handle)
        except Error as error:
            raise _placed(error, character.source) from None

    def mask_below(self, joint: Union[str, SupportsIndex, Joint], inside: float = 1.0, outside: float = 0.0) -> Floats:
        """(J,) float32, fresh, for Pose.blend and add: `inside` for the joint and all below it, `outside` for the others. Raises
        KeyError."""
        character = self._get()
        mask = np.empty(character.joints, np.float32)
        c.mask_below(character.handle, character.find("joint", joint), inside, outside, mask)
        return mask

    def pose(self) -> Pose:
        """A Pose at rest. Raises ValueError if the model is closed."""
        from ._pose import Pose
        return Pose(self)

    def sample(self, clip: Union[str, SupportsIndex, Clip], seconds: float) -> Pose:
        """A Pose of a clip (its name, number or object) at a time. Raises KeyError, IndexError, ValueError."""
        return self.pose().sample(clip, seconds)

    def skin_clip(self, clip: Union[str, SupportsIndex, Clip], times: ArrayLike) -> Floats:
        """The vertices of a clip at many times, (T,) seconds: (T, N, 3) float32, metres, fresh. Raises KeyError, ValueError."""
        character = self._get()
        number, times = character.find("clip", clip), floats(times, (None,), "times").tolist()
        made = np.empty((len(times), character.vertices, 3), np.float32)
        pose, options = c.pose_new(character.handle), c.SkinOptions()
        for seconds, positions in zip(times, made):
            c.sample(pose, number, seconds)
            c.skin(pose, options, c.Vertices(character.vertices, positions))
        return made

    def pose_clip(self, clip: Union[str, SupportsIndex, Clip], times: ArrayLike) -> Floats:
        """The joint matrices of a clip at many times, (T,) seconds: (T, J, 4, 4) float32, fresh. Raises KeyError, ValueError."""
        character = self._get()
        number, times = character.find("clip", clip), floats(times, (None,), "times").tolist()
        made = np.empty((len(times), character.joints, 16), np.float32)
        pose = c.pose_new(character.handle)
        for seconds, matrices in zip(times, made):
            c.sample(pose, number, seconds)
            c.joint_matrices(pose, 0, None, matrices)
        return row_major(made)

    def summary(self) -> Dict[str, Any]:
        """A summary of the character: the dict of `bendy inspect --json`, described in docs/inspect.md."""
        return _bendy.summarize(self.source)

    def close(self) -> None:
        """Closes the file. Arrays, poses and other objects made from the model stay valid and keep the file open; any other use
        of the model raises ValueError."""
        self._character = None
        self._lists = {}

    def same_character(self, other: Model) -> bool:
        """Whether both are the same opened file, so that poses can be blended."""
        return self._get() is other._get()

    def __enter__(self) -> Model:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        if self.closed:
            return "<bendy.Model, closed>"
        return (f"<bendy.Model {self.name!r}: {len(self.joints)} joints, {len(self.meshes)} meshes, {self.vertices} vertices, "
                f"{len(self.clips)} clips>")

    def _repr_html_(self) -> str:
        if self.closed:
            return html.escape(repr(self))
        file = self.source.file
        return _summary_table(self.summary(), Path(file).name if file else self.name, len(self.source.bytes))


def _placed(error: Error, source: _bendy.Source) -> Error:
    """The error with its place in the file as attributes instead of at the end of its message."""
    message, _, place = error.message.rpartition(" (")
    if not place.endswith(f"offset {error.offset})"):
        message = error.message
    return type(error)(message, code=error.code, path=source.chunk_path(error.offset), offset=error.offset, file=source.file)


def _summary_table(summary: Optional[Dict[str, Any]], name: str, size: int) -> str:
    """The facts of `bendy inspect --html`, as a table for a notebook."""
    def listed(things, text):
        shown = [text(thing) for thing in things[:12]]
        more = [] if len(things) <= 12 else [f"... {len(things) - 12:,} more"]
        return f"{len(things):,}" + (": " + ", ".join(shown + more) if shown else "")

    def named(thing):
        return thing["name"] or f"#{thing['number']}"

    if summary is None:
        return html.escape(f"{name}: {size:,} bytes, with faults")
    rows = [("joints", f"{len(summary['joints']):,}")]
    if summary["constraints"] or summary["chains"]:
        rows.append(("rig", f"{summary['constraints']:,} constraints, chains " + listed(summary["chains"], named)))
    rows.append(("meshes", listed(summary["meshes"], lambda m: f"{named(m)} ({m['vertices']:,} vertices, {m['triangles']:,} triangles)")))
    targets = [target for mesh in summary["meshes"] for target in mesh["morphTargets"]]
    if targets:
        rows.append(("morph targets", listed(targets, str)))
    rows.append(("clips", listed(summary["clips"], lambda clip: f"{named(clip)} {clip['seconds']:.4g} s")))
    rows.append(("materials", listed(summary["materials"], named)))
    rows.append(("textures", listed(summary["textures"], named)))
    if summary["bounds"]:
        low, high = summary["bounds"]["min"], summary["bounds"]["max"]
        rows.append(("bounds", " x ".join(f"{b - a:.4g}" for a, b in zip(low, high)) + " m"))
    rows.append(("bytes", ", ".join(f"{kind} {count:,}" for kind, count in summary["bytesByKind"].items())))
    cells = "".join(f"<tr><th style='text-align:left'>{html.escape(label)}</th><td style='text-align:left'>{html.escape(text)}</td></tr>"
                    for label, text in rows)
    return f"<table><caption><b>{html.escape(name)}</b>, {size:,} bytes</caption>{cells}</table>"
