#!/usr/bin/env python3
"""Reads an exact Bendy file as spec/quick.md describes it, and prints its first object, as that page says.

    quick_reader.py FILE [CLIP [TIME ...]]

CLIP is the number of a clip, TIME is in seconds; without them, the pose is the rest pose. A file that is damaged or holds
what the page leaves out gives one line of error and exit status 1. It needs Python 3 and its standard library only.
"""

import bisect
import math
import struct
import sys

KNOWN = ("HEAD VERS BNDS TEXT SAMP IMAG LINK SAME MATE SURF EXTN OBJE NAME EXTR MORE SKIN PIVO REST LIMT PULL POLY JNTS JNAM ROLE "
         "STND IKCH KINF VECT VINF PALT TARG TINF FRMS FNAM GRID NLST POSI NORM TANG TEXC COLR BONE WGHT USER VALS INDX LODD CYCL CINF "
         "TRAK PACK PLAY TIME KEYV MARK CURV").split()
CODECS = {1: "1 (zstd)", 2: "2 (vertices)", 3: "3 (vertices, zstd)", 4: "4 (indices)", 5: "5 (indices, zstd)", 6: "6 (clip)", 7: "7 (sums)"}
NONE, IDENTITY = 0xFFFFFFFF, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
TABLE = list(range(256))
for _ in range(8):
    TABLE = [crc >> 1 ^ (0x82F63B78 if crc & 1 else 0) for crc in TABLE]


def need(condition, message, *values):
    if not condition:
        sys.exit("quick_reader: " + message % values)


def crc32c(data, crc=0xFFFFFFFF):
    for byte in data:
        crc = crc >> 8 ^ TABLE[(crc ^ byte) & 255]
    return crc


class Chunk:
    """One chunk; `children` are those that the format knows, in the order of the file."""

    def __init__(self, file, at, parent):
        self.file, self.at, self.children = file, at, []
        self.id = file[at : at + 4].decode("latin-1")
        self.sum, packed = struct.unpack_from("<IQ", file, at + 4)
        self.size, flags = packed & 0xFFFFFFFFFFFF, packed >> 48
        self.end, self.container, codec = at + 16 + self.size, flags & 1, flags >> 8
        self.known = (parent is None or parent.known) and self.id in KNOWN
        need(all("A" <= c <= "Z" or "0" <= c <= "9" for c in self.id), "the id at %d is not letters and digits", at)
        need(not flags & 0x00FC and (not self.container or codec == self.size % 16 == 0), "%s has a wrong size or flags", self)
        need(self.known or not flags & 2 or not (parent and parent.known), "%s is required and unknown", self)
        need(not self.known or codec == 0, "%s has codec %s: this reader reads raw payloads only", self, CODECS.get(codec, codec))
        need(not self.known or self.id not in "JNTS JNAM FRMS PACK PLAY", "%s: this reader does not read %s", self, self.id)
        self.crc = crc32c(file[at : at + 4] + file[at + 8 : at + 16])

    def __str__(self):
        return "%s at %d" % (self.id, self.at)

    def all(self, name):
        return [child for child in self.children if child.id == name]

    def one(self, name):
        need(self.all(name), "%s has no %s", self, name)
        return self.all(name)[0]

    def name(self):
        return "".join(self.file[leaf.at + 16 : leaf.end].decode("utf-8", "replace") for leaf in self.all("NAME")[:1])

    def numbers(self, form, at=0):
        need(at + struct.calcsize("<" + form) <= self.size, "%s is too short", self)
        values = struct.unpack_from("<" + form, self.file, self.at + 16 + at)
        need(all(map(math.isfinite, values)), "%s: a number is not finite", self)
        return values

    def indices(self, below, default=()):
        values = read_stream(self.one("INDX"), 1, None, "HI")[0] if self.all("INDX") else default
        need(all(value < below for value in values), "%s: INDX refers to no vertex", self)
        return values


def print_line(*words):
    words = ["".join(c if c >= " " else "?" for c in word) if isinstance(word, str) else "%.9g" % word for word in words if word != ""]
    need(not {"inf", "-inf", "nan"}.intersection(words[1:17]), "a result is not finite")
    print(*words)


def read_tree(file):
    need(len(file) >= 16 and file[:4] == b"HEAD", "this is not a Bendy file")
    head = Chunk(file, 0, None)
    need(head.container and head.end == len(file), "HEAD is a leaf, the file is truncated, or other bytes follow HEAD")
    inside, at = [head], 16
    while inside:
        parent = inside[-1]
        if at == parent.end:
            need(parent.crc ^ NONE == parent.sum and len(inside) <= 65536, "the sum or the depth of %s is wrong", inside.pop())
            continue
        need(parent.end - at >= 16, "%s ends within a header", parent)
        chunk = Chunk(file, at, parent)
        need(chunk.end <= parent.end, "%s is longer than its container", chunk)
        parent.crc = crc32c(file[at + 4 : at + 8], parent.crc)
        parent.children += [chunk] if chunk.known else []
        at = at + 16 if chunk.container else chunk.end + -chunk.size % 16
        inside += [chunk] if chunk.container else []
        good = chunk.container or crc32c(file[chunk.at + 16 : chunk.end], chunk.crc) ^ NONE == chunk.sum
        need(good and (chunk.container or not any(file[chunk.end : at])), "the sum or the padding of %s is wrong", chunk)
    return head


