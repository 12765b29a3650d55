# Lets SOURCE_DIR convert models in its build with the program that is installed in PREFIX: with Ninja, and with Makefiles.
cmake_policy(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# A triangle, its corners in a file beside it: letters, which are numbers too.
function(write_model name uri corners)
  file(WRITE ${project}/${name}.bin "${corners}")
  file(WRITE ${project}/${name}.gltf "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{\"nodes\": [0]}],
    \"nodes\": [{\"name\": \"root\", \"mesh\": 0}], \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}],
    \"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}],
    \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"buffers\": [{\"byteLength\": 36, \"uri\": \"${uri}\"}]}")
endfunction()

# Builds, and holds which models were converted against those that should be.
function(expect_converted)
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${work}/build OUTPUT_VARIABLE said ERROR_VARIABLE said RESULT_VARIABLE failed)
  string(REGEX MATCHALL "Converting [^\n]*bendy" converted "${said}")
  list(TRANSFORM converted REPLACE "Converting " "")
  list(SORT converted)
  if(failed OR NOT "${converted}" STREQUAL "${ARGN}")
    message(FATAL_ERROR "${generator}: \"${converted}\" converted, not \"${ARGN}\":\n${said}")
  endif()
endfunction()

function(check generator)
  set(work "${WORK_DIR}/${generator}")
  set(project "${work}/source")
  file(COPY ${SOURCE_DIR}/CMakeLists.txt DESTINATION ${project})
  write_model(a a.bin AAAABBBBCCCCDDDDEEEEFFFFGGGGHHHHIIII)
  write_model("deeper/b b" b%20b.bin AAAABBBBCCCCDDDDEEEEFFFFGGGGHHHHIIII)
  file(WRITE ${project}/rig.json "{\"bendy_rig\": 1}")
  run(${CMAKE_COMMAND} -S ${project} -B ${work}/build -G ${generator} -DCMAKE_CXX_COMPILER=${CXX}
    -DCMAKE_PREFIX_PATH=${PREFIX})
  expect_converted(a.bendy "deeper/b b.bendy")
  expect_converted()
  file(WRITE "${project}/deeper/b b.bin" IIIIHHHHGGGGFFFFEEEEDDDDCCCCBBBBAAAA)
  expect_converted("deeper/b b.bendy")
  file(TOUCH ${project}/a.bin)
  expect_converted(a.bendy)
  file(TOUCH ${project}/rig.json)
  expect_converted(a.bendy "deeper/b b.bendy")
  file(REMOVE ${work}/build/out/a.bendy)
  expect_converted(a.bendy)
  expect_converted()
  file(TOUCH ${PREFIX}/bin/bendy)
  expect_converted(a.bendy "deeper/b b.bendy")
  run(${PREFIX}/bin/bendy validate ${work}/build/out/a.bendy "${work}/build/out/deeper/b b.bendy")
endfunction()

# A project that would write one file twice is refused before anything is built.
function(expect_refused words)
  file(WRITE ${WORK_DIR}/refused/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(models LANGUAGES CXX)\nfind_package(bendy REQUIRED)\n${ARGN}\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK_DIR}/refused -B ${WORK_DIR}/refused/build -G Ninja -DCMAKE_CXX_COMPILER=${CXX}
    -DCMAKE_PREFIX_PATH=${PREFIX} ERROR_VARIABLE said OUTPUT_QUIET RESULT_VARIABLE failed)
  string(REGEX REPLACE "[ \n]+" " " said "${said}")
  if(NOT failed OR NOT said MATCHES "${words}")
    message(FATAL_ERROR "expected \"${words}\", found ${failed}: ${said}")
  endif()
endfunction()

include(${CMAKE_CURRENT_LIST_DIR}/empty_folder.cmake)
empty_folder(${WORK_DIR})
expect_refused("both [^ ]*/dog.glb and [^ ]*/dog.vrm would become" "bendy_add_models(one FILES dog.glb dog.vrm)")
expect_refused("both [^ ]*/dog.glb and [^ ]*/DOG.glb would become" "bendy_add_models(one FILES dog.glb)\nbendy_add_models(two FILES DOG.glb)")
expect_refused("dog.bendy would replace itself" "bendy_add_models(one FILES dog.bendy OUTPUT_DIRECTORY \${CMAKE_CURRENT_SOURCE_DIR})")
check(Ninja)
check("Unix Makefiles")
