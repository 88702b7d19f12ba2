# Run by cpack between laying the files out and packing them: what Debian has other places and forms for.
file(GLOB trees LIST_DIRECTORIES true ${CPACK_TEMPORARY_DIRECTORY}/*/usr)
foreach(usr IN LISTS trees)
  if(EXISTS ${usr}/share/zsh/site-functions)
    file(RENAME ${usr}/share/zsh/site-functions ${usr}/share/zsh/vendor-completions)
  endif()
  # It stands in /usr/share/common-licenses.
  file(REMOVE ${usr}/share/doc/patchlight/LICENSE)

  file(GLOB doc LIST_DIRECTORIES true ${usr}/share/doc/*)
  string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(WRITE ${doc}/changelog "patchlight (${CPACK_PACKAGE_VERSION}) bookworm; urgency=medium

  * As the program's version and commit say.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
  file(GLOB plain ${usr}/share/man/man*/*.1 ${doc}/changelog)
  execute_process(COMMAND gzip -9n ${plain} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND find ${usr} -exec touch -h -d "@$ENV{SOURCE_DATE_EPOCH}" {} +)
endforeach()
