"""Bendy: animated characters in one file. docs/python.md is the guide.

    import bendy

    model = bendy.open("fox.bendy")                    # or fox.glb, converted in memory
    positions = model.sample("Run", 0.35).skin()       # (N, 3) float32, metres
    bendy.convert("fox.glb", "fox.bendy", lod=True)    # the warnings are in the result
    bendy.validate("fox.bendy")                        # a list of faults
    bendy.inspect("fox.bendy")["OBJE/SKIN"].fields     # the chunk tree

A source is a path, bytes, or what convert, edit and open return. Lengths are metres, angles radians (of cameras degrees), times
seconds; Y is up; quaternions are x, y, z, w; matrices are [row, column].
"""

import builtins as _builtins
import contextlib as _contextlib
import html as _html
import json as _json
import math as _math
import operator as _operator
import os as _os
from pathlib import Path as _Path

import numpy as _np

from . import _bendy
from ._bendy import __version__
from ._body_reach import BodyReach, BodyReached, Effector, EffectorTarget
from ._errors import ConversionError, EditError, Error, InvalidError, MalformedError, RenderError, UnsupportedError
from ._items import Items
from ._material import Material, Texture, TextureUse
from ._mesh import Lod, Mesh, MorphTarget, Submesh
from ._model import Chain, Clip, Constraint, Curve, FrameSequence, Joint, Marker, Model, Track
from ._play import Binding, Crossfade, Crowd, Fade, PlayedInterval, Playback, Playing, RootMotion, RootPath, ease
from ._pose import Pose, ReachRequest, ReachResult, ReachState
from ._retarget import Retarget, Retargeted, RetargetState

__all__ = [
    "Binding", "BodyReach", "BodyReached", "Chain", "Chunk", "Clip", "Constraint", "Conversion", "ConversionError", "Crossfade", "Crowd", "Curve", "Edit",
    "EditError", "Effector", "EffectorTarget", "Error", "Export", "Fade", "Fault", "Faults", "File", "FrameSequence", "InvalidError", "Items", "Joint", "Lod", "MalformedError", "Marker",
    "Material", "Mesh", "Model", "MorphTarget", "Playback", "PlayedInterval", "Playing", "Pose", "ReachRequest", "ReachResult", "ReachState",
    "RenderError", "Retarget", "RetargetState", "Retargeted", "RootMotion", "RootPath", "Submesh", "Texture", "TextureUse", "Track", "UnsupportedError", "assemble", "contact_sheet", "convert", "diff",
    "dump", "ease", "edit", "encode_png", "export", "inspect", "open", "render", "save_png", "validate",
]


class File:
    """A bendy file in memory: the result of convert, edit and open."""

    def __init__(self, source, inputs=()):
        self._source = source
        self._inputs = inputs  # the files that it was made from, which it never replaces

    @property
    def data(self):
        """The file's bytes without a copy: (size,) uint8, read-only; bytes(file.data) copies them."""
        return self._source.bytes

    def save(self, path, *, overwrite=False):
        """Writes the file, whole or not at all, and returns its path. Raises FileExistsError unless overwrite, ValueError for a file
        that it was made of and for the suffix of another format, OSError."""
        _claim_bendy(path, overwrite, self._inputs)
        self._source.write(path)
        return _Path(path)

    def open(self, **options):
        """The character: see bendy.open."""
        return open(self, **options)

    def validate(self):
        """The file's faults: see bendy.validate."""
        return validate(self)

    def inspect(self):
        """The file's chunks: see bendy.inspect."""
        return inspect(self)


class Fault:
    """One fault of a file.

    code: "CHUNK_TOO_LONG"; kind: malformed, invalid or unsupported; message: a sentence; path: the chunk's path; offset: bytes from
    the start of the file.
    """

    __slots__ = ("code", "kind", "message", "path", "offset")

    def __init__(self, code, kind, message, path, offset):
        self.code, self.kind, self.message, self.path, self.offset = code, kind, message, path, offset

    def __eq__(self, other):
        return isinstance(other, Fault) and self.as_dict() == other.as_dict()

    def __hash__(self):
        return hash((self.code, self.offset))

    def as_dict(self):
        """The fields as a dict: a row for pandas."""
        return {name: getattr(self, name) for name in self.__slots__}

    def __str__(self):
        return f"{self.code}: {self.message} ({self.path}, offset {self.offset})"

    def __repr__(self):
        return f"<bendy.Fault {self}>"


