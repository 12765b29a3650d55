# Settings that all targets of this project share.

# The suffix of sources that exist once per system.
set(BENDY_SYSTEM posix)
if(WIN32)
  set(BENDY_SYSTEM windows)
endif()

# A WebAssembly module is loaded at address 0, so position-independent code would only be larger.
if(EMSCRIPTEN)
  set(CMAKE_CXX_COMPILE_OPTIONS_PIC "")
endif()

# bendy_library(NAME [EMBEDDABLE] SOURCES ... [HEADERS ...] [TABLES ...]): a library bendy_NAME with the alias bendy::NAME. Its
# public headers, which must compile by themselves, and its .def tables, which need not, are under include/. An EMBEDDABLE library
# is installed, and shared if BUILD_SHARED_LIBS is set; the others are parts of the program.
function(bendy_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "EMBEDDABLE" "" "SOURCES;HEADERS;TABLES")
  if(arg_EMBEDDABLE)
    add_library(bendy_${name} ${arg_SOURCES})
    bendy_export_public_headers(bendy_${name})
  else()
    add_library(bendy_${name} STATIC ${arg_SOURCES})
  endif()
  add_library(bendy::${name} ALIAS bendy_${name})
  set_target_properties(bendy_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
    VERIFY_INTERFACE_HEADER_SETS ON INTERFACE_HEADER_SETS_TO_VERIFY HEADERS)
  target_sources(bendy_${name}
    PUBLIC FILE_SET HEADERS BASE_DIRS include FILES ${arg_HEADERS}
    PUBLIC FILE_SET tables TYPE HEADERS BASE_DIRS include FILES ${arg_TABLES})
  bendy_options(bendy_${name})
  if(BENDY_FUZZ)
    # Coverage without traced comparisons, which would double the time of the other tests.
    target_compile_options(bendy_${name} PRIVATE -fsanitize-coverage=inline-8bit-counters,pc-table)
  endif()
endfunction()

# A shared library exports only namespace blocks marked BENDY_PUBLIC: docs/decisions/0024.
function(bendy_export_public_headers target)
  string(REPLACE _ - file_name ${target})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${file_name}
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    DEFINE_SYMBOL "" INSTALL_RPATH $ORIGIN)
  if(BUILD_SHARED_LIBS AND CMAKE_EXECUTABLE_FORMAT STREQUAL ELF)
    # Otherwise instances of the C++ library's templates would be exported too.
    set(exports ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/bendy_exports.map)
    target_link_options(${target} PRIVATE LINKER:--version-script=${exports})
    set_target_properties(${target} PROPERTIES LINK_DEPENDS ${exports})
  endif()
endfunction()

