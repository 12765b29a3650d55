"""Where the nodes of a glTF file are. For files without scales, which Blender's armatures without scales give."""
from limits import NO_ROTATION, conjugate, product


class Nodes:
    """By name; rotations are x y z w, positions metres, in the file's space or in that of a node above."""

    def __init__(self, document):
        self.by_name = {node['name']: node for node in document['nodes']}
        self.parent = {document['nodes'][child]['name']: node['name'] for node in document['nodes'] for child in node.get('children', [])}

    def rotation(self, name, above=None):
        if name == above or name is None:
            return NO_ROTATION
        return product(self.rotation(self.parent.get(name), above), tuple(self.by_name[name].get('rotation', NO_ROTATION)))

    def position(self, name, above=None):
        if name == above or name is None:
            return (0.0, 0.0, 0.0)
        parent, own = self.parent.get(name), self.by_name[name].get('translation', (0.0, 0.0, 0.0))
        turn = self.rotation(parent, above)
        turned = product(product(turn, (*own, 0.0)), conjugate(turn))
        return tuple(a + b for a, b in zip(self.position(parent, above), turned))
