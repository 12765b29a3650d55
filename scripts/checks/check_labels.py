#!/usr/bin/env python3
"""Checks that every test of build/release has a label, and that a step runs each label: no test is forgotten."""

import json
import subprocess
import sys
from pathlib import Path

from steps import STEPS

ROOT = Path(__file__).resolve().parents[2]


def main():
    listed = subprocess.run(["ctest", "--show-only=json-v1"], cwd=ROOT / "build/release", check=True, capture_output=True, text=True)
    run = {label for step in STEPS for tests in step.tests if tests.preset == "release" for label in tests.labels}
    forgotten = []
    for test in json.loads(listed.stdout)["tests"]:
        labels = next((entry["value"] for entry in test["properties"] if entry["name"] == "LABELS"), [])
        if not run & set(labels):
            forgotten.append(f"{test['name']}: no step of scripts/checks/steps.py runs a label of {labels}")
    print("\n".join(forgotten) or "Every test is in a step.")
    return 1 if forgotten else 0


if __name__ == "__main__":
    sys.exit(main())
