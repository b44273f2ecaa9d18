#pragma once

#include "jobs/stages/surface_parameters.hpp"

namespace semigeo::jobs {

/// Returns parameters of which none has its default value.
inline SurfaceParameters unusual_parameters() {
  return {.levels = 3,
          .depth_jump = 6.5,
          .weld = "0.5",
          .preparation = {.fill_holes = 40,
                          .decimate = 0.25,
                          .decimate_in_length_units = true,
                          .target_vertices = 1993},
          .evolution = {.curved = false,
                        .coordinates = kernels::Coordinates::kPolar,
                        .schedule = Schedule::kOctaves,
                        .rescale = Rescale::kEdges,
                        .remesh = false,
                        .principal = true,
                        .step_factor = 0.1},
          .features = {.radius = 0, .min_completeness = 0.75},
          .recognition_level = 2,
          .compression = io::Compression::kNone,
          .length_unit = "m\"m"};
}

}  // namespace semigeo::jobs
