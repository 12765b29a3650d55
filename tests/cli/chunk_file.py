"""Reads and writes bendy files as the specification has them, without the project's own code: for tests that need a
file with something wrong in it."""

import struct

CONTAINER = 1


def crc32c(data, before=0):
    crc = before ^ 0xFFFFFFFF
    for byte in data:
        crc = _TABLE[(crc ^ byte) & 0xFF] ^ (crc >> 8)
    return crc ^ 0xFFFFFFFF


def _table():
    for byte in range(256):
        for _ in range(8):
            byte = byte >> 1 ^ (0x82F63B78 if byte & 1 else 0)
        yield byte


_TABLE = list(_table())


class Chunk:
    def __init__(self, letters, payload=b"", children=None, flags=0):
        self.letters = letters
        self.payload = payload
        self.children = children  # None: a leaf
        self.flags = flags | (CONTAINER if children is not None else 0)

    @staticmethod
    def read(data, at=0):
        """The chunk at a byte offset of a good file."""
        letters, _, packed = struct.unpack_from("<4sIQ", data, at)
        size, flags = packed & (1 << 48) - 1, packed >> 48
        chunk = Chunk(letters.decode("ascii"), flags=flags)
        chunk.offset = at
        if not flags & CONTAINER:
            chunk.payload = data[at + 16 : at + 16 + size]
            return chunk
        chunk.children = []
        here = at + 16
        while here < at + 16 + size:
            chunk.children.append(Chunk.read(data, here))
            here += 16 + chunk.children[-1].padded_size()
        return chunk

    def padded_size(self):
        return (self.size() + 15) // 16 * 16

    def size(self):
        if self.children is None:
            return len(self.payload)
        return sum(16 + child.padded_size() for child in self.children)

    def write(self):
        """The chunk with its header, sums and padding."""
        packed = struct.pack("<Q", self.size() | self.flags << 48)
        letters = self.letters.encode("ascii")
        if self.children is None:
            body = self.payload
            summed = body
        else:
            pieces = [child.write() for child in self.children]
            body = b"".join(pieces)
            summed = b"".join(piece[4:8] for piece in pieces)
        sum_ = struct.pack("<I", crc32c(letters + packed + summed))
        return letters + sum_ + packed + body + bytes(-len(body) % 16)

    def walk(self, path=None):
        """All chunks in file order, each with its path."""
        path = path or self.letters
        yield path, self
        counts = {}
        for child in self.children or []:
            place = counts.get(child.letters, 0)
            counts[child.letters] = place + 1
            yield from child.walk(f"{path}/{child.letters}" + (f"[{place}]" if place else ""))

    def find(self, path):
        return next(chunk for here, chunk in self.walk() if here == path)
