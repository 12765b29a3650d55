#!/usr/bin/env bash
# Builds the kernels for other processors and tests them: NEON under qemu, WebAssembly under node.
set -euo pipefail
cd "$(dirname "$0")/../tests/elsewhere"
for processor in aarch64 wasm32; do cmake --workflow --preset "$processor"; done
