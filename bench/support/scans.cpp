#include "bench/support/scans.hpp"

#include <cstdlib>
#include <utility>

#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/vertex_order.hpp"

namespace semigeo::bench {

std::filesystem::path real_scan() {
  const char* named = std::getenv("SEMIGEO_BENCH_SCAN");
  const std::filesystem::path path = named != nullptr ? named : SEMIGEO_BENCH_DEFAULT_SCAN;
  return std::filesystem::exists(path) ? path.lexically_normal() : std::filesystem::path();
}

kernels::Surface prepared(kernels::TriangleMesh mesh) {
  const kernels::Surface built = kernels::build_surface(std::move(mesh)).surface;
  return kernels::reordered(built, kernels::locality_order(built));
}

}  // namespace semigeo::bench
