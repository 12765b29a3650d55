"""Writes what an import has kept of a glTF file, kept_document.py, into a file that Blender's exporter has written."""
import base64
import copy
import hashlib

from .kept_document import HOSTS, packed_pictures, sources
from .kept_records import DOCUMENTS, MARK, kept
from .references import GONE, Renumberer, has_whole_number, is_known
from .written_file import image_bytes, read_file, write_document

SHOWN = 6                           # places in a note
KINDS = ('nodes', 'meshes', 'materials')
# A row of VRM 0 for a material that has none: drawn as glTF says.
NEW_ROW = {'shader': 'VRM_USE_GLTFSHADER', 'renderQueue': 2000, 'floatProperties': {}, 'vectorProperties': {}, 'textureProperties': {},
           'keywordMap': {}, 'tagMap': {}}


def return_documents(scene, path):
    """Returns notes for the report."""
    document, binary = read_file(path)
    marks = take_marks(document)
    notes, documents = [], kept(scene, DOCUMENTS)
    documents = documents if isinstance(documents, dict) else {}
    for key, record in documents.items():
        before = copy.deepcopy(document)
        returner = Returner(path, document, binary, record, {kind: marks[kind].get(key, {}) for kind in KINDS})
        try:
            returner.put_back()
            notes += returner.notes
        except (AttributeError, IndexError, KeyError, TypeError, ValueError):       # somebody has edited the property
            document = before
            notes.append((False, f'left out, because the property {DOCUMENTS} of the scene is damaged: what the import has kept as {key}'))
    if any(key not in documents for found in marks.values() for key in found):
        notes.append((False, f'left out, because this scene has no {DOCUMENTS} for it: what an import into another scene has kept'))
    if any(marks.values()) or documents:
        write_document(path, document)
    return notes


def take_marks(document):
    """kind -> a file's key -> number in that file -> numbers in this one; takes the marks out of the extras."""
    found = {kind: {} for kind in KINDS}
    for kind in KINDS:
        for number, thing in enumerate(document.get(kind, [])):
            mark = thing.get('extras', {}).pop(MARK, None) if isinstance(thing.get('extras'), dict) else None
            if thing.get('extras') == {}:
                del thing['extras']
            key, _, old = str(mark).rpartition(':')
            if key and old.isdecimal():
                found[kind].setdefault(key, {}).setdefault(int(old), []).append(number)
    return found


DEFAULT_SAMPLER = {'magFilter': 9729, 'minFilter': 9987, 'wrapS': 10497, 'wrapT': 10497}       # as Blender writes it


