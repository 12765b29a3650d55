"""Corrects the curves of imported clips where Blender's glTF importer plays a clip differently from glTF and Bendy.

It places keys by the scene's frame rate and ignores the tangents of cubic keys. Blender interpolates the four components of a
quaternion, whereas a linear track turns about one axis at constant speed.
"""
import math

import bpy

RATES = (24, 30, 60, 25, 50, 48, 120, 100)      # frames a second
ON_FRAME = 1e-3                                 # distance in frames between a key and its frame
EVEN_ANGLE = 0.15                               # radians between two keys; below it both interpolations agree to 7e-6
COMPONENTS = {'translation': 'location', 'rotation': 'rotation_quaternion', 'scale': 'scale'}


def action_curves(action):
    """The curves of an action; in a layered action (Blender 4.4 and later), those of all slots."""
    if hasattr(action, 'fcurves'):
        return list(action.fcurves)
    return [curve for layer in action.layers for strip in layer.strips for bag in strip.channelbags for curve in bag.fcurves]


def curves_to_add_to(action):
    if hasattr(action, 'fcurves'):
        return action.fcurves
    return action.layers[0].strips[0].channelbags[0].fcurves


# ------------------------------------------------------------------------------------------------- the frame rate

def fitting_rate(times, current):
    """The frame rate that puts all times, in seconds, on frames: the current one, a usual one, or None."""
    return next((rate for rate in (current, *RATES) if all(is_on_frame(time * rate) for time in times)), None)


def is_on_frame(frame):
    return abs(frame - round(frame)) < ON_FRAME


def put_on_frames(curves):
    """Moves keys that rounding put beside a frame onto it: the exporter samples whole frames from the first key on."""
    for curve in curves:
        numbers = key_numbers(curve, 'co')
        for at in range(0, len(numbers), 2):
            if is_on_frame(numbers[at]):
                numbers[at] = round(numbers[at])
        curve.keyframe_points.foreach_set('co', numbers)
        curve.update()


def key_numbers(curve, name):
    count = len(curve.keyframe_points)
    numbers = [0.0] * (2 * count if name == 'co' else count)
    curve.keyframe_points.foreach_get(name, numbers)
    return numbers


# ------------------------------------------------------------------------------------------------- linear rotations

def turn_evenly(action):
    """Adds keys between two rotation keys that are far apart."""
    for curves in rotations(action):
        points = curves[0].keyframe_points
        if any(point.interpolation != 'LINEAR' for point in points):
            continue
        frames = key_numbers(curves[0], 'co')[::2]
        values = list(zip(*(key_numbers(curve, 'co')[1::2] for curve in curves)))
        keys = with_keys_between(frames, values)
        if len(keys) > len(frames):
            write_keys(curves, keys)


def rotations(action):
    """The four curves of each quaternion."""
    found = {}
    for curve in action_curves(action):
        if curve.data_path.endswith('rotation_quaternion'):
            found.setdefault(curve.data_path, {})[curve.array_index] = curve
    return [[curves[i] for i in range(4)] for curves in found.values() if len(curves) == 4]


def with_keys_between(frames, values):
    """Times at whole frames, and more where a rotation is fast."""
    keys = [(frames[0], values[0])]
    for start, end, a, b in zip(frames, frames[1:], values, values[1:]):
        if angle(a, b) > EVEN_ANGLE:
            stops = [start, *range(math.floor(start) + 1, math.ceil(end)), end]
            for low, high in zip(stops, stops[1:]):
                parts = math.ceil(angle(a, b) * (high - low) / (end - start) / EVEN_ANGLE)
                places = [low + (high - low) * part / parts for part in range(parts)]
                keys += [(place, between(a, b, (place - start) / (end - start))) for place in places if place > start]
        keys.append((end, b))
    return keys


def angle(a, b):
    """The angle between two rotations in radians, in the direction of b - a."""
    return 4.0 * math.asin(min(1.0, math.dist(a, b) / 2.0))


def between(a, b, share):
    half = angle(a, b) / 2.0
    return [(math.sin((1.0 - share) * half) * x + math.sin(share * half) * y) / math.sin(half) for x, y in zip(a, b)]


def write_keys(curves, keys):
    for component, curve in enumerate(curves):
        points = curve.keyframe_points
        kind = points[0].bl_rna.properties['interpolation'].enum_items['LINEAR'].value
        points.add(len(keys) - len(points))
        points.foreach_set('co', [number for frame, value in keys for number in (frame, value[component])])
        points.foreach_set('interpolation', [kind] * len(keys))
        curve.update()


# ------------------------------------------------------------------------------------------------- what a clip does not move

def complete(actions, rest):
    """Gives each action of one owner a key for what only others move, and for bones that are not at rest where Blender's are.

    Blender would leave it where the last clip has put it. actions: those of all clips; rest: data path -> values.
    """
    moving = {curve.data_path for action in actions for curve in action_curves(action)}
    paths = [path for path in rest if path in moving or (path.startswith('pose.') and not is_identity(path, rest[path]))]
    for action in actions:
        own, first = {curve.data_path for curve in action_curves(action)}, action.frame_range[0]
        for path in paths:
            if path not in own:
                for index, value in enumerate(rest[path]):
                    curves_to_add_to(action).new(path, index=index).keyframe_points.insert(first, value)


