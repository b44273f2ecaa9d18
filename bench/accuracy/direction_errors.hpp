#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/parallel.hpp"
#include "tests/support/prepared_surface.hpp"

namespace semigeo::accuracy {

/// Of one vertex: what its curvature says when each of its edges in turn is the first direction.
struct DirectionSpread {
  double mean = 0;  ///< over the directions
  double max = 0;   ///< of |mean - k_i|
  double min = 0;
  double average = 0;
};

/// K and H of one vertex; `whole` if the patch is whole in every direction.
struct VertexSpread {
  std::array<DirectionSpread, 2> of;
  bool whole = false;
};

/// Every vertex of the surface. Source: thesis 6.2.1.
std::vector<VertexSpread> direction_spreads(const kernels::PreparedSurface& surface, float step,
                                            kernels::Coordinates coordinates,
                                            engine::Workers& workers);

/// Errors in per cent over the vertices, one for each way to sum up a vertex' directions.
struct DirectionErrors {
  struct Summary {
    double mean;    ///< over the vertices of error / |mean over directions|: the thesis' figure
    double median;  ///< of the same
    double p95;
    double surface_mean;  ///< over all whole vertices of error / median |curvature| of the surface
    double surface_median;  ///< of the same
  };
  Summary max, min, average;
  std::int64_t used = 0;
  std::int64_t near_zero = 0;  ///< left out: |mean over directions| is too small to divide by
  std::int64_t truncated = 0;  ///< left out: the patch is not whole in every direction
};

/// Of K (quantity 0) or H (1). A vertex is near zero where |mean| is below `least` times the median
/// |mean| of the surface.
DirectionErrors direction_errors(const std::vector<VertexSpread>& spreads, int quantity,
                                 double least);

}  // namespace semigeo::accuracy
