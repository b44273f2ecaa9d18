#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "io/dataset/dataset.hpp"
#include "kernels/surface/surface.hpp"

namespace semigeo::jobs {

/// A surface as a page shows it.
struct ShownSurface {
  std::vector<Eigen::Vector3f> points;
  std::vector<kernels::Triangle> triangles;
  /// Number of each vertex before decimation; empty if no vertex was removed.
  std::vector<std::int32_t> rows = {};
};

/// The greatest number of vertices of a shown surface: the corners of its triangles have 16 bits.
inline constexpr std::int64_t kMostShownVertices = 65536;

/// Reads the points and triangles of a level. Throws io::Error if they cannot be read, or if a
/// triangle has a corner that is no vertex.
ShownSurface read_shown_surface(const io::Dataset& dataset, int level);

/// Returns the surface with at most `vertices` vertices. Vertices are removed and none is moved: if
/// there are many, quickly (kernels::coarsen) until four times as many are left as may be, and then
/// by kernels::decimate, which keeps the shape. The cost is about 1 us for each vertex, and 3 us
/// for each of four times `vertices`.
ShownSurface decimated(ShownSurface surface, std::int64_t vertices);

/// Returns the surface with its connectivity.
kernels::Surface connected(ShownSurface surface);

/// A cube that holds points. It has one size, so that fractions of it keep proportions.
struct ShownBox {
  Eigen::Vector3f low = Eigen::Vector3f::Zero();
  float size = 0;
};

/// Returns the smallest box of the points whose lowest corner is theirs.
ShownBox box_of(const std::vector<Eigen::Vector3f>& points);

/// Returns the points as 16-bit fractions of the box, three for each.
std::vector<std::uint16_t> fractions(const std::vector<Eigen::Vector3f>& points,
                                     const ShownBox& box);

/// Adds the surface to an object: its box as `low` and `size`, `shown_vertices`, and `points`,
/// `rows` and `triangles` as base64 of little-endian numbers.
void add_surface(nlohmann::json& json, const ShownSurface& surface, const ShownBox& box);

}  // namespace semigeo::jobs
