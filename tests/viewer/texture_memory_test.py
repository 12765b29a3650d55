#!/usr/bin/env python3
"""What the textures of a file cost: not more than is stated, however large the images are that few bytes hold.

    texture_memory_test.py --bendy PROGRAM --source SOURCE_DIR [--sanitized] [unittest's own arguments]
"""

import base64
import os
import resource
import struct
import subprocess
import sys
import zlib
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parent.parent / "cli"))
from gltf_file import GltfFile  # noqa: E402
from png_file import read_png  # noqa: E402
from program import BENDY, REST, Case, main  # noqa: E402

MIB = 1 << 20
IS_SANITIZED = "--sanitized" in REST
SOFTWARE = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"}


def plain_png(side, colour):
    """A square of one colour, in few bytes."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    rows = zlib.compress(bytes(side * (1 + (side + 7) // 8)), 9)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 1, 3, 0, 0, 0)) +
            chunk(b"PLTE", bytes(colour)) + chunk(b"IDAT", rows) + chunk(b"IEND", b""))


class Textures(Case):
    def model(self, images, squares=1, materials=None):
        """Writes m.bendy: squares that cover one another, each with the next image as its base colour, or with a material."""
        file = GltfFile()
        corners = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)]
        attributes = {"POSITION": file.add(corners, "VEC3"), "NORMAL": file.add([(0.0, 0.0, 1.0)] * 4, "VEC3"),
                      "TEXCOORD_0": file.add([(x, 1 - y) for x, y, _ in corners], "VEC2")}
        indices = file.add([(k,) for k in (0, 1, 2, 0, 2, 3)], "SCALAR", 5123)
        if materials is None:
            materials = [{"extensions": {"KHR_materials_unlit": {}}, "pbrMetallicRoughness": {"baseColorTexture": {"index": k % len(images)}}}
                         for k in range(squares)]
        file.document |= {
            "extensionsUsed": ["KHR_materials_unlit"], "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "materials": materials,
            "meshes": [{"primitives": [{"attributes": attributes, "indices": indices, "material": k} for k in range(squares)]}],
            "textures": [{"source": k} for k in range(len(images))],
            "images": [{"uri": "data:image/png;base64," + base64.b64encode(image).decode()} for image in images]}
        file.write(self.folder / "m.gltf")
        self.done("convert", "m.gltf", "-q", "-o", "m.bendy")

    def peak(self, *arguments):
        """The bytes that a run takes at most, and what it says on standard error."""
        process = subprocess.Popen([BENDY, *arguments], cwd=self.folder, env=SOFTWARE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        with process.stderr as stream:
            errors = stream.read().decode()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0, errors)
        return usage.ru_maxrss * 1024, errors

    def expect_peak(self, most, *arguments):
        """Runs twice: without images, and with them, which may take so much more. Gives what is said."""
        peak, errors = self.peak(*arguments)
        (self.folder / "m.bendy").rename(self.folder / "with.bendy")
        self.model([plain_png(1, (1, 2, 3))])
        base, _ = self.peak(*arguments)
        (self.folder / "with.bendy").rename(self.folder / "m.bendy")
        if not IS_SANITIZED:  # which keeps freed memory
            self.assertLess(peak - base, most)
        return errors

    def test_a_page_has_one_picture_in_memory_at_a_time(self):
        for side, count in ((1024, 50), (4096, 8)):
            with self.subTest(side=side):
                self.model([plain_png(side, (200, 5 * k, 30)) for k in range(count)], squares=count)
                self.assertLess((self.folder / "m.bendy").stat().st_size, 60_000)
                self.expect_peak(64 * MIB + 4 * 4 * side * side, "inspect", "m.bendy", "--html", "m.html")

    def test_a_picture_has_textures_of_a_stated_size(self):
        self.model([plain_png(2048, (200, 5 * k, 30)) for k in range(25)], squares=25)
        errors = self.expect_peak((256 + 64) * MIB, "render", "m.bendy", "-o", "m.png")
        self.assertEqual(errors, "bendy: warning: m.bendy: the textures are scaled down: they would take 534 MiB for pictures of this "
                                 "size, and get 256\n")

    def test_no_texture_is_larger_than_what_can_be_seen(self):
        self.model([plain_png(8192, (200, 60, 30))])
        arguments = ("render", "m.bendy", "-o", "m.png", "--size", "64x64", "--camera", "0,0")
        self.assertEqual(self.expect_peak(16 * MIB, *arguments), "")
        self.peak(*arguments)
        width, height, channels, pixels = read_png((self.folder / "m.png").read_bytes())
        middle = (height // 2 * width + width // 2) * channels
        self.assertEqual(tuple(pixels[middle:middle + 3]), (200, 60, 30))
        # From near, more can be seen.
        self.expect_peak(320 * MIB, *arguments[:-1], "0,0,0.01")

    def test_equal_images_are_one(self):
        self.model([plain_png(2048, (200, 60, 30))] * 40, squares=40)
        self.assertEqual(self.expect_peak(64 * MIB, "render", "m.bendy", "-o", "m.png"), "")

    def test_images_that_nothing_shows_are_not_read(self):
        broken = plain_png(64, (1, 2, 3))[:60]
        lit = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "normalTexture": {"index": 1}}
        unlit = lit | {"extensions": {"KHR_materials_unlit": {}}}
        for material, more, is_said in ((lit, (), True), (unlit, (), False), (lit, ("--wireframe",), False)):
            self.model([plain_png(64, (1, 2, 3)), broken], materials=[material, lit])
            _, errors = self.peak("render", "m.bendy", "-o", "m.png", "--size", "16x16", *more)
            self.assertEqual("texture 1 cannot be shown" in errors, is_said, errors)

    def test_a_lack_of_memory_is_said(self):
        self.model([plain_png(1024, (200, 5 * k, 30)) for k in range(20)], squares=20)
        if IS_SANITIZED:  # which reserves terabytes
            return
        for megabytes in (100, 200, 300, 400, 500):
            for line in (("render", "m.bendy", "-o", "out.png"), ("inspect", "m.bendy", "--html", "out.html")):
                result = self.bendy(*line, env=SOFTWARE,
                                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20)))
                said = result.stderr.decode()
                if line[0] == "render":
                    self.assertEqual(result.returncode, 1, said)
                    self.assertRegex(said, r"^bendy: error: m\.bendy: not enough memory for OpenGL, .*\(ulimit -v\)\n$")
                else:
                    self.assertEqual((result.returncode, said), (0, ""))
                    self.assertIn("not enough memory for OpenGL", (self.folder / "out.html").read_text())


if __name__ == "__main__":
    main([argument for argument in REST if argument != "--sanitized"])
