#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/surface/triangle_mesh.hpp"

/// Surfaces whose curvature is known at every point, and triangulations of them that keep it.
namespace semigeo::shapes {

/// A point of a surface and all that is true there.
struct SurfacePoint {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;  ///< unit, outwards
  double gaussian;         ///< K
  double mean;             ///< H, negative where convex seen from outside
};

/// Where the parameters of a surface live.
enum class Domain {
  kSphere,    ///< A vector of any length, which stands for its direction.
  kTorus,     ///< (s, t, 0) with period 1 in both.
  kCylinder,  ///< (s, t, 0) with period 1 in s, and t in [0, 1].
  kSquare     ///< (s, t, 0) in [0, 1]^2.
};

struct AnalyticSurface {
  std::string name;
  Domain domain;
  SurfacePoint (*at)(const Eigen::Vector3d& parameters);

  bool open() const { return domain == Domain::kCylinder || domain == Domain::kSquare; }
};

/// Sphere, ellipsoid (1, 0.7, 0.5), torus (R = 1, r = 0.4), cylinder, saddle z = (x^2 - y^2) / 2
/// over [-1, 1]^2, Enneper's minimal surface over [-0.8, 0.8]^2.
std::span<const AnalyticSurface> analytic_surfaces();

enum class Tessellation {
  kEven,    ///< A subdivided icosahedron, or a grid in the parameters.
  kUneven,  ///< The even mesh, smoothly warped so that edges differ by a factor of about 4.
  kRagged,  ///< The even mesh, every vertex moved at random by up to 0.3 edges both ways.
  kNeedles  ///< Edges 50 times shorter than others, and vertices with 30 neighbours.
};

const char* name_of(Tessellation tessellation);

/// A triangulation with the truth of each of its vertices.
struct AnalyticMesh {
  kernels::TriangleMesh mesh;
  std::vector<SurfacePoint> truth;
};

/// About `vertices` vertices, exactly on the surface. Spherical domains have 10 * 4^n + 2.
AnalyticMesh tessellate(const AnalyticSurface& surface, Tessellation tessellation, int vertices);

/// Mean length of all edges of a mesh, each counted once.
double mean_edge_length(const kernels::TriangleMesh& mesh);

/// Moves every vertex along its normal by Gaussian noise of this sigma. Same seed, same noise.
void add_normal_noise(AnalyticMesh& mesh, double sigma, std::uint64_t seed);

}  // namespace semigeo::shapes
