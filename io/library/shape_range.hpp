#pragma once

#include "kernels/recognition/triplet.hpp"

namespace semigeo::io {

/// The shapes first, ..., end - 1, which have the cells first * kCodeTriples, ..., end *
/// kCodeTriples - 1.
struct ShapeRange {
  int first = 0;
  int end = kernels::kShapes;

  /// Returns the first cell of the shapes.
  std::uint32_t first_cell() const {
    return static_cast<std::uint32_t>(first) * kernels::kCodeTriples;
  }
  /// Returns the cell after the last one of the shapes.
  std::uint32_t end_cell() const { return static_cast<std::uint32_t>(end) * kernels::kCodeTriples; }
  friend bool operator==(const ShapeRange&, const ShapeRange&) = default;
};

}  // namespace semigeo::io
