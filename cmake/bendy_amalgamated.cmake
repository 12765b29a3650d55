# bendy_amalgamated: the runtime as two files, bendy_runtime.h and bendy_runtime.cpp, in the build's folder amalgamated/.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  set(amalgamated ${PROJECT_BINARY_DIR}/amalgamated)
  file(GLOB_RECURSE amalgamated_from CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/format/* ${PROJECT_SOURCE_DIR}/runtime/*)
  add_custom_command(OUTPUT ${amalgamated}/bendy_runtime.h ${amalgamated}/bendy_runtime.cpp
    COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/scripts/amalgamate.py ${amalgamated}
    DEPENDS ${PROJECT_SOURCE_DIR}/scripts/amalgamate.py ${amalgamated_from} VERBATIM)
  add_custom_target(bendy_amalgamated DEPENDS ${amalgamated}/bendy_runtime.h ${amalgamated}/bendy_runtime.cpp)
endif()
