"""Roles, poses of one model on another one of different build, and clips in files."""

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
    assert len(result.contacts) == 14 and max(result.contacts) > 0.5
    assert result.turned == 0.0 and result.turned_joint is None
    assert "missed" in repr(result)
    for name in ("rotations", "translations", "scales", "morph_weights"):
        assert numpy.array_equal(getattr(pose, name), getattr(source, name)), name
    assert retarget.apply(pose, source, state.reset(), contacts=[1, 1, 0, 0.25] + 10 * [0]).contacts == (1, 1, 0, 0.25) + 10 * (0,)
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
    for contacts in ([1, 2, 3], [1, numpy.nan] + 10 * [0]):
        with pytest.raises(ValueError):
            retarget.apply(pose, model.pose(), state, contacts)


def other_build(text):
    """Lengthens the shins of a text form, and renames its joints."""
    for part in text:
        for name, content in part.items():
            if name == "SKIN" and content[0].get("NAME", "").endswith(("LeftFoot", "RightFoot")):
                rest = next(one["PIVO"] for one in content if "PIVO" in one)[0]["REST"]
                rest["translation"] = [1.3 * number for number in rest["translation"]]
            if name in ("HEAD", "OBJE", "SKIN"):
                other_build(content)


@pytest.fixture(scope="module")
def tall(mannequin, tmp_path_factory):
    """The mannequin with longer shins, other names of joints, and no clip but Idle: a path."""
    text = bendy.dump(mannequin)
    other_build(text["HEAD"])
    edit = bendy.edit(bendy.assemble(text)).strip("clip:Walk").rename("joint", {"mixamorig:*": "b_*"})
    return edit.save(tmp_path_factory.mktemp("tall") / "tall.bendy")


@pytest.mark.parametrize("options, flags", [
    ({}, []),
    ({"clip": "Wal*"}, []),
    ({"limits": "off", "plants_feet": False}, ["--limits", "off", "--free-feet"]),
    ({"rest_poses": "alike"}, ["--rests-alike"]),
    ({"chooses_rests": False}, ["--rests-measured"]),
])
def test_clips_come_as_by_the_program(mannequin, tall, program, tmp_path, options, flags):
    options = {"clip": "Walk", **options}
    edit = bendy.edit(tall).retarget_clips(mannequin, **options)
    program("edit", tall, "-o", tmp_path / "out.bendy", "--retarget", f"{mannequin}:{options['clip']}", *flags)
    assert bytes(edit.data) == (tmp_path / "out.bendy").read_bytes()
    assert edit.open().clips.names == ["Idle", "Walk"] and not edit.validate()
    assert any(line.startswith('retargeted clip "Walk"') and "off by" in line for line in edit.done)


def test_options_of_retargeting_change_the_clip(mannequin, tall):
    usual, others = (bytes(bendy.edit(tall).retarget_clips(mannequin, "Walk", **options).data)
                     for options in ({}, {"limits": "off"}))
    assert usual != others
    assert usual != bytes(bendy.edit(tall).retarget_clips(mannequin, "Walk", plants_feet=False).data)


def test_a_source_of_another_kind_and_clips_of_the_same_name(tall):
    source = ROOT / "examples/mannequin.glb"
    edit = bendy.edit(tall)
    with pytest.raises(bendy.EditError, match='"Idle"'):
        edit.retarget_clips(source)
    assert edit.done == [] and edit.open().clips.names == ["Idle"]
    assert edit.retarget_clips(source, same_name="number").open().clips.names == ["Idle", "Idle.001", "Walk"]
    assert bendy.edit(tall).retarget_clips(source, 0, same_name="replace").open().clips.names == ["Idle"]
    with pytest.raises(ValueError, match="input"):
        bendy.edit(tall).retarget_clips(source, "Walk").save(tall, overwrite=True)


def test_retargeting_of_files_says_what_is_wrong(mannequin, tall):
    edit = bendy.edit(tall)
    for call, error, message in [
        (lambda: edit.retarget_clips(mannequin, "Wlak"), bendy.EditError, "Wlak"),
        (lambda: edit.retarget_clips(ROOT / "examples/tentacle.glb"), bendy.EditError, "the source does not say what its joints are"),
        (lambda: bendy.edit(ROOT / "examples/tentacle.glb").retarget_clips(mannequin), bendy.EditError, "the target does not say"),
        (lambda: edit.retarget_clips(mannequin, same_name="magic"), ValueError, "same_name"),
        (lambda: edit.retarget_clips(mannequin, rest_poses="magic"), ValueError, "rest_poses"),
        (lambda: edit.retarget_clips(b"no character"), bendy.EditError, "the source cannot be opened: this is not a bendy file"),
        (lambda: edit.retarget_clips(mannequin.parent / "none.bendy"), FileNotFoundError, ""),
    ]:
        with pytest.raises(error, match=message):
            call()
    assert bytes(edit.data) == tall.read_bytes() and edit.done == edit.warnings == []


def test_how_the_body_stands_is_told(mannequin, tmp_path):
    def turned(source):
        return [chunk.fields for chunk in bendy.inspect(source).walk() if chunk.id == "STND"]

    told = bendy.edit(mannequin).stand("Walk", 0.35)
    assert told.done[0].startswith("the body stands as told") and len(turned(told)) == 1
    model = told.open()
    frame, standing = model.sample("Walk", 0.35), model.pose().stand()
    hips = model.joints["mixamorig:Hips"].number
    assert numpy.allclose(abs(standing.rotations[hips] @ frame.rotations[hips]), 1, atol=1e-5)
    again = bendy.edit(mannequin).stand_as(told)
    assert turned(again) != turned(told), "it is the rest pose that is taken"
    with pytest.raises(ValueError, match="input"):
        again.save(mannequin, overwrite=True)
    assert bytes(told.strip("standing-pose").data) == bytes(bendy.edit(mannequin).data)
    for call, message in [
        (lambda edit: edit.stand("Walk", 9), "is from 0"),
        (lambda edit: edit.stand("Wlak", 0), "Wlak"),
        (lambda edit: edit.stand_as(ROOT / "examples/tentacle.glb"), "has no joint"),
    ]:
        edit = bendy.edit(mannequin)
        with pytest.raises(bendy.EditError, match=message):
            call(edit)
        assert bytes(edit.data) == mannequin.read_bytes() and edit.done == []


def test_roles_are_given(mannequin):
    edit = bendy.edit(mannequin).set_role("hips", None).set_role("tail:2", "mixamorig:Spine")
    roles = {joint.name: (joint.role, joint.role_place) for joint in edit.open().joints}
    assert roles["mixamorig:Hips"] == ("none", 0) and roles["mixamorig:Spine"] == ("tail", 2)
    edit.retarget_clips(mannequin, same_name="replace")
    assert any(warning.startswith("nothing here follows") for warning in edit.warnings)
    with pytest.raises(ValueError, match="nose"):
        edit.set_role("nose", "mixamorig:Head")
    with pytest.raises(bendy.EditError, match="Nose"):
        edit.set_role("hips", "Nose")
