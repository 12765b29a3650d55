#!/usr/bin/env python3
"""Makes pages with `bendy inspect --html` and looks at them: their structure, and how headless Chromium shows them.

    inspect_html_test.py --bendy PROGRAM --source SOURCE_DIR [unittest's own arguments]
"""

import base64
import hashlib
import html.parser
import json
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True  # nothing into the source tree
sys.path.insert(0, str(Path(__file__).parent))
from chunk_file import Chunk  # noqa: E402
from gltf_file import GltfFile  # noqa: E402
from program import BENDY, SOURCE, main  # noqa: E402

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")

RUN = "document.body.id='ran'"
HOSTILE = (f"</script><img src=x onerror=\"{RUN}\">", f"<!--<script>{RUN}</script>", f"\u2028\u2029';{RUN}//",
           f"\"><svg onload={RUN}>", "&lt;b&gt; \\u003c \\", f"javascript:{RUN}")


class Elements(html.parser.HTMLParser):
    """Tags with their attributes, and the text of scripts and styles."""

    def __init__(self, page):
        super().__init__()
        self.tags = []
        self.raw = []
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag in ("script", "style"):
            self.raw.append([tag, dict(attrs), ""])

    def handle_data(self, data):
        if self.cdata_elem:
            self.raw[-1][2] += data

    def text_of(self, tag, **attributes):
        return next(text for here, found, text in self.raw if here == tag and attributes.items() <= found.items())

    def named(self, tag):
        return [attributes for here, attributes in self.tags if here == tag]


def data_of(page):
    return json.loads(Elements(page).text_of("script", id="data"))


def leaves(value):
    """All strings in a JSON value."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, (list, dict)):
        for item in value.values() if isinstance(value, dict) else value:
            yield from leaves(item)


def hostile_file(path):
    """Every name, URI and extra that glTF has, with something in it that would like to run."""
    file = GltfFile(
        scenes=[{"nodes": [0], "name": HOSTILE[0], "extras": {"x": HOSTILE[0]}}],
        nodes=[{"name": HOSTILE[0], "children": [1, 2, 3], "extras": {HOSTILE[1]: HOSTILE[3]}}, {"name": HOSTILE[1]},
               {"name": HOSTILE[2]}, {"name": HOSTILE[3], "mesh": 0}],
        textures=[{"source": 0, "name": HOSTILE[0]}, {"source": 1, "name": HOSTILE[4]}],
        images=[{"uri": "x%3Cimg%20src=x%20onerror=" + RUN + ".png", "name": HOSTILE[1]},
                {"uri": "data:image/png;base64," + base64.b64encode(b"</script>no picture").decode()}],
        materials=[{"name": name, "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "extras": {"x": name}}
                   for name in HOSTILE])
    corners = file.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "VEC3")
    file.document["meshes"] = [{"name": HOSTILE[5], "primitives": [
        {"attributes": {"POSITION": corners, "TEXCOORD_0": file.add([(0, 0)] * 3, "VEC2")}, "material": 0}]}]
    times = file.add([(0,), (1,)], "SCALAR")
    values = file.add([(0, 0, 0), (4, 0, 0)], "VEC3")
    file.document["animations"] = [
        {"name": name, "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
         "samplers": [{"input": times, "output": values}]} for name in HOSTILE]
    return file.write(path)


class Case(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="bendy_html_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.pages = {}

    def bendy(self, *arguments):
        return subprocess.run([BENDY, *map(str, arguments)], cwd=self.folder, capture_output=True, timeout=300,
                              check=False)

    def converted(self, name):
        """The folder's NAME.bendy, made of an example or of the hostile file."""
        path = self.folder / f"{name}.bendy"
        if not path.exists():
            source = hostile_file(self.folder / "hostile.gltf") if name == "hostile" else SOURCE / f"examples/{name}.glb"
            result = self.bendy("convert", "-q", source, "-o", path)
            self.assertEqual(result.returncode, 0, result.stderr)
        return path

    def page(self, name):
        """The text of the page of a file in the folder."""
        if name not in self.pages:
            result = self.bendy("inspect", self.converted(name), "--html", f"{name}.html")
            self.assertEqual(result.returncode, 0, result.stderr)
            text = (self.folder / f"{name}.html").read_bytes()
            self.assertEqual(result.stdout.decode(), f"{name}.html: {len(text):,} bytes, 0 faults\n")
            self.pages[name] = text.decode("ascii")
        return self.pages[name]


