#!/usr/bin/env python3
"""Makes the gallery, a live page for each capability.

docs/gallery/README.md says what the pages are made of. Needs the npm package, which scripts/web.sh builds, and the program:
BENDY_PROGRAM, or build/release/cli/bendy. The pages ask only for files in FOLDER, by http: python3 -m http.server -d FOLDER.
"""

import argparse
import html
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import notices
from own_folder import made_anew

ROOT = Path(__file__).resolve().parent.parent
SOURCES = ROOT / "docs/gallery"
WEB = ROOT / "bindings/web"
THREE = WEB / "node_modules/three"
# Files of three.js, and where the pages have them; each asks for the others by its relative path.
THREE_FILES = ("build/three.module.js", "build/three.core.js", "examples/jsm/controls/OrbitControls.js", "examples/jsm/utils/SkeletonUtils.js", "LICENSE")
IMPORTS = {"three": "./three/build/three.module.js", "three/addons/": "./three/examples/jsm/"}
# The characters, and the options of the conversion.
CHARACTERS = {"mannequin": ["--lod"], "tentacle": []}
FRAGMENT = re.compile(r"<!-- (?P<title>[^\n]+)\n(?P<text>.+?) -->\n(?P<content>.+)", re.S)


def imports():
    """The import map: the entries of the npm package that the pages name, and three.js."""
    entries = json.loads((WEB / "package.json").read_text(encoding="utf-8"))["exports"]
    used = re.findall(r"from '(bendy[^']*)'|import '(bendy[^']*)'", "".join(path.read_text(encoding="utf-8") for path in SOURCES.glob("*.*")))
    names = sorted({first or second for first, second in used})
    return IMPORTS | {name: "./bendy/" + entries["." + name.removeprefix("bendy")]["default"].removeprefix("./dist/") for name in names}


def read_pages():
    """{name: {title, text, content}}, in the order of the file names."""
    pages = {}
    for path in sorted(SOURCES.glob("[0-9]*.html")):
        match = FRAGMENT.fullmatch(path.read_text(encoding="utf-8"))
        if match is None:
            sys.exit(f"{path}: does not begin with a comment of a title and a text")
        pages[re.sub(r"^\d+_", "", path.stem)] = match.groupdict()
    return pages


def fill(template, parts):
    return re.sub(r"@(\w+)@", lambda match: parts[match[1]], template)


def links(pages, current):
    index = [] if current == "index" else ['<a href="index.html">Gallery</a>']
    return "\n".join(index + [f'<a href="{name}.html">{html.escape(page["title"])}</a>' for name, page in pages.items() if name != current])


def write_pages(folder):
    template = (SOURCES / "template.html").read_text(encoding="utf-8")
    pages = read_pages()
    shared = {"imports": json.dumps({"imports": imports()})}
    for name, page in pages.items():
        parts = {"title": page["title"], "text": page["text"], "content": page["content"], "code": html.escape(page["content"]), "links": links(pages, name)}
        (folder / f"{name}.html").write_text(fill(template, shared | parts), encoding="utf-8")
    items = "\n".join(f'<li><a href="{name}.html">{page["title"]}</a>: {page["text"]}</li>' for name, page in pages.items())
    index = {"title": "Gallery", "text": "A page for each capability, live, with its code.", "content": f"<ul>{items}</ul>", "links": ""}
    start, _, end = template.partition("<h2>The code</h2>")
    (folder / "index.html").write_text(fill(start + end.partition("</pre>\n")[2], shared | index), encoding="utf-8")


def copy_modules(folder):
    shutil.copytree(WEB / "dist", folder / "bendy", ignore=shutil.ignore_patterns("*.d.ts", "ts5.6", "bundle", "page.html", "react.js"))
    shutil.copy(ROOT / "LICENSE", folder / "bendy")
    (folder / "bendy/NOTICES.txt").write_text(notices.notices("npm"), encoding="utf-8")
    for name in THREE_FILES:
        (folder / "three" / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(THREE / name, folder / "three" / name)


def convert_characters(folder):
    program = os.environ.get("BENDY_PROGRAM", ROOT / "build/release/cli/bendy")
    for name, options in CHARACTERS.items():
        source = ROOT / f"examples/{name}.glb"
        subprocess.run([program, "convert", "--quiet", *options, source, "-o", folder / f"{name}.bendy"], check=True, stderr=subprocess.DEVNULL)
        shutil.copy(source, folder)


def is_package_built():
    return (WEB / "dist/viewer/index.js").exists()


def make(folder):
    """Fills an empty folder."""
    write_pages(folder)
    shutil.copy(SOURCES / "stage.js", folder)
    copy_modules(folder)
    convert_characters(folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / "build/gallery", metavar="FOLDER",
                        help="a new folder, or one that this script has made: build/gallery if not named")
    folder = parser.parse_args().folder
    with made_anew(folder, "scripts/make_gallery.py") as fresh:
        if not is_package_built():
            sys.exit("bindings/web/dist is not complete: scripts/web.sh makes it")
        make(fresh)
    print(folder.resolve() / "index.html")
    return 0


if __name__ == "__main__":
    sys.exit(main())
