#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>
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

/// Is thrown for a baseline that cannot be compared with.
class BaselineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Holds what rates depend on besides the program and the machine.
struct BenchConditions {
  bool quick = false;
  std::string scan_xxh3 = {};  ///< Digest of the user's scan, or empty.
};

/// Reads the rates of a file that has a google_document. Throws BaselineError if it has none, or if
/// it was measured on other surfaces or under other conditions.
std::vector<NamedRate> read_baseline(const std::filesystem::path& path,
                                     const BenchConditions& conditions);

}  // namespace semigeo::jobs
