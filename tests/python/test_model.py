"""The model: what is in it, arrays that are views of the file, lifetimes."""

import gc
import pickle
import threading

import bendy
import numpy
import pytest
from conftest import ROOT
from gltf_file import named_file, read_name_keys


def is_view_of(array, model):
    return numpy.shares_memory(array, model.source.bytes)


def test_contents(model, program, mannequin):
    assert model.name == "Scene"
    summary = model.summary()
    assert model.vertices == sum(mesh["vertices"] for mesh in summary["meshes"]) > 3000
    assert [joint.name for joint in model.joints] == [joint["name"] for joint in summary["joints"]]
    assert [clip.name for clip in model.clips] == model.clips.names == ["Idle", "Walk"]
    assert len(model.constraints) == summary["constraints"] > 0
    assert [chain.name for chain in model.chains] == [chain["name"] for chain in summary["chains"]]
    walk = model.clips["Walk"]
    assert (walk.start, walk.end, walk.loop) == (0.0, 1.0, True)


def test_one_reading_of_names_and_numbers(tmp_path):
    names, keys = read_name_keys(ROOT / "tests/format/name_keys.txt")
    model = bendy.open(named_file(tmp_path / "named.gltf", names))
    for key, expected in keys.items():
        finds = (lambda: model.clips[key].number, lambda: model.joints[key].number, lambda: model.joint(key),
                 lambda: model.sample(key, 0.5).matrices[0, 0, 3])
        for find in finds:
            if isinstance(expected, int):
                assert find() == expected, key
                continue
            with pytest.raises(KeyError, match=f"=0 is the |=1 is the " if expected == "ambiguous" else "there is no "):
                find()
        assert (key in model.clips) == (key in names)
    for scene, first in ((0, 0), (1, 1), ("=0", 1), ("#1", 1), ("6", 6)):
        assert bendy.convert(tmp_path / "named.gltf", scene=scene).open().joints[0].translation[0] == first
    with pytest.raises(bendy.ConversionError, match="ambiguous"):
        bendy.convert(tmp_path / "named.gltf", scene="0")


def test_items_by_number_name_and_slice(model):
    assert model.clips["Walk"] is model.clips[1] is model.clips[-1]
    assert "Walk" in model.clips and "Fly" not in model.clips and model.clips[0] in model.clips
    assert model.joints[1:3] == (model.joints[1], model.joints[2])
    with pytest.raises(KeyError, match="Walk"):  # the message suggests a name
        model.clips["Wlak"]
    with pytest.raises(IndexError):
        model.clips[2]
    with pytest.raises(TypeError):
        model.clips[1.5]


def test_parents_come_before_children(model):
    parents = model.parents
    assert parents.dtype == numpy.int32 and parents[0] == -1
    assert all(parent < number for number, parent in enumerate(parents))
    assert [joint.parent for joint in model.joints] == [None if parent < 0 else parent for parent in parents]


def test_arrays_are_views_of_the_mapped_file(model):
    mesh = model.meshes[0]
    arrays = [mesh.positions, mesh.normals, mesh.bones, mesh.palette, mesh.inverse_bind, mesh.indices, *mesh.texture_coords]
    arrays += [array for track in model.clips["Walk"].tracks for array in (track.times, track.values)]
    arrays += [image["bytes"] for texture in model.textures for image in texture.images if image["bytes"] is not None]
    assert len(arrays) > 100
    for array in arrays:
        assert is_view_of(array, model)
        assert not array.flags.writeable
        with pytest.raises(ValueError):
            array.flags.writeable = True
    assert mesh.positions.shape == (mesh.vertices, 3) and mesh.positions.dtype == numpy.float32
    assert mesh.weights.shape == mesh.bones.shape
    numpy.testing.assert_allclose(mesh.weights.sum(axis=1), 1.0, atol=1e-5)
    assert mesh.bones.max() < len(mesh.palette) == len(mesh.inverse_bind)
    assert mesh.positions is mesh.positions


def test_arrays_outlive_everything_else(mannequin):
    def positions_of_closed_model():
        with bendy.open(mannequin) as model:
            pose = model.sample("Walk", 0.3)
            return model.meshes[0].positions, pose, model.clips["Walk"]

    expected = bendy.open(mannequin)
    positions, pose, clip = positions_of_closed_model()
    gc.collect()
    numpy.testing.assert_array_equal(positions, expected.meshes[0].positions)
    numpy.testing.assert_array_equal(pose.skin(), expected.sample("Walk", 0.3).skin())
    assert clip.name == "Walk" and len(clip.tracks) == len(expected.clips["Walk"].tracks)


def test_use_after_close(mannequin):
    model = bendy.open(mannequin)
    pose = model.pose()
    model.close()
    assert model.closed and repr(model) == "<bendy.Model, closed>" and "closed" in model._repr_html_()
    for use in (lambda: model.joints, lambda: model.vertices, lambda: model.sample("Walk", 0.0), lambda: model.source,
                lambda: model.summary(), model.check_sums, lambda: bendy.render(model) if bendy._bendy.has_viewer else model.name):
        with pytest.raises(ValueError, match="closed"):
            use()
    assert pose.skin().shape[1] == 3
    model.close()


