#!/usr/bin/env python3
"""Writes the example files and every annotated byte dump of the specification.

    python3 spec/make_bytes.py            rewrite examples/*.bendy and the marked blocks of the pages
    python3 spec/make_bytes.py --check    change nothing; say what differs; exit 1 if anything does

It knows the format from these pages alone, so it is also a second, small writer. Python 3, nothing else.
"""

import math
import pathlib
import re
import struct
import sys
import zlib  # CRC-32 and Adler-32 of the PNG example; the format's own sum is below

SPEC = pathlib.Path(__file__).resolve().parent

CONTAINER = 1 << 0
REQUIRED = 1 << 1
NONE = 0xFFFFFFFF
LOCAL = 0x80000000
INFINITE = float('inf')


# --- sums -------------------------------------------------------------------------------------------------------------

def make_crc_table():
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = byte >> 1 ^ (0x82F63B78 if byte & 1 else 0)
        table.append(byte)
    return table


CRC_TABLE = make_crc_table()


def crc32c(data, before=0):
    """CRC-32C; pass the last result as `before` to go on with more bytes."""
    crc = before ^ 0xFFFFFFFF
    for byte in data:
        crc = CRC_TABLE[(crc ^ byte) & 0xFF] ^ crc >> 8
    return crc ^ 0xFFFFFFFF


# --- pieces of a payload: bytes and what they mean -------------------------------------------------------------------

def numbers(code, values, what):
    if not isinstance(values, (list, tuple)):
        values = [values]
    return struct.pack('<%d%s' % (len(values), code), *values), what


def u8(values, what):
    return numbers('B', values, what)


def u16(values, what):
    return numbers('H', values, what)


def u32(values, what):
    return numbers('I', values, what)


def u64(values, what):
    return numbers('Q', values, what)


def f32(values, what):
    return numbers('f', values, what)


def text(words):
    return words.encode('utf-8'), '"%s"' % words


def raw(data, what):
    return bytes(data), what


# --- chunks ----------------------------------------------------------------------------------------------------------

class Chunk:
    """A chunk with its children or its pieces. `lay_out` fixes offset, size and sum, from the leaves upwards."""

    def __init__(self, chunk_id, parts, flags=0, codec=0):
        self.id = chunk_id
        self.is_container = bool(flags & CONTAINER)
        self.parts = parts
        self.flags = flags | codec << 8

    def lay_out(self, offset):
        self.offset = offset
        at = offset + 16
        if self.is_container:
            for child in self.parts:
                at = child.lay_out(at)
            self.size = at - offset - 16
        else:
            self.payload = b''.join(data for data, _ in self.parts)
            self.size = len(self.payload)
            at += self.size + -self.size % 16
        self.head = self.id.encode('ascii')
        self.tail = struct.pack('<Q', self.size | self.flags << 48)
        if self.is_container:
            self.covered = b''.join(struct.pack('<I', child.sum) for child in self.parts)
        else:
            self.covered = self.payload
        self.sum = crc32c(self.head + self.tail + self.covered)
        return at

    def header(self):
        return self.head + struct.pack('<I', self.sum) + self.tail

    def encode(self):
        if self.is_container:
            return self.header() + b''.join(child.encode() for child in self.parts)
        return self.header() + self.payload + bytes(-self.size % 16)

    def walk(self):
        yield self
        if self.is_container:
            for child in self.parts:
                yield from child.walk()

    # rows of a dump: offset, bytes, words

    def header_rows(self):
        flags = [name for bit, name in ((CONTAINER, 'CONTAINER'), (REQUIRED, 'REQUIRED')) if self.flags & bit]
        if self.flags >> 8:
            flags.append('codec %d' % (self.flags >> 8))
        words = 'size %d' % self.size + (', ' + ', '.join(flags) if flags else '')
        return [(self.offset, self.head, 'id %s' % self.id),
                (self.offset + 4, struct.pack('<I', self.sum), 'sum 0x%08x' % self.sum),
                (self.offset + 8, self.tail, words)]

    def leaf_rows(self):
        rows = []
        at = self.offset + 16
        for data, what in self.parts:
            rows.append((at, data, what))
            at += len(data)
        if self.size % 16:
            rows.append((at, bytes(-self.size % 16), 'padding'))
        return rows

    def rows(self, depth=0):
        indent = '  ' * depth
        own = self.header_rows()
        if not self.is_container:
            own += [(at, data, '  ' + what) for at, data, what in self.leaf_rows()]
        result = [(at, data, indent + what) for at, data, what in own]
        if self.is_container:
            for child in self.parts:
                result += child.rows(depth + 1)
        return result


