#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace semigeo::kernels {

// Several arrays with one row for each vertex (or face) change together: these functions change
// them all. An array without rows is one that is not kept, and stays empty.

/// Returns the rows in another order: result[i] = values[order[i]]. Rows may be left out.
template <typename Value>
std::vector<Value> gathered(const std::vector<Value>& values,
                            const std::vector<std::int32_t>& order) {
  std::vector<Value> result(values.empty() ? 0 : order.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = values[order[i]];
  return result;
}

/// Puts the rows of several arrays into another order.
template <typename... Values>
void gather_rows(const std::tuple<std::vector<Values>&...>& arrays,
                 const std::vector<std::int32_t>& order) {
  std::apply([&](auto&... array) { ((array = gathered(array, order)), ...); }, arrays);
}

/// Appends a copy of one row to each of several arrays.
template <typename... Values>
void append_row_copy(const std::tuple<std::vector<Values>&...>& arrays, std::int32_t row) {
  const auto append = [row](auto& array) {
    if (!array.empty()) array.push_back(array[row]);
  };
  std::apply([&](auto&... array) { (append(array), ...); }, arrays);
}

}  // namespace semigeo::kernels
