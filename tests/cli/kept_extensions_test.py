#!/usr/bin/env python3
"""Numbers in extensions that are kept as JSON name the same things after conversion, export and editing."""

import json
import re
import struct
import sys

from gltf_file import GltfFile
from program import SOURCE, Case, main

BONES = ("hips", "spine", "chest", "head")


def character(path, version):
    """Bones below a root, a head and teeth with morph targets, hair with a spring, textures; the nodes and meshes in an order that
    joints and bendy meshes do not have."""
    file = GltfFile(scenes=[{"nodes": [5]}], nodes=[
        {"name": "FaceNode", "mesh": 0}, {"name": "TeethNode", "mesh": 2}, {"name": "BodyNode", "mesh": 1},
        {"name": "head", "children": [4]}, {"name": "hair", "translation": [0, 1, 0]},
        {"name": "root", "children": [8, 2, 1, 0]}, {"name": "chest", "children": [3]}, {"name": "spine", "children": [6]},
        {"name": "hips", "children": [7]}])
    corners = file.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "VEC3")
    move = {"POSITION": file.add([(0, 0, 1)] * 3, "VEC3")}

    def mesh(name, targets, material):
        names = [f"{name}_{k}" for k in range(targets)]
        primitive = {"attributes": {"POSITION": corners}, "material": material}
        return {"name": name, "extras": {"targetNames": names},
                "primitives": [{**primitive, "targets": [move] * targets} if targets else primitive]}

    file.document["meshes"] = [mesh("Face", 3, 0), mesh("Body", 0, 1), mesh("Teeth", 2, 0)]
    file.document["images"] = [{"uri": f"data:image/png;base64,iVBORw0KGgo{letter}", "name": name}
                               for letter, name in (("A", "skin"), ("B", "cloth"), ("C", "portrait"))]
    file.document["textures"] = [{"source": k, "name": name} for k, name in ((0, "skin"), (1, "cloth"))]
    file.document["materials"] = [{"name": name, "pbrMetallicRoughness": {"baseColorTexture": {"index": k}}}
                                  for k, name in enumerate(("Skin", "Cloth"))]
    node = {each["name"]: number for number, each in enumerate(file.document["nodes"])}
    if version == 0:
        file.document["textures"].append({"source": 2, "name": "portrait"})
        extensions = {"VRM": {
            "meta": {"texture": 2},
            "humanoid": {"humanBones": [{"bone": bone, "node": node[bone]} for bone in BONES]},
            "firstPerson": {"firstPersonBone": node["head"], "meshAnnotations": [{"mesh": 1}, {"mesh": 0}]},
            "blendShapeMaster": {"blendShapeGroups": [{"name": "A", "binds": [
                {"mesh": 0, "index": 2, "weight": 100}, {"mesh": 2, "index": 1, "weight": 50}],
                "materialValues": [{"materialName": "Skin", "propertyName": "_Color", "targetValue": [0, 0, 0, 1]}]}]},
            "secondaryAnimation": {
                "boneGroups": [{"bones": [node["hair"]], "center": -1, "colliderGroups": [1, 0]}],
                "colliderGroups": [{"node": node["hips"]}, {"node": node["head"]}]},
            "materialProperties": [{"name": "Skin", "textureProperties": {"_MainTex": 0, "_ShadeTexture": 1}},
                                   {"name": "Cloth", "textureProperties": {"_MainTex": 1}}]}}
    else:
        extensions = {
            "VRMC_vrm": {
                "meta": {"thumbnailImage": 2},
                "humanoid": {"humanBones": {bone: {"node": node[bone]} for bone in BONES}},
                "firstPerson": {"meshAnnotations": [{"node": node["BodyNode"]}]},
                "expressions": {"preset": {"aa": {
                    "morphTargetBinds": [{"node": 0, "index": 2, "weight": 1}, {"node": 1, "index": 1, "weight": 1}],
                    "materialColorBinds": [{"material": 1, "type": "color", "targetValue": [0, 0, 0, 1]}]}}}},
            "VRMC_springBone": {
                "colliders": [{"node": node["hips"]}, {"node": node["head"]}],
                "colliderGroups": [{"colliders": [0]}, {"colliders": [1]}],
                "springs": [{"joints": [{"node": node["head"]}, {"node": node["hair"]}], "center": node["hips"],
                             "colliderGroups": [1, 0]}]}}
        file.document["nodes"][4]["extensions"] = {
            "VRMC_node_constraint": {"constraint": {"rotation": {"source": node["chest"]}}}}
    file.document["extensions"] = {**extensions, "ACME_unknown": {"node": 3}}
    return file.write(path)


