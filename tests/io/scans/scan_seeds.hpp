#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace semigeo::io {

/// A small scan, from which others are made by damage.
struct Seed {
  std::string name;   ///< Name of its file, with the extension of its format.
  std::string bytes;  ///< Content of its file.
  friend void PrintTo(const Seed& seed, std::ostream* out) { *out << seed.name; }
};

/// Returns a scan of each format in each of its encodings. None is compressed as a whole.
std::vector<Seed> plain_seeds();

}  // namespace semigeo::io
