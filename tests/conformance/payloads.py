"""Payloads of leaves, written as fields and numbers: `rotation=0,0,0,1 u8: 1 2 f32: 0.5`. README.md explains the notation.

Names, types and offsets of fields come from records.def; what they are stands in spec/ alone.
"""

import pathlib
import re
import struct

ROOT = pathlib.Path(__file__).resolve().parents[2]
FORMAT = ROOT / 'format' / 'include' / 'bendy' / 'format'
NONE = 0xFFFFFFFF
LOCAL = 0x80000000
LETTERS = {'u8': 'B', 'i8': 'b', 'u16': 'H', 'i16': 'h', 'u32': 'I', 'u64': 'Q', 'f32': 'f'}
COMPONENT_TYPES = ['u8', 'i8', 'u16', 'i16', 'u32', 'f32']


class Wrong(Exception):
    """A description that does not make sense."""


# --- tables ----------------------------------------------------------------------------------------------------------

def read_tables():
    """(ids of containers, struct -> field -> (offset, type, count))"""
    ids = (FORMAT / 'chunk_ids.def').read_text(encoding='utf-8')
    containers = set(re.findall(r'^BENDY_CHUNK\((\w{4}), container,', ids, re.MULTILINE))
    structs = {}
    pattern = r'^BENDY_FIELD\((\w+),\s*(\w+),\s*(\w+),\s*(\d+),\s*(\d+),'
    for name, field, kind, count, offset in re.findall(pattern, (FORMAT / 'records.def').read_text(encoding='utf-8'), re.MULTILINE):
        structs.setdefault(name, {})[field] = (int(offset), kind, int(count))
    return containers, structs


CONTAINERS, STRUCTS = read_tables()
RECORD_OF = {'VERS': 'VersionRecord', 'BNDS': 'BoundRecord', 'SAMP': 'SamplerRecord', 'SAME': 'SameRecord',
             'SURF': 'SurfaceRecord', 'REST': 'RestRecord', 'LIMT': 'ConstraintRecord', 'PULL': 'ChainWeightRecord', 'KINF': 'ChainRecord',
             'POLY': 'SubmeshRecord', 'JNTS': 'JointsRecord', 'VINF': 'MeshRecord', 'TINF': 'MorphTargetRecord', 'CINF': 'ClipRecord',
             'PACK': 'PackRecord', 'PALT': 'PaletteRecord', 'LODD': 'CollapseRecord', 'IMAG': 'ImageRecord',
             'MARK': 'MarkersRecord', 'STND': 'StandingPoseRecord', 'CURV': 'CurveRecord'}
STREAMS = ('POSI', 'NORM', 'TANG', 'TEXC', 'COLR', 'BONE', 'WGHT', 'VALS', 'INDX')
RECORD_OF.update(dict.fromkeys(STREAMS, 'StreamRecord'))
ROWS = {('TRAK', 'TrackRecord'): 0, ('PLAY', 'PlayRecord'): 0, ('ROLE', 'RoleRecord'): 0, ('JNTS', 'RestRecord'): 16, ('LODD', 'MeshCollapseRecord'): 16,
        ('STND', 'StandingRotationRecord'): 32, ('MARK', 'MarkerRecord'): 8}  # where a table starts

# What a field holds that no description sets; all others are 0. These are the pages' "none", "free" and "no change".
DEFAULTS = {
    'VersionRecord': {'signature': b'BENDY\r\n\x1a', 'minor': [1]},
    'TextureUseRecord': {'texture': [NONE], 'scale': [1, 1]},
    'SurfaceRecord': {'base_colour': [1, 1, 1, 1], 'metallic': [1], 'roughness': [1], 'normal_scale': [1],
                      'occlusion_strength': [1], 'alpha_cutoff': [0.5]},
    'RestRecord': {'rotation': [0, 0, 0, 1], 'scale': [1, 1, 1]},
    'ConstraintRecord': {'frame': [0, 0, 0, 1], **{'%s_%s' % (what, end): [sign * float('inf')] * 3
                                              for what in ('rotation', 'translation') for end, sign in (('min', -1), ('max', 1))}},
    'StandingPoseRecord': {'axes': [0, 0, 0, 1]},
    'ChainWeightRecord': {'weight': [1]},
    'ChainRecord': {'target': [NONE], 'pole': [NONE], 'tip_rotation': [0, 0, 0, 1], 'position_weight': [1], 'influence': [1]},
    'SubmeshRecord': {'material': [NONE]},
    'MeshRecord': {'joint': [NONE]},
    'PackRecord': {'frames': [1], 'frame_rate': [1]},
    'PlayRecord': {'frames': [1]},
    'CurveRecord': {'keys': [1], 'components': [1], 'interpolation': [1], 'target': [NONE], 'values': [1]},
}


