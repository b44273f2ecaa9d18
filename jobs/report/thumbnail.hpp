#pragma once

#include <string>

#include "io/dataset/dataset.hpp"

namespace semigeo::jobs {

/// Pixels of a thumbnail in each direction.
inline constexpr int kThumbnailPixels = 64;

/// Returns a small picture of a dataset as the bytes of a PNG, shaded and coloured by mean
/// curvature, on a transparent ground. It shows the level at a quarter of the levels, where noise
/// is gone and people still recognise the shape. It takes 1 to 3 kB. A large level is read in
/// full, which is most of the cost. Throws io::Error if the dataset cannot be read.
std::string thumbnail_of(const io::Dataset& dataset);

}  // namespace semigeo::jobs
