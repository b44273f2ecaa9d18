#pragma once

#include <cstdint>
#include <vector>

#include "io/hdf5/content_digest.hpp"

namespace semigeo::io {

/// Says who chose the level of a dataset.
enum class Chosen {
  kSlope,  ///< The curve of the counts, where it is flattest.
  kOption  ///< The user.
};
/// Returns "slope" or "option", as the file names it.
const char* name_of(Chosen chosen);

/// The level at which a scan is recognised, and why. L is the number of levels.
struct Selection {
  /// (L) Number of features of each level, of all kinds together.
  std::vector<std::int64_t> feature_counts;
  std::vector<double> smoothed;  ///< (L) The counts, smoothed along the levels.
  std::int64_t level = 0;
  Chosen chosen = Chosen::kSlope;
};

/// Writes the group /selection.
void write_selection(DigestedFile& file, const Selection& selection, Compression compression);

/// Reads the group /selection. Throws Error if something is missing, or does not fit a dataset of
/// this number of levels.
Selection read_selection(const Hdf5File& file, int levels);

}  // namespace semigeo::io
