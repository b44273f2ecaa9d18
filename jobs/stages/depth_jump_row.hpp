#pragma once

#include "jobs/stages/parameter.hpp"
#include "kernels/repair/range_grid.hpp"

namespace semigeo::jobs {

/// Returns the row for where the triangles of a range grid end. JSON does not have the default, so
/// the keys of all that is not made with another value are what they would be without the row.
template <typename Owner>
Parameter<Owner> depth_jump_row(Field<Owner, double> field) {
  return {.key = "depth_jump",
          .name = "depth-jump",
          .help =
              "Range grids: no triangle has an edge longer than so many times the spacing of\n"
              "the grid there; it would join two surfaces, one before the other",
          .value = NumberIn<Owner, double>{field, 1, 1e6},
          .default_in_json = false};
}

}  // namespace semigeo::jobs
