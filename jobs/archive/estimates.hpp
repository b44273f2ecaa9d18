#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "jobs/archive/journal.hpp"
#include "jobs/archive/scan_size.hpp"

namespace semigeo::jobs {

/// Holds what a job is expected to need.
struct Estimate {
  double vertices = 0;
  double peak_bytes = 0;  ///< Largest use of memory, with a margin for safety.
  double seconds = 0;
};

/// Guesses what surface jobs need from the size and format of their scans:
///
///   vertices   = bytes of the file / bytes per vertex
///   peak_bytes = (30 MB + bytes of memory per vertex * vertices) * 1.4
///   seconds    = 0.02 + time per vertex and level * vertices * levels / threads
///
/// The three rates are learned from the archive's own jobs: they are the medians over the last jobs
/// of each format, weighted by vertices. A format with fewer than three jobs gets the memory and
/// the time of all formats together. An archive with fewer than three jobs gets built-in rates.
class Estimates {
 public:
  /// Rates that were learned. The built-in rate replaces one that is absent.
  struct Rates {
    std::optional<double> file_bytes;    ///< Bytes of the file per vertex.
    std::optional<double> memory_bytes;  ///< Bytes of memory per vertex.
    std::optional<double> microseconds;  ///< Time per vertex and level on one thread.
    friend bool operator==(const Rates&, const Rates&) = default;
  };

  /// Makes estimates with the built-in rates.
  Estimates() = default;
  Estimates(std::map<std::string, Rates> by_format, Rates all);
  /// Reads what the archive has learned from ARCHIVE/estimates.json. The rates are the built-in
  /// ones if the file is absent or damaged.
  static Estimates read(const std::filesystem::path& archive);

  /// Returns what the surface job of a scan needs. `levels` counts level 0.
  Estimate of(const ScanSize& scan, int levels, int threads) const;
  /// Returns what a surface with this number of vertices needs, by the rates of all formats.
  Estimate of(double vertices, int levels, int threads) const;

  const std::map<std::string, Rates>& by_format() const { return by_format_; }
  const Rates& all() const { return all_; }
  /// Replaces the archive's file if the rates in it are different.
  void write(const std::filesystem::path& archive) const;

 private:
  Estimate of(double vertices, const Rates& rates, int levels, int threads) const;

  std::map<std::string, Rates> by_format_;
  Rates all_;
};

/// Learns rates from jobs, given in the order in which they ended. It passes over failed jobs, jobs
/// of other kinds, jobs with numbers that cannot be true, and scans that are too small. It keeps at
/// most a few hundred jobs of each format, however long the journal is.
class EstimateLearner {
 public:
  /// Takes the numbers of a job.
  void add(const JobEnded& job);
  /// Returns the rates that were learned.
  Estimates learned() const;

 private:
  std::map<std::string, std::deque<JobEnded>> jobs_;  ///< The key is the format.
};

/// Learns rates from the journal of an archive. Throws io::Error if the journal cannot be read.
Estimates learn_estimates(const std::filesystem::path& archive);

}  // namespace semigeo::jobs
