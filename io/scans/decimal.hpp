#pragma once

#include <string_view>

namespace semigeo::io {

/// A number that was read from a text.
struct Decimal {
  double value = 0;
  /// Behind the last character used; the start of the text if there is none.
  const char* end = nullptr;
};

/// Reads the decimal number at the start of `text`, rounded to the nearest double: an optional sign
/// (also '+'), digits with or without '.', an optional exponent. "nan" and "inf" in any spelling of
/// C and of MSVC ("1.#IND") are recognised and give a value that is not finite, as does an exponent
/// too large for a double; one too small gives zero.
Decimal parse_decimal(std::string_view text);

}  // namespace semigeo::io
