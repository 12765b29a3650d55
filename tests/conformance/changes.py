"""The changes that a description makes of a tree, or of the finished bytes. README.md lists them."""

import copy
import re

import encoders
from payloads import RECORD_OF, ROWS, Wrong, data_bytes, payload_bytes, put_field, size_of, words_of
from trees import find, parse_tree, step, Node


def place_in(text):
    """A number of bytes, sums allowed: 24+5."""
    return sum(int(part, 0) for part in text.split('+'))


def set_fields(root, words):
    node = find(root, words[0])
    for word in words[1:]:
        left, _, value = word.partition('=')
        row = re.fullmatch(r'(\w+)\[(\d+)\]\.(.+)', left)
        if row:
            name, at, field = row[1], ROWS[node.id, row[1]] + int(row[2]) * size_of(row[1]), row[3]
        else:
            name, at, field = RECORD_OF[node.id], 0, left
        put_field(node.payload, at, name, field, value)
        if node.id == 'VERS':
            node.counted.add(field)


def add(root, words, lines):
    """add PATH [first | before ID] ID ...: a child of PATH; last if it is not said where."""
    parent = find(root, words[0])
    words = words[1:]
    place = len(parent.children)
    if words[0] == 'first':
        place, words = 0, words[1:]
    elif words[0] == 'before':
        chunk_id, nth = step(words[1])
        place = [k for k, child in enumerate(parent.children) if child.id == chunk_id][nth]
        words = words[2:]
    parent.children.insert(place, parse_tree([' '.join(words), *lines]))


def encode(root, words):
    node = find(root, words[0])
    options = dict(word.split('=', 1) for word in words[2:])
    node.plain = bytes(node.payload)
    node.codec, encoded = encoders.encode(words[1], node.plain, **{key: int(value) for key, value in options.items()})
    node.payload = bytearray(encoded)


def change_tree(root, line, below):
    """One change that keeps sizes and sums right. True if `line` is one."""
    words = words_of(line)
    what, words = words[0], words[1:]
    if what == 'set':
        set_fields(root, words)
    elif what == 'put':  # put PATH at N type: numbers
        node, at, data = find(root, words[0]), place_in(words[2]), data_bytes(words[3:])
        if at + len(data) > len(node.payload):
            raise Wrong('there are %d bytes' % len(node.payload))
        node.payload[at:at + len(data)] = data
    elif what == 'payload':
        find(root, words[0]).payload = payload_bytes(find(root, words[0]).id, words[1:])
    elif what == 'cut':  # cut PATH to N
        node = find(root, words[0])
        if place_in(words[2]) >= len(node.payload):
            raise Wrong('there are only %d bytes' % len(node.payload))
        del node.payload[place_in(words[2]):]
    elif what == 'extend':
        find(root, words[0]).payload += data_bytes(words[1:])
    elif what == 'drop':
        parent, place = find(root, words[0], parent=True)
        del parent.children[place]
    elif what == 'copy':
        parent, place = find(root, words[0], parent=True)
        parent.children.insert(place + 1, copy.deepcopy(parent.children[place]))
    elif what == 'move':  # move PATH into PATH
        parent, place = find(root, words[0], parent=True)
        find(root, words[2]).children.append(parent.children.pop(place))
    elif what == 'rename':
        find(root, words[0]).id = words[1]
    elif what == 'shape':  # shape PATH leaf | container
        node = find(root, words[0])
        node.payload, node.children = (bytearray(), None) if words[1] == 'leaf' else (None, [])
    elif what == 'codec':  # codec PATH N: the number alone
        find(root, words[0]).codec = int(words[1])
    elif what == 'encode':
        encode(root, words)
    elif what == 'add':
        add(root, words, below)
    elif what == 'rope':  # rope PATH N ID: N containers behind the first child, each in the one before
        rope = Node(words[2], children=[])
        rope.levels = int(words[1])
        find(root, words[0]).children.insert(1, rope)
    else:
        return False
    return True


def change_bytes(root, data, line):
    """One change of the finished bytes; sums stay as they are."""
    words = words_of(line)
    what, words = words[0], words[1:]
    if what == 'patch':  # patch PATH+N type: numbers, N from the chunk's header
        path, _, at = words[0].partition('+')
        at = find(root, path).offset + place_in(at or '0')
        new = data_bytes(words[1:])
        data[at:at + len(new)] = new
    elif what == 'truncate':  # truncate to N | by N
        del data[place_in(words[1]) if words[0] == 'to' else len(data) - place_in(words[1]):]
    elif what == 'append':
        data += data_bytes(words)
    elif what == 'bytes':
        data[:] = data_bytes(words)
    else:
        raise Wrong('no change is called ' + what)
