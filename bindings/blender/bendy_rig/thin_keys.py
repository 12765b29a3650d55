"""Leaves out the keys of exported clips that nothing needs: Blender's exporter samples every joint at every frame.

A linear key goes if the line between its neighbours passes it within TOLERANCE; a key of a step track, if it repeats the one before. A
track that holds a joint where it rests goes as a whole. The first and the last key of a clip stay.
"""
import copy

import numpy

from . import clip_curves
from .clip_curves import action_curves

# Below what Blender's 32-bit matrices and its interpolation of rotations (clip_curves.EVEN_ANGLE) differ from the file's.
TOLERANCE = {'rotation': 1e-5, 'scale': 1e-5, 'weights': 1e-5}     # radians; factors
PLACE = 1e-6                        # of the largest coordinate of the skeleton, for translations
WIDEST = 3.0                        # radians between two keys: a rotation goes the shorter way round
PATHS = ('translation', 'rotation', 'scale', 'weights')


def thin_animations(animations, scenes):
    """animations, scenes: of the exporter."""
    nodes = all_nodes(scenes)
    size = max((abs(number) for node in nodes for number in node.translation or ()), default=1.0)
    for animation in animations:
        thin(animation, {**TOLERANCE, 'translation': PLACE * max(size, 1e-3)})


def all_nodes(scenes):
    found, waiting = [], [node for scene in scenes for node in scene.nodes]
    while waiting:
        node = waiting.pop()
        found.append(node)
        waiting += node.children or []
    return found


def thin(animation, tolerances):
    kept, still = [], []            # (channel, sampler) that move, and that do not
    for channel in animation.channels:
        sampler, path = copy.copy(animation.samplers[channel.sampler]), channel.target.path
        if path not in PATHS or sampler.interpolation not in ('LINEAR', 'STEP', None):
            kept.append((channel, sampler))
            continue
        times, values = numbers(sampler.input), numbers(sampler.output).reshape(len(numbers(sampler.input)), -1)
        rest = rest_of(channel.target.node, path, values.shape[1])
        if (deviation(values, rest, path) <= tolerances[path]).all():
            still.append((channel, set_keys(sampler, times, values, [0, len(times) - 1])))
            continue
        keys = needed_steps(values, path, tolerances[path]) if sampler.interpolation == 'STEP' else needed_keys(times, values, path, tolerances[path])
        kept.append((channel, set_keys(sampler, times, values, keys)))
    kept += still_to_keep(kept, still)
    animation.samplers = [sampler for _, sampler in kept]
    for number, (channel, _) in enumerate(kept):
        channel.sampler = number
    animation.channels = [channel for channel, _ in kept]


def still_to_keep(kept, still):
    """A clip lasts as long as its keys: of the tracks without motion, those that begin or end it."""
    def ends(pairs):
        inputs = [numbers(sampler.input) for _, sampler in pairs]
        return min(times[0] for times in inputs), max(times[-1] for times in inputs)
    if not still or (kept and ends(kept) == ends(kept + still)):
        return []
    first, last = ends(kept + still)
    early = next((number for number, pair in enumerate(still) if numbers(pair[1].input)[0] == first), None)
    late = next((number for number, pair in enumerate(still) if numbers(pair[1].input)[-1] == last), None)
    return [still[number] for number in dict.fromkeys((early, late)) if number is not None]


def restore_steps(animation, action, rig):
    """The exporter writes sampled bones as linear; those whose curves are all constant keep their steps."""
    curves = {}
    for curve in action_curves(action):
        curves.setdefault(curve.data_path, []).append(curve)
    for channel in animation.channels:
        bone, name = rig.pose.bones.get(channel.target.node.name), clip_curves.COMPONENTS.get(channel.target.path)
        if not bone or not name or not moves_by_curves_alone(bone):
            continue
        own = curves.get(f'{bone.path_from_id()}.{name}')
        if own and all(point.interpolation == 'CONSTANT' for curve in own for point in curve.keyframe_points):
            animation.samplers[channel.sampler].interpolation = 'STEP'


def moves_by_curves_alone(bone):
    return (not any(not constraint.mute for constraint in bone.constraints) and bone.bone.use_inherit_rotation
            and bone.bone.inherit_scale == 'FULL' and bone.bone.use_local_location)


# ------------------------------------------------------------------------------------------------- which keys

