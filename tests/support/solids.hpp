#pragma once

#include "kernels/surface/triangle_mesh.hpp"
#include "tests/support/isosurface.hpp"

/// Objects like those of the thesis' experiments (6.1): thick and thin where it matters, about
/// 1000 to 2000 vertices, closed, outwards.
namespace semigeo::shapes {

/// Union of the parts, their creases rounded by `blend`.
SignedDistance united(std::vector<SignedDistance> parts, double blend);
SignedDistance ball(const Eigen::Vector3d& centre, double radius);
SignedDistance capsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius);
/// Half extents include the rounding of the edges.
SignedDistance rounded_box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half,
                           double rounding);

/// Balls of radius 1 about x = +-2, joined by a bar of radius `bar`.
kernels::TriangleMesh dumbbell(double bar = 0.3);

/// Handset along x: ends of 0.8 x 1 x 0.7 about x = +-1.5, joined by a grip 0.25 thick.
kernels::TriangleMesh phone();

/// Seat in the plane z = 0, four legs below it, a back above y = -0.6 on two thin bars.
kernels::TriangleMesh chair();

/// Sphere of radius 1 with smooth bumps and dents of `height`.
kernels::TriangleMesh bumpy_sphere(int levels, double height);

}  // namespace semigeo::shapes
