#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/run_context.hpp"
#include "kernels/repair/hole_filling.hpp"
#include "kernels/surface/nearest_surface.hpp"

namespace semigeo::jobs {

/// Says what is done to a repaired scan before it is smoothed. By default nothing is done.
struct PreparationOptions {
  std::int64_t fill_holes = 0;            ///< Most edges of a hole that is filled; 0: none is.
  double decimate = 0;                    ///< Tolerance of the decimation; 0: none.
  bool decimate_in_length_units = false;  ///< The unit of `decimate`; otherwise mean edge lengths.
  std::int64_t target_vertices = 0;  ///< Number of vertices at which decimation ends; 0: no limit.

  bool decimates() const { return decimate > 0 || target_vertices > 0; }
  bool any() const { return fill_holes > 0 || decimates(); }
};

/// Counts what was done to a scan.
struct PreparationResult {
  kernels::HoleCounts holes;
  std::int64_t filled_vertices = 0;  ///< Vertices that filling made and decimation left.
  std::int64_t filled_faces = 0;
  std::int64_t removed_vertices = 0;
  std::int64_t removed_faces = 0;
  double tolerance = 0;               ///< Tolerance in length units; 0: only a target.
  kernels::DistanceSummary distance;  ///< From vertices before the decimation to what is left.

  bool operator==(const PreparationResult&) const = default;
};

/// Returns the counts of the steps that the options ask for as JSON with sorted keys. The object is
/// empty if they ask for none.
nlohmann::json json_of(const PreparationResult& result, const PreparationOptions& options);

/// A prepared surface and what was done to it.
struct PreparedSurface {
  kernels::Surface surface;
  std::vector<std::uint8_t> vertex_filled;  ///< (N) 1 = made by filling; empty without filling.
  std::vector<std::uint8_t> face_filled;    ///< (F)
  PreparationResult result;
};

/// Fills holes, then decimates, and returns the result. A face of the decimated
/// surface counts as filled if the face nearest to its centroid was filled. The result does not
/// depend on the number of threads. Source: thesis 5.1.
PreparedSurface prepare_surface(kernels::Surface surface, const PreparationOptions& options,
                                const engine::RunContext& context);

}  // namespace semigeo::jobs