function(bendy_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  bendy_private_options(${target})
endfunction()

# Private options: users of the target do not inherit them.
function(bendy_private_options target)
  target_compile_features(${target} PRIVATE cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  if(BENDY_STANDARD_CPP)
    target_compile_definitions(${target} PRIVATE BENDY_STANDARD_CPP)
  endif()
  if(MSVC)
    target_compile_options(${target} PRIVATE /W4 /utf-8 /permissive- /EHsc /fp:precise)
    target_compile_definitions(${target} PRIVATE NOMINMAX _CRT_SECURE_NO_WARNINGS)
    if(BENDY_WARNINGS_AS_ERRORS)
      target_compile_options(${target} PRIVATE /WX)
    endif()
  else()
    bendy_gnu_options(${target})
  endif()
  if(BENDY_UNITY)
    bendy_batches(${target})
  endif()
endfunction()

# For GCC, clang and compilers that accept their options.
function(bendy_gnu_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wnon-virtual-dtor)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # False alarms inside std::string's own operator+ and replace(): GCC bug 105651, fixed in 13.
    target_compile_options(${target} PRIVATE -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds)
  endif()
  if(CMAKE_SIZEOF_VOID_P EQUAL 4 AND CMAKE_CXX_COMPILER_ID MATCHES Clang)
    # Sizes in a file have 64 bits. They are checked against the bytes that there are, which 32 bits can count. So are indices,
    # which are added to iterators.
    target_compile_options(${target} PRIVATE -Wno-shorten-64-to-32 -Wno-sign-conversion)
  endif()
  # The same bytes from every compiler: no fused multiply-add that the source does not ask for.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  if(BENDY_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# Compiles sources of one folder sixteen at a time, and those of folders with six at most together: docs/decisions/0037. A file that
# is added changes the batches of its folder, or of the small ones, only.
# Not CMake's own batches: those name sources by absolute paths, so that a compiler cache knows them in one clone only. Written when
# the folder's CMakeLists.txt has ended, and with it the list of sources and their properties. A source with
# COMPILE_OPTIONS of its own stays out, and one with BENDY_ALONE, such as one that other targets compile alone. BENDY_ONE_BY_ONE
# keeps out all of a target's.
function(bendy_batches target)
  cmake_language(EVAL CODE "cmake_language(DEFER CALL bendy_write_batches ${target})")
endfunction()

function(bendy_write_batches target)
  get_target_property(is_one_by_one ${target} BENDY_ONE_BY_ONE)
  if(is_one_by_one)
    return()
  endif()
  set(folder_of_batches ${CMAKE_CURRENT_BINARY_DIR}/batches/${target})
  get_target_property(sources ${target} SOURCES)
  set(batches)
  set(batched)
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE file)
    get_source_file_property(is_alone ${source} BENDY_ALONE)
    get_source_file_property(flags ${source} COMPILE_OPTIONS)
    if(NOT source MATCHES "\\.cpp$" OR is_alone OR flags OR NOT EXISTS ${file})
      continue()
    endif()
    # A source that defines macros is compiled alone: they may change headers, as TINYGLTF_IMPLEMENTATION does.
    file(STRINGS ${file} macros REGEX "^#define " LIMIT_COUNT 1)
    if(macros)
      continue()
    endif()
    cmake_path(GET file PARENT_PATH folder)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${folder})
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    list(APPEND sources_of_${folder} ${source})
    list(APPEND batched ${source})
    set(folder_of_${source} ${folder})
  endforeach()
  foreach(source IN LISTS batched)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE file)
    get_source_file_property(options ${source} BENDY_BATCH_OPTIONS)  # the same for a folder
    if(NOT options)
      set(options "")
    endif()
    set(name ${folder_of_${source}})
    list(LENGTH sources_of_${name} count)
    if(count LESS_EQUAL 6)
      string(MAKE_C_IDENTIFIER "small_folders${options}" name)
    endif()
    if(NOT DEFINED count_${name})
      set(count_${name} 0)
    endif()
    math(EXPR batch "${count_${name}} / 16 + 1")
    math(EXPR count_${name} "${count_${name}} + 1")
    file(RELATIVE_PATH from_batch ${folder_of_batches} ${file})
    list(APPEND batches ${name}_${batch})
    list(APPEND sources_${name}_${batch} ${source})
    set(options_${name}_${batch} ${options})
    string(APPEND lines_${name}_${batch} "#include \"${from_batch}\"\n")
  endforeach()
  list(REMOVE_DUPLICATES batches)
  foreach(batch IN LISTS batches)
    list(LENGTH sources_${batch} count)
    if(count EQUAL 1)
      continue()
    endif()
    set_source_files_properties(${sources_${batch}} PROPERTIES HEADER_FILE_ONLY ON)
    file(CONFIGURE OUTPUT ${folder_of_batches}/${batch}.cpp CONTENT "${lines_${batch}}" @ONLY)
    target_sources(${target} PRIVATE ${folder_of_batches}/${batch}.cpp)
    if(options_${batch})
      set_source_files_properties(${folder_of_batches}/${batch}.cpp PROPERTIES COMPILE_OPTIONS "${options_${batch}}")
    endif()
  endforeach()
endfunction()

# bendy_fast_on_the_web(SOURCE...): for speed, where all else is optimised for size.
function(bendy_fast_on_the_web)
  if(EMSCRIPTEN)
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS -O2)
  endif()
endfunction()

# bendy_optimise(TARGET LEVEL [SOURCE...]): -O<LEVEL> in place of the -O3 of optimised builds, for code that compiles faster so and
# runs as fast as anybody can tell; for the batches of these sources, or for all of the target's.
function(bendy_optimise target level)
  if(EMSCRIPTEN AND level EQUAL 1)
    set(level z)  # what need not be fast need not be loaded either
  endif()
  if(MSVC)
    return()
  elseif(CMAKE_CXX_FLAGS MATCHES "-fsanitize=" AND level EQUAL 1)
    set(option -O0)  # templates with sanitizers compile slowest of all
  else()
    set(option $<$<CONFIG:Release>:-O${level}>)
  endif()
  if(ARGN)
    set_source_files_properties(${ARGN} PROPERTIES BENDY_BATCH_OPTIONS ${option})
  else()
    target_compile_options(${target} PRIVATE ${option})
  endif()
endfunction()
