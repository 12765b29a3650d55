#!/usr/bin/env python3
"""Makes one site of the documentation.

The pages stay where they are in the tree; what docs/mkdocs.yml lists, and all that is linked from there, is gathered in
FOLDER/pages, and mkdocs makes FOLDER/site of it. A link that leads nowhere is a fault. If scripts/web.sh has built the npm package,
the site also has the page that converts and shows characters, page.html, and the gallery, gallery/index.html.
"""

import argparse
import re
import shutil
import subprocess
import sys
from pathlib import Path

import make_gallery
from own_folder import made_anew

ROOT = Path(__file__).resolve().parent.parent
LINK = re.compile(r"(\]\()([^)\s]+)(\))")
# The first pages in the format's part of the menu; the other pages of spec/ and all chunks follow.
SPEC_FIRST = ["README", "quick", "grammar", "tree", "streams", "codecs", "constraints", "rig", "text"]


def title_of(page):
    for line in page.read_text(encoding="utf-8").splitlines():
        if line.startswith("# "):
            return line[2:].strip()
    return page.stem


def listed(indent, pages):
    return "".join(f'{indent}- "{title_of(page)}": {page.relative_to(ROOT)}\n' for page in pages)


def menu(text):
    """mkdocs.yml with the pages of spec/ and the decisions, which it names only by SPEC and DECISIONS."""
    first = [ROOT / f"spec/{name}.md" for name in SPEC_FIRST]
    spec = first + sorted(page for page in (ROOT / "spec").glob("*.md") if page not in first)
    chunks = sorted((ROOT / "spec/chunks").glob("*.md"))
    text = text.replace("  - Format: SPEC\n", "  - Format:\n" + listed(" " * 6, spec) + " " * 6 + "- Chunks:\n" + listed(" " * 10, chunks))
    decisions = sorted((ROOT / "docs/decisions").glob("*.md"))
    return text.replace("      - Decisions: DECISIONS\n", "      - Decisions:\n" + listed(" " * 10, decisions))


def index_of(folder):
    """A page for a folder that is linked and has none."""
    lines = [f"# {folder.relative_to(ROOT)}", ""]
    for entry in sorted(folder.iterdir()):
        if entry.is_file():
            lines.append(f"- [{title_of(entry) if entry.suffix == '.md' else entry.name}]({entry.name})")
    return "\n".join(lines) + "\n"


def gather(first, pages):
    """Copies the pages, and all that they link to, to `pages`; returns the faults."""
    faults, seen, waiting = [], set(), list(first)

    def wanted(path):
        if path not in seen:
            seen.add(path)
            waiting.append(path)

    seen.update(waiting)
    while waiting:
        path = waiting.pop()
        place = pages / path.relative_to(ROOT)
        place.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix != ".md":
            shutil.copy(path, place)
            continue

        def follow(link, path=path):
            target, _, anchor = link[2].partition("#")
            if not target or re.match(r"[a-z]+:", target):
                return link[0]
            found = (path.parent / target).resolve()
            if not found.exists() or ROOT not in found.parents:
                faults.append(f"{path.relative_to(ROOT)}: {link[2]} leads nowhere")
                return link[0]
            if found.is_dir():
                target = target.rstrip("/") + "/README.md"
                found /= "README.md"
            wanted(found)
            return link[1] + target + (f"#{anchor}" if anchor else "") + link[3]

        text = path.read_text(encoding="utf-8") if path.exists() else index_of(path.parent)
        if path.exists():
            text = LINK.sub(follow, text)
        else:
            for entry in path.parent.iterdir():
                if entry.is_file():
                    wanted(entry)
        place.write_text(text, encoding="utf-8")
    return faults


def make(folder):
    """Fills an empty folder."""
    pages = folder / "pages"
    pages.mkdir()
    settings = menu((ROOT / "docs/mkdocs.yml").read_text(encoding="utf-8"))
    (folder / "mkdocs.yml").write_text(settings, encoding="utf-8")
    listed_pages = [ROOT / name for name in re.findall(r"^\s+- .*: (\S+\.md)$", settings, re.MULTILINE)]
    faults = [f"docs/mkdocs.yml: {page.relative_to(ROOT)} is not there" for page in listed_pages if not page.exists()]
    faults += gather([page for page in listed_pages if page.exists()], pages)
    if faults:
        sys.exit("\n".join(faults))
    done = subprocess.run(["mkdocs", "build", "--strict", "--quiet", "-f", str(folder / "mkdocs.yml")], check=False)
    if done.returncode != 0:
        sys.exit(done.returncode)
    page = ROOT / "bindings/web/dist/page.html"
    if page.exists():
        shutil.copy(page, folder / "site")
    if make_gallery.is_package_built():
        (folder / "site/gallery").mkdir()
        make_gallery.make(folder / "site/gallery")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / "build/site", metavar="FOLDER",
                        help="a new folder, or one that this script has made: build/site if not named")
    folder = parser.parse_args().folder
    with made_anew(folder, "scripts/make_site.py") as fresh:
        make(fresh)
    print(f"{folder.resolve()}/site/index.html")
    return 0


if __name__ == "__main__":
    sys.exit(main())
