#pragma once

#include "jobs/cli/output.hpp"
#include "jobs/report/pages.hpp"

namespace semigeo::jobs::cli {

/// Returns whether this program was built without the pages of a report, and says why on stderr.
inline bool lacks_pages() {
  if (pages().missing.empty()) return false;
  complain("this program has no report: ", pages().missing,
           "; install node and npm, and build it again (CONTRIBUTING.md)");
  return true;
}

}  // namespace semigeo::jobs::cli
