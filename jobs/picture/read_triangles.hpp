#pragma once

#include <cstdint>
#include <vector>

#include "io/dataset/dataset.hpp"

namespace semigeo::jobs {

/// Returns the corners of the triangles of a level, three for each. Throws io::Error if the dataset
/// cannot be read, or if a corner is none of `vertices` vertices.
std::vector<std::int64_t> read_triangles(const io::Dataset& dataset, int level,
                                         std::size_t vertices);

}  // namespace semigeo::jobs
