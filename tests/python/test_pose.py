"""Poses: the numbers of the program and of the C API, outputs in the caller's memory, and wrong arguments."""

import importlib.util
import json
import math
import os
import re
import threading
import time

import bendy
import numpy
import pytest
from conftest import ROOT


def positions_of(pose):
    return numpy.concatenate([numpy.float32(mesh["positions"]).reshape(-1, 3) for mesh in pose["meshes"]])


@pytest.mark.parametrize("clip, seconds", [("Walk", 0.3), ("Idle", 1.7), ("Walk", -5.0)])
def test_the_program_gives_the_same_numbers(model, mannequin, posed, clip, seconds):
    expected = posed(mannequin, "--clip", clip, f"--time={seconds}")
    pose = model.sample(clip, seconds)
    positions, normals = pose.skin(normals=True)
    numpy.testing.assert_array_equal(positions, positions_of(expected))
    numpy.testing.assert_array_equal(
        normals, numpy.concatenate([numpy.float32(mesh["normals"]).reshape(-1, 3) for mesh in expected["meshes"]]))
    worlds = numpy.float32([joint["world"] for joint in expected["joints"]]).reshape(-1, 4, 4).swapaxes(1, 2)
    numpy.testing.assert_array_equal(pose.matrices, worlds)


def test_the_program_reaches_the_same(model, mannequin, posed):
    expected = posed(mannequin, "--clip", "Walk", "--time", "0.3", "--reach", "IK_LeftArm=0.1,1.25,-0.2")
    pose = model.sample("Walk", 0.3)
    result = pose.reach("IK_LeftArm", (0.1, 1.25, -0.2))
    numpy.testing.assert_array_equal(pose.skin(), positions_of(expected))
    assert numpy.float32(expected["reaches"][0]["distance"]) == numpy.float32(result.distance)
    assert not result and not result.reached and result.status == "not_reached" and result.distance > 0.1
    assert model.sample("Walk", 0.3).reach("IK_LeftArm", [0.3, 1.2, 0.4])
    free = model.pose().reach(model.chains["IK_LeftArm"], numpy.array([0.1, 1.25, -0.2]), obey_constraints=False)
    assert free.reached


def test_reaching_over_time_is_as_the_programs(model, mannequin, tmp_path, program):
    arguments = ["pose", str(mannequin), "--clip", "Idle", "--frames", "0..50@60", "--reach", "IK_LeftArm=-0.2,1.5,0.3", "-o", str(tmp_path / "#.json")]
    program(*arguments)
    state, chain = bendy.ReachState(model), model.chains["IK_LeftArm"]
    start = model.clips["Idle"].start
    for frame in range(51):
        pose = model.sample("Idle", frame / 60)
        if frame % 2:
            result = pose.reach(chain, (-0.2, 1.5, 0.3), state=state, seconds=1 / 60 if frame else 0.0)
        else:
            result, = pose.reach_chains([(chain, (-0.2, 1.5, 0.3), None, {"state": state, "seconds": 1 / 60 if frame else 0.0})])
        expected = json.loads((tmp_path / f"{frame}.json").read_text())["reaches"][0]["distance"]
        assert result.distance == pytest.approx(expected, abs=2e-5)
    assert start == 0
    alone = model.sample("Idle", 0.0).reach(chain, (-0.2, 1.5, 0.3)).distance
    for forget in (state.reset, lambda: state.forget(chain)):
        forget()
        assert model.sample("Idle", 0.0).reach(chain, (-0.2, 1.5, 0.3), state=state).distance == alone
    pose = model.pose()
    assert pose.reach_all(state, 0.1) is pose
    with pytest.raises(ValueError, match="state is of another model than pose"):
        bendy.open(mannequin).pose().reach("IK_LeftArm", (0, 1, 0), state=state)
    with pytest.raises(TypeError):
        model.pose().reach("IK_LeftArm", (0, 1, 0), state=3)


def test_what_a_chain_follows_is_carried(model):
    chain = model.chains["IK_LeftArm"]
    target = numpy.float32([0.3, 1.2, 0.4])
    for reach in (lambda pose, **options: pose.reach(chain, target, **options),
                  lambda pose, **options: pose.reach_chains([(chain, target, None, options)])):
        pose = model.pose()
        before = pose.socket(chain.target)[:3, 3].copy()
        reach(pose, carry_target=False)
        numpy.testing.assert_array_equal(pose.socket(chain.target)[:3, 3], before)
        reach(pose)
        numpy.testing.assert_allclose(pose.socket(chain.target)[:3, 3], target, atol=1e-3)


