#pragma once

#include <Eigen/Core>

#include "kernels/patch/patch_derivatives.hpp"

namespace semigeo::kernels {

/// K in length^-2, H in length^-1, negative where the surface is convex seen from outside (a sphere
/// of radius r has H = -1 / r), and the unit normal along r_u x r_v.
struct Curvature {
  float gaussian;
  float mean;
  Eigen::Vector3f normal;
};

/// From the first and second fundamental forms in full. All zero if r_u and r_v are parallel.
/// Source: thesis A.2, A.2.2.
Curvature curvature_from_forms(const PatchDerivatives& d);

/// For exact semigeodesic coordinates, E = 1 and F = 0. Source: thesis (4.9), (4.10).
Curvature curvature_semigeodesic(const PatchDerivatives& d);

/// Principal curvatures k1 >= k2 in length^-1, signed as H, and their unit directions: orthogonal,
/// tangent, each up to its sign; (first, second, normal) is right-handed. At an umbilic the
/// directions are any such pair. All zero if r_u and r_v are parallel.
struct PrincipalCurvatures {
  float k1 = 0;
  float k2 = 0;
  Eigen::Vector3f first = Eigen::Vector3f::Zero();
  Eigen::Vector3f second = Eigen::Vector3f::Zero();
};

/// Eigenvalues and eigenvectors of the shape operator. Source: thesis A.2.1, A.2.2. Differs: the
/// operator is written in an orthonormal basis of the tangent plane, where it is symmetric; the
/// quadratic equation of A.2.1 loses all digits near umbilics.
PrincipalCurvatures principal_curvatures(const PatchDerivatives& d);

}  // namespace semigeo::kernels
