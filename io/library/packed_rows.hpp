#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace semigeo::io {

/// Returns the values of packed rows of `stride` bytes, each the beginning of a Value in memory.
template <typename Value>
std::vector<Value> unpacked(std::span<const std::byte> rows, std::size_t stride = sizeof(Value)) {
  std::vector<Value> values(rows.size() / stride);
  for (std::size_t i = 0; i < values.size(); ++i)
    std::memcpy(static_cast<void*>(&values[i]), rows.data() + i * stride, stride);
  return values;
}

/// Returns the packed rows of values: the first `stride` bytes of each.
template <typename Value>
std::vector<std::byte> packed(std::span<const Value> values, std::size_t stride = sizeof(Value)) {
  std::vector<std::byte> rows(values.size() * stride);
  for (std::size_t i = 0; i < values.size(); ++i)
    std::memcpy(rows.data() + i * stride, static_cast<const void*>(&values[i]), stride);
  return rows;
}

}  // namespace semigeo::io
