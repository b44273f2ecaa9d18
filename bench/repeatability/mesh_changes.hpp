#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>

#include "kernels/recognition/similarity.hpp"
#include "kernels/surface/surface.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::repeatability {

enum class Digitising {
  as_is,
  decimated,  ///< quadric decimation: fewer vertices where the surface is flat
  resampled   ///< a new mesh of equal edges and about as many vertices
};

/// What is done to a mesh before its features are looked for again, in this order.
struct Case {
  const char* name;
  Digitising digitising = Digitising::as_is;
  bool cut = false;    ///< half of it
  bool noise = false;  ///< in every coordinate
  bool moved = true;   ///< rotated, scaled and shifted
};
std::span<const Case> all_cases();

struct ChangeOptions {
  double vertices_left = 0.6;  ///< share that decimation leaves
  double noise = 0.15;  ///< sigma a coordinate, in mean edge lengths of the mesh as it is then
  std::uint64_t seed = 1;
};

struct ChangedMesh {
  kernels::TriangleMesh mesh;
  kernels::Similarity similarity;  ///< from the original to `mesh`
  double area = 0;                 ///< before noise, in the original's units
  /// In the original's frame: what lies on its negative side is cut away.
  std::optional<Eigen::Hyperplane<double, 3>> cut;
};

/// Changes one surface in many ways. All chance comes from the seed, so that results repeat, and
/// every mesh meets the same chances; cuts are the same in every case.
class MeshChanger {
 public:
  /// Keeps a reference to the original.
  MeshChanger(const kernels::Surface& original, const ChangeOptions& options);

  /// Throws std::runtime_error if OpenMesh cannot hold the surface.
  ChangedMesh changed(const Case& change);

 private:
  const kernels::TriangleMesh& digitised(Digitising digitising);

  const kernels::Surface& original_;
  ChangeOptions options_;
  kernels::TriangleMesh as_is_;
  std::optional<kernels::TriangleMesh> decimated_;
  std::optional<kernels::TriangleMesh> resampled_;
};

}  // namespace semigeo::repeatability
