# carus_embed(TARGET FILE SYMBOL): compiles the text of FILE into TARGET as `const char* const carus::scenario::embedded::SYMBOL`.
function(carus_embed target file symbol)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(READ ${file} text)
  # Chunks: the standard only promises string literals of 65,536 bytes.
  set(literals "")
  string(LENGTH "${text}" length)
  set(begin 0)
  while(begin LESS length)
    string(SUBSTRING "${text}" ${begin} 8000 chunk)
    string(APPEND literals "R\"embed(${chunk})embed\"\n")
    math(EXPR begin "${begin} + 8000")
  endwhile()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded/${symbol}.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY NEWLINE_STYLE UNIX CONTENT
       "// Generated from ${file}\nnamespace carus::scenario::embedded {\nextern const char* const ${symbol};\nconst char* const ${symbol} =\n@literals@;\n}\n")
  target_sources(${target} PRIVATE ${source})
endfunction()
