#include "kernels/surface/vertex_rows.hpp"

#include <gtest/gtest.h>

#include <string>

namespace semigeo::kernels {
namespace {

TEST(VertexRowsTest, RowsAreGatheredAndMayBeLeftOutOrRepeated) {
  const std::vector<double> values = {1, 2, 3};
  EXPECT_EQ(gathered(values, {2, 0}), (std::vector<double>{3, 1}));
  EXPECT_EQ(gathered(values, {1, 1, 1, 0}), (std::vector<double>{2, 2, 2, 1}));
}

TEST(VertexRowsTest, AllArraysChangeAlike) {
  std::vector<int> numbers = {1, 2, 3};
  std::vector<std::string> names = {"a", "b", "c"};
  gather_rows(std::tie(numbers, names), {2, 0, 1});
  EXPECT_EQ(numbers, (std::vector<int>{3, 1, 2}));
  EXPECT_EQ(names, (std::vector<std::string>{"c", "a", "b"}));
  append_row_copy(std::tie(numbers, names), 1);
  EXPECT_EQ(numbers, (std::vector<int>{3, 1, 2, 1}));
  EXPECT_EQ(names, (std::vector<std::string>{"c", "a", "b", "a"}));
}

TEST(VertexRowsTest, AnArrayThatIsNotKeptStaysEmpty) {
  std::vector<int> kept = {1, 2};
  std::vector<int> missing;
  gather_rows(std::tie(kept, missing), {1});
  append_row_copy(std::tie(kept, missing), 0);
  EXPECT_EQ(kept, (std::vector<int>{2, 2}));
  EXPECT_TRUE(missing.empty());
}

}  // namespace
}  // namespace semigeo::kernels
