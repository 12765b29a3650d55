"""bendy.h in Python: every function and every option reaches it, and what is made from the header is safe to call."""

import ast
import gc
import inspect
import itertools
import re
import sys
import threading
import time
import weakref
from pathlib import Path

import bendy
import numpy
import pytest
from bendy._bendy import c
from conftest import ROOT

sys.path.insert(0, str(ROOT / "bindings"))
from describe import read  # noqa: E402
from make_python import Maker, bare, pascal  # noqa: E402

HEADER = ROOT / "bindings/c/include/bendy.h"
STUB = Path(bendy._bendy.__file__).with_name("_c.pyi")


@pytest.fixture(scope="module")
def api():
    return read(HEADER)


def test_every_function_reaches_python(api):
    declared = re.findall(r"^BENDY_API .*?\b(bendy_\w+)\(", HEADER.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    assert sorted(declared) == sorted(api.functions)
    frees = {function.name for function in Maker(api).frees.values()}
    for function in api.functions.values():
        if "Only for C" in function.doc:
            assert re.search(r"Only for C: \w.{20,}", function.doc), f"{function.name} is only for C: why?"
            assert not hasattr(c, bare(function.name))
        elif function.name not in frees:
            assert callable(getattr(c, bare(function.name), None)), function.name
    for name in api.handles:
        assert inspect.isclass(getattr(c, pascal(name)))
    for name in set(api.structs) - {"bendy_error"}:
        assert inspect.isclass(getattr(c, pascal(name)))


def test_stubs_have_what_the_module_has():
    stub = ast.parse(STUB.read_text(encoding="utf-8"))
    found = {}
    for node in stub.body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            found[node.name] = node
    assert set(found) == {name for name, value in vars(c).items() if callable(value)}
    for name, node in found.items():
        if isinstance(node, ast.ClassDef):
            members = {part.name for part in node.body if isinstance(part, ast.FunctionDef)} - {"__init__"}
            assert members == {name for name in vars(getattr(c, name)) if not name.startswith("_")}, name
        else:
            assert ast.get_docstring(node) or not inspect.getdoc(getattr(c, name)).partition("\n\n")[2], name


def test_options_of_c_are_those_of_python(api):
    struct = api.structs["bendy_reach_options"]
    options = [name for name, _, _ in Maker(api).fields(struct)]
    parameters = inspect.signature(bendy.Pose.reach).parameters
    assert list(parameters)[4:] == options and all(f"{option}: " in bendy.Pose.reach.__doc__ for option in options)
    assert parameters["solver"].default == "any" and parameters["obey_constraints"].default is True
    others = {bendy.Binding: "bendy_binding_options", bendy.Pose.socket: "bendy_socket", bendy.Pose.skin: "bendy_skin_options"}
    for python, name in others.items():
        assert set(inspect.signature(python).parameters) >= {name for name, _, _ in Maker(api).fields(api.structs[name])}


def test_a_new_option_reaches_python(tmp_path):
    header = HEADER.read_text(encoding="utf-8")
    header = header.replace("} bendy_reach_options;", "    uint32_t is_lazy; /* 1: stops early */\n} bendy_reach_options;")
    header = re.sub(r"(#define BENDY_REACH_OPTIONS_INIT.*?NULL)", r"\1, 0", header, count=1, flags=re.DOTALL)
    (tmp_path / "bendy.h").write_text(header, encoding="utf-8")
    maker = Maker(read(tmp_path / "bendy.h"))
    expanded = maker.expand((ROOT / "bindings/python/bendy/_pose.py").read_text(encoding="utf-8"))
    assert "is_lazy: bool = False)" in expanded and "is_lazy: True: stops early." in expanded and '"_handle", state), is_lazy)' in expanded
    assert "offsetof(bendy_reach_options, is_lazy)" in maker.source() and "def is_lazy(self) -> bool:" in maker.stub()


def test_a_new_function_reaches_the_class_of_its_object(tmp_path):
    header = HEADER.read_text(encoding="utf-8")
    added = "/* Mirrors `pose` at a joint; see bendy_set_rest. Not in JavaScript: a test. */\n" \
            "BENDY_API bendy_status bendy_pose_mirror(bendy_pose* pose, uint32_t joint, uint32_t easing /* a bendy_easing */," \
            " bendy_error* error);\n\n"
    (tmp_path / "bendy.h").write_text(header.replace("/* Moves every joint into the range", added + "/* Moves every joint into the range"))
    expanded = Maker(read(tmp_path / "bendy.h")).expand((ROOT / "bindings/python/bendy/_pose.py").read_text(encoding="utf-8"))
    assert "def mirror(self, joint: Union[str, SupportsIndex, Joint], easing: str) -> Pose:" in expanded
    assert "Mirrors the pose at a joint; see Pose.reset. Raises KeyError, IndexError, ValueError." in expanded
    assert 'c.pose_mirror(self._handle, self._character.find("joint", joint), easing)' in expanded


def test_lengths_that_functions_do_not_take(model):
    handle, pose = model._character.handle, model.pose()._handle
    joints, mesh = len(model.joints), model.meshes[0]
    for function in (c.blend, c.add):
        function(pose, c.pose_copy(pose), 0.5, numpy.ones(joints))
        for count in (0, joints - 1, joints + 1):
            with pytest.raises(ValueError, match=f"mask must have the shape \\({joints},\\)"):
                function(pose, c.pose_copy(pose), 0.5, numpy.ones(count))
    positions = numpy.empty((mesh.vertices, 3), numpy.float32)
    c.apply_morph_targets(handle, 0, numpy.zeros(mesh.targets), positions)
    numpy.testing.assert_array_equal(positions, mesh.positions)
    with pytest.raises(ValueError, match="weights must have the shape"):
        c.apply_morph_targets(handle, 0, numpy.zeros(mesh.targets + 1), positions)


def test_a_copy_does_not_keep_the_original(model):
    pose = c.pose_new(model._character.handle)
    original = weakref.ref(pose)
    pose = c.pose_copy(pose)
    gc.collect()
    assert original() is None
    c.sample(pose, 0, 0.0)


def test_structs():
    options = c.ReachOptions(pole=(1, 2, 3), solver="aim", obey_constraints=False)
    assert (options.pole, options.solver, options.obey_constraints, options.gain) == ((1.0, 2.0, 3.0), "aim", False, 1.0)
    assert c.ReachOptions().pole is None and c.ReachOptions("ccd", 3).iterations == 3 and c.Socket().joint is None
    for arguments, error in [({"solver": "magic"}, ValueError), ({"poles": 1}, TypeError), ({"pole": (1, 2)}, ValueError),
                             ({"pole": 1}, TypeError), ({"iterations": -1}, ValueError), ({"iterations": 1.5}, TypeError),
                             ({"gain": "much"}, TypeError), ({"iterations": 1 << 40}, ValueError)]:
        with pytest.raises(error):
            c.ReachOptions(**arguments)
    with pytest.raises(AttributeError):
        options.solver = "ccd"


def test_wrong_arguments_are_refused(model):
    """Whatever a function is given, it raises or returns: it does not end the interpreter."""
    pose = model.pose()._handle
    things = [None, 0, 7, -1, 1 << 40, 0.5, "Walk", model._character.handle, pose, numpy.zeros(3, numpy.float32), c.ReachOptions(), []]
    for name, function in vars(c).items():
        if not callable(function) or inspect.isclass(function) or name == "set_kernel":
            continue
        count = len(re.findall(r"(\w+):", function.__doc__.split("\n")[0].partition("->")[0]))
        for first in (model._character.handle, pose, None):
            for rest in itertools.chain(([thing] * (count - 1) for thing in things), [things[1:count], things[4:3 + count]]):
                try:
                    function(*([first, *rest][:count]))
                except (TypeError, ValueError, KeyError, OSError, bendy.Error):
                    pass


def test_errors_are_exceptions(model, tmp_path):
    handle = model._character.handle
    with pytest.raises(ValueError, match="2 clips"):
        c.sample(c.pose_new(handle), 9, 0.0)
    with pytest.raises(KeyError, match="Walk"):
        c.find_clip(handle, "Wlak")
    with pytest.raises(OSError):
        c.open(str(tmp_path / "none.bendy"))
    with pytest.raises(bendy.MalformedError) as caught:
        c.open_copy(b"no bendy file")
    assert caught.value.code
    opened = c.open_copy(model.source.bytes)
    assert c.find_clip(opened, "Walk") == 1 and c.joint_constraint(opened, 0) is None


def test_chains_together_and_one_after_another(model):
    left, right = [(0.3, 1.2, 0.4), (-0.3, 1.2, 0.4)]
    one, both = model.sample("Walk", 0.3), model.sample("Walk", 0.3)
    expected = [one.reach("IK_LeftArm", left), one.reach("IK_RightArm", right, solver="ccd", iterations=2)]
    results = both.reach_chains([bendy.ReachRequest("IK_LeftArm", left),
                                 ("IK_RightArm", right, None, {"solver": "ccd", "iterations": 2})])
    numpy.testing.assert_array_equal(both.matrices, one.matrices)
    assert list(map(repr, results)) == list(map(repr, expected)) and all(isinstance(result, bendy.ReachResult) for result in results)
    assert both.reach_chains([]) == []
    before = both.matrices
    for requests, error in [([("IK_LeftArm", left), ("Nose", left)], KeyError), ([("IK_LeftArm", (0, 1))], ValueError),
                            ([("IK_LeftArm", (1, 1, 1)), ("IK_RightArm", right, None, {"influence": 2})], ValueError)]:
        with pytest.raises(error):
            both.reach_chains(requests)
    numpy.testing.assert_array_equal(both.matrices, before)


def test_a_pose_is_for_one_thread_at_a_time(model):
    pose, is_done = model.sample("Walk", 0.3), threading.Event()
    out = pose.skin()

    def skin():
        while not is_done.is_set():
            try:
                pose.skin(out=out)
            except RuntimeError:
                pass

    thread = threading.Thread(target=skin)
    thread.start()
    try:
        with pytest.raises(RuntimeError, match="in use by another thread"):
            end = time.monotonic() + 60
            while time.monotonic() < end:
                pose.sample("Walk", 0.3)
    finally:
        is_done.set()
        thread.join()
    pose.blend(pose, 0.5)  # by one thread, twice


def test_other_calls_of_the_runtime(model):
    """Those that no class of the package has."""
    assert c.kernel() in [c.kernel_name(number) for number in range(c.kernel_count())]
    handle = model._character.handle
    movers = numpy.empty(1, numpy.uint32)
    with pytest.raises(ValueError, match="rigid"):
        c.get_movers(handle, 0, movers)
