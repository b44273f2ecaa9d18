#pragma once

#include <string_view>

namespace semigeo::jobs {

/// A page without its data. The data is a JSON document that stands between the two texts.
struct PageTemplate {
  std::string_view before;
  std::string_view behind;
};

/// The pages that were bundled when the program was built (report/CMakeLists.txt).
struct Pages {
  /// Why the program has no pages, as a clause. It is empty if it has them.
  std::string_view missing;
  PageTemplate index = {};  ///< The table of all scans.
  PageTemplate scan = {};   ///< The surface of one scan and its data.
  PageTemplate scene = {};  ///< A recognised scene and the models in it.
};

/// Returns the pages of this program.
const Pages& pages();

}  // namespace semigeo::jobs
