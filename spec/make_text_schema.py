#!/usr/bin/env python3
"""Writes text.schema.json, the JSON Schema of the text form, from the tables of chunks and records.

    make_text_schema.py [--check]      --check: only check whether the file is up to date
"""

import json
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
TABLES = HERE.parent / "format/include/bendy/format"
STREAMS = ("POSI", "NORM", "TANG", "TEXC", "COLR", "BONE", "WGHT", "VALS", "INDX")
TEXTS = ("NAME", "EXTR", "EXTN", "MORE", "LINK")
TYPES = ("u8", "i8", "u16", "i16", "u32", "i32", "u64")


def ref(name):
    return {"$ref": f"#/$defs/{name}"}


def read_tables():
    """Chunks as (id, shape, what), records as {struct: (chunk, shortest, fields)}."""
    chunks = re.findall(r'^BENDY_CHUNK\((\w+),\s*(\w+),.*"([^"]*)"\)', (TABLES / "chunk_ids.def").read_text(), re.M)
    records = {}
    for line in (TABLES / "records.def").read_text().splitlines():
        if opened := re.match(r"BENDY_RECORD\((\w+), (\w+), (\d+)\)", line):
            records[opened[2]] = (opened[1], int(opened[3]), [])
        elif field := re.match(r'BENDY_FIELD\((\w+), +(\w+), +(\w+), +(\d+), +(\d+), +"(.*)"\)', line):
            records[field[1]][2].append((field[2], field[3], int(field[4]), int(field[5]), field[6]))
    return chunks, records


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
    _, shortest, fields = records[struct]
    properties, required = {}, []
    for name, kind, count, offset, what in fields:
        one = ref(kind)
        schema = one if count == 1 else {"type": "array", "items": one, "minItems": count, "maxItems": count}
        if name == "generator":
            schema = {"anyOf": [{"type": "string"}, schema]}
        properties[name] = {"description": what, **schema}
        if not name.startswith("reserved") and (is_in_array or shortest == 0 or offset < shortest):
            required.append(name)
    properties.update(members)
    if not is_in_array:
        properties["more"] = {"description": "the bytes after those that the other members represent", **ref("digits")}
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


def leaf_forms(records):
    """The schema of a leaf's content, by id."""
    forms = {name: {"type": "string"} for name in TEXTS}
    of_chunk = {chunk: struct for struct, (chunk, _, _) in records.items()}
    for chunk, struct in of_chunk.items():
        forms[chunk] = record(records, struct)
    stream = record(records, "StreamRecord", {"box": {"description": "minimum and step of each component", **array("f32")},
                                              "values": {"description": "elements x components numbers",
                                                         "type": "array", "items": {"anyOf": [ref("f32"), ref("i16"), ref("u32")]}}})
    forms.update(dict.fromkeys(STREAMS, stream))
    forms["JNAM"] = forms["FNAM"] = {"type": "object", "properties": {"names": {"type": "array", "items": {"type": "string"}}, "more": ref("digits")},
                     "required": ["names"], "additionalProperties": False}
    for chunk in ("TIME", "KEYV", "GRID", "NLST"):
        forms[chunk] = {"type": "object", "properties": {"values": array("f32"), "more": ref("digits")},
                        "required": ["values"], "additionalProperties": False}
    forms["TRAK"] = {"type": "object", "properties": {"tracks": {"type": "array", "items": ref("TrackRecord")}, "more": ref("digits")},
                     "required": ["tracks"], "additionalProperties": False}
    forms["PLAY"] = {"type": "object", "properties": {"plays": {"type": "array", "items": ref("PlayRecord")}, "more": ref("digits")},
                     "required": ["plays"], "additionalProperties": False}
    forms["MARK"] = {"type": "object", "properties": {"markers": {"type": "array", "items": {
        "type": "object", "properties": {"seconds": ref("f32"), "name": {"type": "string"}}, "required": ["seconds", "name"],
        "additionalProperties": False}}}, "required": ["markers"], "additionalProperties": False}
    forms["PALT"] = record(records, "PaletteRecord", {"joints": array("u32"), "matrices": array("f32")})
    forms["JNTS"] = record(records, "JointsRecord", {"rests": {"type": "array", "items": ref("RestRecord")},
                                                     "ranges": {"type": "array", "items": ref("JointPolygons")}})
    forms["LODD"] = record(records, "CollapseRecord", {"collapses": {"type": "array", "items": ref("PoolCollapseRecord")},
                                                       "table": {"description": "for each level: error, vertices alive of each mesh",
                                                                 "type": "array", "items": {"anyOf": [ref("f32"), ref("u32")]}}})
    forms["LODD"]["patternProperties"] = {"^targets_[0-9]+$": array("u32"), "^joined_[0-9]+$": array("u8")}
    forms["IMAG"] = record(records, "ImageRecord", {"image": ref("digits")})
    forms["PACK"] = record(records, "PackRecord", {"times": array("f32"), "starts": array("u32"), "tracks": ref("digits")})
    forms["PACK"]["patternProperties"] = {"^joints_[0-7]$": array("u16"), "^steps_[0-7]$": array("u8"),
                                          "^bases_([0-9]+_)?[0-7]$": array("i32"), "^widths_[0-9]+_[0-7]$": array("u8"),
                                          "^frames_[0-9]+$": array("u32")}
    return forms


def schema():
    chunks, records = read_tables()
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
    for letters, shape, what in chunks:
        has_form = shape == "leaf" and letters in forms
        properties[letters] = {"description": what, "anyOf": [*([ref(letters)] if has_form else []), ref("any")]}
        if has_form:
            definitions[letters] = forms[letters]
    properties["required"] = {"description": "a reader that does not know this chunk must refuse the file", "type": "boolean"}
    properties["codec"] = {"description": "how the leaf is encoded: see spec/codecs.md", "type": "integer", "minimum": 1, "maximum": 255}
    properties["encoded"] = {"description": "the encoded bytes; used if they still decode to the content", **ref("digits")}
    definitions["chunk"] = {
        "type": "object", "properties": properties, "additionalProperties": ref("any"),
        "propertyNames": {"pattern": "^([A-Z0-9]{4}|required|codec|encoded)$"}, "minProperties": 1, "maxProperties": 4,
        "dependentRequired": {"codec": ["encoded"], "encoded": ["codec"]}}
    for struct in ("TrackRecord", "PlayRecord", "RestRecord", "PoolCollapseRecord", "TextureUseRecord"):
        definitions[struct] = record(records, struct, is_in_array=True)
    polygons = record(records, "PolygonRecord", is_in_array=True)
    polygons["properties"] = {"joint": ref("u32"), **polygons["properties"]}
    polygons["required"] = ["joint", *polygons["required"]]
    definitions["JointPolygons"] = polygons
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
