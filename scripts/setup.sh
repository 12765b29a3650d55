#!/usr/bin/env bash
# Installs what the build and the tests need, if it is missing and we may; else names it in one line.
#   scripts/setup.sh [build|test|gate|all|cross|static|web]   build (default): compiler and libraries; test, gate, all: also what
#                                                             scripts/test.sh needs, alone or with that word; cross, static, web:
#                                                             also what the script of that name needs
set -euo pipefail
cd "$(dirname "$0")/.."

need() { # need COMMAND-OR-FILE PACKAGE: adds the package to the list if the command or file is not there
    case "$1" in
        /*) [ -e "$1" ] ;;
        *) command -v "$1" >/dev/null ;;
    esac || missing+=("$2")
}

install_missing() {
    [ ${#missing[@]} -gt 0 ] || return 0
    if [ "$(id -u)" = 0 ]; then
        as_root=()
    elif sudo -n true 2>/dev/null; then
        as_root=(sudo -n)
    else
        echo "Some Debian packages are missing. Install them with: sudo apt-get install ${missing[*]}" >&2
        exit 1
    fi
    echo "Installing from Debian: ${missing[*]}" >&2
    local log
    log=$(mktemp)
    local patient=(-qq -o DPkg::Lock::Timeout=600) # waits for another apt, such as the one that a new machine starts by itself
    if ! { "${as_root[@]}" apt-get update "${patient[@]}" &&
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y "${patient[@]}" --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
        cat "$log" >&2 # apt also says things that sound alarming and are not: nobody sees them where it works
        exit 1
    fi
    rm -f "$log"
}

what=${1:-build}
missing=()
need g++ g++
need cmake cmake
need ninja ninja-build
need /usr/include/glm/glm.hpp libglm-dev
need /usr/include/tiny_gltf.h libtinygltf-dev
need /usr/include/nlohmann/json.hpp nlohmann-json3-dev
need /usr/include/rapidjson/reader.h rapidjson-dev
need /usr/include/CLI/App.hpp libcli11-dev
need /usr/include/utf8cpp/utf8.h libutfcpp-dev
need /usr/include/meshoptimizer.h libmeshoptimizer-dev
need /usr/include/zstd.h libzstd-dev
need /usr/include/zlib.h zlib1g-dev
need /usr/include/draco/compression/decode.h libdraco-dev
need pkg-config pkg-config
need python3 python3
need /usr/include/epoxy/egl.h libepoxy-dev
need /usr/include/GLFW/glfw3.h libglfw3-dev
need /usr/include/imgui/imgui.h libimgui-dev
need /usr/include/png.h libpng-dev
need /usr/include/turbojpeg.h libturbojpeg0-dev
need /usr/include/webp/mux.h libwebp-dev
need /usr/include/gif_lib.h libgif-dev
need /usr/include/stb/stb_image.h libstb-dev
need /usr/lib/x86_64-linux-gnu/libEGL.so.1 libegl1
need /usr/lib/x86_64-linux-gnu/dri/swrast_dri.so libgl1-mesa-dri
wants() { [[ " $* " = *" $what "* ]]; } # wants KIND...: whether one of these is asked for
if wants cross; then
    need /usr/src/googletest/CMakeLists.txt googletest
    need /usr/include/gtest/gtest.h libgtest-dev
    need wine wine
    need /usr/lib/wine/wine64 wine64
    need x86_64-w64-mingw32-g++-posix g++-mingw-w64-x86-64-posix
fi
if wants cross static web gate all; then
    need dpkg-source dpkg-dev
fi
if wants static all; then
    need unshare util-linux
    need file file
fi
if wants web gate all; then
    need emcc emscripten
    need wasm-opt binaryen
    need node nodejs
    need npm npm
fi
if wants test gate all; then
    python3 -c 'import jsonschema' 2>/dev/null || missing+=(python3-jsonschema)
    for module in jsonschema numpy pytest; do # of the system's Python, for which the Python package is built
        /usr/bin/python3 -c "import $module" 2>/dev/null || missing+=("python3-$module")
    done
    need /usr/include/pybind11/pybind11.h pybind11-dev
    compgen -G '/usr/include/python3*/Python.h' >/dev/null || missing+=(python3-dev)
    need /usr/include/gtest/gtest.h libgtest-dev
    need ccache ccache
    need git git
fi
if wants gate all; then
    need /usr/include/benchmark/benchmark.h libbenchmark-dev
    need /usr/include/tbb/parallel_for.h libtbb-dev
    need clang++ clang
    compgen -G '/usr/lib/llvm-*/lib/clang/*/lib/linux/libclang_rt.asan-*.a' >/dev/null || missing+=(libclang-rt-dev)
    need clang-format clang-format
    need clang-tidy clang-tidy
fi
if wants web all; then
    need chromium chromium
fi
if wants cross all; then
    need aarch64-linux-gnu-g++ g++-aarch64-linux-gnu
    need qemu-aarch64 qemu-user
fi
if wants all; then
    for module in setuptools wheel pip venv; do
        /usr/bin/python3 -c "import $module" 2>/dev/null || missing+=("python3-$module")
    done
    need patchelf patchelf
    need /usr/include/assimp/Importer.hpp libassimp-dev
    compgen -G '/usr/lib/llvm-*/include/c++/v1/vector' >/dev/null || missing+=(libc++-dev libc++abi-dev)
    need /usr/src/googletest/CMakeLists.txt googletest
    need glslangValidator glslang-tools
    need spirv-cross spirv-cross
    need groff groff-base
    need mandoc mandoc
    need fish fish
    need zsh zsh
    need update-mime-database shared-mime-info
    need gio libglib2.0-bin
    need desktop-file-validate desktop-file-utils
    need Xvfb xvfb
    need xauth xauth
    need /usr/share/doc/mkdocs-material mkdocs-material
    need xdotool xdotool
    need blender blender
    need bazel bazel-bootstrap
    need /usr/lib/wasm32-wasi/libc.a wasi-libc
    need /usr/lib/wasm32-wasi/libc++.a libc++-dev-wasm32
    compgen -G '/usr/lib/llvm-*/lib/clang/*/lib/wasi/libclang_rt.builtins-wasm32.a' >/dev/null || missing+=(libclang-rt-dev-wasm32)
    need wasm-ld lld
fi
install_missing
# Downloads for the WebAssembly build, so that the checks download nothing.
if wants gate; then
    for system in web web-plain; do scripts/cross_dependencies.sh "$system"; done
    [ -e bindings/web/node_modules/playcanvas ] || (cd bindings/web && npm ci --silent --no-audit --no-fund)
fi
if wants all; then
    [ -e bindings/web/test/compilers/node_modules/oldest ] || (cd bindings/web/test/compilers && npm ci --silent --no-audit --no-fund)
fi
