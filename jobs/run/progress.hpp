#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include "engine/observer.hpp"

namespace semigeo::jobs {

/// Prints on stderr how far a run is. On a terminal it is one line that is overwritten, otherwise a
/// new line every minute. Rates are in vertices times levels per second. Nothing is coloured.
class Progress : public engine::Observer {
 public:
  /// Starts a run of `jobs` jobs that read `bytes` bytes of scans. The time left is estimated from
  /// the bytes. A quiet one counts and prints nothing.
  Progress(std::int64_t jobs, std::uintmax_t bytes, bool quiet = false);
  ~Progress() override;

  /// Counts work, in vertices times levels.
  void worked(std::int64_t amount) override;

  /// Shows the name of a job that has started.
  void job_started(const std::string& name);
  /// Counts a job that has ended, and the bytes of its scan.
  void job_ended(bool ok, std::uintmax_t bytes);
  /// Prints a separate line and leaves the live line whole.
  void say(const std::string& line);

  /// Returns the work of all jobs so far, in vertices times levels.
  std::int64_t vertex_levels() const { return vertex_levels_; }

 private:
  using Clock = std::chrono::steady_clock;
  void show(bool force);
  std::string counts() const;

  const std::int64_t jobs_;
  const std::uintmax_t bytes_;
  const bool terminal_;
  const bool quiet_;
  const Clock::time_point start_ = Clock::now();
  std::atomic<std::int64_t> vertex_levels_ = 0;
  std::mutex mutex_;  ///< Guards the members below.
  Clock::time_point shown_ = start_;
  std::string current_;
  std::int64_t done_ = 0;
  std::int64_t failed_ = 0;
  std::uintmax_t bytes_done_ = 0;
  bool live_ = false;  ///< The terminal shows a live line.
};

/// Returns "counts, name" in at most `width` bytes. If it is too long, the name is shortened in its
/// middle, then left out; then the counts are cut.
std::string progress_line(const std::string& counts, const std::string& name, std::size_t width);

/// Returns a number as "1.2 M", "340 k" or "17".
std::string short_number(double value);
/// Returns a time as "45 s", "3 min 20 s" or "2 h 05 min".
std::string short_duration(double seconds);

}  // namespace semigeo::jobs
