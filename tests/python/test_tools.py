"""convert, validate, inspect, edit, export, render: the program's answers, and files that are never lost."""

import inspect
import json
import math
import os
import signal
import subprocess
import time

import bendy
import numpy
import pytest
from conftest import ROOT, write_quake_model


def test_conversion_equals_the_programs(tmp_path, program, mannequin):
    source = ROOT / "examples/tentacle.glb"
    report = json.loads(program("convert", source, "-o", tmp_path / "by_program.bendy", "--json", "--force", "--lod"))
    made = bendy.convert(source, tmp_path / "by_module.bendy", lod=True)
    assert made.output.read_bytes() == (tmp_path / "by_program.bendy").read_bytes() == bytes(made.data)
    report = report[0] if isinstance(report, list) else report.get("files", [report])[0]
    assert made.warnings == report["warnings"] and made.report["vertices"] == report["vertices"]
    assert source in [path for path in made.sources]
    source = ROOT / "examples/mannequin.glb"
    in_memory = bendy.convert(source)
    assert in_memory.output is None and bytes(in_memory.data) == mannequin.read_bytes()
    assert bytes(bendy.convert(source.read_bytes()).data) == mannequin.read_bytes()


def test_convert_takes_the_options_of_the_program():
    own = {"source", "output", "name", "jobs", "progress", "overwrite"}
    parameters = set(inspect.signature(bendy.convert).parameters)
    assert parameters - own == set(bendy._bendy.convert_options())
    for option in parameters:
        assert option in ("source", "overwrite") or f"{option}: " in bendy.convert.__doc__, f"{option} is not described"
    for option, value in (("skeleton", 3), ("compact", 0.1), ("lod", "no"), ("ticks_per_second", "x")):
        with pytest.raises(TypeError, match="has the wrong type"):
            bendy.convert(ROOT / "examples/tentacle.glb", **{option: value})
    assert bendy.convert(ROOT / "examples/tentacle.glb", compact=None).report
    with pytest.raises(TypeError, match="no such option"):
        bendy._bendy.convert("a.glb", None, "", {"speed": 1}, None, 0, None)


def test_compact_conversion(compact, mannequin):
    assert 0 < compact.compact["measuredError"] <= compact.compact["maxError"]
    assert len(compact.data) < mannequin.stat().st_size / 2 and "compact.bendy" in repr(compact)
    made = bendy.convert(ROOT / "examples/tentacle.glb", compact="1mm")
    assert 0 < made.compact["measuredError"] <= made.compact["maxError"] == pytest.approx(1e-3)
    with pytest.raises(ValueError, match="compact"):
        bendy.convert(ROOT / "examples/mannequin.glb", compact="1 parsec")


def test_files_outside_the_sources_folder(tmp_path):
    inner = tmp_path / "inner"
    inner.mkdir()
    (tmp_path / "secret").write_bytes(bytes(12))
    text = json.dumps({"asset": {"version": "2.0"}, "nodes": [{}], "buffers": [{"byteLength": 12, "uri": "../secret"}],
                       "images": [{"uri": "..%2fsecret"}]})
    source = inner / "m.gltf"
    source.write_text(text, encoding="utf-8")
    for refused in (source, text.encode()):
        with pytest.raises(bendy.ConversionError, match=": root FOLDER"):
            bendy.convert(refused)
        with pytest.raises(bendy.ConversionError, match=": root FOLDER"):
            bendy.open(refused)
    made = bendy.convert(source, root=tmp_path)
    assert [os.path.basename(one["file"]) for one in made.report["embedded"]] == ["secret"]
    assert any("not an image" in warning["message"] for warning in made.warnings)
    bendy.open(source, root=str(tmp_path))
    bendy.convert(text.encode(), root=tmp_path, name=str(source))


def test_the_texture_of_a_quake_model(tmp_path):
    model = write_quake_model(tmp_path / "man.md2", ["still"])
    skin = tmp_path / "skin.png"
    skin.write_bytes(b"\x89PNG\r\n\x1a\n")
    assert bendy.convert(model).report["embedded"] == []
    assert [one["bytes"] for one in bendy.convert(model, texture=skin).report["embedded"]] == [8]
    with pytest.raises(FileNotFoundError):
        bendy.convert(model, texture=tmp_path / "none.png")


