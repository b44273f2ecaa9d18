#include "jobs/run/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "io/files/number_text.hpp"
#include "io/files/printable.hpp"
#include "jobs/run/terminal.hpp"

namespace semigeo::jobs {
namespace {

constexpr std::chrono::milliseconds kLiveInterval{200};
constexpr std::chrono::seconds kPlainInterval{60};
constexpr std::size_t kShortestName = 8;

/// Returns both ends of `text` with dots between them, or all of it if it fits. `width` counts
/// characters.
std::string shortened(const std::string& text, std::size_t width) {
  constexpr std::size_t kDots = 3;
  const std::size_t length = io::count_characters(text);
  if (length <= width) return text;
  const std::size_t tail = (width - kDots + 1) / 2;
  const std::size_t tail_begin = io::first_characters(text, length - tail).size();
  return std::string(io::first_characters(text, width - kDots - tail)) + "..." +
         text.substr(tail_begin);
}

/// Returns a whole number below 100 with two digits.
std::string two_digits(long number) {
  return (number < 10 ? "0" : "") + std::to_string(number);
}

}  // namespace

std::string progress_line(const std::string& counts, const std::string& name, std::size_t width) {
  const std::string text = counts + ", ";
  const std::size_t shortest = std::min(io::count_characters(name), kShortestName);
  if (text.size() + shortest > width) return counts.substr(0, width);
  return text + shortened(name, width - text.size());
}

std::string short_number(double value) {
  if (value >= 1e9) return io::fixed_text(value / 1e9, 2) + " G";
  if (value >= 1e6) return io::fixed_text(value / 1e6, 2) + " M";
  if (value >= 1e4) return io::fixed_text(value / 1e3, 0) + " k";
  return io::fixed_text(value, 0);
}

std::string short_duration(double seconds) {
  const auto whole = std::lround(seconds);
  if (seconds < 10) return io::fixed_text(seconds, 1) + " s";
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + two_digits(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + two_digits(whole % 3600 / 60) + " min";
}

Progress::Progress(std::int64_t jobs, std::uintmax_t bytes, bool quiet)
    : jobs_(jobs), bytes_(bytes), terminal_(is_live_terminal(STDERR_FILENO)), quiet_(quiet) {}

Progress::~Progress() {
  if (live_) std::fputs("\r\033[K", stderr);
}

void Progress::worked(std::int64_t amount) {
  vertex_levels_ += amount;
  std::unique_lock lock(mutex_, std::try_to_lock);
  if (lock) show(false);
}

void Progress::job_started(const std::string& name) {
  const std::scoped_lock lock(mutex_);
  current_ = io::printable(name);
  show(true);
}

void Progress::job_ended(bool ok, std::uintmax_t bytes) {
  const std::scoped_lock lock(mutex_);
  ++(ok ? done_ : failed_);
  bytes_done_ += bytes;
  show(true);
}

void Progress::say(const std::string& line) {
  if (quiet_) return;
  const std::scoped_lock lock(mutex_);
  std::fprintf(stderr, "%s%s\n", live_ ? "\r\033[K" : "", io::printable(line).c_str());
  live_ = false;
}

std::string Progress::counts() const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const std::int64_t left = jobs_ - done_ - failed_;
  std::string text = std::to_string(done_) + " done, " + std::to_string(failed_) + " failed, " +
                     std::to_string(left) + " left";
  if (elapsed > 0 && vertex_levels_ > 0)
    text += ", " + short_number(static_cast<double>(vertex_levels_) / elapsed) + " vertices/s";
  if (bytes_done_ > 0 && bytes_ > bytes_done_) {
    const double rest =
        static_cast<double>(bytes_ - bytes_done_) / static_cast<double>(bytes_done_);
    text += ", " + short_duration(elapsed * rest) + " left";
  }
  return text;
}

void Progress::show(bool force) {
  if (quiet_) return;
  const auto now = Clock::now();
  if (terminal_) {
    if (!force && now - shown_ < kLiveInterval) return;
    // The last column is left free, because some terminals wrap when it is written.
    const std::size_t width = terminal_columns(STDERR_FILENO) - 1;
    std::fprintf(stderr, "\r\033[K%s", progress_line(counts(), current_, width).c_str());
    live_ = true;
  } else {
    if (now - shown_ < kPlainInterval) return;
    std::fprintf(stderr, "%s, %s\n", counts().c_str(), current_.c_str());
  }
  shown_ = now;
}

}  // namespace semigeo::jobs