class Faults(list):
    """The faults of a file: an empty list if it is valid. `left_out`: the number beyond the first thousand. `warnings`: those of
    a converted file, as in Conversion."""

    def __init__(self, faults=(), left_out=0, warnings=()):
        super().__init__(faults)
        self.left_out = left_out
        self.warnings = [*warnings]


class Conversion(File):
    """The result of bendy.convert.

    output: the path that was written, or None. report: the dict of `bendy convert --json`: counts, clips, sizes. warnings: dicts with
    message, place and count, for what the file cannot hold. proposals: lines for what auto_rig and auto_skin guessed. suggestions:
    lines with options worth trying. compact: the measured error and sizes, or None. sources: the files that were read.
    """

    def __init__(self, source, output, report, sources):
        super().__init__(source, sources)
        self.output = output
        self.report = report
        self.warnings = report["warnings"]
        self.proposals = report["proposals"]
        self.suggestions = report["suggestions"]
        self.compact = report.get("compact")
        self.sources = sources

    def __repr__(self):
        name = f" {str(self.output)!r}" if self.output else ""
        return f"<bendy.Conversion{name}: {len(self.data)} bytes, {len(self.warnings)} warnings>"


class Edit(File):
    """A file that is being changed, chunk by chunk; everything that a change does not affect keeps its bytes. Every method
    returns the edit:

        bendy.edit("fox.bendy").strip("clip:Run").rename("joint", {"b_*": "*"}).save("walks.bendy")

    done, warnings: lines about what was done, and what to check. A method that fails changes nothing; it raises EditError.
    """

    def __init__(self, source, inputs=()):
        super().__init__(source, inputs)
        self.done = []
        self.warnings = []

    def _take(self, result):
        self._source, done, warnings = result
        self.done += done
        self.warnings += warnings
        return self

    def strip(self, *parts):
        """Removes parts: "textures", "clips", "clip:Run", "mesh:Hat*", "lod", "extras", ... Raises ValueError for another word."""
        source, done, warnings = self._source, [], []
        for part in parts:
            source, more_done, more_warnings = _bendy.strip(source, part)
            done += more_done
            warnings += more_warnings
        return self._take((source, done, warnings))

    def rename(self, kind, names, *, all_must_match=True):
        """Renames things of a kind (joint, clip, chain, mesh, target, material, texture, object): {"mixamorig:*": "*"}."""
        return self._take(_bendy.rename(self._source, kind, list(dict(names).items()), all_must_match))

    def merge_clips(self, other, *, same_name="error"):
        """Appends the clips of another source, by the joints' names. same_name: error, replace or number."""
        self._take(_bendy.merge_clips(self._source, _bendy_source(other), same_name))
        self._inputs = [*self._inputs, other]
        return self

    def retarget_clips(self, other, clip=None, *, same_name="error", chooses_rests=True, **options: "bendy_retarget_options"):
        """Puts clips of another source on this character, whatever its build: see docs/retarget.md. `done` has a line for each with what
        had to give way, and `warnings` what is lost.

        other: a source with a character whose joints have roles, as this one's must have. clip: which of its clips, a name, a pattern as in
        "Walk*", or a number; None: all. same_name: error, replace or number, if there is a clip of that name. chooses_rests: takes
        rest poses of animals on four legs as alike if that brings feet much nearer; `done` says so.

        **options
        """
        clip = "" if clip is None else str(clip)
        taken = _bendy.c.RetargetOptions(**options)
        chooses = bool(chooses_rests) and taken.rest_poses == "measured"
        self._take(_bendy.retarget_clips(self._source, _bendy_source(other), clip, same_name, taken, chooses))
        self._inputs = [*self._inputs, other]
        return self

    def set_role(self, role, joint):
        """Says what a joint is in the body, as Joint.role has it: set_role("left_hand", "Hand.L"), set_role("tail:2", "Tail3"). None: nobody
        is it. Raises ValueError for another word."""
        return self._take(_bendy.set_role(self._source, f"{role}={'' if joint is None else joint}"))

    def stand(self, clip, seconds):
        """Says that the body stands upright at this time of a clip: retargeting measures from that pose, not from the rest pose.
        strip("standing-pose") takes it back. A clip is a name, a pattern as in "Walk*", or a number."""
        return self._take(_bendy.stand(self._source, str(clip), float(seconds)))

    def stand_as(self, other):
        """Says that the body stands as the character of another source rests; joints are found there by their names."""
        self._take(_bendy.stand_as(self._source, _bendy_source(other)))
        self._inputs = [*self._inputs, other]
        return self

    def set_material(self, material, field, value):
        """Changes a field of a material's SURF record: set_material("Wood", "roughness", 0.4), set_material("*", "base_colour", (1, 0.5, 0, 1)),
        set_material("Wood", "alpha_mode", "blend"), set_material("Wood", "normal_texture.texture", None). Raises EditError for another
        field, and lists them."""
        numbers = [value] if isinstance(value, (int, float)) else value
        text = "none" if value is None else value if isinstance(value, str) else ",".join(repr(float(number)) for number in numbers)
        return self._take(_bendy.set_material(self._source, str(material), field, text))

    def extract(self, joint):
        """Keeps the joint with this name and its descendants, with everything that belongs to them."""
        return self._take(_bendy.extract(self._source, joint))

    def _change_clips(self, word, *texts):
        return self._take(_bendy.change_clips(self._source, word, list(texts)))

    def keep_clips(self, *clips):
        """Takes out all clips but these. A clip, here and in the methods below, is a name, a pattern as in "Walk*", or a number."""
        return self._change_clips("keep-clip", *(str(clip) for clip in clips))

    def copy_clip(self, clip, name):
        """Adds a second clip with the same content, to change one of the two. With a pattern, name may have a * too."""
        return self._change_clips("copy-clip", f"{clip}={name}")

    def trim(self, clip, start=None, end=None):
        """Keeps the part from start to end, seconds on the clip's time line; it then begins at 0. None: as far as the clip goes."""
        start, end = ("" if seconds is None else repr(float(seconds)) for seconds in (start, end))
        return self._change_clips("trim", f"{clip}={start}..{end}")

    def resample(self, clip, rate):
        """Replaces the keys with linear ones, rate per second; tracks that step keep theirs."""
        return self._change_clips("resample", f"{clip}@{float(rate)!r}")

    def mirror(self, clip):
        """Left does what right did. Joints are paired by their roles or by names such as arm.L and arm.R."""
        return self._change_clips("mirror", str(clip))

    def loop(self, clip, seconds):
        """Lets the clip repeat: during its last seconds it drifts to the pose of its start."""
        return self._change_clips("loop", f"{clip}={float(seconds)!r}")

    def root_motion(self, clip, source="", to=""):
        """Gives the movement over the ground (x and z) of the joint source to the joint `to` above it; without it, takes it out.

        source: if empty, the highest joint that moves, down to the one whose role is hips.
        """
        return self._change_clips("root-motion", f"{clip}={source}..{to}")

    def on_the_spot(self, clip, seconds=None):
        """Takes a clip's way over the ground out, averaged over some seconds or one cycle; what sways about it stays."""
        return self._change_clips("on-the-spot", f"{clip}" if seconds is None else f"{clip}@{float(seconds)!r}")

    def limit_influences(self, most):
        """Leaves each vertex its `most` largest influences at most, scaled to the same sum."""
        return self._take(_bendy.limit_influences(self._source, most))

    def __repr__(self):
        return f"<bendy.Edit: {len(self.data)} bytes>"


