"""BodyReach: hands, feet and head that reach for targets at the same time."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Optional, Sequence, SupportsIndex, Tuple, Union

from numpy.typing import ArrayLike

from ._bendy import c
from ._model import Joint

if TYPE_CHECKING:
    from ._model import Model


class Effector(NamedTuple):
    """A point of a joint (its name, number or object) that is to reach for a target. tip_offset: (3,) metres, in the joint's space."""

    joint: Union[str, SupportsIndex, Joint]
    tip_offset: ArrayLike = (0.0, 0.0, 0.0)


class EffectorTarget(c.EffectorTarget):
    """Where an effector is to be, for Pose.reach_body."""

    def __init__(self, position: ArrayLike, **options: "bendy_effector_target") -> None:
        """Anything that is not given has the default.

        **options

        Raises ValueError, TypeError."""
        super().__init__(**options)


class BodyReached(c.BodyReached):
    """How near the effectors came to their targets; true if all are there.

    is_reached: whether every effector is at its target, within the tolerance. farthest: the index of the effector that is farthest from its
    target, of those with a weight. distance: metres, of that one. angle: radians, the largest between an effector's orientation and its
    target's. iterations: number of iterations made.
    """

    def __bool__(self) -> bool:
        return self.is_reached

    def __repr__(self) -> str:
        status = "reached" if self.is_reached else f"effector {self.farthest} not reached"
        return f"<bendy.BodyReached {status}, {self.distance:.6g} m left>"


class BodyReach:
    """The joints between a root and several effectors, for Pose.reach_body. For one thread at a time."""

    follows: "bendy_body_reach"

    def __init__(self, model: Model, effectors: Sequence[Union[str, SupportsIndex, Joint, Effector]], *,
                 root: Union[None, str, SupportsIndex, Joint] = None, **options: "bendy_body_reach_options") -> None:
        """effectors: 1 to 32, each a joint (its name, number or object) or an Effector.

        **options

        Raises KeyError, IndexError, ValueError."""
        character = model._get()
        root = None if root is None else character.find("joint", root)
        listed = [one if isinstance(one, Effector) else Effector(one) for one in effectors]
        points = [c.Effector(joint=character.find("joint", one.joint), tip_offset=one.tip_offset) for one in listed]
        self._handle = c.body_reach_new(character.handle, points, c.BodyReachOptions(**options))
