#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/parallel.hpp"
#include "tests/support/prepared_surface.hpp"

namespace semigeo::accuracy {

/// Tells how K or H of one vertex depends on the first direction of its patch. Each edge of the
/// vertex is the first direction once and gives a value k_i.
struct DirectionSpread {
  double mean = 0;     ///< Mean of k_i over the directions.
  double max = 0;      ///< Largest |mean - k_i|.
  double min = 0;      ///< Smallest |mean - k_i|.
  double average = 0;  ///< Mean of |mean - k_i|.
};

/// Holds the spreads of one vertex.
struct VertexSpread {
  std::array<DirectionSpread, 2> of;  ///< Spread of K, then of H.
  bool whole = false;                 ///< The patch is whole in every direction.
};

/// Returns the spreads of all vertices of a surface. `step` is the distance of samples, in the
/// units of the points. Source: thesis 6.2.1.
std::vector<VertexSpread> direction_spreads(const kernels::PreparedSurface& surface, float step,
                                            kernels::Coordinates coordinates,
                                            engine::Workers& workers);

/// Holds the errors of K or H over the vertices of a surface, in per cent.
struct DirectionErrors {
  /// Sums up one member of DirectionSpread over the vertices. The relative error of a vertex is
  /// that member over |DirectionSpread::mean|.
  struct Summary {
    double mean;            ///< Mean of the relative errors: the number that the thesis gives.
    double median;          ///< Median of the relative errors.
    double p95;             ///< 95th percentile of the relative errors.
    double surface_mean;    ///< Mean of the error over the median |curvature| of the surface.
    double surface_median;  ///< Median of the error over the median |curvature| of the surface.
  };
  Summary max, min, average;
  std::int64_t used = 0;       ///< Number of vertices that have a relative error.
  std::int64_t near_zero = 0;  ///< Number of vertices whose |mean| is too small to divide by.
  std::int64_t truncated = 0;  ///< Number of vertices whose patch is not whole in every direction.
};

/// Sums up the spreads of K (quantity 0) or H (quantity 1). A vertex is near zero where |mean| is
/// below `least` times the median |mean| of the surface.
DirectionErrors direction_errors(const std::vector<VertexSpread>& spreads, int quantity,
                                 double least);

}  // namespace semigeo::accuracy
