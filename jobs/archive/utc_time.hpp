#pragma once

#include <string>

namespace semigeo::jobs {

/// Returns the current time as "2024-05-31T21:00:00Z".
std::string utc_time();
/// Returns the seconds from such a time to now, or 0 if the text is no time.
double seconds_since(const std::string& utc_time);
/// Returns the seconds from one such time to another, or 0 if one of the texts is no time.
double seconds_between(const std::string& begin, const std::string& end);

}  // namespace semigeo::jobs
