"""Reads bendy.h, the one description of everything that can be called across languages: its enumerations, structs, handles and
functions, with their comments. The generators of the C layer, of Python and of JavaScript are made from what this returns.

Some of the header's forms are machine-readable:
  float position[3]         an array of so many numbers; finite, if the function reads them
  uint32_t mesh             the name of a part of a model, without more: an index of one (see PARTS)
  TYPE* name   with "/* or NULL */" behind it: it may be NULL, otherwise that is an error
  float* positions          an array of `count` elements of the function, with "N each" in its comment: N numbers for each
  uint32_t field            with a comment that begins "a bendy_NAME": a value of that enumeration
  uint32_t field            with a comment that begins "0 or 1", "1:" or "0: ... 1: ...": a flag
    uint32_t has_X            beside X: whether X is given; in other languages X may be absent
  uint32_t field            with "elsewhere: not NAME" in its comment: other languages have the flag NAME instead, the other way round
  float field               with a comment that begins "0 to 1": nothing below or above
  uint32_t field            with BENDY_NONE in its comment: an index that may be none
  uint32_t field            with a comment that begins "a sum of bendy_NAME": bits, each of which is a flag elsewhere
  struct field              whose first field has a comment that begins "or BENDY_NONE: not used": may be absent elsewhere
  field               with "added later, as all below" in its comment: the first version of the struct ended before it
  const float* mask   with "bendy_joint_count numbers" in its comment: an array of so many; so with a field of the part that is named
                      before it, "bendy_mesh.targets numbers"
  bendy_pose* pose    with "of another model" in its comment: it need not be of the model of the handles before it
  function            with "elsewhere: NAME" in its comment: its name in the classes of other languages
  parameter           with "elsewhere: VALUE if not given" in its comment: its default in other languages
  const char* extras, more, extensions    JSON, which other languages parse
"""

import re
from dataclasses import dataclass, field
from os.path import commonprefix


@dataclass
class Type:
    name: str  # without const and *: "float", "bendy_pose"
    is_const: bool = False
    is_pointer: bool = False

    def __str__(self):
        return ("const " if self.is_const else "") + self.name + ("*" if self.is_pointer else "")


@dataclass
class Field:
    """A field of a struct, or a parameter of a function. count: elements of an array, 0 for a single value."""
    name: str
    type: Type
    count: int = 0
    doc: str = ""
    is_later: bool = False  # the first of those that the first version of a struct did not have

    @property
    def enum(self):
        """The enumeration whose value the number is, or None."""
        found = re.match(r"(?:the |sets the )?an? (bendy_\w+)", self.doc)
        return found and found[1]

    @property
    def is_flag(self):
        return self.type.name == "uint32_t" and bool(re.match(r"0 or 1|1: |0: .*\b1: ", self.doc, re.DOTALL))

    @property
    def inverse(self):
        """The flag that other languages have instead, the other way round, or None."""
        found = re.search(r"elsewhere: not (\w+)", self.doc)
        return found and found[1]

    @property
    def is_fraction(self):
        return self.type.name in ("float", "double") and self.doc.startswith("0 to 1")

    @property
    def sum_of(self):
        """The enumeration of bits whose sum the number is, or None."""
        found = re.match(r"a sum of (bendy_\w+)", self.doc)
        return found and found[1]

    @property
    def may_be_none(self):
        return self.type.name == "uint32_t" and "BENDY_NONE" in self.doc

    @property
    def is_json(self):
        return self.type.name == "char" and self.name in ("extras", "more", "extensions")

    @property
    def may_be_null(self):
        return self.doc.startswith("or NULL")

    @property
    def default(self):
        """What other languages pass if the parameter is not given, as text: a number or a word; or None."""
        found = re.search(r"elsewhere: (\S+) if not given", self.doc)
        return found and found[1]

    @property
    def length(self):
        """How many numbers an array has that no parameter counts: (a function, "") or (a struct, its field); or None."""
        found = re.search(r"(bendy_\w+)(?:\.(\w+))? numbers", self.doc)
        return found and (found[1], found[2] or "")


@dataclass
class Struct:
    name: str
    doc: str
    fields: list
    defaults: list = None  # expressions of C, one for each field, if there is a macro ..._INIT

    @property
    def has_size(self):
        return self.fields[0].name == "size"

    @property
    def presence(self):
        """The index that is BENDY_NONE if the struct, as a field of another one, is not used; or None."""
        return self.fields[0] if self.fields[0].doc.startswith("or BENDY_NONE: not used") else None


@dataclass
class Enum:
    name: str
    doc: str
    values: list  # (name, number, comment)

    @property
    def is_list(self):
        """Whether its values are 0, 1, 2, ..., not flags."""
        return [number for _, number, _ in self.values] == list(range(len(self.values)))

    @property
    def words(self):
        """Its values in other languages: the names without their common prefix."""
        prefix = commonprefix([name for name, _, _ in self.values])
        return [name[prefix.rindex("_") + 1:].lower() for name, _, _ in self.values]


