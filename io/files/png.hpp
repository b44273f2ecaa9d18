#pragma once

#include <string>

#include "io/files/image.hpp"

namespace semigeo::io {

/// Returns the bytes of a PNG file. Alpha is left out if the picture is opaque. Throws
/// std::invalid_argument if the picture has no pixel or its array does not fit its size.
/// Thread-safe.
std::string png_of(const Image& image);

}  // namespace semigeo::io
