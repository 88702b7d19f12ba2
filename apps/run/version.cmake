# Writes version.cpp with the commit that is being built, only when it changed. Run at build time.
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR NOT commit)
  set(commit unknown)
endif()
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

}  // namespace patchlight
")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
