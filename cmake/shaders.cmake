# GLSL -> SPIR-V -> an array of words in a header, at build time. Nothing is compiled from GLSL at run time.
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)

# q3rt_shaders(TARGET lib SOURCES entry...)
# An entry is "path", "path|name" or "path|name|MACRO,MACRO=value": path below shaders/ (or the current folder), name of
# the array (default: the path with _ for / and .), macros of a variant. vk/surface.vert becomes
#   #include "spirv/vk_surface_vert.hpp"    ->    q3rt::shaders::vk_surface_vert (const uint32_t[])
# #include is resolved in shaders/ and beside the file. Only changed shaders are compiled again (depfile).
function(q3rt_shaders)
  cmake_parse_arguments(ARG "" "TARGET" "SOURCES" ${ARGN})
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${ARG_TARGET}_shaders)
  file(MAKE_DIRECTORY ${folder}/spirv)
  set(headers)
  foreach(entry ${ARG_SOURCES})
    string(REPLACE "|" ";" parts "${entry}")
    list(GET parts 0 path)
    list(LENGTH parts count)
    string(REGEX REPLACE "[/.]" "_" name ${path})
    if(count GREATER 1)
      list(GET parts 1 name)
    endif()
    set(defines)
    if(count GREATER 2)
      list(GET parts 2 macros)
      string(REPLACE "," ";" macros "${macros}")
      foreach(macro ${macros})
        list(APPEND defines "-D${macro}")
      endforeach()
    endif()
    if(EXISTS ${CMAKE_SOURCE_DIR}/shaders/${path})
      set(source ${CMAKE_SOURCE_DIR}/shaders/${path})
    else()
      set(source ${CMAKE_CURRENT_SOURCE_DIR}/${path})
    endif()
    # The validator writes the array alone; the header around it is written now, at configure time.
    set(array ${folder}/spirv/${name}.array.h)
    file(CONFIGURE OUTPUT ${folder}/spirv/${name}.hpp CONTENT
"#pragma once
#include <cstdint>
namespace q3rt::shaders {
#include \"${name}.array.h\"
}
")
    add_custom_command(
      OUTPUT ${array}
      COMMAND ${GLSLANG_VALIDATOR} --quiet --target-env vulkan1.2 -I${CMAKE_SOURCE_DIR}/shaders ${defines}
              --depfile ${array}.d --vn ${name} -o ${array} ${source}
      DEPENDS ${source}
      DEPFILE ${array}.d
      COMMENT "Shader ${name}"
      VERBATIM)
    list(APPEND headers ${array})
  endforeach()
  set_property(TARGET ${ARG_TARGET} APPEND PROPERTY Q3RT_SHADER_ARRAYS ${headers})
  target_sources(${ARG_TARGET} PRIVATE ${headers})
  target_include_directories(${ARG_TARGET} PUBLIC ${folder})
endfunction()

# q3rt_hash_shaders(TARGET t NAME n MATCH regex): target n makes generated/n.hpp with kShaderHash, which changes with
# each of t's shaders whose name matches. Whoever includes it depends on n.
function(q3rt_hash_shaders)
  cmake_parse_arguments(ARG "" "TARGET;NAME;MATCH" "" ${ARGN})
  get_target_property(arrays ${ARG_TARGET} Q3RT_SHADER_ARRAYS)
  list(FILTER arrays INCLUDE REGEX "${ARG_MATCH}")
  set(header ${CMAKE_BINARY_DIR}/generated/${ARG_NAME}.hpp)
  add_custom_command(
    OUTPUT ${header}
    COMMAND ${CMAKE_COMMAND} "-DFILES=${arrays}" -DHEADER=${header} -P ${CMAKE_SOURCE_DIR}/cmake/hash_files.cmake
    DEPENDS ${arrays} ${CMAKE_SOURCE_DIR}/cmake/hash_files.cmake
    COMMENT "Hash ${ARG_NAME}"
    VERBATIM)
  add_custom_target(${ARG_NAME} DEPENDS ${header})
endfunction()
