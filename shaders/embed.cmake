# Writes OUTPUT: a function from a shader's name to its text, for every file of FILES under ROOT.
set(text "#include <string_view>\n\nnamespace panoptes::gl {\n\n")
string(APPEND text "std::string_view embedded_shader(std::string_view file) {\n")
foreach(file IN LISTS FILES)
  file(READ ${ROOT}/${file} content)
  string(APPEND text "  if (file == \"${file}\") return R\"GLSL(${content})GLSL\";\n")
endforeach()
string(APPEND text "  return {};\n}\n\n}  // namespace panoptes::gl\n")
file(WRITE ${OUTPUT} "${text}")
