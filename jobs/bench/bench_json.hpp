#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <vector>

#include "jobs/bench/report.hpp"

namespace semigeo::jobs {

/// Returns the report in the form of Google Benchmark's JSON: `context` and `benchmarks`, with one
/// entry for each repetition, then the aggregates mean, median, stddev and cv. Times are in
/// milliseconds for one call. `items_per_second` is the rate, and `label` its unit.
nlohmann::json google_document(const BenchReport& report);

/// Returns the medians as a list of objects with name, unit, value, range and extra: what
/// github-action-benchmark reads with `tool: customBiggerIsBetter`. Every value is a rate.
nlohmann::json github_document(const BenchReport& report);

/// A baseline that cannot be compared with.
class BaselineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads the rates of a file that has a google_document. Throws BaselineError if it has none, or if
/// it was measured on other surfaces: by another version, or if one of both with --quick.
std::vector<NamedRate> read_baseline(const std::filesystem::path& path, bool quick);

}  // namespace semigeo::jobs