def box(chunk_id, *children, flags=0):
    return Chunk(chunk_id, list(children), flags | CONTAINER)


def leaf(chunk_id, *pieces, flags=0, codec=0):
    return Chunk(chunk_id, list(pieces), flags, codec)


def name(words):
    return leaf('NAME', text(words))


def extras(json):
    return leaf('EXTR', text(json))


# --- records ---------------------------------------------------------------------------------------------------------

def version(objects=0, joints=0, meshes=0, vertices=0, clips=0, materials=0, textures=0, generator=None):
    pieces = [raw(b'BENDY\r\n\x1a', 'signature'), u16(0, 'major 0'), u16(1, 'minor 1'),
              u32(objects, 'objects %d' % objects), u32(joints, 'joints %d' % joints), u32(meshes, 'meshes %d' % meshes),
              u64(vertices, 'vertices %d' % vertices), u32(clips, 'clips %d' % clips),
              u32(materials, 'materials %d' % materials), u32(textures, 'textures %d' % textures), u32(0, 'reserved')]
    if generator is not None:
        pieces.append(raw(generator.encode('utf-8').ljust(32, b'\0'), 'generator "%s"' % generator))
    return leaf('VERS', *pieces)


def sampler(mag, smallest, s, t):
    return leaf('SAMP', u8(mag, 'mag_filter %d' % mag), u8(smallest, 'min_filter %d' % smallest),
                u8(s, 'wrap_s %d' % s), u8(t, 'wrap_t %d' % t))


def texture_use(which, texture=NONE, coords=0, offset=(0, 0), scale=(1, 1), rotation=0):
    word = 'none' if texture == NONE else texture
    return [u32(texture, '%s.texture %s' % (which, word)), u32(coords, '  .coords %d' % coords),
            f32(offset, '  .offset %g %g' % tuple(offset)), f32(scale, '  .scale %g %g' % tuple(scale)),
            f32(rotation, '  .rotation %g' % rotation), u32(0, '  .reserved')]


def surface(colour, texture=NONE):
    return leaf('SURF', f32(colour, 'base_colour %g %g %g %g' % tuple(colour)), f32([0, 0, 0], 'emissive 0 0 0'),
                f32(0, 'metallic 0'), f32(0.5, 'roughness 0.5'), f32(1, 'normal_scale 1'),
                f32(1, 'occlusion_strength 1'), f32(0.5, 'alpha_cutoff 0.5'), u8(0, 'alpha_mode 0 (opaque)'),
                u8(0, 'double_sided 0'), u8(0, 'unlit 0'), u8([0] * 13, 'reserved'),
                *texture_use('base_colour_texture', texture), *texture_use('metallic_roughness_texture'),
                *texture_use('normal_texture'), *texture_use('occlusion_texture'), *texture_use('emissive_texture'))


def rest(translation, rotation=(0, 0, 0, 1), scale=(1, 1, 1), shear=(0, 0, 0)):
    def words(values):
        return ' '.join('%g' % value for value in values)
    return leaf('REST', f32(rotation, 'rotation ' + words(rotation)), f32(translation, 'translation ' + words(translation)),
                f32(scale, 'scale ' + words(scale)), f32(shear, 'shear ' + words(shear)))


def joint_rest(joint, translation):
    """A row of JNTS."""
    return [f32([0, 0, 0, 1], 'joint %d: rotation 0 0 0 1' % joint),
            f32(translation, '  translation %g %g %g' % tuple(translation)), f32([1, 1, 1], '  scale 1 1 1'),
            f32([0, 0, 0], '  shear 0 0 0')]


