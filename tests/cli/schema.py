"""Holds a value against a JSON Schema: as much of draft 2020-12 as the schemas in spec/ use; other
keywords raise."""

import re

IGNORED = {"$schema", "$defs", "title", "description"}
TYPES = {
    "object": lambda v: isinstance(v, dict),
    "array": lambda v: isinstance(v, list),
    "string": lambda v: isinstance(v, str),
    "number": lambda v: isinstance(v, (int, float)) and not isinstance(v, bool),
    "integer": lambda v: TYPES["number"](v) and v == int(v),
    "null": lambda v: v is None,
    "boolean": lambda v: isinstance(v, bool),
}


def same(a, b):
    return a == b and isinstance(a, bool) == isinstance(b, bool)


def is_valid(value, schema, root):
    """True where `value` fits `schema`, a part of `root`."""
    if isinstance(schema, bool):
        return schema
    is_object, is_list, is_number = isinstance(value, dict), isinstance(value, list), TYPES["number"](value)
    for keyword, what in schema.items():
        fits = lambda part, against: is_valid(part, against, root)  # noqa: E731
        if keyword in IGNORED:
            good = True
        elif keyword == "$ref":
            part = root
            for step in what.removeprefix("#/").split("/"):
                part = part[step]
            good = fits(value, part)
        elif keyword == "type":
            good = any(TYPES[name](value) for name in ([what] if isinstance(what, str) else what))
        elif keyword == "const":
            good = same(value, what)
        elif keyword == "enum":
            good = any(same(value, one) for one in what)
        elif keyword == "anyOf":
            good = any(fits(value, one) for one in what)
        elif keyword == "required":
            good = not is_object or all(key in value for key in what)
        elif keyword == "properties":
            good = not is_object or all(fits(value[key], what[key]) for key in what if key in value)
        elif keyword == "additionalProperties":
            known, patterns = schema.get("properties", {}), schema.get("patternProperties", {})
            good = not is_object or all(
                fits(part, what) for key, part in value.items()
                if key not in known and not any(re.search(pattern, key) for pattern in patterns))
        elif keyword == "patternProperties":
            good = not is_object or all(
                fits(part, against) for pattern, against in what.items() for key, part in value.items()
                if re.search(pattern, key))
        elif keyword == "propertyNames":
            good = not is_object or all(fits(key, what) for key in value)
        elif keyword == "pattern":
            good = not isinstance(value, str) or re.search(what, value) is not None
        elif keyword == "dependentRequired":
            good = not is_object or all(other in value for key in what if key in value for other in what[key])
        elif keyword == "minProperties":
            good = not is_object or len(value) >= what
        elif keyword == "maxProperties":
            good = not is_object or len(value) <= what
        elif keyword == "dependentSchemas":
            good = not is_object or all(fits(value, what[key]) for key in what if key in value)
        elif keyword == "items":
            good = not is_list or all(fits(part, what) for part in value)
        elif keyword == "minItems":
            good = not is_list or len(value) >= what
        elif keyword == "maxItems":
            good = not is_list or len(value) <= what
        elif keyword == "minimum":
            good = not is_number or value >= what
        elif keyword == "maximum":
            good = not is_number or value <= what
        else:
            raise NotImplementedError(keyword)
        if not good:
            return False
    return True
