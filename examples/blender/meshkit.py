"""Skinned meshes from tubes: positions, texture coordinates and weights in one pass.

Space: Blender's world, metres, Z up, characters face -Y and have their left at +X.
"""
import math
from typing import NamedTuple

import bpy
from mathutils import Vector


class Section(NamedTuple):
    """One ring of a tube. The tube runs towards side x up."""
    center: Vector
    side: Vector            # unit
    up: Vector              # unit
    side_radius: float
    up_radius: float        # towards +up
    down_radius: float      # towards -up
    weights: dict           # joint name -> weight, sum 1


def smoothstep(low, high, x):
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3.0 - 2.0 * t)


def interpolate(table, x):
    """Smooth curve through the rows (x, value, ...) of table, ascending in x; the ends are held."""
    if x <= table[0][0]:
        return list(table[0][1:])
    if x >= table[-1][0]:
        return list(table[-1][1:])

    def slope(row, column):
        before, after = table[max(row - 1, 0)], table[min(row + 1, len(table) - 1)]
        return (after[column] - before[column]) / (after[0] - before[0])

    i = next(k for k in range(len(table) - 1) if x < table[k + 1][0])
    a, b = table[i], table[i + 1]
    span = b[0] - a[0]
    t = (x - a[0]) / span
    return [(2 * t**3 - 3 * t**2 + 1) * a[c] + (t**3 - 2 * t**2 + t) * span * slope(i, c)
            + (3 * t**2 - 2 * t**3) * b[c] + (t**3 - t**2) * span * slope(i + 1, c)
            for c in range(1, len(a))]


def chain_weights(chain, distance):
    """Soft weights along a chain of rows (joint, distance at which it starts, half width of the blend there)."""
    reached = [1.0] + [smoothstep(start - half, start + half, distance) for _, start, half in chain[1:]] + [0.0]
    shares = ((row[0], reached[i] - reached[i + 1]) for i, row in enumerate(chain))
    return {joint: share for joint, share in shares if share > 1e-5}


def along(points, distance):
    """The point at a distance along a polyline; beyond its ends, the ends' directions go on."""
    for i, (a, b) in enumerate(zip(points, points[1:])):
        length = (b - a).length
        if distance <= length or i == len(points) - 2:
            return a + (b - a) * (distance / length)
        distance -= length


