"""Every function of bendy.h is called by the npm package's sources or by what is made for them, or its comment says why not: "Only for C: ..." or
"Not in JavaScript: ...". A comment that says so of a function that is called is wrong, too."""

import re
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "bindings"))
import describe  # noqa: E402
import make_web  # noqa: E402

EXCEPTION = re.compile(r"(Only for C|Not in JavaScript): \w")


def reaches_its_class(header, sources):
    """Whether a function that is added to the header becomes a method of its object's class."""
    added = ("/* Mirrors `pose`. */\nBENDY_API bendy_status bendy_pose_mirror(bendy_pose* pose, uint32_t joint, bendy_error* error);\n\n"
             "/* Moves every joint into the range")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "bendy.h")
        file.write_text(header.read_text(encoding="utf-8").replace("/* Moves every joint into the range", added), encoding="utf-8")
        structs = make_web.Structs(describe.read(file))
        return "  mirror(joint: Key<Joint>): this {" in make_web.classes(structs, make_web.called(structs, sources)[1])


def main():
    sources = "".join(path.read_text(encoding="utf-8") for path in sorted((SOURCE / "bindings/web/src").glob("*.ts")))
    header = SOURCE / "bindings/c/include/bendy.h"
    api = describe.read(header)
    called, _ = make_web.called(make_web.Structs(api), sources)
    faults = [] if reaches_its_class(header, sources) else ["bendy_pose_mirror, added to bendy.h, does not reach the class Pose"]
    for function in api.functions.values():
        is_exception = EXCEPTION.search(function.doc) is not None
        if function.name not in called and not is_exception:
            faults.append(f"{function.name}: JavaScript has no call of it, and its comment does not say why")
        if function.name in called and is_exception:
            faults.append(f"{function.name}: JavaScript calls it, although its comment says that it does not")
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
