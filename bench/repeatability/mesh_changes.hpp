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

/// The meshes that can be made of one surface.
enum class Digitising {
  kAsIs,       ///< The mesh itself.
  kDecimated,  ///< Quadric decimation leaves fewer vertices where the surface is flat.
  kResampled   ///< A new mesh has equal edges and about as many vertices.
};

/// Says what is done to a mesh before its features are looked for again. The changes are made in
/// the order of the fields.
struct Case {
  const char* name;
  Digitising digitising = Digitising::kAsIs;
  bool cut = false;    ///< Half of the mesh is cut away.
  bool noise = false;  ///< Noise is added to every coordinate.
  bool moved = true;   ///< The mesh is rotated, scaled and shifted.
};
/// Returns all cases.
std::span<const Case> all_cases();

/// Says how much a mesh is changed.
struct ChangeOptions {
  double vertices_left = 0.6;  ///< Share of the vertices that decimation leaves.
  double noise = 0.15;     ///< Sigma of the noise in each coordinate, in mean edge lengths then.
  std::uint64_t seed = 1;  ///< Seed of all random choices.
};

/// Holds a mesh after its changes.
struct ChangedMesh {
  kernels::TriangleMesh mesh;
  kernels::Similarity similarity;  ///< Leads from the original to `mesh`.
  double area = 0;                 ///< Area before noise was added, in the original's units.
  /// The plane of the cut, in the original's frame. Its negative side is cut away.
  std::optional<Eigen::Hyperplane<double, 3>> cut;
};

/// Changes one surface in many ways. The same seed gives the same changes, and the plane of the cut
/// is the same in every case.
class MeshChanger {
 public:
  /// Begins with a surface, and keeps a reference to it.
  MeshChanger(const kernels::Surface& original, const ChangeOptions& options);

  /// Returns the mesh after the changes of a case. Throws std::runtime_error if OpenMesh cannot
  /// hold the surface.
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
