#pragma once

#include <string>

namespace semigeo::jobs {

/// Now, as "2024-05-31T21:00:00Z".
std::string utc_time();
/// Seconds from such a time to now; 0 for a text that is none.
double seconds_since(const std::string& utc_time);

}  // namespace semigeo::jobs