def test_conversions_that_fail(tmp_path):
    broken = tmp_path / "broken.gltf"
    broken.write_text('{"asset": {"version": "2.0"}, "scenes": [{"nodes": [5]}]}')
    with pytest.raises(bendy.ConversionError) as caught:
        bendy.convert(broken, tmp_path / "out.bendy")
    assert caught.value.path and "scenes" in caught.value.path and caught.value.code == "CONVERSION"
    assert not (tmp_path / "out.bendy").exists()
    with pytest.raises(bendy.ConversionError):
        bendy.convert(b"not a model at all")
    with pytest.raises(FileNotFoundError):
        bendy.convert(ROOT / "examples/mannequin.glb", rig=tmp_path / "no_rig.json")
    with pytest.raises(ValueError):
        bendy.convert(ROOT / "examples/mannequin.glb", images="both")


def test_a_rig_may_be_a_dict(tmp_path):
    source = ROOT / "examples/mannequin.glb"
    rig = {"bendy_rig": 1, "joints": {"*Head": {"model": "hinge", "x": [-10, 20]}}}
    (tmp_path / "rig.json").write_text(json.dumps(rig))
    of_file = bendy.convert(source, rig=tmp_path / "rig.json")
    assert bytes(bendy.convert(source, rig=rig).data) == bytes(of_file.data) != bytes(bendy.convert(source).data)
    rig["joints"]["*Head"]["x"] = numpy.array([-10, 20], numpy.float32)  # as computed
    assert bytes(bendy.convert(source, rig=rig).data) == bytes(of_file.data)
    for wrong in ({}, {"bendy_rig": 2}, {"bendy_rig": 1, "chains": [{"name": "a", "start": "nobody", "effector": "nobody"}]}, {"bendy_rig": math.nan}):
        (tmp_path / "rig.json").write_text(json.dumps(wrong))
        errors = []
        for given in (wrong, tmp_path / "rig.json"):
            with pytest.raises(bendy.ConversionError) as caught:
                bendy.convert(source, rig=given)
            errors.append((caught.value.path, str(caught.value).replace(str(tmp_path / "rig.json"), "rig")))
        assert errors[0] == errors[1]
    with pytest.raises(TypeError):
        bendy.convert(source, rig={"bendy_rig": object()})


def test_nothing_is_overwritten_unless_asked(tmp_path, mannequin):
    target = tmp_path / "precious.bendy"
    target.write_text("precious")
    edit = bendy.edit(mannequin)
    for write in (
        lambda **options: bendy.convert(ROOT / "examples/tentacle.glb", target, **options),
        lambda **options: edit.save(target, **options),
    ):
        target.write_text("precious")
        with pytest.raises(FileExistsError):
            write()
        assert target.read_text() == "precious"
        write(overwrite=True)
        assert bendy.validate(target) == []
    glb = tmp_path / "out.gltf"
    (tmp_path / "out.bin").write_text("precious")
    with pytest.raises(FileExistsError):
        bendy.export(mannequin, glb)
    assert not glb.exists() and (tmp_path / "out.bin").read_text() == "precious"


def test_an_input_is_never_an_output(tmp_path, mannequin):
    copy = tmp_path / "copy.bendy"
    copy.write_bytes(mannequin.read_bytes())
    (tmp_path / "link.bendy").symlink_to(copy)
    with pytest.raises(ValueError, match="input"):
        bendy.convert(copy, tmp_path / "link.bendy", overwrite=True)
    glb = tmp_path / "model.glb"
    glb.symlink_to(copy)
    with pytest.raises(ValueError, match="input"):
        bendy.export(copy, glb, overwrite=True)
    with pytest.raises(ValueError, match="input"):
        bendy.edit(copy).strip("clips").save(copy, overwrite=True)
    with pytest.raises(ValueError, match="input"):
        bendy.edit(mannequin).merge_clips(copy, same_name="number").save(copy, overwrite=True)
    with pytest.raises(ValueError, match="input"):
        bendy.edit(bendy.open(copy)).save(copy, overwrite=True)
    assert copy.read_bytes() == mannequin.read_bytes()


