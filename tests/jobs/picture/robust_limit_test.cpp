#include "jobs/picture/robust_limit.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace semigeo::jobs {
namespace {

TEST(RobustLimitTest, IsThe98thPercentileOfTheValidValues) {
  std::vector<float> values;
  for (int i = 0; i <= 100; ++i) values.push_back(static_cast<float>(i % 2 == 0 ? i : -i));
  values.push_back(1e30f);  // not valid
  values.push_back(std::numeric_limits<float>::infinity());
  std::vector<float> completeness(values.size(), 1);
  completeness[101] = 0;
  const std::vector<FieldValues> fields = {{values, completeness}};
  EXPECT_EQ(robust_limit(fields), 98);
}

TEST(RobustLimitTest, TakesAllFieldsTogether) {
  const std::vector<float> small(50, 1.0f);
  const std::vector<float> large(50, -3.0f);
  const std::vector<float> valid(50, 0.5f);
  EXPECT_EQ(robust_limit(std::vector<FieldValues>{{small, valid}}), 1);
  EXPECT_EQ(robust_limit(std::vector<FieldValues>{{small, valid}, {large, valid}}), 3);
}

TEST(RobustLimitTest, IsZeroWithoutValidValues) {
  const std::vector<float> values = {1, 2};
  const std::vector<float> completeness = {0, 0};
  EXPECT_EQ(robust_limit(std::vector<FieldValues>{{values, completeness}}), 0);
  EXPECT_EQ(robust_limit({}), 0);
}

}  // namespace
}  // namespace semigeo::jobs
