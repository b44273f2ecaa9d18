#pragma once

#include <cstddef>

#include "jobs/cli/search_run.hpp"
#include "jobs/run/run.hpp"

namespace semigeo::jobs::cli {

/// Says what of the results is printed.
struct SimilarReport {
  std::size_t top = 10;             ///< Number of models of each scan.
  bool groups = false;              ///< Groups of one object are printed instead of lists.
  bool failures_were_told = false;  ///< Each failure was printed in the same place before.
};

/// Prints on stdout for each scan the models that resemble it, those of one object first, then by
/// how alike they are as a whole; or the groups. Then failures and totals.
void print_similar(const RunResult& result, const Searched& searched, const SimilarReport& report);

/// Prints the same as one JSON document.
void print_similar_json(const RunResult& result, const Searched& searched,
                        const SimilarReport& report);

}  // namespace semigeo::jobs::cli
