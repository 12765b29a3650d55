"""Clips over time: Playback, Crossfade, Fade, root motion, clips of other files, crowds."""

from __future__ import annotations

import itertools
import math
import os
import threading
from typing import TYPE_CHECKING, Any, List, Optional, Sequence, SupportsIndex, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._bendy import c
from ._items import Character, Floats, Vector3, Vector4, floats, numbers_or_none, row_major
from ._mesh import Lod, Mesh
from ._model import Clip, Joint, Marker
from ._pose import Pose

if TYPE_CHECKING:
    from ._model import Model

_MOST_THREADS = 256
_AT_ONCE = 8  # members that a crowd computes together


class PlayedInterval(c.Played):
    """The interval that one step of a Playback has played, across the ends."""

    def __init__(self, character: Character, clip: int) -> None:
        super().__init__()
        self._character, self._clip = character, clip

    def markers(self, limit: int = 1000) -> List[Marker]:
        """The markers that were passed, in playback order: a list of at most `limit` Marker."""
        numbers = np.empty(min(limit, self.marker_count), np.uint32)
        count = c.collect_markers(self._character.handle, self._clip, self, numbers)
        return [Marker(self._character, self._clip, number) for number in numbers[:count].tolist()]

    @property
    def marker_count(self) -> int:
        """How many markers were passed; one that was passed twice counts twice."""
        return c.count_markers(self._character.handle, self._clip, self)

    @property
    def is_empty(self) -> bool:
        """Whether nothing was played: the clip is paused or at its end."""
        return self.passes == 0 and all(span.from_ == span.to and not span.has_end for span in (self.first, self.last))


def _clock(character: Character, clip: int, mode: Optional[str], speed: float) -> c.Playback:
    clock = c.playback_new(character.handle, clip)
    if mode is not None:
        c.playback_set_mode(clock, mode)
    c.playback_set_speed(clock, speed)
    return clock


class Playback:
    """The clock of a clip. Time does not drift, however long it plays."""

    follows: "bendy_playback"

    def __init__(self, clip: Clip, mode: Optional[str] = None, speed: float = 1.0) -> None:
        """At the clip's start. clip: a Clip. mode: once, repeat or ping_pong; None: as the clip says. speed: 1 is as authored, negative is
        backwards. Raises TypeError, ValueError."""
        if not isinstance(clip, Clip):
            raise TypeError("expected a Clip, as model.clips[\"Walk\"]")
        self._clip = clip
        self._handle = _clock(clip._character, clip.number, mode, speed)

    def advance(self, seconds: float) -> PlayedInterval:
        """Advances by seconds times the speed; returns the PlayedInterval. Raises ValueError."""
        return c.playback_advance(self._handle, seconds, PlayedInterval(self._clip._character, self._clip.number))

    @property
    def clip(self) -> Clip:
        """The Clip."""
        return self._clip


ease = c.ease


class Fade:
    """A weight that moves towards another over time: of a layer, of an additive pose."""

    follows: "bendy_fade"

    def __init__(self, weight: float = 0.0) -> None:
        """At this weight. Raises ValueError."""
        self._handle = c.fade_new(weight)


class Playing(c.Playing):
    """One of the clips of a Crossfade, as it was after the last advance. seconds: the time on the clip's time line. share: of the result;
    they sum to 1. weight: how far it covers those that began before it, 0 to 1."""

    def __init__(self, character: Character, crossfade: c.Crossfade, number: int) -> None:
        super().__init__()
        self._character = character
        c.get_playing(crossfade, number, self)
        self._played = c.get_played(crossfade, number, PlayedInterval(character, super().clip))

    @property
    def clip(self) -> Clip:
        """The Clip."""
        return Clip(self._character, super().clip)

    @property
    def played(self) -> PlayedInterval:
        """The PlayedInterval of the last advance: for markers and root motion."""
        return self._played


class Crossfade:
    """Clips that each fade in over those before; an interrupted clip plays on beneath. At most four at a time."""

    def __init__(self, model: Model) -> None:
        """Nothing plays yet. Raises ValueError if the model is closed."""
        self._character = model._get()
        self._handle = c.crossfade_new(self._character.handle)
        self._scratch = c.pose_new(self._character.handle)

    def play(self, clip: Union[str, SupportsIndex, Clip], fade: float = 0.2, *, easing: str = "smooth", mode: Optional[str] = None,
             speed: float = 1.0, share: Optional[float] = None) -> None:
        """Starts a clip (its name, number or object) that fades in for `fade` seconds; the first one is there at once. easing: linear or
        smooth. mode, speed: as for Playback. share: where it starts, 0 to 1, so that a run is in step with a walk. Raises KeyError,
        IndexError, ValueError."""
        number = self._character.find("clip", clip)
        clock = _clock(self._character, number, mode, speed)
        if share is not None:
            c.playback_seek_share(clock, share)
        c.crossfade_play(self._handle, number, clock, fade, easing)

    def advance(self, seconds: float) -> None:
        """Advances all clips and fades. Raises ValueError."""
        c.crossfade_advance(self._handle, seconds)

    @property
    def playing(self) -> List[Playing]:
        """A list of Playing, the oldest first."""
        return [Playing(self._character, self._handle, number) for number in range(c.crossfade_count(self._handle))]

    def sample(self, pose: Pose) -> Pose:
        """Sets a pose of the same opened model to the clips that play, and returns it. Raises ValueError if nothing plays."""
        c.sample_crossfade(pose._handle, self._handle, self._scratch)
        return pose


