"""Checks that a glTF file contains what the add-on put there."""
import json
import struct

from .joint_limits import says_a_limit


def read_document(path):
    """The JSON of a .glb or .gltf file."""
    with open(path, 'rb') as file:
        if file.read(4) != b'glTF':
            file.seek(0)
            return json.loads(file.read().decode('utf-8'))
        file.seek(12)
        length, _ = struct.unpack('<2I', file.read(8))
        return json.loads(file.read(length).decode('utf-8'))


def count_records(document):
    """(joints with limits, chains) in a glTF document."""
    nodes, scenes = document.get('nodes', []), document.get('scenes', [])
    joints = [node for node in nodes if says_a_limit(node.get('extras', {}).get('rig_joint'))]
    rigs = [owner['extras']['rig_ik'] for owner in nodes + scenes if 'rig_ik' in owner.get('extras', {})]
    return len(joints), sum(len(rig['chains']) for rig in rigs)
