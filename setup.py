"""Builds the module of the Python package with CMake; pyproject.toml has the rest.

BENDY_BUILD_DIR names a build folder of CMake to take the module from; without it, the project is built in a folder of its own.
BENDY_CMAKE_ARGS are further arguments for CMake, such as "-DBENDY_VIEWER=OFF".
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
# Where setuptools puts its own files: the package's folder stays as it is.
WORK = Path(os.environ.get("BENDY_BUILD_DIR", ROOT / "build")) / "python_wheel"
# An editable installation is the package in the build folder, most of which are links to the sources.
IS_EDITABLE = "editable_wheel" in sys.argv
BUILD = Path(os.environ.get("BENDY_BUILD_DIR", WORK / "editable"))


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        folder = os.environ.get("BENDY_BUILD_DIR")
        if folder is None:
            folder = BUILD if IS_EDITABLE else Path(self.build_temp).resolve()
            self.configure(folder)
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        subprocess.run(["cmake", "--build", folder, "--target", "bendy_python", "--parallel", jobs], check=True)
        output = Path(self.get_ext_fullpath(extension.name)).resolve()
        output.parent.mkdir(parents=True, exist_ok=True)
        module = Path(folder, "python/bendy", output.name)
        if not module.exists():
            raise SystemExit(f"{module} is missing: the build folder is for another Python than {sys.executable}")
        shutil.copyfile(module, output)
        for file in module.parent.glob("*.py*"):  # the build folder has the whole package, with what is made from bendy.h
            shutil.copyfile(file, output.parent / file.name)

    def configure(self, folder):
        arguments = ["-DCMAKE_BUILD_TYPE=Release", "-DBENDY_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}"]
        arguments += [f"-DBENDY_{part}=OFF" for part in ("TESTS", "BENCHMARKS", "EXAMPLES", "INSTALL")]
        try:
            import pybind11
            arguments.append(f"-DBENDY_PYBIND11_INCLUDE={pybind11.get_include()}")
        except ImportError:
            pass  # the system's headers
        if shutil.which("ninja"):
            arguments += ["-G", "Ninja"]
        arguments += shlex.split(os.environ.get("BENDY_CMAKE_ARGS", ""))
        folder.mkdir(parents=True, exist_ok=True)
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, *arguments], check=True)


version = re.search(r"project\(bendy VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
WORK.mkdir(parents=True, exist_ok=True)
package = BUILD / "python" if IS_EDITABLE else ROOT / "bindings/python"
if IS_EDITABLE:
    Path(package, "bendy").mkdir(parents=True, exist_ok=True)
setup(version=version, packages=["bendy"], package_dir={"": os.path.relpath(package, ROOT)},
      options={"build": {"build_base": str(WORK)}, "egg_info": {"egg_base": str(WORK)}},
      ext_modules=[Extension("bendy._bendy", [])], cmdclass={"build_ext": CMakeBuild})