class RootMotion(c.RootMotion):
    """A rotation followed by a translation, in double precision. translation: x, y, z in metres. rotation: a unit quaternion x, y, z, w."""

    def __init__(self, translation: Vector3 = (0.0, 0.0, 0.0), rotation: Vector4 = (0.0, 0.0, 0.0, 1.0)) -> None:
        """translation: x, y, z in metres. rotation: a unit quaternion x, y, z, w. Raises ValueError."""
        super().__init__(translation, rotation)
        if not all(map(math.isfinite, self.translation)):
            raise ValueError("translation must be a finite number")
        if not abs(math.sqrt(sum(number * number for number in self.rotation)) - 1.0) <= 1e-6:
            raise ValueError("rotation must be a unit quaternion x, y, z, w")

    @property
    def matrix(self) -> NDArray[np.float64]:
        """(4, 4) float64, fresh."""
        return row_major(c.root_motion_matrix(self))

    def __matmul__(self, after: RootMotion) -> RootMotion:
        """character @ motion: the motion, in the axes of `character`, after it."""
        return c.root_motion_compose(self, after, RootMotion()) if isinstance(after, RootMotion) else NotImplemented

    def inverse(self) -> RootMotion:
        """The motion that undoes this one."""
        return c.root_motion_inverse(self, RootMotion())

    def blend(self, other: RootMotion, weight: float) -> RootMotion:
        """Interpolates between two motions, weight 0 to 1: for cross-fades."""
        return c.root_motion_blend(self, other, weight, RootMotion())

    def __repr__(self) -> str:
        return "<bendy.RootMotion ({:.6g}, {:.6g}, {:.6g})>".format(*self.translation)


class RootPath:
    """How a clip carries a character over the ground."""

    def __init__(self, model: Model, joint: Union[str, SupportsIndex, Joint], axes: str = "xz", turn: str = "yaw") -> None:
        """joint: the root or the hips. axes: along which it moves the character; the rest stays in the pose. turn: none, yaw (about y,
        which is up) or all. Raises KeyError, IndexError, ValueError."""
        self._character = model._get()
        if set(axes) - set("xyz"):
            raise ValueError("axes must be of the letters x, y and z")
        taken = c.RootAxes(turn=turn, **{axis: axis in axes for axis in "xyz"})
        self._handle = c.root_path_new(self._character.handle, self._character.find("joint", joint), taken)

    def at(self, clip: Union[str, SupportsIndex, Clip], seconds: float) -> RootMotion:
        """From the root's rest pose to where it is in the clip: a RootMotion."""
        return c.root_path_at(self._handle, self._character.find("clip", clip), seconds, RootMotion())

    def between(self, clip: Union[str, SupportsIndex, Clip], start: float, end: float) -> RootMotion:
        """From one time of a clip to another, in the character's axes at the start."""
        return c.root_path_between(self._handle, self._character.find("clip", clip), start, end, RootMotion())

    def over(self, played: PlayedInterval) -> RootMotion:
        """Over the interval that a Playback has played; each pass continues where the one before ended. Raises ValueError."""
        if played._character is not self._character:
            raise ValueError("the clip that was played belongs to another model")
        return c.root_path_over(self._handle, played._clip, played, RootMotion())

    def extract(self, pose: Pose) -> RootMotion:
        """Takes the motion out of a pose and returns it. Raises ValueError."""
        return c.root_path_extract(self._handle, pose._handle, RootMotion())


class Binding:
    """Plays the clips of one model on another: joints and morph targets are matched by name."""

    def __init__(self, animated: Model, posed: Model, *, translations: str = "all",
                 root: Union[None, str, SupportsIndex, Joint] = None, root_scale: float = 1.0) -> None:
        """animated: the model that has the clips. posed: the one that moves. translations: all, or root_only: limbs keep the lengths of
        the posed model, and `root` (usually the hips) with its ancestors moves, by root_scale times as far. Raises KeyError, IndexError,
        ValueError."""
        self._animated, self._posed = animated._get(), posed._get()
        options = c.BindingOptions(translations=translations, root=None if root is None else self._posed.find("joint", root),
                                   root_scale=root_scale)
        self._handle = c.binding_new(self._animated.handle, self._posed.handle, options)

    def sample(self, pose: Pose, clip: Union[str, SupportsIndex, Clip], seconds: float) -> Pose:
        """Sets a pose of the posed model to a clip of the animated one, and returns it. Raises KeyError, IndexError, ValueError."""
        c.sample_bound(pose._handle, self._handle, self._animated.find("clip", clip), seconds)
        return pose

    @property
    def joints(self) -> List[Optional[int]]:
        """For each joint of the animated model, the number of the posed model's joint, or None."""
        return numbers_or_none(c.binding_joints(self._handle), self._animated.joints)

    @property
    def targets(self) -> List[Optional[int]]:
        """The same for morph targets."""
        return numbers_or_none(c.binding_targets(self._handle), c.morph_target_count(self._animated.handle))

    @property
    def unmatched_joints(self) -> List[int]:
        """Numbers of the animated model's joints that a clip animates and that have no match."""
        return c.binding_unmatched_joints(self._handle).tolist()

    @property
    def unmatched_targets(self) -> List[int]:
        """The same for morph targets."""
        return c.binding_unmatched_targets(self._handle).tolist()


