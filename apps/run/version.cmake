# Writes version.cpp with the commit that is being built and the digest of the sources that make numbers, only when they
# changed. Run at build time.
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR NOT commit)
  set(commit unknown)
endif()

# Sorted names and what is in the files: the same wherever the tree stands.
set(numbers "")
foreach(folder meshing formfactor solver apps/run)
  file(GLOB_RECURSE names RELATIVE ${SOURCE} ${SOURCE}/${folder}/*.h ${SOURCE}/${folder}/*.cpp)
  list(APPEND numbers ${names})
endforeach()
list(SORT numbers)
set(digests "")
foreach(name IN LISTS numbers)
  file(SHA256 ${SOURCE}/${name} digest)
  string(APPEND digests "${digest} ${name}\n")
endforeach()
string(SHA256 numeric "${digests}")
string(SUBSTRING ${numeric} 0 16 numeric)

set(text "#include \"apps/run/run_record.h\"

namespace patchlight {

std::string tool_version()
{
    return \"${VERSION}\";
}

std::string tool_commit()
{
    return \"${commit}\";
}

std::string numeric_version()
{
    return \"${numeric}\";
}

}  // namespace patchlight
")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