def document_of(path):
    data = path.read_bytes()
    if data[:4] != b"glTF":
        return json.loads(data)
    return json.loads(data[20 : 20 + struct.unpack_from("<I", data, 12)[0]])


def named(root):
    """What the extensions say, with names in place of numbers."""
    def name(kind, number):
        if number == -1:
            return None
        thing = root[kind][number]
        return thing["name"] if kind != "textures" else root["images"][thing["source"]]["name"]

    def target(mesh, number):
        return root["meshes"][mesh]["extras"]["targetNames"][number]

    said = {}
    if vrm := root["extensions"].get("VRM"):
        second = vrm["secondaryAnimation"]
        groups = [name("nodes", group["node"]) for group in second["colliderGroups"]]
        said["bones"] = {bone["bone"]: name("nodes", bone["node"]) for bone in vrm["humanoid"]["humanBones"]}
        said["expression"] = [target(bind["mesh"], bind["index"]) for group in vrm["blendShapeMaster"]["blendShapeGroups"]
                              for bind in group["binds"]]
        said["values"] = [value["materialName"] for group in vrm["blendShapeMaster"]["blendShapeGroups"]
                          for value in group.get("materialValues", [])]
        said["meshes"] = [name("meshes", one["mesh"]) for one in vrm["firstPerson"]["meshAnnotations"]]
        said["springs"] = [([name("nodes", bone) for bone in group["bones"]], name("nodes", group["center"]),
                            [groups[number] for number in group["colliderGroups"]]) for group in second["boneGroups"]]
        said["textures"] = [(one["name"], {key: name("textures", number) for key, number in one["textureProperties"].items()})
                            for one in vrm["materialProperties"]]
        said["first person"] = name("nodes", vrm["firstPerson"]["firstPersonBone"])
        said["portrait"] = name("textures", vrm["meta"]["texture"])
    if vrm := root["extensions"].get("VRMC_vrm"):
        aa = vrm["expressions"]["preset"]["aa"]
        said["bones"] = {bone: name("nodes", one["node"]) for bone, one in vrm["humanoid"]["humanBones"].items()}
        said["expression"] = [target(root["nodes"][bind["node"]]["mesh"], bind["index"]) for bind in aa["morphTargetBinds"]]
        said["colours"] = [name("materials", bind["material"]) for bind in aa["materialColorBinds"]]
        said["meshes"] = [name("nodes", one["node"]) for one in vrm["firstPerson"]["meshAnnotations"]]
        said["portrait"] = root["images"][vrm["meta"]["thumbnailImage"]]["name"] if "thumbnailImage" in vrm["meta"] else None
    if springs := root["extensions"].get("VRMC_springBone"):
        groups = [[name("nodes", springs["colliders"][number]["node"]) for number in group["colliders"]]
                  for group in springs["colliderGroups"]]
        said["springs"] = [([name("nodes", joint["node"]) for joint in spring["joints"]],
                            name("nodes", spring.get("center", -1)), [groups[number] for number in spring["colliderGroups"]])
                           for spring in springs["springs"]]
    said["constraints"] = {node["name"]: name("nodes", node["extensions"]["VRMC_node_constraint"]["constraint"]["rotation"]["source"])
                           for node in root["nodes"] if "VRMC_node_constraint" in node.get("extensions", {})}
    return said


