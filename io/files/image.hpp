#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace semigeo::io {

/// A picture in memory: rows from the top, pixels from the left.
struct Image {
  Image() = default;
  /// Makes a picture that is transparent everywhere.
  Image(int columns, int rows)
      : width(columns),
        height(rows),
        rgba(std::size_t{4} * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

  /// Returns where the four numbers of a pixel begin.
  std::size_t at(int x, int y) const {
    return std::size_t{4} * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x));
  }

  int width = 0;
  int height = 0;
  /// (height, width, 4): red, green, blue in sRGB, and alpha, with which they are not multiplied.
  std::vector<std::uint8_t> rgba;
};

}  // namespace semigeo::io