def joint_role(joint, role, place, word):
    """A row of ROLE."""
    return [u32(joint, 'joint %d' % joint), u16(role, '  role %d (%s)' % (role, word)), u16(place, '  place %d' % place)]


def standing(axes, ground, height, evidence, word, rotations):
    """`rotations` are (joint, [x, y, z])."""
    def words(values):
        return ' '.join('%g' % value for value in values)
    rows = [piece for joint, rotation in rotations
            for piece in (u32(joint, 'joint %d' % joint), f32(rotation, '  rotation ' + words(rotation)))]
    return leaf('STND', f32(axes, 'axes ' + words(axes)), f32(ground, 'ground %g' % ground), f32(height, 'height %g' % height),
                u8(evidence, 'evidence %d (%s)' % (evidence, word)), u8([0] * 7, 'reserved'), *rows)


def limit(model, frame, rotation, scope=0, flags=0, order=0, soft_zone=0, translation=((-INFINITE, INFINITE),) * 3,
          stiffness=(0, 0, 0), preferred=(0, 0, 0)):
    """`rotation` and `translation` are (minimum, maximum) of X, Y, Z; rotation in degrees, None free."""
    models = ('free', 'locked', 'hinge', 'swing-twist ellipse', 'swing-twist pyramid', 'Euler box', 'largest angle')
    lows = [-INFINITE if pair is None else math.radians(pair[0]) for pair in rotation]
    highs = [INFINITE if pair is None else math.radians(pair[1]) for pair in rotation]

    def words(values):
        return ' '.join('%g' % value for value in values)
    return leaf('LIMT', u8(model, 'model %d (%s)' % (model, models[model])), u8(order, 'euler_order %d' % order),
                u8(scope, 'scope %d' % scope), u8(flags, 'flags %d' % flags), f32(soft_zone, 'soft_zone %g' % soft_zone),
                f32(frame, 'frame ' + words(frame)), f32(lows, 'rotation_min ' + words(lows)),
                f32(highs, 'rotation_max ' + words(highs)),
                f32([low for low, _ in translation], 'translation_min ' + words(low for low, _ in translation)),
                f32([high for _, high in translation], 'translation_max ' + words(high for _, high in translation)),
                f32(stiffness, 'stiffness ' + words(stiffness)), f32(preferred, 'preferred ' + words(preferred)))


def pull(chain, weight):
    return leaf('PULL', u32(chain, 'chain %d' % chain), f32(weight, 'weight %g' % weight))


def chain_info(start, effector, target=NONE, pole=NONE, solver=0, tip_offset=(0, 0, 0)):
    def joint(what, number):
        return u32(number, '%s %s' % (what, 'none' if number == NONE else number))
    solvers = ('any', 'pull', 'two-bone', 'CCD', 'FABRIK', 'aim', 'least squares')
    return leaf('KINF', joint('start', start), joint('effector', effector), joint('target', target), joint('pole', pole),
                u8(solver, 'solver %d (%s)' % (solver, solvers[solver])), u8(0, 'flags 0'), u16(16, 'iterations 16'),
                u8(1, 'priority 1'), u8([0, 0, 0], 'reserved'), f32(0.001, 'tolerance 0.001'),
                f32([0, 0, 1], 'pole_vector 0 0 1'), f32(0, 'pole_angle 0'),
                f32(tip_offset, 'tip_offset %g %g %g' % tuple(tip_offset)), f32([0, 0, 0, 1], 'tip_rotation 0 0 0 1'),
                f32(1, 'position_weight 1'), f32(0, 'rotation_weight 0'), f32(1, 'influence 1'), f32(0, 'stretch 0'),
                f32(0, 'compress 0'))


def submesh(mesh, material, first, count):
    if material == NONE:
        word = 'none'
    elif material & LOCAL:
        word = 'local %d' % (material & ~LOCAL)
    else:
        word = str(material)
    return leaf('POLY', u32(mesh, 'mesh %d' % mesh), u32(material, 'material ' + word), u32(first, 'first %d' % first),
                u32(count, 'count %d' % count), u8(0, 'topology 0 (triangles)'), u8([0, 0, 0], 'reserved'))