def at_rest(action, name, first, rest):
    """A copy of an owner's action that holds what it moves at rest. first: the frame of its only key; rest: data path -> values."""
    still = action.copy()
    still.name = name
    for key in list(still.keys()):
        del still[key]
    while still.pose_markers:
        still.pose_markers.remove(still.pose_markers[0])
    for curve in action_curves(still):
        points = curve.keyframe_points
        while len(points) > 1:
            points.remove(points[-1], fast=True)
        points[0].co = (first, rest[curve.data_path][curve.array_index] if curve.data_path in rest else points[0].co.y)
        curve.update()
    return still


def is_identity(path, values):
    wanted = {'scale': (1.0, 1.0, 1.0), 'location': (0.0, 0.0, 0.0)}.get(path.rsplit('.', 1)[-1], (1.0, 0.0, 0.0, 0.0))
    return math.dist(values, wanted) < 1e-5


# ------------------------------------------------------------------------------------------------- cubic keys

def set_tangents(gltf, animation, vnode, path, channel, action):
    """Sets a cubic track's handles: with handles a third of the way to the next key, a Bezier curve is the same cubic."""
    sampler = animation.samplers[channel.sampler]
    if sampler.interpolation != 'CUBICSPLINE' or path not in COMPONENTS:
        return
    to_curve = conversion(gltf, vnode, path)
    values = [to_curve(value) for value in read_accessor(gltf, sampler.output)]
    times = [time for time, in read_accessor(gltf, sampler.input)]
    target = COMPONENTS[path]
    is_bone = getattr(vnode, 'blender_bone_name', None) is not None
    place = f'pose.bones["{bpy.utils.escape_identifier(vnode.blender_bone_name)}"].{target}' if is_bone else target
    for curve in action_curves(action):
        if curve.data_path == place:
            component = curve.array_index
            # The importer has negated some keys to the near side, and the tangents still belong to the original signs.
            own = [value[component] for value in values[1::3]] if path == 'rotation' else None
            set_handles(curve, times, [v[component] for v in values[0::3]], [v[component] for v in values[2::3]], own)


def conversion(gltf, vnode, path):
    """The importer's conversion of a value without the constant part, since tangents are differences."""
    edit = vnode.editbone_rot.conjugated() if getattr(vnode, 'blender_bone_name', None) is not None else None
    if path == 'translation':
        turn = edit.to_matrix() @ vnode.rotation_after.to_matrix() if edit else vnode.rotation_after.to_matrix()
        return lambda value: turn @ gltf.loc_gltf_to_blender(value)
    if path == 'rotation':
        before = edit @ vnode.rotation_after if edit else vnode.rotation_after
        return lambda value: before @ gltf.quaternion_gltf_to_blender(value) @ vnode.rotation_before
    return lambda value: vnode.base_scales_to_final_scales([gltf.scale_gltf_to_blender(value)])[0]


def set_weight_tangents(gltf, vnode, animation, clip, action):
    """The same for the weights of morph targets, where a key has several numbers."""
    node = gltf.data.nodes[vnode.mesh_node_idx]
    names = gltf.data.meshes[node.mesh].shapekey_names
    for number in node.animations.get(clip, []):
        channel = animation.channels[number]
        sampler = animation.samplers[channel.sampler]
        if channel.target.path != 'weights' or sampler.interpolation != 'CUBICSPLINE':
            continue
        values = [value for value, in read_accessor(gltf, sampler.output)]
        times = [time for time, in read_accessor(gltf, sampler.input)]
        for target, name in enumerate(names):
            place = f'key_blocks["{bpy.utils.escape_identifier(name or "")}"].value'
            for curve in action_curves(action):
                if curve.data_path == place:
                    set_handles(curve, times, values[target::3 * len(names)], values[target + 2 * len(names)::3 * len(names)], None)


def set_handles(curve, times, tangents_in, tangents_out, values):
    """times: seconds; tangents: units per second; values: of the keys, or None to keep the current ones."""
    points = curve.keyframe_points
    last = len(points) - 1
    for i, point in enumerate(points):
        if values:
            point.co.y = values[i]
        point.handle_left_type = point.handle_right_type = 'FREE'
        for handle, other, tangent in ((point.handle_left, max(i - 1, 0), tangents_in[i]),
                                       (point.handle_right, min(i + 1, last), tangents_out[i])):
            handle.x = point.co.x + (points[other].co.x - point.co.x) / 3.0
            handle.y = point.co.y + (times[other] - times[i]) * tangent / 3.0


def read_accessor(gltf, accessor):
    from io_scene_gltf2.io.imp.gltf2_io_binary import BinaryData
    return BinaryData.get_data_from_accessor(gltf, accessor)
