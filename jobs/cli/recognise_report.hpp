#pragma once

#include <cstddef>
#include <vector>

#include "jobs/cli/run_report.hpp"
#include "jobs/plan/recognise_plan.hpp"

namespace semigeo::jobs::cli {

/// How much of what was recognised is told.
struct RecogniseReport {
  std::size_t top = 5;    ///< models of each ranking
  bool has_files = true;  ///< that stay
};

/// For each scene its objects with their poses, then the first of the ranking; failures; totals.
/// outcomes[i] belongs to plan[i].
void print_recognised(const std::vector<PlannedJob>& plan, const std::vector<JobOutcome>& outcomes,
                      const RunSummary& summary, const SearchedLibrary& library,
                      const RecogniseReport& report);

/// The same as one JSON document, with the content of each file.
void print_recognised_json(const std::vector<PlannedJob>& plan,
                           const std::vector<JobOutcome>& outcomes, const RunSummary& summary,
                           const SearchedLibrary& library, const RecogniseReport& report);

}  // namespace semigeo::jobs::cli
