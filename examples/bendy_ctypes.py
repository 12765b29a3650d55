#!/usr/bin/env python3
"""Bendy from Python, through libbendy's C API and nothing but the standard library.

    ./bendy_ctypes.py mannequin.bendy Walk 0.3 IK_LeftArm 0.3 1.2 0.4 > posed.obj

As a module: Model and Pose below. The library is looked for beside this file or the program bendy, by the loader, or at the path
in BENDY_LIBRARY. Numbers are passed as array.array("f"), which numpy.asarray takes without a copy.
"""

import array
import ctypes
import os
import shutil
import sys
from ctypes import POINTER, Structure, byref, c_char, c_char_p, c_float, c_int, c_int32, c_size_t, c_uint32, c_uint64, c_void_p
from pathlib import Path

NONE = 0xFFFFFFFF
TRIANGLES, LINES, POINTS = range(3)
REACH_STATUS = ("reached", "out of reach", "not reached", "aimed")


class BendyError(Exception):
    """An error: message, code ("CHUNK_TOO_LONG", "NOT_FOUND", ...), and the offset in the file."""

    def __init__(self, error):
        super().__init__(error.message.decode("utf-8", "replace"))
        self.code = error.code.decode("ascii")
        self.offset = error.offset


class Error(Structure):
    _fields_ = [("status", c_int32), ("reserved", c_uint32), ("offset", c_uint64), ("code", c_char * 40), ("message", c_char * 456)]


class Sized(Structure):
    """A struct that begins with its size."""

    def __init__(self, **fields):
        super().__init__(size=ctypes.sizeof(type(self)), **fields)


class Transform(Structure):
    _fields_ = [("rotation", c_float * 4), ("translation", c_float * 3), ("scale", c_float * 3)]


class Joint(Sized):
    _fields_ = [("size", c_uint32), ("parent", c_uint32), ("name", c_char_p), ("rest", Transform), ("shear", c_float * 3)]


class Clip(Sized):
    _fields_ = [("size", c_uint32), ("loops", c_uint32), ("name", c_char_p), ("start", c_float), ("end", c_float),
                ("frame_rate", c_float)]


class Mesh(Sized):
    _fields_ = [("size", c_uint32), ("vertices", c_uint32), ("first_vertex", c_uint64), ("name", c_char_p),
                *((field, c_uint32) for field in ("indices", "joint", "first_morph_target", "targets", "has_normals", "has_tangents",
                                                  "texture_coord_sets", "bones", "influences"))]


class Submesh(Sized):
    _fields_ = [(field, c_uint32) for field in ("size", "mesh", "material", "topology", "first", "count")]


class ReachOptions(Sized):
    _fields_ = [("size", c_uint32), ("solver", c_uint32), ("iterations", c_uint32), ("restarts", c_uint32), ("tolerance", c_float),
                ("influence", c_float), ("softness", c_float), ("gain", c_float), ("step_limit", c_float),
                ("ignore_constraints", c_uint32), ("has_pole", c_uint32), ("pole", c_float * 3), ("carry_target", c_uint32),
                ("seconds", c_float), ("speed_limit", c_float), ("state", c_void_p)]

    def __init__(self, **fields):
        super().__init__(**{"restarts": 4, "influence": 1.0, "softness": 0.005, "gain": 1.0, "step_limit": 0.2, "carry_target": 1,
                            "speed_limit": 4.0, **fields})


class ReachResult(Sized):
    _fields_ = [("size", c_uint32), ("status", c_uint32), ("distance", c_float), ("angle", c_float), ("iterations", c_uint32)]


class Vertices(Sized):
    _fields_ = [("size", c_uint32), ("reserved", c_uint32), ("capacity", c_size_t), ("positions", c_void_p),
                ("position_stride", c_size_t), ("normals", c_void_p), ("normal_stride", c_size_t), ("tangents", c_void_p),
                ("tangent_stride", c_size_t)]


# The result and the parameters, without the error, of each function used here.
SIGNATURES = {
    "open": (c_void_p, c_char_p, c_void_p),
    "open_copy": (c_void_p, c_char_p, c_size_t, c_void_p),
    "pose_new": (c_void_p, c_void_p),
    **{f"find_{kind}": (c_uint32, c_void_p, c_char_p) for kind in ("joint", "clip", "chain", "morph_target", "mesh", "material")},
    **{f"get_{kind}": (c_int, c_void_p, c_uint32, c_void_p) for kind in ("joint", "clip", "mesh", "submesh")},
    "get_indices": (c_int, c_void_p, c_uint32, c_void_p, c_size_t),
    "sample": (c_int, c_void_p, c_uint32, c_float),
    "blend": (c_int, c_void_p, c_void_p, c_float, c_void_p),
    "constrain": (c_int, c_void_p),
    "reach": (c_int, c_void_p, c_uint32, c_void_p, c_void_p, c_void_p, c_void_p),
    "joint_matrices": (c_int, c_void_p, c_uint32, c_uint32, c_void_p, c_void_p),
    "skin": (c_int, c_void_p, c_void_p, c_void_p),
}
COUNTS = ("joint", "clip", "chain", "morph_target", "mesh", "submesh", "material")


def find_library():
    """The library's path: BENDY_LIBRARY; otherwise in the folder where Bendy is installed, derived from this file's path or the
    program bendy on the PATH; otherwise only its name, for the system's loader."""
    if "BENDY_LIBRARY" in os.environ:
        return os.environ["BENDY_LIBRARY"]
    name = {"win32": "libbendy.dll", "darwin": "libbendy.0.dylib"}.get(sys.platform, "libbendy.so.0")
    roots = [Path(__file__).resolve().parent, *Path(__file__).resolve().parents[1:4]]
    if program := shutil.which("bendy"):
        roots.append(Path(program).resolve().parents[1])
    for root in roots:
        for folder in (root, root / "lib", root / "lib64", *sorted((root / "lib").glob("*-linux-gnu*")), root / "bin"):
            if (folder / name).is_file():
                return str(folder / name)
    return name


