"""Numbers in glTF extensions: where they are, what they are of, and what goes if that is not there any more.

The table is that of format/extensions/include/bendy/extensions/references.def, which explains its columns; a test compares them. What is
done with it is the same, too, but rows of materials get the order that materials have in the new file.
"""
import re

REFERENCES = (
    ('MSFT_lod', 'node', 'ids[]', 'joint', '', 'entry_or_list'),
    ('MSFT_lod', 'material', 'ids[]', 'material', '', 'entry_or_list'),
    ('VRM', 'root', 'blendShapeMaster.blendShapeGroups[].binds[].index', 'target_of_mesh', 'mesh', 'entry'),
    ('VRM', 'root', 'blendShapeMaster.blendShapeGroups[].binds[].mesh', 'mesh', '', 'entry'),
    ('VRM', 'root', 'firstPerson.firstPersonBone', 'joint', '', 'minus_one'),
    ('VRM', 'root', 'firstPerson.meshAnnotations[].mesh', 'mesh', '', 'entry'),
    ('VRM', 'root', 'humanoid.humanBones[].node', 'joint', '', 'entry'),
    ('VRM', 'root', 'materialProperties[].textureProperties{}', 'texture', '', 'entry'),
    ('VRM', 'root', 'materialProperties[]', 'rows_of_materials', '', 'entry'),
    ('VRM', 'root', 'meta.texture', 'texture', '', 'minus_one'),
    ('VRM', 'root', 'secondaryAnimation.boneGroups[].bones[]', 'joint', '', 'entry'),
    ('VRM', 'root', 'secondaryAnimation.boneGroups[].center', 'joint', '', 'minus_one'),
    ('VRM', 'root', 'secondaryAnimation.colliderGroups[].node', 'joint', '', 'entry'),
    ('VRM', 'root', 'secondaryAnimation.boneGroups[].colliderGroups[]', 'element', 'secondaryAnimation.colliderGroups', 'entry'),
    ('VRMC_node_constraint', 'node', 'constraint.aim.source', 'joint', '', 'all'),
    ('VRMC_node_constraint', 'node', 'constraint.roll.source', 'joint', '', 'all'),
    ('VRMC_node_constraint', 'node', 'constraint.rotation.source', 'joint', '', 'all'),
    ('VRMC_springBone', 'root', 'colliders[].node', 'joint', '', 'entry'),
    ('VRMC_springBone', 'root', 'colliderGroups[].colliders[]', 'element', 'colliders', 'entry_or_list'),
    ('VRMC_springBone', 'root', 'springs[].joints[].node', 'joint', '', 'entry_or_list'),
    ('VRMC_springBone', 'root', 'springs[].center', 'joint', '', 'member'),
    ('VRMC_springBone', 'root', 'springs[].colliderGroups[]', 'element', 'colliderGroups', 'entry'),
    ('VRMC_vrm', 'root', 'expressions.preset{}.morphTargetBinds[].index', 'target_of_joint', 'node', 'entry'),
    ('VRMC_vrm', 'root', 'expressions.preset{}.morphTargetBinds[].node', 'joint', '', 'entry'),
    ('VRMC_vrm', 'root', 'expressions.preset{}.materialColorBinds[].material', 'material', '', 'entry'),
    ('VRMC_vrm', 'root', 'expressions.preset{}.textureTransformBinds[].material', 'material', '', 'entry'),
    ('VRMC_vrm', 'root', 'expressions.custom{}.morphTargetBinds[].index', 'target_of_joint', 'node', 'entry'),
    ('VRMC_vrm', 'root', 'expressions.custom{}.morphTargetBinds[].node', 'joint', '', 'entry'),
    ('VRMC_vrm', 'root', 'expressions.custom{}.materialColorBinds[].material', 'material', '', 'entry'),
    ('VRMC_vrm', 'root', 'expressions.custom{}.textureTransformBinds[].material', 'material', '', 'entry'),
    ('VRMC_vrm', 'root', 'firstPerson.meshAnnotations[].node', 'joint', '', 'entry'),
    ('VRMC_vrm', 'root', 'humanoid.humanBones{}.node', 'joint', '', 'entry'),
    ('VRMC_vrm', 'root', 'meta.thumbnailImage', 'image', '', 'member'),
    ('VRMC_vrm_animation', 'root', 'expressions.custom{}.node', 'joint', '', 'entry'),
    ('VRMC_vrm_animation', 'root', 'expressions.preset{}.node', 'joint', '', 'entry'),
    ('VRMC_vrm_animation', 'root', 'humanoid.humanBones{}.node', 'joint', '', 'entry'),
    ('VRMC_vrm_animation', 'root', 'lookAt.node', 'joint', '', 'member'),
)
GONE = object()                     # in place of a number: the thing is not there


