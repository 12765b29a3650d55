"""Makes TypeScript objects from the structs of bendy.h: their interfaces with documentation, and the code that reads and writes them."""

import re

from methods import class_of, name_of

# type: size and alignment in bytes, DataView's method
NUMBERS = {"uint32_t": (4, "Uint32"), "int32_t": (4, "Int32"), "float": (4, "Float32"), "size_t": (4, "Uint32"), "double": (8, "Float64"),
           "uint64_t": (8, "BigUint64"), "int64_t": (8, "BigInt64")}
JSON = {"extras": "Application-specific data: JSON, parsed; null if there is none.",
        "extensions": "The glTF source's extensions: JSON, parsed; null if there are none.",
        "more": "The members of the glTF source that no field holds: JSON, parsed; null if there are none."}


def camel(name):
    first, *rest = name.split("_")
    return first + "".join(word[:1].upper() + word[1:] for word in rest)


def short(name):
    return name.removeprefix("bendy_")


def pascal(name):
    """bendy_joint: BendyJoint, so that it is not the Joint of the package."""
    return camel("_" + name)


def is_text(field):
    return field.type.name == "char" and field.type.is_const and field.type.is_pointer


def array_type(count):
    """The type of an array that callers give: three numbers are a point or a direction, four a unit quaternion."""
    return {3: "PointLike", 4: "RotationLike"}.get(count, "ArrayLike<number>")


def comment(text, indent=""):
    return [f"{indent}/** {text} */"] if text else []


