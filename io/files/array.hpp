#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "io/files/element_type.hpp"

namespace semigeo::io {

/// Refers to rows in memory, and says how a file stores them. The shape is (rows) if `columns` is
/// 1, and (rows, columns) otherwise. A view owns nothing: what it points to must outlive it. The
/// types may differ for int32 -> int64 and float64 -> float32, which are converted chunk by chunk,
/// so that no second copy of an array is ever in memory. Records in memory may end in padding,
/// which is not stored.
struct ArrayView {
  ElementType memory_type = ElementType::kFloat32;
  ElementType stored_type = ElementType::kFloat32;
  const std::byte* data = nullptr;
  std::ptrdiff_t row_stride = 0;  ///< Bytes from one row in memory to the next.
  std::int64_t rows = 0;          ///< Number of rows as stored.
  int columns = 1;
  /// Stored row i is memory row row_order[i]. If it is empty, rows are stored as they are in
  /// memory.
  std::span<const std::int32_t> row_order = {};
};

/// Memory rows in the order in which they are stored.
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

// Each of the functions that follow returns a view of its values. Scalars make one column. `stored`
// is the type that they are stored as.

/// Views (N) as float32.
inline ArrayView array_of(std::span<const float> values, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::kFloat32, ElementType::kFloat32, 1, order);
}
/// Views (N) as float64, or narrowed to float32.
inline ArrayView array_of(std::span<const double> values,
                          ElementType stored = ElementType::kFloat64, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::kFloat64, stored, 1, order);
}
/// Views (N) as int32, or widened to int64.
inline ArrayView array_of(std::span<const std::int32_t> values,
                          ElementType stored = ElementType::kInt32, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::kInt32, stored, 1, order);
}
/// Views (N) as int64.
inline ArrayView array_of(std::span<const std::int64_t> values, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::kInt64, ElementType::kInt64, 1, order);
}
/// Views (N) as uint8.
inline ArrayView array_of(std::span<const std::uint8_t> values, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::kUint8, ElementType::kUint8, 1, order);
}
/// Views (N, 3) as float32.
inline ArrayView array_of(std::span<const Eigen::Vector3f> values, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::kFloat32, ElementType::kFloat32, 3, order);
}
/// Views (N, 3), narrowed to float32.
inline ArrayView array_of(std::span<const Eigen::Vector3d> values, RowOrder order = {}) {
  return detail::rows_of(values, ElementType::kFloat64, ElementType::kFloat32, 3, order);
}
/// Views (F, 3), widened to int64.
inline ArrayView array_of(std::span<const std::array<std::int32_t, 3>> values,
                          RowOrder order = {}) {
  return detail::rows_of(values, ElementType::kInt32, ElementType::kInt64, 3, order);
}

}  // namespace semigeo::io
