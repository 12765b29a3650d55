#!/usr/bin/env python3
"""Holds bendy.h against the C++ runtime: check_counterparts.py --source DIR --list TXT

Everything that <bendy/runtime.h> and the format's views behind it declare in public must have a line in the list: the
declaration, ` -> `, and its counterparts in bendy.h (functions, structs, struct.field, enumerations, constants), or a reason
in parentheses why C has none. `*::field` stands for that field of every type. No line is needed for a field whose struct has a
counterpart with a field of that name, nor for what a type without a counterpart has. An enumeration must have the same values as
its counterpart."""

import argparse
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "bindings"))
import describe  # noqa: E402

# Of the format's headers, the types that a Model hands out.
VIEWS = {
    "clip.h": ["TrackView", "ClipView"],
    "constraint.h": ["ConstraintView"],
    "curve.h": ["CurveView"],
    "ik_chain.h": ["ChainView"],
    "joint.h": ["SubmeshView", "ChainWeightView"],
    "lod.h": ["MeshCollapseView", "CollapseView"],
    "marker.h": ["Marker"],
    "material.h": ["MaterialView", "ImageView", "TextureView"],
    "mesh.h": ["StreamView", "PaletteView", "MorphTargetView", "AttributeView", "MeshView"],
    "records.h": ["SamplerRecord", "SameRecord", "TextureUseRecord", "SurfaceRecord", "ConstraintRecord", "ChainRecord",
                  "ChainWeightRecord", "PlayRecord", "RoleRecord", "Role",
                  "ComponentType", "Topology", "TrackPath", "Interpolation", "CurveTarget", "Filter", "Wrap", "AlphaMode",
                  "MediaType", "ConstraintModel", "EulerOrder", "ConstraintScope", "Solver"],
}


def matching(text, at, pair):
    """The index after the bracket that closes the one at `at`."""
    depth = 0
    for k in range(at, len(text)):
        depth += (text[k] == pair[0]) - (text[k] == pair[1])
        if depth == 0:
            return k + 1
    raise ValueError(f"unbalanced {pair}: {text[at:at + 60]}")


def statements(text):
    """(head, body) of each declaration: body is what stands between braces, of a function, a type or a namespace; otherwise None."""
    at = 0
    start = 0
    while at < len(text):
        if text[at] == "(":
            at = matching(text, at, "()")
        elif text[at] == ";":
            yield " ".join(text[start:at].split()), None
            at += 1
            start = at
        elif text[at] == "{":
            head = " ".join(text[start:at].split())
            end = matching(text, at, "{}")
            is_type = re.match(r"(template ?<.*> ?)?(class|struct|enum|namespace)\b", head)
            is_function = not is_type and ("operator" in head or "(" in re.sub(r"=.*", "", head))
            if is_type or is_function:
                yield head, text[at + 1:end - 1]
                at = end
                while is_type and at < len(text) and text[at] in " \n;":
                    at += 1
                start = at
            else:  # an initialiser
                text = text[:at] + " " * (end - at) + text[end:]
        elif re.match(r"(public|private|protected):", text[at:]):
            label = re.match(r"\w+:", text[at:]).group()
            yield label, None
            at += len(label)
            start = at
        else:
            at += 1


def without_template(head):
    while head.startswith("template"):
        head = head[matching(head, head.index("<"), "<>"):].strip()
    return head


def parameters(text):
    """The parameters without their defaults."""
    parts, depth, start = [], 0, 0
    for k, letter in enumerate(text + ","):
        depth += letter in "<({"
        depth -= letter in ">)}"
        if letter == "," and depth == 0:
            parts.append(re.sub(r"\s*=.*", "", text[start:k].strip()))
            start = k + 1
    return ", ".join(part for part in parts if part)


def fields_of(head):
    """The names that a declaration of data declares."""
    head = re.sub(r"=[^,]*", "", head)
    while "<" in head:
        at = head.index("<")
        head = head[:at] + head[matching(head, at, "<>"):]
    return [re.sub(r"\[.*", "", part).split()[-1] for part in head.split(",")]


