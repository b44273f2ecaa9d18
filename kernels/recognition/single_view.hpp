#pragma once

#include <Eigen/Core>
#include <optional>

#include "kernels/recognition/recognition_model.hpp"

namespace semigeo::kernels {

/// Returns the place that a surface was seen from, if its normals tell that it was scanned from one
/// place. At least 99 % of the normals must face the place: it is the origin of the file's
/// coordinates, where many scanners stand, or else it lies far away, where the mean normal points.
/// A surface without a rim was not scanned from one place. The result is in the coordinates of the
/// samples.
std::optional<Eigen::Vector3d> eye_of_view(const RecognitionModel& scene);

}  // namespace semigeo::kernels
