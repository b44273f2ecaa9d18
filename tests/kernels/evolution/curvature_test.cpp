#include "kernels/evolution/curvature.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/graph_patch.hpp"

namespace semigeo::kernels {
namespace {

TEST(CurvatureTest, FormsGiveKAndHOfAGraph) {
  const Curvature c = curvature_from_forms(fit(quadratic_patch(-2, 0, -0.5f, 0.1f), 0.1f));
  EXPECT_NEAR(c.gaussian, 1, 1e-4);
  EXPECT_NEAR(c.mean, -1.25, 1e-4);
  EXPECT_NEAR(c.normal.z(), 1, 1e-6);
}

// A.2: K and H do not depend on how the surface is parametrised.
TEST(CurvatureTest, FormsAreInvariantUnderReparametrisation) {
  const PatchDerivatives d = fit(quadratic_patch(-2, 0.7f, -0.5f, 0.1f), 0.1f);
  PatchDerivatives skew = d;  // u' = u / 2, v' = v - 0.3 u, so r_u' = 2 (r_u + 0.3 r_v)
  skew.ru = 2 * (d.ru + 0.3f * d.rv);
  skew.ruu = 4 * (d.ruu + 0.6f * d.ruv + 0.09f * d.rvv);
  skew.ruv = 2 * (d.ruv + 0.3f * d.rvv);
  const Curvature a = curvature_from_forms(d), b = curvature_from_forms(skew);
  EXPECT_NEAR(a.gaussian, b.gaussian, 1e-4);
  EXPECT_NEAR(a.mean, b.mean, 1e-4);
}

// In orthonormal semigeodesic coordinates (4.9), (4.10) and A.2.2 agree.
TEST(CurvatureTest, SemigeodesicFormulasAgreeOnUnitCoordinates) {
  const PatchDerivatives d = fit(quadratic_patch(0.4f, 0.1f, -0.5f, 0.1f), 0.1f);
  EXPECT_NEAR(curvature_semigeodesic(d).gaussian, curvature_from_forms(d).gaussian, 1e-4);
  EXPECT_NEAR(curvature_semigeodesic(d).mean, curvature_from_forms(d).mean, 1e-4);
}

TEST(PrincipalCurvaturesTest, OfAGraphInAnyParametrisation) {
  const PatchDerivatives d = fit(quadratic_patch(-2, 0, -0.5f, 0.1f), 0.1f);
  PatchDerivatives skew = d;  // u' = u / 2, v' = v - 0.3 u
  skew.ru = 2 * (d.ru + 0.3f * d.rv);
  skew.ruu = 4 * (d.ruu + 0.6f * d.ruv + 0.09f * d.rvv);
  skew.ruv = 2 * (d.ruv + 0.3f * d.rvv);
  for (const PatchDerivatives& derivatives : {d, skew}) {
    const PrincipalCurvatures p = principal_curvatures(derivatives);
    EXPECT_NEAR(p.k1, -0.5, 1e-4);
    EXPECT_NEAR(p.k2, -2, 1e-4);
    EXPECT_NEAR(std::abs(p.first.y()), 1, 1e-4);
    EXPECT_NEAR(std::abs(p.second.x()), 1, 1e-4);
    EXPECT_NEAR(p.first.cross(p.second).z(), 1, 1e-5);
  }
}

TEST(PrincipalCurvaturesTest, AnUmbilicHasSomeOrthogonalPair) {
  const PrincipalCurvatures p = principal_curvatures(fit(quadratic_patch(-1, 0, -1, 0.1f), 0.1f));
  EXPECT_NEAR(p.k1, -1, 1e-4);
  EXPECT_NEAR(p.k2, -1, 1e-4);
  EXPECT_NEAR(p.first.norm(), 1, 1e-5);
  EXPECT_NEAR(p.first.dot(p.second), 0, 1e-5);
}

TEST(CurvatureTest, ParallelTangentsGiveZeroNotNan) {
  PatchDerivatives d{};
  d.ru = d.rv = {1, 0, 0};
  EXPECT_EQ(curvature_from_forms(d).gaussian, 0);
  EXPECT_TRUE(curvature_semigeodesic(d).normal.isZero(0));
  EXPECT_TRUE(principal_curvatures(d).first.isZero(0));
}

}  // namespace
}  // namespace semigeo::kernels
