#!/usr/bin/env python3
"""Adds what Debian's policy asks for to the folders that cpack has gathered: copyright, changelogs, compressed man pages."""

import argparse
import gzip
import os
import shutil
import time
from email.utils import formatdate
from pathlib import Path

PACKAGING = Path(__file__).resolve().parent
PACKAGES = {"program": "bendy", "development": "libbendy-dev", "c_library": "libbendy{major}", "libraries": "libbendy-cpp{major}.{minor}"}
CHANGELOG = """{source} ({version}) unstable; urgency=medium

  * See changelog.gz.

 -- {maintainer}  {date}
"""


def compress(path, data):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(gzip.compress(data, 9, mtime=0))
    path.chmod(0o644)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", required=True, type=Path, help="holds a folder for each component")
    parser.add_argument("--version", required=True, help="with Debian's revision")
    parser.add_argument("--maintainer", required=True)
    arguments = parser.parse_args()

    major, minor = arguments.version.split(".")[:2]
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))
    date = formatdate(seconds)
    for component in arguments.folder.iterdir():
        if not (component / "usr").is_dir():
            continue
        package = PACKAGES[component.name].format(major=major, minor=minor)
        documents = component / "usr/share/doc" / package
        documents.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(PACKAGING / "copyright", documents / "copyright")
        compress(documents / "changelog.gz", (PACKAGING.parent / "CHANGELOG.md").read_bytes())
        entry = CHANGELOG.format(source="bendy", version=arguments.version, maintainer=arguments.maintainer, date=date)
        compress(documents / "changelog.Debian.gz", entry.encode())
        for page in component.glob("usr/share/man/man*/*.[0-9]"):
            compress(Path(f"{page}.gz"), page.read_bytes())
            page.unlink()
        for path in (component, *component.rglob("*")):  # one time for all, so that the same sources give the same package
            os.utime(path, (seconds, seconds), follow_symlinks=False)


if __name__ == "__main__":
    main()
