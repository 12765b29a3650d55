"""A Conan 2 recipe for the runtime, run in a checkout: conan create packaging/conan"""

from pathlib import Path

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy


class Bendy(ConanFile):
    name = "bendy"
    version = "0.1.0"
    description = "A file format for animated characters: the runtime that poses them"
    license = "MIT"
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "zstd": [True, False], "meshoptimizer": [True, False]}
    default_options = {"shared": False, "zstd": True, "meshoptimizer": True}

    def export_sources(self):
        root = Path(self.recipe_folder).parents[1]
        for pattern in ("CMakeLists.txt", "LICENSE", "cmake/*", "format/*", "runtime/*", "bindings/c/*", "packaging/*", "scripts/*"):
            copy(self, pattern, src=root, dst=self.export_sources_folder)

    def validate(self):
        check_min_cppstd(self, 20)

    def requirements(self):
        self.requires("glm/[>=0.9.9 <2]", transitive_headers=True)
        if self.options.zstd:
            self.requires("zstd/[>=1.4 <2]")
        if self.options.meshoptimizer:
            self.requires("meshoptimizer/[>=0.18 <1]")

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for part in ("TOOLS", "VIEWER", "TESTS", "BENCHMARKS", "EXAMPLES"):
            toolchain.cache_variables[f"BENDY_{part}"] = False
        toolchain.cache_variables["BENDY_ZSTD"] = bool(self.options.zstd)
        toolchain.cache_variables["BENDY_MESHOPTIMIZER"] = bool(self.options.meshoptimizer)
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", src=self.source_folder, dst=Path(self.package_folder) / "licenses")

    def package_info(self):
        self.cpp_info.set_property("cmake_find_mode", "none")  # the package's own bendy-config.cmake is used
        self.cpp_info.builddirs.append("lib/cmake/bendy")
