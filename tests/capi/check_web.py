"""Every function of bendy.h is called by the npm package's sources, or its comment says why not: "Only for C: ..." or
"Not in JavaScript: ...". A comment that says so of a function that is called is wrong, too."""

import re
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "bindings"))
import describe  # noqa: E402

EXCEPTION = re.compile(r"(Only for C|Not in JavaScript): \w")


def main():
    sources = "".join(path.read_text(encoding="utf-8") for path in sorted((SOURCE / "bindings/web/src").glob("*.ts")))
    called = set(re.findall(r"\bbendy_\w+", sources))
    faults = []
    for function in describe.read(SOURCE / "bindings/c/include/bendy.h").functions.values():
        is_exception = EXCEPTION.search(function.doc) is not None
        if function.name not in called and not is_exception:
            faults.append(f"{function.name}: JavaScript has no call of it, and its comment does not say why")
        if function.name in called and is_exception:
            faults.append(f"{function.name}: JavaScript calls it, although its comment says that it does not")
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