def mesh_info(vertices, joint):
    return leaf('VINF', u32(vertices, 'vertices %d' % vertices), u32(joint, 'joint %s' % ('none' if joint == NONE else joint)))


TYPES = {'u8': (0, 'B'), 'i8': (1, 'b'), 'u16': (2, 'H'), 'i16': (3, 'h'), 'u32': (4, 'I'), 'f32': (5, 'f')}


def stream(chunk_id, kind, elements, normalised=0, number=0, box=()):
    """`elements` is a list of lists, one a vertex; one row of the dump each. `box`: (minimum, step) of each component."""
    code, letter = TYPES[kind]
    width = len(elements[0])
    pieces = [u8(code, 'component_type %d (%s)' % (code, kind)), u8(normalised, 'normalised %d' % normalised),
              u16(width, 'components %d' % width), u32(len(elements), 'elements %d' % len(elements)),
              u32(number, 'set %d' % number), u32(0, 'reserved')]
    pieces += [f32(side, 'minimum %g, step %g' % side) for side in box]
    if len(box) * 8 % 16:
        pieces.append(raw(bytes(8), 'zeros up to 16 bytes'))
    for index, element in enumerate(elements):
        pieces.append(numbers(letter, element, '[%d] %s' % (index, ' '.join('%g' % value for value in element))))
    return leaf(chunk_id, *pieces)


def palette(entries):
    joints = [joint for joint, _ in entries]
    pieces = [u32(len(entries), 'entries %d' % len(entries)), u32(0, 'derived 0'), u32([0, 0], 'reserved'),
              u32(joints, 'joints ' + ' '.join(map(str, joints)))]
    if len(entries) * 4 % 16:
        pieces.append(raw(bytes(-len(entries) * 4 % 16), 'zeros up to 16 bytes'))
    for index, (_, matrix) in enumerate(entries):
        for column in range(4):
            values = matrix[4 * column:4 * column + 4]
            pieces.append(f32(values, 'inverse bind %d, column %d: %s' % (index, column, ' '.join('%g' % v for v in values))))
    return leaf('PALT', *pieces)


def collapse(meshes, levels):
    """meshes: (number, base, targets, joined bits); levels: (error, vertices alive of each mesh)"""
    pieces = [u32(len(meshes), 'meshes %d' % len(meshes)), u32(len(levels), 'levels %d' % len(levels)),
              u32([0, 0], 'reserved')]

    def pad(size):
        if size % 16:
            pieces.append(raw(bytes(-size % 16), 'zeros up to 16 bytes'))

    for number, base, _, _ in meshes:
        pieces += [u32(number, 'mesh %d' % number), u32(base, 'base %d' % base), u8(2, 'target_type 2 (u16)'),
                   u8([0] * 7, 'reserved')]
    for index, (error, *alive) in enumerate(levels):
        pieces += [f32(error, 'level %d: error %g' % (index, error)),
                   u32(alive, 'level %d: alive %s' % (index, ' '.join(map(str, alive))))]
    pad(sum(4 + 4 * len(alive) for _, *alive in levels))
    for number, base, targets, joined in meshes:
        pieces.append(u16(targets, 'targets of vertices %d and on: %s' % (base, ' '.join(map(str, targets)))))
        pad(2 * len(targets))
        pieces.append(u8(joined, 'joined bits of vertices %d and on' % base))
        pad(len(joined))
    return leaf('LODD', *pieces)


def clip_info(start, end, rate, loop):
    return leaf('CINF', f32(start, 'start %g' % start), f32(end, 'end %g' % end), f32(rate, 'frame_rate %g' % rate),
                u8(loop, 'loop %d' % loop), u8([0, 0, 0], 'reserved'))


def track(target, path, interpolation, components, keys, first_time, first_value):
    paths = ('translation', 'rotation', 'scale', 'weights')
    kinds = ('step', 'linear', 'cubic')
    time = 'fixed frames' if first_time == NONE else str(first_time)
    return [u32(target, 'target %d' % target), u8(path, 'path %d (%s)' % (path, paths[path])),
            u8(interpolation, 'interpolation %d (%s)' % (interpolation, kinds[interpolation])),
            u16(components, 'components %d' % components), u32(keys, 'keys %d' % keys),
            u32(first_time, 'first_time ' + time), u64(first_value, 'first_value %d' % first_value)]


