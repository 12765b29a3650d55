"""The artefacts of a release: what each is, the names of its files, how it is made, and in which kind of packaging/notices it is."""

import dataclasses
from collections.abc import Callable

import packages
import pages
import programs
from project import VERSION


@dataclasses.dataclass(frozen=True)
class Artefact:
    name: str  # for --only and --without
    what: str
    files: tuple  # patterns
    make: Callable  # make(folder, log)
    kind: str | None = None


ARTEFACTS = (
    Artefact("sources", "the sources", (f"bendy-{VERSION}.tar.gz",), programs.make_sources),
    Artefact("linux", "the program for Linux, x86-64; without the viewer", (f"bendy-{VERSION}-linux-x86_64.tar.gz",), programs.make_linux, "static"),
    Artefact("arm", "the program for Linux, 64-bit ARM; without the viewer", (f"bendy-{VERSION}-linux-aarch64.tar.gz",), programs.make_arm, "static-aarch64"),
    Artefact("windows", "the program for Windows, x86-64; without the viewer", (f"bendy-{VERSION}-windows-x86_64.zip",), programs.make_windows, "static-windows"),
    Artefact("debian", "a package for Debian 12: `sudo apt install ./FILE`", (f"*_{VERSION}-1_*.deb",), packages.make_debian),
    Artefact("wheel", "the Python package, for Linux: `pip install` this file", (f"bendy-{VERSION}-*.whl",), packages.make_wheel, "wheel"),
    Artefact("npm", "the npm package: `npm install` this file", (f"bendy-{VERSION}.tgz",), packages.make_npm, "npm"),
    Artefact("blender", "the add-on for Blender: Edit > Preferences > Add-ons > Install...", (f"bendy_rig-{VERSION}.zip",), packages.make_blender),
    Artefact("two-files", "the runtime as two files, for C++", (f"bendy-{VERSION}-two-files.zip",), packages.make_two_files),
    Artefact("page", "the page that shows and converts characters: open it in a browser", (f"bendy-{VERSION}-page.html",), pages.make_page, "page"),
    Artefact("site", "the documentation, with a gallery", (f"bendy-{VERSION}-site.tar.gz",), pages.make_site, "npm"),
)
