"""Which keys of sampled clips go: those that the others give within the tolerance, and no others.

blender -b --factory-startup --python check_thin_keys.py
"""
import math
import os
import sys
from types import SimpleNamespace

import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from posing import check                     # first: it makes the add-on known
from bendy_rig import thin_keys

RATE = 30.0
TIMES = numpy.arange(91) / RATE


class Data:
    """As the exporter's BinaryData."""

    def __init__(self, data):
        self.data = data


def accessor(values, kind):
    values = numpy.array(values, dtype='<f4')
    return SimpleNamespace(buffer_view=Data(values.tobytes()), count=values.size if kind == 'SCALAR' else len(values), type=kind, min=None, max=None)


def node(**values):
    return SimpleNamespace(**{'name': 'joint', 'translation': None, 'rotation': None, 'scale': None, 'weights': None, 'mesh': None, 'children': [], **values})


def animation(*tracks, times=TIMES):
    """tracks: (node, path, values, interpolation)"""
    kinds = {'rotation': 'VEC4', 'weights': 'SCALAR'}
    samplers = [SimpleNamespace(input=accessor(times[:len(values)], 'SCALAR'), output=accessor(values, kinds.get(path, 'VEC3')), interpolation=interpolation)
                for _, path, values, interpolation in tracks]
    return SimpleNamespace(samplers=samplers, channels=[SimpleNamespace(sampler=number, target=SimpleNamespace(node=joint, path=path))
                                                        for number, (joint, path, _, _) in enumerate(tracks)])


def thinned(*tracks):
    """(path, times, values) of each track that is left."""
    made = animation(*tracks)
    thin_keys.thin_animations([made], [SimpleNamespace(nodes=[track[0] for track in tracks])])
    left = []
    for channel in made.channels:
        sampler = made.samplers[channel.sampler]
        times, values = thin_keys.numbers(sampler.input), thin_keys.numbers(sampler.output)
        check(sampler.interpolation == 'CUBICSPLINE' or sampler.input.count == len(times) and sampler.input.max == [times[-1]] and sampler.input.min == [times[0]], 'the accessor')
        check(sampler.output.count == (len(values) if sampler.output.type == 'SCALAR' else len(times)), 'the count of the output')
        left.append((channel.target.path, times, values.reshape(len(times), -1)))
    return left


def frames(track):
    return [round(time * RATE) for time in track[1]]


def turn(angles, axis=(0.0, 0.6, 0.8)):
    return numpy.column_stack([numpy.sin(angles / 2.0)[:, None] * axis, numpy.cos(angles / 2.0)])


def check_linear():
    joint = node(translation=[0.0, 1.0, 0.0])
    line = numpy.outer(TIMES, (1.0, -2.0, 0.5))
    corner = numpy.where(TIMES[:, None] < 1.0, line, 2.0 * line[30] - line)
    for what, values, wanted in (('a line', line, [0, 90]), ('a corner', corner, [0, 30, 90])):
        check(frames(thinned((joint, 'translation', values, 'LINEAR'))[0]) == wanted, what)
    weights = numpy.column_stack([TIMES / 3.0, numpy.maximum(0.0, TIMES - 2.0)])
    check(frames(thinned((node(weights=[0.0, 0.0]), 'weights', weights, 'LINEAR'))[0]) == [0, 60, 90], 'weights')


def check_rotations():
    joint = node()
    slow, fast = turn(TIMES * 0.9), turn(TIMES * 4.0)
    fast[::2] *= -1.0               # the same rotations
    check(frames(thinned((joint, 'rotation', slow, 'LINEAR'))[0]) == [0, 90], 'an even turn')
    keys = frames(thinned((joint, 'rotation', fast, 'LINEAR'))[0])
    check(len(keys) == 6 and max(b - a for a, b in zip(keys, keys[1:])) * 4.0 / RATE < math.pi, f'{keys}: the shorter way between keys is another')


def check_curve():
    """Of a curve, what is left gives every sample within the tolerance; the work is in proportion to the keys."""
    values = numpy.column_stack([numpy.sin(TIMES), numpy.cos(3.0 * TIMES), TIMES ** 2]) * 2e-4
    _, times, left = thinned((node(translation=[1.0, 0.0, 0.0]), 'translation', values, 'LINEAR'))[0]
    off = max(numpy.abs(numpy.interp(TIMES, times, left[:, k]) - values[:, k]).max() for k in range(3))
    check(off < 1.01e-6 and 10 < len(times) < 91, f'{len(times)} keys, {off} off')
    angles = 0.005 * numpy.sin(2.0 * TIMES)
    _, times, left = thinned((node(), 'rotation', turn(angles), 'LINEAR'))[0]
    off = numpy.abs(numpy.interp(TIMES, times, 2.0 * numpy.arctan2(left[:, 2] / 0.8, left[:, 3])) - angles).max()
    check(off < 1.01e-5 and len(times) < 91, f'{len(times)} keys, {off} rad off')
    read = 0
    plain = thin_keys.turns

    def counted(start, rotations):
        nonlocal read
        read += len(rotations)
        return plain(start, rotations)
    thin_keys.turns = counted
    try:
        for count in (2000, 4000):
            read, times = 0, numpy.arange(count) / RATE
            for rotations in (turn(0.1 * times), turn(numpy.sin(times * 50.0))):
                thin_keys.needed_keys(times, rotations, 'rotation', 1e-5)
            check(read < 40 * count, f'{read} rotations were read for {count} keys')
    finally:
        thin_keys.turns = plain


def check_steps():
    joint = node(translation=[0.0, 0.0, 0.0])
    values = numpy.repeat([(0.0, 1.0, 0.0), (0.0, 2.0, 0.0), (0.0, 1.0, 0.0)], (30, 45, 16), axis=0)
    path, _, left = track = thinned((joint, 'translation', values, 'STEP'))[0]
    check(frames(track) == [0, 30, 75, 90] and left[1][1] == 2.0, f'{path} {frames(track)}')


def check_still():
    """A joint that rests needs no track; but the clip stays as long as it is."""
    resting = node(translation=[0.0, 1.0, 0.0], rotation=[0.0, 0.0, 0.6, 0.8], scale=[2.0, 2.0, 2.0])
    still = [(resting, 'translation', numpy.tile((0.0, 1.0, 0.0), (91, 1)), 'LINEAR'), (resting, 'scale', numpy.tile((2.0, 2.0, 2.0), (91, 1)), 'LINEAR'),
             (resting, 'rotation', -numpy.tile((0.0, 0.0, 0.6, 0.8), (91, 1)), 'LINEAR')]
    moving = (resting, 'scale', numpy.tile((1.0, 1.0, 1.0), (91, 1)), 'LINEAR')       # at rest it has another
    left = thinned(*still, moving)
    check([(path, len(times)) for path, times, _ in left] == [('scale', 2)] and left[0][2][0][0] == 1.0, f'{left}')
    left = thinned(*still)
    check([(path, list(times)) for path, times, _ in left] == [('translation', [0.0, 3.0])], f'{left}')
    short = (resting, 'scale', numpy.tile((1.0, 1.0, 1.0), (11, 1)), 'LINEAR')
    check([frames(track) for track in thinned(*still, short)] == [[0, 10], [0, 90]], 'a clip that ends with a track without motion')
    cubic = (resting, 'translation', numpy.zeros((91, 3)), 'CUBICSPLINE')
    check(frames(thinned(cubic)[0]) == list(range(91)), 'a cubic track')


def main():
    for test in (check_linear, check_rotations, check_curve, check_steps, check_still):
        test()
    print('Settings: keys that nothing needs are left out, and no others')


main()