def play(mesh, first, frames, closed):
    return leaf('PLAY', u32(mesh, 'mesh %d' % mesh), u32(first, 'first %d' % first), u32(frames, 'frames %d' % frames),
                u8(closed, 'closed %d' % closed), u8([0, 0, 0], 'reserved'))


def grid(frames):
    """(minimum, step) of each axis of each frame"""
    return leaf('GRID', *(f32(side, 'frame %d, %s: minimum %g, step %g' % (number, axis, *side))
                          for number, sides in enumerate(frames) for axis, side in zip('xyz', sides)))


def packed_tracks():
    """Joint 0 turns about x at 2 frames a second, joint 1 stands aside: one list of each."""
    return [u32(3, 'frames 3'), f32(0, 'start 0'), f32(2, 'frame_rate 2'), u16(2, 'joints 2'), u16(0, 'segment_frames 0'),
            u8(6, 'lists 1 and 2'), u8(0, 'wide none'), u8([0, 0], 'reserved'),
            u8(1, 'list 1 (rotation, animated): joint 0'), u8(2, 'list 2 (translation, constant): joint 1'),
            u8([120, 121, 122], 'steps of list 1: x, y, z'), u8([130] * 3, 'steps of list 2'),
            raw(bytes([0, 0, 7, 0, 0, 0]), 'bases of list 2: 0, 7, 0'),
            u8([3, 0, 0], 'widths of list 1: x has 3 bits'), raw(bytes([255, 255, 0, 0, 9, 0]), 'its bases: -1, 0, 9'),
            u8(0, 'frame 0: x = -1 + 0'), u8(3, 'frame 1: x = -1 + 3'), u8(6, 'frame 2: x = -1 + 6'),
            u8([0] * 4, 'tail')]


def marked(*markers):
    """(seconds, name) each"""
    pieces = [u32(len(markers), 'markers %d' % len(markers)), u32(0, 'reserved')]
    end = 0
    for number, (seconds, word) in enumerate(markers):
        end += len(word.encode())
        pieces += [f32(seconds, 'marker %d: seconds %g' % (number, seconds)), u32(end, 'marker %d: name_end %d' % (number, end))]
    return leaf('MARK', *pieces, *(raw(word.encode(), '"%s"' % word) for _, word in markers))


def curve(kind, target, path, word, times, values):
    """A linear curve of f32."""
    components = len(values) // len(times)
    pieces = [u32(len(times), 'keys %d' % len(times)), u8(components, 'components %d' % components), u8(1, 'interpolation 1 (linear)'),
              u8(0, 'packed 0'), u8(kind, 'kind %d' % kind), u32(target, 'target %d' % target), f32(0, 'max_error 0'),
              u32(len(values), 'values %d' % len(values)), u32(len(path), 'path_size %d' % len(path)),
              u32(len(word), 'name_size %d' % len(word)), u32(0, 'reserved'), f32(times, 'times'), f32(values, 'values')]
    return leaf('CURV', *pieces, raw(path.encode(), '"%s"' % path), raw(word.encode(), '"%s"' % word))


