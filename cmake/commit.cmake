# Writes a source with the commit that is checked out, "unknown" outside of a repository of git, and
# a sign if files that git knows were changed. The source is left alone if it says so already:
#   cmake -DGIT=git -DSOURCE=repository -DOUTPUT=commit.cpp -P commit.cmake
set(COMMIT unknown)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse --show-toplevel
    OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE result ERROR_QUIET)
  file(REAL_PATH ${SOURCE} source)
  # A source without a repository may lie in that of something else.
  if(result EQUAL 0 AND top STREQUAL source)
    execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse --short=12 HEAD
      OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE result ERROR_QUIET)
    execute_process(COMMAND ${GIT} -C ${SOURCE} diff-index --quiet HEAD --
      RESULT_VARIABLE changed ERROR_QUIET)
    if(result EQUAL 0)
      set(COMMIT ${commit})
      if(changed EQUAL 1)
        string(APPEND COMMIT " with changes")
      endif()
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#include "jobs/cli/version.hpp"

namespace semigeo::jobs::cli {

const char* const kCommit = "@COMMIT@";

}  // namespace semigeo::jobs::cli
]] @ONLY)