class Structure(Case):
    def test_page_is_self_contained(self):
        page = self.page("tentacle")
        elements = Elements(page)
        self.assertEqual([tag for tag, *_ in elements.raw], ["style", "script", "script"])
        for tag, attributes in elements.tags:
            self.assertNotIn("src", attributes, tag)
            self.assertNotIn(tag, ("link", "iframe", "object", "embed", "base", "form"))
            self.assertFalse([name for name in attributes if name.startswith("on")])
        policy = next(meta["content"] for meta in elements.named("meta")
                      if meta.get("http-equiv") == "Content-Security-Policy")
        rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
        self.assertEqual(rules["default-src"], "'none'")
        self.assertEqual(rules["img-src"], "data:")
        for rule, text in (("script-src", elements.raw[-1][2]), ("style-src", elements.raw[0][2])):
            digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
            self.assertEqual(rules[rule], f"'sha256-{digest}'")
        for word in ("innerHTML", "outerHTML", "insertAdjacent", "document.write", "eval(", "fetch("):
            self.assertNotIn(word, page)

    def test_chunks_are_those_of_the_file(self):
        for name in ("tentacle", "mannequin"):
            data = data_of(self.page(name))
            chunks = data["chunks"]
            expected = json.loads(self.bendy("inspect", self.converted(name), "--json").stdout)["chunks"]
            self.assertEqual(chunks["total"], len(expected))
            self.assertEqual([chunks["ids"][i] for i in chunks["id"]], [chunk["id"] for chunk in expected])
            for column in ("offset", "size"):
                self.assertEqual(chunks[column], [chunk[column] for chunk in expected])
            self.assertEqual(chunks["parent"][1:], [chunk["parent"] for chunk in expected[1:]])
            joints = [chunk for chunk in expected if chunk["id"] == "SKIN"]
            self.assertEqual(data["facts"]["joints"], len(joints))
            self.assertEqual(data["objects"][0]["joints"]["chunk"], [chunk["number"] for chunk in joints])

    def test_joints_stand_where_the_pose_has_them(self):
        data = data_of(self.page("mannequin"))["objects"][0]["joints"]
        self.assertEqual(self.bendy("pose", self.converted("mannequin"), "-o", "rest.json").returncode, 0)
        joints = json.loads((self.folder / "rest.json").read_text())["joints"]
        self.assertEqual(len(joints), len(data["place"]))
        for joint, name, place in zip(joints, data["name"], data["place"]):
            self.assertEqual(joint["name"], name)
            for a, b in zip(joint["world"][12:15], place):
                self.assertAlmostEqual(a, b, delta=1e-5)
        self.assertTrue(any(text.startswith("hinge") or "Euler" in text for text in data["constraints"]))

    def test_curves_pass_through_the_keys(self):
        for name in ("tentacle", "mannequin"):
            data = data_of(self.page(name))
            file = Chunk.read(self.converted(name).read_bytes())
            found = [chunk for _, chunk in file.walk() if chunk.letters == "CYCL"]
            clips = data["objects"][0]["clips"]["list"]
            self.assertEqual(len(found), len(clips))
            for chunk, clip in zip(found, clips):
                leaf = {child.letters: child.payload for child in chunk.children}
                times = struct.unpack(f"<{len(leaf['TIME']) // 4}f", leaf["TIME"])
                values = struct.unpack(f"<{len(leaf['KEYV']) // 4}f", leaf["KEYV"])
                records = list(struct.iter_unpack("<IBBHIIQ", leaf["TRAK"]))
                self.assertEqual(len(records), len(clip["tracks"]))
                for record, track in zip(records, clip["tracks"]):
                    target, path, interpolation, components, keys, first_time, first_value = record
                    self.assertEqual((target, path, interpolation, keys),
                                     tuple(track[key] for key in ("target", "path", "interpolation", "keys")))
                    points = {t: [column[k] for column in track["values"]]
                              for k, t in enumerate(data["times"][track["times"]])}
                    per_key = components * (3 if interpolation == 2 else 1)
                    for key in range(keys):
                        at = first_value + key * per_key + (components if interpolation == 2 else 0)
                        time = times[first_time + key]
                        point = next((p for t, p in points.items() if abs(t - time) < 1e-5), None)
                        self.assertIsNotNone(point, (clip["name"], target, time))
                        for a, b in zip(values[at : at + components], point):
                            self.assertAlmostEqual(a, b, delta=2e-5 * max(1, abs(a)))

    def test_images_are_embedded_as_they_are(self):
        file = Chunk.read(self.converted("tentacle").read_bytes())
        pictures = [chunk.payload[16:] for _, chunk in file.walk() if chunk.letters == "IMAG"]
        textures = data_of(self.page("tentacle"))["textures"]["list"]
        images = [image for texture in textures for image in texture["images"] if "src" in image]
        self.assertEqual([base64.b64decode(image["src"].partition(",")[2], validate=True) for image in images], pictures)
        self.assertTrue(pictures)

    def test_equal_warnings_are_one_line_with_names(self):
        def flagged(name, flag):
            return {"name": name, "translation": [0, 1, 0],
                    "extensions": {"BENDY_joint_limits": {"limits": [
                        {"model": "hinge", "x": [-1, 1], "scope": scope, flag: True} for scope in ("ikOnly", "allButIk")]}}}

        file = GltfFile(nodes=[{"name": "Root", "children": [1, 2, 3, 4, 5, 6, 7, 8]},
                               *[flagged(f"Finger{k}", "proposed") for k in range(7)], flagged("Tail", "approximated")],
                        scenes=[{"nodes": [0]}], extensionsUsed=["BENDY_joint_limits"])
        file.write(self.folder / "flags.gltf")
        result = self.bendy("convert", "-q", "flags.gltf", "-o", "flags.bendy")
        self.assertEqual((result.returncode, result.stderr), (0, b""))
        warnings = data_of(self.page("flags"))["warnings"]
        self.assertEqual([warning["text"] for warning in warnings["list"]], [
            "joint constraints approximate the source, which Bendy cannot represent exactly: Tail",
            "joint constraints proposed by --auto-rig, not by an author: Finger0, Finger1, Finger2, Finger3, Finger4 and 2 more"])
        self.assertEqual(warnings["total"], 2)

    def test_hostile_text_stays_text(self):
        page = self.page("hostile")
        block = page[page.index('id="data">') + 10 :]
        block = block[: block.index("</script>")]
        self.assertNotRegex(block, r"[<>&]|[^\x20-\x7e]")
        found = set(leaves(json.loads(block)))
        for name in HOSTILE:
            shown = name.replace("\u2028", r"\u2028").replace("\u2029", r"\u2029")  # visible, as in a terminal
            self.assertTrue(any(text and shown.startswith(text.removesuffix("...")) and len(text) > 10 for text in found
                                ), name)

    def test_faulty_files_give_a_page(self):
        good = self.converted("tentacle").read_bytes()
        file = Chunk.read(good)
        sums = bytearray(good)
        sums[file.find("HEAD/VERS").offset + 5] ^= 1
        (self.folder / "sums.bendy").write_bytes(sums)
        result = self.bendy("inspect", "sums.bendy", "--html", "sums.html")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("the file has faults", result.stderr.decode())
        data = data_of((self.folder / "sums.html").read_text())
        faults = data["faults"]["list"]
        self.assertEqual({fault["code"] for fault in faults}, {"SUM_MISMATCH"})
        self.assertIn("HEAD/VERS", [fault["path"] for fault in faults])
        self.assertEqual(data["chunks"]["total"], len(list(file.walk())))

        (self.folder / "cut.bendy").write_bytes(good[: len(good) // 2])
        result = self.bendy("inspect", "cut.bendy", "--html", "cut.html")
        self.assertEqual((result.returncode, result.stdout), (1, b""))
        data = data_of((self.folder / "cut.html").read_text())
        self.assertEqual(data["faults"]["total"], 1)
        self.assertNotIn("chunks", data)

    def test_damaged_files_never_crash(self):
        good = self.converted("hostile").read_bytes()
        for at in range(0, len(good), 41):
            (self.folder / "damaged.bendy").write_bytes(good[:at] + bytes([good[at] ^ 0xFF]) + good[at + 1 :])
            result = self.bendy("inspect", "damaged.bendy", "--html", "damaged.html")
            self.assertIn(result.returncode, (0, 1), (at, result.stderr))
            data_of((self.folder / "damaged.html").read_text())

    def test_large_files_give_a_bounded_page(self):
        file = Chunk.read(self.converted("hostile").read_bytes())
        file.children += [Chunk("ODD" + chr(65 + n % 26), bytes(1)) for n in range(120_000)]
        (self.folder / "large.bendy").write_bytes(file.write())
        result = self.bendy("inspect", "large.bendy", "--html", "large.html")
        self.assertEqual(result.returncode, 0, result.stderr)
        page = (self.folder / "large.html").read_text()
        self.assertLess(len(page), 16 << 20)
        data = data_of(page)
        self.assertGreater(data["chunks"]["total"], 120_000)
        self.assertEqual(len(data["chunks"]["id"]), 100_000)
        self.assertEqual(len(data["warnings"]["list"]), 1000)

    def test_large_skeletons_have_fewer_pictures(self):
        """At most 200,000 bones are drawn in all: of 20,000 joints, 10 frames in place of 16."""
        joints = 20_000
        file = GltfFile(nodes=[{"translation": [0.02 * (k % 7), 0.05, 0.01 * (k % 5)],
                                **({"children": below} if (below := [n for n in (2 * k + 1, 2 * k + 2) if n < joints])
                                   else {})} for k in range(joints)], scenes=[{"nodes": [0]}])
        times = file.add([(0,), (1,)], "SCALAR")
        moved = file.add([(0, 0, 0), (0, 1, 0)], "VEC3")
        file.document["animations"] = [{"channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
                                        "samplers": [{"input": times, "output": moved}]}]
        file.write(self.folder / "skeleton.gltf")
        result = self.bendy("convert", "-q", "skeleton.gltf", "-o", "skeleton.bendy")
        self.assertEqual(result.returncode, 0, result.stderr)
        pictures = data_of(self.page("skeleton"))["pictures"]["list"]
        self.assertEqual(len(pictures), 2)
        clip = base64.b64decode(pictures[1]["src"].partition(",")[2], validate=True)
        self.assertEqual(clip.count(b"ANMF"), 10)

    def test_options_that_exclude_each_other(self):
        path = self.converted("hostile")
        for option in (["--json"], ["--hex"], ["--all"], ["--chunk", "HEAD"]):
            result = self.bendy("inspect", path, "--html", "no.html", *option)
            self.assertEqual((result.returncode, result.stdout), (2, b""), option)
        result = self.bendy("inspect", path, "--html", "no/folder.html")
        self.assertEqual((result.returncode, result.stdout), (1, b""))
        self.assertFalse((self.folder / "no.html").exists())


@unittest.skipUnless(CHROMIUM, "Chromium is not installed: the pages are not shown (scripts/setup.sh all installs it)")
class InChromium(Case):
    def shown(self, name, page, script=""):
        """The page's element tree after its script has run, and what the browser's console said. `script` runs after
        it, let in through the page's policy by its own sum, and may put words into the root's data-result."""
        if script:
            digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
            page = page.replace("script-src ", f"script-src 'sha256-{digest}' ", 1)
            page = page.replace("</body>", f"<script>{script}</script></body>", 1)
        path = self.folder / f"{name}_shown.html"
        path.write_text(page, encoding="utf-8")
        profile = tempfile.mkdtemp(dir=self.folder)
        result = subprocess.run(
            [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync", "--enable-logging=stderr",
             f"--user-data-dir={profile}", "--window-size=1200,900", "--virtual-time-budget=2000", "--dump-dom",
             path.as_uri()],
            capture_output=True, timeout=300, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        dom = result.stdout.decode("utf-8")
        console = [line for line in result.stderr.decode("utf-8", "replace").splitlines() if "CONSOLE" in line]
        self.assertEqual(console, [])
        top = re.search(r"<html[^>]*>", dom).group()
        self.assertIn('data-ready="yes"', top)
        for trouble in ("data-error", "data-blocked"):
            self.assertNotIn(trouble, top)
        self.assertFalse('id="ran"' in dom)
        return dom

    def test_examples_are_drawn(self):
        for name in ("tentacle", "mannequin"):
            data = data_of(self.page(name))
            chunks = data["chunks"]
            letters = [chunks["ids"][i] for i in chunks["id"]]
            rows = sum(parent < 0 or parent == 0 or letters[parent] == "OBJE" for parent in chunks["parent"])
            joints = len(data["objects"][0]["joints"]["name"])
            dom = self.shown(name, self.page(name))
            self.assertEqual(dom.count('role="treeitem"'), rows + joints)
            self.assertGreater(len(re.findall(r'<button class="cell [a-z]', dom)), 20)
            clip = data["objects"][0]["clips"]["list"][0]
            tracks = [track for track in clip["tracks"]
                      if (track["target"], track["path"] == 3) == (clip["tracks"][0]["target"],
                                                                   clip["tracks"][0]["path"] == 3)]
            # Rotations are drawn as three angles; what does not move may be said in words instead.
            drawn = len(re.findall(r'<path class="curve', dom))
            self.assertLessEqual(drawn, sum(3 if t["path"] == 1 else len(t["values"]) for t in tracks))
            self.assertGreaterEqual(drawn, len(tracks))
            self.assertGreaterEqual(len(data["pictures"]["list"]), 2)
            self.assertEqual(dom.count("<img "), len(data["pictures"]["list"]) + sum(
                "src" in image for texture in data["textures"]["list"] for image in texture["images"]))
            self.assertTrue("\u2713 valid" in dom)

    def test_mouse_and_keys(self):
        data = data_of(self.page("tentacle"))
        total = data["chunks"]["total"]
        script = """
const rows = () => document.querySelectorAll('#tree [role=treeitem]').length;
const cells = () => document.querySelectorAll('.cell').length;
const key = (node, name) => node.dispatchEvent(new KeyboardEvent('keydown', { key: name, bubbles: true, cancelable: true }));
const button = text => [...document.querySelectorAll('#tree button')].find(b => b.textContent === text);
const result = {};
button('Unfold all').click();
result.unfolded = rows();
button('Fold all').click();
result.folded = rows();
const first = document.querySelector('#tree [role=treeitem]');
key(first, 'ArrowRight');
result.opened = rows();
const search = document.querySelector('#tree input');
search.value = 'key values';
search.dispatchEvent(new Event('input'));
result.found = [...document.querySelectorAll('#tree [role=treeitem] b')].filter(b => b.textContent.startsWith('KEYV')).length;
const clip = [...document.querySelectorAll('.cell.anim')].find(c => c.textContent.startsWith('CYCL'));
clip.click();
result.trail = document.getElementById('trail').textContent;
result.info = document.getElementById('mapinfo').textContent;
key(document.getElementById('map'), 'Escape');
result.out = document.getElementById('trail').textContent;
const target = document.getElementById('target');
target.value = target.options.length - 1;
target.dispatchEvent(new Event('change'));
result.charts = document.querySelectorAll('#charts figure').length;
const canvas = document.getElementById('bones');
const before = canvas.toDataURL();
key(canvas, 'ArrowLeft');
result.turned = canvas.toDataURL() !== before;
target.value = 0;
target.dispatchEvent(new Event('change'));
result.degrees = document.querySelectorAll('.curve.c3').length;
document.getElementById('degrees').click();
result.quaternion = document.querySelectorAll('.curve.c3').length;
const svg = document.querySelector('.chart');
key(svg, 'ArrowRight');
result.reading = document.querySelector('figcaption .readout').textContent;
document.documentElement.dataset.result = JSON.stringify(result);
"""
        dom = self.shown("keys", self.page("tentacle"), script)
        result = json.loads(html.unescape(re.search(r'data-result="([^"]*)"', dom).group(1)))
        self.assertEqual(result["unfolded"], min(total, 1000))
        self.assertEqual(result["folded"], 1)
        self.assertEqual(result["opened"], 1 + data["chunks"]["parent"].count(0))
        self.assertEqual(result["found"], len(data["objects"][0]["clips"]["list"]))
        self.assertRegex(result["trail"], r"^HEAD/OBJE/CYCL")
        self.assertRegex(result["info"], r"^HEAD/OBJE/CYCL.* bytes .*% of the file")
        self.assertEqual(result["out"], "HEAD/OBJE")
        self.assertGreater(result["charts"], 0)
        self.assertTrue(result["turned"])
        self.assertGreater(result["quaternion"], 0)
        self.assertEqual(result["degrees"], 0)
        self.assertRegex(result["reading"], r" s: x ")

    def test_hostile_names_are_shown_and_do_not_run(self):
        dom = self.shown("hostile", self.page("hostile"))
        for name in HOSTILE[:2]:
            self.assertTrue(html.escape(name, quote=False) in dom)
        self.assertFalse("<img src=\"x\"" in dom)
        self.assertFalse("<svg onload" in dom)
        self.assertTrue("cannot show it" in dom)  # the bytes that are no picture

    def test_broken_and_large_files(self):
        good = self.converted("tentacle").read_bytes()
        (self.folder / "cut.bendy").write_bytes(good[: len(good) // 2])
        self.bendy("inspect", "cut.bendy", "--html", "cut.html")
        dom = self.shown("cut", (self.folder / "cut.html").read_text())
        self.assertTrue("1 fault" in dom)
        self.assertTrue("TRUNCATED" in dom)

        file = Chunk.read(self.converted("hostile").read_bytes())
        file.children += [Chunk("ODDS", bytes(1)) for _ in range(65_000)]
        (self.folder / "many.bendy").write_bytes(file.write())
        self.bendy("inspect", "many.bendy", "--html", "many.html")
        dom = self.shown("many", (self.folder / "many.html").read_text())
        self.assertLessEqual(dom.count('role="treeitem"'), 1010)
        self.assertLessEqual(len(re.findall(r'<button class="cell', dom)), 1500)


if __name__ == "__main__":
    main()
