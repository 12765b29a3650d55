"""The base of a model's parts: the opened file behind them, and looking them up by name, number or object."""

from __future__ import annotations

import collections.abc
import json
import operator
from typing import Any, Dict, Generic, List, Optional, Sequence, SupportsIndex, Tuple, TypeVar, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _bendy
from ._bendy import c, floats

T = TypeVar("T")
Floats = NDArray[np.float32]
Vector3 = Tuple[float, float, float]
Vector4 = Tuple[float, float, float, float]

# A text that begins otherwise is a name; these may be a number: see Items.
_NUMBER_SIGNS = frozenset("#=0123456789")


def parse_json(text: str) -> Any:
    """JSON of a file; None if there is none. Raises ValueError if it is not JSON."""
    return json.loads(text) if text else None


def check_units(rotations: Floats, name: str) -> None:
    """Raises ValueError if the length of a quaternion, or of any of several, is not 1. {} in `name` stands for its number."""
    lengths = np.linalg.norm(np.float64(rotations.reshape(-1, 4)), axis=1)
    wrong = np.flatnonzero(np.abs(lengths - 1.0) > 1e-4)
    if len(wrong):
        raise ValueError(f"{name.format(wrong[0])} must be a unit quaternion x, y, z, w")


def column_major(matrix: ArrayLike, name: str) -> Floats:
    """A matrix of (4, 4) numbers, [row, column], in C's layout."""
    return floats(matrix, (4, 4), name).T.ravel()


def row_major(columns: NDArray[Any]) -> NDArray[Any]:
    """Matrices in C's layout, (..., 16), as (..., 4, 4), [row, column]: a copy."""
    return np.ascontiguousarray(columns.reshape(*columns.shape[:-1], 4, 4).swapaxes(-1, -2))


def numbers_or_none(found: Optional[c.Pointer], count: int) -> List[Optional[int]]:
    """An array of C's, in which BENDY_NONE is None."""
    numbers = [] if found is None else found.array(count).tolist()
    return [None if number == 0xffffffff else number for number in numbers]


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    array.flags.writeable = False
    return array


class Character:
    """An opened file, shared by a model and everything made from it. joints, vertices: their numbers."""

    __slots__ = ("handle", "joints", "source", "vertices", "_bounds", "_names", "_numbers")

    def __init__(self, handle: c.Model, source: _bendy.Source) -> None:
        self.handle, self.source = handle, source
        self.joints, self.vertices = c.joint_count(handle), c.vertex_count(handle)
        self._bounds: Optional[c.Bounds] = None
        self._names: Dict[str, List[str]] = {}
        self._numbers: Dict[str, Dict[str, int]] = {}

    @property
    def bounds(self) -> c.Bounds:
        """Computed on first use."""
        if self._bounds is None:
            self._bounds = c.bounds_new(self.handle)
        return self._bounds

    def names(self, kind: str) -> List[str]:
        """The names of the model's joints, clips, ... in order."""
        found = self._names.get(kind)
        if found is None:
            get = getattr(c, "get_" + kind)
            found = [get(self.handle, number).name for number in range(getattr(c, kind + "_count")(self.handle))]
            numbers: Dict[str, int] = {}
            for number, name in enumerate(found):
                numbers.setdefault(name, number)
            self._numbers[kind] = numbers
            self._names[kind] = found
        return found

    def find(self, kind: str, wanted: Any) -> int:
        """The number of a part by its name, number or object. Raises KeyError, IndexError, ValueError for an object of another model,
        TypeError."""
        names = self._names.get(kind)
        if names is None:
            names = self.names(kind)
        if isinstance(wanted, str):
            if wanted[:1] not in _NUMBER_SIGNS:
                number = self._numbers[kind].get(wanted)
                if number is not None:
                    return number
            return find_name(names, wanted, kind)
        if isinstance(wanted, Part):
            if wanted._kind == kind:
                if wanted._character is not self:
                    raise ValueError(f"the {kind} belongs to another model")
                return wanted._number
        elif hasattr(wanted, "__index__"):
            return find_index(wanted, len(names), kind)
        raise TypeError(f"a {kind} is a name, a number or one of the model's own")


def find_name(names: List[str], wanted: str, kind: str) -> int:
    """The number of what a text refers to. Raises KeyError."""
    try:
        return _bendy.find_key(names, wanted, kind)
    except KeyError as error:
        if names or kind != "chain":
            raise
        raise KeyError(f"{error.args[0]}: bendy.convert(source, auto_rig=True).open() proposes some") from None


def find_index(wanted: SupportsIndex, count: int, kind: str) -> int:
    """-1 is the last. Raises IndexError."""
    given = operator.index(wanted)
    number = given + count if given < 0 else given
    if not 0 <= number < count:
        raise IndexError(f"there is no {kind} {given}: the model has {count}")
    return number


class Part:
    """Something of a model that has a number; the other base of such a class is the struct that describes it."""

    _kind = ""  # its name in functions of the C API

    def __init__(self, character: Character, *place: int) -> None:
        """place: its number, preceded by the number of the clip that contains it, if any."""
        super().__init__()
        self._character, self._place, self._number = character, place, place[-1]
        getattr(c, "get_" + self._kind)(character.handle, *place, self)

    @property
    def number(self) -> int:
        """Index among the parts of its kind: joints, clips, ... of the model, curves of the clip, morph targets of the mesh."""
        return self._number

    def __repr__(self) -> str:
        return f"<bendy.{type(self).__name__} {self._number} {getattr(self, 'name', '')!r}>"


class WithExtras(Part):
    """A part with data of its author; a base of the classes whose struct has `extras`."""

    @property
    def extras(self) -> Any:
        """The author's own data, parsed; None if there is none. Raises ValueError if it is not JSON."""
        return parse_json(super().extras)  # type: ignore[misc]


class Items(collections.abc.Sequence, Generic[T]):
    """A list of parts that are looked up by number or by name: clips[0], clips["Walk"]. Names need not be unique; the first one
    counts. "#3" is always a number and "=3" always a name."""

    def __init__(self, kind: str, things: Sequence[T], names: List[str]) -> None:
        self._kind, self._things, self._names = kind, tuple(things), names

    def __len__(self) -> int:
        return len(self._things)

    def __iter__(self):
        return iter(self._things)

    def __getitem__(self, key: Union[str, SupportsIndex, slice]) -> Any:
        """Returns one by its number (-1 is the last) or its name; a slice gives a tuple. Raises IndexError, or KeyError with the
        names that exist."""
        if isinstance(key, slice):
            return self._things[key]
        if isinstance(key, str):
            return self._things[find_name(self._names, key, self._kind)]
        if isinstance(key, Part) and key not in self:  # a joint may stand for its number elsewhere
            raise ValueError(f"the {key._kind} is none of these")
        return self._things[find_index(key, len(self._things), self._kind)]

    def __contains__(self, key: object) -> bool:
        """Whether there is one with exactly that name, or that object."""
        return key in self._names if isinstance(key, str) else any(one is key for one in self._things)

    @property
    def names(self) -> List[str]:
        """The names in order; they may be empty."""
        return list(self._names)

    def __repr__(self) -> str:
        return repr(self._things)