class Export:
    """The result of bendy.export. files: the paths, the main one first. warnings: dicts with message, place and count."""

    def __init__(self, files, warnings):
        self.files, self.warnings = files, warnings

    def __repr__(self):
        return f"<bendy.Export {str(self.files[0])!r}, {len(self.warnings)} warnings>"


class Chunk:
    """A chunk of a file, as bendy.inspect returns it.

    id: four letters; meaning: the id in words; number: its index in file order; offset: bytes from the start of the file;
    size: bytes of the payload as stored; sum: the stored CRC-32C; is_container; codec: 0 or the payload's encoding; fields: its
    record by name, as in `bendy inspect --json`; parent: the chunk that contains it, or None; children: a tuple.
    """

    __slots__ = ("_tree", "children", "codec", "fields", "id", "is_container", "meaning", "number", "offset", "parent", "size", "sum")

    def __init__(self, tree, entry, parent):
        self._tree = tree
        self.id, self.meaning, self.number = entry["id"], entry["meaning"], entry["number"]
        self.offset, self.size, self.sum = entry["offset"], entry["size"], int(entry["sum"], 16)
        self.is_container, self.codec, self.fields = entry["container"], entry.get("codec", 0), entry.get("fields", {})
        self.parent, self.children = parent, ()

    @property
    def path(self):
        """Its path from the root: "HEAD/OBJE/SKIN[1]/NAME"."""
        return self._tree.path(self.number)

    @property
    def payload(self):
        """(size,) uint8, read-only, without a copy: the payload, decoded if it is encoded."""
        return self._tree.payload(self.number)

    @property
    def name(self):
        """The text of its NAME; "" if it has none."""
        return next((child.fields.get("text", "") for child in self.children if child.id == "NAME"), "")

    def walk(self):
        """Iterates over the chunk and everything in it, in file order."""
        pending = [self]
        while pending:
            chunk = pending.pop()
            yield chunk
            pending.extend(reversed(chunk.children))

    def find(self, id):
        """A list of all chunks with this id, the chunk itself included."""
        return [chunk for chunk in self.walk() if chunk.id == id]

    def __iter__(self):
        return iter(self.children)

    def __len__(self):
        return len(self.children)

    def __bool__(self):
        return True

    def __getitem__(self, path):
        """The chunk at a path below this one, "OBJE/SKIN[1]", or the child with this number. Raises KeyError, IndexError."""
        if not isinstance(path, str):
            return self.children[path]
        chunk = self
        for step in path.split("/"):
            id, _, place = step.partition("[")
            same = [child for child in chunk.children if child.id == id]
            index = place.rstrip("]") or "0"
            if not index.isdecimal() or int(index) >= len(same):
                raise KeyError(f"there is no chunk {step} in {chunk.path}")
            chunk = same[int(index)]
        return chunk

    def __repr__(self):
        name = f" {self.name!r}" if self.name else ""
        return f"<bendy.Chunk {self.id}{name}: {self.meaning}, {self.size} bytes at {self.offset}>"

    def _repr_html_(self):
        rows = []
        for chunk in self.walk():
            if len(rows) == 500:
                rows.append("<tr><td colspan=4>...</td></tr>")
                break
            name = _html.escape(chunk.name)
            rows.append(f"<tr><td style='text-align:left'>{_html.escape(chunk.path)}</td><td>{name}</td><td>{chunk.offset:,}</td>"
                        f"<td>{chunk.size:,}</td></tr>")
        return ("<table><tr><th>chunk</th><th>name</th><th>offset</th><th>bytes</th></tr>" + "".join(rows) + "</table>")


