#pragma once

#include <span>

namespace semigeo::jobs {

/// A field of a surface, and where it is valid.
struct FieldValues {
  std::span<const float> values;        ///< (N)
  std::span<const float> completeness;  ///< (N) Values are valid where it is above 0.
};

/// Returns the end of a scale of colours that is symmetric about zero: the 98th percentile of
/// |value| over the valid vertices of all fields together; 0 if there are none. So a few wild
/// values do not make all others pale.
float robust_limit(std::span<const FieldValues> fields);

}  // namespace semigeo::jobs
