# Builds SOURCE_DIR, which has the project as a part, without the libraries and programs that only other parts need; runs it on
# MODEL, and on COMPRESSED, which such a library cannot read. Not optimised: quicker to build.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(expect code words)
  execute_process(COMMAND ${WORK_DIR}/build/game ${ARGN} OUTPUT_VARIABLE said RESULT_VARIABLE failed)
  if(NOT failed EQUAL code OR NOT said MATCHES "${words}")
    message(FATAL_ERROR "expected ${code} and \"${words}\", found ${failed} and \"${said}\"")
  endif()
endfunction()

include(${CMAKE_CURRENT_LIST_DIR}/empty_folder.cmake)
empty_folder(${WORK_DIR})
set(without "")
foreach(package IN ITEMS zstd meshoptimizer draco glfw3 imgui CLI11 nlohmann_json RapidJSON TBB GTest benchmark PNG ZLIB OpenGL Python3 PkgConfig)
  list(APPEND without -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/build -G Ninja -DCMAKE_CXX_COMPILER=${CXX} -DBENDY_SOURCE_DIR=${BENDY_SOURCE_DIR} ${without})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build -j2)
expect(0 "^1 joints" ${MODEL})
expect(1 "^UNSUPPORTED_CODEC: .*\\(BENDY_ZSTD, BENDY_MESHOPTIMIZER\\)" ${COMPRESSED})  # the options that it lacks

run(${CMAKE_COMMAND} --install ${WORK_DIR}/build --prefix ${WORK_DIR}/prefix)
file(GLOB_RECURSE installed RELATIVE ${WORK_DIR}/prefix ${WORK_DIR}/prefix/*)
if(NOT installed STREQUAL "bin/game")
  message(FATAL_ERROR "expected nothing but the game to be installed, found ${installed}")
endif()
