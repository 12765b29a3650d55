"""Folders that scripts fill. A script removes nothing there but what it has made itself, and says what else it has found."""

import argparse
import contextlib
import hashlib
import itertools
import json
import os
import stat
import sys
import tempfile
from pathlib import Path

BUILD = Path(__file__).resolve().parent.parent / "build"
# In a folder that a script has made: {"made by": the script, "files": {path: SHA-256}}.
MADE = ".made.json"
SHOWN = 3


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def read_made(folder, script):
    """{path: SHA-256} of what the script has made in the folder: nothing, if it was not this script."""
    try:
        made = json.loads((folder / MADE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    files = made.get("files") if isinstance(made, dict) and made.get("made by") == script else None
    return files if isinstance(files, dict) else {}


def not_made(folder, files):
    """What is in the folder and was not made there, or has changed since; links are not followed."""
    for place, folders, names in os.walk(folder, onerror=raise_it):
        links = [name for name in folders if (Path(place) / name).is_symlink()]
        for name in sorted(names + links):
            path = Path(place) / name
            relative = path.relative_to(folder).as_posix()
            if not stat.S_ISREG(path.lstat().st_mode) or (relative != MADE or not files) and files.get(relative) != digest(path):
                yield relative
        if not folders and not names and Path(place) != folder:
            yield Path(place).relative_to(folder).as_posix() + "/"


def raise_it(error):
    raise error


def check(folder, script):
    """Exits if there is anything else than what the script has made."""
    if not folder.is_dir():
        if os.path.lexists(folder):
            sys.exit(f"{script}: {folder} is not a folder")
        return
    found = list(itertools.islice(not_made(folder, read_made(folder, script)), SHOWN + 1))
    if found:
        names = ", ".join(found[:SHOWN]) + (" and more" if len(found) > SHOWN else "")
        sys.exit(f"{script}: {folder} has files that this script has not made, or that have changed since: {names}. "
                 "Name another folder, or move them away")


def remove_made(folder):
    """Removes a folder in which everything was made: check() has said so."""
    for place, _, names in os.walk(folder, topdown=False):
        for name in names:
            (Path(place) / name).unlink()
        Path(place).rmdir()


@contextlib.contextmanager
def made_anew(folder, script):
    """Gives an empty folder to fill. It takes the place of `folder` when all is made; until then, and if that fails, the old one stays.

    script: its name from the project's root, which the folder keeps.
    """
    folder = Path(folder).resolve()
    try:
        check(folder, script)
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=f"{folder.name}.", dir=folder.parent) as name:
            fresh = Path(name) / folder.name
            fresh.mkdir()
            yield fresh
            files = {path.relative_to(fresh).as_posix(): digest(path) for path in sorted(fresh.rglob("*")) if path.is_file()}
            (fresh / MADE).write_text(json.dumps({"made by": script, "files": files}, indent=1) + "\n", encoding="utf-8")
            check(folder, script)
            remove_made(folder)
            fresh.rename(folder)
    except OSError as error:
        sys.exit(f"{script}: {error}")


def work_folder(folder):
    """The type of an argument: a folder for a test that empties it or parts of it. One below a build folder, or an empty one; it is made."""
    folder = Path(folder).resolve()
    is_built = BUILD in folder.parents or any((above / "CMakeCache.txt").exists() for above in folder.parents)
    if folder.exists() and not is_built and (not folder.is_dir() or any(folder.iterdir())):
        raise argparse.ArgumentTypeError(f"{folder} may have files of others: name a new folder, or one below {BUILD}")
    folder.mkdir(parents=True, exist_ok=True)
    return folder
