#pragma once

#include <cstdint>
#include <functional>

namespace semigeo::io {

/// Calls body(0), ..., body(count - 1) on what threads and in what order it likes, and returns when
/// all are done; the first exception comes through. Empty: one after the other.
using ForEach = std::function<void(std::int64_t count, const std::function<void(std::int64_t)>&)>;

}  // namespace semigeo::io
