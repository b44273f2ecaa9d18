#pragma once

#include <string_view>

namespace semigeo::io {

struct Decimal {
  double value = 0;
  const char* end = nullptr;  ///< behind the last character used; the start of the text if none
};

/// The decimal number at the start of `text`, rounded to the nearest double: an optional sign
/// (also '+'), digits with or without '.', an optional exponent. "nan" and "inf" in any spelling
/// of C and of MSVC ("1.#IND") are recognised and give a value that is not finite, as does an
/// exponent too large for a double; one too small gives zero.
Decimal parse_decimal(std::string_view text);

}  // namespace semigeo::io
