# carus_module(NAME LINK public... PRIVATE private...): the library carus_NAME from src/carus/NAME/*.cpp.
set(CARUS_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
    -Wno-stringop-overflow)  # GCC 12 is wrong about fmt 9

function(carus_module name)
  cmake_parse_arguments(ARG "" "" "LINK;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/carus/${name}/*.cpp)
  if(sources)
    add_library(carus_${name} STATIC ${sources})
    target_include_directories(carus_${name} PUBLIC ${CMAKE_SOURCE_DIR}/src)
    target_link_libraries(carus_${name} PUBLIC ${ARG_LINK} PRIVATE ${ARG_PRIVATE})
    target_compile_options(carus_${name} PRIVATE ${CARUS_WARNINGS})
    set(CARUS_KEYWORD_${name} PRIVATE PARENT_SCOPE)
  else()
    add_library(carus_${name} INTERFACE)
    target_include_directories(carus_${name} INTERFACE ${CMAKE_SOURCE_DIR}/src)
    target_link_libraries(carus_${name} INTERFACE ${ARG_LINK} ${ARG_PRIVATE})
    set(CARUS_KEYWORD_${name} INTERFACE PARENT_SCOPE)
  endif()
endfunction()
