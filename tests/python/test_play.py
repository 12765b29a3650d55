"""Clips over time, clips of other files, crowds, sockets and levels of detail."""

import math

import bendy
import numpy
import pytest
from conftest import ROOT, write_quake_model


@pytest.fixture(scope="module")
def walker(tmp_path_factory):
    """The mannequin with markers in its walk and levels of detail, opened."""
    rig = tmp_path_factory.mktemp("rig") / "steps.json"
    rig.write_text('{"bendy_rig": 1, "markers": {"Walk": {"left": 0.1, "right": 0.6}}}')
    return bendy.convert(ROOT / "examples/mannequin.glb", rig=rig, lod=True).open()


def test_fades():
    fade = bendy.Fade(0.25)
    assert fade.weight == 0.25 and fade.is_done
    assert fade.to(1.0, 2.0, "linear").advance(1.0) is fade and not fade.is_done
    assert fade.weight == pytest.approx(0.625)
    assert fade.to(0.0, 2.0).advance(0.5).weight == pytest.approx(0.625 * (1 - bendy.ease("smooth", 0.25)))
    assert fade.advance(5.0).weight == 0.0 and fade.is_done
    assert bendy.ease("smooth", 0.25) == pytest.approx(3 * 0.25**2 - 2 * 0.25**3) and bendy.ease("linear", 0.25) == 0.25
    for wrong in (lambda: bendy.Fade(math.nan), lambda: fade.to(1.0, 1.0, "sudden"), lambda: fade.advance(math.inf)):
        with pytest.raises(ValueError):
            wrong()


def test_frames_of_a_clip(tmp_path):
    model = bendy.open(write_quake_model(tmp_path / "man.md2", ["run1", "run2", "run3"]))
    clip, = model.clips
    sequence, = clip.frame_sequences
    mesh = model.meshes[sequence.mesh]
    assert mesh.frames == 3 and sequence.frames == 3 and "FrameSequence 0" in repr(sequence)
    mix = sequence.mix(clip.start + 0.25 / clip.frame_rate)
    assert (mix.left, mix.right) == (sequence.first, sequence.first + 1) and mix.fraction == pytest.approx(0.25)
    with pytest.raises(ValueError):
        sequence.mix(math.nan)


def test_playback_passes_markers(walker):
    walk = walker.clips["Walk"]
    playback = bendy.Playback(walk, mode="repeat")
    assert playback.seconds == walk.start and playback.clip.name == "Walk"
    assert [marker.name for marker in playback.advance(0.3).markers()] == ["left"]
    assert [marker.name for marker in playback.advance(walk.seconds).markers()] == ["right", "left"]
    assert playback.passes == 1 and not playback.is_done
    far = playback.advance(walk.seconds * 1e6)
    assert far.marker_count == 2_000_000 and len(far.markers()) == 1000 and len(far.markers(limit=3)) == 3
    assert playback.seek_share(0.5) is playback and playback.share == pytest.approx(0.5)
    assert playback.seek(walk.start + 0.25).seconds == pytest.approx(walk.start + 0.25)
    assert (playback.start, playback.end) == pytest.approx((walk.start, walk.end))
    playback.speed = 0.0
    assert playback.advance(1.0).is_empty
    playback.mode = "once"
    playback.speed = -1.0
    playback.advance(100.0)
    assert playback.is_done and playback.seconds == walk.start
    for wrong in (lambda: bendy.Playback(walk, mode="backwards"), lambda: playback.advance(math.nan)):
        with pytest.raises(ValueError):
            wrong()
    with pytest.raises(TypeError, match="Clip"):
        bendy.Playback("Walk")


def test_crossfade(walker):
    crossfade = bendy.Crossfade(walker)
    pose = walker.pose()
    with pytest.raises(ValueError):
        crossfade.sample(pose)
    crossfade.play("Idle", mode="repeat")
    crossfade.advance(0.25)
    numpy.testing.assert_array_equal(crossfade.sample(pose).matrices, walker.sample("Idle", 0.25).matrices)
    crossfade.play("Walk", fade=0.4, easing="linear")
    crossfade.advance(0.1)
    idle, walk = crossfade.playing
    assert (idle.clip.name, walk.clip.name) == ("Idle", "Walk") and walk.share == pytest.approx(0.25)
    expected = walker.sample("Idle", idle.seconds).blend(walker.sample("Walk", walk.seconds), walk.share)
    numpy.testing.assert_allclose(crossfade.sample(pose).matrices, expected.matrices, atol=1e-6)
    assert [marker.name for marker in walk.played.markers()] == []
    crossfade.advance(1.0)
    assert [one.clip.name for one in crossfade.playing] == ["Walk"]
    with pytest.raises(KeyError):
        crossfade.play("Wlak")
    with pytest.raises(ValueError):
        crossfade.play("Walk", easing="bouncy")