class Layout:
    """The offsets of a struct's fields."""

    def __init__(self, struct, layouts):
        self.places, self.size, self.alignment = {}, 0, 1
        for field in struct.fields:
            if field.type.is_pointer:
                size = alignment = 4
            elif field.type.name == "char":
                size = alignment = 1
            elif field.type.name in NUMBERS:
                size = alignment = NUMBERS[field.type.name][0]
            else:
                size, alignment = layouts[field.type.name].size, layouts[field.type.name].alignment
            self.size = -(-self.size // alignment) * alignment
            self.places[field.name] = self.size
            self.size += size * (field.count or 1)
            self.alignment = max(self.alignment, alignment)
        self.size = -(-self.size // self.alignment) * self.alignment


def members_that_call(source):
    """For each function of bendy.h, the members of TypeScript's classes in whose bodies it is called; those that are private do not count."""
    members, member = {}, ""
    for line in source.splitlines():
        begun = re.match(r"  (?:static |async |get |set )*([#\w]+)(?:<\w+>)?\(", line)
        if begun or line.startswith("}"):
            member = begun[1] if begun else ""
        for function in re.findall(r"\.(bendy_\w+)\(", line):
            if member and member != "constructor" and not member.startswith("#"):
                members.setdefault(function, set()).add(member)
    return members


class Structs:
    """read: the names of the structs that a function fills. given: those that callers give as objects.
    source: the TypeScript that calls the functions."""

    def __init__(self, api, source=""):
        self.api = api
        self.callers = members_that_call(source)
        self.layouts = {}
        for struct in api.structs.values():
            self.layouts[struct.name] = Layout(struct, self.layouts)
        self.values = {name: word for enum in api.enums.values() for (name, _, _), word in zip(enum.values, enum.words)}
        filled = {one.type.name for function in api.functions.values() for one in function.parameters
                  if one.type.is_pointer and not one.type.is_const}
        for struct in reversed(api.structs.values()):  # a struct is declared after those that it contains
            if struct.name in filled:
                filled |= {field.type.name for field in struct.fields}
        self.read = filled & set(api.structs)
        self.given = {struct.name for struct in api.structs.values() if self.is_given(struct)}

    # ---- Documentation

    def method_of(self, name):
        """What TypeScript has of a function: the method that calls it, if there is one, or the one that follows from its name."""
        function = self.api.functions[name]
        callers = self.callers.get(name, ())
        return next(iter(callers)) if len(callers) == 1 else camel(name_of(function, class_of(function, self.api)))

    def phrase(self, doc, is_flag=False, is_inverse=False):
        """A comment of the header for readers of TypeScript."""
        doc = re.sub(r"(^|[;.]? ?)elsewhere: not \w+$", "", doc)
        doc = re.sub(r"^(the )?an? (sum of )?bendy_\w+([:,;.] ?|$)", "", doc)  # the type already says it
        if is_flag:
            doc = re.sub(r"^0 or 1([:;] ?|$)", "", doc)
            doc = re.sub(r"\b([01]): ", lambda found: f"{(found[1] == '1') != is_inverse}: ", doc)
        doc = re.sub(r"(^|, )or BENDY_NONE$|^or NULL$", "", doc)
        doc = doc.replace("or BENDY_NONE: ", "null: ").replace("BENDY_NONE", "null").replace("NULL", "null")
        doc = re.sub(r"\bBENDY_\w+", lambda found: f"`{self.values.get(found[0], found[0])}`", doc)
        doc = re.sub(r"\bbendy_\w+", lambda found: f"`{self.method_of(found[0])}`" if found[0] in self.api.functions
                     else pascal(short(found[0])), doc).strip()
        first = doc[:1].upper() if re.match(r"[a-z]{2}|a ", doc) else doc[:1]  # not of "sRGB" and "x y z"
        return doc and first + doc[1:] + ("" if doc[-1] in ".!?" else ".")

    def field_comment(self, field, more=""):
        doc = JSON[field.name] if field.is_json else self.phrase(field.doc, field.is_flag, bool(field.inverse))
        return comment(" ".join(filter(None, [doc, more])), "  ")

    def interface(self, struct, members):
        return comment(self.phrase(struct.doc)) + [f"export interface {pascal(struct.name)} {{", *members, "}", ""]

    # ---- Reading

    def value_type(self, field, is_record):
        kind = self.api.structs.get(field.type.name)
        if kind and not field.type.is_pointer:
            name = pascal(kind.name)
            return (f"Readonly<{name}>" if is_record else name) + (" | null" if kind.presence else "")
        if field.is_json:
            return "unknown"
        if field.type.name == "char":
            return "string"
        if field.count:
            listed = "[" + ", ".join(["number"] * field.count) + "]"
            return f"readonly {listed}" if is_record else listed
        if field.enum:
            return pascal(short(field.enum))
        if field.is_flag:
            return "boolean"
        return "number | null" if field.may_be_none else "number"

    def value(self, field, place):
        """The expression that reads a field at an offset of the struct."""
        kind = self.api.structs.get(field.type.name)
        if kind and not field.type.is_pointer:
            none = f"view.getUint32(at + {place}, true) === 0xffffffff ? null : " if kind.presence else ""
            return f"{none}read{pascal(kind.name)}(runtime, at + {place})"
        if field.type.is_pointer:
            address = f"view.getUint32(at + {place}, true)"
            return f"runtime.json({address})" if field.is_json else f"runtime.text({address})" if is_text(field) else address
        if field.type.name == "char":
            return f"runtime.text(at + {place})"
        width, method = NUMBERS[field.type.name]
        values = [f"view.get{method}(at + {place + width * i}, true)" for i in range(field.count or 1)]
        if method.startswith("Big"):
            values = [f"Number({value})" for value in values]
        if field.count:
            return f"[{', '.join(values)}]"
        if field.enum:
            return f"{camel(short(field.enum))}Words[{values[0]}]!"
        if field.is_flag:
            return f"{values[0]} !== 0"
        return f"orNull({values[0]})" if field.may_be_none else values[0]

    def flags(self, field, place):
        """(comment, name, expression) of each bit of a sum."""
        enum = self.api.enums[field.sum_of]
        for (_, number, note), word in zip(enum.values, enum.words):
            value = f"(view.getUint32(at + {place}, true) & {number}) !== 0"
            yield comment(self.phrase("1: " + note, True), "  "), camel("is_" + word), value

    def reader(self, struct):
        name, members, values = pascal(struct.name), [], []
        readonly = "readonly " if struct.has_size else ""
        for field in struct.fields:
            place = self.layouts[struct.name].places[field.name]
            if field.name in ("size", "reserved"):
                continue
            if field.sum_of:
                for note, flag, value in self.flags(field, place):
                    members += note + [f"  {readonly}{flag}: boolean;"]
                    values.append(f"    {flag}: {value},")
            elif field is struct.presence:  # the struct is read only where it is used
                members.append(f"  {readonly}{camel(field.name)}: number;")
                values.append(f"    {camel(field.name)}: view.getUint32(at + {place}, true),")
            else:
                members += self.field_comment(field) + [f"  {readonly}{camel(field.name)}: {self.value_type(field, struct.has_size)};"]
                values.append(f"    {camel(field.name)}: {self.value(field, place)},")
        return [*self.interface(struct, members), f"export function read{name}(runtime: Runtime, at: number): {name} {{",
                "  const { view } = runtime;", "  return {", *values, "  };", "}", ""]

    # ---- Writing

    def is_given(self, struct):
        """Whether callers give it as an object: it has defaults, and no pointers to callers' memory."""
        return struct.defaults is not None and struct.name != "bendy_error" and all(
            not field.type.is_pointer or field.type.name in self.api.handles or self.nested(field) for field in struct.fields)

    def nested(self, field):
        """The struct that a field points to, if it is given as an object too."""
        struct = self.api.structs.get(field.type.name)
        return struct if struct and field.type.is_pointer and self.is_given(struct) else None

    def beyond(self, struct):
        """The additional bytes for the structs that it points to."""
        return sum(self.layouts[field.type.name].size for field in struct.fields if self.nested(field))

    def given_type(self, struct):
        """A struct that is also read has the same type, all of whose members may be absent when it is given."""
        return f"Partial<{pascal(struct.name)}>" if struct.name in self.read else pascal(struct.name)

    def literal(self, text):
        """A value of an initialiser."""
        if text in ("NULL", "BENDY_NONE"):
            return "null"
        return f"'{self.values[text]}'" if text in self.values else f"{float(text.rstrip('f')):g}"

    def written(self, field, default, at):
        """The type of a member that is given, the default for its comment, and the statement that writes it."""
        key = camel(field.inverse or field.name)
        value = f"given.{key}"
        if field.type.is_pointer:
            return "Handle", "", f"view.setUint32({at}, runtime.address({value}, '{key}'), true);"
        if field.count:
            put = "putDoubles" if field.type.name == "double" else "putFloats"
            numbers = ", ".join(map(self.literal, default))
            return array_type(field.count), "", f"runtime.{put}({at}, {value} ?? [{numbers}], {field.count}, '{key}');"
        default = self.literal(default)
        if field.enum:
            words = f"{camel(short(field.enum))}Words"
            return pascal(short(field.enum)), default.replace("'", "`"), f"runtime.putWord({at}, {words}, {value} ?? {default}, '{key}');"
        if field.is_flag:
            is_true = (default == "1") != bool(field.inverse)
            chosen = "0 : 1" if field.inverse else "1 : 0"
            chosen = f"({value} ?? {str(is_true).lower()}) ? {chosen}"
            return "boolean", "True" if is_true else "", f"view.setUint32({at}, {chosen}, true);"
        if default == "null":
            kind = "number | null" if field.may_be_none else "number"
            return kind, "", f"runtime.putWhole({at}, {value} ?? 0xffffffff, '{key}');"
        if field.type.name in ("uint32_t", "size_t"):
            return "number", default, f"runtime.putWhole({at}, {value} ?? {default}, '{key}');"
        return "number", default, f"view.set{NUMBERS[field.type.name][1]}({at}, checkNumber({value} ?? {default}, '{key}'), true);"

    def writer(self, struct):
        name, layout = pascal(struct.name), self.layouts[struct.name]
        names = {field.name for field in struct.fields}
        members, lines, beyond = [], [], 0
        for field, default in zip(struct.fields, struct.defaults):
            at, key = f"at + {layout.places[field.name]}", camel(field.inverse or field.name)
            present = field.name.removeprefix("has_")
            if field.name in ("size", "reserved"):
                lines.append(f"view.setUint32({at}, {layout.size if field.name == 'size' else 0}, true);")
            elif present != field.name and present in names:
                lines.append(f"view.setUint32({at}, given.{camel(present)} == null ? 0 : 1, true);")
            elif self.nested(field):
                kind = pascal(field.type.name)
                members += self.field_comment(field) + [f"  {key}?: {kind} | undefined;"]
                write = f"write{kind}(runtime, beyond + {beyond}, given.{key})"
                lines.append(f"view.setUint32({at}, given.{key} == null ? 0 : {write}, true);")
                beyond += self.layouts[field.type.name].size
            else:
                kind, absent, line = self.written(field, default, at)
                is_needed = default == "BENDY_NONE" and not field.may_be_none
                members += self.field_comment(field, f"{absent} if not given." if absent else "")
                members.append(f"  {key}: {kind};" if is_needed else f"  {key}?: {kind} | undefined;")
                lines.append(line)
        names = [re.match(r"  (\w+)\??: ", member)[1] for member in members if not member.startswith("  /**")]
        listed = [] if struct.name in self.read else [
            "/** The names of its members. */",
            f"export const {camel(short(struct.name))}Names: Record<keyof {name}, true> = {{ {', '.join(one + ': true' for one in names)} }};", ""]
        more = ", beyond: number" if beyond else ""
        view = ["  const { view } = runtime;"] if any("view." in line for line in lines) else []
        return [*([] if struct.name in self.read else self.interface(struct, members)),
                f"export function write{name}(runtime: Runtime, at: number, given: {self.given_type(struct)}{more}): number {{",
                *view, *(f"  {line}" for line in lines), "  return at;", "}", "", *listed]

    def all(self):
        lines = []
        for struct in self.api.structs.values():
            layout = self.layouts[struct.name]
            places = [f"{camel(name)}: {at}" for name, at in layout.places.items() if name not in ("size", "reserved")]
            lines.append(f"export const {camel(short(struct.name))}Layout = {{ {', '.join([f'size: {layout.size}', *places])} }} as const;")
            if struct.name in self.read:
                lines += self.reader(struct)
            if struct.name in self.given:
                lines += self.writer(struct)
        return lines
