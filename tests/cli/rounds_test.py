#!/usr/bin/env python3
"""What comes back from bendy files as it was, and what glTF 2.1, a draft, has and 2.0 has not."""

import json
import sys

from gltf_file import GltfFile
from program import Case, main

PIXEL = ("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==")


def triangle(**top):
    file = GltfFile(scenes=[{"nodes": [0]}], nodes=[{"name": "body", "mesh": 0}], **top)
    corners = file.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "VEC3")
    file.document["meshes"] = [{"primitives": [{"attributes": {"POSITION": corners}}]}]
    return file


class Drafts(Case):
    def file(self):
        file = triangle(
            files=[{"uri": "tree.glb", "mimeType": "model/gltf-binary"}, {"bufferView": 0, "mimeType": "model/gltf-binary", "name": "packed"}],
            externalAssets=[{"file": 0, "name": "tree"}, {"file": 1}, {"file": 0}],
            shapes=[{"type": "sphere", "sphere": {"radius": 1}}], images=[{"uri": f"data:image/png;base64,{PIXEL}"}],
            acme={"files": 1})
        file.document["asset"] = {"version": "2.1", "minVersion": "2.0", "thumbnail": 0, "copyright": "me"}
        file.document["nodes"] += [{"name": "wood", "externalAsset": 0}, {"name": "far", "externalAsset": 7}]
        file.document["nodes"][0] |= {"boundingVolume": {"shape": 0}, "acme": 2}
        file.document["scenes"][0]["nodes"] = [0, 1, 2]
        return file

    def test_what_an_external_asset_places_is_named(self):
        self.file().write(self.folder / "a.gltf")
        result = self.bendy("convert", "-q", "a.gltf")
        self.assertEqual(result.returncode, 0, result.stderr)
        told = result.stderr.decode()
        self.assertIn("glTF '2.1' is read as glTF 2.0", told)
        self.assertIn("external assets of glTF 2.1, which are not read, left out: 'tree' ('tree.glb') at 'wood', "
                      "externalAssets[7] at 'far', externalAssets[1], externalAssets[2] ('tree.glb')", told)
        self.assertIn("the bytes of files of glTF 2.1 in buffer views left out: 'packed'", told)

    def test_an_export_is_of_version_2_0_and_names_what_that_has_not(self):
        self.file().write(self.folder / "a.gltf")
        self.done("convert", "-q", "a.gltf")
        result = self.bendy("export", "-q", "a.bendy", "-o", "b.gltf")
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ("files", "externalAssets", "shapes", "thumbnail", "externalAsset", "boundingVolume"):
            self.assertIn(f"left out, because only glTF 2.1 has it: {name}", result.stderr.decode())
        text = (self.folder / "b.gltf").read_text()
        document = json.loads(text)
        self.assertEqual({key: value for key, value in document["asset"].items() if key != "generator"},
                         {"version": "2.0", "copyright": "me"})
        self.assertEqual((document["acme"], document["nodes"][0]["acme"]), ({"files": 1}, 2))
        for name in ("externalAsset", "shapes", "boundingVolume", "thumbnail", "2.1"):
            self.assertNotIn(name, text)
        self.assertNotIn("files", document)

    def test_what_is_no_list_or_no_number_is_no_asset(self):
        for wrong in ({}, 3, [3], [{"file": "x"}], [{"file": -1}], [{"file": 9}], [None]):
            file = self.file()
            file.document["externalAssets"] = file.document["files"] = wrong
            file.document["nodes"][1]["externalAsset"] = wrong
            file.write(self.folder / "a.gltf")
            self.done("convert", "-q", "a.gltf")
            self.done("export", "-q", "a.bendy", "-o", "b.gltf")

    def test_later_versions_and_other_chunks_are_refused(self):
        for asset, chunk, why in (({"version": "2.1", "minVersion": "2.1"}, None, "the file demands glTF version '2.1'"),
                                  ({"version": "3.0"}, None, "glTF version '3.0' is not supported, only 2.x"),
                                  ({"version": "2.1"}, 2, "buffers[0].chunk: the buffer is in chunk 2 of a file of glTF 2.1")):
            file = self.file()
            file.document["asset"] = asset
            file.write(self.folder / "a.gltf")
            document = json.loads((self.folder / "a.gltf").read_text())
            if chunk:
                document["buffers"] = [{"byteLength": document["buffers"][0]["byteLength"], "chunk": chunk}]
            (self.folder / "a.gltf").write_text(json.dumps(document))
            self.assertIn(why, self.failed("convert", "-q", "a.gltf"))


class Rounds(Case):
    def rounds(self, name="a.gltf"):
        """The file converted, and what its export converts to: equal bytes."""
        self.done("convert", "-q", name, "-o", "a.bendy")
        self.done("export", "-q", "a.bendy", "-o", "b.gltf")
        self.done("convert", "-q", "b.gltf", "-o", "b.bendy")
        self.assertEqual((self.folder / "a.bendy").read_bytes(), (self.folder / "b.bendy").read_bytes())
        return json.loads(self.done("inspect", "a.bendy", "--json"))

    def test_names_of_targets_are_stored_once_wherever_they_were_said(self):
        for where in ("mesh", "primitive", "both"):
            for more in ({}, {"mine": 1}):
                file = triangle()
                mesh = file.document["meshes"][0]
                move = {"POSITION": file.add([(0, 0, 1)] * 3, "VEC3")}
                mesh["primitives"][0]["targets"] = [move, move]
                for owner in [mesh] * (where != "primitive") + [mesh["primitives"][0]] * (where != "mesh"):
                    owner["extras"] = {"targetNames": ["Smile", "Blink"], **(more if owner is mesh else {})}
                file.write(self.folder / "a.gltf")
                ids = [chunk["id"] for chunk in self.rounds()["chunks"]]
                self.assertEqual(ids.count("EXTR"), 2 if more and where != "primitive" else 1, (where, more))
                shown = json.loads((self.folder / "b.gltf").read_text())["meshes"][0]["extras"]
                self.assertEqual(shown, {"targetNames": ["Smile", "Blink"], **(more if where != "primitive" else {})})

    def test_textures_of_one_image_say_so(self):
        file = triangle(images=[{"uri": f"data:image/png;base64,{PIXEL}"}], samplers=[{"wrapS": 33071}],
                        textures=[{"source": 0, "name": "skin"}, {"source": 0, "sampler": 0}])
        file.document["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "emissiveTexture": {"index": 1}}]
        file.document["meshes"][0]["primitives"][0]["material"] = 0
        file.write(self.folder / "a.gltf")
        shown = self.rounds()["summary"]["textures"]
        self.assertEqual([texture["images"] for texture in shown],
                         [[{"type": "PNG", "bytes": 70}], [{"type": "PNG", "bytes": 0, "sameAs": 0}]])
        text = self.done("inspect", "a.bendy").decode()
        self.assertIn("textures       2: skin PNG, #1 the same image as skin", text)
        self.assertIn("the same image as image 0 of TEXT 0", text)
        self.assertNotIn("other ", text.split("bytes  ")[0])

    def test_negative_zeros_are_no_integers(self):
        file = triangle()
        file.document["nodes"][0]["translation"] = [-0.0, 1, 0]
        file.write(self.folder / "a.gltf")
        self.rounds()
        for command in (("dump", "a.bendy"), ("pose", "a.bendy", "--format", "json"), ("inspect", "a.bendy", "--json")):
            text = self.done(*command).decode()
            self.assertIn("-0.0", text, command)
            self.assertNotRegex(text, r"-0(?![.\d])", command)


if __name__ == "__main__":
    sys.exit(main())
