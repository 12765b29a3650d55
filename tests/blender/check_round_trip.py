"""Characters that go from .bendy into Blender and back: poses, rigs, markers and names.

blender -b --factory-startup --python check_round_trip.py -- BENDY FOLDER FILE.bendy ...

Blender's poses are compared with those of `bendy pose` at several times of each clip: every joint's place, and every vertex. Then the
character is exported, and the new file is compared with the first in the same way; limits and chains record for record.
"""
import math
import os
import sys

import bpy
from mathutils import Matrix, Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from posing import arguments, check         # first: it makes the add-on known
from bendy_file import BendyFile, enable_addon
from bendy_rig.axes import Y_UP
from blender_pose import joint_places, play, skinned_meshes, vertex_places

TOLERANCE = 1e-4                    # of the character's height
PLACES = (0.0, 0.21, 0.5, 0.83, 1.0)        # of a clip's length


def times_of(clip):
    """At its ends and between."""
    return [clip['start'] + place * clip['seconds'] for place in PLACES]


class Worst:
    def __init__(self, height):
        self.height, self.joint, self.vertex, self.poses = height, 0.0, 0.0, 0

    def add(self, what, name, distance):
        distance /= self.height
        check(distance < TOLERANCE, f'{what}: {name} is {distance:.2e} of the height away')
        return distance

    def compare(self, what, wanted, joints, vertices):
        """wanted: the output of `bendy pose`; joints: name -> places of those of that name; vertices: mesh -> places."""
        for name, places in joint_groups(wanted).items():
            offs = sorted(min((distance(place, other) for other in joints.get(name, [])), default=math.inf) for place in places)
            if name in skinned_meshes():
                offs.pop()          # its bones place it, wherever its own joint is
            for off in offs:
                self.joint = max(self.joint, self.add(what, name, off))
        places = [place for mesh in vertices.values() for place in mesh]
        wanted_places = [mesh['positions'][i:i + 3] for mesh in wanted['meshes'] for i in range(0, len(mesh['positions']), 3)]
        self.vertex = max(self.vertex, self.add(what, 'a vertex', farthest(wanted_places, places)),
                          self.add(what, 'a vertex of Blender', farthest(places, wanted_places)))
        self.poses += 1


def joint_groups(pose):
    """Name -> places of the joints of that name, of the output of `bendy pose`."""
    groups = {}
    for joint in pose['joints']:
        groups.setdefault(joint['name'], []).append(joint['world'][12:15])
    return groups


def distance(a, b):
    return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5


def farthest(points, others):
    """How far the worst point is from the nearest of the others."""
    from mathutils.kdtree import KDTree
    tree = KDTree(max(1, len(others)))
    for i, other in enumerate(others):
        tree.insert(other, i)
    tree.balance()
    return max((tree.find(point)[2] or 0.0 for point in points), default=0.0) if others else (1e9 if points else 0.0)


def is_scaled(file):
    """Bones have no scale at rest, so that the rest pose is another one; the clips are the same."""
    return any(abs(distance(joint['world'][i:i + 3], (0, 0, 0)) - 1) > 1e-3 for joint in file.pose()['joints'] for i in (0, 4, 8))


def compare_with_blender(file):
    worst, rate = Worst(file.height()), bpy.context.scene.render.fps
    play(None, 0.0)
    if not is_scaled(file):
        worst.compare('rest', file.pose(), joint_places(), vertex_places())
    for clip in file.clips():
        for time in times_of(clip):
            play(clip['name'], time * rate)
            worst.compare(f'{clip["name"]} at {time:.4f} s', file.pose(clip['name'], time), joint_places(), vertex_places())
    return worst


def compare_files(first, second, rate):
    """At the frames, which is where an export has keys."""
    worst = Worst(first.height())
    names = [clip['name'] for clip in second.clips()]
    check(names == [clip['name'] for clip in first.clips()], f'clips: {names}')
    poses = [] if is_scaled(first) else [(None, 0.0)]
    for clip in first.clips():
        poses += [(clip['name'], min(max(round(time * rate) / rate, clip['start']), clip['start'] + clip['seconds']))
                  for time in times_of(clip)]
    for name, time in poses:
        pose = second.pose(name, time - (first.start(name) - second.start(name)) if name else 0.0)
        vertices = {mesh['name']: [mesh['positions'][i:i + 3] for i in range(0, len(mesh['positions']), 3)] for mesh in pose['meshes']}
        worst.compare(f'exported: {name or "rest"} at {time:.4f} s', first.pose(name, time), joint_groups(pose), vertices)
    return worst


