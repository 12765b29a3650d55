"""The package: its stubs and docstrings are complete, and its examples run."""

import ast
import csv
import inspect
import re
import shutil
import subprocess
import sys
from pathlib import Path

import bendy
import pytest
from conftest import ROOT

OPTIONAL = {"render", "encode_png"}  # in builds with the viewer


def public(names):
    return {name for name in names if not name.startswith("_")}


def test_stubs_have_what_the_module_has():
    stub = ast.parse((ROOT / "bindings/python/bendy/_bendy.pyi").read_text())
    declared = {node.name: node for node in stub.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    assert public(declared) - OPTIONAL == public(vars(bendy._bendy)) - OPTIONAL - {"has_viewer", "c"}  # that has a stub of its own
    for name, node in declared.items():
        if not isinstance(node, ast.ClassDef):
            continue
        members = {part.name if isinstance(part, ast.FunctionDef) else part.target.id
                   for part in node.body if isinstance(part, (ast.FunctionDef, ast.AnnAssign))}
        assert public(members) == public(vars(getattr(bendy._bendy, name))), name


def test_everything_has_a_docstring():
    things = [getattr(bendy, name) for name in bendy.__all__] + [bendy]
    assert len(things) > 35
    for thing in things:
        assert thing.__doc__, thing
        if inspect.isclass(thing) and not issubclass(thing, BaseException):
            for name in public(vars(thing)) - set(getattr(thing, "__slots__", ())):
                member = getattr(thing, name)
                assert member is None or member.__doc__, f"{thing.__name__}.{name}"


def test_all_names_what_is_public():
    modules = {"_bendy", "_errors"}
    found = {name for name, value in vars(bendy).items() if not name.startswith("_") and not inspect.ismodule(value)}
    assert found == set(bendy.__all__) - modules


def test_the_pipeline_example(tmp_path):
    sources = tmp_path / "sources"
    sources.mkdir()
    for name in ("mannequin.glb", "tentacle.glb"):
        (sources / name).symlink_to(ROOT / "examples" / name)
    (sources / "broken.glb").write_bytes(b"glTF, or not")
    command = [sys.executable, ROOT / "examples/pipeline.py", sources, tmp_path / "out", "--size", "64x48"]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == 1, result.stderr  # one of the sources is broken
    rows = list(csv.DictReader((tmp_path / "out/report.csv").open()))
    assert [row["file"] for row in rows] == ["broken.glb", "mannequin.glb", "tentacle.glb"]
    broken, mannequin, tentacle = rows
    assert broken["error"] and not broken["vertices"]
    assert not mannequin["error"] and mannequin["clips"] == "2" and int(mannequin["constraints"]) > 10
    assert bendy.open(tmp_path / "out/tentacle.bendy").vertices == int(tentacle["vertices"])
    assert (tmp_path / "out/sheet.png").exists() == bendy._bendy.has_viewer
    again = subprocess.run(command, capture_output=True, text=True)
    assert again.returncode == 2 and "overwrite" in again.stderr


def test_the_pipeline_loses_nothing(tmp_path):
    """Two sources of one output, an output that is a source, and files that are there: named before anything is written."""
    sources, out = tmp_path / "sources", tmp_path / "out"
    sources.mkdir()
    (sources / "folder.glb").mkdir()  # is no source

    def refused(*said, folder=out, options=()):
        before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
        result = subprocess.run([sys.executable, ROOT / "examples/pipeline.py", sources, folder, *options], capture_output=True, text=True)
        assert result.returncode == 2 and "Traceback" not in result.stderr, result.stderr
        for text in said:
            assert text in result.stderr
        assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before and not (tmp_path / "out/report.csv").exists()

    def given(*names):
        for path in sources.iterdir():
            if not path.is_dir():
                path.unlink()
        for name in names:
            shutil.copy(ROOT / "examples/tentacle.glb", sources / name)

    for names in (("dog.glb", "dog.vrm"), ("dog.glb", "dog.GLB"), ("Dog.glb", "dog.glb"), ("dog.bendy", "dog.glb")):
        given(*names)
        for options in ((), ("--overwrite",)):
            refused(f"both {sources / sorted(names)[0]} and {sources / sorted(names)[1]} would be written to", options=options)
    given("dog.bendy")
    refused("would replace the source", folder=sources, options=("--overwrite",))
    given("dog.glb", "cat.glb")
    out.mkdir()
    (out / "cat.bendy").symlink_to(sources / "dog.glb")
    refused("cat.bendy would replace the source", options=("--overwrite",))
    (out / "cat.bendy").unlink()
    for name in ("dog.bendy", "sheet.png"):
        (out / name).write_text("mine")
        refused(f"{out / name} exists")
        (out / name).unlink()
    (out / "dog.bendy").write_text("mine")
    (out / "cat.bendy").hardlink_to(out / "dog.bendy")
    refused("would be written to", options=("--overwrite",))
    (out / "cat.bendy").unlink()
    (out / "cat.bendy").symlink_to(out / "dog.bendy")
    refused("would be written to", options=("--overwrite",))
    missing = subprocess.run([sys.executable, ROOT / "examples/pipeline.py", tmp_path / "missing", tmp_path / "new"], capture_output=True, text=True)
    assert missing.returncode == 2 and "missing" in missing.stderr and "Traceback" not in missing.stderr
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize("page", ["docs/python.md", "docs/languages.md", "docs/retarget.md"])
def test_the_documentations_blocks_run(page, tmp_path):
    blocks = re.findall(r"^```python\n(.*?)^```$", (ROOT / page).read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    assert blocks
    for name in ("mannequin.glb", "tentacle.glb"):
        shutil.copy(ROOT / "examples" / name, tmp_path)
    for block in blocks:
        if "import bpy" in block:  # tests/blender/blender_test.py runs that one
            continue
        if "render" in block and not bendy._bendy.has_viewer:
            continue
        done = subprocess.run([sys.executable, "-c", block], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, f"{block}\n{done.stderr}"
