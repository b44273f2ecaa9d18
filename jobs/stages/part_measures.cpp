#include "jobs/stages/part_measures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace semigeo::jobs {
namespace {

constexpr std::int64_t kFaceBlock = 8192;
/// The least credible volume, as a share of the cube of the mean radius (a ball has 4). A smaller
/// volume may be that of folds.
constexpr double kLeastVolume = 1e-3;

/// A sequence of consecutive faces that belong to one part.
struct Stretch {
  std::int32_t part;
  PartMeasure measure;
};

void add_face(const kernels::LevelMesh& mesh, std::int32_t f, double edge_limit, PartMeasure& sum) {
  const kernels::Connectivity& surface = mesh.connectivity;
  const auto& t = surface.triangles[f];
  const std::array<Eigen::Vector3d, 3> p = {mesh.point(t[0]), mesh.point(t[1]), mesh.point(t[2])};
  bool outlier = false;
  for (int i = 0; i < 3; ++i) {
    const std::int32_t h = kernels::halfedge(f, i);
    sum.boundary_edges += surface.twin[h] == kernels::kNone;
    const double length = (p[i == 2 ? 0 : i + 1] - p[i]).norm();
    const bool beyond = length > edge_limit;
    outlier |= beyond;
    // An edge is counted from one of its sides. There is no branch because it would be a random
    // one.
    const bool counted = !beyond & (surface.twin[h] <= h);
    sum.edge_length += static_cast<double>(counted) * length;
    sum.edges += counted;
  }
  const double twice_area = (p[1] - p[0]).cross(p[2] - p[0]).norm();
  const Eigen::Vector3d corners = p[0] + p[1] + p[2];
  sum.twice_area += twice_area;
  sum.moment += twice_area * corners;
  if (!outlier) {
    sum.corners += corners;
    sum.squared_corners += p[0].squaredNorm() + p[1].squaredNorm() + p[2].squaredNorm();
    sum.corner_count += 3;
  }
  sum.six_volumes += p[0].dot(p[1].cross(p[2]));
  ++sum.faces;
}

}  // namespace

PartMeasure& PartMeasure::operator+=(const PartMeasure& other) {
  edge_length += other.edge_length;
  edges += other.edges;
  twice_area += other.twice_area;
  moment += other.moment;
  corners += other.corners;
  squared_corners += other.squared_corners;
  corner_count += other.corner_count;
  six_volumes += other.six_volumes;
  boundary_edges += other.boundary_edges;
  faces += other.faces;
  return *this;
}

PartMeasure PartMeasure::scaled(double factor) const {
  PartMeasure result = *this;
  const Eigen::Vector3d centre = centroid();
  const double count = corner_count;
  result.edge_length *= factor;
  result.twice_area *= factor * factor;
  result.moment = 3 * result.twice_area * centre;
  const Eigen::Vector3d from_centre = corners - count * centre;
  result.corners = count * centre + factor * from_centre;
  const double squared_from_centre =
      squared_corners - 2 * centre.dot(corners) + count * centre.squaredNorm();
  result.squared_corners = count * centre.squaredNorm() + 2 * factor * centre.dot(from_centre) +
                           factor * factor * squared_from_centre;
  result.six_volumes *= factor * factor * factor;
  return result;
}

Eigen::Vector3d PartMeasure::centroid() const {
  if (!(twice_area > 0)) return Eigen::Vector3d::Zero();
  return moment / (3 * twice_area);
}

double PartMeasure::radius_of_gyration() const {
  if (corner_count == 0) return 0;
  const Eigen::Vector3d mean = corners / corner_count;
  return std::sqrt(std::max(0.0, squared_corners / corner_count - mean.squaredNorm()));
}

double PartMeasure::volume() const {
  const double volume = six_volumes / 6;
  const bool encloses = boundary_edges == 0 && corner_count == 3.0 * static_cast<double>(faces) &&
                        volume > kLeastVolume * std::pow(radius_of_gyration(), 3);
  return encloses ? volume : 0;
}

std::vector<PartMeasure> measure_parts(const kernels::LevelMesh& mesh, double edge_limit,
                                       const engine::RunContext& context) {
  const std::int64_t faces = mesh.connectivity.face_count();
  std::vector<std::vector<Stretch>> blocks((faces + kFaceBlock - 1) / kFaceBlock);
  const auto block_count = static_cast<std::int64_t>(blocks.size());
  context.workers.for_blocks(block_count, 1, [&](engine::IndexRange range) {
    for (auto b = range.begin; b < range.end; ++b) {
      const auto end = static_cast<std::int32_t>(std::min((b + 1) * kFaceBlock, faces));
      for (auto f = static_cast<std::int32_t>(b * kFaceBlock); f < end; ++f) {
        const std::int32_t part = mesh.part[mesh.connectivity.triangles[f][0]];
        if (blocks[b].empty() || blocks[b].back().part != part) blocks[b].push_back({part, {}});
        add_face(mesh, f, edge_limit, blocks[b].back().measure);
      }
    }
  });
  std::vector<PartMeasure> parts(mesh.part_count);
  for (const auto& block : blocks)
    for (const Stretch& stretch : block) parts[stretch.part] += stretch.measure;
  return parts;
}

double mean_edge_length(const std::vector<PartMeasure>& parts) {
  PartMeasure sum;
  for (const PartMeasure& part : parts) sum += part;
  return sum.mean_edge_length();
}

}  // namespace semigeo::jobs
