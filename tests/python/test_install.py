"""pip installs the package, and a wheel contains the libraries that it needs."""

import os
import re
import shutil
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest
from conftest import ROOT


# Of docs/python.md: without a package index.
OFFLINE, = re.findall(r"^venv/bin/pip install( .+) \.$", (ROOT / "docs/python.md").read_text(encoding="utf-8"), re.M)


def install(tmp_path, *what):
    """Into a fresh environment. Returns its Python, and the variables to run it with."""
    if "BENDY_BUILD_DIR" not in os.environ:
        pytest.skip("no build folder to take the module from")
    venv.create(tmp_path / "venv", system_site_packages=True, with_pip=False, symlinks=True)
    python = tmp_path / "venv/bin/python"
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run([python, "-m", "pip", "install", "--quiet", *OFFLINE.split(), "--no-cache-dir",
                    "--disable-pip-version-check", *what], check=True, env=environment)
    return python, environment


def test_an_editable_installation_is_the_build_folder(tmp_path):
    python, environment = install(tmp_path, "-e", ROOT)
    script = (f"import bendy; print(bendy.__file__); print(bendy.open({str(ROOT / 'examples/tentacle.glb')!r}).sample(0, 0.5).skin().shape[1])")
    printed = subprocess.run([python, "-c", script], check=True, env=environment, cwd=tmp_path, capture_output=True, text=True).stdout
    assert printed.split() == [str(Path(os.environ["BENDY_BUILD_DIR"], "python/bendy/__init__.py")), "3"]


def test_pip_installs_it(tmp_path):
    """From where it needs neither the build folder nor the source."""
    python, environment = install(tmp_path, ROOT)
    script = ("import bendy, pathlib; folder = pathlib.Path(bendy.__file__).parent; print(folder); "
              f"print(bendy.open({str(ROOT / 'examples/tentacle.glb')!r}).pose().skin().shape[1]); "
              f"print(bendy.open({str(ROOT / 'examples/mannequin.glb')!r}).pose().reach('IK_LeftArm', (0, 1, 0), solver='ccd').status); "
              "print(*sorted(path.suffix for path in folder.iterdir() if path.is_file()))")
    printed = subprocess.run([python, "-c", script], check=True, env=environment, cwd=tmp_path, capture_output=True, text=True)
    folder, columns, status, suffixes = printed.stdout.splitlines()
    assert folder.startswith(str(tmp_path / "venv")) and columns == "3" and status
    modules = len(list((ROOT / "bindings/python/bendy").glob("*.py")))
    assert suffixes.split() == [*[".py"] * modules, ".pyi", ".pyi", ".so", ".typed"]
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
    licences = {path.stem: path for path in (tmp_path / "site").glob("*.dist-info/licenses/*.txt")}
    assert set(licences) == {*bundled, "NOTICES"} and "Copyright" in licences["NOTICES"].read_text(encoding="utf-8")
    assert list((tmp_path / "site").glob("*.dist-info/**/LICENSE"))
    subprocess.run([sys.executable, ROOT / "scripts/notices.py", "wheel", "--check", f"{os.environ['BENDY_BUILD_DIR']}:bendy_python"],
                   check=True)
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
