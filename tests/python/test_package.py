"""The package: its stubs and docstrings are complete, its example runs, and pip installs it."""

import ast
import csv
import inspect
import os
import re
import shutil
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import bendy
import pytest
from conftest import ROOT

OPTIONAL = {"render", "encode_png"}  # in builds with the viewer


def public(names):
    return {name for name in names if not name.startswith("_")}


def test_stubs_have_what_the_module_has():
    stub = ast.parse((ROOT / "python/bendy/_bendy.pyi").read_text())
    declared = {node.name: node for node in stub.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    assert public(declared) - OPTIONAL == public(vars(bendy._bendy)) - OPTIONAL - {"has_viewer"}
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


def test_pip_installs_it(tmp_path):
    """Into a fresh environment, from where it needs neither the build folder nor the source."""
    if "BENDY_BUILD_DIR" not in os.environ:
        pytest.skip("no build folder to take the module from")
    venv.create(tmp_path / "venv", system_site_packages=True, with_pip=False, symlinks=True)
    python = tmp_path / "venv/bin/python"
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-deps", "--no-index",
                    "--no-cache-dir", "--disable-pip-version-check", ROOT], check=True, env=environment)
    script = ("import bendy, pathlib; folder = pathlib.Path(bendy.__file__).parent; print(folder); "
              f"print(bendy.open({str(ROOT / 'examples/tentacle.glb')!r}).pose().skin().shape[1]); "
              "print(*sorted(path.suffix for path in folder.iterdir() if path.is_file()))")
    printed = subprocess.run([python, "-c", script], check=True, env=environment, cwd=tmp_path, capture_output=True, text=True)
    folder, columns, suffixes = printed.stdout.splitlines()
    assert folder.startswith(str(tmp_path / "venv")) and columns == "3"
    assert suffixes.split() == [".py", ".py", ".pyi", ".so", ".typed"]
    module = next((tmp_path / "venv").rglob("_bendy*.so"))
    assert os.environ["BENDY_BUILD_DIR"].encode() not in module.read_bytes()


def test_a_wheel_contains_the_libraries(tmp_path):
    """scripts/make_wheel.py: the module loads its own copies, and from the system what every Linux desktop has."""
    if "BENDY_BUILD_DIR" not in os.environ or shutil.which("patchelf") is None:
        pytest.skip("no build folder to take the module from, or no patchelf")
    printed = subprocess.run([sys.executable, ROOT / "scripts/make_wheel.py", tmp_path / "wheels"], check=True,
                             capture_output=True, text=True).stdout
    wheel, = (tmp_path / "wheels").iterdir()
    assert printed.startswith(str(wheel)) and re.search(r"-manylinux_2_\d+_\w+\.whl$", wheel.name)
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "site")
    bundled = {path.name.split("-")[0] for path in (tmp_path / "site/bendy.libs").iterdir()}
    assert {"libzstd", "libmeshoptimizer", "libdraco"} <= bundled
    assert {path.stem for path in (tmp_path / "site").glob("*.dist-info/licenses/*.txt")} == bundled
    # ctypes.CDLL loads the module as an import does, and nothing of numpy's.
    module, = (tmp_path / "site/bendy").glob("_bendy*.so")
    script = (f"import ctypes; before = open('/proc/self/maps').read(); ctypes.CDLL({str(module)!r})\n"
              "print(*{line.split()[-1] for line in open('/proc/self/maps') if '.so' in line and line.split()[-1] not in before})")
    loaded = subprocess.run([sys.executable, "-I", "-c", script], check=True, capture_output=True, text=True).stdout.split()
    outside = {Path(path).name.split(".")[0] for path in loaded if not path.startswith(str(tmp_path / "site"))}
    assert outside <= {"libc", "libm", "libdl", "librt", "libpthread", "libstdc++", "libgcc_s", "libX11", "libxcb", "libXau",
                       "libXdmcp", "libbsd", "libmd"}
    assert len(loaded) - len(outside) == len(bundled) + 1
    script = f"import bendy; print(bendy.open({str(ROOT / 'examples/tentacle.glb')!r}).sample(0, 0.5).skin().shape[1])"
    environment = {**os.environ, "PYTHONPATH": str(tmp_path / "site")}
    assert subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True, env=environment).stdout == "3\n"


@pytest.mark.parametrize("page", ["docs/python.md", "README.md"])
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