def declared(text, owner="", is_public=True):
    """{name: the values of an enumeration, or None} of what the text declares in public."""
    found = {}
    prefix = owner + "::" if owner else ""
    for head, body in statements(text):
        if head in ("public:", "private:", "protected:"):
            is_public = head == "public:"
            continue
        head = without_template(head)
        if not is_public or not head or head.startswith(("static_assert", "friend struct", "friend class")):
            continue
        if match := re.match(r"enum class (\w+)", head):
            if body is not None:
                found[prefix + match[1]] = re.findall(r"(\w+)[^,]*", body)
            continue
        if match := re.match(r"(class|struct) (?:alignas\(\d+\) )?(\w+)", head):
            if body is None:
                continue
            found[prefix + match[2]] = None
            found.update(declared(body, prefix + match[2], match[1] == "struct"))
            continue
        if match := re.match(r"using (\w+) =", head):
            found[prefix + match[1]] = None
            continue
        call = re.search(r"(operator ?[^\s(]+|~?\w+) ?\(", head if "operator" in head else re.sub(r"=.*", "", head))
        if call is None:
            for name in fields_of(head):
                found[prefix + name] = None
            continue
        name = call[1]
        arguments = parameters(head[call.end():matching(head, call.end() - 1, "()") - 1])
        own = owner.split("::")[-1]
        if name == "~" + own or (name in (own, "operator=") and re.fullmatch(rf"(const )?{own}&&? \w+", arguments)):
            continue  # C has _free, and does not copy handles by assignment
        if name == own and not arguments:
            continue
        found[f"{prefix}{name}({arguments})"] = None
    return found


def public_part(header):
    """What a header declares in namespace bendy, without comments and attributes."""
    text = header.read_text()
    text = re.sub(r"//.*", "", text)
    text = re.sub(r"^\s*#.*(\\\n.*)*$", "", text, flags=re.M)
    text = re.sub(r"\[\[.*?\]\]", "", text)
    parts = []
    for match in re.finditer(r"namespace BENDY_PUBLIC bendy \{", text):
        parts.append(text[match.end():matching(text, match.end() - 1, "{}") - 1])
    return "\n".join(parts)


def in_cpp(source):
    found = {}
    runtime = source / "runtime/include/bendy/runtime"
    for header in sorted(runtime.glob("*.h")):
        found.update(declared(public_part(header)))
    for header, types in VIEWS.items():
        names = declared(public_part(source / "format/include/bendy/format" / header))
        if header == "records.h":  # makes its structs and enumerations from a table
            table = (source / "format/include/bendy/format/records.def").read_text()
            fields = re.findall(r"^BENDY_(?:FIELD|CONSTANT)\((\w+), (\w+),", table, re.M)
            names.update({name: None for struct, field in fields for name in (struct, f"{struct}::{field}")})
            rows = re.findall(r"^BENDY_VALUES\((\w+), \w+, (.+)\)$", table, re.M)
            names.update({name: values.split(", ") for name, values in rows})
        found.update({name: values for name, values in names.items() if name.split("::")[0] in types})
    return found


def in_c(source):
    """({names}, {struct: fields}, {enumeration: values as other languages have them}) of bendy.h."""
    header = source / "bindings/c/include/bendy.h"
    text = re.sub(r"/\*.*?\*/", "", header.read_text(), flags=re.S)
    names = set(re.findall(r"^BENDY_API [^;(]*?(bendy_\w+)\(", text, re.M))
    names |= set(re.findall(r"^#define (BENDY_\w+)", text, re.M)) | set(re.findall(r"^typedef struct \w+ (\w+);", text, re.M))
    names |= set(re.findall(r"^typedef void \(\*(\w+)\)", text, re.M))
    structs = {name: set(re.findall(r"(\w+)(?:\[\w+\])?;", body))
               for name, body in re.findall(r"typedef struct (bendy_\w+) \{(.*?)\} \1;", text, re.S)}
    enums = describe.read(header).enums.values()
    names |= {name for enum in enums for name, _, _ in enum.values}
    return names, structs, {enum.name: enum.words for enum in enums}