def test_the_c_api_gives_the_same_numbers(model, mannequin):
    if "BENDY_LIBRARY" not in os.environ:
        pytest.skip("libbendy was not built as a shared library")
    found = importlib.util.spec_from_file_location("bendy_ctypes", ROOT / "examples/bendy_ctypes.py")
    ctypes_module = importlib.util.module_from_spec(found)
    found.loader.exec_module(ctypes_module)
    pose = ctypes_module.Pose(ctypes_module.Model(str(mannequin)))
    pose.sample("Walk", 0.3)
    expected = numpy.asarray(pose.skin()[0] if isinstance(pose.skin(), tuple) else pose.skin(), numpy.float32).reshape(-1, 3)
    numpy.testing.assert_array_equal(model.sample("Walk", 0.3).skin(), expected)


def test_skinning_by_hand(model):
    """The arrays mean what the documentation says: sum of weight * matrix * inverse bind * position."""
    pose = model.sample("Walk", 0.6)
    for mesh in model.meshes:
        palette = pose.matrices[mesh.palette] @ mesh.inverse_bind
        numpy.testing.assert_allclose(pose.palette(mesh), palette[:, :3], atol=1e-5)
        points = numpy.c_[mesh.positions, numpy.ones(mesh.vertices, numpy.float32)]
        expected = numpy.einsum("vi,virc,vc->vr", mesh.weights, palette[mesh.bones], points)[:, :3]
        numpy.testing.assert_allclose(pose.skin(mesh), expected, atol=1e-5)
        start = mesh.first_vertex
        numpy.testing.assert_array_equal(pose.skin(mesh), pose.skin()[start:start + mesh.vertices])


def test_outputs_in_memory_of_the_caller(model):
    pose = model.sample("Walk", 0.3)
    positions, normals, tangents = pose.skin(normals=True, tangents=True)
    out = numpy.empty_like(positions)
    assert pose.skin(out=out) is out
    numpy.testing.assert_array_equal(out, positions)
    buffer = numpy.full((model.vertices, 8), 7, numpy.float32)  # interleaved, with a gap
    returned = pose.skin(normals=True, out=(buffer[:, :3], buffer[:, 4:7]))
    assert isinstance(returned, tuple)
    numpy.testing.assert_array_equal(buffer[:, :3], positions)
    numpy.testing.assert_array_equal(buffer[:, 4:7], normals)
    assert (buffer[:, [3, 7]] == 7).all()
    assert tangents.shape == (model.vertices, 4)
    numpy.testing.assert_array_equal(pose.skin(tangents=True)[1], tangents)
    for _ in range(2):  # the second time its checks are known
        assert pose.skin(out=out) is out
    out.flags.writeable = False
    with pytest.raises(ValueError, match="read-only"):
        pose.skin(out=out)
    assert not numpy.shares_memory(pose.skin(), pose.skin())


def test_wrong_outputs(model):
    pose, n = model.pose(), model.vertices
    read_only = numpy.zeros((n, 3), numpy.float32)
    read_only.flags.writeable = False
    for out, error in [
        (numpy.zeros((n, 3)), TypeError),
        (numpy.zeros((n, 3), ">f4"), TypeError),
        ([[0.0] * 3] * n, TypeError),
        (numpy.zeros((n - 1, 3), numpy.float32), ValueError),
        (numpy.zeros((n, 4), numpy.float32), ValueError),
        (numpy.zeros(n * 3, numpy.float32), ValueError),
        (numpy.zeros((3, n), numpy.float32).T, ValueError),
        (numpy.zeros((n, 6), numpy.float32)[:, ::2], ValueError),
        (numpy.zeros((n, 3), numpy.float32)[::-1], ValueError),
        (numpy.broadcast_to(numpy.zeros((1, 3), numpy.float32), (n, 3)), ValueError),
        (numpy.ndarray((n, 3), numpy.float32, bytearray(12 * n + 1), offset=1), ValueError),
        (read_only, ValueError),
    ]:
        with pytest.raises(error):
            pose.skin(out=out)
    zero_stride = numpy.lib.stride_tricks.as_strided(numpy.zeros(3, numpy.float32), (n, 3), (0, 4))
    with pytest.raises(ValueError):
        pose.skin(out=zero_stride)
    with pytest.raises(ValueError, match="one array for each"):
        pose.skin(normals=True, out=(numpy.zeros((n, 3), numpy.float32),))


