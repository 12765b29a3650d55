"""What the program bendy says of a file."""
import json
import subprocess

import addon_utils
import bpy


def enable_addon(bendy):
    addon_utils.enable('bendy_rig', default_set=True)
    bpy.context.preferences.addons['bendy_rig'].preferences.program = bendy


class BendyFile:
    def __init__(self, bendy, path):
        self.bendy, self.path = bendy, path
        self.summary = self.json('inspect', '--json', '--summary', path)['summary']

    def json(self, *arguments):
        return json.loads(subprocess.run([self.bendy, *arguments], capture_output=True, check=True).stdout)

    def pose(self, clip=None, time=0.0):
        options = ['--clip', clip, '--time', repr(time)] if clip else []
        return self.json('pose', self.path, *options, '--format', 'json', '--output', '-')

    def rig(self):
        """The output of `bendy rig`, with names for the numbers of joints that have no name of their own: an export numbers them anew."""
        rig = {'joints': {}, 'chains': [], **self.json('rig', self.path)}
        named = {}
        for key, record in rig['joints'].items():
            named.setdefault(self.joint_name(key), []).append(record)
        rig['joints'] = named
        for chain in rig['chains']:
            chain.update({key: self.joint_name(chain[key]) for key in ('start', 'effector', 'target', 'pole') if key in chain})
        return rig

    def joint_name(self, key):
        return self.summary['joints'][int(key[1:])]['name'] if key.startswith('#') else key

    def clips(self):
        return self.summary['clips']

    def start(self, name):
        return next(clip['start'] for clip in self.clips() if clip['name'] == name)

    def height(self):
        bounds = self.summary['bounds']
        return bounds['max'][1] - bounds['min'][1]

    def targets(self):
        return [name for mesh in self.summary['meshes'] for name in mesh['morphTargets']]

    def names(self, what):
        return [thing['name'] for thing in self.summary[what]]
