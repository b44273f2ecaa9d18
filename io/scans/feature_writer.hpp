#pragma once

#include <array>
#include <filesystem>
#include <span>

#include "kernels/features/features.hpp"

namespace semigeo::io {

/// A view of features of one kind in somebody else's memory.
struct FeaturesView {
  kernels::FeatureKind kind = kernels::FeatureKind::kGaussian;
  std::span<const kernels::Feature> features;
};

// These functions write binary little-endian PLY, or CSV with a line of names and the shortest
// decimals that read back as the same numbers. `origin` is added to positions, which are doubles if
// it is not zero, and floats otherwise. A file appears whole or not at all. They throw Error if the
// disk fails, or if a PLY would need more than 32 bits to count something.

/// Writes one table after the other, a vertex or line for each feature: x y z, nx ny nz, value,
/// prominence, scale_free_gaussian, scale_free_mean, initial_x initial_y initial_z, kind (PLY: the
/// number of the FeatureKind, CSV: its name), vertex.
void write_features_ply(const std::filesystem::path& path, std::span<const FeaturesView> tables,
                        const std::array<double, 3>& origin);
void write_features_csv(const std::filesystem::path& path, std::span<const FeaturesView> tables,
                        const std::array<double, 3>& origin);

/// Writes a vertex or line for each point: x y z, torsion, contour (from 0 on), closed (1 or 0).
/// The PLY has an edge (vertex1 vertex2) from each point to the next, and on closed contours also
/// from the last to the first. Throws std::invalid_argument if the arrays do not fit each other.
void write_contours_ply(const std::filesystem::path& path, const kernels::SampledContours& contours,
                        const std::array<double, 3>& origin);
void write_contours_csv(const std::filesystem::path& path, const kernels::SampledContours& contours,
                        const std::array<double, 3>& origin);

}  // namespace semigeo::io