class Crowd:
    """Many characters of one model, posed and skinned on several threads."""

    def __init__(self, model: Model, threads: int = 0) -> None:
        """threads: at most; 0: one for each processor. Raises ValueError if the model is closed."""
        self._character = model._get()
        self._handle = c.crowd_new(self._character.handle, min(threads or os.cpu_count() or 1, _MOST_THREADS))
        self._is_busy = False

    def skin(self, clips: Any, seconds: ArrayLike, *, normals: bool = False, lod: Optional[Lod] = None) -> Any:
        """The vertices of M characters: (M, N, 3) float32, metres, fresh; with normals, a tuple of two. clips: one for all, or a list of M
        clips or None, which is the rest pose. seconds: (M,). lod: a Lod; vertices that it leaves out are zero. Raises KeyError,
        IndexError, ValueError, RuntimeError."""
        numbers, times = self._members(clips, seconds)
        if lod is not None and lod._character is not self._character:
            raise ValueError("the level of detail belongs to another model")
        count = self._character.vertices
        names = ("positions", "normals") if normals else ("positions",)
        arrays = tuple(np.zeros((len(times), count, 3), np.float32) for _ in names)
        if count:
            handle = None if lod is None else lod._handle
            outputs = [c.Vertices(capacity=count, **dict(zip(names, places))) for places in zip(*arrays)]
            self._play([c.CrowdMember(clip=number, seconds=time, lod=handle, vertices=vertices)
                        for number, time, vertices in zip(numbers, times, outputs)])
        return arrays if normals else arrays[0]

    def palettes(self, clips: Any, seconds: ArrayLike) -> Floats:
        """The skinning matrices of M characters: (M, B, 3, 4) float32, fresh, of all meshes: see first_entry. Neighbouring meshes with the
        same palette share them, and a rigid mesh has one. Raises KeyError, IndexError, ValueError, RuntimeError."""
        numbers, times = self._members(clips, seconds)
        made = np.zeros((len(times), c.crowd_palette_size(self._handle), 16), np.float32)
        self._play([c.CrowdMember(clip=number, seconds=time, palette=palette) for number, time, palette in zip(numbers, times, made)])
        return row_major(made)[:, :, :3].copy()

    def first_entry(self, mesh: Union[str, SupportsIndex, Mesh]) -> int:
        """Index of a mesh's first matrix in `palettes`."""
        return c.crowd_first_matrix(self._handle, self._character.find("mesh", mesh))

    @property
    def threads(self) -> int:
        """At most so many at a time."""
        return c.crowd_workers(self._handle)

    def _members(self, clips: Any, seconds: ArrayLike) -> Tuple[Sequence[Optional[int]], List[float]]:
        """The clip and the time of each."""
        times = floats(seconds, (None,), "seconds").tolist()
        if not isinstance(clips, (list, tuple)):
            return [None if clips is None else self._character.find("clip", clips)] * len(times), times
        if len(clips) != len(times):
            raise ValueError("clips must be one clip, or as many as there are seconds")
        return [None if clip is None else self._character.find("clip", clip) for clip in clips], times

    def _play(self, members: List[c.CrowdMember]) -> None:
        """Runs on as many threads as the crowd has workers; on fewer if the system refuses one."""
        if self._is_busy:
            raise RuntimeError("the crowd is in use by another thread: give each thread its own")
        self._is_busy = True
        places = itertools.count(0, _AT_ONCE)
        errors: List[BaseException] = []

        def work(worker: int) -> None:
            try:
                for first in places:
                    if first >= len(members) or errors:
                        return
                    c.crowd_play(self._handle, members[first:first + _AT_ONCE], worker)
            except BaseException as error:
                errors.append(error)

        threads = []
        try:
            for worker in range(1, min(self.threads, -(-len(members) // _AT_ONCE))):
                thread = threading.Thread(target=work, args=(worker,))
                try:
                    thread.start()
                except RuntimeError:
                    break
                threads.append(thread)
            work(0)
        finally:
            for thread in threads:
                thread.join()
            self._is_busy = False
        if errors:
            raise errors[0]
