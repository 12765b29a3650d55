"""What bones and objects are in the body: the glTF extension BENDY_joint_role (spec/gltf.md) as a custom property."""
from .kept_records import ROLE

EXTENSION = 'BENDY_joint_role'


def keep_role(owner, node):
    """node: of the importer; owner: the pose bone or object that it became."""
    record = (node.extensions or {}).get(EXTENSION)
    if isinstance(record, dict) and isinstance(record.get('role'), str):
        owner[ROLE] = record['role'] + (f':{record["place"]}' if 'place' in record else '')


def add_role(node, owner):
    """node: of the exporter. Returns notes for the report."""
    from io_scene_gltf2.io.com.gltf2_io_extensions import Extension
    if ROLE not in owner:
        return []
    role, separator, place = str(owner[ROLE]).partition(':')
    if not role or (separator and not place.isdecimal()):
        return [(False, f'{ROLE} "{owner[ROLE]}" is neither a word such as leftHand nor one with a place, as tail:2: left out')]
    record = {'role': role, 'place': int(place)} if separator else {'role': role}
    node.extensions = {**(node.extensions or {}), EXTENSION: Extension(EXTENSION, record, False)}
    return []
