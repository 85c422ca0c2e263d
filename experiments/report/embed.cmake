# Writes OUTPUT: a C++ file with a function of each name in NAMES that returns the bytes of the file at the same place in FILES.
# Both are joined by "|". A file "none" is empty.
string(REPLACE "|" ";" NAMES "${NAMES}")
string(REPLACE "|" ";" FILES "${FILES}")
set(out "// Made by experiments/report/embed.cmake; do not edit.\n#include \"experiments/report/embedded.h\"\n\nnamespace framesim {\n")
foreach(name file IN ZIP_LISTS NAMES FILES)
  set(bytes "")
  if(NOT file STREQUAL "none")
    file(READ ${file} hex HEX)
    string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${hex}")
  endif()
  string(APPEND out "static const char ${name}_bytes[] = {${bytes}'\\0'};\n"
                    "std::string_view ${name}() { return {${name}_bytes, sizeof ${name}_bytes - 1}; }\n")
endforeach()
file(WRITE ${OUTPUT} "${out}}  // namespace framesim\n")