class Renumberer:
    """Renumbers extensions, which are plain JSON, in place."""

    def __init__(self, now):
        """now(thing, number, owner, path) is the new number, or GONE. owner: of a target, the number of its mesh or joint."""
        self.now, self.gone = now, []           # gone: the places of what was taken out

    def renumber(self, host, extensions):
        for name in list(extensions):
            lists = {}
            for reference in REFERENCES:
                if reference[:2] == (name, host) and self.walk(extensions[name], reference, split(reference[2]), name, lists) == 'all':
                    del extensions[name]
                    break
            else:
                if host == 'material' and isinstance(extensions[name], dict):
                    self.textures(extensions[name], name)

    def walk(self, value, reference, path, place, lists):
        """Returns what goes: None, 'member', 'entry' or 'all'."""
        step, rest = path[0], path[1:]
        if step == '[]':
            return self.walk_array(value, reference, rest, place, lists) if isinstance(value, list) else None
        if step == '{}':
            if isinstance(value, dict):
                for name in [name for name in value if self.walk_last(value, name, reference, rest, f'{place}.{name}', lists) == 'entry']:
                    del value[name]
            return None
        if not isinstance(value, dict) or step not in value:
            return None
        fate = self.walk_last(value, step, reference, rest, f'{place}.{step}', lists)
        if fate == 'member':
            del value[step]
            return None
        return fate

    def walk_last(self, owner, key, reference, rest, place, lists):
        """The value of a member or an element: the number, if the path ends there."""
        if rest:
            return self.walk(owner[key], reference, rest, place, lists)
        number = owner[key]
        if number == -1:
            return None
        if isinstance(number, bool) or not isinstance(number, (int, float)) or number != int(number):
            return self.take_out(owner, key, reference, place)
        _, _, path, thing, beside, _ = reference
        if thing == 'element':
            new = lists[beside].get(number, GONE) if beside in lists else number
        else:
            new = self.now(thing, number, owner.get(beside) if beside and isinstance(owner, dict) else None, path)
        if new is GONE:
            return self.take_out(owner, key, reference, place)
        owner[key] = new
        return None

    def take_out(self, owner, key, reference, place):
        self.gone.append(place)
        what = reference[5]
        if what == 'minus_one':
            owner[key] = -1
            return None
        return what if what in ('member', 'all') else 'entry'

    def walk_array(self, array, reference, rest, place, lists):
        if reference[3] == 'rows_of_materials':
            array[:] = self.now('rows_of_materials', array, None, reference[2])
            return None
        stay, numbers, was_empty = [], {}, not array
        for number in range(len(array)):
            fate = self.walk_last(array, number, reference, rest, f'{place}[{number}]', lists)
            if fate == 'all':
                return fate
            if fate is None:
                numbers[number] = len(stay)
                stay.append(array[number])
        array[:] = stay
        lists.setdefault('.'.join(place.split('.')[1:]), numbers)
        is_innermost = not any(step in ('[]', '{}') for step in rest)
        return 'entry' if is_innermost and not stay and not was_empty and reference[5] == 'entry_or_list' else None

    def textures(self, value, place):
        """In a material: the number of each texture."""
        waiting = [(value, place)]
        while waiting:
            value, place = waiting.pop()
            for key, each in list(value.items() if isinstance(value, dict) else enumerate(value)):
                where = f'{place}.{key}'
                if isinstance(each, dict) and str(key).endswith('Texture') and isinstance(each.get('index'), int):
                    each['index'] = self.now('texture', each['index'], None, where)
                    if each['index'] is GONE:
                        self.gone.append(where)
                        del value[key]
                        continue
                if isinstance(each, (dict, list)):
                    waiting.append((each, where))


def split(path):
    """'a.b[].c{}' -> ['a', 'b', '[]', 'c', '{}']"""
    return re.findall(r'[^.\[{]+|\[\]|\{\}', path)


def has_whole_number(value):
    """Whether JSON may name something by its number."""
    waiting = [value]
    while waiting:
        value = waiting.pop()
        if isinstance(value, (dict, list)):
            waiting += value.values() if isinstance(value, dict) else value
        elif isinstance(value, (int, float)) and not isinstance(value, bool) and value == int(value) >= 0:
            return True
    return False


def is_known(name):
    return any(name == reference[0] for reference in REFERENCES)
