# WebAssembly without SIMD by Debian's emscripten, for the tools: scripts/web.sh
set(BENDY_WEB_FLAGS "-fwasm-exceptions")
set(BENDY_WEB_LIBRARIES ${CMAKE_CURRENT_LIST_DIR}/../build/cross/web-tools/libraries/usr)
include(${CMAKE_CURRENT_LIST_DIR}/emscripten.cmake)
