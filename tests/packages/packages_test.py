#!/usr/bin/env python3
"""The media type, as file(1) and a desktop see it; and the Debian packages: what is in them, what they ask for, and that the
program runs from them."""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ARGUMENTS = argparse.Namespace()


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, timeout=300, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def needs(*programs):
    missing = [program for program in programs if not shutil.which(program)]
    return unittest.skipIf(missing, f"not installed: {', '.join(missing)}")


class Case(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)


class MediaType(Case):
    def setUp(self):
        super().setUp()
        self.packaging = ARGUMENTS.source / "packaging"
        # Known by its content, whatever it is called; what is no bendy file but begins like one is not.
        self.good = self.folder / "no_ending"
        data = (ARGUMENTS.source / "spec/examples/every_chunk.bendy").read_bytes()
        self.good.write_bytes(data)
        self.sent_as_text = self.folder / "sent_as_text"
        self.sent_as_text.write_bytes(data.replace(b"\r\n", b"\n"))

    @needs("file")
    def test_file_knows_it(self):
        def kind(path, *options):
            return run("file", "-b", *options, "-m", self.packaging / "bendy.magic", path).strip()

        self.assertEqual(kind(self.good), "Bendy animated character, version 0.1, 2 joints, 6 vertices, 2 clips")
        self.assertEqual(kind(self.good, "--mime-type"), "model/x-bendy")
        self.assertEqual(kind(self.good, "--extension"), "bendy")
        for other in (self.sent_as_text, ARGUMENTS.source / "examples/tentacle.glb", ARGUMENTS.source / "LICENSE"):
            self.assertNotIn("Bendy", kind(other))

    @needs("file")
    def test_file_takes_it_from_the_home_folder_too(self):
        shutil.copy(self.packaging / "bendy.magic", self.folder / ".magic")
        environment = {**os.environ, "HOME": str(self.folder)}
        self.assertIn("Bendy animated character", run("file", "-b", self.good, env=environment))
        self.assertIn("glTF", run("file", "-b", ARGUMENTS.source / "examples/tentacle.glb", env=environment))

    @needs("update-mime-database", "gio")
    def test_desktop_knows_it(self):
        packages = self.folder / "data/mime/packages"
        packages.mkdir(parents=True)
        shutil.copy(self.packaging / "bendy.xml", packages)
        run("update-mime-database", self.folder / "data/mime")
        named = self.folder / "damaged.bendy"
        named.write_bytes(bytes(range(16)))

        def kind(path):
            return run("gio", "info", "-a", "standard::content-type", path,
                       env={**os.environ, "XDG_DATA_HOME": str(self.folder / "data")}).split()[-1]

        self.assertEqual(kind(self.good), "model/x-bendy")
        self.assertEqual(kind(named), "model/x-bendy")
        self.assertNotEqual(kind(self.sent_as_text), "model/x-bendy")

    @needs("desktop-file-validate")
    def test_desktop_entry(self):
        self.assertEqual(run("desktop-file-validate", self.packaging / "bendy-view.desktop"), "")