class MeshBuilder:
    """Collects parts of one mesh; build() makes the Blender object."""

    def __init__(self):
        self.positions, self.weights = [], []
        self.faces, self.face_uvs, self.face_materials = [], [], []

    def _vertex(self, position, weights):
        self.positions.append(Vector(position))
        self.weights.append(dict(weights))
        return len(self.positions) - 1

    def _face(self, corners, uvs, material):
        self.faces.append(tuple(corners))
        self.face_uvs.append(tuple(uvs))
        self.face_materials.append(material)

    def tube(self, sections, segments, material=0, uv_repeat=(1.0, 1.0)):
        """A closed tube: the first and the last section are its poles, of which only the centre counts.

        material: a slot number, or one per band between two sections. Returns the range of the new vertices.
        """
        first = len(self.positions)
        rings = []
        for s in sections[1:-1]:
            ring = []
            for k in range(segments):
                angle = 2 * math.pi * k / segments
                height = math.sin(angle) * (s.up_radius if math.sin(angle) > 0 else s.down_radius)
                ring.append(self._vertex(s.center + s.side * (math.cos(angle) * s.side_radius) + s.up * height, s.weights))
            rings.append(ring)
        start = self._vertex(sections[0].center, sections[0].weights)
        end = self._vertex(sections[-1].center, sections[-1].weights)

        lengths = [0.0]
        for a, b in zip(sections, sections[1:]):
            lengths.append(lengths[-1] + (b.center - a.center).length)
        u = [uv_repeat[0] * k / segments for k in range(segments + 1)]
        v = [uv_repeat[1] * length / lengths[-1] for length in lengths]
        slot = (lambda band: material) if isinstance(material, int) else (lambda band: material[band])
        for k in range(segments):
            k2, middle = (k + 1) % segments, uv_repeat[0] / 2
            self._face((start, rings[0][k2], rings[0][k]), ((middle, v[0]), (u[k + 1], v[1]), (u[k], v[1])), slot(0))
            for i, (low, high) in enumerate(zip(rings, rings[1:])):
                self._face((low[k], low[k2], high[k2], high[k]),
                           ((u[k], v[i + 1]), (u[k + 1], v[i + 1]), (u[k + 1], v[i + 2]), (u[k], v[i + 2])), slot(i + 1))
            self._face((end, rings[-1][k], rings[-1][k2]), ((middle, v[-1]), (u[k], v[-2]), (u[k + 1], v[-2])), slot(len(rings)))
        return range(first, len(self.positions))

    def limb(self, path, side, up, profile, chain, caps, rings, segments, material=0):
        """A tube along a polyline with round ends.

        profile: rows (distance, side radius, up radius, down radius); its last distance is the length.
        chain:   the rows that chain_weights() takes, or a function: distance -> weights.
        caps:    length of the rounding at the start and at the end.
        """
        side, up = Vector(side).normalized(), Vector(up).normalized()
        path = [Vector(p) for p in path]
        length, (start_cap, end_cap) = profile[-1][0], caps
        steps = (0.0, 0.13, 0.5)                # of a cap: its pole, 30 and 60 degrees
        distances = [start_cap * s for s in steps]
        distances += [start_cap + (length - start_cap - end_cap) * i / (rings - 1) for i in range(rings)]
        distances += [length - end_cap * s for s in reversed(steps)]
        sections = []
        for d in distances:
            into_cap = max(0.0, 1 - d / start_cap, 1 - (length - d) / end_cap)
            rounding = math.sqrt(max(0.0, 1 - into_cap**2))
            radii = [r * rounding for r in interpolate(profile, d)]
            weights = chain(d) if callable(chain) else chain_weights(chain, d)
            sections.append(Section(along(path, d), side, up, *radii, weights))
        girth = 2 * math.pi * max(row[1] for row in profile)
        return self.tube(sections, segments, material, (max(1, round(girth / 0.25)), length / 0.4))

    def ellipsoid(self, center, radii, joint, rings, segments, material=0):
        """An ellipsoid whose bands go from its pole at the back to its pole in front; radii along X, Y, Z."""
        center = Vector(center)
        sections = []
        for i in range(rings + 1):
            angle = math.pi * i / rings
            sections.append(Section(center + Vector((0, radii[1] * math.cos(angle), 0)), Vector((1, 0, 0)), Vector((0, 0, 1)),
                                    radii[0] * math.sin(angle), radii[2] * math.sin(angle), radii[2] * math.sin(angle), {joint: 1.0}))
        return self.tube(sections, segments, material)

    def grid(self, rows, joint, material=0):
        """An open surface over rows of points. It is seen from where rows run right and columns run up."""
        first = len(self.positions)
        indices = [[self._vertex(p, {joint: 1.0}) for p in row] for row in rows]

        def uv(row, column):
            return column / (len(rows[0]) - 1), row / (len(rows) - 1)

        for r, (low, high) in enumerate(zip(indices, indices[1:])):
            for c in range(len(low) - 1):
                self._face((low[c], low[c + 1], high[c + 1], high[c]),
                           (uv(r, c), uv(r, c + 1), uv(r + 1, c + 1), uv(r + 1, c)), material)
        return range(first, len(self.positions))

    def mirror(self):
        """Adds everything once more on the other side of X = 0, Left and Right in joint names exchanged."""
        count, faces = len(self.positions), len(self.faces)
        for i in range(count):
            p = self.positions[i]
            self._vertex((-p.x, p.y, p.z), {other_side(joint): w for joint, w in self.weights[i].items()})
        for i in range(faces):
            self._face([c + count for c in reversed(self.faces[i])], reversed(self.face_uvs[i]), self.face_materials[i])

    def append(self, other):
        """Adds another builder's parts. Returns the range of the new vertices."""
        offset = len(self.positions)
        self.positions += other.positions
        self.weights += other.weights
        self.faces += [tuple(c + offset for c in face) for face in other.faces]
        self.face_uvs += other.face_uvs
        self.face_materials += other.face_materials
        return range(offset, len(self.positions))

    def build(self, name, armature, materials):
        """The mesh object, skinned to the armature object. Keeps the order of the vertices."""
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata([tuple(p) for p in self.positions], [], self.faces)
        for m in materials:
            mesh.materials.append(m)
        uv_layer = mesh.uv_layers.new(name='UVMap')
        for polygon, uvs, material in zip(mesh.polygons, self.face_uvs, self.face_materials):
            polygon.use_smooth, polygon.material_index = True, material
            for loop, uv in zip(polygon.loop_indices, uvs):
                uv_layer.data[loop].uv = uv
        mesh.update()
        obj = bpy.data.objects.new(name, mesh)
        bpy.context.scene.collection.objects.link(obj)
        for bone in armature.data.bones:
            if any(bone.name in w for w in self.weights):
                obj.vertex_groups.new(name=bone.name)
        for i, weights in enumerate(self.weights):
            for joint, weight in weights.items():
                obj.vertex_groups[joint].add([i], weight, 'REPLACE')
        obj.parent = armature
        obj.modifiers.new('Armature', 'ARMATURE').object = armature
        return obj


def other_side(name):
    """LeftArm <-> RightArm; a name without a side stays."""
    if 'Left' in name:
        return name.replace('Left', 'Right')
    return name.replace('Right', 'Left')


def texture(name, width, height, colour):
    """A packed image, so that it is embedded as PNG. colour: function of (x, y) in pixels -> (r, g, b), each 0 to 1, sRGB."""
    image = bpy.data.images.new(name, width, height, alpha=False)
    image.pixels = [channel for y in range(height) for x in range(width) for channel in (*colour(x, y), 1.0)]
    image.pack()
    return image


def material(name, colour=(1.0, 1.0, 1.0), roughness=0.6, image=None):
    """A metallic-roughness material: base colour (linear r, g, b) or base colour texture; no metal; one-sided."""
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    m.use_backface_culling = True
    surface = m.node_tree.nodes['Principled BSDF']
    surface.inputs['Base Color'].default_value = (*colour, 1.0)
    surface.inputs['Roughness'].default_value = roughness
    surface.inputs['Metallic'].default_value = 0.0
    if image:
        node = m.node_tree.nodes.new('ShaderNodeTexImage')
        node.image = image
        m.node_tree.links.new(node.outputs['Color'], surface.inputs['Base Color'])
    return m
