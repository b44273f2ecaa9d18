#include "jobs/run/progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace semigeo::jobs {
namespace {

constexpr std::chrono::milliseconds kLiveInterval{200};
constexpr std::chrono::seconds kPlainInterval{60};
constexpr std::size_t kUsualWidth = 80;
constexpr std::size_t kShortestName = 8;

/// Returns the number of columns that a line may fill. The last column is left free, because some
/// terminals wrap when it is written.
std::size_t terminal_width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return (known ? size.ws_col : kUsualWidth) - 1;
}

/// Returns both ends of `text` with dots between them, or all of it if it fits.
std::string shortened(const std::string& text, std::size_t width) {
  constexpr std::size_t kDots = 3;
  if (text.size() <= width) return text;
  const std::size_t tail = (width - kDots + 1) / 2;
  return text.substr(0, width - kDots - tail) + "..." + text.substr(text.size() - tail);
}

template <typename... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
  const int length = std::snprintf(nullptr, 0, pattern, arguments...);
  std::string text(length + 1, '\0');
  std::snprintf(text.data(), text.size(), pattern, arguments...);
  text.pop_back();
  return text;
}

}  // namespace

std::string progress_line(const std::string& counts, const std::string& name, std::size_t width) {
  const std::string text = counts + ", ";
  if (text.size() + std::min(name.size(), kShortestName) > width) return counts.substr(0, width);
  return text + shortened(name, width - text.size());
}

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

Progress::Progress(std::int64_t jobs, std::uintmax_t bytes)
    : jobs_(jobs), bytes_(bytes), terminal_(isatty(STDERR_FILENO) != 0) {}

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
  current_ = name;
  show(true);
}

void Progress::job_ended(bool ok, std::uintmax_t bytes) {
  const std::scoped_lock lock(mutex_);
  ++(ok ? done_ : failed_);
  bytes_done_ += bytes;
  show(true);
}

void Progress::say(const std::string& line) {
  const std::scoped_lock lock(mutex_);
  std::fprintf(stderr, "%s%s\n", live_ ? "\r\033[K" : "", line.c_str());
  live_ = false;
}

std::string Progress::counts() const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const std::int64_t left = jobs_ - done_ - failed_;
  std::string text = format("%ld done, %ld failed, %ld left", static_cast<long>(done_),
                            static_cast<long>(failed_), static_cast<long>(left));
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
  const auto now = Clock::now();
  if (terminal_) {
    if (!force && now - shown_ < kLiveInterval) return;
    std::fprintf(stderr, "\r\033[K%s", progress_line(counts(), current_, terminal_width()).c_str());
    live_ = true;
  } else {
    if (now - shown_ < kPlainInterval) return;
    std::fprintf(stderr, "%s, %s\n", counts().c_str(), current_.c_str());
  }
  shown_ = now;
}

}  // namespace semigeo::jobs
