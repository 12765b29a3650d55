# WebAssembly with SIMD by Debian's emscripten: scripts/web.sh
set(BENDY_WEB_FLAGS "-fwasm-exceptions -msimd128")
set(BENDY_WEB_SIMD ON)
set(BENDY_WEB_LIBRARIES ${CMAKE_CURRENT_LIST_DIR}/../build/cross/web/libraries/usr)
include(${CMAKE_CURRENT_LIST_DIR}/emscripten.cmake)