def test_a_file_may_be_read_into_memory(mannequin, tmp_path):
    path = tmp_path / "a.bendy"
    path.write_bytes(mannequin.read_bytes())
    assert bendy.open(path).source.is_mapped
    model = bendy.open(path, copied=True)
    assert not model.source.is_mapped
    path.write_bytes(b"")  # would end the program if it were mapped
    model.check_sums()
    with pytest.raises(FileNotFoundError):
        bendy.open(tmp_path / "none.bendy", copied=True)


def test_compact_files_are_decoded(compact, model):
    other = bendy.open(compact)
    mesh = other.meshes[0]
    assert other.clips["Walk"].is_packed and not model.clips["Walk"].is_packed
    assert mesh.positions.dtype == numpy.float32 and not mesh.positions.flags.writeable
    assert {track.path for track in other.clips["Walk"].tracks} >= {"rotation"}
    low, high = other.summary()["bounds"].values()
    height = high[1] - low[1]
    for extreme in (numpy.min, numpy.max):  # vertices are in another order
        numpy.testing.assert_allclose(extreme(other.sample("Walk", 0.3).skin(), axis=0),
                                      extreme(model.sample("Walk", 0.3).skin(), axis=0), atol=2e-4 * height)
    assert mesh.stored["positions"].dtype != numpy.float32


def test_triangles(model, posed, mannequin):
    pose = posed(mannequin)
    for mesh, expected in zip(model.meshes, pose["meshes"]):
        assert mesh.triangles().ravel().tolist() == expected["indices"]
    with pytest.raises(ValueError):
        model.meshes[0].triangles(share=float("nan"))


def test_levels_of_detail(tmp_path):
    model = bendy.convert(ROOT / "examples/tentacle.glb", lod=True).open()
    assert model.has_levels
    mesh = model.meshes[0]
    assert 0 < len(mesh.triangles(share=0.25)) < len(mesh.triangles()) / 3


def test_clamping(model):
    for constraint in model.constraints:
        joint = model.joints[constraint.joint]
        legal, violation = constraint.clamp_rotation(joint.rotation)
        numpy.testing.assert_allclose(numpy.abs(numpy.dot(legal, joint.rotation)), 1.0, atol=1e-5)
        assert violation == pytest.approx(0.0, abs=1e-3)
        turned = numpy.roll(joint.rotation, 1)
        legal, violation = constraint.clamp_rotation(turned)
        assert legal.dtype == numpy.float32 and numpy.linalg.norm(legal) == pytest.approx(1.0, abs=1e-5)
        again, none_left = constraint.clamp_rotation(legal)
        assert violation > 0.1 and none_left < 1e-3 and abs(numpy.dot(again, legal)) == pytest.approx(1.0, abs=1e-5)
        numpy.testing.assert_allclose(constraint.clamp_translation(joint.translation), joint.translation, atol=1e-6)
    for wrong in (lambda: constraint.clamp_rotation((1, 1, 0, 0)), lambda: constraint.clamp_rotation((0, 0, 1)),
                  lambda: constraint.clamp_translation((0, 0, numpy.inf))):
        with pytest.raises(ValueError):
            wrong()


def test_constraints_chains_and_materials(model):
    chain = model.chains["IK_LeftArm"]
    joints = [model.joints[number] for number in chain.links]
    assert [joint.number for joint in joints] == [chain.start, *chain.links[1:-1], chain.effector]
    assert all(b.parent == a.number for a, b in zip(joints, joints[1:]))
    kinds = {constraint.model for constraint in model.constraints}
    assert kinds == {"euler_box", "swing_twist_ellipse"}
    box = next(constraint for constraint in model.constraints if constraint.model == "euler_box")
    assert all(low < high for low, high in zip(box.rotation_min, box.rotation_max)) and box.euler_order in ("xyz", "xzy", "yxz", "yzx")
    assert model.materials["Wood"].roughness == pytest.approx(0.55)
    assert model.submeshes[0].topology == "triangles"
    assert sum(submesh.count for submesh in model.submeshes) == 3 * sum(len(mesh.triangles()) for mesh in model.meshes)


