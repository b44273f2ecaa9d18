#pragma once

#include <cstdint>
#include <vector>

#include "io/hdf5/content_digest.hpp"

namespace semigeo::io {

/// Who chose the level of a dataset.
enum class Chosen {
  slope,  ///< the curve of the counts: where it is flattest
  option  ///< the user
};
const char* name_of(Chosen chosen);

/// The level at which a scan is recognised, and what it was chosen by. L levels.
struct Selection {
  std::vector<std::int64_t> feature_counts;  ///< (L) of each level, all kinds together
  std::vector<double> smoothed;              ///< (L) the counts, smoothed along the levels
  std::int64_t level = 0;
  Chosen chosen = Chosen::slope;
};

/// Writes the group /selection.
void write_selection(DigestedFile& file, const Selection& selection, Compression compression);

/// Error if something is missing, or does not fit a dataset of so many levels.
Selection read_selection(const Hdf5File& file, int levels);

}  // namespace semigeo::io
