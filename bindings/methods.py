"""What follows from bendy.h for the class of a handle in Python and in JavaScript: properties and methods, with their documentation.

A function belongs to the class of its first parameter, under its own name without bendy_ and the handle's: bendy_playback_seek is
`seek` of a playback, unless its comment says "elsewhere: NAME".
  bendy_get_HANDLE, a function of the handle alone that returns a number     properties: the fields of the struct, the number
  ..._set_PROPERTY                                                           makes the property one that can be set
  a function of numbers, words, parts of the model, poses, masks             a method; without a result, it returns the object
All others are written by hand; so is each that a class wants otherwise.
"""

import re
from dataclasses import dataclass

from make_c import PARTS

ONLY_C = re.compile(r"\b(for|be) NULL\b|\bpointers\b|^(Not in JavaScript|Only for C|elsewhere): ")


@dataclass
class Property:
    name: str
    function: object
    field: object  # of the struct that the function fills; None: the function's result
    setter: object = None

    @property
    def doc(self):
        """The comment of the field, or what the function returns."""
        if self.field:
            return self.field.doc
        return re.sub(r"^Returns (\w)|, 1 or 0\b", lambda found: (found[1] or "").upper(), documentation(self.function))

    @property
    def is_flag(self):
        return self.field.is_flag if self.field else self.function.doc.startswith("Returns whether ")


@dataclass
class Method:
    name: str
    function: object
    given: list  # parameters behind the object, in C's order
    out: object  # the parameter that it fills, which is the method's result; or None

    @property
    def taken(self):
        """The parameters as a caller gives them: those that may be left out come last."""
        return sorted(self.given, key=lambda one: one.may_be_null or one.default is not None)


def bare(name):
    return name[len("bendy_"):]


def name_of(function, handle):
    elsewhere = re.search(r"(?:^|[;.] )elsewhere: (\w+)", function.doc)  # a clause of its own: not "for skinning elsewhere: the bones"
    name, prefix = bare(function.name), bare(handle or "bendy_") + "_"
    return elsewhere[1] if elsewhere else name[len(prefix):] if name.startswith(prefix) else name


def class_of(function, api):
    """The handle whose class has the function, or None."""
    return next((one.type.name for one in function.parameters[:1] if one.type.name in api.handles), None)


def documentation(function):
    """A function's comment without what only concerns C, and without what it says of other languages."""
    clauses = [clause for clause in re.split(r"(?<=[.;]) ", function.doc) if not ONLY_C.search(clause)]
    return re.sub(";$", ".", " ".join(clauses))


def takes(one, api):
    return (one.type.name == "bendy_pose" or one.type.name in api.handles and one.may_be_null or bool(one.length) or
            not one.type.is_pointer and not one.count and (one.type.name in ("float", "double") or bool(one.enum) or one.name in PARTS))


def follow(api, handle, excused):
    """The properties and methods of a handle's class, by name. excused: what the comment of a function says that is left out."""
    made = {}
    for function in api.functions.values():
        if class_of(function, api) != handle or function.result is None or excused.search(function.doc):
            continue
        name, result = name_of(function, handle), function.result
        given = [one for one in function.parameters[1:] if one.type.name != "bendy_error"]
        out = next((one for one in given if one.name == "out" and one.type.name in api.structs), None)
        given = [one for one in given if one is not out]
        if name == "get_" + bare(handle) and not given:
            fields = [one for one in api.structs[out.type.name].fields if one.name != "size"]
            made.update((one.name, Property(one.name, function, one)) for one in fields)
        elif not given and not result.is_pointer and result.name != "bendy_status":
            made[name] = Property(name, function, None)
        elif name.startswith("set_") and name[4:] in made:
            made[name[4:]].setter = function
        elif all(takes(one, api) for one in given) and not result.is_pointer:
            made[name] = Method(name, function, given, out)
    return made