def compare_tips(file):
    """At rest, the bone with a chain's IK constraint ends where the file has the chain's tip."""
    play(None, 0.0)
    pose, rig = file.pose(), file.json('rig', file.path)
    ends = {constraint.name: tuple((Y_UP @ obj.matrix_world) @ bone.tail) for obj in bpy.data.objects if obj.pose
            for bone in obj.pose.bones for constraint in bone.constraints if constraint.type == 'IK'}
    check(len(ends) == len(rig.get('chains', [])), f'{len(ends)} IK constraints')
    for chain in rig.get('chains', []):
        joint = next(joint for joint in pose['joints'] if joint['name'] == file.joint_name(chain['effector']))
        world = Matrix([joint['world'][row::4] for row in range(4)])
        tip = world @ Vector(chain.get('tip_offset', (0, 0, 0)))
        check(distance(tip, ends[chain['name']]) < TOLERANCE * file.height(), f'{chain["name"]}: {ends[chain["name"]]} is not at {tip}')


def compare_rigs(first, second):
    a, b = first.rig(), second.rig()
    check(a['joints'].keys() == b['joints'].keys(), f'joints with constraints: {sorted(a["joints"].keys() ^ b["joints"].keys())}')
    for name, record in a['joints'].items():
        check(record == b['joints'][name], f'{name}: {record} is now {b["joints"][name]}')
    check([chain['name'] for chain in a['chains']] == [chain['name'] for chain in b['chains']], f'chains: {b["chains"]}')
    for old, new in zip(a['chains'], b['chains']):
        check(old == new, f'{old} is now {new}')
    check(a.get('markers') == b.get('markers'), f'markers {a.get("markers")} are now {b.get("markers")}')
    check(a.get('roles') == b.get('roles'), f'roles {a.get("roles")} are now {b.get("roles")}')
    check(a.get('curves') == b.get('curves'), f'curves {a.get("curves")} are now {b.get("curves")}')
    return len(a['joints']), len(a['chains']), sum(map(len, a.get('markers', {}).values()))


def compare_names(first, second):
    for what, a, b in (('joints', first.names('joints'), second.names('joints')),
                       ('materials', first.names('materials'), second.names('materials')),
                       ('morph targets', first.targets(), second.targets())):
        check(sorted(a) == sorted(b), f'{what}: {a} are now {b}')


def compare_textures(first, second):
    a, b = ([[image['type'] for image in texture['images']] for texture in file.summary['textures']] for file in (first, second))
    check(a == b, f'textures: {a} are now {b}')


def check_file(bendy, folder, path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    enable_addon(bendy)
    first = BendyFile(bendy, path)
    check(bpy.ops.import_scene.bendy(filepath=path) == {'FINISHED'}, f'{path}: not imported')
    imported = compare_with_blender(first)
    if not is_scaled(first):
        compare_tips(first)
    for armature in bpy.data.armatures:
        armature.pose_position = 'POSE'         # Blender exports what it shows
    out = os.path.join(folder, os.path.basename(path))
    check(bpy.ops.export_scene.bendy(filepath=out) == {'FINISHED'}, f'{path}: not exported')
    second = BendyFile(bendy, out)
    exported = compare_files(first, second, bpy.context.scene.render.fps)
    joints, chains, markers = compare_rigs(first, second)
    compare_names(first, second)
    compare_textures(first, second)
    print(f'Round trip of {os.path.basename(path)}: {imported.poses} poses in Blender, joints {imported.joint:.1e}, '
          f'vertices {imported.vertex:.1e} of the height; exported: joints {exported.joint:.1e}, vertices {exported.vertex:.1e}')
    print(f'  - returned: {joints} joints with constraints, {chains} chains, {markers} markers')


def main():
    bendy, folder, *paths = arguments()
    for path in paths:
        check_file(bendy, folder, path)


main()
