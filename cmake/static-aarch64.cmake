# The program for 64-bit ARM as one file without shared libraries, for releases: scripts/static.sh aarch64
include(${CMAKE_CURRENT_LIST_DIR}/aarch64.cmake)
set(CMAKE_FIND_ROOT_PATH ${CMAKE_CURRENT_LIST_DIR}/../build/cross/static-aarch64/libraries/usr)
set(CMAKE_FIND_LIBRARY_SUFFIXES .a)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
