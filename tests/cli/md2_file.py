"""Makes Quake II models: a square of two triangles."""

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
