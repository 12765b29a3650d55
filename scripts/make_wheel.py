#!/usr/bin/env python3
"""Builds a wheel of the Python package that contains the libraries it needs, for Linux systems without them.

`pip install .` and `pip wheel .` link the system's libraries instead. The libraries that every Linux desktop has
(glibc, libstdc++, X11) stay outside, as PEP 600 allows. N is the oldest glibc, 2.N, that has all the symbols used.
Setting BENDY_BUILD_DIR takes the module from a build folder, as in setup.py. Needs Debian, patchelf, and pip, setuptools
and wheel of the Python that runs this script.
"""

import argparse
import hashlib
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Outside the wheel. The first nine are glibc's and GCC's; the others are X11's, which must match the display server.
SYSTEM = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|stdc\+\+|gcc_s|X11|xcb|Xau|Xdmcp|bsd|md))\.so(\.\d+)*")


def run(*command, **more):
    return subprocess.run([str(word) for word in command], check=True, text=True, stdout=subprocess.PIPE, **more).stdout


def needed_by(file):
    """Names of the libraries that an ELF file needs, in order."""
    return run("patchelf", "--print-needed", file).split()


def found_by_loader(file):
    """Where the loader finds the libraries that a file needs, directly or not, by name."""
    return dict(re.findall(r"^\s*(\S+) => (/\S+)", run("ldd", file), re.MULTILINE))


def oldest_glibc(files):
    """The N of glibc 2.N, the oldest that has every symbol the files use."""
    symbols = "".join(run("readelf", "--version-info", "--wide", file) for file in files)
    return max(int(minor) for minor in re.findall(r"GLIBC_2\.(\d+)", symbols))


def copyright_of(name):
    """The file in which Debian states the licence of a library."""
    package = run("dpkg-query", "--search", f"*/{name}").split(":")[0]
    return Path("/usr/share/doc", package, "copyright")


def bundle(module, folder, licences):
    """Copies the libraries that the module needs into a folder, under names of their own, and their licences into
    another; returns the copies."""
    paths = {name: path for name, path in found_by_loader(module).items() if not SYSTEM.fullmatch(name)}
    # Needed only by libraries that stay outside: reached through these, not through a copy.
    wanted, queue = [], [module]
    for file in queue:
        for name in needed_by(file):
            if name in paths and name not in wanted:
                wanted.append(name)
                queue.append(Path(paths[name]))
    folder.mkdir()
    licences.mkdir()
    names = {}
    for name in wanted:  # under a name that no other library has, so that the loader never takes one for the other
        stem, suffix = name.split(".so", 1)
        names[name] = f"{stem}-{hashlib.sha256(Path(paths[name]).read_bytes()).hexdigest()[:8]}.so{suffix}"
        shutil.copyfile(paths[name], folder / names[name])
        shutil.copyfile(copyright_of(name), licences / f"{stem}.txt")
    for name, own in names.items():
        run("patchelf", "--set-soname", own, folder / own)
    for file in (module, *(folder / own for own in names.values())):
        for name in needed_by(file):
            if name in names:
                run("patchelf", "--replace-needed", name, names[name], file)
        run("patchelf", "--force-rpath", "--set-rpath", "$ORIGIN/../bendy.libs" if file == module else "$ORIGIN", file)
    return [folder / own for own in names.values()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / "build/wheel", metavar="FOLDER",
                        help="where bendy-VERSION-...-manylinux_2_N_ARCH.whl goes: build/wheel if not named")
    output = parser.parse_args().folder.resolve()
    if shutil.which("patchelf") is None:
        sys.exit("patchelf is missing; install it with: sudo apt-get install patchelf")
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="bendy-wheel-") as name:
        work = Path(name)
        run(sys.executable, "-m", "pip", "wheel", "--quiet", "--no-build-isolation", "--no-deps", "--no-index",
            "--no-cache-dir", "--disable-pip-version-check", "--wheel-dir", work, ROOT)
        run(sys.executable, "-m", "wheel", "unpack", "--dest", work, next(work.glob("bendy-*.whl")))
        unpacked = next(path for path in work.iterdir() if path.is_dir())
        module = next((unpacked / "bendy").glob("_bendy*.so"))
        info = next(unpacked.glob("*.dist-info"))
        libraries = bundle(module, unpacked / "bendy.libs", info / "licenses")
        (info / "licenses/NOTICES.txt").write_text(run(sys.executable, "-B", ROOT / "scripts/notices.py", "wheel"), encoding="utf-8")
        tag = f"manylinux_2_{oldest_glibc([module, *libraries])}_{platform.machine()}"
        text = (info / "WHEEL").read_text()
        (info / "WHEEL").write_text(re.sub(r"^(Tag: .*-)linux_\w+$", rf"\g<1>{tag}", text, flags=re.MULTILINE))
        made = work / "made"
        made.mkdir()
        run(sys.executable, "-m", "wheel", "pack", "--dest-dir", made, unpacked)
        result = output / next(made.iterdir()).name
        os.replace(shutil.copyfile(next(made.iterdir()), result.with_suffix(".part")), result)
    print(f"{result} ({result.stat().st_size / 1e6:.1f} MB, {len(libraries)} libraries)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
