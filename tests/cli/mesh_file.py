"""Readers of the mesh files that `bendy pose` writes."""

import struct


def floats(data):
    return list(struct.unpack(f"<{len(data) // 4}f", data))


def as_float(text):
    """A decimal number as the float that it means."""
    return struct.unpack("<f", struct.pack("<f", float(text)))[0]


def read_obj(text):
    """Positions, normals, faces, lines and points, each a list of tuples; indices count from 0."""
    found = {"o": [], "v": [], "vn": [], "f": [], "l": [], "p": []}
    for line in text.splitlines():
        keyword, _, rest = line.partition(" ")
        if keyword in ("v", "vn"):
            found[keyword].append(tuple(as_float(number) for number in rest.split()))
        elif keyword in ("f", "l", "p"):
            corners = [corner.split("//") for corner in rest.split()]
            assert all(corner[0] == corner[-1] for corner in corners), line
            found[keyword].append(tuple(int(corner[0]) - 1 for corner in corners))
        elif keyword == "o":
            found["o"].append(rest)
        else:
            assert keyword == "#", line
    return found


def read_ply(data):
    """Positions, normals and faces of a binary PLY."""
    head, _, body = data.partition(b"end_header\n")
    lines = head.decode("ascii").splitlines()
    assert lines[0] == "ply" and lines[1] == "format binary_little_endian 1.0", lines[:2]
    elements = {}
    for line in lines[2:]:
        words = line.split()
        if words[0] == "element":
            elements[words[1]] = (int(words[2]), [])
            last = words[1]
        elif words[0] == "property":
            elements[last][1].append(tuple(words[1:]))
    at = 0
    result = {}
    for name, (count, properties) in elements.items():
        rows = []
        for _ in range(count):
            row = []
            for kind, *rest in properties:
                if kind == "list":
                    length = body[at]
                    row += struct.unpack_from(f"<{length}I", body, at + 1)
                    at += 1 + 4 * length
                else:
                    row += struct.unpack_from("<f" if kind == "float" else "<I", body, at)
                    at += 4
            rows.append(tuple(row))
        result[name] = rows
    assert at == len(body), "bytes are left over"
    return result