def load_library():
    path = find_library()
    try:
        library = ctypes.CDLL(path)
    except OSError as problem:
        raise ImportError(f"{path} cannot be loaded ({problem}): put the path of libbendy into BENDY_LIBRARY") from problem
    for name, (result, *arguments) in SIGNATURES.items():
        function = getattr(library, "bendy_" + name)
        function.restype, function.argtypes = result, [*arguments, POINTER(Error)]
    for kind in COUNTS:
        function = getattr(library, f"bendy_{kind}_count")
        function.restype, function.argtypes = c_uint32, [c_void_p]
    library.bendy_vertex_count.restype, library.bendy_vertex_count.argtypes = c_uint64, [c_void_p]
    for name in ("close", "pose_free"):
        function = getattr(library, "bendy_" + name)
        function.restype, function.argtypes = None, [c_void_p]
    return library


LIBRARY = load_library()


def call(name, *arguments):
    """Calls bendy_NAME; raises BendyError if it fails."""
    error = Error()
    result = getattr(LIBRARY, "bendy_" + name)(*arguments, byref(error))
    if error.status != 0:
        raise BendyError(error)
    return result


def address(numbers):
    return numbers.buffer_info()[0]


class Model:
    """A character. Count joints, clips, ... by count("joint"), look them up by find("joint", NAME)."""

    def __init__(self, source):
        """source: a path, or the bytes of a file."""
        self.handle = None
        if isinstance(source, (bytes, bytearray)):
            self.handle = call("open_copy", bytes(source), len(source), None)
        else:
            self.handle = call("open", os.fsencode(source), None)

    def __del__(self):
        LIBRARY.bendy_close(self.handle)

    def count(self, kind):
        return getattr(LIBRARY, f"bendy_{kind}_count")(self.handle)

    def find(self, kind, name):
        return call("find_" + kind, self.handle, name.encode())

    def get(self, kind, number):
        """A Joint, Clip, Mesh or Submesh."""
        value = {"joint": Joint, "clip": Clip, "mesh": Mesh, "submesh": Submesh}[kind]()
        call("get_" + kind, self.handle, number, byref(value))
        return value

    def indices(self, mesh):
        count = self.get("mesh", mesh).indices
        indices = array.array("I", bytes(4 * count))
        call("get_indices", self.handle, mesh, address(indices), count)
        return indices


class Pose:
    """A model in one position; initially at rest."""

    def __init__(self, model):
        self.handle = None
        self.model = model
        self.handle = call("pose_new", model.handle)

    def __del__(self):
        LIBRARY.bendy_pose_free(self.handle)

    def sample(self, clip, seconds):
        call("sample", self.handle, self.model.find("clip", clip), seconds)

    def blend(self, other, weight):
        call("blend", self.handle, other.handle, weight, None)

    def constrain(self):
        call("constrain", self.handle)

    def reach(self, chain, position, rotation=None, **options):
        """Returns (status, metres from tip to target). options: fields of ReachOptions."""
        result = ReachResult()
        turned = None if rotation is None else (c_float * 4)(*rotation)
        call("reach", self.handle, self.model.find("chain", chain), (c_float * 3)(*position), turned, byref(ReachOptions(**options)),
             byref(result))
        return REACH_STATUS[result.status], result.distance

    def joint_matrices(self):
        """16 floats for each joint, column by column: joint space to model space."""
        joints = self.model.count("joint")
        matrices = array.array("f", bytes(64 * joints))
        call("joint_matrices", self.handle, 0, joints, None, address(matrices))
        return matrices

    def skin(self):
        """Positions and normals of all vertices, three floats each."""
        count = LIBRARY.bendy_vertex_count(self.model.handle)
        positions, normals = (array.array("f", bytes(12 * count)) for _ in range(2))
        call("skin", self.handle, None, byref(Vertices(capacity=count, positions=address(positions), normals=address(normals))))
        return positions, normals


def write_obj(model, pose, out):
    for keyword, numbers in zip(("v", "vn"), pose.skin()):
        for at in range(0, len(numbers), 3):
            out.write(f"{keyword} {numbers[at]:.9g} {numbers[at + 1]:.9g} {numbers[at + 2]:.9g}\n")
    for submesh in (model.get("submesh", number) for number in range(model.count("submesh"))):
        if submesh.topology != TRIANGLES:
            continue
        first = model.get("mesh", submesh.mesh).first_vertex + 1
        corners = [first + index for index in model.indices(submesh.mesh)[submesh.first:submesh.first + submesh.count]]
        for a, b, c in zip(*[iter(corners)] * 3):
            out.write(f"f {a}//{a} {b}//{b} {c}//{c}\n")


def main(arguments):
    if len(arguments) not in (3, 7):
        sys.exit("usage: bendy_ctypes.py FILE.bendy CLIP SECONDS [CHAIN X Y Z]")
    try:
        model = Model(arguments[0])
        pose = Pose(model)
        pose.sample(arguments[1], float(arguments[2]))
        if len(arguments) == 7:
            status, distance = pose.reach(arguments[3], [float(number) for number in arguments[4:]])
            print(f"{arguments[3]}: {status}, {distance * 1000:.1f} mm from the target", file=sys.stderr)
        write_obj(model, pose, sys.stdout)
    except BendyError as error:
        sys.exit(f"{arguments[0]}: {error}")


if __name__ == "__main__":
    main(sys.argv[1:])
