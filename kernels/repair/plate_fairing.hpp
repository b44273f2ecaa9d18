#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// What fairing may do with a vertex.
enum class PlateRole : std::uint8_t {
  kHeld,  ///< The vertex stays.
  kTied,  ///< The vertex moves, but is drawn to where it was.
  kFree   ///< The vertex moves.
};

/// Moves vertices of a mesh to where the sum of the squared Laplacians at tied and free vertices is
/// least: a thin plate, clamped to the held ones. Ties are as stiff as the plate at waves of
/// `wave_length`: shorter ones (noise) are smoothed away, longer ones (shape) kept. The faces round
/// a tied or free vertex must be a closed fan. Weights are cotangents of the triangles as they are
/// in `points`, kept positive, so a second call is better where the first changed the shape much;
/// ties draw towards `targets`. False, and nothing moved, if the equations cannot be solved or a
/// vertex would move farther than three times the radius of the mesh from its centroid. Cost: one
/// sparse factorisation.
bool fair_plate(std::vector<Eigen::Vector3d>& points, std::span<const Eigen::Vector3d> targets,
                std::span<const PlateRole> roles, std::span<const Triangle> triangles,
                double wave_length);

}  // namespace semigeo::kernels
