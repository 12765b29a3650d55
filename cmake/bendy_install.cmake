# cmake --install: the embeddable libraries with their headers and CMake package, and the program.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/bendy)
install(TARGETS bendy_format bendy_runtime EXPORT bendy_targets
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILE_SET tables DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT bendy_targets NAMESPACE bendy:: FILE bendy-targets.cmake DESTINATION ${package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/bendy-config.cmake.in ${PROJECT_BINARY_DIR}/bendy-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/bendy-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/bendy-config.cmake ${PROJECT_BINARY_DIR}/bendy-config-version.cmake
  ${CMAKE_CURRENT_LIST_DIR}/bendy_add_models.cmake
  DESTINATION ${package_dir})
if(BENDY_TOOLS)
  install(TARGETS bendy EXPORT bendy_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(EXPORT bendy_program NAMESPACE bendy:: FILE bendy-program.cmake DESTINATION ${package_dir})
endif()
