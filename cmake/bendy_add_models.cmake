# bendy_add_models(TARGET FILES FILE... [OUTPUT_DIRECTORY DIR] [OPTIONS OPTION...])
#
# A target that is built with all others and converts each model (.gltf, .glb, .vrm, ...) to DIR/NAME.bendy by
# `bendy convert OPTION...`. A model is converted again when a file that it was read from has changed, its buffers, images
# and rig file included, or the program or the options have. Buffers and images are read from the folder of the model and below
# it; `OPTIONS --root DIR` allows those in DIR too.
#
# Relative paths, those of `--rig` and `--root` too, start from the current source directory, DIR from the current binary directory, which it
# also is if not given. A model below the current source directory keeps its folder there: models/fox.glb becomes
# DIR/models/fox.bendy; any other has just its name. The target's property BENDY_MODELS lists the outputs, for install()
# and the like.
function(bendy_add_models target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "OUTPUT_DIRECTORY" "FILES;OPTIONS")
  if(arg_UNPARSED_ARGUMENTS OR NOT arg_FILES)
    message(FATAL_ERROR "bendy_add_models(TARGET FILES FILE... [OUTPUT_DIRECTORY DIR] [OPTIONS OPTION...]): "
                        "there are no FILES, or words that it does not know: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT TARGET bendy::program)
    message(FATAL_ERROR "bendy_add_models needs the program bendy, which this package was installed without")
  endif()
  if(NOT arg_OUTPUT_DIRECTORY)
    set(arg_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
  endif()
  cmake_path(ABSOLUTE_PATH arg_OUTPUT_DIRECTORY BASE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR} NORMALIZE)
  foreach(option IN ITEMS --rig --root)
    list(FIND arg_OPTIONS ${option} at)
    if(NOT at EQUAL -1)
      math(EXPR at "${at} + 1")
      list(GET arg_OPTIONS ${at} path)
      list(REMOVE_AT arg_OPTIONS ${at})
      cmake_path(ABSOLUTE_PATH path BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
      list(INSERT arg_OPTIONS ${at} "${path}")
    endif()
  endforeach()

  set(outputs "")
  foreach(model IN LISTS arg_FILES)
    cmake_path(ABSOLUTE_PATH model BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
    cmake_path(IS_PREFIX CMAKE_CURRENT_SOURCE_DIR "${model}" is_below)
    cmake_path(GET model FILENAME place)
    if(is_below)
      cmake_path(RELATIVE_PATH model BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE place)
    endif()
    cmake_path(REPLACE_EXTENSION place LAST_ONLY bendy)
    set(output "${arg_OUTPUT_DIRECTORY}/${place}")
    string(TOLOWER "${output}" key)  # some systems ignore the case of names
    get_property(earlier GLOBAL PROPERTY "bendy_model_of:${key}")
    if(earlier)
      message(FATAL_ERROR "bendy_add_models(${target}): both ${earlier} and ${model} would become ${output}")
    elseif(output STREQUAL model)
      message(FATAL_ERROR "bendy_add_models(${target}): ${output} would replace itself: give another OUTPUT_DIRECTORY")
    endif()
    set_property(GLOBAL PROPERTY "bendy_model_of:${key}" "${model}")
    list(APPEND outputs "${output}")
    set(depfile "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${target}.dir/${place}.d")
    cmake_path(GET output PARENT_PATH output_folder)
    cmake_path(GET depfile PARENT_PATH depfile_folder)
    add_custom_command(OUTPUT "${output}"
      COMMAND ${CMAKE_COMMAND} -E make_directory "${output_folder}" "${depfile_folder}"
      COMMAND bendy::program convert "${model}" -o "${output}" --depfile "${depfile}" --quiet ${arg_OPTIONS}
      DEPENDS "${model}" bendy::program
      DEPFILE "${depfile}"
      COMMENT "Converting ${place}"
      VERBATIM)
  endforeach()
  add_custom_target(${target} ALL DEPENDS ${outputs})
  set_property(TARGET ${target} PROPERTY BENDY_MODELS ${outputs})
endfunction()
