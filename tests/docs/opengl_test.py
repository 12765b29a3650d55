#!/usr/bin/env python3
"""An OpenGL example draws the character, and it moves: opengl_test.py PROGRAM FILE.bendy"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path


def draw(program, model, frames, folder):
    """The picture after so many frames: bytes of red, green, blue."""
    picture = Path(folder) / f"{frames}.ppm"
    subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 800x600x24", program, model, str(frames), str(picture)], check=True,
                   env={**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"}, timeout=120)
    head, pixels = picture.read_bytes().split(b"\n", 1)
    assert head == b"P6 640 480 255" and len(pixels) == 640 * 480 * 3, head
    return pixels


def main():
    program, model = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        first, later = draw(program, model, 1, folder), draw(program, model, 15, folder)
    background = first[:3]
    drawn = sum(first[at:at + 3] != background for at in range(0, len(first), 3)) / (640 * 480)
    moved = sum(first[at:at + 3] != later[at:at + 3] for at in range(0, len(first), 3)) / (640 * 480)
    print(f"{drawn:.1%} of the picture is drawn, {moved:.1%} differs 14 frames later")
    return 0 if 0.02 < drawn < 0.5 and moved > 0.001 else 1


if __name__ == "__main__":
    sys.exit(main())
