# carus_embed_page(TARGET FILE): the bytes of FILE in TARGET as carus::report::embedded::viewer_page(); none where FILE is not there (then
# `carus report` asks for it with --viewer). The assembler reads the file as it is: no escaping, no limit of string literals.
function(carus_embed_page target file)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded/viewer_page.cpp)
  if(EXISTS ${file})
    set(data "asm(\".section .rodata\\n\"\n    \".global carus_viewer_begin\\n.global carus_viewer_end\\n\"\n    \"carus_viewer_begin:\\n.incbin \\\"${file}\\\"\\ncarus_viewer_end:\\n.byte 0\\n.text\\n\");\nextern \"C\" const char carus_viewer_begin[], carus_viewer_end[];\n")
    set(value "{carus_viewer_begin, std::size_t(carus_viewer_end - carus_viewer_begin)}")
    set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS ${file})
  else()
    set(data "")
    set(value "{}")
    message(STATUS "No ${file}: carus report has no viewer built in (./dev build makes it)")
  endif()
  file(CONFIGURE OUTPUT ${source} @ONLY NEWLINE_STYLE UNIX CONTENT
       "// Generated from ${file}\n#include <string_view>\n@data@namespace carus::report {\nstd::string_view built_in_viewer();\nstd::string_view built_in_viewer() { return @value@; }\n}  // namespace carus::report\n")
  target_sources(${target} PRIVATE ${source})
endfunction()