def open(source, *, object=0, check_sums=True, copied=False, root=None):
    """Opens a character. A path is mapped; a file of another format (.gltf, .glb, .vrm, .vrma, .x, .md2, .bvh) is converted
    in memory, and Model.conversion has the warnings. For files that nothing reads (FBX, USD, ...) the ConversionError names their format.

    object: which object of the file. check_sums: False defers the check of all bytes to Model.check_sums. copied: True reads a path
    into memory, for files that another program may make shorter, which ends a program that has them mapped. root: as for convert.
    Raises FileNotFoundError and other OSErrors; MalformedError, InvalidError, UnsupportedError with code, path and offset;
    ConversionError.
    """
    if isinstance(source, Model):
        return source
    found = _bendy.Source.read(source) if copied and isinstance(source, (str, _os.PathLike)) else _source(source)
    conversion = None
    if found.is_converted:
        conversion = convert(source, root=root)
        found = conversion._source
    model = Model(found, object, check_sums)
    model.conversion = conversion
    return model


def _plain(value):
    """NumPy's numbers and arrays as JSON has them."""
    if isinstance(value, (_np.generic, _np.ndarray)):
        return value.tolist()
    raise TypeError(f"a rig cannot hold {value!r}")


def convert(source, output=None, *, name="source.glb", jobs=0, progress=None, overwrite=False,
            **options: "convert_options"):
    """Converts another format (.gltf, .glb, .vrm, .vrma, .x, .md2, .bvh), or a bendy file, to a bendy file, exactly unless compact.
    Returns a Conversion.

    output: the path to write; None: nothing is written, see File.save. name: of a source that is bytes, preceded by the folder of the
    files that it refers to; without a folder, only root counts. jobs: the most threads for making a compact file; 0: one per
    processor. progress: is called with the fraction done, 0 to 1, when the source is read, and while vertices are collapsed (lod)
    and a compact file is made; an exception from it, or a KeyboardInterrupt, ends the conversion there. Raises ConversionError with
    the place in the source, FileNotFoundError, FileExistsError unless overwrite, ValueError.

    The options of `bendy convert`; compact may also be the largest error, "0.1mm" or "0.005%", scene a number, and rig a
    dict with what a rig file holds:

    **options
    """
    rig_text = None
    if isinstance(rig, dict):
        rig, rig_text = None, _json.dumps(rig, default=_plain)
    given = dict(locals())
    if output is not None:
        _claim_bendy(output, overwrite, [source, rig, texture])
    if isinstance(source, (str, _os.PathLike)):
        file, found = source, None
        _must_exist(file)
    else:
        found = _source(source)
        file = found.file or name
    if rig is not None:
        _must_exist(rig)
    if texture is not None:
        _must_exist(texture)
    options = {option: given[option] for option in _bendy.convert_options() if given.get(option) is not None}
    if scene is not None and not isinstance(scene, str):
        options["scene"] = f"#{scene}"  # "0" could be a name
    if compact is not None and not isinstance(compact, bool):
        options["compact"], options["max_error"] = True, compact
    made, report, sources = _bendy.convert(file, found, "" if output is None else output, options, rig_text, jobs, progress)
    if output is not None:
        _claim_bendy(output, overwrite, sources)
        made.write(output)
        output = _Path(output)
    return Conversion(made, output, report, sources)


