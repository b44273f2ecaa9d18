#pragma once

#include <concepts>

namespace semigeo::io {

/// Reads a value of a JSON document. A whole number must be written as one: a number beyond 64 bits
/// is kept as a floating-point number, which may lie outside of all whole numbers. Throws
/// Json::exception if the value is of another type.
template <typename Json, typename Value>
void read_value(const Json& from, Value& value) {
  if constexpr (std::integral<Value> && !std::same_as<Value, bool>)
    static_cast<void>(from.template get_ref<const typename Json::number_integer_t&>());
  from.get_to(value);
}

}  // namespace semigeo::io
