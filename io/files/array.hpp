#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "io/files/element_type.hpp"

namespace semigeo::io {

/// Rows somewhere in memory and how a dataset stores them: shape (rows) when `columns` is 1, else
/// (rows, columns). Owns nothing: what it points to must outlive it. The types may differ for
/// int32 -> int64 and float64 -> float32, which are converted chunk by chunk, so that no second
/// copy of an array is ever in memory. Records in memory may end in padding, which is not stored.
struct ArrayView {
  ElementType memory_type = ElementType::float32;
  ElementType stored_type = ElementType::float32;
  const std::byte* data = nullptr;
  std::ptrdiff_t row_stride = 0;  ///< bytes from one row in memory to the next
  std::int64_t rows = 0;          ///< rows as stored
  int columns = 1;
  /// Stored row i is memory row row_order[i]; empty: as in memory.
  std::span<const std::int32_t> row_order = {};
};

using RowOrder = std::span<const std::int32_t>;

namespace detail {

template <typename Row>
ArrayView rows_of(std::span<const Row> values, ElementType memory, ElementType stored, int columns,
                  RowOrder order) {
  return {.memory_type = memory,
          .stored_type = stored,
          .data = reinterpret_cast<const std::byte*>(values.data()),
          .row_stride = sizeof(Row),
          .rows = static_cast<std::int64_t>(order.empty() ? values.size() : order.size()),
          .columns = columns,
          .row_order = order};
}

}  // namespace detail

inline ArrayView array_of(std::span<const float> values, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::float32, ElementType::float32, 1, order);
}
inline ArrayView array_of(std::span<const double> values, ElementType stored = ElementType::float64,
                          RowOrder order = {}) {
  return detail::rows_of(values, ElementType::float64, stored, 1, order);
}
inline ArrayView array_of(std::span<const std::int32_t> values,
                          ElementType stored = ElementType::int32, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::int32, stored, 1, order);
}
inline ArrayView array_of(std::span<const std::int64_t> values, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::int64, ElementType::int64, 1, order);
}
inline ArrayView array_of(std::span<const std::uint8_t> values, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::uint8, ElementType::uint8, 1, order);
}
/// (N, 3) as float32.
inline ArrayView array_of(std::span<const Eigen::Vector3f> values, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::float32, ElementType::float32, 3, order);
}
/// (N, 3), narrowed to float32.
inline ArrayView array_of(std::span<const Eigen::Vector3d> values, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::float64, ElementType::float32, 3, order);
}
/// (F, 3), widened to int64.
inline ArrayView array_of(std::span<const std::array<std::int32_t, 3>> values,
                          RowOrder order = {}) {
  return detail::rows_of(values, ElementType::int32, ElementType::int64, 3, order);
}

}  // namespace semigeo::io