def validate(source):
    """Every fault of a bendy file: Faults, an empty list if it is valid. For a file that convert reads, the error that the
    importer finds, with its place in the source as `path`. Raises MalformedError for a file of another kind, OSError."""
    found = _source(source)
    if found.is_converted:
        try:
            return Faults(warnings=convert(source).warnings)
        except ConversionError as error:
            if error.path:
                return Faults([Fault(error.code, "invalid", error.message, error.path, 0)])
    faults, left_out = _bendy.validate(found)
    return Faults((Fault(**fault) for fault in faults), left_out)


def inspect(source):
    """The root Chunk of a bendy file, whatever its chunks hold, or of what bendy.open accepts. Raises MalformedError if the grammar
    is broken, ConversionError, OSError."""
    tree = _bendy.Tree(_bendy_source(source))
    chunks, children = [], []
    for entry in tree.chunks():
        parent = None if entry["parent"] is None else chunks[entry["parent"]]
        chunk = Chunk(tree, entry, parent)
        chunks.append(chunk)
        children.append([])
        if parent is not None:
            children[parent.number].append(chunk)
    for chunk, list_of in zip(chunks, children):
        chunk.children = tuple(list_of)
    return chunks[0]


def edit(source):
    """An Edit of a bendy file, or of what bendy.open accepts. Nothing is written before Edit.save."""
    return Edit(_bendy_source(source), [source])


