#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "jobs/archive/find_scans.hpp"
#include "jobs/kinds/recognise_plan.hpp"
#include "jobs/run/run.hpp"

namespace semigeo::jobs::cli {

/// Says how much of the results is printed.
struct RecogniseReport {
  std::size_t top = 5;              ///< Number of models of each ranking.
  bool failures_were_told = false;  ///< Each failure was printed in the same place before.
  bool has_files = true;            ///< The files are kept, so their paths are printed.
  PassedOver passed_over;           ///< Files that are no scenes.
};

/// Returns what the JSON of every search says besides its scenes: the library, and what the run did
/// and took.
nlohmann::json search_json(const RunResult& result, const SearchedLibrary& library);

/// Prints on stdout for each scene its objects with their poses and the first models of the
/// ranking; then failures and totals.
void print_recognised(const RunResult& result, const SearchedLibrary& library,
                      const RecogniseReport& report);

/// Prints the same as one JSON document, with the content of each file.
void print_recognised_json(const RunResult& result, const SearchedLibrary& library,
                           const RecogniseReport& report);

}  // namespace semigeo::jobs::cli