class Kept(Case):
    def converted(self, version):
        source = character(self.folder / f"vrm{version}.gltf", version)
        self.done("convert", source, "-q", "-o", f"vrm{version}.bendy")
        return named(document_of(source)), self.folder / f"vrm{version}.bendy"

    def exported(self, file):
        """What the exported file says; what was printed stands in self.warned."""
        glb = file.with_suffix(".glb")
        glb.unlink(missing_ok=True)
        self.warned = self.bendy("export", file, "-o", glb).stderr.decode()
        return named(document_of(glb))

    def edited(self, file, *arguments):
        result = self.bendy("edit", file, "-o", "edited.bendy", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.told = result.stderr.decode()
        self.assertEqual(self.done("validate", "edited.bendy"), b"")
        return self.exported(self.folder / "edited.bendy")

    def test_conversion_and_export_keep_what_numbers_mean(self):
        for version in (0, 1):
            said, file = self.converted(version)
            self.assertEqual(self.exported(file), said)
            self.assertIn('the meaning of numbers is not known, written as it is: \'ACME_unknown\'', self.warned)
            self.done("convert", file.with_suffix(".glb"), "-q", "-o", "again.bendy")
            self.assertEqual(self.exported(self.folder / "again.bendy"), said)

    def test_a_target_that_goes_takes_its_binds_along(self):
        for version in (0, 1):
            said, file = self.converted(version)
            self.assertEqual(self.edited(file, "--strip", "target:Face_1"), said)
            now = self.edited(file, "--strip", "target:Face_2")
            self.assertEqual(now, {**said, "expression": ["Teeth_1"]})
            self.assertIn("removed from extensions, because the things that they name no longer exist: VRM", self.told)

    def test_a_mesh_that_goes(self):
        for version in (0, 1):
            said, file = self.converted(version)
            now = self.edited(file, "--strip", "mesh:Face")
            self.assertEqual(now["expression"], ["Teeth_1"])
            self.assertEqual(now["meshes"], [name for name in said["meshes"] if name != "Face"])

    def test_a_texture_that_goes(self):
        said, file = self.converted(0)
        now = self.edited(file, "--strip", "texture:skin")
        self.assertEqual(now["textures"], [("Skin", {"_ShadeTexture": "cloth"}), ("Cloth", {"_MainTex": "cloth"})])
        self.assertEqual(now["portrait"], "portrait")
        said, file = self.converted(1)
        self.assertEqual(self.edited(file, "--strip", "texture:skin"), said)
        self.assertIsNone(self.edited(file, "--strip", "texture:portrait")["portrait"])

    def test_a_material_that_goes(self):
        _, file = self.converted(0)
        self.assertEqual(self.edited(file, "--strip", "material:Skin")["textures"], [("Cloth", {"_MainTex": "cloth"})])
        _, file = self.converted(1)
        self.assertEqual(self.edited(file, "--strip", "material:Skin")["colours"], ["Cloth"])
        self.assertEqual(self.edited(file, "--strip", "material:Cloth")["colours"], [])

    def test_a_material_that_is_renamed(self):
        _, file = self.converted(0)
        now = self.edited(file, "--rename", "material:Skin=Fur", "--rename", "material:Cloth=Skin")
        self.assertEqual([name for name, _ in now["textures"]], ["Fur", "Skin"])
        self.assertEqual(now["values"], ["Fur"])

    def test_joints_that_stay_keep_their_roles(self):
        for version in (0, 1):
            said, file = self.converted(version)
            now = self.edited(file, "--extract", "head")
            self.assertEqual(now["bones"], said["bones"])  # those above it stay as its parents
            self.assertEqual(now["springs"], said["springs"])
            self.assertIn('numbers in extension "ACME_unknown" is not known: they stay as they are', self.told)
            now = self.edited(file, "--extract", "chest")
            self.assertEqual(now["constraints"], said["constraints"])
            now = self.edited(file, "--extract", "FaceNode")
            self.assertEqual(now["bones"], {})
            self.assertEqual(now["expression"], ["Face_2"])
            self.assertEqual(now["constraints"], {})
            if version == 1:
                self.assertEqual(now["springs"], [])


class MaterialExtensions(Case):
    def test_only_what_render_does_not_draw_has_a_warning(self):
        drawn = set(re.findall(r'"(KHR_materials_\w+)"', (SOURCE / "tools/viewer/src/materials.cpp").read_text()))
        self.assertGreaterEqual(len(drawn), 3)
        for name in (*drawn, "KHR_materials_clearcoat", "KHR_materials_sheen"):
            file = GltfFile(scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}], materials=[{"extensions": {name: {}}}],
                            extensionsUsed=[name])
            corners = file.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "VEC3")
            file.document["meshes"] = [{"primitives": [{"attributes": {"POSITION": corners}, "material": 0}]}]
            result = self.bendy("convert", file.write(self.folder / "m.gltf"), "-q")
            self.assertEqual(result.returncode, 0)
            self.assertEqual(f"kept as JSON, not interpreted: {name}" in result.stderr.decode(), name not in drawn, name)


if __name__ == "__main__":
    sys.exit(main())
