"""What the tests share: the examples as bendy files, the program, and a broken file."""

import json
import os
import struct
import subprocess
import sys
from pathlib import Path

import bendy
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))  # for gltf_file


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("characters")


@pytest.fixture(scope="session")
def mannequin(folder):
    """The example character, converted exactly: a path."""
    return bendy.convert(ROOT / "examples/mannequin.glb", folder / "mannequin.bendy").output


@pytest.fixture(scope="session")
def compact(folder):
    """The same, compact: a Conversion."""
    return bendy.convert(ROOT / "examples/mannequin.glb", folder / "compact.bendy", compact=True)


@pytest.fixture
def model(mannequin):
    return bendy.open(mannequin)


@pytest.fixture(scope="session")
def program():
    """Runs the program bendy, which must succeed; returns what it prints."""
    path = os.environ["BENDY_PROGRAM"]

    def run(*arguments, status=0):
        result = subprocess.run([path, *map(str, arguments)], capture_output=True, text=True)
        assert result.returncode == status, result.stderr
        return result.stdout

    return run


@pytest.fixture(scope="session")
def posed(program):
    """What `bendy pose` makes of a file, as JSON."""
    return lambda *arguments: json.loads(program("pose", *arguments, "--format", "json"))


def write_quake_model(path, frames):
    """Writes a model of one triangle, whose frames differ, and returns its path."""
    pieces = [struct.pack("<6h", 0, 0, 8, 0, 0, 8), struct.pack("<6H", 0, 1, 2, 0, 1, 2), b"", bytes(4)]
    for number, name in enumerate(frames):
        corners = b"".join(struct.pack("<4B", *corner, 5) for corner in ((number, 0, 0), (0, 8, 0), (0, 0, 8)))
        pieces[2] += struct.pack("<6f16s", 1, 1, 1, 0, 0, 0, name.encode()) + corners
    places = [68, 68]
    for piece in pieces:
        places.append(places[-1] + len(piece))
    path.write_bytes(struct.pack("<4s16i", b"IDP2", 8, 8, 8, 52, 0, 3, 3, 1, 1, len(frames), *places) + b"".join(pieces))
    return path


@pytest.fixture
def damaged(mannequin, tmp_path):
    """Makes a copy with some bytes replaced: a path."""
    def make(offset, replacement):
        data = bytearray(mannequin.read_bytes())
        data[offset:offset + len(replacement)] = replacement
        path = tmp_path / "damaged.bendy"
        path.write_bytes(data)
        return path

    return make
