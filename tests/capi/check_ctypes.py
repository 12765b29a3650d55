"""examples/bendy_ctypes.py declares structs, functions and words as bendy.h does. The library is not loaded."""

import ctypes
import importlib.util
import re
import sys
import unittest.mock
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "bindings"))
import describe  # noqa: E402

sys.dont_write_bytecode = True
NUMBERS = {"uint32_t": ctypes.c_uint32, "int32_t": ctypes.c_int32, "uint64_t": ctypes.c_uint64, "size_t": ctypes.c_size_t,
           "float": ctypes.c_float, "double": ctypes.c_double, "char": ctypes.c_char, "bendy_status": ctypes.c_int}


def load():
    spec = importlib.util.spec_from_file_location("bendy_ctypes", SOURCE / "examples/bendy_ctypes.py")
    module = importlib.util.module_from_spec(spec)
    with unittest.mock.patch("ctypes.CDLL"):
        spec.loader.exec_module(module)
    return module


class Comparison:
    def __init__(self, api, module):
        self.api, self.module = api, module
        self.structs = {"bendy_" + re.sub(r"(?<!^)([A-Z])", r"_\1", name).lower(): value for name, value in vars(module).items()
                        if isinstance(value, type) and issubclass(value, ctypes.Structure) and "_fields_" in vars(value)}
        self.faults = []

    def check(self, is_equal, message):
        if not is_equal:
            self.faults.append(message)

    def types(self, one):
        """The types of ctypes that a field or a parameter may have."""
        if one.type.is_pointer:
            return {ctypes.c_char_p, ctypes.c_void_p} if one.type.name in ("char", "void") else {ctypes.c_void_p}
        return {NUMBERS.get(one.type.name, self.structs.get(one.type.name))}

    def compare_struct(self, name, made):
        struct = self.api.structs[name]
        self.check(len(made._fields_) <= len(struct.fields), f"{name}: it has fewer fields")
        later = next((k for k, one in enumerate(struct.fields) if one.is_later), len(struct.fields))
        self.check(len(made._fields_) >= later, f"{name}: its first version had more fields")
        for (field, kind), one in zip(made._fields_, struct.fields):
            kinds = {found * one.count for found in self.types(one)} if one.count else self.types(one)
            self.check(field == one.name and kind in kinds, f"{name}.{one.name}: here it is {field}, a {kind.__name__}")

    def compare_defaults(self, name, made):
        struct = self.api.structs[name]
        for one, default in zip(struct.fields[1:], struct.defaults[1:]):
            if one.count or one.enum or one.type.is_pointer:
                continue
            expected = NUMBERS[one.type.name](float(default.rstrip("f")) if one.type.name == "float" else int(default)).value
            self.check(getattr(made(), one.name, None) == expected, f"{name}.{one.name}: its default is {default}")

    def compare_function(self, name, result, taken):
        function = self.api.functions["bendy_" + name]
        parameters = [one for one in function.parameters if one.type.name != "bendy_error"]
        pairs = zip(parameters, taken)
        self.check(len(parameters) == len(taken), f"{function.name} takes {len(parameters)}")
        self.check(all(kind in ({ctypes.c_void_p} if one.count else self.types(one)) for one, kind in pairs), f"{function.name}: a parameter")
        self.check(result in self.types(describe.Field("result", function.result)), f"{function.name}: its result")


def main():
    api, module = describe.read(SOURCE / "bindings/c/include/bendy.h"), load()
    compared = Comparison(api, module)
    for name, made in compared.structs.items():
        compared.compare_struct(name, made)
    compared.compare_defaults("bendy_reach_options", module.ReachOptions)
    for name, (result, *taken) in module.SIGNATURES.items():
        compared.compare_function(name, result, taken)
    for kind in module.COUNTS:
        compared.compare_function(f"{kind}_count", ctypes.c_uint32, [ctypes.c_void_p])
    compared.compare_function("vertex_count", ctypes.c_uint64, [ctypes.c_void_p])
    words = [word.replace("_", " ") for word in api.enums["bendy_reach_status"].words]
    compared.check(list(module.REACH_STATUS) == words, f"REACH_STATUS: bendy.h has {words}")
    topologies = [(name[len("BENDY_"):], number) for name, number, _ in api.enums["bendy_topology"].values]
    compared.check(all(getattr(module, name) == number for name, number in topologies), f"bendy.h has {topologies}")
    compared.check(len(compared.structs) > 8 and len(module.SIGNATURES) > 15, "too little is compared")
    print("\n".join(compared.faults))
    return 1 if compared.faults else 0


if __name__ == "__main__":
    sys.exit(main())
