#pragma once

#include <Eigen/Core>

#include "kernels/patch/patch_derivatives.hpp"

namespace semigeo::kernels {

/// Holds the curvature of a surface at a point. H is negative where the surface is convex seen from
/// outside: a sphere of radius r has H = -1 / r.
struct Curvature {
  float gaussian;          ///< K, in length^-2.
  float mean;              ///< H, in length^-1.
  Eigen::Vector3f normal;  ///< Of unit length, along r_u x r_v.
};

/// Returns the curvature by the full first and second fundamental forms. All is zero if r_u and r_v
/// are parallel. Source: thesis A.2, A.2.2.
Curvature curvature_from_forms(const PatchDerivatives& d);

/// Returns the curvature for exact semigeodesic coordinates, where E = 1 and F = 0. Source: thesis
/// (4.9), (4.10).
Curvature curvature_semigeodesic(const PatchDerivatives& d);

/// Holds the principal curvatures k1 >= k2, signed as H, and their directions. These are orthogonal
/// unit tangents, each up to its sign; (first, second, normal) is right-handed. At an umbilic they
/// are any such pair.
struct PrincipalCurvatures {
  float k1 = 0;  ///< In length^-1.
  float k2 = 0;  ///< In length^-1.
  Eigen::Vector3f first = Eigen::Vector3f::Zero();
  Eigen::Vector3f second = Eigen::Vector3f::Zero();
};

/// Returns the eigenvalues and eigenvectors of the shape operator. All is zero if r_u and r_v are
/// parallel. Source: thesis A.2.1, A.2.2. Differs: the operator is written in an orthonormal basis
/// of the tangent plane, where it is symmetric; the quadratic equation of A.2.1 loses all digits
/// near umbilics.
PrincipalCurvatures principal_curvatures(const PatchDerivatives& d);

}  // namespace semigeo::kernels
