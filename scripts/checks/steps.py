"""The steps of the checks, in the order in which they run: the tests that anybody runs first, then the rest of the gate, and in it
those that fail often before those that take long."""

import dataclasses
import os

CPUS = os.cpu_count() or 2


@dataclasses.dataclass(frozen=True)
class Tests:
    """Tests of a build, by their labels."""
    preset: str
    labels: tuple
    without: tuple = ()
    environment: dict = dataclasses.field(default_factory=dict)
    jobs: int = CPUS


@dataclasses.dataclass(frozen=True)
class Step:
    """One check."""
    name: str
    ring: str  # test, gate, all, or asked: only when it is named
    what: str
    commands: tuple = ()
    tests: tuple = ()
    environment: dict = dataclasses.field(default_factory=dict)
    # For --since, beside the programs and scripts of the tests: CMake targets, and files of the project, that the commands use.
    uses: tuple = ()
    needs: tuple = ()  # steps that run before, when this one is named

    @property
    def setup(self):
        """What installs the packages: an argument of scripts/setup.sh."""
        return "all" if self.ring == "asked" else self.ring


def ctest_command(tests, results, more):
    command = ["ctest", "--preset", tests.preset, "-j", str(tests.jobs), "-L", f"^({'|'.join(tests.labels)})$",
               "--output-junit", str(results), "--test-output-size-passed", "100000", "--no-tests=error"]
    if tests.without:
        command += ["-LE", f"^({'|'.join(tests.without)})$"]
    return [*command, *more]


def configure(preset, *options):
    return ["cmake", "--preset", preset, *options]


def build(preset, *targets):
    return ["cmake", "--build", "--preset", preset, *(["--target", *targets] if targets else [])]


def release(needed):
    return configure("release", "-DBENDY_TESTS=ON", "-DBENDY_WARNINGS_AS_ERRORS=ON", f"-DBENDY_TESTS_NEEDED={needed}")


UNITS = ("format", "runtime", "capi", "threads", "mutation", "conformance", "compat", "json", "edit", "motion", "converter", "text_form", "memory")

