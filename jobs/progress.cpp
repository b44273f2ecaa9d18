#include "jobs/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace semigeo::jobs {
namespace {

constexpr std::chrono::milliseconds kLiveInterval{200};
constexpr std::chrono::seconds kPlainInterval{60};
constexpr int kLiveWidth = 100;

template <typename... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
  const int length = std::snprintf(nullptr, 0, pattern, arguments...);
  std::string text(length + 1, '\0');
  std::snprintf(text.data(), text.size(), pattern, arguments...);
  text.pop_back();
  return text;
}

}  // namespace

std::string short_number(double value) {
  if (value >= 1e9) return format("%.2f G", value / 1e9);
  if (value >= 1e6) return format("%.2f M", value / 1e6);
  if (value >= 1e4) return format("%.0f k", value / 1e3);
  return format("%.0f", value);
}

std::string short_duration(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  if (seconds < 10) return format("%.1f s", seconds);
  if (whole < 60) return format("%ld s", whole);
  if (whole < 3600) return format("%ld min %02ld s", whole / 60, whole % 60);
  return format("%ld h %02ld min", whole / 3600, whole % 3600 / 60);
}

Progress::Progress(std::int64_t scans, std::uintmax_t bytes)
    : scans_(scans), bytes_(bytes), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (live_) std::fputs("\r\033[K", stderr);
}

void Progress::worked(std::int64_t amount) {
  vertex_levels_ += amount;
  std::unique_lock lock(mutex_, std::try_to_lock);
  if (lock) show(false);
}

void Progress::scan_started(const std::string& name) {
  const std::scoped_lock lock(mutex_);
  current_ = name;
  show(true);
}

void Progress::scan_ended(bool ok, std::uintmax_t bytes) {
  const std::scoped_lock lock(mutex_);
  ++(ok ? done_ : failed_);
  bytes_done_ += bytes;
  show(false);
}

void Progress::say(const std::string& line) {
  const std::scoped_lock lock(mutex_);
  std::fprintf(stderr, "%s%s\n", live_ ? "\r\033[K" : "", line.c_str());
  live_ = false;
}

std::string Progress::line() const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const std::int64_t left = scans_ - done_ - failed_;
  std::string text = format("%ld done, %ld failed, %ld left", static_cast<long>(done_),
                            static_cast<long>(failed_), static_cast<long>(left));
  if (elapsed > 0)
    text += ", " + short_number(static_cast<double>(vertex_levels_) / elapsed) + " vertices/s";
  if (bytes_done_ > 0 && bytes_ > bytes_done_) {
    const double rest =
        static_cast<double>(bytes_ - bytes_done_) / static_cast<double>(bytes_done_);
    text += ", " + short_duration(elapsed * rest) + " left";
  }
  return text + ", " + current_;
}

void Progress::show(bool force) {
  const auto now = Clock::now();
  if (terminal_) {
    if (!force && now - shown_ < kLiveInterval) return;
    std::fprintf(stderr, "\r\033[K%.*s", kLiveWidth, line().c_str());
    live_ = true;
  } else {
    if (now - shown_ < kPlainInterval) return;
    std::fprintf(stderr, "%s\n", line().c_str());
  }
  shown_ = now;
}

}  // namespace semigeo::jobs