def read_stream(chunk, components, elements, types):
    """The numbers of a stream and how many an element has; None stands for any number of components or elements."""
    kind, form, width, rows, _, reserved = chunk.numbers("BBHIII")
    need(form not in (2, 3), "%s: this reader does not read boxed and listed streams", chunk)
    need(kind < 6 and form <= ("n" in types) and reserved == 0 and "BbHhIf"[kind] in types, "%s has the wrong type", chunk)
    need(components in (None, width) and elements in (None, rows), "%s does not fit", chunk)
    values = chunk.numbers("%d%s" % (rows * width, "BbHhIf"[kind]), 16)
    need(width and chunk.size == 16 + rows * width * (1, 1, 2, 2, 4, 4)[kind], "%s has the wrong size", chunk)
    return [value / (255 if kind == 0 else 65535) for value in values] if form and kind != 5 else values, width


def read_joints(thing, meshes):
    joints, left = [], [len(mesh["indices"]) for mesh in meshes]
    waiting = [(chunk, None) for chunk in reversed(thing.all("SKIN"))]
    while waiting:
        chunk, parent = waiting.pop()
        rest = chunk.one("PIVO").one("REST")
        values = rest.numbers("10f" if rest.size == 40 else "13f") + (0.0, 0.0, 0.0)
        for poly in chunk.all("POLY"):  # which says that this joint moves the vertices of a rigid mesh
            mesh, _, first, count, topology = poly.numbers("IIIII")  # and three reserved bytes
            need(mesh < len(meshes) and topology < 3, "%s has no mesh", poly)
            left[mesh] -= count  # submeshes do not overlap
            need(first + count <= len(meshes[mesh]["indices"]) and left[mesh] >= 0, "%s is not within INDX", poly)
            for index in meshes[mesh]["indices"][first : first + count]:
                meshes[mesh]["owners"][index] = len(joints)
        waiting += [(child, len(joints)) for child in reversed(chunk.all("SKIN"))]
        joints.append((parent, values[:13]))
        print_line("joint", -1 if parent is None else parent, *values[:13], chunk.name())
    for mesh in meshes:
        need(all(joint < len(joints) for joint in (mesh["carrier"], *mesh["palette"])), "a mesh refers to a joint that does not exist")
    return joints


def read_mesh(chunk):
    vertices, carrier = chunk.one("VINF").numbers("II")
    mesh = {"name": chunk.name(), "carrier": -1 if carrier == NONE else carrier, "targets": [], "palette": ()}
    mesh["positions"] = read_stream(chunk.one("POSI"), 3, vertices, "f")[0] if vertices else ()
    mesh.update(owners=[mesh["carrier"]] * vertices, indices=chunk.indices(vertices))
    mesh.update(bones=mesh["owners"], weights=[1] * vertices, influences=1)  # as in a rigid mesh: the palette is all joints
    for target in chunk.all("TARG"):
        touched = target.indices(vertices, range(vertices))
        moved = read_stream(target.one("POSI"), 3, len(touched), "f")[0] if target.all("POSI") else ()
        mesh["targets"].append((target.one("TINF").numbers("f")[0], touched, moved))
    if chunk.all("BONE") + chunk.all("WGHT") + chunk.all("PALT"):
        palette = chunk.one("PALT")
        entries, derived, *reserved = palette.numbers("IIII")
        need(not derived, "%s: this reader does not read derived palettes", palette)
        start = 16 + (4 * entries + 15) // 16 * 16
        mesh["palette"], mesh["matrices"] = palette.numbers("%dI" % entries, 16), palette.numbers("%df" % (16 * entries), start)
        reserved += palette.numbers("%dB" % (start - 16 - 4 * entries), 16 + 4 * entries)
        need(palette.size == start + 64 * entries and not any(reserved), "%s has the wrong size", palette)
        mesh["bones"], mesh["influences"] = read_stream(chunk.one("BONE"), None, vertices, "BH")
        mesh["weights"], _ = read_stream(chunk.one("WGHT"), mesh["influences"], vertices, "BHfn")
        need(all(bone < entries for bone in mesh["bones"]), "%s: BONE refers to no entry of PALT", chunk)
    return mesh


