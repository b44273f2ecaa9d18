#include "jobs/picture/curvature_unit.hpp"

#include <gtest/gtest.h>

namespace semigeo::jobs {
namespace {

TEST(CurvatureUnitTest, IsThatOfTheReciprocalLength) {
  EXPECT_EQ(curvature_units("mm").mean, "1/mm");
  EXPECT_EQ(curvature_units("mm").gaussian, "1/mm\u00b2");
  EXPECT_EQ(curvature_units("unknown").gaussian, "1/unit\u00b2");
  EXPECT_EQ(curvature_units("m\n").mean, "1/m\\n");
}

}  // namespace
}  // namespace semigeo::jobs
