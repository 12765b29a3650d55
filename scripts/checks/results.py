"""Reads ctest's JUnit file: which tests failed, and which skipped something that tests/skipped.txt does not allow."""

import re
import xml.etree.ElementTree
from pathlib import Path

# How the frameworks say that they skipped something: GoogleTest, unittest, pytest, node.
SKIPPED = re.compile(r"^\[  SKIPPED \] .*|\bskipped=[1-9]\d*|\b[1-9]\d* skipped\b|^# skipped [1-9]\d*", re.MULTILINE)


def read_allowed(file):
    """Lines of a name's pattern and a reason, as pairs."""
    allowed = []
    for line in file.read_text(encoding="utf-8").splitlines():
        if line.strip() and not line.startswith("#"):
            pattern, reason = line.split(maxsplit=1)
            allowed.append((re.compile(pattern), reason))
    return allowed


def read_results(results, allowed_file):
    """Names of failed tests, and pairs of the name of a test that skipped something and its message."""
    if not Path(results).exists():
        return [], []
    allowed = read_allowed(allowed_file)
    failed, skipped = [], []
    for case in xml.etree.ElementTree.parse(results).iter("testcase"):
        name, status = case.get("name"), case.get("status")
        output = case.findtext("system-out") or ""
        if status == "fail":
            failed.append(name)
            continue
        found = SKIPPED.search(output)
        why = found[0] if found else (output.strip().splitlines() or ["did not run"])[-1] if status != "run" else None
        if why is not None and not any(pattern.fullmatch(name) for pattern, _ in allowed):
            skipped.append((name, why))
    return failed, skipped