STEPS = (
    # What a newcomer runs: a compiler, libraries and Python are enough.
    Step("build", "test", "optimised, warnings are errors", (release("test"), build("release", "gate"))),
    Step("tests", "test", "units, command line, specification, conformance, determinism, C, Python",
         tests=(Tests("release", (*UNITS, "viewer", "architecture", "spec", "release", "determinism", "cli", "reference", "python")),),
         needs=("build",)),
    Step("corpus", "test", "real characters, known poses", tests=(Tests("release", ("corpus",)),), needs=("build",)),

    # The rest of the gate.
    Step("format", "gate", "sources are formatted, and what is made of bendy.h is up to date",
         (["scripts/lint.sh"], ["python3", "bindings/make_c.py", "bindings/c/include/bendy.h", "bindings/c/src", "--check"])),
    Step("tidy", "gate", "clang-tidy of what has changed, and of what includes it", (["scripts/lint.sh", "build/release", "--changed"],),
         needs=("build",)),
    Step("asan", "gate", "AddressSanitizer and UndefinedBehaviorSanitizer, by clang",
         (configure("asan-ubsan", "-DBENDY_TESTS_NEEDED=test"), build("asan-ubsan", "gate", "fuzz_targets")),
         (Tests("asan-ubsan", (*UNITS, "viewer", "cli"), without=("exhaustive",)),)),
    Step("threads", "gate", "ThreadSanitizer: what uses threads", (configure("tsan"), build("tsan")), (Tests("tsan", ("threads",)),)),
    Step("web", "gate", "the runtime as WebAssembly, under node", (["scripts/web.sh", "runtime"],), needs=("build",)),
    Step("fuzz", "gate", "every fuzz target for five seconds, with one seed", (["scripts/fuzz.sh"],), needs=("build", "asan")),

    # The outer ring.
    Step("everything", "all", "all programs, warnings are errors; examples, the two files of the amalgamated runtime",
         (release("all"), build("release"), ["scripts/checks/check_labels.py"]), (Tests("release", ("examples", "amalgamated")),),
         uses=("bendy", "bench", "tests", "examples", "scripts/amalgamate.py", "cmake", "scripts/checks")),
    Step("headers", "all", "every public header compiles by itself", (build("release", "all_verify_interface_header_sets"),),
         needs=("everything",), uses=("bendy", "bendy_python")),
    Step("no-exceptions", "all", "the embeddable part without exceptions and RTTI", (configure("no-exceptions"), build("no-exceptions")),
         uses=("bendy_c",)),
    Step("least", "all", "the program without X-files, Quake II models, rigging by shape and the viewer",
         (configure("least"), build("least"), ["build/least/cli/bendy", "convert", "--quiet", "examples/mannequin.glb", "-o", "build/least/mannequin.bendy"]),
         uses=("bendy",)),
    Step("standard-cpp", "all", "the libraries in the standard language only, by clang with libc++",
         (configure("standard-cpp"), build("standard-cpp")), (Tests("standard-cpp", ("format", "runtime", "capi", "threads")),),
         uses=("bendy_c",)),
    Step("elsewhere", "all", "kernels of other processors: NEON under qemu, WebAssembly under node",
         (["scripts/elsewhere.sh"],), uses=("bendy_runtime", "tests/elsewhere", "scripts/elsewhere.sh")),
    Step("tidy-all", "all", "clang-tidy of everything", (["scripts/lint.sh", "build/release"],), needs=("everything",),
         uses=("bendy", "bendy_python", "bench", "examples", "scripts/lint.sh", "scripts/tidy_in_groups.py", ".clang-tidy")),
    Step("install", "all", "what is installed, packages, wheel, CMake and Bazel rules", tests=(Tests("release", ("install",)),),
         needs=("everything",), uses=("packaging", "cmake", "scripts/make_wheel.py", "setup.py", "pyproject.toml", "bendy", "bendy_python")),
    Step("docs", "all", "what the pages show runs; man pages and completions; the site", tests=(Tests("release", ("docs",)),),
         needs=("everything",), uses=("docs", "*.md", "scripts/reference", "scripts/make_site.py", "bendy", "bendy_python")),
    Step("witnesses", "all", "exports read by Khronos' validator, three.js, assimp; files by a second reader",
         tests=(Tests("release", ("export", "second_reader")),), needs=("everything",), uses=("spec",)),
    Step("pictures", "all", "the viewer, pictures beside three.js's, skinning on the graphics processor",
         tests=(Tests("release", ("pictures",)),), needs=("everything",), uses=("bendy_python", "examples/gpu_skinning")),
    Step("blender", "all", "the add-on in Blender", tests=(Tests("release", ("blender",)),), needs=("everything",), uses=("bindings/blender",)),
    Step("npm", "all", "the npm package: WebAssembly with and without SIMD, the tools; in Chromium the page, the viewer, an empty project",
         (["scripts/web.sh"],), needs=("build",),
         uses=("bindings", "bendy_c", "bendy_reports", "packaging/notices", "scripts/notices.py", "scripts/web.sh",
               "scripts/cross_dependencies.sh", "cmake")),
    Step("damage", "all", "every place of the damage tests under AddressSanitizer, and what takes long there",
         (configure("asan-ubsan", "-DBENDY_TESTS_NEEDED=all"), build("asan-ubsan")),
         (Tests("asan-ubsan", ("format", "runtime", "mutation", "exhaustive", "examples")),), environment={"BENDY_PLACES": "0/1"},
         uses=("bendy",)),
    Step("fuzz-long", "all", "every fuzz target for a minute, the libraries that decode instrumented, and the npm package's tools",
         (["scripts/fuzz.sh", "60"], ["node", "tests/fuzz/fuzz_tools.mjs", "60"]), needs=("build", "npm"),
         uses=("bendy", "tests/fuzz", "scripts/fuzz.sh", "scripts/cross_dependencies.sh", "bindings/web")),
    Step("determinism", "all", "the same bytes from g++ and clang++, -O0 and -O2", (["scripts/determinism.sh"],),
         uses=("bendy_converter", "tests/determinism", "scripts/determinism.sh")),
    Step("demo", "all", "what a newcomer runs first", (["tests/demo/demo_test.py"],),
         uses=("bendy", "scripts/demo.sh", "scripts/setup.sh", "tests/demo")),
    Step("faults", "all", "each fault of tests/faults is found by the step that CONTRIBUTING.md names", (["scripts/checks/faults.py"],),
         uses=("tests/faults", "scripts", "CMakePresets.json", "CMakeLists.txt", "cmake", "CONTRIBUTING.md", ".github", ".ci")),

    Step("release", "all", "everything that a release has, twice the same bytes; each artefact makes the first pose in an empty place",
         (["tests/release/release_test.py"],),
         uses=("scripts/release", "scripts/release.sh", "scripts/static.sh", "scripts/cross_dependencies.sh", "scripts/web.sh", "scripts/make_gallery.py",
               "scripts/make_site.py", "scripts/make_wheel.py", "docs/gallery", "tests/release", "packaging", "bindings/blender", "bindings/web")),

    # Only when they are named.
    Step("coverage", "asked", "coverage of lines and branches of format/ and runtime/", (["scripts/coverage.sh"],)),
    Step("windows", "asked", "64-bit Windows under wine", (["scripts/cross.sh", "windows"],)),
    Step("aarch64", "asked", "64-bit ARM under qemu", (["scripts/cross.sh", "aarch64"],)),
    Step("static", "asked", "the program as one file without shared libraries", (["scripts/static.sh"],)),
)


def named(name):
    return next((step for step in STEPS if step.name == name), None)
