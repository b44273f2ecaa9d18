#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

namespace semigeo::io {

/// Makes the triangles of a strip: each corner with the two before it, every second time in the
/// opposite order. Repeated corners only steer a strip and make no triangle.
class TriangleStrip {
 public:
  /// Takes the next corner. Returns the triangle that it completes, if it completes one.
  std::optional<std::array<std::int64_t, 3>> next(std::int64_t corner) {
    const std::int64_t a = std::exchange(a_, b_), b = std::exchange(b_, corner);
    if (++length_ < 3 || a == b || b == corner || a == corner) return std::nullopt;
    return length_ % 2 == 0 ? std::array{b, a, corner} : std::array{a, b, corner};
  }
  /// Begins a new strip with the next corner.
  void restart() { length_ = 0; }

 private:
  std::int64_t length_ = 0, a_ = 0, b_ = 0;
};

}  // namespace semigeo::io
