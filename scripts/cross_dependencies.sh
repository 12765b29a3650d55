#!/usr/bin/env bash
# Fills build/cross/SYSTEM/libraries with the libraries that the project needs there: scripts/cross_dependencies.sh SYSTEM
#   aarch64   Debian's packages for that processor, unpacked
#   windows   zstd, meshoptimizer, draco and googletest, from Debian's source packages, by mingw-w64
#   static    zstd, meshoptimizer and draco, from the same sources, as static libraries for this machine
#   static-aarch64  the same for 64-bit ARM
#   fuzzers   the same, by clang, with what AddressSanitizer and the fuzzer need
#   web       zstd and meshoptimizer, from the same sources, for WebAssembly with SIMD; web-plain: without
#   web-tools zstd, meshoptimizer, draco, zlib and double-conversion, from the same sources, for WebAssembly
# Libraries that are headers only are this machine's. Packages come from the mirror that this machine uses; what apt knows
# of other processors and of sources stays in build/cross/apt.
set -euo pipefail
cd "$(dirname "$0")/.."
system=${1:?usage: scripts/cross_dependencies.sh windows|aarch64|static|static-aarch64|fuzzers|web|web-plain|web-tools}
[ -e "cmake/$system.cmake" ] || { echo "$0: unknown system $system" >&2; exit 2; }
here=$PWD/build/cross
root=$here/$system/libraries
versions=$(cat "$0" cmake/"$system".cmake cmake/emscripten.cmake; dpkg-query -W libzstd-dev libmeshoptimizer-dev libdraco-dev libgtest-dev libglm-dev \
    nlohmann-json3-dev rapidjson-dev libcli11-dev libtinygltf-dev libutfcpp-dev)
[ "$(cat "$root/versions" 2>/dev/null)" != "$versions" ] || exit 0
rm -rf "$root"
mkdir -p "$root"

# apt for other processors and for sources, with a state of its own.
mkdir -p "$here"/apt/{state/lists/partial,cache/archives/partial}
apt=(-qq -o Dir::State="$here/apt/state" -o Dir::State::status=/var/lib/dpkg/status -o Dir::Cache="$here/apt/cache"
    -o Dir::Etc::sourcelist="$here/apt/sources.list" -o Dir::Etc::sourceparts=/dev/null
    -o APT::Architectures::=amd64 -o APT::Architectures::=arm64 -o APT::Sandbox::User=root)
if [ ! -e "$here/apt/sources.list" ]; then
    read -r site release component < <(apt-get indextargets --format '$(SITE) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
        grep -v -e '-security ' -e '-updates ' | head -n 1)
    key='signed-by=/usr/share/keyrings/debian-archive-keyring.gpg'
    printf '%s\n' "deb [arch=arm64 $key] $site $release $component" "deb-src [$key] $site $release $component" >"$here/apt/sources.list"
    apt-get "${apt[@]}" update
fi

copy_headers() {
    for package in libglm-dev nlohmann-json3-dev rapidjson-dev libcli11-dev libutfcpp-dev; do dpkg -L "$package"; done |
        sed -nE 's,^/(usr/(include|share/cmake)/.*),\1,p' | tar -C / --no-recursion -T - -c | tar -C "$root" -x
    cp /usr/include/tiny_gltf.h "$root/usr/include"
}

fetch_aarch64() {
    mkdir -p "$here/aarch64/packages"
    cd "$here/aarch64/packages"
    apt-get "${apt[@]}" download libzstd1:arm64 libzstd-dev:arm64 libmeshoptimizer2d:arm64 libmeshoptimizer-dev:arm64 libdraco7:arm64 \
        libdraco-dev:arm64 libgtest-dev:arm64 libgmock-dev:arm64 zlib1g:arm64 zlib1g-dev:arm64
    for package in *.deb; do dpkg-deb -x "$package" "$root"; done
    # Its targets name the place that they would be installed to.
    sed -i "s,\"/usr/*,\"$root/usr/," "$root"/usr/lib/*/cmake/draco/draco-targets*.cmake
}

build_library() { # build_library NAME SOURCES [CMAKE-OPTION...]: a library into the root
    local build=$here/$system/build_$1 source=$2 launcher=()
    shift 2
    rm -rf "$build" # its cache has the flags of the last time
    if [[ $system != web* ]] && command -v ccache >/dev/null; then
        export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
        launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    fi
    cmake -S "$source" -B "$build" -G Ninja --toolchain "$PWD/cmake/$system.cmake" -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_INSTALL_PREFIX="$root/usr" -DBUILD_SHARED_LIBS=OFF "${launcher[@]}" "$@" >"$build.log" 2>&1 || { cat "$build.log" >&2; exit 1; }
    cmake --build "$build" --target install --parallel "$(nproc)" >>"$build.log" 2>&1 || { tail -n 50 "$build.log" >&2; exit 1; }
}

fetch_sources() { # fetch_sources PACKAGE...: unpacked into $sources
    sources=$here/$system/sources
    mkdir -p "$sources"
    (cd "$sources" && apt-get "${apt[@]}" source "$@")
}

build_leaf_codecs() { # build_leaf_codecs [CMAKE-OPTION...]: the libraries that the runtime needs; the options are zstd's
    build_library zstd "$sources"/libzstd-*/build/cmake -DZSTD_BUILD_PROGRAMS=OFF -DZSTD_BUILD_TESTS=OFF -DZSTD_BUILD_SHARED=OFF \
        -DZSTD_LEGACY_SUPPORT=OFF -DZSTD_MULTITHREAD_SUPPORT=OFF "$@"
    build_library meshoptimizer "$sources"/meshoptimizer-*/
}

