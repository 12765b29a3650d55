#!/usr/bin/env python3
"""examples/draw.c draws what it says: draw_test.py DRAW NUMBERS BENDY FILE.bendy

Its numbers are those that the C++ API gives (NUMBERS); the picture changes with the texture (without which BENDY makes a copy of the
file), with the clips, and with the target."""

import subprocess
import sys
import tempfile
from pathlib import Path

WIDTH, HEIGHT = 480, 640
REQUEST = ["Idle", "Walk", "IK_LeftArm", "0.3", "1.2", "0.4"]


def draw(program, model, folder, *request):
    """(what it prints, the picture as a list of pixels)"""
    picture = Path(folder, "picture.ppm")
    text = subprocess.run([program, model, picture, *request], check=True, capture_output=True, text=True).stdout
    head, pixels = picture.read_bytes().split(b"\n", 1)
    if head != f"P6 {WIDTH} {HEIGHT} 255".encode() or len(pixels) != 3 * WIDTH * HEIGHT:
        sys.exit(f"not the picture that was asked for: {head}")
    return text, [pixels[at:at + 3] for at in range(0, len(pixels), 3)]


def differing(a, b):
    return sum(x != y for x, y in zip(a, b)) / len(a)


def main():
    program, numbers, bendy, model = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        text, picture = draw(program, model, folder, *REQUEST)
        expected = subprocess.run([numbers, model, *REQUEST], check=True, capture_output=True, text=True).stdout
        if text != expected:
            sys.exit(f"C says\n{text}C++ says\n{expected}")
        plain = Path(folder, "plain.bendy")
        subprocess.run([bendy, "edit", "--quiet", model, "--strip", "textures", "-o", plain], check=True, capture_output=True)
        other = {"texture": draw(program, plain, folder, *REQUEST)[1],
                 "blend": draw(program, model, folder, "Walk", *REQUEST[1:])[1],
                 "reach": draw(program, model, folder, *REQUEST[:3], "0.5", "0.9", "0.1")[1]}
    drawn = sum(pixel != picture[0] for pixel in picture) / len(picture)
    shares = {name: differing(picture, pixels) for name, pixels in other.items()}
    print(text, f"{drawn:.1%} of the picture is drawn;", ", ".join(f"{name}: {share:.1%} differs" for name, share in shares.items()))
    return 0 if 0.05 < drawn < 0.5 and all(share > 0.005 for share in shares.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
