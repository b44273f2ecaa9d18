#include "jobs/archive/utc_time.hpp"

#include <array>
#include <ctime>

namespace semigeo::jobs {

std::string utc_time() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text;
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

double seconds_since(const std::string& utc_time) {
  std::tm parts{};
  const char* end = strptime(utc_time.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  if (end == nullptr || *end != '\0') return 0;
  return std::difftime(std::time(nullptr), timegm(&parts));
}

}  // namespace semigeo::jobs