build_codecs() {
    fetch_sources libzstd meshoptimizer draco
    build_leaf_codecs
    build_library draco "$sources"/draco-*/
}

fetch_web() {
    fetch_sources libzstd meshoptimizer
    sed -i 's/ -Werror//' "$sources"/meshoptimizer-*/CMakeLists.txt  # its code for SIMD has unused variables
    # One decoder of each kind, as in the library's own builds for the web: less to download.
    build_leaf_codecs -DCMAKE_C_FLAGS_RELEASE="-Os -DNDEBUG -DHUF_FORCE_DECOMPRESS_X1 -DZSTD_FORCE_DECOMPRESS_SEQUENCES_SHORT -DZSTD_NO_INLINE -DZSTD_STRIP_ERROR_STRINGS"
}

fetch_web-tools() {
    fetch_sources libzstd meshoptimizer draco zlib double-conversion
    sed -i 's/ -Werror//' "$sources"/meshoptimizer-*/CMakeLists.txt
    local small=(-DCMAKE_C_FLAGS_RELEASE="-Oz -DNDEBUG" -DCMAKE_CXX_FLAGS_RELEASE="-Oz -DNDEBUG")
    build_library zstd "$sources"/libzstd-*/build/cmake -DZSTD_BUILD_PROGRAMS=OFF -DZSTD_BUILD_TESTS=OFF -DZSTD_BUILD_SHARED=OFF \
        -DZSTD_LEGACY_SUPPORT=OFF -DZSTD_MULTITHREAD_SUPPORT=OFF "${small[@]}"
    for library in meshoptimizer double-conversion; do build_library $library "$sources"/$library-*/ "${small[@]}"; done
    # Draco's CMake files ask for EMSCRIPTEN; programs of draco are linked with acorn, which Debian has there.
    NODE_PATH=/usr/share/nodejs EMSCRIPTEN=/usr/share/emscripten build_library draco "$sources"/draco-*/ -DDRACO_JS_GLUE=OFF "${small[@]}"
    # What inflates; zlib's own CMake files want a shared library.
    mkdir -p "$here/$system/build_zlib"
    (cd "$here/$system/build_zlib" && emcc -Oz -c "$sources"/zlib-*/{adler32,crc32,inffast,inflate,inftrees,zutil}.c && emar rcs "$root/usr/lib/libz.a" ./*.o)
    cp "$sources"/zlib-*/{zlib,zconf}.h "$root/usr/include/"
}

fetch_static() {
    build_codecs
    cp /usr/lib/x86_64-linux-gnu/libz.a "$root/usr/lib/"
}

fetch_static-aarch64() {
    build_codecs
    (cd "$here/static-aarch64" && apt-get "${apt[@]}" download zlib1g-dev:arm64 && dpkg-deb -x zlib1g-dev_*.deb "$root")
}

fetch_fuzzers() {
    build_codecs
}

fetch_windows() {
    build_codecs
    build_library googletest /usr/src/googletest
    (cd "$here/windows/libraries" && apt-get "${apt[@]}" download libz-mingw-w64-dev && dpkg-deb -x libz-mingw-w64-dev_*.deb zlib)
    cp -r "$here"/windows/libraries/zlib/usr/x86_64-w64-mingw32/{include,lib} "$root/usr/"
}

copy_headers
"fetch_${system%-plain}"
echo "$versions" >"$root/versions"
