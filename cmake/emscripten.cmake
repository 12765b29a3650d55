# What web.cmake, web-plain.cmake and web-tools.cmake share.
# emcc forbids most inlining if -Os or -Oz is among the options, even if -O2 follows. Allowed, it makes the runtime two to seven times as
# fast, and 2 % larger. Copying and filling memory by an instruction is older than the exceptions that an engine needs.
string(APPEND BENDY_WEB_FLAGS " -finline-functions -mbulk-memory")
set(CMAKE_C_FLAGS_INIT "${BENDY_WEB_FLAGS}")
set(CMAKE_CXX_FLAGS_INIT "${BENDY_WEB_FLAGS} -fno-rtti")
set(CMAKE_FIND_ROOT_PATH ${BENDY_WEB_LIBRARIES})
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # linking takes seconds
