#!/usr/bin/env python3
"""Writes text.schema.json, the JSON Schema of the text form, from the tables of chunks, records and leaves.

    make_text_schema.py [--check]      --check: only check whether the file is up to date
"""

import json
import sys
from pathlib import Path

import tables

HERE = Path(__file__).resolve().parent
TYPES = ("u8", "i8", "u16", "i16", "u32", "i32", "u64")


def ref(name):
    return {"$ref": f"#/$defs/{name}"}


def number(kind):
    if kind == "f32":
        return {"anyOf": [{"type": "number"}, {"type": "string", "pattern": "^(-?inf|nan:0x[0-9A-Fa-f]{1,8})$"}]}
    bits = int(kind[1:])
    least, most = (0, 2**bits - 1) if kind[0] == "u" else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    return {"type": "integer", "minimum": least, "maximum": most}


def array(kind):
    return {"type": "array", "items": ref(kind)}


def record(records, struct, members=(), is_in_array=False):
    """The object of a record, with additional members: (name, schema)."""
    shortest = records[struct].shortest
    properties, required = {}, []
    for field in records[struct].fields:
        one = ref(field.type)
        schema = one if field.count == 1 else {"type": "array", "items": one, "minItems": field.count, "maxItems": field.count}
        if field.unit == "text":
            schema = {"anyOf": [{"type": "string"}, schema]}
        properties[field.name] = {"description": field.what, **schema}
        if not field.name.startswith("reserved") and (is_in_array or shortest == 0 or field.offset < shortest):
            required.append(field.name)
    properties.update(members)
    if not is_in_array:
        properties["more"] = {"description": "the bytes after those that the other members represent", **ref("digits")}
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


def part_form(part):
    """A member of a leaf's object."""
    if part.kind == "records":
        form = {"type": "array", "items": ref(part.type)}
    elif part.kind == "text":
        form = {"type": "string"}
    elif part.kind == "names":
        form = {"type": "array", "items": {"type": "string"}}
    elif part.kind == "bytes":
        form = ref("digits")
    elif part.type in tables.SIZES:
        form = array(part.type)
    else:  # a field says which
        form = {"type": "array", "items": {"anyOf": [ref("f32"), ref("i16"), ref("u32")]}}
    return {"description": part.what, **form} if part.what else form


def leaf_form(parts, records):
    """The schema of a leaf's content, without its odd part."""
    if [part.kind for part in parts] == ["text"]:
        return {"type": "string"}
    members = {}
    for part in parts:
        if part.kind not in ("record", "odd"):
            forms = members.setdefault(part.name, [])
            if part_form(part) not in forms:
                forms.append(part_form(part))
    members = {name: forms[0] if len(forms) == 1 else {"anyOf": forms} for name, forms in members.items()}
    if parts[0].kind == "record":
        return record(records, parts[0].type, members)
    return {"type": "object", "properties": {**members, "more": ref("digits")}, "required": list(members), "additionalProperties": False}


def leaf_forms(records):
    """The schema of a leaf's content, by id."""
    forms = {leaf: leaf_form(parts, records) for leaf, parts in tables.read_leaves().items()}
    forms["MARK"] = {"type": "object", "properties": {"markers": {"type": "array", "items": {
        "type": "object", "properties": {"seconds": ref("f32"), "name": {"type": "string"}}, "required": ["seconds", "name"],
        "additionalProperties": False}}}, "required": ["markers"], "additionalProperties": False}
    forms["LODD"]["properties"]["table"] = {"description": "for each level: error, vertices alive of each mesh",
                                            "type": "array", "items": {"anyOf": [ref("f32"), ref("u32")]}}
    forms["LODD"]["patternProperties"] = {"^targets_[0-9]+$": array("u32"), "^joined_[0-9]+$": array("u8")}
    forms["PACK"]["properties"].update({"times": array("f32"), "starts": array("u32"), "tracks": ref("digits")})
    forms["PACK"]["patternProperties"] = {"^joints_[0-7]$": array("u16"), "^steps_[0-7]$": array("u8"),
                                          "^bases_([0-9]+_)?[0-7]$": array("i32"), "^widths_[0-9]+_[0-7]$": array("u8"),
                                          "^frames_[0-9]+$": array("u32")}
    return forms


def structs_in_arrays(records):
    """Records that are members: those of arrays of records, and those inside records."""
    of_parts = [part.type for parts in tables.read_leaves().values() for part in parts if part.kind == "records" and part.type != "MarkerRecord"]
    of_fields = [field.type for record in records.values() for field in record.fields if field.type in records]
    return [struct for struct in dict.fromkeys(of_parts + of_fields) if struct in records]


def schema():
    records = tables.read_records()
    forms = leaf_forms(records)
    definitions = {kind: number(kind) for kind in (*TYPES, "f32")}
    definitions["digits"] = {"description": "bytes, two hexadecimal digits each: a string, or several strings to be concatenated",
                             "anyOf": [ref("digitString"), {"type": "array", "items": ref("digitString")}]}
    definitions["digitString"] = {"type": "string", "pattern": "^([0-9A-Fa-f]{2})*$"}
    definitions["bytes"] = {"type": "object", "properties": {"hex": ref("digits")}, "required": ["hex"], "additionalProperties": False}
    definitions["any"] = {"description": "the chunks of a container; the bytes of a leaf; null if only encoded bytes are present",
                          "anyOf": [ref("chunks"), ref("bytes"), {"type": "null"}]}
    definitions["chunks"] = {"type": "array", "items": ref("chunk")}
    properties = {}
    for chunk in tables.read_chunks():
        letters = chunk.id
        has_form = chunk.shape == "leaf" and letters in forms
        properties[letters] = {"description": chunk.what, "anyOf": [*([ref(letters)] if has_form else []), ref("any")]}
        if has_form:
            definitions[letters] = forms[letters]
    properties["required"] = {"description": "a reader that does not know this chunk must refuse the file", "type": "boolean"}
    properties["codec"] = {"description": "how the leaf is encoded: see spec/codecs.md", "type": "integer", "minimum": 1, "maximum": 255}
    properties["encoded"] = {"description": "the encoded bytes; used if they still decode to the content", **ref("digits")}
    definitions["chunk"] = {
        "type": "object", "properties": properties, "additionalProperties": ref("any"),
        "propertyNames": {"pattern": "^([A-Z0-9]{4}|required|codec|encoded)$"}, "minProperties": 1, "maxProperties": 4,
        "dependentRequired": {"codec": ["encoded"], "encoded": ["codec"]}}
    for struct in structs_in_arrays(records):
        definitions[struct] = record(records, struct, is_in_array=True)
    polygons = record(records, "SubmeshRecord", is_in_array=True)
    polygons["properties"] = {"joint": ref("u32"), **polygons["properties"]}
    polygons["required"] = ["joint", *polygons["required"]]
    definitions["JointSubmesh"] = polygons
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "The text form of a Bendy file: see text.md",
        "type": "object",
        "properties": {"$schema": {"type": "string"}, "bendy_text": {"description": "version of the text form", "const": 1},
                       "HEAD": ref("chunks"), "required": {"type": "boolean"}},
        "required": ["bendy_text", "HEAD"],
        "additionalProperties": False,
        "$defs": definitions,
    }


def main():
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(__doc__)
    path = HERE / "text.schema.json"
    text = json.dumps(schema(), indent=1) + "\n"
    if sys.argv[1:] == ["--check"]:
        if path.exists() and path.read_text() == text:
            return 0
        print(f"{path} is not up to date: run {Path(__file__).name}")
        return 1
    path.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
