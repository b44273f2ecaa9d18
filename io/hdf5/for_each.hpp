#pragma once

#include <cstdint>
#include <functional>

namespace semigeo::io {

/// Calls body(0), ..., body(count - 1) on any threads in any order, and returns when all are done.
/// The first exception comes through. An empty function stands for one call after the other.
using ForEach = std::function<void(std::int64_t count, const std::function<void(std::int64_t)>&)>;

}  // namespace semigeo::io