def test_wrong_arguments(model, compact):
    pose = model.pose()
    other = bendy.open(compact)
    nan = float("nan")
    for call, error in [
        (lambda: pose.sample("Wlak", 0), KeyError),
        (lambda: pose.sample(2, 0), IndexError),
        (lambda: pose.sample(1 << 70, 0), IndexError),
        (lambda: pose.sample(None, 0), TypeError),
        (lambda: pose.sample(1.0, 0), TypeError),
        (lambda: pose.sample("Walk", nan), ValueError),
        (lambda: pose.sample("Walk", math.inf), ValueError),
        (lambda: pose.sample(other.clips[0], 0), ValueError),
        (lambda: pose.reach("IK_LeftArm", (0, 1)), ValueError),
        (lambda: pose.reach("IK_LeftArm", (0, 1, nan)), ValueError),
        (lambda: pose.reach("IK_LeftArm", "abc"), (TypeError, ValueError)),
        (lambda: pose.reach("IK_LeftArm", (0, 1, 0), rotation=(0, 0, 0, 2)), ValueError),
        (lambda: pose.reach("IK_LeftArm", (0, 1, 0), solver="magic"), ValueError),
        (lambda: pose.reach("IK_LeftArm", (0, 1, 0), softness=1.5), ValueError),
        (lambda: pose.reach("IK_LeftArm", (0, 1, 0), influence=-0.1), ValueError),
        (lambda: pose.reach("IK_LeftArm", (0, 1, 0), gain=math.inf), ValueError),
        (lambda: pose.reach("IK_Tail", (0, 1, 0)), KeyError),
        (lambda: pose.blend(other.pose(), 0.5), ValueError),
        (lambda: pose.blend(model.pose(), nan), ValueError),
        (lambda: pose.blend(model.pose(), 0.5, mask=[1.0]), ValueError),
        (lambda: pose.skin("Nose"), KeyError),
        (lambda: pose.skin(99), IndexError),
        (lambda: pose.skin(method="magic"), ValueError),
        (lambda: pose.palette(99), IndexError),
        (lambda: model.skin_clip("Walk", [[0.0]]), ValueError),
        (lambda: model.skin_clip("Walk", [nan]), ValueError),
        (lambda: model.mask_below("Nose"), KeyError),
        (lambda: setattr(pose, "rotations", numpy.zeros((3, 4))), ValueError),
        (lambda: setattr(pose, "rotations", pose.rotations * 2), ValueError),
        (lambda: setattr(pose, "translations", pose.translations * nan), ValueError),
        (lambda: setattr(pose, "scales", "abc"), (TypeError, ValueError)),
    ]:
        with pytest.raises(error):
            call()
    numpy.testing.assert_array_equal(pose.skin(), model.pose().skin())  # nothing of it has changed the pose


def test_where_chains_come_from(model):
    with pytest.raises(KeyError, match=r"there are none: bendy\.convert\(source, auto_rig=True\)"):
        bendy.open(ROOT / "spec/examples/one_joint.bendy").pose().reach("LeftArm", (0, 1, 0))
    with pytest.raises(KeyError, match='did you mean "IK_LeftArm"') as refused:
        model.pose().reach("LeftArm", (0, 1, 0))
    assert "auto_rig" not in str(refused.value)


def test_local_transforms_are_copies_and_can_be_set(model):
    pose = model.sample("Walk", 0.3)
    other = model.pose()
    other.rotations, other.translations, other.scales = pose.rotations, pose.translations, pose.scales
    numpy.testing.assert_array_equal(other.skin(), pose.skin())
    rotations = pose.rotations
    rotations[:] = (0, 0, 0, 1)
    numpy.testing.assert_array_equal(other.skin(), pose.skin())  # a copy: the pose did not change
    hips = model.joint("mixamorig:Hips")
    moved = pose.translations
    moved[hips] += (0, 1, 0)
    pose.translations = moved.tolist()
    numpy.testing.assert_allclose(pose.bounds[:, 1] - other.bounds[:, 1], 1.0, atol=1e-4)


