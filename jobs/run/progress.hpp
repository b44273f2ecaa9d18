#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include "engine/observer.hpp"

namespace semigeo::jobs {

/// Tells on stderr how a run goes: on a terminal one line that is overwritten, else a plain line a
/// minute. Rates are in vertices times levels per second. NO_COLOR is honoured (nothing is
/// coloured).
class Progress : public engine::Observer {
 public:
  /// `jobs` are to be done, which read `bytes` bytes of scans; time left is judged by bytes.
  Progress(std::int64_t jobs, std::uintmax_t bytes);
  ~Progress() override;

  void worked(std::int64_t amount) override;

  void job_started(const std::string& name);
  void job_ended(bool ok, std::uintmax_t bytes);
  /// Prints a line of its own, not disturbing the live line.
  void say(const std::string& line);

  std::int64_t vertex_levels() const { return vertex_levels_; }

 private:
  using Clock = std::chrono::steady_clock;
  void show(bool force);
  std::string counts() const;

  const std::int64_t jobs_;
  const std::uintmax_t bytes_;
  const bool terminal_;
  const Clock::time_point start_ = Clock::now();
  std::atomic<std::int64_t> vertex_levels_ = 0;
  std::mutex mutex_;  ///< guards what follows
  Clock::time_point shown_ = start_;
  std::string current_;
  std::int64_t done_ = 0;
  std::int64_t failed_ = 0;
  std::uintmax_t bytes_done_ = 0;
  bool live_ = false;  ///< a live line stands on the terminal
};

/// "counts, name" in at most `width` bytes: the name is shortened in its middle, then left out,
/// then the counts are cut.
std::string progress_line(const std::string& counts, const std::string& name, std::size_t width);

/// "1.2 M", "340 k", "17".
std::string short_number(double value);
/// "45 s", "3 min 20 s", "2 h 05 min".
std::string short_duration(double seconds);

}  // namespace semigeo::jobs
