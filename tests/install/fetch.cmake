# Builds a game with the lines that docs/embedding.md has for FetchContent, the sources taken from BENDY_SOURCE_DIR, and runs it on
# COMPRESSED, which it can read.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

include(${CMAKE_CURRENT_LIST_DIR}/empty_folder.cmake)
empty_folder(${WORK_DIR})
file(READ ${BENDY_SOURCE_DIR}/docs/embedding.md page)
if(NOT page MATCHES "```cmake\n(include\\(FetchContent\\)[^`]*)```")
  message(FATAL_ERROR "docs/embedding.md has no block that begins with include(FetchContent)")
endif()
file(WRITE ${WORK_DIR}/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(game LANGUAGES CXX)\nadd_executable(game ${MAIN})\n${CMAKE_MATCH_1}")
run(${CMAKE_COMMAND} -S ${WORK_DIR} -B ${WORK_DIR}/build -G Ninja -DCMAKE_CXX_COMPILER=${CXX} -DFETCHCONTENT_SOURCE_DIR_BENDY=${BENDY_SOURCE_DIR})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build -j2 --target game)
execute_process(COMMAND ${WORK_DIR}/build/game ${COMPRESSED} OUTPUT_VARIABLE said RESULT_VARIABLE failed)
if(failed OR NOT said MATCHES "^[0-9]+ joints, [0-9]+ vertices")
  message(FATAL_ERROR "expected a number of joints and vertices, found ${failed} and \"${said}\"")
endif()
