#pragma once

#include "io/dataset/dataset.hpp"

namespace semigeo::jobs::cli {

/// Throws io::Error with a remedy if the dataset does not have the level.
void require_level(const io::Dataset& dataset, int level);

}  // namespace semigeo::jobs::cli
