#!/usr/bin/env bash
# Runs the checks: scripts/test.sh --help, or the first lines of scripts/checks/run.py
set -euo pipefail
cd "$(dirname "$0")/.."
exec python3 scripts/checks/run.py "$@"
