#include "jobs/archive/utc_time.hpp"

#include <array>
#include <ctime>
#include <optional>

namespace semigeo::jobs {
namespace {

std::optional<std::time_t> time_of(const std::string& utc_time) {
  std::tm parts{};
  const char* end = strptime(utc_time.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  if (end == nullptr || *end != '\0') return std::nullopt;
  return timegm(&parts);
}

}  // namespace

std::string utc_time() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text;
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

double seconds_since(const std::string& utc_time) {
  const auto begin = time_of(utc_time);
  return begin ? std::difftime(std::time(nullptr), *begin) : 0;
}

double seconds_between(const std::string& begin, const std::string& end) {
  const auto from = time_of(begin);
  const auto to = time_of(end);
  return from && to ? std::difftime(*to, *from) : 0;
}

}  // namespace semigeo::jobs