def test_the_suffix_names_the_format(tmp_path):
    source = tmp_path / "mannequin.glb"
    source.write_bytes((ROOT / "examples/mannequin.glb").read_bytes())
    made = bendy.convert(source)
    for name in ("mannequin.glb", "mannequin.gltf", "mannequin.x", "mannequin.obj"):
        with pytest.raises(ValueError, match=r"\.bendy"):
            made.save(tmp_path / name, overwrite=True)
        with pytest.raises(ValueError, match=r"\.bendy"):
            bendy.convert(ROOT / "examples/mannequin.glb", tmp_path / name, overwrite=True)
    with pytest.raises(ValueError, match=r"\.png"):
        bendy.save_png(numpy.zeros((1, 1, 4), numpy.uint8), source, overwrite=True)
    assert source.read_bytes() == (ROOT / "examples/mannequin.glb").read_bytes() and len(list(tmp_path.iterdir())) == 1


def test_names_that_are_not_utf_8(tmp_path, mannequin):
    odd = os.fsdecode(bytes(tmp_path) + b"/caf\xe9.bendy")
    assert bendy.convert(ROOT / "examples/mannequin.glb", odd).output.read_bytes() == mannequin.read_bytes()
    assert bendy.open(odd).joints.names and bendy.validate(odd) == []
    assert str(bendy.open(odd).source.file) == odd
    with pytest.raises(FileNotFoundError):
        bendy.open(odd + "x")


def test_validate(mannequin, damaged, program):
    assert bendy.validate(mannequin) == [] and bendy.validate(mannequin).left_out == 0
    path = damaged(bendy.inspect(mannequin)["OBJE/CYCL/CINF"].offset + 16, b"\x00\x00\xc0\x7f")  # a start that is NaN
    faults = bendy.validate(path)
    expected = json.loads(program("validate", "--json", path, status=1))
    expected = expected[0] if isinstance(expected, list) else expected
    listed = expected.get("faults") or expected["files"][0]["faults"]
    assert [(fault.code, fault.path, fault.offset) for fault in faults] == [
        (fault["code"], fault["path"], fault["offset"]) for fault in listed]
    assert len(faults) >= 2 and {fault.kind for fault in faults} == {"invalid", "malformed"}
    assert set(faults[0].as_dict()) == {"code", "kind", "message", "path", "offset"}
    assert faults[0].code in str(faults[0]) and faults[0].path in str(faults[0])
    with pytest.raises(bendy.MalformedError) as caught:
        bendy.validate(b"Kaydara FBX Binary  \0\x1a\0" + bytes(40))
    assert caught.value.code == "NOT_A_BENDY_FILE" and "is an FBX file" in str(caught.value)
    assert [fault.kind for fault in bendy.validate(mannequin.read_bytes()[:1000])] == ["malformed"]
    assert bendy.validate(b"")[0].kind == "malformed"


def test_validate_and_inspect_convert_sources(tmp_path):
    source = ROOT / "examples/mannequin.glb"
    faults = bendy.validate(source)
    assert faults == [] and faults.warnings == bendy.convert(source).warnings != []
    broken = tmp_path / "broken.gltf"
    broken.write_text('{"asset": {"version": "2.0"}, "scenes": [{"nodes": [5]}]}')
    (fault,) = bendy.validate(broken)
    assert (fault.code, fault.kind, fault.path) == ("CONVERSION", "invalid", "scenes[0].nodes[0]")
    assert [chunk.sum for chunk in bendy.inspect(source).walk()] == [
        chunk.sum for chunk in bendy.inspect(bendy.convert(source)).walk()]


def test_files_that_nothing_reads_are_named(tmp_path, program):
    for name, content in (("a.fbx", b"Kaydara FBX Binary  \0\x1a\0" + bytes(40)), ("a.usdc", b"PXR-USDC" + bytes(80))):
        path = tmp_path / name
        path.write_bytes(content)
        said = subprocess.run([os.environ["BENDY_PROGRAM"], "pose", path], capture_output=True, text=True).stderr
        for read in (bendy.open, bendy.edit, bendy.inspect, bendy.convert):
            with pytest.raises(bendy.ConversionError) as caught:
                read(path)
            assert f"bendy: error: {caught.value}\n" == said