def rest_of(node, path, count):
    """What a joint has without a clip."""
    if path == 'weights':
        weights = node.weights or (node.mesh.weights if node.mesh else None) or [0.0] * count
        return numpy.array(weights if len(weights) == count else [0.0] * count)
    return numpy.array(getattr(node, path) or {'translation': (0, 0, 0), 'rotation': (0, 0, 0, 1), 'scale': (1, 1, 1)}[path], dtype=float)


def deviation(values, value, path):
    """How far each value is from one, radians for rotations."""
    if path == 'rotation':
        return numpy.linalg.norm(turns(value, values), axis=1)
    return numpy.abs(values - value).max(axis=1)


def turns(start, rotations):
    """Rotations x y z w, as rotation vectors in radians relative to one of them; each the shorter way."""
    x, y, z, w = start / numpy.linalg.norm(start)
    inverse = numpy.array(((w, z, -y, -x), (-z, w, x, -y), (y, -x, w, -z), (x, y, z, w)))       # of the conjugate, from the left
    relative = rotations @ inverse.T
    relative *= numpy.where(relative[:, 3:] < 0.0, -1.0, 1.0)
    sines = numpy.linalg.norm(relative[:, :3], axis=1)
    angles = 2.0 * numpy.arctan2(sines, relative[:, 3])
    return relative[:, :3] * numpy.where(sines > 1e-12, angles / numpy.maximum(sines, 1e-12), 2.0)[:, None]


def needed_steps(values, path, tolerance):
    """The numbers of the keys that change something, and the last."""
    def held(start, stop):
        return deviation(values[start + 1:stop], values[start], path) <= tolerance
    keys, count = [0], len(values)
    while (step := keys[-1] + how_many(keys[-1], count, held) + 1) < count:
        keys.append(step)
    return keys if keys[-1] == count - 1 else [*keys, count - 1]


def needed_keys(times, values, path, tolerance):
    """The numbers of the keys of a linear track without those that their neighbours' line passes.

    From a key, a line goes to the farthest one for which it passes all between: each key between leaves it a range of slopes.
    """
    if path == 'rotation':
        tolerance /= 3.0 ** 0.5     # of each coordinate of a rotation vector

    def passed(start, stop):
        spans = (times[start + 1:stop] - times[start])[:, None]
        offsets = turns(values[start], values[start + 1:stop]) if path == 'rotation' else values[start + 1:stop] - values[start]
        slopes, width = offsets / spans, tolerance / spans
        low = numpy.maximum.accumulate(slopes - width)
        high = numpy.minimum.accumulate(slopes + width)
        passes = numpy.ones(len(slopes), dtype=bool)
        passes[1:] = ((slopes[1:] >= low[:-1]) & (slopes[1:] <= high[:-1])).all(axis=1)
        if path == 'rotation':
            passes[1:] &= numpy.linalg.norm(offsets[1:], axis=1) < WIDEST
        return passes
    keys, count = [0], len(times)
    while keys[-1] < count - 1:
        keys.append(keys[-1] + how_many(keys[-1], count, passed))
    return keys


def how_many(start, count, holds):
    """For how many keys after one something holds. holds(start, stop): of each key between.

    Few are tried first, and twice as many each time: so the work stays in proportion to the keys.
    """
    block = 16
    while True:
        stop = min(start + block + 1, count)
        failed = (~holds(start, stop)).nonzero()[0]
        if len(failed):
            return int(failed[0])
        if stop == count:
            return count - 1 - start
        block *= 2


# ------------------------------------------------------------------------------------------------- the exporter's data

def numbers(accessor):
    return numpy.frombuffer(accessor.buffer_view.data, dtype='<f4').astype(float)


def set_keys(sampler, times, values, keys):
    keys = list(dict.fromkeys(keys))
    sampler.input = with_data(sampler.input, times[keys], 1)
    sampler.input.min, sampler.input.max = [float(times[keys[0]])], [float(times[keys[-1]])]
    rows = values.shape[1] if sampler.output.type == 'SCALAR' else 1       # weights: a number for each target
    sampler.output = with_data(sampler.output, values[keys], rows)
    return sampler


def with_data(accessor, data, rows):
    made = copy.copy(accessor)
    made.buffer_view = type(accessor.buffer_view)(data.astype('<f4').tobytes())
    made.count = len(data) * rows
    return made
