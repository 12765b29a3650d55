"""Parts of another model are refused, and numbers that a model does not have; parts keep their file open."""

import gc

import bendy
import numpy
import pytest

from conftest import ROOT


@pytest.fixture(params=["twin", "larger"])
def other(request, model, mannequin):
    """Another model: of the same file, and of a file with other parts."""
    return bendy.open(mannequin if request.param == "twin" else ROOT / "examples/tentacle.glb")


def crossfade(model):
    fade = bendy.Crossfade(model)
    fade.play(0)
    return fade


CALLS = {
    "sample": lambda mine, other: mine.pose().sample(other.clips[0], 0),
    "Model.sample": lambda mine, other: mine.sample(other.clips[0], 0),
    "skin_clip": lambda mine, other: mine.skin_clip(other.clips[0], [0]),
    "pose_clip": lambda mine, other: mine.pose_clip(other.clips[0], [0]),
    "blend": lambda mine, other: mine.pose().blend(other.pose(), 0.5),
    "make_additive": lambda mine, other: mine.pose().make_additive(other.pose()),
    "add": lambda mine, other: mine.pose().add(other.pose()),
    "reach": lambda mine, other: mine.pose().reach(other.chains[0], (0, 1, 0)),
    "skin": lambda mine, other: mine.pose().skin(other.meshes[0]),
    "skin lod": lambda mine, other: mine.pose().skin(lod=bendy.Lod(other)),
    "palette": lambda mine, other: mine.pose().palette(other.meshes[0]),
    "socket": lambda mine, other: mine.pose().socket(other.joints[0]),
    "joint": lambda mine, other: mine.joint(other.joints[0]),
    "joints": lambda mine, other: mine.joints[other.joints[0]],
    "mask_below": lambda mine, other: mine.mask_below(other.joints[0]),
    "Crossfade.play": lambda mine, other: bendy.Crossfade(mine).play(other.clips[0]),
    "Crossfade.sample": lambda mine, other: crossfade(mine).sample(other.pose()),
    "RootPath": lambda mine, other: bendy.RootPath(mine, other.joints[0]),
    "RootPath.at": lambda mine, other: bendy.RootPath(mine, 0).at(other.clips[0], 0),
    "RootPath.between": lambda mine, other: bendy.RootPath(mine, 0).between(other.clips[0], 0, 1),
    "RootPath.over": lambda mine, other: bendy.RootPath(mine, 0).over(bendy.Playback(other.clips[0]).advance(0.1)),
    "RootPath.extract": lambda mine, other: bendy.RootPath(mine, 0).extract(other.pose()),
    "Binding": lambda mine, other: bendy.Binding(mine, mine, root=other.joints[0]),
    "Binding.sample clip": lambda mine, other: bendy.Binding(mine, mine).sample(mine.pose(), other.clips[0], 0),
    "Binding.sample pose": lambda mine, other: bendy.Binding(mine, mine).sample(other.pose(), 0, 0),
    "Crowd.skin": lambda mine, other: bendy.Crowd(mine, 1).skin(other.clips[0], [0]),
    "Crowd.skin list": lambda mine, other: bendy.Crowd(mine, 1).skin([None, other.clips[0]], [0, 0]),
    "Crowd.skin lod": lambda mine, other: bendy.Crowd(mine, 1).skin(0, [0], lod=bendy.Lod(other)),
    "Crowd.palettes": lambda mine, other: bendy.Crowd(mine, 1).palettes(other.clips[0], [0]),
    "Crowd.first_entry": lambda mine, other: bendy.Crowd(mine, 1).first_entry(other.meshes[0]),
    "Lod.vertex_count": lambda mine, other: bendy.Lod(mine).vertex_count(other.meshes[0]),
    "Lod.triangles": lambda mine, other: bendy.Lod(mine).triangles(other.meshes[0]),
}


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS.keys())
def test_parts_of_another_model(model, other, call):
    with pytest.raises(ValueError, match="model|none of these"):
        call(model, other)


def test_a_joint_is_no_clip(model):
    assert model.joints[model.joints[1]] is model.joints[1]
    for use in (model.pose().reach, model.pose().sample):
        with pytest.raises(TypeError):
            use(model.joints[0], (0, 0, 0) if use == model.pose().reach else 0)


@pytest.mark.parametrize("number", [10_000, -10_000, 2**31, 2**32, -2**63, 2**80])
def test_numbers_that_a_model_does_not_have(model, number):
    for call in (
        lambda: model.clips[number],
        lambda: model.pose().sample(number, 0),
        lambda: model.pose().reach(number, (0, 1, 0)),
        lambda: model.pose().skin(number),
        lambda: model.pose().palette(number),
        lambda: model.pose().socket(number),
        lambda: model.mask_below(number),
        lambda: bendy.RootPath(model, number),
        lambda: bendy.Lod(model).triangles(number),
        lambda: bendy.Crowd(model, 1).first_entry(number),
        lambda: bendy.Crowd(model, 1).skin(number, [0]),
    ):
        with pytest.raises(IndexError):
            call()


def test_parts_keep_the_file_open(mannequin):
    model = bendy.open(mannequin)
    walk, playback, fade = model.clips["Walk"], bendy.Playback(model.clips["Walk"]), crossfade(model)
    pose, path = model.pose(), bendy.RootPath(model, 0)
    expected = model.sample("Walk", 0.3).skin()
    model.close()
    del model
    gc.collect()
    assert walk.name == "Walk" and len(walk.tracks) > 0
    numpy.testing.assert_array_equal(pose.sample(walk, 0.3).skin(), expected)
    path.over(playback.advance(0.1))
    fade.advance(0.1)
    fade.sample(pose)
    assert fade.playing[0].clip.number == 0