def diff(a, b, *, tolerance=None):
    """How two bendy files differ: the dict of `bendy diff --json`, described in docs/cli.md; ["same"] is true if they do not.

    tolerance: compares the characters instead of the chunks, for example an exact file with its compact version: the largest distance
    by which a point of the skin may differ in any clip, "0.1mm" or "0.005%". Raises Error for a file with faults, ValueError, OSError.
    """
    a, b = _bendy_source(a), _bendy_source(b)
    return _bendy.diff(a, b) if tolerance is None else _bendy.compare(a, b, tolerance)


def dump(source, *, decode=False):
    """The text form of a bendy file as a dict, described in spec/text.md: for reading, changing, and passing to assemble.

    decode: encoded leaves as plain ones. Raises MalformedError, OSError.
    """
    # A negative zero keeps its sign: JSON's -0 would become an int.
    return _json.loads(_bendy.dump(_bendy_source(source), decode), parse_int=lambda digits: -0.0 if digits == "-0" else int(digits))


def assemble(text):
    """A File made from a text form: the dict that dump returns, or JSON. Its content is not checked: see File.validate. Raises
    ValueError with line and column."""
    return File(_bendy.assemble(text if isinstance(text, str) else _json.dumps(text, indent=1)))


def export(source, output, *, lod=1.0, overwrite=False):
    """Writes a bendy file as glTF (.glb, or .gltf with a .bin beside it) or as an X-file (.x), by the output's suffix. Returns an
    Export.

    lod: the fraction of the triangles, 0 to 1, for a file with levels of detail. Raises ValueError for another suffix,
    FileExistsError unless overwrite, ConversionError, OSError.
    """
    output = _Path(output)
    files, warnings = _bendy.export(_bendy_source(source), output.suffix[1:].lower(), output, lod)
    paths = [output.parent / name for name in files]
    _claim(paths, overwrite, [source])
    for path, made in reversed(list(zip(paths, files.values()))):
        made.write(path)
    return Export(paths, warnings)


def render(subject, clip=None, times=None, *, size=(512, 512), yaw=None, pitch=None, distance=1.0, bones=False, axes=False,
           constraints=False, wireframe=False, background=None, root=None):
    """A picture without a display: (height, width, 4) uint8, red, green, blue, alpha, sRGB. With `times`, a list of seconds of the
    clip, one picture for each: (T, height, width, 4).

    subject: a Pose, or a source at rest or in a clip. times: also one number; None: the clip's start. size: width and height, pixels.
    yaw, pitch: degrees around the character, 0, 0 is its front; None: as in `bendy render`, 34 and 11. distance: 1 fits the whole clip
    into the picture. background: None, "transparent", or red, green, blue, alpha, linear, 0 to 1. root: a folder whose images may be
    read, as for convert. Raises RenderError without OpenGL 3.3, NotImplementedError if the package was built without the viewer,
    KeyError, ValueError, TypeError.
    """
    _need_viewer()
    if isinstance(subject, Pose):
        if clip is not None or times is not None:
            raise ValueError("a pose has no clip and times: sample it instead")
    else:
        subject = open(subject)
    if clip is None and times is not None:
        raise ValueError("times need a clip")
    is_one = times is None or not _np.iterable(times)
    if times is None:
        times = [_start_of(subject, clip)]
    elif is_one:
        times = [times]
    if isinstance(background, str):
        if background != "transparent":
            raise ValueError("background must be None, transparent or four numbers")
        background = (0.0, 0.0, 0.0, 0.0)
    drawn = [name for name, wanted in (("bones", bones), ("axes", axes), ("constraints", constraints), ("wireframe", wireframe)) if wanted]
    try:
        width, height = (_operator.index(length) for length in size)
    except (TypeError, ValueError):
        raise TypeError(f"size must be (width, height), two whole numbers of pixels, not {size!r}") from None
    yaw, pitch = (None if angle is None else _math.radians(angle) for angle in (yaw, pitch))
    character = subject._character if isinstance(subject, Pose) else subject._get()
    pose = subject._handle if isinstance(subject, Pose) else None
    number = None if clip is None else character.find("clip", clip)
    pictures = _bendy.render(character.handle, pose, character.source, number, [float(time) for time in times], width, height, yaw, pitch,
                             distance,
                             None if background is None else tuple(background), drawn, root or "")
    return pictures[0] if is_one else pictures


