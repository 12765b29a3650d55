"""Full-body IK: several effectors in one solve."""

import math

import bendy
import numpy
import pytest

HANDS = ["mixamorig:LeftHand", "mixamorig:RightHand"]
TARGETS = [(0.3, 1.3, 0.35), (-0.25, 1.2, 0.4)]


def places(pose, joints):
    return numpy.array([pose.matrices[joint, :3, 3] for joint in joints])


def test_both_hands_reach_and_nothing_else_moves(model):
    body = bendy.BodyReach(model, HANDS)
    joints = [model.joint(name) for name in HANDS]
    assert model.joints[body.root].name == "mixamorig:Spine2"
    pose = model.pose()
    result = pose.reach_body(body, TARGETS)
    assert result and result.is_reached and result.iterations > 0
    numpy.testing.assert_allclose(places(pose, joints), TARGETS, atol=1e-3)
    assert result.distance == pytest.approx(numpy.linalg.norm(places(pose, joints) - TARGETS, axis=1).max(), abs=1e-5)
    hips = model.joint("mixamorig:Hips")
    numpy.testing.assert_array_equal(pose.rotations[hips], model.pose().rotations[hips])


def test_options_and_weights_reach_the_solver(model):
    hips = model.joints["mixamorig:Hips"]
    effectors = [bendy.Effector(HANDS[0], tip_offset=numpy.array([0, 0.08, 0])), model.joints[HANDS[1]]]
    body = bendy.BodyReach(model, effectors, root=hips, root_shift=(0.1, 0.2, 0.1), root_turn=0.4)
    assert body.root == hips.number
    far = [(1.5, 1.2, 0.5), bendy.EffectorTarget((-1.5, 1.2, 0.5), weight=0.01)]
    pose = model.pose()
    result = pose.reach_body(body, far)
    assert not result and result.farthest == 1 and "effector 1 not reached" in repr(result)
    moved = pose.matrices[hips.number, :3, 3] - model.pose().matrices[hips.number, :3, 3]
    assert moved[0] == pytest.approx(0.1, abs=1e-4)
    tip = pose.matrices[model.joint(HANDS[0])] @ [0, 0.08, 0, 1]
    assert numpy.linalg.norm(tip[:3] - far[0]) < result.distance

    turned = bendy.EffectorTarget(TARGETS[0], rotation=(0, math.sin(0.2), 0, math.cos(0.2)), rotation_weight=0.5)
    free = bendy.BodyReach(model, HANDS, obey_constraints=False)
    assert model.pose().reach_body(free, [turned, TARGETS[1]]).angle < 0.1
    few = bendy.BodyReach(model, HANDS, iterations=1, restarts=0)
    assert model.pose().reach_body(few, TARGETS).iterations == 1


def test_bad_arguments_are_errors_and_leave_the_pose(model, mannequin):
    body, pose, other = bendy.BodyReach(model, HANDS), model.pose(), bendy.open(mannequin)
    for call, error, message in [
        (lambda: bendy.BodyReach(model, []), ValueError, "1 to 32 effectors, found 0"),
        (lambda: bendy.BodyReach(model, [HANDS[0]] * 33), ValueError, "found 33"),
        (lambda: bendy.BodyReach(model, ["Nose"]), KeyError, "Nose"),
        (lambda: bendy.BodyReach(model, [9999]), IndexError, "9999"),
        (lambda: bendy.BodyReach(model, HANDS, root="mixamorig:LeftHand"), ValueError, "root is not at or above all effectors"),
        (lambda: bendy.BodyReach(model, HANDS, root_turn=math.nan), ValueError, "root_turn"),
        (lambda: bendy.BodyReach(model, [bendy.Effector(HANDS[0], (0, 0))]), ValueError, "tip_offset"),
        (lambda: bendy.BodyReach(model, [other.joints[HANDS[0]]]), ValueError, "another model"),
        (lambda: pose.reach_body(body, TARGETS[:1]), ValueError, "a target for each of 2 effectors, found 1"),
        (lambda: pose.reach_body(body, [(0, 1, 0), (0, 1)]), ValueError, "position"),
        (lambda: pose.reach_body(body, [(0, 1, 0), (0, 1, math.nan)]), ValueError, "position"),
        (lambda: pose.reach_body(body, [(0, 1, 0), "abc"]), TypeError, "position"),
        (lambda: bendy.EffectorTarget((0, 1, 0), rotation=(0, 0, 0)), ValueError, "rotation"),
        (lambda: pose.reach_body(body, [(0, 1, 0), bendy.EffectorTarget((0, 1, 0), rotation=(0, 0, 0, 2))]), ValueError, "rotation"),
        (lambda: pose.reach_body(body, [(0, 1, 0), bendy.EffectorTarget((0, 1, 0), weight=2)]), ValueError, "weight"),
        (lambda: other.pose().reach_body(body, TARGETS), ValueError, "another model"),
    ]:
        with pytest.raises(error, match=message):
            call()
    numpy.testing.assert_array_equal(pose.skin(), model.pose().skin())
