#!/usr/bin/env python3
"""Compares compact files with gltfpack's at the same measured error: compact_at_equal_error.py BENDY GLTFPACK FILE... [--max-error 0.02%]

For each file, the bits of gltfpack's positions and clips are chosen so that `gltfpack -cz` is smallest while `bendy diff`
measures no more than the bound, as for the compact file. Both leave out what no material uses (`--drop-unused`; gltfpack's
default). Bytes without images, as a Markdown table. Needs only Python 3.
"""

import argparse
import functools
import json
import math
import pathlib
import statistics
import struct
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from compact_files import bendy_bytes, gltf_bytes  # noqa: E402

MOST_BITS = {"-vp": 16, "-ar": 16, "-at": 24, "-as": 24}
FEWEST_BITS = {"-vp": 8, "-ar": 6, "-at": 8, "-as": 8}
RATES = ("0", "30")  # -af: the source's keys, or gltfpack's default


def read_glb(path):
    data = path.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + size]), data[20 + size:]


def skinned(gltf):
    return [node for node in gltf["nodes"] if "skin" in node and "mesh" in node]


def give_back_meshes(packed, source):
    """gltfpack puts each mesh on a new node without a name, which holds its scale. A skin makes no use of it: moves the meshes to
    the nodes that have them in the source, so that both skeletons are the same. Nothing for characters with rigid meshes."""
    gltf, rest = read_glb(packed)
    homes, guests = skinned(read_glb(source)[0]), skinned(gltf)
    by_name = {node["name"]: node for node in gltf["nodes"] if "name" in node}
    if len(homes) != len(guests) or any("mesh" in node and "skin" not in node for node in gltf["nodes"]):
        return None
    gone = {number for number, node in enumerate(gltf["nodes"]) if any(node is guest for guest in guests)}
    for home, guest in zip(homes, guests):
        if home.get("name") not in by_name:
            return None
        by_name[home["name"]].update(mesh=guest.pop("mesh"), skin=guest.pop("skin"))
    for parent in (*gltf["scenes"], *gltf["nodes"]):
        for key in ("nodes", "children"):
            if key in parent:
                parent[key] = [child for child in parent[key] if child not in gone]
                if not parent[key]:
                    del parent[key]
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    out = packed.with_name("same_skeleton.glb")
    out.write_bytes(struct.pack("<III", 0x46546C67, 2, 20 + len(text) + len(rest)) + struct.pack("<II", len(text), 0x4E4F534A) + text + rest)
    return out


class Packer:
    def __init__(self, bendy, gltfpack, source, folder):
        self.bendy, self.gltfpack, self.source, self.folder = bendy, gltfpack, source, folder

    def run(self, *command):
        return subprocess.run([str(word) for word in command], capture_output=True, text=True)

    def pack(self, settings, *options):
        out = self.folder / "packed.glb"
        words = [word for name, value in settings for word in (name, value)]
        done = self.run(*self.gltfpack.split(), "-i", self.source, "-o", out, "-cz", *words, *options)
        if done.returncode != 0:
            sys.exit(done.stdout + done.stderr)
        return out

    def differ(self, other):
        done = self.run(self.bendy, "diff", self.source, other, "--tolerance", "1%", "--json")
        if done.returncode == 2:
            sys.exit(done.stderr)
        report = json.loads(done.stdout)
        return math.inf if report["worst"] is None else report["worst"], report["tolerance"] / 0.01

    @functools.lru_cache(maxsize=None)
    def error(self, settings):
        """metres, infinite if unknown; the joints keep their names, by which they are matched"""
        packed = give_back_meshes(self.pack(settings, "-kn"), self.source)
        return math.inf if packed is None else self.differ(packed)[0]

    @functools.lru_cache(maxsize=None)
    def size(self, settings):
        return gltf_bytes(self.pack(settings))[0]

    def fewest(self, settings, name, bound):
        """The fewest bits of one setting that keep the bound, all else as it is; the error is taken to be monotonic."""
        low, high = FEWEST_BITS[name], settings[name]
        while low < high:
            middle = (low + high) // 2
            if self.error(as_key({**settings, name: middle})) <= bound:
                high = middle
            else:
                low = middle + 1
        return {**settings, name: high}

    def smallest(self, bound, has_clips):
        """The settings of the smallest file within the bound; None if there are none."""
        best = None
        for rate in RATES if has_clips else RATES[:1]:
            finest = {**MOST_BITS, "-af": rate}
            if self.error(as_key(finest)) > bound:
                continue
            least = self.fewest(finest, "-vp", bound)["-vp"]
            for positions in range(least, min(least + 3, MOST_BITS["-vp"] + 1) if has_clips else least + 1):
                settings = {**finest, "-vp": positions}
                for name in ("-ar", "-at", "-as") if has_clips else ():
                    settings = self.fewest(settings, name, bound)
                if self.error(as_key(settings)) <= bound and (best is None or self.size(as_key(settings)) < self.size(as_key(best))):
                    best = settings
        return best


def as_key(settings):
    return tuple(sorted((name, str(value)) for name, value in settings.items()))


def row(arguments, source, folder):
    packer = Packer(arguments.bendy, arguments.gltfpack, source, folder)
    compact = folder / "compact.bendy"
    done = packer.run(arguments.bendy, "convert", source, "-q", "-o", compact, "--drop-unused", "--max-error", arguments.max_error, "--force")
    if done.returncode != 0:
        sys.exit(done.stderr)
    size, clips = bendy_bytes(compact)
    error, height = packer.differ(compact)
    bound = float(arguments.max_error.rstrip("%")) / 100 * height
    settings = packer.smallest(bound, clips != 0)
    cells = [source.stem, size, "%.3g" % (error * 1e3)]
    if settings is None:
        return [*cells, "", "%.3g" % (packer.error(as_key({**MOST_BITS, "-af": "0"})) * 1e3), "cannot", ""], None
    packed = packer.size(as_key(settings))
    names = " ".join(f"{name} {settings[name]}" for name in (("-vp", "-ar", "-at", "-as", "-af") if clips else ("-vp",)))
    return [*cells, packed, "%.3g" % (packer.error(as_key(settings)) * 1e3), names, "%.2f" % (size / packed)], size / packed


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bendy", type=pathlib.Path)
    parser.add_argument("gltfpack")
    parser.add_argument("files", type=pathlib.Path, nargs="+")
    parser.add_argument("--max-error", default="0.02%", help="a share of the height")
    arguments = parser.parse_args()
    print("| file | compact | measured, mm | gltfpack -cz | measured, mm | its options | compact / -cz |")
    print("|---|---|---|---|---|---|---|")
    ratios = []
    for source in arguments.files:
        with tempfile.TemporaryDirectory() as folder:
            cells, ratio = row(arguments, source, pathlib.Path(folder))
        ratios += [ratio] if ratio else []
        print("| " + " | ".join(f"{cell:,}" if isinstance(cell, int) else str(cell) for cell in cells) + " |", flush=True)
    if ratios:
        print(f"median {statistics.median(ratios):.2f} of {len(ratios)}")


if __name__ == "__main__":
    main()