def test_root_motion(walker):
    hips = bendy.RootPath(walker, "mixamorig:Hips", axes="xyz", turn="none")
    walk = walker.clips["Walk"]
    playback = bendy.Playback(walk, mode="repeat")
    character = bendy.RootMotion()
    for _ in range(10):
        character = character @ hips.over(playback.advance(walk.seconds / 5))
    end = hips.between(walk, walk.start, walk.end)
    numpy.testing.assert_allclose(character.translation, numpy.multiply(end.translation, 2), atol=1e-9)
    pose = walker.sample(walk, 0.4)
    before = pose.matrices[walker.joint("mixamorig:Hips")][:3, 3]
    taken = hips.extract(pose)
    after = pose.matrices[walker.joint("mixamorig:Hips")][:3, 3]
    numpy.testing.assert_allclose(before - after, taken.translation, atol=1e-6)
    numpy.testing.assert_allclose((taken @ taken.inverse()).matrix, numpy.eye(4), atol=1e-12)
    half = bendy.RootMotion((1, 2, 3)).blend(bendy.RootMotion((3, 2, 1)), 0.5)
    assert half.translation == (2, 2, 2) and half.rotation == (0, 0, 0, 1)
    with pytest.raises(ValueError):
        bendy.RootMotion(rotation=(0, 0, 0, 2))
    with pytest.raises(ValueError, match="letters"):
        bendy.RootPath(walker, 0, axes="xw")
    with pytest.raises(ValueError, match="another model"):
        hips.over(bendy.Playback(bendy.open(ROOT / "examples/tentacle.glb").clips[0]).advance(0.1))


def test_clips_of_another_file(walker, model, tmp_path):
    bare = bendy.edit(ROOT / "examples/mannequin.glb").strip("clips").open()
    assert len(bare.clips) == 0
    binding = bendy.Binding(model, bare)
    assert binding.joints == list(range(len(bare.joints))) and binding.unmatched_joints == []
    pose = binding.sample(bare.pose(), "Walk", 0.3)
    numpy.testing.assert_allclose(pose.skin(), model.sample("Walk", 0.3).skin(), atol=1e-5)
    tentacle = bendy.open(ROOT / "examples/tentacle.glb")
    strange = bendy.Binding(model, tentacle, translations="root_only")
    assert strange.unmatched_joints and set(strange.joints) == {None}
    with pytest.raises(ValueError):
        binding.sample(tentacle.pose(), "Walk", 0.3)
    with pytest.raises(ValueError):
        bendy.Binding(model, bare, translations="some")


def test_crowds(walker):
    crowd = bendy.Crowd(walker, threads=3)
    clips = ["Walk", None, "Idle"] * 20
    seconds = numpy.linspace(0, 2, 60)
    positions, normals = crowd.skin(clips, seconds, normals=True)
    palettes = crowd.palettes(clips, seconds)
    for k in (0, 1, 2, 31, 59):
        pose = walker.pose() if clips[k] is None else walker.sample(clips[k], seconds[k])
        numpy.testing.assert_array_equal(positions[k], pose.skin())
        numpy.testing.assert_array_equal(normals[k], pose.skin(normals=True)[1])
        for mesh in walker.meshes:
            if not mesh.is_rigid:
                first = crowd.first_entry(mesh)
                numpy.testing.assert_array_equal(palettes[k, first:first + len(mesh.palette)], pose.palette(mesh))
    assert crowd.skin("Walk", [0.0, 0.5]).shape == (2, walker.vertices, 3) and crowd.threads == 3
    assert crowd.skin("Walk", []).shape == (0, walker.vertices, 3)
    with pytest.raises(ValueError):
        crowd.skin(["Walk"], [0.0, 0.5])
    with pytest.raises(KeyError):
        crowd.skin("Wlak", [0.0])


def test_levels_of_detail(walker):
    lod = bendy.Lod(walker, 0.25)
    whole = bendy.Lod(walker)
    assert 0 < lod.triangle_count < 0.3 * whole.triangle_count and lod.share == 0.25 and whole.error == 0 < lod.error
    pose = walker.sample("Walk", 0.3)
    every, some = pose.skin(), pose.skin(lod=lod)
    in_crowd = bendy.Crowd(walker).skin("Walk", [0.3], lod=lod)[0]
    for mesh in walker.meshes:
        count = lod.vertex_count(mesh)
        alive = slice(mesh.first_vertex, mesh.first_vertex + count)
        assert lod.triangles(mesh).max(initial=0) < count <= mesh.vertices
        numpy.testing.assert_array_equal(lod.triangles(mesh), mesh.triangles(0.25))
        numpy.testing.assert_array_equal(some[alive], every[alive])
        numpy.testing.assert_array_equal(in_crowd[alive], every[alive])
        numpy.testing.assert_array_equal(pose.skin(mesh, lod=lod), every[alive])
        assert not some[mesh.first_vertex + count:mesh.first_vertex + mesh.vertices].any()
    with pytest.raises(ValueError, match="another model"):
        pose.skin(lod=bendy.Lod(bendy.open(ROOT / "examples/tentacle.glb")))
    with pytest.raises(ValueError):
        bendy.Lod(walker, math.nan)


def test_sockets(walker):
    pose = walker.sample("Walk", 0.3)
    hand = walker.joint("mixamorig:LeftHand")
    matrix = pose.matrices[hand]
    offset = numpy.eye(4)
    offset[:3, 3] = 0.1, 0.2, 0.3
    world = numpy.diag([2.0, 2.0, 2.0, 1.0])
    numpy.testing.assert_allclose(
        pose.socket("mixamorig:LeftHand", offset, model_to_world=world, keeps_size=False), world @ matrix @ offset, atol=1e-5)
    axes = pose.socket(hand)[:3, :3]
    numpy.testing.assert_allclose(axes @ axes.T, numpy.eye(3), atol=1e-5)
    with pytest.raises(ValueError):
        pose.socket(hand, numpy.eye(3))
    with pytest.raises(KeyError):
        pose.socket("Nose")
