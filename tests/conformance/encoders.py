"""Encodes payloads as spec/codecs.md says, the plain way: made to be right, not small."""

import struct


def zstd(data, magic=True, most=1 << 17):
    """One zstd frame (RFC 8878) that states its content's size: blocks of one repeated byte, and blocks as they are."""
    frame = bytearray(b'\x28\xb5\x2f\xfd' if magic else b'')
    frame += struct.pack('<BI', 0xA0, len(data))  # single segment, size in 4 bytes
    blocks = []
    at = 0
    while at < len(data):
        run = 1
        while at + run < len(data) and data[at + run] == data[at] and run < most:
            run += 1
        if run >= 64:
            blocks.append((1, run, data[at:at + 1]))
        else:
            run = 1
            if blocks and blocks[-1][0] == 0 and blocks[-1][1] < most:
                _, size, old = blocks.pop()
                blocks.append((0, size + 1, old + data[at:at + 1]))
            else:
                blocks.append((0, 1, data[at:at + 1]))
        at += run
    blocks = blocks or [(0, 0, b'')]
    for place, (kind, size, content) in enumerate(blocks):
        last = place == len(blocks) - 1
        frame += struct.pack('<I', last | kind << 1 | size << 3)[:3] + content
    return bytes(frame)


def to_planes(data, stride):
    if stride < 2:
        return data
    count = len(data) // stride
    planes = bytes(data[k * stride + b] for b in range(stride) for k in range(count))
    return planes + data[count * stride:]


def zigzag(byte):
    """Of the difference of two bytes, modulo 256."""
    signed = byte - 256 if byte > 127 else byte
    return (signed << 1 ^ (-1 if signed < 0 else 0)) & 0xFF


