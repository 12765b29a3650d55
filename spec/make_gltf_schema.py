#!/usr/bin/env python3
"""Writes gltf/*.schema.json, the JSON Schemas of our glTF extensions, from rig.schema.json: the records are the same, in glTF's notation.

    make_gltf_schema.py [--check]      --check: only check whether the files are up to date
"""

import json
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
JOINTS = ("start", "effector", "target", "pole")
FURTHER = {"extensions": {"type": "object"}, "extras": {}}
WEIGHTS = {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/weight"},
           "description": "How much nodes of the chain turn; 1 each if left out"}
WEIGHT = {"type": "object", "required": ["node", "weight"], "additionalProperties": False,
          "properties": {"node": {"$ref": "#/$defs/node"}, "weight": {"$ref": "#/$defs/fraction"}}}


def camel(word):
    return re.sub(r"_([a-z])", lambda found: found[1].upper(), word)


def in_notation(schema):
    """Keys and words in camelCase, and radians."""
    if isinstance(schema, list):
        return [in_notation(each) for each in schema]
    if not isinstance(schema, dict):
        return schema
    changed = {}
    for key, value in schema.items():
        if key in ("properties", "dependentSchemas"):
            changed[key] = {camel(name): in_notation(each) for name, each in value.items()}
        elif key == "description":
            changed[key] = value.replace("Degrees", "Radians").replace("joint", "node")
        elif key in ("enum", "const"):
            changed[key] = [camel(word) if isinstance(word, str) else word for word in value] if key == "enum" else camel(value)
        else:
            changed[key] = in_notation(value)
    return changed


def definitions(rig, *names):
    found = {name: in_notation(rig["$defs"][name]) for name in names}
    return found | {"flag": {"type": "boolean"}}


def file_schema(title, description, member, item, defs):
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": title,
        "description": description,
        "type": "object",
        "required": [member],
        "additionalProperties": False,
        "properties": {member: {"type": "array", "minItems": 1, **item}, **FURTHER},
        "$defs": defs,
    }


def schemas(rig):
    limits = definitions(rig, "fraction", "three", "quaternion", "range", "constraint")
    limits["constraint"]["properties"] |= FURTHER
    chains = definitions(rig, "fraction", "three", "quaternion", "chain")
    chain = chains["chain"]
    chain["required"] = ["start", "effector"]
    for name in JOINTS:
        chain["properties"][name]["$ref"] = "#/$defs/node"
        del chain["properties"][name]["type"]
    chain["properties"] |= {"weights": WEIGHTS} | FURTHER
    chains |= {"weight": WEIGHT, "node": {"description": "Number of a node", "type": "integer", "minimum": 0}}
    standing = definitions(rig, "three", "quaternion", "standing_pose")
    pose = standing["standing_pose"]
    pose["properties"]["rotations"] = {
        "description": "Nodes and their rotations in model space", "type": "array", "items": {"$ref": "#/$defs/standing_rotation"}}
    pose["properties"] |= FURTHER
    standing |= {
        "standing_rotation": {
            "type": "object", "required": ["node", "rotation"], "additionalProperties": False,
            "properties": {"node": {"$ref": "#/$defs/node"},
                           "rotation": {"description": "x y z of a unit quaternion whose w is not negative", "$ref": "#/$defs/three"}}},
        "node": chains["node"]}
    del standing["flag"]
    roles = [camel(word) for word in rig["properties"]["roles"]["propertyNames"]["enum"]]
    role = {
        "type": "object",
        "required": ["role"],
        "additionalProperties": False,
        "properties": {
            "role": {"enum": roles},
            "place": {"description": "Of a chain: the node's place in it, ascending from the body outwards", "type": "integer",
                      "minimum": 0, "maximum": 65535},
        } | FURTHER,
    }
    return {
        "node.BENDY_joint_role.schema.json": {
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "title": "BENDY_joint_role",
            "description": "What a node is in the body; gltf.md describes it.",
            "$ref": "#/$defs/role",
            "$defs": {"role": role},
        },
        "node.BENDY_joint_limits.schema.json": file_schema(
            "BENDY_joint_limits", "What a node's rotation and translation may be, relative to its rest transform; gltf.md describes it.",
            "limits", {"maxItems": 3, "items": {"$ref": "#/$defs/constraint"}}, limits),
        "glTF.BENDY_ik_chains.schema.json": file_schema(
            "BENDY_ik_chains", "Chains of nodes that turn together so that a tip reaches a target; gltf.md describes them.",
            "chains", {"items": {"$ref": "#/$defs/chain"}}, chains),
        "glTF.BENDY_standing_pose.schema.json": {
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "title": "BENDY_standing_pose",
            "description": "The pose in which the body stands, if that is not the rest pose; gltf.md describes it.",
            "$ref": "#/$defs/standing_pose",
            "$defs": standing,
        },
    }


def main():
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(__doc__)
    is_check = sys.argv[1:] == ["--check"]
    rig = json.loads((HERE / "rig.schema.json").read_text(encoding="utf-8"))
    status = 0
    for name, schema in schemas(rig).items():
        path = HERE / "gltf" / name
        text = json.dumps(schema, indent=1) + "\n"
        if not is_check:
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != text:
            print(f"{path} is not up to date: run {Path(__file__).name}")
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main())
