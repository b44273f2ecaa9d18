#pragma once

#include <string>

namespace semigeo::io {

/// Returns a number for people to read, with all the digits that it has: a length, a coordinate or
/// a part of a pose. A double has at most 15 significant digits. A decimal number of 15 digits that
/// was read from a file is printed as it was written, and the rounding errors of a sum stay out of
/// sight (0.1 + 0.2 is "0.3"). The text does not depend on the locale.
std::string number_text(double value);
/// Returns the shortest decimal number that reads back as the same float.
std::string number_text(float value);

/// Returns a number for people with this number of decimals: a share, a rate or a duration, whose
/// further digits mean nothing.
std::string fixed_text(double value, int decimals);

}  // namespace semigeo::io
