#pragma once

#include <concepts>
#include <utility>

namespace semigeo::io {

/// Reads a value of a JSON document. A whole number must be written as one, and `Value` must hold
/// it: a number beyond 64 bits is kept as a floating-point number, which may lie outside of all
/// whole numbers. Throws Json::exception if the value is of another type or out of range.
template <typename Json, typename Value>
void read_value(const Json& from, Value& value) {
  if constexpr (std::integral<Value> && !std::same_as<Value, bool>) {
    const auto& number = from.template get_ref<const typename Json::number_integer_t&>();
    const bool fits =
        from.is_number_unsigned()
            ? std::in_range<Value>(from.template get<typename Json::number_unsigned_t>())
            : std::in_range<Value>(number);
    if (!fits) throw Json::out_of_range::create(406, "number out of range: " + from.dump(), &from);
  }
  from.get_to(value);
}

}  // namespace semigeo::io