def smallest_png():
    """One red pixel. Its only block is stored, so that every zlib makes the same bytes."""
    def part(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    row = bytes([0, 255, 0, 0])
    stored = b'\x78\x01\x01' + struct.pack('<HH', len(row), len(row) ^ 0xFFFF) + row + struct.pack('>I', zlib.adler32(row))
    return (b'\x89PNG\r\n\x1a\n' + part(b'IHDR', struct.pack('>IIBBBBB', 1, 1, 8, 2, 0, 0, 0)) + part(b'IDAT', stored) +
            part(b'IEND', b''))


# --- the example files -----------------------------------------------------------------------------------------------

def make_smallest():
    return box('HEAD', version())


def make_one_joint():
    """A rigid triangle on one joint, one metre above the ground."""
    return box(
        'HEAD',
        version(objects=1, joints=1, meshes=1, vertices=3, generator='make_bytes'),
        box('OBJE',
            name('flag'),
            box('SKIN', name('pole'), box('PIVO', rest([0, 1, 0])), submesh(0, NONE, 0, 3)),
            box('VECT', mesh_info(3, 0),
                stream('POSI', 'f32', [[0, 0, 0], [1, 0, 0], [0, 1, 0]]),
                stream('INDX', 'u16', [[0], [1], [2]]))))


def make_every_chunk():
    """Every chunk that version 0.1 has a record for: two joints with an IK chain, a soft-skinned triangle, a target, a clip;
    and a triangle with frames, and a clip that plays them."""
    identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    one_down = identity[:13] + [-1] + identity[14:]
    half = 0.7071067811865476
    tracks = (track(1, 1, 1, 4, 2, 0, 0) +                # joint 1, rotation, linear, timed: 8 numbers
              track(0, 0, 0, 3, 3, NONE, 8) +             # joint 0, translation, step, fixed frames: 9 numbers
              track(0, 3, 2, 1, 2, 0, 17))                # mesh 0, weights, cubic, timed: 6 numbers
    values = [f32([0, 0, 0, 1], '[0] track 0, key 0'), f32([0, 0, half, half], '[4] track 0, key 1'),
              f32([0, 0, 0], '[8] track 1, key 0'), f32([0, 0.5, 0], '[11] track 1, key 1'),
              f32([0, 0, 0], '[14] track 1, key 2'),
              f32([0, 0, 0], '[17] track 2, key 0: in-tangent, value, out-tangent'),
              f32([0, 1, 0], '[20] track 2, key 1: in-tangent, value, out-tangent')]
    png = smallest_png()
    return box(
        'HEAD',
        version(objects=1, joints=2, meshes=2, vertices=6, clips=2, materials=2, textures=3, generator='make_bytes'),
        leaf('BNDS', f32(0.0005, 'max_error 0.0005'), f32(0.0004, 'measured_error 0.0004'), f32(2, 'height 2')),
        box('TEXT', name('cloth'), sampler(2, 6, 0, 1), leaf('LINK', text('cloth.png')), extras('{"from":"scan"}')),
        box('TEXT', sampler(1, 1, 0, 0), leaf('SAME', u32(2, 'texture 2'), u32(0, 'image 0'))),
        box('MATE', name('red cloth'), surface([1, 0.5, 0.5, 1], 0),
            leaf('EXTN', text('{"KHR_materials_ior":{"ior":1.4}}')), extras('{"layer":2}')),
        box('OBJE',
            name('worm'),
            extras('{"species":"worm"}'),
            box('SKIN', name('root'), box('PIVO', rest([0, 0, 0]), pull(0, 0.5)), submesh(1, NONE, 0, 3), extras('{"side":"mid"}'),
                leaf('EXTN', text('{"KHR_node_visibility":{"visible":true}}')),
                box('SKIN', name('tip'),
                    box('PIVO', rest([0, 1, 0]),
                        limit(3, [0.5, 0.5, 0.5, 0.5], [(-30, 30), (-40, 40), (-20, 60)])),
                    box('MATE', surface([0, 0, 1, 1])), submesh(0, LOCAL | 0, 0, 3))),
            leaf('JNTS', u32(2, 'joints 2'), u32(0, 'submeshes 0'), u32([0, 0], 'reserved'),
                 *joint_rest(0, [0, 0, 0]), *joint_rest(1, [0, 1, 0])),
            leaf('JNAM', raw(b'root\0', '"root"'), raw(b'tip\0', '"tip"')),
            leaf('ROLE', *joint_role(0, 1, 0, 'hips'), *joint_role(1, 58, 0, 'tail')),
            standing([half, 0, 0, half], 0, 1, 2, 'clip', [(0, [half, 0, 0]), (1, [0.5, 0.5, 0.5])]),  # Z is up
            box('IKCH', name('body'), chain_info(0, 1, solver=3, tip_offset=[0, 1, 0]), extras('{"by":"hand"}')),
            box('VECT', name('body'), mesh_info(3, 0), extras('{"unit":"m"}'),
                palette([(0, identity), (1, one_down)]),
                stream('POSI', 'f32', [[0, 0, 0], [1, 2, 0], [0, 2, 0]]),
                stream('NORM', 'f32', [[0, 0, 1]] * 3),
                stream('TANG', 'f32', [[1, 0, 0, 1]] * 3),
                stream('TEXC', 'f32', [[0, 1], [1, 0], [0, 0]]),
                stream('COLR', 'u8', [[255, 255, 255, 255], [255, 0, 0, 255], [0, 0, 255, 255]], normalised=1),
                stream('BONE', 'u8', [[0, 1], [1, 0], [1, 0]]),
                stream('WGHT', 'u8', [[204, 51], [255, 0], [255, 0]], normalised=1),
                box('USER', name('_HEAT'), stream('VALS', 'f32', [[36.5], [37], [37.5]])),
                box('TARG', name('stretch'), leaf('TINF', f32(0, 'rest_weight 0')),
                    stream('INDX', 'u16', [[1], [2]]),
                    stream('POSI', 'f32', [[0, 1, 0], [0, 1, 0]]),
                    stream('NORM', 'f32', [[0, 0, 0]] * 2),
                    stream('TANG', 'f32', [[0, 0, 0]] * 2)),
                stream('INDX', 'u16', [[0], [1], [2]])),
            box('VECT', name('wing'), mesh_info(3, 0),
                leaf('NLST', f32([0, 0, 1], '[0] 0 0 1'), f32([0, 1, 0], '[1] 0 1 0')),
                stream('POSI', 'u8', [[0, 0, 0], [2, 0, 0], [2, 2, 0]], normalised=2, box=[(0, 0.5)] * 3),
                stream('NORM', 'u8', [[0]] * 3, normalised=3),
                box('FRMS', leaf('FNAM', raw(b'up\0', '"up"'), raw(b'high\0', '"high"')),
                    grid([[(0, 0.5), (0, 0.25), (0, 0)], [(0, 0.5), (0.5, 0.25), (0, 0)]]),
                    stream('INDX', 'u8', [[0], [1], [1]]),
                    stream('POSI', 'u8', [[0, 0, 0], [2, 2, 0], [0, 0, 0], [2, 4, 0]]),
                    stream('NORM', 'u8', [[0], [1], [0], [1]], normalised=3)),
                stream('INDX', 'u16', [[0], [1], [2]])),
            collapse([(0, 2, [0], [0])], [(0, 3), (0.5, 2)]),
            box('CYCL', name('wave'), clip_info(0, 1, 2, 1), extras('{"mood":"glad"}'),
                leaf('TRAK', *tracks), leaf('PACK', *packed_tracks()), leaf('TIME', f32([0, 1], '[0] 0 1')), leaf('KEYV', *values),
                marked((0.25, 'up'), (0.75, 'down')),
                curve(2, 0, 'pbrMetallicRoughness/roughnessFactor', 'shine', [0, 1], [1, 0.25])),
            box('CYCL', name('flap'), clip_info(0, 1.5, 2, 1), play(1, 0, 3, 1))),
        extras('{"author":"us"}'),
        leaf('EXTN', text('{"KHR_xmp_json_ld":{"packets":[]}}')),
        box('TEXT', sampler(1, 1, 0, 0), leaf('IMAG', u8(1, 'media 1 (PNG)'), u8([0] * 15, 'reserved'),
                                              raw(png, 'the PNG file, %d bytes' % len(png))),
            leaf('MORE', text('{"source":[{"name":"dot"}]}'))))


def make_unknown_chunks():
    """Chunks of a later version or of somebody's own: a reader skips them, whatever is in them."""
    return box('HEAD',
               version(generator='make_bytes'),
               leaf('ABCD', text('a leaf that nobody knows')),
               leaf('EFGH', raw([1, 2, 3], 'encoded'), codec=7),
               box('WXYZ', leaf('SKIN', text('not a joint: its parent is unknown')),
                   leaf('IJKL', text('required only where WXYZ is read'), flags=REQUIRED)))


EXAMPLES = {'smallest': make_smallest, 'one_joint': make_one_joint, 'every_chunk': make_every_chunk,
            'unknown_chunks': make_unknown_chunks}


# --- the blocks of the pages -----------------------------------------------------------------------------------------

def hex_rows(rows):
    lines = ['offset  bytes                                            meaning']
    for at, data, what in rows:
        for start in range(0, max(len(data), 1), 16):
            cut = data[start:start + 16].hex(' ')
            words = what if start == 0 else ''
            lines.append(('%06x  %-47s  %s' % (at + start, cut, words)).rstrip())
    return lines


def fenced(lines):
    return ['```'] + lines + ['```']


def dump_block(chunk):
    return fenced(hex_rows(chunk.rows()))


def chunk_block(root, chunk_id):
    """The first chunk of this id in every_chunk: a leaf byte by byte, a container as its header and its children."""
    chunk = next((chunk for chunk in root.walk() if chunk.id == chunk_id), None)
    if chunk is None:
        sys.exit('make_bytes: no %s in every_chunk' % chunk_id)
    if not chunk.is_container:
        return fenced(hex_rows(chunk.rows()))
    lines = hex_rows(chunk.header_rows())
    for child in chunk.parts:
        lines.append('%06x  %s, %d bytes' % (child.offset, child.id, child.size))
    return fenced(lines)


def sums_block(root):
    vers = root.parts[0]
    return fenced([
        'VERS is a leaf: id, size+flags, payload',
        '    crc32c( %s   id' % vers.head.hex(' '),
        '            %s   size+flags: %d bytes, no flags' % (vers.tail.hex(' '), vers.size),
        '            %s ... )   payload, %d bytes' % (vers.payload[:8].hex(' '), vers.size),
        '    = 0x%08x, stored as %s' % (vers.sum, struct.pack('<I', vers.sum).hex(' ')),
        '',
        'HEAD is a container: id, size+flags, the sums of its children as they are stored',
        '    crc32c( %s   id' % root.head.hex(' '),
        '            %s   size+flags: %d bytes, CONTAINER' % (root.tail.hex(' '), root.size),
        '            %s )   sum of VERS' % root.covered.hex(' '),
        '    = 0x%08x, stored as %s' % (root.sum, struct.pack('<I', root.sum).hex(' ')),
        '',
        'the check value of the algorithm: crc32c("123456789") = 0x%08x' % crc32c(b'123456789'),
    ])


def make_block(key, roots):
    kind, _, what = key.partition(' ')
    if kind == 'dump' and what in roots:
        return dump_block(roots[what])
    if kind == 'chunk':
        return chunk_block(roots['every_chunk'], what)
    if key == 'sums':
        return sums_block(roots['smallest'])
    sys.exit('make_bytes: no block is called "%s"' % key)


MARKED = re.compile(r'(<!-- make_bytes: (.+?) -->\n)(.*?)(<!-- end -->)', re.DOTALL)


def make_all():
    """Every file that this script writes: path -> bytes."""
    roots = {}
    made = {}
    for example, make in EXAMPLES.items():
        roots[example] = make()
        roots[example].lay_out(0)
        made[SPEC / 'examples' / (example + '.bendy')] = roots[example].encode()
    for page in sorted(SPEC.glob('**/*.md')):
        before = page.read_text(encoding='utf-8')
        after = MARKED.sub(lambda m: m[1] + '\n'.join(make_block(m[2], roots)) + '\n' + m[4], before)
        if MARKED.search(before):
            made[page] = after.encode('utf-8')
    return made


def main(arguments):
    if arguments not in ([], ['--check']):
        sys.exit(__doc__)
    stale = 0
    for path, content in make_all().items():
        if path.exists() and path.read_bytes() == content:
            continue
        where = path.relative_to(SPEC.parent).as_posix()
        if arguments:
            print('%s is not what spec/make_bytes.py makes' % where)
            stale += 1
        else:
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(content)
            print('wrote ' + where)
    return 1 if stale else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
