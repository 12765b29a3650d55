"""Numbers as written to the file."""
import struct


def shortest(value):
    """The shortest decimal that reads back to the same 32-bit float, which is Blender's precision; never -0."""
    wanted = as_float32(value)
    for digits in range(6, 10):
        short = float(f'{value:.{digits}g}')
        if as_float32(short) == wanted:
            break
    return short + 0.0


def as_float32(value):
    return struct.unpack('f', struct.pack('f', value))[0]


def shortest_list(values):
    return [shortest(v) for v in values]


def quaternion_xyzw(q):
    return shortest_list((q.x, q.y, q.z, q.w))
