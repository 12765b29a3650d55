"""Where a file must repeat the version of CMakeLists.txt, because another program reads it there."""

import re

from project import ROOT, VERSION

# Each pattern is found once; its groups are the numbers of the version.
PLACES = {
    "bindings/blender/bendy_rig/__init__.py": r"'version': \((\d+), (\d+), (\d+)\)",
    "bindings/blender/bendy_rig/blender_manifest.toml": r'^version = "(\d+)\.(\d+)\.(\d+)"',
    "bindings/web/package.json": r'^  "version": "(\d+)\.(\d+)\.(\d+)"',
    "packaging/conan/conanfile.py": r'^    version = "(\d+)\.(\d+)\.(\d+)"',
    "packaging/vcpkg/vcpkg.json": r'^  "version": "(\d+)\.(\d+)\.(\d+)"',
    "tools/cli/windows/bendy.manifest": r'name="Bendy" version="(\d+)\.(\d+)\.(\d+)\.0"',
}


def check_versions():
    for name, pattern in PLACES.items():
        found = re.findall(pattern, (ROOT / name).read_text(encoding="utf-8"), re.M)
        if [".".join(numbers) for numbers in found] != [VERSION]:
            raise SystemExit(f"{name} does not have the version of CMakeLists.txt, {VERSION}")
