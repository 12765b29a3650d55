# cpack -G DEB: Debian packages of the components, see docs/decisions/0024 and packaging/README.md.
set(BENDY_MAINTAINER "The Bendy contributors <bendy@localhost>" CACHE STRING "Who answers for the packages: NAME <ADDRESS>")
mark_as_advanced(BENDY_MAINTAINER)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has one of its own
set(CPACK_PACKAGE_CONTACT ${BENDY_MAINTAINER})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_BINARY_DIR}/finish_debian_folders.cmake)
configure_file(${PROJECT_SOURCE_DIR}/packaging/finish_debian_folders.cmake.in ${CPACK_PRE_BUILD_SCRIPTS} @ONLY)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_COMPONENTS_ALL development)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libbendy-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libglm-dev, libzstd-dev, libmeshoptimizer-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "library for animated characters in bendy files: development files
Headers and libraries that open bendy files, pose and skin the characters
in them and reach inside their joints' limits, with CMake and pkg-config
files.")

if(BENDY_TOOLS)
  list(APPEND CPACK_COMPONENTS_ALL program)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME bendy)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libegl1, libgl1, libgl1-mesa-dri")
  set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "tools for animated characters in bendy files
Makes bendy files of glTF and back, checks, shows, poses, draws, compares and
changes them. A bendy file holds a character's skeleton, skin, clips,
materials, levels of detail, joint limits and chains for inverse kinematics.")
endif()

if(BENDY_C AND BENDY_C_SHARED)
  list(APPEND CPACK_COMPONENTS_ALL c_library)
  set(CPACK_DEBIAN_C_LIBRARY_PACKAGE_NAME libbendy${PROJECT_VERSION_MAJOR})
  set(CPACK_DEBIAN_C_LIBRARY_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_C_LIBRARY_PACKAGE_GENERATE_SHLIBS ON)
  set(CPACK_COMPONENT_C_LIBRARY_DESCRIPTION "library for animated characters in bendy files, for C
What programs need that pose characters through bendy.h, from C or any language
that binds to it.")
  set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
  list(APPEND CPACK_COMPONENT_DEVELOPMENT_DEPENDS c_library)
endif()

if(BUILD_SHARED_LIBS)
  list(APPEND CPACK_COMPONENTS_ALL libraries)
  set(abi ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  set(CPACK_DEBIAN_LIBRARIES_PACKAGE_NAME libbendy-cpp${abi})
  set(CPACK_DEBIAN_LIBRARIES_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
  file(WRITE ${PROJECT_BINARY_DIR}/debian/triggers "activate-noawait ldconfig\n")
  set(CPACK_DEBIAN_LIBRARIES_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/triggers)
  set(CPACK_DEBIAN_LIBRARIES_DESCRIPTION "library for animated characters in bendy files
What programs need that open bendy files and pose the characters in them.")
  set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
  list(APPEND CPACK_COMPONENT_DEVELOPMENT_DEPENDS libraries)
  set(CPACK_COMPONENT_PROGRAM_DEPENDS libraries)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/format ${PROJECT_BINARY_DIR}/runtime)
endif()

include(CPack)
