# The fuzz targets with the libraries that decode, instrumented as well: scripts/fuzz.sh
set(CMAKE_C_COMPILER clang)
set(CMAKE_CXX_COMPILER clang++)
set(CMAKE_C_FLAGS_INIT "-O2 -gline-tables-only -fsanitize=address,fuzzer-no-link -fno-omit-frame-pointer")
set(CMAKE_CXX_FLAGS_INIT "${CMAKE_C_FLAGS_INIT}")
set(CMAKE_FIND_ROOT_PATH ${CMAKE_CURRENT_LIST_DIR}/../build/cross/fuzzers/libraries/usr)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
