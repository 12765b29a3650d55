#!/usr/bin/env python3
"""Writes bendy.ksy and bendy.hexpat from bendy.ksy.in and bendy.hexpat.in: what every leaf holds comes from the tables of
format/; the header, and what leaf_parts.def calls odd, is in the templates.

    make_grammar.py [--check]      --check: only say whether the files are what would be written
"""

import re
import sys
import textwrap
from pathlib import Path

import tables

HERE = Path(__file__).resolve().parent
RECORDS = tables.read_records()
VALUES = tables.read_values()
CHUNKS = tables.read_chunks()
# Leaves with an odd part: their types are in the templates.
ODD = {"LODD": ("collapse_sequence", "CollapseSequence"), "PACK": ("packed_tracks", "PackedTracks"), "MARK": ("marker_list", "MarkerList")}


def snake(name):
    return re.sub(r"(?<!^)([A-Z])", r"_\1", name).lower()


def camel(name):
    return "".join(word.capitalize() for word in name.split("_"))


def joint_submesh():
    """The record of JNTS, which is not a struct of records.def: a joint, then a SubmeshRecord."""
    joint = tables.Row(name="joint", type="u32", count=1, offset=0, what="to which the polygons belong", values="", unit="", reference=None)
    return [joint, *RECORDS["SubmeshRecord"].fields]


def merged(parts):
    """The parts, with parts of the same name merged: (part, the part that is present if the first one's condition does not
    hold)."""
    pairs = {}
    for part in parts:
        pairs.setdefault(part.name, []).append(part)
    return [(pair[0], pair[1] if len(pair) > 1 else None) for pair in pairs.values()]


def leaf_types():
    """Type names in small letters -> parts, in the order of leaf_parts.def; leaf -> type name."""
    types, of_leaf = {}, {}
    for leaf, parts in tables.read_leaves().items():
        kinds = [part.kind for part in parts]
        if leaf in ODD:
            of_leaf[leaf] = ODD[leaf][0]
        elif kinds == ["record"]:
            of_leaf[leaf] = snake(parts[0].type)
        elif kinds == ["text"]:
            of_leaf[leaf] = "text"
            types["text"] = parts
        else:
            name = next((known for known, others in types.items() if others == parts), None)
            if name is None:
                name = snake(parts[0].type).removesuffix("_record") if kinds[0] == "record" else leaf.lower() + "_list"
            of_leaf[leaf] = name
            types[name] = parts
    return types, of_leaf


def condition(part, parts, name_of_value):
    """ "packed == 1" as an expression; a value of an enumeration by its name."""
    field, sign, number = part.when.split()
    enumeration = next(f.values for f in RECORDS[parts[0].type].fields if f.name == field)
    value = name_of_value(enumeration, VALUES[enumeration][int(number)]) if enumeration else number
    return f"record.{field} {sign} {value}"


def product(count):
    """ "2 * components" as an expression."""
    return " * ".join(word if word.isdigit() else "record." + word for word in count.split(" * "))


# --- Kaitai Struct ---------------------------------------------------------------------------------------------------

KAITAI = {"u8": "u1", "i8": "s1", "u16": "u2", "i16": "s2", "u32": "u4", "i32": "s4", "u64": "u8", "f32": "f4"}


def kaitai_field(field, shortest):
    keys = [f"id: {field.name}"]
    if field.type == "u8" and field.count > 1:
        keys.append(f"size: {field.count}")
        if field.unit == "text":
            keys.append("type: str")
    else:
        keys.append("type: " + KAITAI.get(field.type, snake(field.type)))
        if field.count > 1:
            keys.append(f"repeat: expr, repeat-expr: {field.count}")
    if field.values:
        keys.append("enum: " + snake(field.values))
    if shortest and field.offset >= shortest:
        keys.append("if: not _io.eof")
    return "      - {%s, doc: \"%s\"}" % (", ".join(keys), field.what)


def kaitai_records():
    lines = []
    for record in RECORDS.values():
        lines += [f"  {snake(record.name)}:", "    seq:"]
        lines += [kaitai_field(field, record.shortest) for field in record.fields]
    return lines


def kaitai_enum_value(enumeration, value):
    return f"{snake(enumeration)}::{value}"


