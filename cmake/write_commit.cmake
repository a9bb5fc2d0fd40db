# cmake -D GIT=PROGRAM -D SOURCE=FOLDER -D OUTPUT=FILE -P write_commit.cmake
# Writes the commit that SOURCE has checked out; nothing where it is no repository of its own, such
# as an unpacked archive inside another's.
set(commit "")
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --abbrev=12 --exclude=* --dirty=+changes
                  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  string(REPLACE "+changes" " with changes" commit "${commit}")
endif()
set(text "// Generated: see write_commit.cmake.
#include \"experiments/commands/version_text.h\"

const char* const lockstep::build_commit = \"${commit}\";
")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
