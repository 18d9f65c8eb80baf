# q3rt_module(NAME LINK libraries... [SOURCES files...]): a renderer module for the engine, from module.cpp of the
# current folder. It comes under two names, because upstream dropped the architecture suffix after 2025:
# renderer_NAME_x86_64.so and renderer_NAME.so (one file).
function(q3rt_module name)
  cmake_parse_arguments(ARG "" "" "LINK;SOURCES" ${ARGN})
  if(NOT ARG_SOURCES)
    set(ARG_SOURCES module.cpp)
  endif()
  set(target module_${name})
  set(map ${CMAKE_SOURCE_DIR}/cmake/module.map)
  add_library(${target} MODULE ${ARG_SOURCES})
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME renderer_${name}_x86_64 LINK_DEPENDS ${map})
  target_link_libraries(${target} PRIVATE ${ARG_LINK})
  # Nothing but GetRefAPI is exported, and no symbol is unique in the process: the engine must really unmap the library.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
  target_link_options(${target} PRIVATE -Wl,--version-script=${map} -Wl,--gc-sections)
  if(NOT Q3RT_SANITIZE) # the sanitizers' symbols come from the program that loads the module
    target_link_options(${target} PRIVATE -Wl,-z,defs)
  endif()
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -E create_hardlink $<TARGET_FILE:${target}> ${CMAKE_BINARY_DIR}/renderer_${name}.so)
endfunction()
