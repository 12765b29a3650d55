#!/usr/bin/env bash
# Makes everything that a release has: scripts/release.sh --help, or the first lines of scripts/release/run.py
set -euo pipefail
cd "$(dirname "$0")/.."
exec python3 -B scripts/release/run.py "$@"
