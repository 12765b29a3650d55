# What web.cmake and web-plain.cmake share.
set(CMAKE_C_FLAGS_INIT "${BENDY_WEB_FLAGS}")
set(CMAKE_CXX_FLAGS_INIT "${BENDY_WEB_FLAGS} -fno-rtti")
set(CMAKE_FIND_ROOT_PATH ${BENDY_WEB_LIBRARIES})
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # linking takes seconds