def test_morph_weights():
    model = bendy.open(ROOT / "spec/examples/every_chunk.bendy")
    body = model.meshes["body"]
    stretch = body.morph_targets["stretch"]
    assert stretch.vertices.tolist() == [1, 2] and stretch.positions.shape == (2, 3)
    assert numpy.shares_memory(stretch.positions, model.source.bytes)
    pose = model.pose()
    before = pose.skin(body)
    pose.morph_weights = [1.0, 0.0, 0.0]
    moved = numpy.linalg.norm(pose.skin(body) - before, axis=1)
    assert moved[0] == 0 and (moved[1:] > 0).all()
    numpy.testing.assert_array_equal(pose.morph_weights, [1, 0, 0])
    with pytest.raises(ValueError):
        pose.morph_weights = [1.0, 0.0]


def test_blending(model):
    walk, idle = model.sample("Walk", 0.3), model.sample("Idle", 0.5)
    numpy.testing.assert_allclose(walk.copy().blend(idle, 0.0).skin(), walk.skin(), atol=1e-6)
    numpy.testing.assert_allclose(walk.copy().blend(idle, 1.0).skin(), idle.skin(), atol=1e-5)
    mask = model.mask_below("mixamorig:Spine")
    assert set(mask) == {0.0, 1.0} and mask[model.joint("mixamorig:LeftArm")] == 1 and mask[model.joint("mixamorig:Hips")] == 0
    upper = walk.copy().blend(idle, 1.0, mask)
    inside = mask == 1
    numpy.testing.assert_allclose(upper.rotations[inside], idle.rotations[inside], atol=1e-6)
    numpy.testing.assert_allclose(upper.rotations[~inside], walk.rotations[~inside], atol=1e-6)
    difference = walk.copy().make_additive(idle)
    numpy.testing.assert_allclose(idle.copy().add(difference).skin(), walk.skin(), atol=1e-4)
    numpy.testing.assert_allclose(walk.blend(walk, 0.5).skin(), model.sample("Walk", 0.3).skin(), atol=1e-5)
    assert walk.reset() is walk
    numpy.testing.assert_array_equal(walk.skin(), model.pose().skin())


def test_many_times_at_once(model):
    times = numpy.linspace(0, 1, 5)
    vertices = model.skin_clip("Walk", times)
    matrices = model.pose_clip("Walk", times)
    assert vertices.shape == (5, model.vertices, 3) and matrices.shape == (5, len(model.joints), 4, 4)
    for k, seconds in enumerate(times):
        pose = model.sample("Walk", seconds)
        numpy.testing.assert_array_equal(vertices[k], pose.skin())
        numpy.testing.assert_array_equal(matrices[k], pose.matrices)
    assert model.skin_clip("Walk", []).shape == (0, model.vertices, 3)


def test_constrain_and_reach_all(model):
    pose = model.sample("Walk", 0.3)
    rotations = pose.rotations
    knee = model.joint("mixamorig:LeftLeg")
    rotations[knee] = (-math.sin(1.0), 0, 0, math.cos(1.0))  # bent the wrong way
    pose.rotations = rotations
    assert numpy.abs(pose.copy().constrain().rotations[knee] - rotations[knee]).max() > 0.1
    assert pose.reach_all() is pose


def test_dual_quaternions(model):
    pose = model.sample("Walk", 0.3)
    linear, dual = pose.skin(), pose.skin(method="dual_quaternion")
    assert 0 < numpy.abs(linear - dual).max() < 0.1


def test_bounds_hold_the_vertices(model):
    pose = model.sample("Walk", 0.3)
    low, high = pose.bounds
    vertices = pose.skin()
    assert (vertices >= low).all() and (vertices <= high).all()


def test_long_calls_release_the_gil(model):
    """While one thread skins for long, this one goes on; and its pose refuses a second user."""
    times = numpy.linspace(0, 1, 20_000, dtype=numpy.float32)
    matrices = threading.Thread(target=lambda: model.pose_clip("Walk", times))
    matrices.start()
    steps = 0
    while matrices.is_alive():
        steps += 1
        time.sleep(0)
    assert steps > 10


def test_options_of_solvers_reach_them(model):
    """Each moves the hand otherwise than its default, with the solver that it is for."""
    def hand(**options):
        pose = model.sample("Walk", 0.3)
        result = pose.reach("IK_LeftArm", (0.3, 1.2, 0.4), **options)
        return tuple(pose.matrices.ravel()), result

    for solver, options in (("pull", {"gain": 0.5}), ("pull", {"step_limit": 0.01}), ("two_bone", {"softness": 0.5})):
        assert hand(solver=solver)[0] != hand(solver=solver, **options)[0], options
    far = {"solver": "least_squares", "tolerance": 1e-9}
    assert hand(**far, restarts=0)[1].iterations <= hand(**far, restarts=4)[1].iterations
