"""Retarget: poses of one model on another one of different build."""

from __future__ import annotations

from typing import TYPE_CHECKING, List, Optional

from numpy.typing import ArrayLike

from ._bendy import c
from ._items import floats, numbers_or_none

if TYPE_CHECKING:
    from ._model import Model
    from ._pose import Pose


class Retargeted(c.Retargeted):
    """What had to give way in a frame.

    turned: radians, most that a constraint turned a joint away from where it was to be; turned_joint: its number in the target, or
    None. missed: metres, most that a hand or foot is away from where it was to be; missed_joint: as turned_joint. lowered: metres, by
    how much the hips were lowered so that the feet reach the ground. contacts: how firmly left heel, left toes, right heel and right
    toes stand, the same of an animal's front feet, a human's left hand and right hand, and its body, if it sits, lies or kneels: 0 in the
    air to 1 on the ground; whether its hands are near each other, as on one sword; and whether left and right hand touch its own body.
    """

    def __repr__(self) -> str:
        return f"<bendy.Retargeted, turned {self.turned:.6g} rad, missed {self.missed:.6g} m, lowered {self.lowered:.6g} m>"


class RetargetState:
    """What a character remembers from one frame to the next: where its feet stand and its hands lie, and how its joints
    were turned. Make a new one where the motion jumps."""

    follows: "bendy_retarget_state"

    def __init__(self) -> None:
        """Nothing yet."""
        self._handle = c.retarget_state_new()


class Retarget:
    """How poses of one model become poses of another of different build. What corresponds is known from Joint.role, not from names; the
    rest poses may differ (arms out or down), face other ways and have other sizes. Joints with a role turn as those of the source do.
    Joints and morph targets with equal names and no role come along, such as props and faces. All others keep their rest relative to
    their parent. For one thread at a time."""

    follows: "bendy_retarget"

    def __init__(self, source: Model, target: Model, **options: "bendy_retarget_options") -> None:
        """source: the model whose poses are taken. target: the one that moves. Both are humans, animals on four legs, or
        animals on two. A human needs the roles of hips, head, upper and lower arms and legs, hands and feet; an animal those of hips, and
        of three joints or more of each leg.

        **options

        Raises ValueError, with a message that says what is missing."""
        self._target = target._get()
        self._handle = c.retarget_new(source._get().handle, self._target.handle, c.RetargetOptions(**options))

    def apply(self, pose: Pose, source: Pose, state: RetargetState, contacts: Optional[ArrayLike] = None,
              seconds: float = 0.0) -> Retargeted:
        """Sets a pose of the target to a pose of the source. Where neither a constraint nor a contact acts, limbs have the directions of
        the source's. What a constraint holds back, the joints below make up for as far as theirs allow. Feet and hands on the
        ground are then brought to their places by IK, and the body of who sits, lies or kneels to its height.

        state: the character's own. contacts: (14,), as in Retargeted; None: found by heights above the ground. seconds: since the last
        call with this state, 0 to 1: joints that would jump where the source does not turn quickly, but do not jump; 0: they may. Raises
        ValueError; if a number is not finite, the pose is then at rest."""
        given = None if contacts is None else floats(contacts, (14,), "contacts")
        return c.retarget_pose(pose._handle, self._handle, source._handle, state._handle, given, seconds, Retargeted())

    @property
    def joints(self) -> List[Optional[int]]:
        """For each joint of the target, the number of the source's joint that turns it, or None."""
        return numbers_or_none(c.retarget_joints(self._handle), self._target.joints)

    @property
    def morph_targets(self) -> List[Optional[int]]:
        """The same for morph targets."""
        return numbers_or_none(c.retarget_morph_targets(self._handle), c.morph_target_count(self._target.handle))