def kaitai_type(part, other):
    """The type of one number: a name, or lines of a switch."""
    if part.type not in tables.SIZES:
        cases = [f"component_type::{kind}: {KAITAI[kind]}" for kind in VALUES["ComponentType"]]
        return ["switch-on: record." + part.type, "cases:", *("  " + case for case in cases)]
    if other is None or other.type == part.type:
        return KAITAI[part.type]
    return None


def kaitai_part(part, other, parts):
    doc = [f'doc: "{part.what}"'] if part.what else []
    if part.kind == "record":
        return [f"      - {{id: record, type: {snake(part.type)}}}"]
    keys, lines = [f"id: {part.name}"], []
    when = f"{condition(part, parts, kaitai_enum_value)}" if part.when else ""
    if part.kind in ("text", "bytes"):
        keys += ["type: str"] if part.kind == "text" else []
        keys.append("size-eos: true" if part.count == "rest" else "size: " + product(part.count))
    elif part.kind == "names":
        keys += ["type: strz", "repeat: eos"]
    else:
        repeat = ["repeat: eos"]
        if part.count != "rest":
            count = product(part.count)
            if other is not None and other.count != part.count:
                count = f"'{when} ? {count} : {product(other.count)}'"
            repeat = ["repeat: expr", "repeat-expr: " + count]
        if part.kind == "records":
            keys += [f"type: {snake(part.type)}"]
            if part.type in RECORDS:
                keys.append(f"size: {RECORDS[part.type].size}")
        else:
            kind = kaitai_type(part, other)
            if kind is None:
                kind = ["switch-on: " + when, "cases:", "  true: " + KAITAI[part.type], "  false: " + KAITAI[other.type]]
            if isinstance(kind, str):
                keys.append("type: " + kind)
            else:
                lines = ["        type:"] + ["          " + line for line in kind]
        keys += repeat
    if when and other is None:
        keys.append("if: " + when)
    keys += doc
    if lines:
        made = [("      - " if k == 0 else "        ") + key for k, key in enumerate(keys)] + lines
    else:
        made = ["      - {%s}" % ", ".join(keys)]
    if part.ending == "padded":
        made.append("      - {id: %s_zeros, size: (16 - _io.pos %% 16) %% 16%s}" % (part.name, ", if: " + when if when else ""))
    return made


def kaitai_types():
    lines = []
    for name, parts in leaf_types()[0].items():
        lines += [f"  {name}:", "    seq:"]
        for part, other in merged(parts):
            lines += kaitai_part(part, other, parts)
        if name == "text":
            lines[-1] = "      - {id: value, type: str, size-eos: true}"
    lines += ["  joint_submesh:", "    seq:"] + [kaitai_field(field, 0) for field in joint_submesh()]
    return lines


def kaitai_enums():
    return ["  %s: {%s}" % (snake(name), ", ".join(f"{k}: {value}" for k, value in enumerate(values))) for name, values in VALUES.items()]


def either(ids, word, indent):
    """ header.id == "HEAD" or ..., on lines of a good length."""
    text = f" {word} ".join(f'header.id~==~"{name}"' for name in ids)
    lines = textwrap.wrap(text, 118, initial_indent=indent, subsequent_indent=indent)
    return "\n".join(lines).lstrip().replace("~", " ")


def write_kaitai():
    _, of_leaf = leaf_types()
    leaves = [chunk.id for chunk in CHUNKS if chunk.shape == "leaf"]
    return {
        "CONTAINERS": either([chunk.id for chunk in CHUNKS if chunk.shape == "container"], "or", " " * 10),
        "LEAVES": either(leaves, "or", " " * 10),
        "CASES": "".join(f"            '\"{leaf}\"': {of_leaf[leaf]}\n" for leaf in leaves),
        "TYPES": "".join(line + "\n" for line in kaitai_types()),
        "RECORDS": "".join(line + "\n" for line in kaitai_records()),
        "ENUMS": "".join(line + "\n" for line in kaitai_enums()),
    }


# --- ImHex -----------------------------------------------------------------------------------------------------------

IMHEX = {"u8": "u8", "i8": "s8", "u16": "u16", "i16": "s16", "u32": "u32", "i32": "s32", "u64": "u64", "f32": "float"}
KEPT_WORDS = {"any", "u8", "i8", "u16", "i16", "u32", "f32"}  # names that are reserved, or nearly so, in the language


def imhex_name(word):
    return word + "_" if word in KEPT_WORDS else word


def imhex_field(field):
    kind = "char" if field.unit == "text" else field.values or IMHEX.get(field.type, field.type)
    return "    %s %s%s;" % (kind, field.name, f"[{field.count}]" if field.count > 1 else "")


