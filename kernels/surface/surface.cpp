#include "kernels/surface/surface.hpp"

#include "kernels/surface/circulators.hpp"

namespace semigeo::kernels {

void connect(Surface& surface) {
  choose_outgoing(surface, std::ssize(surface.points));
  surface.part_count = number_parts(surface, surface.part);
}

double mean_edge_length(const Surface& surface) {
  double sum = 0;
  std::int64_t count = 0;
  for (const std::int32_t h : edges(surface)) {
    const Eigen::Vector3d edge =
        (surface.points[surface.target(h)] - surface.points[surface.origin(h)]).cast<double>();
    sum += edge.norm();
    ++count;
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

}  // namespace semigeo::kernels
