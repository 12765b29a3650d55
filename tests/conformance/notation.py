"""Reads descriptions/*.txt and makes the files that they describe. README.md explains the notation."""

import copy
import itertools
import re
import struct

from changes import change_bytes, change_tree, place_in
from payloads import Wrong, words_of
from trees import count_all, find, parse_tree


class File:
    def __init__(self, family, name):
        self.family = family
        self.name = name
        self.why = ''
        self.data = b''
        self.faults = []  # (offset, code, path)


def expand(lines):
    """Blocks with `each A,B: 1,2 3,4`, or `1;2 3;4`, become several, {A} and {B} replaced; {parent} is the last id of {path}."""
    loops = [line[5:] for line in lines if line.startswith('each ')]
    lines = [line for line in lines if not line.startswith('each ')]
    rounds = []
    for loop in loops:
        names, _, values = loop.partition(':')
        names = names.strip().split(',')
        mark = ';' if ';' in values else ','
        rounds.append([dict(zip(names, value.split(mark, len(names) - 1), strict=True)) for value in values.split()])
    for choice in itertools.product(*rounds):
        names = {key: value for part in choice for key, value in part.items()}
        names.setdefault('parent', names.get('path', '').split('/')[-1].split('[')[0])
        yield [re.sub(r'\{(\w+)\}', lambda found: names[found[1]], line) for line in lines]


def fault_of(root, words):
    """fault CODE PATH [at padding | at +N | at end] [shown PATH]: (offset, code, path)"""
    code, path = words[0], words[1]
    if path == 'nowhere':
        return 0, code, ''
    rope = re.fullmatch(r'(.*?)((?:/\w{4}))\*(\d+)', path)
    chunk = find(root, rope[1] + rope[2] if rope else path)
    offset = chunk.offset
    if rope:
        path, offset = rope[1] + rope[2] * int(rope[3]), offset + 16 * (int(rope[3]) - 1)
    for what, value in zip(words[2::2], words[3::2]):
        if what == 'shown':
            path = value
        elif value == 'padding':
            offset = chunk.offset + 16 + chunk.size
        elif value.startswith('+'):
            offset = chunk.offset + place_in(value[1:])
        elif value == 'end':
            offset, path = chunk.offset + 16 + chunk.size, ''
        else:
            raise Wrong('no place is called ' + value)
    return offset, code, path


def grouped(lines):
    """(line, the deeper lines behind it)"""
    groups = []
    for line in lines:
        if line.startswith('  '):
            groups[-1][1].append(line)
        else:
            groups.append((line, []))
    return groups


def make_file(family, lines, bases):
    file = File(family, re.sub(r'[^\w-]', '_', lines[0].split()[1]))
    node, root, data, is_valid = None, None, None, False

    def finish():
        nonlocal root, data
        if data is None:
            count_all(node)
            root = node.chunk()
            root.lay_out(0)
            data = bytearray(root.encode())

    for line, below in grouped(lines[1:]):
        what, _, rest = line.partition(' ')
        if what == 'why':
            file.why = rest
        elif line == 'large':
            continue
        elif what == 'from':
            if rest not in bases:
                raise Wrong('no base is called ' + rest)
            node = copy.deepcopy(bases[rest])
        elif line == 'tree':
            node = parse_tree([deeper[2:] for deeper in below])
        elif what == 'valid':
            is_valid = True
        elif what == 'fault':
            finish()
            file.faults.append(fault_of(root, words_of(rest)))
        elif data is not None or not change_tree(node, line, below):
            finish()
            change_bytes(root, data, line)
    finish()
    if is_valid == bool(file.faults) or not file.why:
        raise Wrong('a file needs a reason, and is valid or has faults')
    file.data = bytes(data)
    file.faults = sorted(set(file.faults))
    return file


def read_blocks(path):
    """Parts of a description file, each a list of lines that starts with `base NAME` or `file NAME`."""
    block = []
    for line in path.read_text(encoding='utf-8').splitlines():
        if line.startswith('#') or not line.strip():
            continue
        if re.match(r'(base|file) ', line) and block:
            yield block
            block = []
        block.append(line.rstrip())
    if block:
        yield block


def read_all(folder, large):
    """The files that the descriptions in `folder` describe, those marked as large or all others; bases.txt comes first."""
    bases = {}
    files = []
    names = set()
    for path in sorted(folder.glob('*.txt'), key=lambda path: (path.stem != 'bases', path.stem)):
        for block in read_blocks(path):
            try:
                if block[0].startswith('base '):
                    bases[block[0].split()[1]] = parse_tree(line[2:] for line in block[1:])
                    continue
                if ('large' in block) != large:
                    continue
                for lines in expand(block):
                    file = make_file(path.stem, lines, bases)
                    if (path.stem, file.name) in names:
                        raise Wrong('the name is taken')
                    names.add((path.stem, file.name))
                    files.append(file)
            except (Wrong, ValueError, IndexError, KeyError, struct.error) as wrong:
                raise SystemExit('%s: %s: %s: %s' % (path.name, block[0], type(wrong).__name__, wrong))
    return files