def test_inspect(mannequin, program):
    root = bendy.inspect(mannequin)
    expected = json.loads(program("inspect", mannequin, "--json"))["chunks"]
    walked = list(root.walk())
    assert [(c.id, c.offset, c.size, c.meaning) for c in walked] == [
        (e["id"], e["offset"], e["size"], e["meaning"]) for e in expected]
    assert [c.fields for c in walked] == [e.get("fields", {}) for e in expected]
    assert [c.number for c in walked] == list(range(len(walked)))
    name = root["OBJE/CYCL[1]/NAME"]
    assert name.path == "HEAD/OBJE/CYCL[1]/NAME" and bytes(name.payload) == b"Walk" and name.parent.name == "Walk"
    assert name.parent.parent.parent is root and root.parent is None
    assert not name.payload.flags.writeable
    assert len(root.find("SKIN")) == len(bendy.open(mannequin).joints)
    with pytest.raises(KeyError):
        root["OBJE/CYCL[9]"]
    with pytest.raises(KeyError):
        root["OBJE/CYCL[x]"]
    with pytest.raises(bendy.MalformedError):
        bendy.inspect(mannequin.read_bytes()[:2000])
    assert "HEAD/OBJE" in root._repr_html_() and "SKIN" in repr(root["OBJE/SKIN"])


def test_payloads_are_views(mannequin):
    model = bendy.open(mannequin)
    payload = bendy.inspect(model)["OBJE/VECT/POSI"].payload
    assert numpy.shares_memory(payload, model.source.bytes)
    assert numpy.shares_memory(payload, model.meshes[0].positions)


def test_edit(mannequin, tmp_path):
    edit = bendy.edit(mannequin).strip("clip:Walk", "textures").rename("joint", {"mixamorig:*": "*"})
    saved = edit.save(tmp_path / "edited.bendy")
    assert bendy.validate(saved) == [] and edit.done
    model = bendy.open(saved)
    assert model.clips.names == ["Idle"] and not model.textures and "Hips" in model.joints
    merged = bendy.edit(saved).rename("joint", {"*": "mixamorig:*"}, all_must_match=False)
    assert merged.merge_clips(mannequin, same_name="number").open().clips.names == ["Idle", "Idle.001", "Walk"]
    arm = bendy.edit(mannequin).extract("mixamorig:LeftArm").open()
    assert 0 < arm.vertices < model.vertices


def test_clips_are_changed(mannequin):
    edit = bendy.edit(mannequin).keep_clips("Walk").copy_clip("Walk", "Mirrored").mirror("Mirrored").trim("Walk", 0.25, 0.75)
    walk, mirrored = (edit.resample("Walk", 10).loop("Walk", 0.1).limit_influences(2).open()).clips
    assert (walk.name, walk.start, walk.end, walk.loop) == ("Walk", 0, 0.5, True) and mirrored.name == "Mirrored"
    assert mirrored.end > 0.5
    text = "mixamorig:Hips"
    assert "taken out" in bendy.edit(mannequin).root_motion("Walk", text).done[-1] or edit.done
    assert "averaged over 1 s" in bendy.edit(mannequin).on_the_spot("Walk").done[-1]
    assert "averaged over 0.5 s" in bendy.edit(mannequin).on_the_spot("Walk", 0.5).done[-1]
    for wrong in (lambda e: e.trim("Walk", 2, 1), lambda e: e.loop("Walk", 0), lambda e: e.resample("Walk", float("nan")),
                  lambda e: e.on_the_spot("Walk", 0), lambda e: e.keep_clips("")):
        with pytest.raises(ValueError):
            wrong(edit)
    for wrong in (lambda e: e.trim("Walk", 0, 9), lambda e: e.mirror("Wlak"), lambda e: e.root_motion("Walk", "a", "b")):
        with pytest.raises(bendy.EditError):
            wrong(edit)


