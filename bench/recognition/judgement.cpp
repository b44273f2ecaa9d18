#include "bench/recognition/judgement.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "bench/support/chance.hpp"
#include "bench/support/mesh_changes.hpp"
#include "kernels/surface/bounding_box.hpp"

namespace semigeo::recognition {
namespace {

/// The number of vertices of a model from which the mean distance of its surface is computed.
constexpr std::size_t kVertices = 500;

}  // namespace

PoseError pose_error(const BenchModel& model, const kernels::Similarity& found,
                     const kernels::Similarity& truth) {
  PoseError error;
  const double size = truth.scale * model.diagonal;
  const auto away = [&](const Eigen::Vector3d& p) {
    return (found.apply(p) - truth.apply(p)).norm() / size;
  };
  error.degrees = Eigen::AngleAxisd(found.rotation * truth.rotation.transpose()).angle() * 180 /
                  std::numbers::pi;
  error.scale = std::abs(found.scale / truth.scale - 1);
  error.centre = away(model.centre);
  const Eigen::AlignedBox3d box = kernels::bounding_box(model.mesh.points);
  error.box = 0;
  for (int corner = 0; corner < 8; ++corner)
    error.box =
        std::max(error.box, away(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner))));
  double sum = 0;
  std::int64_t count = 0;
  const std::size_t step = std::max<std::size_t>(1, model.mesh.points.size() / kVertices);
  for (std::size_t v = 0; v < model.mesh.points.size(); v += step, ++count)
    sum += model.nearest
               ->nearest(bench::undo(truth, found.apply(model.mesh.points[v])) - model.built.origin)
               .distance;
  error.surface = sum / static_cast<double>(count) / model.diagonal;
  return error;
}

bool right(const PoseError& error) {
  if (!(error.scale <= kMaxScale)) return false;
  return (error.degrees <= kMaxDegrees && error.centre <= kMaxCentre) ||
         error.surface <= kMaxSurface;
}

}  // namespace semigeo::recognition
