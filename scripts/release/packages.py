"""What package managers and Blender install, and the runtime as two files."""

import shutil
import tempfile
from pathlib import Path

from archives import write_zip
from project import VERSION, epoch, run


def make_debian(folder, log):
    run("cmake", "--preset", "deb", log=log)
    run("cmake", "--build", "--preset", "deb", log=log)
    with tempfile.TemporaryDirectory() as name:  # build/deb/packages may have those of other versions
        run("cpack", "--preset", "deb", "-B", name, log=log)
        for package in Path(name).glob("*.deb"):
            shutil.copy(package, folder)


def make_wheel(folder, log):
    run("/usr/bin/python3", "scripts/make_wheel.py", folder, log=log)


def make_npm(folder, log):
    run("scripts/web.sh", "package", log=log)
    run("npm", "pack", "--silent", "--pack-destination", folder, "./bindings/web", log=log)


def make_blender(folder, log):
    with tempfile.TemporaryDirectory() as name:
        run("bindings/blender/make_zip.sh", name, log=log)
        shutil.copy(Path(name, "bendy_rig.zip"), folder / f"bendy_rig-{VERSION}.zip")


def make_two_files(folder, log):
    with tempfile.TemporaryDirectory() as name:
        run("scripts/amalgamate.py", name, log=log)
        write_zip(folder / f"bendy-{VERSION}-two-files.zip", {path.name: path for path in Path(name).iterdir()}, epoch())
