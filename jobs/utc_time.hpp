#pragma once

#include <string>

namespace semigeo::jobs {

/// Now, as "2024-05-31T21:00:00Z".
std::string utc_time();

}  // namespace semigeo::jobs
