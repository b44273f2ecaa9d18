#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "jobs/archive/journal.hpp"
#include "jobs/archive/scan_size.hpp"

namespace semigeo::jobs {

/// What a job is expected to need.
struct Estimate {
  double vertices = 0;
  double peak_bytes = 0;  ///< of memory, with a margin for safety
  double seconds = 0;
};

/// Guesses what surface jobs need from the size and format of their scans:
///
///   vertices   = bytes of the file / bytes a vertex
///   peak_bytes = (30 MB + bytes of memory a vertex * vertices) * 1.4
///   seconds    = 0.02 + time a vertex and level * vertices * levels / threads
///
/// The three rates are learned from the archive's own jobs: for each format the medians over its
/// last jobs, where a vertex is a voice. A format with fewer than three of them has the memory and
/// the time of all formats together; an archive with fewer, built-in rates.
class Estimates {
 public:
  /// Rates that were learned; none: the built-in one.
  struct Rates {
    std::optional<double> file_bytes;    ///< a vertex
    std::optional<double> memory_bytes;  ///< a vertex
    std::optional<double> microseconds;  ///< a vertex and level, on one thread
    friend bool operator==(const Rates&, const Rates&) = default;
  };

  /// The built-in rates.
  Estimates() = default;
  Estimates(std::map<std::string, Rates> by_format, Rates all);
  /// What the archive has learned, ARCHIVE/estimates.json; built-in rates where that is absent or
  /// damaged.
  static Estimates read(const std::filesystem::path& archive);

  /// `levels` counts level 0.
  Estimate of(const ScanSize& scan, int levels, int threads) const;
  /// The same of a surface of so many vertices, by the rates of all formats.
  Estimate of(double vertices, int levels, int threads) const;

  const std::map<std::string, Rates>& by_format() const { return by_format_; }
  const Rates& all() const { return all_; }
  /// Replaces the archive's file, if it would say something else.
  void write(const std::filesystem::path& archive) const;

 private:
  Estimate of(double vertices, const Rates& rates, int levels, int threads) const;

  std::map<std::string, Rates> by_format_;
  Rates all_;
};

/// Learns rates from jobs that have ended, given in the order in which they did. Failed jobs, other
/// kinds, numbers that cannot be true, and scans too small to tell are passed over. Keeps a few
/// hundred jobs of each format, so that the archive may be of any age.
class EstimateLearner {
 public:
  void add(const JobEnded& job);
  Estimates learned() const;

 private:
  std::map<std::string, std::deque<JobEnded>> jobs_;  ///< by format
};

/// From all of an archive's journal. Error if there is one that cannot be read.
Estimates learn_estimates(const std::filesystem::path& archive);

}  // namespace semigeo::jobs
