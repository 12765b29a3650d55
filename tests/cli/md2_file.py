"""Makes Quake II models, and says from their bytes alone where their corners are."""

import struct


def md2_file(path, names=("stand01", "stand02", "run1", "run2"), skins=("models/man.pcx",)):
    """Each frame one unit further up than the one before."""
    coords = b"".join(struct.pack("<hh", s, t) for s, t in ((0, 32), (32, 32), (32, 0), (0, 0)))
    triangles = b"".join(struct.pack("<6H", *corners, *corners) for corners in ((0, 1, 2), (0, 2, 3)))
    corners = b"".join(struct.pack("<4B", *corner, 5) for corner in ((0, 8, 0), (0, 0, 0), (0, 0, 8), (0, 8, 8)))
    frames = b"".join(struct.pack("<6f16s", 0.5, 0.25, 0.25, 1, -1, number, name.encode()) + corners
                      for number, name in enumerate(names))
    pieces = [b"".join(struct.pack("64s", skin.encode()) for skin in skins), coords, triangles, frames, struct.pack("<i", 0)]
    places = [68]
    for piece in pieces:
        places.append(places[-1] + len(piece))
    head = struct.pack("<4s16i", b"IDP2", 8, 64, 32, 40 + 4 * 4, len(skins), 4, 4, 2, 1, len(names), *places)
    path.write_bytes(head + b"".join(pieces))
    return path


# What Quake II's players have: letters and number of frames of each clip.
PLAYER = (("stand", 40), ("run", 6), ("attack", 8), ("pain", 12), ("jump", 6), ("flip", 12), ("salute", 11), ("taunt", 17),
          ("wave", 11), ("point", 12), ("crstnd", 19), ("crwalk", 6), ("crattak", 9), ("crpain", 4), ("crdeath", 5), ("death", 20))


def player_names():
    return [f"{letters}{number}" for letters, count in PLAYER for number in range(1, count + 1)]


def tube_md2(path, names, sides=6, rings=8):
    """A closed tube with a seam in its texture, of bytes that differ in every frame."""
    state = 7

    def random(below):
        nonlocal state
        state = (state * 1103515245 + 12345) % 2**31
        return state // 65536 % below
    coords = [(side * 10, ring * 9) for ring in range(rings) for side in range(sides + 1)]
    triangles = []
    for ring in range(rings - 1):
        for side in range(sides):
            def corner(r, s):
                return r * sides + s % sides, r * (sides + 1) + s
            a, b, c, d = corner(ring, side), corner(ring, side + 1), corner(ring + 1, side), corner(ring + 1, side + 1)
            triangles += [(a, b, c), (b, d, c)]
    frames = []
    for number, name in enumerate(names):
        scale = [0.05 + random(1000) / 3000 for _ in range(3)]
        origin = [-20 + random(1000) / 70 for _ in range(3)]
        vertices = bytes(value for _ in range(sides * rings) for value in (random(256), random(256), random(256), random(162)))
        frames.append(struct.pack("<6f16s", *scale, *origin, name.encode()) + vertices)
    pieces = [b"", b"".join(struct.pack("<hh", *coord) for coord in coords),
              b"".join(struct.pack("<6H", *(v for v, _ in t), *(c for _, c in t)) for t in triangles), b"".join(frames), bytes(4)]
    places = [68]
    for piece in pieces:
        places.append(places[-1] + len(piece))
    counts = (0, sides * rings, len(coords), len(triangles), 1, len(names))
    path.write_bytes(struct.pack("<4s16i", b"IDP2", 8, 64, 80, 40 + 4 * sides * rings, *counts, *places) + b"".join(pieces))
    return path


class Md2:
    """A model's frames, read from its bytes: Quake's units and axes."""

    def __init__(self, path):
        data = path.read_bytes()
        (_, _, _, _, size, _, vertices, _, triangles, _, frames, _, _, triangles_at, frames_at, _, _) = struct.unpack_from("<17i", data)
        self.triangles = [struct.unpack_from("<3H", data, triangles_at + 12 * t) for t in range(triangles)]
        self.names, self.places = [], []
        for frame in range(frames):
            at = frames_at + size * frame
            numbers = struct.unpack_from("<6f", data, at)
            self.names.append(data[at + 24:at + 40].split(b"\0")[0].decode())
            self.places.append([[numbers[axis] * data[at + 40 + 4 * v + axis] + numbers[3 + axis] for axis in range(3)]
                                for v in range(vertices)])

    def corners(self, frame, after=None, fraction=0.0):
        """The corners of all triangles between two frames, as bendy has them: metres, Y up, front +Z, turned round."""
        def place(vertex):
            a, b = self.places[frame][vertex], self.places[frame if after is None else after][vertex]
            x, y, z = (p + (q - p) * fraction for p, q in zip(a, b))
            return y / 32, z / 32, x / 32
        return [place(triangle[k]) for triangle in self.triangles for k in (0, 2, 1)]