def vertices(rows, stride):
    """meshoptimizer's vertex format, version 0."""
    wide = (stride + 3) // 4 * 4
    table = [rows[at:at + stride] + bytes(wide - stride) for at in range(0, len(rows), stride)]
    out = bytearray(b'\xa0')
    before = table[0] if table else bytes(wide)
    first = before
    at_once = min(8192 // wide // 16 * 16, 256)
    for start in range(0, len(table), at_once):
        block = table[start:start + at_once]
        for b in range(wide):
            column = bytes(zigzag((row[b] - last[b]) & 0xFF) for last, row in zip([before, *block], block))
            column += bytes(-len(column) % 16)
            groups = [byte_group(column[at:at + 16]) for at in range(0, len(column), 16)]
            header = bytearray((len(groups) + 3) // 4)
            for k, (bits, _) in enumerate(groups):
                header[k // 4] |= bits << (k % 4 * 2)
            out += header + b''.join(data for _, data in groups)
        before = block[-1]
    return bytes(out) + first.rjust(32, b'\0') if wide < 32 else bytes(out) + first


def byte_group(values):
    """16 values: (the two bits that say how they lie, their bytes)."""
    if not any(values):
        return 0, b''
    choices = [(3, values)]
    for bits, width in ((1, 2), (2, 4)):
        escape = (1 << width) - 1
        packed = bytearray()
        per_byte = 8 // width
        for at in range(0, 16, per_byte):
            byte = 0
            for value in values[at:at + per_byte]:
                byte = byte << width | min(value, escape)
            packed.append(byte)
        packed += bytes(value for value in values if value >= escape)
        choices.append((bits, bytes(packed)))
    return min(choices, key=lambda choice: len(choice[1]))


def triangles(indices):
    """meshoptimizer's index format, version 1, of triangles whose vertices all are new: 0 1 2, 3 4 5, ..."""
    if indices != list(range(len(indices))):
        raise ValueError('these triangles need more of the format than is written here')
    return b'\xe1' + b'\xf0' * (len(indices) // 3) + bytes(16)


# Of PACK's lists: numbers of a track, whether it is animated, path.
LISTS = ((3, 0, 0), (3, 1, 0), (3, 0, 1), (3, 1, 1), (1, 0, 2), (1, 1, 2), (3, 0, 2), (3, 1, 2))


def clip(payload):
    """Codec 6's plain form of a payload with one segment and bases of 2 bytes; predictor 0 throughout."""
    frames, _, rate, joints, segment, lists, wide = struct.unpack_from('<IffHHBB', payload)
    if segment or wide:
        raise ValueError('one segment, narrow bases')
    at = 20
    tracks = []
    for k, (numbers, animated, path) in enumerate(LISTS):
        if lists >> k & 1:
            bits = payload[at:at + (joints + 7) // 8]
            count = sum(bin(byte).count('1') for byte in bits)
            tracks.append((numbers, animated, path, count))
            at += len(bits)
    plain = bytearray(payload[:at])
    steps = {}
    for place, (numbers, _, _, count) in enumerate(tracks):
        steps[place] = payload[at:at + numbers * count]
        at += numbers * count
    constants, firsts, heads, planes = [], [], bytearray(), []
    for place, (numbers, animated, _, count) in enumerate(tracks):
        if not animated:
            bases = struct.unpack_from('<%dh' % (numbers * count), payload, at)
            constants += [bases[c * count + t] for t in range(count) for c in range(numbers)]
            at += 2 * numbers * count
    if rate == 0:
        plain += payload[at:at + 4 * frames]
        at += 4 * frames
    widths, bases = {}, {}
    for place, (numbers, animated, _, count) in enumerate(tracks):
        if animated:
            widths[place] = payload[at:at + numbers * count]
            at += numbers * count
            bases[place] = struct.unpack_from('<%dh' % (numbers * count), payload, at)
            at += 2 * numbers * count
    values = {}
    for frame in range(frames if widths else 0):
        bit = at * 8
        for place, (numbers, animated, _, count) in enumerate(tracks):
            if not animated:
                continue
            for start in range(0, count, 8):
                for c in range(numbers):
                    for t in range(start, min(start + 8, count)):
                        width = widths[place][c * count + t]
                        word = int.from_bytes(payload[bit // 8:bit // 8 + 5], 'little') >> bit % 8 & (1 << width) - 1
                        values.setdefault((place, t, c), []).append(bases[place][c * count + t] + word)
                        bit += width
        at = (bit + 7) // 8
    last = {}
    for place, (numbers, _, path, count) in enumerate(tracks):
        for t in range(count):
            for c in range(numbers):
                step = steps[place][c * count + t]
                plain.append((step - last.get(path, 160)) & 0xFF)
                last[path] = step
    for place, (numbers, animated, _, count) in enumerate(tracks):
        for t in range(count if animated else 0):
            for c in range(numbers):
                samples = values[place, t, c]
                firsts.append(samples[0])
                residuals = [signed_zigzag(b - a) for a, b in zip(samples, samples[1:])]
                depth = max(1, (max(residuals).bit_length() + 7) // 8)
                heads.append(depth << 2)
                planes.append((depth, residuals))
    plain += number_table(constants) + number_table(firsts) + heads
    for plane in range(4):
        for depth, residuals in planes:
            if depth > plane:
                plain += bytes(residual >> 8 * plane & 0xFF for residual in residuals)
    return struct.pack('<I', len(plain)) + zstd(bytes(plain), magic=False)


def signed_zigzag(value):
    return 2 * value if value >= 0 else -2 * value - 1


def number_table(values):
    codes = [signed_zigzag(value) for value in values]
    depth = (max(codes, default=0).bit_length() + 7) // 8
    return bytes([depth]) + bytes(code >> 8 * plane & 0xFF for plane in range(depth) for code in codes)


def sums(rows, stride):
    out = bytearray()
    for at in range(0, len(rows), stride):
        row = list(struct.unpack_from('<%dH' % (stride // 2), rows, at))
        row[0] = sum(row) & 0xFFFF
        out += struct.pack('<%dH' % len(row), *row)
    return to_planes(bytes(out), stride)


CODECS = {'zstd': 1, 'vertices': 2, 'vertices_zstd': 3, 'indices': 4, 'indices_zstd': 5, 'clip': 6, 'sums': 7}


def encode(name, payload, head=0, stride=0, size=None, reserved=0, most=1 << 17):
    """(codec's number, the encoded payload with its start). `size` and `reserved` can be told wrongly."""
    rest = payload[head:]
    if name == 'zstd':
        body = zstd(to_planes(payload, stride), most=most)
    elif name.startswith('vertices'):
        body = vertices(rest, stride)
    elif name.startswith('indices'):
        body = triangles(list(struct.unpack('<%d%s' % (len(rest) // stride, 'H' if stride == 2 else 'I'), rest)))
    elif name == 'sums':
        body = zstd(sums(rest, stride))
    else:
        body = clip(payload)
    if name.endswith('_zstd'):
        body = zstd(body)
    start = struct.pack('<QHHI', len(payload) if size is None else size, head, stride, reserved)
    return CODECS[name], start + (payload[:head] if CODECS[name] not in (1, 6) else b'') + body