def read_clip(chunk, joints, meshes):
    start, end, rate, *reserved = chunk.one("CINF").numbers("fffI")
    print_line("clip", start, end, rate, chunk.name())
    clocked, values = ([n for leaf in chunk.all(name)[:1] for n in leaf.numbers("%df" % (leaf.size // 4))] for name in ("TIME", "KEYV"))
    frames, tracks = [start + k / rate for k in range(len(values))] if rate > 0 else [], []  # frames: times of fixed frames
    for table in chunk.all("TRAK")[:1]:
        need(table.size % 24 == 0 and reserved < [2], "%s is cut, or CINF has a reserved field", table)
        for at in range(0, table.size, 24):
            target, path, mode, width, keys, time, value = table.numbers("IBBHIIQ", at)
            need(path < 4 and mode < 3 and target < len(meshes if path == 3 else joints), "%s animates nothing", table)
            need(width == (3, 4, 3, 0)[path] or path == 3 and width == len(meshes[target]["targets"]), "%s does not fit", table)
            step = 3 * width if mode == 2 else width
            clock, time = (frames, 0) if time == NONE else (clocked, time)
            need(0 < keys <= len(clock) - time and 0 < keys * step <= len(values) - value, "%s: keys beyond TIME or KEYV", table)
            tracks.append((target, path, mode, clock, time, keys, values, value, step))
    return tracks


def sample(path, mode, clock, time, keys, values, value, step, t):
    low = max(bisect.bisect_right(clock, t, time, time + keys) - 1, time)
    after = min(low + 1, time + keys - 1)
    a, b = (values[value + (k - time) * step : value + (k - time + 1) * step] for k in (low, after))
    d, n = clock[after] - clock[low], step // 3
    u = min(max((t - clock[low]) / d, 0.0), 1.0) if d > 0 else 0.0
    if mode == 2:
        leave, arrive, q = d * (u**3 - 2 * u**2 + u), d * (u**3 - u**2), 3 * u**2 - 2 * u**3
        a = [(1 - q) * a[n + k] + leave * a[2 * n + k] + q * b[n + k] + arrive * b[k] for k in range(n)]
    elif mode == 1:
        c = sum(x * y for x, y in zip(a, b)) if path == 1 else 1.0
        h = math.acos(min(abs(c), 1.0))
        p, q = (math.sin((1 - u) * h) / math.sin(h), math.sin(u * h) / math.sin(h)) if h > 1e-4 else (1 - u, u)
        a = [p * x + (-q if c < 0 else q) * y for x, y in zip(a, b)]
    length = math.sqrt(sum(x * x for x in a)) if path == 1 else 1.0
    return [x / (length or 1.0) for x in a]


def times(a, b):
    return [sum(a[4 * k + row] * b[column + k] for k in range(4)) for column in (0, 4, 8, 12) for row in range(4)]


def local(translation, rotation, s, h):
    x, y, z, w = rotation
    turn = [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0, 2 * (x * y - z * w), 1 - 2 * (x * x + z * z),
            2 * (y * z + x * w), 0, 2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0, *translation, 1]
    return times(turn, [s[0], 0, 0, 0, h[0], s[1], 0, 0, h[1], h[2], s[2], 0, 0, 0, 0, 1])


def skin(mesh, weights, world):
    positions, n = list(mesh["positions"]), mesh["influences"]
    for weight, (_, touched, moved) in zip(weights, mesh["targets"]):
        for k in range(len(moved) if weight else 0):
            positions[3 * touched[k // 3] + k % 3] += weight * moved[k]
    palette = [times(world[joint], mesh["matrices"][16 * k : 16 * k + 16]) for k, joint in enumerate(mesh["palette"])] or [*world, IDENTITY]
    for v in range(len(mesh["owners"])):
        x, y, z = positions[3 * v : 3 * v + 3]
        parts = [(w, palette[b]) for w, b in zip(mesh["weights"][n * v : n * v + n], mesh["bones"][n * v : n * v + n]) if w]
        print_line("vertex", *[sum(w * (m[row] * x + m[row + 4] * y + m[row + 8] * z + m[row + 12]) for w, m in parts) for row in range(3)])


def pose(joints, meshes, tracks, t):
    print_line("pose", t)
    now, world = {(target, path): sample(path, *track, t) for target, path, *track in tracks}, []
    for k, (parent, rest) in enumerate(joints):
        parts = [now.get((k, path), part) for path, part in enumerate((rest[4:7], rest[:4], rest[7:10]))]
        world.append(local(*parts, rest[10:]) if parent is None else times(world[parent], local(*parts, rest[10:])))
        print_line("world", *world[-1])
    for k, mesh in enumerate(meshes):
        print_line("mesh", mesh["name"])
        skin(mesh, now.get((k, 3), [w for w, _, _ in mesh["targets"]]), world)


def main(file, clip=None, *at):
    with open(file, "rb") as opened:
        head = read_tree(opened.read())
    need(head.one("VERS").numbers("10B34xI") == (*b"BENDY\r\n\x1a\0\0", 0), "the file has another signature or version")
    thing = (head.all("OBJE") or [head])[0]  # a file may have no object
    for chunk in head.all("MATE"):
        print_line("material", *chunk.one("SURF").numbers("12f"), chunk.name())
    meshes = [read_mesh(chunk) for chunk in thing.all("VECT")]
    joints = read_joints(thing, meshes)
    clips = [read_clip(chunk, joints, meshes) for chunk in thing.all("CYCL")]
    need(clip is None or clip.isdigit() and int(clip) < len(clips), "there is no clip %s", clip)
    for t in at or (0,):
        pose(joints, meshes, clips[int(clip)] if clip else (), float(t))


if __name__ == "__main__":
    main(*sys.argv[1:])
