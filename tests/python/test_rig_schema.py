"""spec/rig.schema.json and the converter accept the same rig files: in one process, since there are thousands of them."""

import json
import re

import bendy
from conftest import ROOT
from jsonschema import Draft202012Validator

# A small file with the joints that the samples name.
ROW = json.dumps({"asset": {"version": "2.0"}, "nodes": [
    {"name": "seg_00", "children": [1]}, {"name": "seg_01", "children": [2]}, {"name": "x"}]}).encode()
SCHEMA = json.loads((ROOT / "spec/rig.schema.json").read_text(encoding="utf-8"))
PARTS = SCHEMA["$defs"]
SAMPLES = [None, True, 0, 1, 2, -1, 0.5, 70000, "", "x", [], {}, [1], [0, 0], [-1, 1], [None, None], [0, 0, 0],
           [0, 0, 1], [2, 0, 0], [0, 0, 0, 1], {"x": [0, 1]}, {"w": [0, 1]}, {"seg_00": 1}, {"seg_01": 2},
           {"model": "free"}, [{"model": "free"}]]
# What a schema cannot say: joints that are there, lists that go with others, ranges in order that hold 0 where they must, no zero
# rotation.
BEYOND = re.compile(r"there is no joint|nor above it|is above the maximum|must hold 0|is not a rotation|no such joint"
                    r"|expected (a time after|\d+ numbers|a JSON pointer)")


def members(list_name, part, usual):
    """Rig files with one entry in a list of which one member is replaced by each sample, and those that lack one."""
    for key, rule in {**PARTS[part]["properties"], "unknown": {}}.items():
        yield from ({"bendy_rig": 1, list_name: [{**usual, key: sample}]} for sample in SAMPLES + rule.get("enum", []))
        if key in usual:
            yield {"bendy_rig": 1, list_name: [{name: value for name, value in usual.items() if name != key}]}


def rigs():
    yield from (None, [], {}, {"bendy_rig": 2}, {"bendy_rig": 1, "joint": {}})
    for key in SCHEMA["properties"]:
        yield from ({"bendy_rig": 1, key: sample} for sample in SAMPLES)
    constraint = PARTS["constraint"]["properties"]
    for key, rule in {**constraint, "unknown": {}}.items():
        for model in constraint["model"]["enum"] if key in ("order", "x", "y", "z", "angle") else ("hinge",):
            for sample in SAMPLES + rule.get("enum", []):
                yield {"bendy_rig": 1, "joints": {"seg_00": {"model": model, key: sample}}}
    yield from members("chains", "chain", {"name": "c", "start": "seg_00", "effector": "seg_01"})
    yield from members("curves", "curve", {"clip": "c", "name": "n", "times": [0], "values": [0]})


def test_the_schema_accepts_what_is_written_and_the_example(program, mannequin, tmp_path):
    Draft202012Validator.check_schema(SCHEMA)
    validator = Draft202012Validator(SCHEMA)
    tentacle = bendy.convert(ROOT / "examples/tentacle.glb", tmp_path / "tentacle.bendy").output
    for converted in (mannequin, tentacle):
        assert validator.is_valid(json.loads(program("rig", converted)))
    example = (ROOT / "spec/rig.md").read_text(encoding="utf-8").partition("```json\n")[2].partition("```")[0]
    assert validator.is_valid(json.loads(example))


def test_the_schema_and_the_converter_agree():
    validator = Draft202012Validator(SCHEMA)
    agreed = {True: 0, False: 0}
    for rig in rigs():
        try:
            if isinstance(rig, dict):
                bendy.convert(ROW, name="row.gltf", rig=rig)
            else:  # what only a file can hold
                bendy._bendy.convert("row.gltf", bendy._source(ROW), "", {}, json.dumps(rig), 0, None)
            is_accepted = True
        except bendy.ConversionError as error:
            if BEYOND.search(str(error)):
                continue
            is_accepted = False
        assert is_accepted == validator.is_valid(rig), rig
        agreed[is_accepted] += 1
    assert min(agreed.values()) > 100
