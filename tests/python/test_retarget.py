"""Roles, and poses of one model on another one of different build."""

import bendy
import numpy
import pytest

from conftest import ROOT


def test_joints_have_roles(model):
    joint = model.joints["mixamorig:LeftForeArm"]
    assert (joint.role, joint.role_place) == ("left_lower_arm", 0)
    assert sum(joint.role != "none" for joint in model.joints) == 54


def test_a_pose_on_a_model_of_the_same_build_is_the_same_to_the_last_bit(model, mannequin):
    target = bendy.open(mannequin)
    retarget = bendy.Retarget(model, target)
    assert retarget.scale == 1.0
    assert retarget.joints == list(range(len(model.joints)))
    assert retarget.morph_targets == list(range(model.morph_targets))
    source, pose, state = model.sample("Walk", 0.3), target.pose(), bendy.RetargetState()
    result = retarget.apply(pose, source, state)
    assert len(result.contacts) == 4 and max(result.contacts) > 0.5
    assert result.turned == 0.0 and result.turned_joint is None
    assert "missed" in repr(result)
    for name in ("rotations", "translations", "scales", "morph_weights"):
        assert numpy.array_equal(getattr(pose, name), getattr(source, name)), name
    assert retarget.apply(pose, source, state.reset(), contacts=[1, 1, 0, 0.25]).contacts == (1, 1, 0, 0.25)
    model.close()
    target.close()
    retarget.apply(pose, source, state)


def test_errors_say_what_is_missing(model):
    tentacle = bendy.open(ROOT / "examples/tentacle.glb")
    with pytest.raises(ValueError, match='the target does not say what its joints are: list them as "roles" in its rig file'):
        bendy.Retarget(model, tentacle)
    with pytest.raises(ValueError, match="the source does not say"):
        bendy.Retarget(tentacle, model)
    with pytest.raises(ValueError, match="rest_poses"):
        bendy.Retarget(model, model, rest_poses="other")


def test_poses_of_other_models_are_refused(model, mannequin):
    retarget, state, other = bendy.Retarget(model, model), bendy.RetargetState(), bendy.open(mannequin)
    pose = model.pose()
    for target, source in ((other.pose(), model.pose()), (pose, other.pose()), (pose, pose)):
        with pytest.raises(ValueError):
            retarget.apply(target, source, state)
    for contacts in ([1, 2, 3], [1, numpy.nan, 0, 0]):
        with pytest.raises(ValueError):
            retarget.apply(pose, model.pose(), state, contacts)