def read_list(path):
    """{declaration: [counterparts], or a reason}"""
    lines = {}
    for line in path.read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        declaration, _, rest = line.partition(" -> ")
        if not rest or declaration in lines:
            sys.exit(f"{path.name}: a line without ` -> `, or a second one: {line}")
        lines[declaration] = rest if rest.startswith("(") else rest.split(", ")
    return lines


def check_parser():
    """What declared() must find, so that a declaration of a new form is not overlooked in silence."""
    found = declared("""
        enum class Kind : std::uint8_t { a, b = 3 };
        struct Plain { float x = 0.0f, y{1}; std::vector<int> many = {}; };
        class Hidden { void no(); public: explicit Hidden(const Plain& p) : p_(p) {} int get(int k = 0) const { return k; }
            bool operator==(const Hidden& other) const = default; private: Plain p_; };
        template <class T> void visit(std::span<const T> all, const Plain& plain = {}) { if (all.empty()) { return; } }
        inline constexpr int kMost = 4;
        int late(Kind kind);""")
    expected = {"Kind": ["a", "b"], "Plain": None, "Plain::x": None, "Plain::y": None, "Plain::many": None, "Hidden": None,
                "Hidden::Hidden(const Plain& p)": None, "Hidden::get(int k)": None, "Hidden::operator==(const Hidden& other)": None,
                "visit(std::span<const T> all, const Plain& plain)": None, "kMost": None, "late(Kind kind)": None}
    if found != expected:
        sys.exit(f"the parser found {found}")


def main():
    check_parser()
    parser = argparse.ArgumentParser()
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--list", type=Path, required=True)
    arguments = parser.parse_args()
    cpp = in_cpp(arguments.source)
    names, structs, enums = in_c(arguments.source)
    lines = read_list(arguments.list)

    def exists(counterpart):
        struct, _, field = counterpart.partition(".")
        if field:
            return field in structs.get(struct, ())
        return counterpart in names or counterpart in structs or counterpart in enums

    def has_same_field(name):
        owner, _, field = name.rpartition("::")
        counterparts = lines.get(owner, "")
        return isinstance(counterparts, list) and any(field in structs.get(struct, ()) for struct in counterparts)

    def has_reason(name):  # for every such field, or for the type that it is in
        if "*::" + name.rpartition("::")[2] in lines:
            return True
        owner = name.rpartition("::")[0] if "(" not in name else name[:name.index("(")].rpartition("::")[0]
        return isinstance(lines.get(owner), str)

    faults = [f"{name}: in C++, without a line in {arguments.list.name}"
              for name in cpp if name not in lines and not has_same_field(name) and not has_reason(name)]
    faults += [f"{name}: in {arguments.list.name}, and not in C++" for name in lines
               if name not in cpp and not (name.startswith("*::") and any(known.endswith(name[1:]) for known in cpp))]
    for name, counterparts in lines.items():
        if isinstance(counterparts, str):
            if len(counterparts) < 10 or not counterparts.endswith(")"):
                faults.append(f"{name}: a reason is a sentence in parentheses")
            continue
        faults += [f"{name} -> {counterpart}: bendy.h has no such thing" for counterpart in counterparts if not exists(counterpart)]
        values = enums.get(counterparts[0])
        if cpp.get(name) is not None and values is not None and values != cpp[name]:
            faults.append(f"{name} has the values {cpp[name]}, {counterparts[0]} has {values}")
    for fault in faults:
        print(fault)
    return 1 if faults or not cpp else 0


if __name__ == "__main__":
    sys.exit(main())
