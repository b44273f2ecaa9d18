#pragma once

#include <cstdint>
#include <filesystem>

#include "kernels/surface/surface.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::bench {

/// Vertices of `shapes::icosphere(subdivisions)`.
constexpr std::int64_t icosphere_vertices(std::int64_t subdivisions) {
  return 10 * (std::int64_t{1} << (2 * subdivisions)) + 2;
}

/// A real scan: what SEMIGEO_BENCH_SCAN names, or the skull next to the repository; empty if the
/// file does not exist.
std::filesystem::path real_scan();

/// Built and reordered as the surface job does.
kernels::Surface prepared(kernels::TriangleMesh mesh);

}  // namespace semigeo::bench