def size_of(name):
    offset, kind, count = max(STRUCTS[name].values())
    return offset + count * (struct.calcsize('<' + LETTERS[kind]) if kind in LETTERS else size_of(kind))


def default_record(name):
    data = bytearray(size_of(name))
    for field, (offset, kind, count) in STRUCTS[name].items():
        if kind in LETTERS:
            values = DEFAULTS.get(name, {}).get(field, [0] * count)
            struct.pack_into('<%d%s' % (count, LETTERS[kind]), data, offset, *values)
        else:
            data[offset:offset + size_of(kind)] = default_record(kind)
    return data


def put_field(data, at, name, field, text):
    """Writes `field` (of the struct `name`, which starts at `at`); "use.texture" is a field of a record in the record."""
    first, _, rest = field.partition('.')
    if first not in STRUCTS[name]:
        raise Wrong('%s has no field %s' % (name, first))
    offset, kind, count = STRUCTS[name][first]
    if kind not in LETTERS:
        put_field(data, at + offset, kind, rest, text)
        return
    values = text_bytes(text).ljust(count, b'\0') if text.startswith('"') else [number(kind, part) for part in text.split(',')]
    if len(values) != count:
        raise Wrong('%s.%s has %d numbers' % (name, field, count))
    struct.pack_into('<%d%s' % (count, LETTERS[kind]), data, at + offset, *values)


# --- words -----------------------------------------------------------------------------------------------------------

def number(kind, word):
    if word == 'none':
        return NONE
    if word.startswith('local:'):
        return LOCAL | int(word[6:])
    return float(word) if kind == 'f32' else int(word, 0)


def text_bytes(word):
    """A text in quotes; \\xNN is a byte."""
    out = bytearray()
    body = word[1:-1]
    at = 0
    while at < len(body):
        if body[at] == '\\':
            out.append(int(body[at + 2:at + 4], 16))
            at += 4
        else:
            out += body[at].encode('utf-8')
            at += 1
    return bytes(out)


def words_of(line):
    return re.findall(r'\S*"[^"]*"|\S+', line)


def is_type(word):
    return word.endswith(':') and word[:-1] in [*LETTERS, 'hex']


def data_bytes(words, before=0):
    """`u8: 1 2 f32: 0.5 "text" hex: 00ff align`: bytes. `before`: how many stand before them, for `align`."""
    out = bytearray()
    kind = None
    for word in words:
        if is_type(word):
            kind = word[:-1]
        elif word.startswith('"'):
            out += text_bytes(word)
        elif word == 'align':
            out += bytes(-(before + len(out)) % 16)
        elif kind == 'hex':
            out += bytes.fromhex(word)
        elif kind is None:
            raise Wrong('no type before ' + word)
        else:
            value, _, times = word.partition('*')
            out += struct.pack('<' + LETTERS[kind], number(kind, value)) * int(times or 1)
    return out


def stream_bytes(words):
    """`[field=value ...] f32x3 [box f32...] numbers`: a StreamRecord that counts its elements, a box, the numbers."""
    fields = [word for word in words if '=' in word]
    words = [word for word in words if '=' not in word]
    data = default_record('StreamRecord')
    kind, _, components = words[0].partition('x')
    put_field(data, 0, 'StreamRecord', 'component_type', str(COMPONENT_TYPES.index(kind)))
    put_field(data, 0, 'StreamRecord', 'components', components)
    words = words[1:]
    box = bytearray()
    if words and words[0] == 'box':
        end = words.index('data')
        box = data_bytes(['f32:', *words[1:end]])
        box += bytes(-len(box) % 16)
        words = words[end + 1:]
    numbers = data_bytes([kind + ':', *words])
    width = struct.calcsize('<' + LETTERS[kind]) * int(components)
    put_field(data, 0, 'StreamRecord', 'elements', str(len(numbers) // width if width else 0))
    for word in fields:
        field, _, value = word.partition('=')
        put_field(data, 0, 'StreamRecord', field, value)
    return data + box + numbers


def payload_bytes(chunk_id, words):
    """What stands behind a leaf's id in a description."""
    if chunk_id in STREAMS and words and re.fullmatch(r'[uif]\d+x\d+', next((w for w in words if '=' not in w), '')):
        return stream_bytes(words)
    out = bytearray()
    name = RECORD_OF.get(chunk_id)
    at = 0
    rest = []
    if words and words[0] == 'raw':
        name, words = None, words[1:]
    elif name:
        out += default_record(name)

    def flush():
        out.extend(data_bytes(rest, len(out)))
        rest.clear()

    for word in words:
        if word.startswith('@'):
            flush()
            name, _, times = word[1:].partition('*')
            at = len(out)
            out += default_record(name) * int(times or 1)
        elif re.match(r'[a-z_.]+=', word):
            field, _, value = word.partition('=')
            put_field(out, at, name, field, value)
        else:
            rest.append(word)
    flush()
    return out
