#!/usr/bin/env python3
"""Installs the libraries, static and shared, as an embedding user meets them: moves the folder, builds the outside project in
embed/ through find_package and through pkg-config, runs it, and looks at what the shared libraries export."""

import argparse
import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
from own_folder import work_folder  # noqa: E402

ARGUMENTS = argparse.Namespace()
EMBED = Path(__file__).resolve().parent / "embed"


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}:\n{done.stdout}{done.stderr}")
    return done.stdout


def install(build, work):
    """Installs a build of this script's own, moves it elsewhere, and returns where it is then."""
    shutil.rmtree(work, ignore_errors=True)
    run(ARGUMENTS.cmake, "--install", build, "--prefix", work / "first")
    (work / "first").rename(work / "moved")
    return work / "moved"


def new_folder(name):
    """An empty folder to work in."""
    folder = ARGUMENTS.work / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def without_paths():
    """An environment that does not tell where libraries are: what is installed under a prefix of one's own must do without."""
    return {name: value for name, value in os.environ.items() if name not in ("LD_LIBRARY_PATH", "BENDY_LIBRARY")}


def library_folder(prefix):
    return next(prefix.rglob("bendy-runtime.pc")).parent.parent


class Case(unittest.TestCase):
    def check_program(self, program, shared):
        model = ARGUMENTS.source / "spec/examples/one_joint.bendy"
        self.assertRegex(run(program, model, env=without_paths()), r"^1 joints, first vertex at ")
        needed = re.findall(r"NEEDED.*\[(.*)\]", run("readelf", "-d", program))
        self.assertEqual([name for name in needed if "bendy" in name],
                         ["libbendy-runtime.so.0.1", "libbendy-format.so.0.1"] if shared else [])

    def check_find_package(self, prefix, work, shared):
        run(ARGUMENTS.cmake, "-S", EMBED, "-B", work / "embed", "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={ARGUMENTS.cxx}",
            f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_DISABLE_FIND_PACKAGE_zstd={'ON' if shared else 'OFF'}")
        run(ARGUMENTS.cmake, "--build", work / "embed")
        self.check_program(work / "embed/embed", shared)

    def check_pkg_config(self, prefix, work, shared):
        environment = {**os.environ, "PKG_CONFIG_PATH": str(library_folder(prefix) / "pkgconfig")}
        flags = {}
        for wanted in ("--cflags", "--libs"):
            flags[wanted] = run("pkg-config", wanted, "bendy-runtime", env=environment).split()
            self.assertNotIn("first", " ".join(flags[wanted]))
        program = work / "by_pkg_config"
        run(ARGUMENTS.cxx, "-std=c++20", EMBED / "main.cpp", *flags["--cflags"], "-o", program, *flags["--libs"])
        self.check_program(program, shared)
        older = subprocess.run([ARGUMENTS.cxx, "-std=c++17", "-fsyntax-only", EMBED / "main.cpp", *flags["--cflags"]],
                               capture_output=True, text=True, check=False)
        self.assertIn("bendy needs C++20", older.stderr)
        static = run("pkg-config", "--static", "--libs", "bendy-runtime", env=environment).split()
        self.assertLess(static.index("-lbendy-runtime"), static.index("-lbendy-format"))
        self.assertLess(static.index("-lbendy-format"), static.index("-lzstd"))
        self.assertLess(static.index("-lbendy-format"), static.index("-lmeshoptimizer"))


class Static(Case):
    def test_embedding(self):
        work, prefix = new_folder("static"), ARGUMENTS.prefix
        self.assertFalse(list(prefix.rglob("libbendy-format.so*")))
        self.check_find_package(prefix, work, shared=False)
        self.check_pkg_config(prefix, work, shared=False)

    def test_the_c_api_is_found_under_a_prefix_of_ones_own(self):
        work, prefix = new_folder("c"), ARGUMENTS.prefix
        library = next(prefix.rglob("libbendy.so.0"), None)
        if library is None:
            self.skipTest("this build has no shared libbendy")
        request = [ARGUMENTS.source / "spec/examples/every_chunk.bendy", "wave", "0.3"]
        # From C: what pkg-config says is enough to link the program and to run it.
        flags = run("pkg-config", "--cflags", "--libs", "bendy",
                    env={**os.environ, "PKG_CONFIG_PATH": str(library.parent / "pkgconfig")}).split()
        program = work / "pose_c"
        run("cc", "-std=c99", ARGUMENTS.source / "examples/pose.c", *flags, "-o", program)
        from_c = run(program, *request, env=without_paths())
        self.assertIn("\nv ", from_c)
        # From Python: beside the file, by the program on the PATH, and as BENDY_LIBRARY says.
        script = prefix / "share/bendy/bendy_ctypes.py"
        script.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ARGUMENTS.source / "examples/bendy_ctypes.py", script)
        alone = work / "alone.py"
        shutil.copy(script, alone)
        plain = {**without_paths(), "PATH": "/usr/bin:/bin"}
        for file, environment in ((script, plain), (alone, {**plain, "PATH": f"{prefix / 'bin'}:/usr/bin:/bin"}),
                                  (alone, {**plain, "BENDY_LIBRARY": str(library)})):
            with self.subTest(file=file.name, environment=environment["PATH"]):
                self.assertEqual(run(sys.executable, file, *request, env=environment), from_c)
        done = subprocess.run([sys.executable, *map(str, (alone, *request))], capture_output=True, text=True, check=False,
                              env={**plain, "BENDY_LIBRARY": "/nowhere/libbendy.so.0"})
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("BENDY_LIBRARY", done.stderr)


