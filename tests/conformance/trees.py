"""Trees of chunks as descriptions have them, and as they lie in a file. The chunk writer is that of spec/make_bytes.py."""

import re
import struct
import sys

from payloads import CONTAINERS, ROOT, Wrong, payload_bytes, put_field, words_of

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / 'spec'))
from make_bytes import CONTAINER, REQUIRED, Chunk, crc32c  # noqa: E402


class Node:
    def __init__(self, chunk_id, payload=None, children=None, flags=0):
        self.id = chunk_id
        self.payload = payload  # None: a container
        self.children = children
        self.flags = flags
        self.codec = 0
        self.plain = None  # of an encoded leaf
        self.counted = set()  # of VERS: fields whose values a description has set
        self.levels = 1  # of a rope: containers of this id, each in the one before

    @staticmethod
    def parse(line):
        words = words_of(line)
        chunk_id, words = words[0], words[1:]
        marks = [word for word in words if word.startswith('+')]
        words = [word for word in words if not word.startswith('+')]
        flags = REQUIRED if '+REQUIRED' in marks else 0
        if (chunk_id in CONTAINERS or '+CONTAINER' in marks) and '+LEAF' not in marks:
            if words:
                raise Wrong('%s is a container' % chunk_id)
            return Node(chunk_id, children=[], flags=flags)
        node = Node(chunk_id, payload=payload_bytes(chunk_id, words), flags=flags)
        if chunk_id == 'VERS' and 'raw' not in words:
            node.counted = {word.partition('=')[0] for word in words if '=' in word}
            if 'generator' not in node.counted:
                del node.payload[48:]
        return node

    def chunk(self):
        if self.levels != 1:
            return Rope(self.id, self.levels)
        if self.children is not None:
            return Chunk(self.id, [child.chunk() for child in self.children], self.flags | CONTAINER)
        return Chunk(self.id, [(bytes(self.payload), '')], self.flags, self.codec)

    def walk(self):
        yield self
        for child in self.children or []:
            yield from child.walk()


def parse_tree(lines):
    """Lines, two blanks deeper for each level: the first line's node."""
    stack = []
    for line in lines:
        depth = (len(line) - len(line.lstrip())) // 2
        node = Node.parse(line.strip())
        del stack[depth:]
        if stack:
            if stack[-1].children is None:
                stack[-1].children, stack[-1].payload = [], None
            stack[-1].children.append(node)
        stack.append(node)
    return stack[0]


def step(path_step):
    found = re.fullmatch(r'(.{4})(?:\[(\d+)\])?', path_step)
    if not found:
        raise Wrong('%s is no step of a path' % path_step)
    return found[1], int(found[2] or 0)


def find(root, path, parent=False):
    """The node or chunk at a path such as HEAD/OBJE/SKIN[1]; with `parent`, its parent and place there."""
    steps = [step(part) for part in path.split('/')]
    here, above, place = root, None, 0
    if steps[0] != (root.id, 0):
        raise Wrong('no ' + path)
    for chunk_id, nth in steps[1:]:
        children = here.children if isinstance(here, Node) else here.parts
        same = [k for k, child in enumerate(children) if child.id == chunk_id]
        if nth >= len(same):
            raise Wrong('no ' + path)
        above, place = here, same[nth]
        here = children[place]
    return (above, place) if parent else here


def count_all(root):
    """Writes into VERS what the file holds, where no description has said it."""
    vers = next((child for child in root.children or [] if child.id == 'VERS'), None)
    if vers is None or vers.payload is None or len(vers.payload) < 48 or vers.codec:
        return
    counts = dict.fromkeys(('objects', 'joints', 'meshes', 'vertices', 'clips', 'materials', 'textures'), 0)

    def visit(node):
        for child in node.children or []:
            if child.children is None:
                continue
            if (node.id, child.id) in (('HEAD', 'OBJE'), ('OBJE', 'SKIN'), ('SKIN', 'SKIN'), ('OBJE', 'VECT'), ('OBJE', 'CYCL'),
                                       ('HEAD', 'MATE'), ('SKIN', 'MATE'), ('HEAD', 'TEXT')):
                counts[{'OBJE': 'objects', 'SKIN': 'joints', 'VECT': 'meshes', 'CYCL': 'clips', 'MATE': 'materials',
                        'TEXT': 'textures'}[child.id]] += child.levels
                if child.id == 'VECT':
                    info = next((leaf for leaf in child.children if leaf.id == 'VINF' and leaf.payload is not None), None)
                    if info and len(info.plain or info.payload) >= 8:
                        counts['vertices'] += struct.unpack_from('<I', info.plain or info.payload)[0]
                visit(child)

    visit(root)
    for field, count in counts.items():
        if field not in vers.counted:
            put_field(vers.payload, 0, 'VersionRecord', field, str(count))


class Rope(Chunk):
    """Containers of one id, each in the one before; made without recursion."""

    def __init__(self, chunk_id, levels):
        super().__init__(chunk_id, [], CONTAINER)
        self.levels = levels

    def lay_out(self, offset):
        self.offset = offset
        self.size = 16 * (self.levels - 1)
        self.head = self.id.encode('ascii')
        headers = []
        covered = b''
        for level in range(self.levels):
            tail = struct.pack('<Q', 16 * level | self.flags << 48)
            self.sum = crc32c(self.head + tail + covered)
            covered = struct.pack('<I', self.sum)
            headers.append(self.head + covered + tail)
        self.bytes = b''.join(reversed(headers))
        return offset + len(self.bytes)

    def encode(self):
        return self.bytes