def contact_sheet(pictures, columns=None):
    """Arranges pictures of one size, (T, height, width, 4) uint8, in rows: one picture. columns: None: about a square. Empty places
    have the colour of the first picture's top left corner. Raises ValueError."""
    pictures = _np.asarray(pictures, dtype=_np.uint8)
    if pictures.ndim != 4 or len(pictures) == 0:
        raise ValueError("pictures must have the shape (T, height, width, 4), and be one at least")
    count, height, width, channels = pictures.shape
    columns = columns or _math.ceil(_math.sqrt(count))
    if columns < 1:
        raise ValueError("columns must be 1 or more")
    rows = -(-count // columns)
    sheet = _np.empty((rows * columns, height, width, channels), _np.uint8)
    sheet[:] = pictures[0, 0, 0]
    sheet[:count] = pictures
    return sheet.reshape(rows, columns, height, width, channels).swapaxes(1, 2).reshape(rows * height, columns * width, channels)


def encode_png(picture):
    """The bytes of a PNG file: of (height, width, 4) uint8. Raises ValueError; NotImplementedError without the viewer."""
    _need_viewer()
    return _bendy.encode_png(picture)


def save_png(picture, path, *, overwrite=False):
    """Writes a picture as a PNG file and returns its path. Raises FileExistsError unless overwrite, ValueError, also for another suffix,
    OSError."""
    if _Path(path).suffix.lower() not in (".png", ""):
        raise ValueError(f"{path} is not the name of a PNG file: give it the suffix .png")
    _claim([path], overwrite, [])
    _bendy.Source.copy(encode_png(picture)).write(path)
    return _Path(path)


def _need_viewer():
    if not _bendy.has_viewer:
        raise NotImplementedError("this package was built without the viewer (BENDY_VIEWER=OFF): there are no pictures")


def _start_of(subject, clip):
    if clip is None:
        return 0.0
    return clip.start if isinstance(clip, Clip) else subject.clips[clip].start


def _source(source):
    """The bytes of any source that the functions accept."""
    if isinstance(source, File):
        return source._source
    if isinstance(source, Model):
        return source.source
    if isinstance(source, _bendy.Source):
        return source
    if isinstance(source, (str, _os.PathLike)):
        return _bendy.Source.map(source)
    if isinstance(source, (bytes, bytearray, memoryview, _np.ndarray)):
        return _bendy.Source.copy(source)
    raise TypeError(f"a source is a path, bytes, a bendy.File or a bendy.Model, not {type(source).__name__}")


def _bendy_source(source):
    """The same for a bendy file; other formats are converted in memory."""
    found = _source(source)
    return convert(source)._source if found.is_converted else found


def _must_exist(path):
    """Raises the OSError for a file that cannot be opened."""
    with _builtins.open(path, "rb"):
        pass


def _claim_bendy(output, overwrite, inputs):
    """The same as _claim for a bendy file: also raises ValueError for a name that means another format."""
    named = _bendy.format_named_by(output)
    if named not in ("", "a bendy file"):
        raise ValueError(f"{output} names {named}, but a bendy file is written: give it the suffix .bendy, or use bendy.export")
    _claim([output], overwrite, inputs)


def _files_of(inputs):
    """The paths of those inputs that have one."""
    for given in inputs:
        if isinstance(given, File):
            yield from _files_of([*given._inputs, given._source])
        elif isinstance(given, Model):
            if not given.closed:
                yield from _files_of([given.source, given.conversion])
        elif isinstance(given, _bendy.Source):
            if given.is_mapped:
                yield given.file
        elif isinstance(given, (str, _os.PathLike)):
            yield given


def _claim(outputs, overwrite, inputs):
    """Raises FileExistsError for outputs that exist, and ValueError for one that is an input, even with overwrite."""
    for output in outputs:
        output = _Path(output)
        if not output.exists():
            continue
        for file in _files_of(inputs):
            with _contextlib.suppress(OSError):
                if _os.path.samefile(file, output):
                    raise ValueError(f"{output} is an input as well as an output: give another name")
        if not overwrite:
            raise FileExistsError(17, "the file exists; overwrite=True replaces it", str(output))