def test_edits_that_fail_change_nothing(mannequin):
    edit = bendy.edit(mannequin)
    with pytest.raises(bendy.EditError, match="Wlak"):
        edit.strip("textures", "clip:Wlak")
    with pytest.raises(ValueError):
        edit.strip("everything")
    with pytest.raises(ValueError):
        edit.rename("nose", {"a": "b"})
    with pytest.raises(bendy.EditError):
        edit.merge_clips(mannequin)
    with pytest.raises(ValueError):
        edit.merge_clips(mannequin, same_name="magic")
    with pytest.raises(bendy.EditError):
        edit.extract("Nose")
    assert bytes(edit.data) == mannequin.read_bytes() and edit.done == []


def test_materials_are_changed(mannequin):
    edit = bendy.edit(mannequin).set_material("Wood", "roughness", 0.4).set_material("Wood", "base_colour", (1, 0.5, 0, 1))
    edit.set_material("*", "double_sided", True).set_material("Wood", "base_colour_texture.texture", None)
    assert '"roughness": 0.4,' in json.dumps(bendy.dump(edit)) and '"roughness": 0.4,' not in json.dumps(bendy.dump(mannequin))
    assert [line.split(": ")[1] for line in edit.done[:2]] == ["roughness is 0.4", "base_colour is 1.0,0.5,0.0,1.0"]
    with pytest.raises(bendy.EditError, match="roughness, "):
        edit.set_material("Wood", "shine", 1)
    with pytest.raises(bendy.EditError, match="from 0 to 1"):
        edit.set_material("Wood", "roughness", 2)


@pytest.mark.parametrize("suffix, files", [("glb", 1), ("gltf", 2), ("x", 1)])
def test_export_and_back(mannequin, tmp_path, suffix, files):
    made = bendy.export(mannequin, tmp_path / f"back.{suffix}")
    assert len(made.files) >= files and all(path.exists() for path in made.files)
    back = bendy.open(made.files[0])
    model = bendy.open(mannequin)
    assert back.clips.names == model.clips.names and len(back.joints) == len(model.joints)
    if suffix == "glb":
        assert bytes(back.source.bytes) == mannequin.read_bytes()
    with pytest.raises(ValueError):
        bendy.export(mannequin, tmp_path / "back.fbx")
    with pytest.raises(ValueError):
        bendy.export(mannequin, tmp_path / "far.glb", lod=0.25)  # no levels


def test_render(model):
    if not bendy._bendy.has_viewer:
        with pytest.raises(NotImplementedError):
            bendy.render(model)
        pytest.skip("built without the viewer")
    picture = bendy.render(model, "Walk", 0.3, size=(96, 64), background="transparent")
    assert picture.shape == (64, 96, 4) and picture.dtype == numpy.uint8
    assert 0.02 < (picture[..., 3] > 0).mean() < 0.9
    pose = bendy.render(model.sample("Walk", 0.3), size=(96, 64))
    assert pose.shape == (64, 96, 4) and len(numpy.unique(pose)) > 10
    pictures = bendy.render(model, "Walk", [0.0, 0.5, 0.9], size=(48, 32))
    assert pictures.shape == (3, 32, 48, 4) and not numpy.array_equal(pictures[0], pictures[1])
    sheet = bendy.contact_sheet(pictures, columns=2)
    assert sheet.shape == (64, 96, 4)
    numpy.testing.assert_array_equal(sheet[32:, :48], pictures[2])
    assert (sheet[32:, 48:] == pictures[0, 0, 0]).all()
    for call in (lambda: bendy.render(model, size=(0, 5)), lambda: bendy.render(model, times=0.5),
                 lambda: bendy.render(model.pose(), "Walk"), lambda: bendy.render(model, "Walk", float("nan")),
                 lambda: bendy.render(model, distance=0.0), lambda: bendy.contact_sheet([]),
                 lambda: bendy.encode_png(numpy.zeros((3, 3), numpy.uint8))):
        with pytest.raises(ValueError):
            call()
    with pytest.raises(KeyError):
        bendy.render(model, "Fly")
    for size in (320, (320,), (0.5, 100)):
        with pytest.raises(TypeError, match=r"size must be \(width, height\)"):
            bendy.render(model, size=size)