@needs("dpkg-deb", "dpkg-shlibdeps", "file")
class Packages(Case):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.out = Path(temporary.name)
        run(ARGUMENTS.cpack, "--config", ARGUMENTS.build / "CPackConfig.cmake", "-B", cls.out, cwd=cls.out)
        cls.packages = {path.name.split("_")[0]: path for path in cls.out.glob("*.deb")}
        cls.version = (ARGUMENTS.source / "CMakeLists.txt").read_text(encoding="utf-8").split("project(bendy VERSION ")[1].split()[0]

    def test_fields(self):
        self.assertEqual(sorted(self.packages), ["bendy", "libbendy-dev", "libbendy0"])
        for name, wanted in {"bendy": "libc6 libstdc++6 libzstd1", "libbendy-dev": "libglm-dev libzstd-dev libmeshoptimizer-dev libbendy0",
                             "libbendy0": "libc6 libstdc++6 libzstd1"}.items():
            path = self.packages[name]
            self.assertEqual(path.name, f"{name}_{self.version}-1_{run('dpkg', '--print-architecture').strip()}.deb")
            fields = dict(re.findall(r"^ (\S+): (.*)", run("dpkg-deb", "-I", path), re.M))
            self.assertEqual((fields["Package"], fields["Version"]), (name, f"{self.version}-1"))
            self.assertLessEqual(set(wanted.split()), set(re.findall(r"[\w+.-]+", fields["Depends"])))

    def test_contents(self):
        wanted = {
            "bendy": "usr/bin/bendy usr/share/man/man1/bendy.1.gz usr/share/man/man1/bendy-convert.1.gz usr/share/bash-completion/completions/bendy "
                     "usr/share/fish/vendor_completions.d/bendy.fish usr/share/mime/packages/bendy.xml usr/share/bendy/bendy.magic "
                     "usr/share/doc/bendy/copyright usr/share/doc/bendy/changelog.Debian.gz",
            "libbendy-dev": "usr/include/bendy/runtime.h usr/include/bendy/format/records.def usr/include/bendy.h usr/share/doc/libbendy-dev/copyright",
            "libbendy0": "usr/share/doc/libbendy0/copyright",
        }
        for name, path in self.packages.items():
            lines = run("dpkg-deb", "-c", path).splitlines()
            files = {line.split()[5].removeprefix("./") for line in lines if not line.startswith("d")}
            self.assertLessEqual(set(wanted[name].split()), files)
            for line in lines:
                with self.subTest(line=line):
                    self.assertRegex(line, r"^(drwxr-xr-x|-rw-r--r--|-rwxr-xr-x|lrwxrwxrwx) root/root ")
                    self.assertRegex(line, r" \./(usr/.*)?$| \./usr/$")
            self.assertEqual("usr/bin/bendy" in files, name == "bendy")
            self.assertEqual(any(file.endswith("pkgconfig/bendy-runtime.pc") for file in files), name == "libbendy-dev")
            self.assertEqual(any(file.endswith("libbendy-runtime.a") for file in files), name == "libbendy-dev")
            self.assertEqual(any(file.endswith("libbendy.so") for file in files), name == "libbendy-dev")
            self.assertEqual(any(file.endswith("libbendy.so.0") for file in files), name == "libbendy0")
            self.assertEqual("usr/share/applications/bendy-view.desktop" in files, name == "bendy" and ARGUMENTS.viewer)

    def test_program_runs_from_the_package(self):
        run("dpkg-deb", "-x", self.packages["bendy"], self.folder / "root")
        bendy = self.folder / "root/usr/bin/bendy"
        self.assertEqual(run(bendy, "--version"), f"bendy {self.version}\n")
        run(bendy, "convert", ARGUMENTS.source / "examples/tentacle.glb", "-o", self.folder / "tentacle.bendy")
        self.assertEqual(run(bendy, "validate", self.folder / "tentacle.bendy"), "")
        self.assertNotRegex(run("readelf", "-d", bendy), "RPATH|RUNPATH")

    def test_every_library_is_of_a_package_that_is_asked_for(self):
        run("dpkg-deb", "-x", self.packages["bendy"], self.folder / "root")
        bendy = self.folder / "root/usr/bin/bendy"
        fields = dict(re.findall(r"^ (\S+): (.*)", run("dpkg-deb", "-I", self.packages["bendy"]), re.M))
        asked_for = set(re.findall(r"[\w+.-]+", fields["Depends"]))
        places = dict(re.findall(r"^\s*(\S+) => (/\S+)", run("ldd", bendy), re.M))
        needed = re.findall(r"NEEDED.*\[(.*)\]", run("readelf", "-d", bendy))
        self.assertIn("libzstd.so.1", needed)
        for library in needed:
            if library not in places:
                continue  # the loader itself
            found = run("dpkg", "-S", "*/" + Path(places[library]).resolve().name)
            owners = {line.split(":")[0] for line in found.splitlines()}
            with self.subTest(library=library):
                self.assertTrue(owners & asked_for, f"{owners} is not in {fields['Depends']}")

    @needs("dpkg")
    def test_dpkg_installs_and_removes_them(self):
        root = self.folder / "root"
        (root / "var/lib/dpkg/updates").mkdir(parents=True)
        (root / "var/lib/dpkg/info").mkdir()
        (root / "var/lib/dpkg/status").touch()
        (root / "var/log").mkdir()
        dpkg = ["dpkg", f"--root={root}", "--force-depends", "--force-not-root", "--log=/dev/null"]
        environment = {**os.environ, "PATH": f"{os.environ['PATH']}:/usr/sbin:/sbin"}
        # A library's scripts call ldconfig, and there is no shell in that root: unpacked is as far as it gets.
        last = {name: "unpacked" if name == "libbendy0" else "installed" for name in self.packages}
        for name, package in self.packages.items():
            run(*dpkg, "-i" if last[name] == "installed" else "--unpack", package, env=environment)
            self.assertIn(f"Status: install ok {last[name]}", run("dpkg", f"--root={root}", "-s", name))
        self.assertTrue((root / "usr/bin/bendy").exists())
        run(*dpkg, "-r", *[name for name in self.packages if last[name] == "installed"], env=environment)
        self.assertFalse((root / "usr/bin/bendy").exists())


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--source", required=True, type=Path)
    parser.add_argument("--build", required=True, type=Path)
    parser.add_argument("--cpack", required=True)
    parser.add_argument("--viewer", action="store_true", help="the program was built with it")
    _, rest = parser.parse_known_args(namespace=ARGUMENTS)
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
