#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// Tells what fairing may do with a vertex.
enum class PlateRole : std::uint8_t {
  kHeld,  ///< The vertex stays.
  kTied,  ///< The vertex moves, but is drawn to where it was.
  kFree   ///< The vertex moves.
};

/// Moves vertices of a mesh to where the sum of the squared Laplacians at tied and free vertices is
/// least: to where a thin plate would lie that is clamped to the held vertices. Ties draw towards
/// `targets`. They are as stiff as the plate at waves of `wave_length`: shorter waves (noise) are
/// smoothed away, longer ones (shape) are kept. The faces round a tied or free vertex must be a
/// closed fan. Weights are the cotangents of the triangles as they are in `points`, kept positive;
/// where one call has changed the shape much, a second one is better. Returns false, and moves
/// nothing, if the equations cannot be solved or a vertex would move farther than three times the
/// radius of the mesh from its centroid. The cost is one sparse factorisation.
bool fair_plate(std::vector<Eigen::Vector3d>& points, std::span<const Eigen::Vector3d> targets,
                std::span<const PlateRole> roles, std::span<const Triangle> triangles,
                double wave_length);

}  // namespace semigeo::kernels
