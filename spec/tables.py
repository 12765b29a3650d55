"""The tables of format/ as Python data, for the scripts that generate files from them: chunk_ids.def, records.def,
leaf_parts.def."""

import re
from pathlib import Path
from types import SimpleNamespace as Row

TABLES = Path(__file__).resolve().parent.parent / "format/include/bendy/format"
SIZES = {"u8": 1, "i8": 1, "u16": 2, "i16": 2, "u32": 4, "i32": 4, "u64": 8, "f32": 4}


def rows(name, macro):
    """The arguments of every row BENDY_<macro>(...) of a table, strings without their quotes."""
    for arguments in re.findall(rf"^BENDY_{macro}\((.*)\)$", (TABLES / name).read_text(encoding="utf-8"), re.M):
        yield [quoted if quoted or text == '""' else text for text, quoted in
               re.findall(r'("([^"]*)"|[^,"\s][^,"]*)', arguments) for text in [text.strip()]]


def read_chunks():
    """Rows in the table's order: id, shape, parents (a list), times, what."""
    return [Row(id=letters, shape=shape, parents=parents.replace("-", "").split(), times=times, what=what)
            for letters, shape, parents, times, what in rows("chunk_ids.def", "CHUNK")]


def read_records():
    """struct -> row: chunk, shortest, size, fields; of a field: name, type, count, offset, what, values and unit (empty or a
    name), reference (None or a row: things, selector, need)."""
    records = {}
    for chunk, struct, shortest in rows("records.def", "RECORD"):
        records[struct] = Row(name=struct, chunk=chunk, shortest=int(shortest), fields=[])
    for struct, name, kind, count, offset, what, *_ in rows("records.def", "FIELD"):
        records[struct].fields.append(Row(name=name, type=kind, count=int(count), offset=int(offset), what=what, values="",
                                          unit="", reference=None))
    field = {(struct, field.name): field for struct, record in records.items() for field in record.fields}
    for struct, name, values in rows("records.def", "ENUM"):
        field[struct, name].values = values
    for struct, name, unit in rows("records.def", "UNIT"):
        field[struct, name].unit = unit
    for struct, name, thing, need in rows("records.def", "REFERENCE"):
        field[struct, name].reference = Row(things=[thing], selector="", need=need)
    for struct, name, selector, things, need in rows("records.def", "REFERENCE_BY"):
        field[struct, name].reference = Row(things=things.split(), selector=selector, need=need)
    for record in records.values():
        last = record.fields[-1]
        record.size = last.offset + last.count * (SIZES[last.type] if last.type in SIZES else records[last.type].size)
    return records


def read_values():
    """enumeration -> names of its values from 0 on"""
    return {name: names for name, _, *names in rows("records.def", "VALUES")}


def read_leaves():
    """id -> parts in their order; of a part: kind, name, type, count, when, row, ending, each, to, what."""
    leaves = {}
    columns = ("kind", "name", "type", "count", "when", "row", "ending", "each", "to", "what")
    for ids, *cells in rows("leaf_parts.def", "PART"):
        for leaf in ids.split():
            leaves.setdefault(leaf, []).append(Row(**dict(zip(columns, cells, strict=True))))
    return leaves
