# Writes a .cpp that holds FILES (names in FOLDER) as byte arrays behind FUNCTION(), which HEADER declares.
set(arrays "")
set(entries "")
set(number 0)
foreach(name IN LISTS FILES)
  file(READ ${FOLDER}/${name} hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${hex}")
  string(APPEND arrays "constexpr char file_${number}[] = {${bytes}};\n")
  string(APPEND entries "        {\"${name}\", {file_${number}, sizeof file_${number}}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "#include \"${HEADER}\"

namespace patchlight {

namespace {

${arrays}
}  // namespace

std::vector<std::pair<std::string_view, std::string_view>> ${FUNCTION}()
{
    return {
${entries}    };
}

}  // namespace patchlight
")