@dataclass
class Function:
    name: str
    result: Type  # None: void
    parameters: list
    doc: str

    @property
    def can_fail(self):
        return bool(self.parameters) and self.parameters[-1].type.name == "bendy_error"

    @property
    def may_be_none(self):
        """Whether the result is an index that may be none, also where no handle is NULL."""
        return self.result.name == "uint32_t" and not self.result.is_pointer and "BENDY_NONE" in self.doc.replace("BENDY_NONE for NULL", "")

    def is_list(self, one):
        """Whether a parameter is an array of structs: `count` follows it, or its comment says so."""
        following = self.parameters[self.parameters.index(one) + 1:][:1]
        is_counted = any(later.name == "count" and not later.type.is_pointer for later in following)
        return is_counted or one.doc.startswith("or NULL if") or "one for each" in one.doc

    @property
    def is_json(self):
        return self.result is not None and self.result.name == "char" and self.name.endswith("_extras")


@dataclass
class Api:
    enums: dict = field(default_factory=dict)
    structs: dict = field(default_factory=dict)
    handles: dict = field(default_factory=dict)  # name: comment
    callbacks: dict = field(default_factory=dict)
    functions: dict = field(default_factory=dict)


def words_of(comment):
    """The text of a comment as one line."""
    return " ".join(re.sub(r"^\s*/?\*+/?|\*/$", " ", comment.strip(), flags=re.MULTILINE).split())


def declaration(text):
    """A field, from `const float* name[3]`, with or without a comment behind it."""
    comments = re.findall(r"/\*.*?\*/", text, re.DOTALL)
    bare = " ".join(re.sub(r"/\*.*?\*/", " ", text, flags=re.DOTALL).split())
    const, kind, star, name, count = re.fullmatch(r"(const )?(\w+)\s?(\*)? ?(\w+)(?:\[(\w+)\])?", bare).groups()
    doc, is_later = re.subn("(; )?added later, as all below$", "", " ".join(map(words_of, comments)))
    return Field(name, Type(kind, bool(const), bool(star)), int(count or 0), doc, is_later == 1)


def items(body, end):
    """(text, comment) of the parts separated by `end` in the body of a struct or enumeration: a comment belongs to the part
    before it."""
    pieces = re.findall(r"(/\*.*?\*/)|([^/%s]+)|(%s)" % (end, end), body, re.DOTALL)
    made = []
    is_open = False
    for comment, text, _ in pieces:
        if comment and made:
            made[-1][1] += " " + comment
        elif text.strip() and not is_open:
            made.append([text, ""])
            is_open = True
        elif text.strip():
            made[-1][0] += text
        elif not comment and not text:
            is_open = False
    return made


def read(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    api = Api()
    inits = {name.lower(): re.sub(r"[{}\\\n]", " ", body) for name, body in
             re.findall(r"#define (BENDY_\w+)_INIT\b((?:[^\n]*\\\n)*[^\n]*\n)", text)}
    text = re.sub(r"^#(.*\\\n)*.*\n", "", text, flags=re.MULTILINE)

    doc = ""  # of the next declaration, until a blank line
    token = re.compile(r"(/\*.*?\*/)|typedef enum \w+ \{(.*?)\} (\w+);|typedef struct \w+ \{(.*?)\} (\w+);|typedef struct \w+ (\w+);"
                       r"|typedef void \(\*(\w+)\)\((.*?)\);|BENDY_API ([\w ]+?\*?) ?(\w+)\(((?:[^;/]|/\*.*?\*/)*?)\);([ \t]*/\*[^\n]*?\*/)?|(\n[ \t]*\n)", re.DOTALL)
    for found in token.finditer(text):
        comment, values, enum, fields, struct, handle, callback, passed, result, function, parameters, behind, blank = found.groups()
        if comment:
            doc = words_of(comment)
        elif blank:
            doc = ""
        elif enum:
            listed = []
            for item, note in items(values, ","):
                name, _, number = item.partition("=")
                listed.append((name.strip(), int(number), words_of(note)))
            api.enums[enum] = Enum(enum, doc, listed)
        elif struct:
            listed = [declaration(item + note) for item, note in items(fields, ";")]
            api.structs[struct] = Struct(struct, doc, listed, inits.get(struct))
        elif handle:
            api.handles[handle] = doc
        elif callback:
            api.callbacks[callback] = Function(callback, None, [declaration(one) for one in passed.split(",")], doc)
        else:
            pieces = [] if parameters.strip() == "void" else re.split(r",(?![^/]*\*/)", parameters)
            listed = [declaration(piece) for piece in pieces]
            kind = None if result == "void" else declaration(result + " result").type
            api.functions[function] = Function(function, kind, listed, " ".join(filter(None, [doc, words_of(behind or "")])))
    assert len(api.functions) == len(re.findall(r"^BENDY_API ", text, re.MULTILINE)), "a function that is not read"
    for struct in api.structs.values():
        if struct.defaults is not None:
            struct.defaults = defaults_of(struct, api, struct.defaults)
    return api


def defaults_of(struct, api, listed):
    """The expressions of an initialiser for each field; those of an array in a list."""
    values = [value.strip() for value in listed.split(",")]
    defaults = []
    for one in struct.fields:
        is_array = one.count and one.type.name != "char"
        count = one.count if is_array else 1
        defaults.append(values[:count] if is_array else values[0])
        values = values[count:]
    return defaults
