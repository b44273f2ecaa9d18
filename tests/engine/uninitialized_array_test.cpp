#include "engine/uninitialized_array.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <span>

namespace semigeo::engine {
namespace {

TEST(UninitializedArrayTest, IsEmptyAtFirst) {
  const UninitializedArray<int> array;
  EXPECT_EQ(array.size(), 0U);
  EXPECT_EQ(array.begin(), array.end());
}

TEST(UninitializedArrayTest, HoldsWhatIsWritten) {
  UninitializedArray<int> array;
  array.resize(1000);
  std::iota(array.begin(), array.end(), 0);
  EXPECT_EQ(std::accumulate(array.begin(), array.end(), 0), 499500);
  array[7] = 0;
  EXPECT_EQ(std::span<const int>(array.begin(), array.end())[7], 0);
}

TEST(UninitializedArrayTest, KeepsItsMemoryUntilMoreIsNeeded) {
  UninitializedArray<int> array;
  array.resize(1000);
  const int* const first = array.begin();
  array.resize(10);
  EXPECT_EQ(array.size(), 10U);
  array.resize(1000);
  EXPECT_EQ(array.begin(), first);
  array.resize(100000);
  EXPECT_EQ(array.size(), 100000U);
  array[99999] = 1;
}

TEST(UninitializedArrayTest, CopiesAreIndependent) {
  UninitializedArray<int> array;
  array.resize(3);
  std::iota(array.begin(), array.end(), 0);
  UninitializedArray<int> copy = array;
  copy[0] = 7;
  EXPECT_EQ(array[0], 0);
  array = copy;
  EXPECT_EQ(array[0], 7);
  EXPECT_EQ(array[2], 2);
}

TEST(UninitializedArrayTest, KeepsTheAlignmentOfItsValues) {
  struct alignas(64) Line {
    float numbers[16];
  };
  UninitializedArray<Line> lines;
  lines.resize(3);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(lines.begin()) % 64, 0U);
}

}  // namespace
}  // namespace semigeo::engine