def imhex_struct(name, lines, parameter=""):
    return [f"struct {name}{parameter} {{", *lines, "};", ""]


def imhex_records():
    lines = []
    for record in RECORDS.values():
        lines += imhex_struct(record.name, [imhex_field(field) for field in record.fields])
    return lines


def imhex_enum_value(enumeration, value):
    return f"{enumeration}::{imhex_name(value)}"


def imhex_numbers(part):
    count = "(end - $) / %d" % tables.SIZES.get(part.type, 1) if part.count == "rest" else product(part.count)
    if part.type in tables.SIZES:
        return [f"{IMHEX[part.type]} {part.name}[{count}];"]
    kinds = VALUES["ComponentType"]
    lines = [f"{'else ' if k else ''}if (record.{part.type} == ComponentType::{imhex_name(kind)}) {IMHEX[kind]} {part.name}[{count}];"
             for k, kind in enumerate(kinds[:-1])]
    return lines + [f"else {IMHEX[kinds[-1]]} {part.name}[{count}];"]


def imhex_part(part, parts):
    if part.kind == "record":
        return [f"    {part.type} record;"]
    if part.kind == "text":
        lines = ["char %s[%s];" % (part.name, "end - $" if part.count == "rest" else product(part.count))]
    elif part.kind == "bytes":
        lines = [f"u8 {part.name}[end - $];"]
    elif part.kind == "names":
        lines = [f"Name {part.name}[while($ < end)];"]
    elif part.kind == "records":
        lines = ["%s %s[%s];" % (part.type, part.name, "while($ < end)" if part.count == "rest" else product(part.count))]
    else:
        lines = imhex_numbers(part)
    if part.ending == "padded":
        lines.append("padding[(16 - $ % 16) % 16];")
    if not part.when:
        return ["    " + line for line in lines]
    return [f"    if ({condition(part, parts, imhex_enum_value)}) {{", *("        " + line for line in lines), "    }"]


def imhex_types():
    lines = imhex_struct("Name", ["    char text[];"])
    lines += imhex_struct("JointSubmesh", [imhex_field(field) for field in joint_submesh()])
    for name, parts in leaf_types()[0].items():
        lines += imhex_struct(camel(name), [line for part in parts for line in imhex_part(part, parts)], "<auto end>")
    return lines


def imhex_cases():
    _, of_leaf = leaf_types()
    types = leaf_types()[0]
    for chunk in CHUNKS:
        if chunk.shape != "leaf":
            continue
        name = of_leaf[chunk.id]
        kind = ODD[chunk.id][1] if chunk.id in ODD else camel(name)
        if name in types or chunk.id in ODD:
            yield f'    else if (header.id == "{chunk.id}") {kind}<end> payload;'
            continue
        record = RECORDS[kind]
        if record.shortest < record.size:  # the pattern of the shortest form is in the template
            yield f'    else if (header.id == "{chunk.id}" && size < {record.size}) Short{kind.removesuffix("Record")} payload;'
        yield f'    else if (header.id == "{chunk.id}") {kind} payload;'


def write_imhex():
    types = {field.values: IMHEX[field.type] for record in RECORDS.values() for field in record.fields if field.values}
    enums = ["enum %s : %s { %s };" % (name, types[name], ", ".join(f"{imhex_name(value)} = {k}" for k, value in enumerate(values)))
             for name, values in VALUES.items()]
    return {
        "CONTAINERS": either([chunk.id for chunk in CHUNKS if chunk.shape == "container"], "||", " " * 12),
        "CASES": "".join(line + "\n" for line in imhex_cases()),
        "TYPES": "\n".join(imhex_types()),
        "RECORDS": "\n".join(imhex_records()),
        "ENUMS": "".join(line + "\n" for line in enums),
    }


def main():
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(__doc__)
    is_same = True
    for name, write in (("bendy.ksy", write_kaitai), ("bendy.hexpat", write_imhex)):
        text = (HERE / (name + ".in")).read_text(encoding="utf-8")
        for word, made in write().items():
            text = text.replace(f"@{word}@", made)
        path = HERE / name
        if sys.argv[1:] != ["--check"]:
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != text:
            print(f"{path} is not what {Path(__file__).name} writes")
            is_same = False
    return 0 if is_same else 1


if __name__ == "__main__":
    sys.exit(main())
