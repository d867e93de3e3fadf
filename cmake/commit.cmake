# cmake -D SOURCE=FOLDER -D HEADER=FILE -P commit.cmake: writes CDEM_COMMIT, what git says of the sources.
# Sources from `git archive` have the commit in cmake/commit.txt (.gitattributes). A repository that only happens to be
# around the sources is not asked.
set(commit "")
if(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND git describe --always --dirty --tags WORKING_DIRECTORY ${SOURCE}
                  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
else()
  file(STRINGS ${SOURCE}/cmake/commit.txt commit REGEX "^[0-9a-f]+$")
endif()
if(commit STREQUAL "")
  set(commit "unknown")
endif()
set(text "#define CDEM_COMMIT \"${commit}\"\n")
set(old "")
if(EXISTS ${HEADER})
  file(READ ${HEADER} old)
endif()
if(NOT text STREQUAL old)
  file(WRITE ${HEADER} "${text}")
endif()
