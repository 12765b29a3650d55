# Uses ccache if it is installed: its cache serves every clone of the project that compiles with the same flags, because paths are
# passed as relative ones. It uses the compiler's dependency output as the key (CCACHE_DEPEND), so that a miss does not run the
# preprocessor twice. The build is the same without it.
if(NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER AND NOT DEFINED ENV{CMAKE_CXX_COMPILER_LAUNCHER} AND NOT MSVC)
  find_program(BENDY_CCACHE ccache)
  if(BENDY_CCACHE)
    set(launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 CCACHE_DEPEND=1
      CCACHE_SLOPPINESS=time_macros,include_file_mtime,include_file_ctime)
    if(EMSCRIPTEN)  # a script, which starts the compiler behind the cache itself
      list(APPEND launcher EM_COMPILER_WRAPPER=${BENDY_CCACHE})
    else()
      list(APPEND launcher ${BENDY_CCACHE})
    endif()
    set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
    set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
  endif()
endif()
