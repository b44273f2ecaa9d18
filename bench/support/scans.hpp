#pragma once

#include <cstdint>
#include <filesystem>

#include "kernels/surface/surface.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::bench {

/// Returns the number of vertices of `shapes::icosphere(subdivisions)`.
constexpr std::int64_t icosphere_vertices(std::int64_t subdivisions) {
  return 10 * (std::int64_t{1} << (2 * subdivisions)) + 2;
}

/// Returns the path of a real scan: the one that SEMIGEO_BENCH_SCAN names, or the skull beside the
/// repository. It is empty if the file does not exist.
std::filesystem::path real_scan();

/// Returns a surface that was built and reordered as a surface job does it.
kernels::Surface prepared(kernels::TriangleMesh mesh);

}  // namespace semigeo::bench
