#pragma once

#include <string>
#include <vector>

#include "bench/peers/comparison.hpp"
#include "bench/peers/scan_views.hpp"

namespace semigeo::peers {

/// Holds everything that one run of the program measured.
struct Report {
  std::vector<Library> libraries;
  int rounds = 0;
  std::vector<MethodRow> methods;
  /// Levels of ours, then jets of each degree by rising radius; empty without range views.
  std::vector<AgreementRow> agreement;
};

/// Returns tables in Markdown.
std::string markdown(const Report& report);
/// Returns the same as JSON.
std::string json(const Report& report);
/// Returns two panels: disagreement and time against the detail that is left.
std::string chart(const Report& report);

}  // namespace semigeo::peers
