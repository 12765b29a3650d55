# cmake --install, in three components: the program; libraries, which linked programs need at run time; development, the headers,
# the CMake package and the pkg-config files.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/bendy)
install(TARGETS bendy_format bendy_runtime EXPORT bendy_targets
  ARCHIVE COMPONENT development
  LIBRARY COMPONENT libraries NAMELINK_COMPONENT development
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
  FILE_SET tables DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT bendy_targets NAMESPACE bendy:: FILE bendy-targets.cmake DESTINATION ${package_dir} COMPONENT development)
if(BENDY_C)
  install(EXPORT bendy_c_targets NAMESPACE bendy:: FILE bendy-c-targets.cmake DESTINATION ${package_dir} COMPONENT development)
endif()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/bendy-config.cmake.in ${PROJECT_BINARY_DIR}/bendy-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/bendy-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/bendy-config.cmake ${PROJECT_BINARY_DIR}/bendy-config-version.cmake
  ${CMAKE_CURRENT_LIST_DIR}/bendy_add_models.cmake
  DESTINATION ${package_dir} COMPONENT development)

# pkg-config: paths relative to the file itself, so that the tree may be moved. Static libraries need their dependencies linked.
set(pkgconfig_dir ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH prefix_from_pkgconfig ${pkgconfig_dir} ${CMAKE_INSTALL_PREFIX})
file(RELATIVE_PATH libdir_from_prefix ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_LIBDIR})
file(RELATIVE_PATH includedir_from_prefix ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
set(own_requires "")  # of bendy-format, beside what its headers include
set(own_libraries "")
if(BENDY_ZSTD)
  set(own_requires libzstd)
endif()
if(BENDY_MESHOPTIMIZER)
  set(own_libraries -lmeshoptimizer)  # which has no pkg-config file
endif()
if(BUILD_SHARED_LIBS)
  set(requires "")
  set(requires_private ${own_requires})
  set(libraries "")
  set(libraries_private ${own_libraries})
else()
  set(requires ${own_requires})
  set(requires_private "")
  set(libraries ${own_libraries})
  set(libraries_private "")
endif()
set(rpath "")  # of programs that are linked by them, so that they run wherever the prefix is; not in packages of a system
if(BUILD_SHARED_LIBS AND CMAKE_EXECUTABLE_FORMAT STREQUAL ELF AND NOT CMAKE_SKIP_INSTALL_RPATH)
  set(rpath " -Wl,-rpath,\${libdir}")
endif()
foreach(library format runtime)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/bendy-${library}.pc.in ${PROJECT_BINARY_DIR}/bendy-${library}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/bendy-${library}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endforeach()

if(BENDY_TOOLS)
  if(BUILD_SHARED_LIBS)
    file(RELATIVE_PATH libdir_from_bindir ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
    set_target_properties(bendy PROPERTIES INSTALL_RPATH $ORIGIN/${libdir_from_bindir})
  endif()
  install(TARGETS bendy EXPORT bendy_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  install(EXPORT bendy_program NAMESPACE bendy:: FILE bendy-program.cmake DESTINATION ${package_dir} COMPONENT program)
  include(${CMAKE_CURRENT_LIST_DIR}/bendy_reference.cmake)
  # Files by which a desktop and file(1) recognise the format.
  set(packaging ${PROJECT_SOURCE_DIR}/packaging)
  install(FILES ${packaging}/bendy.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT program)
  install(FILES ${packaging}/bendy.magic DESTINATION ${CMAKE_INSTALL_DATADIR}/bendy COMPONENT program)
  if(BENDY_VIEWER)
    install(FILES ${packaging}/bendy-view.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT program)
  endif()
endif()