class Shared(Case):
    @classmethod
    def setUpClass(cls):
        # Not optimised: quicker to build, and every inline function that could be exported is there.
        build = ARGUMENTS.work / "shared_build"
        run(ARGUMENTS.cmake, "-S", ARGUMENTS.source, "-B", build, "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={ARGUMENTS.cxx}",
            "-DCMAKE_BUILD_TYPE=None", "-DBUILD_SHARED_LIBS=ON", "-DBENDY_TOOLS=OFF", "-DBENDY_TESTS=OFF",
            "-DBENDY_BENCHMARKS=OFF", "-DBENDY_EXAMPLES=OFF")
        run(ARGUMENTS.cmake, "--build", build, "-j2")
        cls.work = ARGUMENTS.work / "shared"
        cls.prefix = install(build, cls.work)

    def test_embedding(self):
        self.check_find_package(self.prefix, self.work, shared=True)
        self.check_pkg_config(self.prefix, self.work, shared=True)

    def test_names_of_the_files(self):
        folder = library_folder(self.prefix)
        for library in ("format", "runtime"):
            link = folder / f"libbendy-{library}.so"
            self.assertEqual(os.readlink(link), f"{link.name}.0.1")
            self.assertEqual(os.readlink(f"{link}.0.1"), f"{link.name}.0.1.0")
            self.assertIn(f"soname: [{link.name}.0.1]", run("readelf", "-d", link))

    def test_nothing_but_the_public_interface_is_exported(self):
        headers = "\n".join(file.read_text(encoding="utf-8") for file in (self.prefix / "include").rglob("*.h"))
        # What is only named there, to be a friend, is not public.
        headers = re.sub(r"^namespace bendy \{.*?^\}|^ *friend .*?;|//[^\n]*", "", headers, flags=re.M | re.S)
        public = set(re.findall(r"\w+", headers))
        for library in ("format", "runtime"):
            lines = run("nm", "-D", "--defined-only", "-C", library_folder(self.prefix) / f"libbendy-{library}.so").splitlines()
            self.assertGreater(len(lines), 50)
            for line in lines:
                symbol = line.split(" ", 2)[2]
                with self.subTest(library=library, symbol=symbol):
                    name = own_name(symbol)
                    self.assertRegex(name, "^bendy::")
                    self.assertLessEqual(set(re.findall(r"\w+", name)), public | {"bendy"})


    def test_all_that_is_not_hidden_is_exported(self):
        for library in ("format", "runtime"):
            name = f"libbendy-{library}"
            exported = set(re.findall(r"\S+$", run("nm", "-D", "--defined-only", library_folder(self.prefix) / f"{name}.so"), re.M))
            table = run("readelf", "-sW", ARGUMENTS.build / library / f"{name}.a")
            visible = set(re.findall(r" FUNC +GLOBAL +DEFAULT +\d+ (\S+)", table))
            self.assertGreater(len(visible), 50)
            self.assertEqual(visible - exported, set())


def own_name(symbol):
    """The qualified name in a demangled symbol, without parameters, template arguments and what it returns."""
    symbol = re.sub(r"^(guard variable|typeinfo name|typeinfo|vtable) for ", "", symbol)
    symbol = symbol.replace("operator()", "operator").replace("(anonymous namespace)", "anonymous_namespace")
    while (shorter := re.sub(r"<[^<>]*>|\([^()]*\)|\[abi:\w+\]", "", symbol)) != symbol:
        symbol = shorter
    return re.sub(r"( const| &&?)+$", "", symbol).split(" ")[-1]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--cmake", required=True)
    parser.add_argument("--cxx", required=True)
    parser.add_argument("--source", required=True, type=Path)
    parser.add_argument("--build", required=True, type=Path, help="a static build")
    parser.add_argument("--prefix", required=True, type=Path, help="where that is installed")
    parser.add_argument("--work", required=True, type=work_folder, help="a folder to work in")
    _, rest = parser.parse_known_args(namespace=ARGUMENTS)
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