def test_tracks_curves_and_markers():
    model = bendy.open(ROOT / "spec/examples/every_chunk.bendy")
    wave = model.clips["wave"]
    assert [(marker.name, marker.seconds) for marker in wave.markers] == [("up", 0.25), ("down", 0.75)]
    shapes = {(track.path, track.target, track.interpolation): track.values.shape for track in wave.tracks}
    assert shapes["weights", 0, "cubic"] == (2, 3, 1) and shapes["translation", 0, "step"] == (3, 3)
    turn = next(track for track in wave.tracks if (track.path, track.target) == ("rotation", 0))
    for seconds, value in zip(turn.times, turn.values):  # a pose at the time of a key has the key's value
        rotation = model.sample(wave, seconds).rotations[0]
        numpy.testing.assert_allclose(rotation * numpy.sign(rotation @ value), value, atol=1e-6)
    shine = wave.curves["shine"]
    assert (shine.kind, shine.target, shine.path) == ("material", 0, "pbrMetallicRoughness/roughnessFactor")
    assert shine.sample(0.1) == pytest.approx([0.925]) and shine.values.ravel().tolist() == [1.0, 0.25]
    with pytest.raises(ValueError):
        shine.sample(float("nan"))
    assert model.extras == {"species": "worm"} and model.file_extras == {"author": "us"}
    assert model.joints[0].extras == {"side": "mid"} and model.joints[1].extras is None
    assert model.meshes["body"].attributes["_HEAT"].ravel().tolist() == [36.5, 37.0, 37.5]
    assert model.meshes["wing"].is_rigid and model.meshes["wing"].bones is None


def test_open_converts_other_formats(mannequin, model):
    converted = bendy.open(ROOT / "examples/mannequin.glb")
    assert converted.conversion.warnings and model.conversion is None
    numpy.testing.assert_array_equal(converted.meshes[0].positions, model.meshes[0].positions)
    from_bytes = bendy.open(mannequin.read_bytes())
    numpy.testing.assert_array_equal(from_bytes.sample("Walk", 0.5).skin(), model.sample("Walk", 0.5).skin())


def test_missing_files_and_folders(tmp_path):
    for function in (bendy.open, bendy.validate, bendy.inspect, bendy.edit, bendy.convert):
        with pytest.raises(FileNotFoundError) as caught:
            function(tmp_path / "nothing.bendy")
        assert caught.value.filename == str(tmp_path / "nothing.bendy")
        with pytest.raises(IsADirectoryError):
            function(tmp_path)
    with pytest.raises(TypeError):
        bendy.open(3)


def test_errors_have_code_path_and_offset(damaged, mannequin):
    joint = bendy.inspect(mannequin)["OBJE/SKIN"]
    with pytest.raises(bendy.MalformedError) as caught:  # a byte of a payload: the sum does not fit
        bendy.open(damaged(joint.offset + joint.size, b"\xff\xfe"))
    error = caught.value
    assert isinstance(error, bendy.Error) and error.code == "SUM_MISMATCH"
    assert error.path.startswith("HEAD/OBJE/SKIN") and error.offset > 0 and error.file.endswith("damaged.bendy")
    assert error.path in str(error) and str(error.offset) in str(error)
    copy = pickle.loads(pickle.dumps(error))
    assert (copy.code, copy.path, copy.offset, str(copy)) == (error.code, error.path, error.offset, str(error))
    with pytest.raises(bendy.MalformedError) as caught:
        bendy.open(mannequin.read_bytes()[:5000])
    assert caught.value.file is None and caught.value.offset is not None


def test_deferred_sums(damaged, mannequin):
    mesh = bendy.inspect(mannequin)["OBJE/VECT/POSI"]
    path = damaged(mesh.offset + 1000, b"\x01")
    model = bendy.open(path, check_sums=False)
    with pytest.raises(bendy.MalformedError) as caught:
        model.check_sums()
    assert caught.value.path == "HEAD/OBJE/VECT/POSI"


def test_every_damaged_byte_is_an_error_or_a_model(mannequin):
    """Whatever bytes a file holds, the interpreter survives them."""
    data = mannequin.read_bytes()
    rng = numpy.random.default_rng(1)
    outcomes = {"opened": 0, "refused": 0}
    for _ in range(150):
        copy = bytearray(data)
        for place in rng.integers(0, len(copy), 3):
            copy[place] = rng.integers(256)
        try:
            model = bendy.open(bytes(copy), check_sums=False)
        except (bendy.Error, UnicodeError):
            outcomes["refused"] += 1
            continue
        outcomes["opened"] += 1
        model.sample(0, 0.2).skin(normals=True)
        [track.values.sum() for track in model.clips[0].tracks]
    assert outcomes["opened"] > 0 and outcomes["refused"] > 0, outcomes


def test_threads_share_a_model_and_not_a_pose(model):
    expected = [model.sample("Walk", k / 8).skin() for k in range(8)]
    results = [None] * 8

    def work(k):
        results[k] = model.sample("Walk", k / 8).skin()

    threads = [threading.Thread(target=work, args=(k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for mine, theirs in zip(results, expected):
        numpy.testing.assert_array_equal(mine, theirs)


def test_html_for_notebooks(model):
    page = model._repr_html_()
    for text in ("mannequin.bendy", "IK_LeftArm", "Walk 1 s", "Wood", "bounds"):
        assert text in page
    evil = bendy.edit(model).rename("clip", {"Walk": "<script>alert(1)</script>"}).open()
    assert "<script>" not in evil._repr_html_() and "&lt;script&gt;" in evil._repr_html_()
