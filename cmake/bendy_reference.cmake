# Man pages and completions made from the program's help. The third output, docs/cli.md, is kept in the tree.
find_package(Python3 COMPONENTS Interpreter)
if(NOT Python3_FOUND)
  message(STATUS "Python is missing: no man pages, no completions")
  return()
endif()

set(made ${PROJECT_BINARY_DIR}/reference)
file(GLOB scripts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scripts/reference/*.py)
add_custom_command(OUTPUT ${made}/stamp
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${made}
  COMMAND Python3::Interpreter -B ${PROJECT_SOURCE_DIR}/scripts/make_reference.py --bendy $<TARGET_FILE:bendy>
    --man ${made}/man --completions ${made}/completions
  COMMAND ${CMAKE_COMMAND} -E touch ${made}/stamp
  DEPENDS bendy ${PROJECT_SOURCE_DIR}/scripts/make_reference.py ${scripts}
  COMMENT "Making man pages and completions" VERBATIM)
add_custom_target(bendy_reference ALL DEPENDS ${made}/stamp)

set(BENDY_ZSH_COMPLETIONS ${CMAKE_INSTALL_DATADIR}/zsh/site-functions CACHE STRING "Where zsh looks for completions")
mark_as_advanced(BENDY_ZSH_COMPLETIONS)
install(DIRECTORY ${made}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${made}/completions/bendy DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(FILES ${made}/completions/_bendy DESTINATION ${BENDY_ZSH_COMPLETIONS} COMPONENT program)
install(FILES ${made}/completions/bendy.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