class Returner:
    def __init__(self, path, document, binary, record, marks):
        self.path, self.document, self.binary, self.record, self.marks = path, document, binary, record, marks
        self.notes, self.textures = [], {}
        self.digests = self.pictures = None     # SHA-256 -> the number of the new file's image; the bytes of Blender's

    def put_back(self):
        if not any(self.marks.values()) and not self.by_name():
            return                  # nothing of that file is exported
        renumberer = Renumberer(self.now)
        for kind in KINDS:
            gone = []
            for number, members in self.record[kind].items():
                new = self.numbers(kind, int(number))
                if not new:
                    gone += [f'{kind[:-1] if kind != "meshes" else "mesh"} {self.name(kind, number)}: {name}' for name in words(members)]
                if new and kind in HOSTS:
                    renumberer.renumber(HOSTS[kind], members.get('extensions', {}))
                for place in new:
                    self.merge(self.document[kind][place], members, f'{kind}[{place}]')
            if gone:
                self.note('left out with what had it', gone)
        renumberer.renumber('root', self.record['root'].get('extensions', {}))
        self.merge(self.document, self.record['root'], '')
        if self.document.get('scenes'):
            self.merge(self.document['scenes'][self.document.get('scene', 0)], self.record['scene'], 'scene')
        if renumberer.gone:
            self.note('left out, because what it names is not there any more', renumberer.gone)
        self.note_unknown()
        self.declare()

    def note(self, text, places):
        more = f' and {len(places) - SHOWN} more' if len(places) > SHOWN else ''
        self.notes.append((False, f'{text}: {", ".join(places[:SHOWN])}{more}'))

    def note_unknown(self):
        hosts = (self.record['root'], *self.record['nodes'].values())
        unknown = dict.fromkeys(name for host in hosts for name, value in host.get('extensions', {}).items()
                                if not is_known(name) and has_whole_number(value))
        if unknown:
            self.note('the meaning of numbers is not known, they are those of the imported file', list(unknown))

    def declare(self):
        things = (self.document, *self.document.get('scenes', []), *(each for kind in (*KINDS, 'textures') for each in self.document.get(kind, [])))
        present = {name for thing in things for name in thing.get('extensions', {})}
        used = self.document.get('extensionsUsed', [])
        added = [name for name in sorted(present | set(self.record['used']) & self.inside()) if name not in used]
        if used or added:
            self.document['extensionsUsed'] = used + added
        required = self.document.get('extensionsRequired', [])
        required += [name for name in self.record['required'] if name in present and name not in required]
        if required:
            self.document['extensionsRequired'] = required

    def inside(self):
        """Names of extensions in extensions, as in a texture info."""
        found, waiting = set(), [self.record[kind] for kind in ('root', *KINDS)] + [self.document.get('textures', [])]
        while waiting:
            value = waiting.pop()
            if isinstance(value, dict):
                found.update(value.get('extensions', {}) if isinstance(value.get('extensions'), dict) else ())
                waiting += value.values()
            elif isinstance(value, list):
                waiting += value
        return found

    def merge(self, thing, members, place):
        """Adds members; what the new file has itself stays."""
        taken = []
        for key, value in members.items():
            if key == 'extensions':
                extensions = thing.setdefault('extensions', {})
                taken += [name for name in value if name in extensions and extensions[name] != value[name]]
                thing['extensions'] = {**value, **extensions}
            elif place == 'scene' and key == 'name':
                thing[key] = value
            elif key in thing and thing[key] != value:
                taken.append(key)
            else:
                thing[key] = value
        if taken:
            self.note('left out, because the file has another one', [f'{place}.{name}'.lstrip('.') for name in taken])
        if thing.get('extensions') == {}:
            del thing['extensions']

    # ------------------------------------------------------------------------------------------------- what numbers mean now

    def numbers(self, kind, old):
        """Of a thing of the imported file in the new one: none if it is gone, several of a material that became several."""
        new = self.marks[kind].get(old, [])
        if kind == 'nodes':
            return [self.best(new, old)] if new else self.by_name().get(old, [])
        return new if kind == 'materials' else new[:1]

    def best(self, new, old):
        """A copy of a bone or an object has its mark, too."""
        wanted = self.record['names'].get(str(old))
        return next((number for number in new if self.document['nodes'][number].get('name') == wanted), new[0])

    def by_name(self):
        """Joints without a mark that have the name that the import gave them: those of a bone that was made anew."""
        if not hasattr(self, 'named'):
            marked = {number for numbers in self.marks['nodes'].values() for number in numbers}
            there = {}
            for number, node in enumerate(self.document.get('nodes', [])):
                if number not in marked:
                    there.setdefault(node.get('name'), number)
            self.named = {int(old): [there[name]] for old, name in self.record['names'].items()
                          if name in there and int(old) not in self.marks['nodes']}
        return self.named

    def name(self, kind, number):
        return self.record['names'].get(number, number) if kind == 'nodes' else number

    def now(self, thing, number, owner, path):
        if thing == 'rows_of_materials':
            return self.rows(number)
        number = int(number)
        if thing == 'texture':
            return self.texture(number)
        if thing == 'image':
            return self.image(number)
        if thing.startswith('target'):
            return self.target(number, owner if thing == 'target_of_mesh' else self.record['meshes_of_nodes'].get(str(owner)))
        kind = {'joint': 'nodes', 'mesh': 'meshes', 'material': 'materials'}[thing]
        new = self.numbers(kind, number)
        if kind == 'nodes' and ('morphTargetBinds' in path or 'meshAnnotations' in path):
            return self.node_of_mesh(number, new)
        return new[0] if new else GONE

    def node_of_mesh(self, old, new):
        """Blender puts a mesh that was at a bone, or is skinned, into an object of its own."""
        mesh = self.numbers('meshes', self.record['meshes_of_nodes'].get(str(old), -1))
        if not mesh:
            return GONE
        having = [number for number, node in enumerate(self.document['nodes']) if node.get('mesh') == mesh[0]]
        return next((number for number in new if number in having), having[0] if having else GONE)

    def target(self, number, mesh):
        """By name; if all targets have other names, by number."""
        new = self.numbers('meshes', mesh) if isinstance(mesh, (int, float)) else []
        if not new:
            return GONE
        before = self.record['targets'].get(str(int(mesh)), [])
        after = self.document['meshes'][new[0]].get('extras', {}).get('targetNames', [])
        if not 0 <= number < len(before):
            return GONE
        if before[number] in after:
            return after.index(before[number])
        return number if len(after) == len(before) and after[number] not in before else GONE

    def rows(self, rows):
        """One element for each material, in the new file's order."""
        old = {new: number for number in range(len(rows)) for new in self.numbers('materials', number)}
        return [copy.deepcopy(rows[old[number]]) if number in old else {'name': material.get('name', ''), **copy.deepcopy(NEW_ROW)}
                for number, material in enumerate(self.document.get('materials', []))]

    # ------------------------------------------------------------------------------------------------- textures

    def texture(self, old):
        """The same texture of the new file, or a new one."""
        if old not in self.textures:
            texture = copy.deepcopy(self.record['textures'].get(str(old), {}))
            for owner in sources(texture):
                owner['source'] = self.image(owner['source'])
                if owner['source'] is GONE:
                    del owner['source']
            self.textures[old] = self.add_texture(texture) if sources(texture) else GONE
        return self.textures[old]

    def add_texture(self, texture):
        sampler = texture.pop('sampler', {})
        textures = self.document.setdefault('textures', [])
        samplers = self.document.setdefault('samplers', [])
        for number, other in enumerate(textures):
            drawn = {**DEFAULT_SAMPLER, **(samplers[other['sampler']] if 'sampler' in other else {})}
            rest = {key: value for key, value in other.items() if key != 'sampler'}
            if drawn == {**DEFAULT_SAMPLER, **sampler} and rest.items() <= texture.items():
                other.update(texture)       # the one that Blender has made of it has no name
                return number
        if sampler:
            if sampler not in samplers:
                samplers.append(sampler)
            texture['sampler'] = samplers.index(sampler)
        if not samplers:
            del self.document['samplers']
        textures.append(texture)
        return len(textures) - 1

    def image(self, old):
        """The image with the same bytes of the new file, or a new one with those that Blender has."""
        record = self.record['images'].get(str(old))
        if record is None:
            return GONE
        images = self.document.setdefault('images', [])
        if self.digests is None:
            read = ((number, image_bytes(self.path, self.document, self.binary, image)) for number, image in enumerate(images))
            self.digests = {hashlib.sha256(data).hexdigest(): number for number, data in read if data}
        digest = record['sha256']
        if digest not in self.digests:
            if self.pictures is None:
                self.pictures = dict(packed_pictures())
            data = self.pictures.get(digest)
            if data is None:
                return GONE
            image = {key: value for key, value in record.items() if key != 'sha256'}
            kind = image.setdefault('mimeType', 'image/png' if data.startswith(b'\x89PNG') else 'image/jpeg')
            images.append({**image, 'uri': f'data:{kind};base64,' + base64.b64encode(data).decode()})
            self.digests[digest] = len(images) - 1
        return self.digests[digest]


def words(members):
    return [*members.get('extensions', {}), *(key for key in members if key != 'extensions')]