def test_png(model, tmp_path):
    if not bendy._bendy.has_viewer:
        pytest.skip("built without the viewer")
    pixels = numpy.arange(4 * 5 * 4, dtype=numpy.uint8).reshape(4, 5, 4)
    path = bendy.save_png(pixels, tmp_path / "a.png")
    data = path.read_bytes()
    assert data.startswith(b"\x89PNG\r\n\x1a\n") and data[16:24] == b"\x00\x00\x00\x05\x00\x00\x00\x04"
    with pytest.raises(FileExistsError):
        bendy.save_png(pixels, path)


def test_diff(mannequin, compact, program, tmp_path):
    assert bendy.diff(mannequin, mannequin.read_bytes())["same"]
    walk = bendy.edit(mannequin).strip("clip:Idle").save(tmp_path / "walk.bendy")
    found = bendy.diff(mannequin, walk)
    assert found == json.loads(program("diff", mannequin, walk, "--json", status=1)) and not found["same"]
    close = bendy.diff(mannequin, compact, tolerance="0.01%")
    assert close["same"] and 0 < close["worst"] <= close["tolerance"]
    assert not bendy.diff(mannequin, compact, tolerance="1um")["same"]
    with pytest.raises(ValueError, match="tolerance"):
        bendy.diff(mannequin, walk, tolerance="some")


def test_diff_of_a_broken_file(mannequin, damaged):
    path = damaged(bendy.inspect(mannequin)["OBJE/CYCL/CINF"].offset + 16, b"\x00\x00\xc0\x7f")
    with pytest.raises(bendy.Error):
        bendy.diff(mannequin, path)
    with pytest.raises(bendy.Error):
        bendy.diff(path, mannequin, tolerance="1mm")


def test_text_form(mannequin, compact, program):
    text = bendy.dump(mannequin)
    assert text == json.loads(program("dump", mannequin))
    assert bytes(bendy.assemble(text).data) == bytes(bendy.assemble(json.dumps(text)).data) == mannequin.read_bytes()
    assert bytes(bendy.assemble(bendy.dump(compact)).data) == bytes(compact.data)
    assert bytes(bendy.assemble(bendy.dump(compact, decode=True)).data) != bytes(compact.data)
    with pytest.raises(ValueError, match="line 1, column"):
        bendy.assemble("{")


@pytest.mark.parametrize("options", [{"compact": True}, {"lod": True}, {"compact": True, "lod": True}])
def test_progress(options):
    shares = []
    made = bendy.convert(ROOT / "examples/mannequin.glb", progress=shares.append, **options)
    assert len(shares) > 10 and shares == sorted(shares) and 0 <= shares[0] and shares[-1] <= 1
    assert bytes(made.data) == bytes(bendy.convert(ROOT / "examples/mannequin.glb", jobs=1, **options).data)

    def stop(share):
        if share > 0.1:
            raise LookupError(share)

    with pytest.raises(LookupError):
        bendy.convert(ROOT / "examples/mannequin.glb", progress=stop, **options)


def test_messages_name_options_as_python_does():
    gltf = b'{"asset": {"version": "2.0"}, "extensionsRequired": ["EXT_mesh_gpu_instancing"]}'
    with pytest.raises(bendy.ConversionError, match=r"unless instances are made \(instances\)"):
        bendy.convert(gltf)

@pytest.mark.parametrize("jobs", [1, 2])
def test_a_conversion_is_stopped(jobs):
    """By what progress raises and by a signal: in less than half of the processor time that the whole conversion takes."""
    def cost(**options):
        start = time.process_time()
        try:
            bendy.convert(ROOT / "examples/mannequin.glb", compact=True, jobs=jobs, **options)
        finally:
            spent.append(time.process_time() - start)

    def stop(share):
        raise LookupError(share)

    spent = []
    cost()
    with pytest.raises(LookupError):
        cost(progress=stop)
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            signal.setitimer(signal.ITIMER_REAL, 0.001)
            cost()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert max(spent[1:]) < 0.5 * spent[0]
