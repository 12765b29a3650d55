# Installs BUILD_DIR, and moves what was installed to PREFIX.
include(${CMAKE_CURRENT_LIST_DIR}/empty_folder.cmake)
empty_folder(${PREFIX})
empty_folder(${PREFIX}_first)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${PREFIX}_first COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${PREFIX}_first ${PREFIX})
