#include "kernels/surface/radix_sort.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace semigeo::kernels {
namespace {

TEST(RadixSort, SortsByItsBitsAndKeepsTheOrderOfTheRest) {
  std::mt19937_64 random(1);
  for (const std::size_t count : {0, 1, 2, 1000, 5000})
    for (const auto& [first, last] : {std::pair(0, 64), {0, 11}, {5, 6}, {32, 62}, {7, 7}}) {
      std::vector<std::uint64_t> keys(count);
      for (std::uint64_t& key : keys) key = random();
      std::vector<std::uint64_t> expected = keys;
      std::ranges::stable_sort(expected, {}, [&](std::uint64_t key) {
        return last == 64 ? key >> first : key % (std::uint64_t{1} << last) >> first;
      });
      radix_sort(keys, first, last);
      EXPECT_EQ(keys, expected) << count << " keys by the bits " << first << " to " << last;
    }
}

}  // namespace
}  // namespace semigeo::kernels
