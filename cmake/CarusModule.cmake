# carus_module(NAME LINK public... PRIVATE private...): the library carus_NAME from src/carus/NAME/*.cpp.
set(CARUS_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
    -Wno-stringop-overflow)  # GCC 12 is wrong about fmt 9

# carus_precompile(TARGET FROM [HEADERS...]): what most sources include is parsed once, for FROM; others use that.
function(carus_precompile target from)
  if(CARUS_PCH AND target STREQUAL from)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  elseif(CARUS_PCH)
    target_precompile_headers(${target} REUSE_FROM ${from})
  endif()
endfunction()
set(CARUS_COMMON_HEADERS <Eigen/Geometry> <Eigen/LU> <fmt/format.h> <algorithm> <array> <cmath> <filesystem> <functional> <map> <optional> <string> <vector>)

function(carus_module name)
  cmake_parse_arguments(ARG "" "" "LINK;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/carus/${name}/*.cpp)
  if(sources)
    add_library(carus_${name} STATIC ${sources})
    target_include_directories(carus_${name} PUBLIC ${CMAKE_SOURCE_DIR}/src)
    target_link_libraries(carus_${name} PUBLIC ${ARG_LINK} PRIVATE ${ARG_PRIVATE})
    target_compile_options(carus_${name} PRIVATE ${CARUS_WARNINGS})
    carus_precompile(carus_${name} carus_mesh ${CARUS_COMMON_HEADERS})
    set(CARUS_KEYWORD_${name} PRIVATE PARENT_SCOPE)
  else()
    add_library(carus_${name} INTERFACE)
    target_include_directories(carus_${name} INTERFACE ${CMAKE_SOURCE_DIR}/src)
    target_link_libraries(carus_${name} INTERFACE ${ARG_LINK} ${ARG_PRIVATE})
    set(CARUS_KEYWORD_${name} INTERFACE PARENT_SCOPE)
  endif()
endfunction()
