#include "engine/resources.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace semigeo::engine {
namespace {

TEST(Resources, AdmitsWhatFits) {
  Resources resources({4, 100});
  EXPECT_TRUE(resources.admit({2, 50}));
  EXPECT_FALSE(resources.admit({3, 1}));   // too many cores
  EXPECT_FALSE(resources.admit({1, 51}));  // too many bytes
  EXPECT_TRUE(resources.admit({2, 50}));   // exactly what is left
  EXPECT_FALSE(resources.admit({1, 0}));
  EXPECT_FALSE(resources.admit({0, 1}));
  EXPECT_EQ(resources.running(), 2);
  resources.release({2, 50});
  EXPECT_TRUE(resources.admit({1, 0}));
}

TEST(Resources, WhatIsTooLargeRunsAlone) {
  for (const Amount large : {Amount{5, 1}, Amount{1, 101}, Amount{5, 101}}) {
    Resources resources({4, 100});
    ASSERT_TRUE(resources.admit({1, 1}));
    EXPECT_FALSE(resources.admit(large));
    resources.release({1, 1});
    EXPECT_TRUE(resources.admit(large));
    EXPECT_FALSE(resources.admit({0, 0}));
    EXPECT_FALSE(resources.admit(large));
    resources.release(large);
    EXPECT_TRUE(resources.admit({4, 100}));
  }
}

TEST(Resources, HugeRequestsDoNotOverflow) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  Resources resources({4, kMost});
  ASSERT_TRUE(resources.admit({1, kMost - 1}));
  EXPECT_FALSE(resources.admit({1, kMost}));
  EXPECT_FALSE(resources.admit({std::numeric_limits<int>::max(), 1}));
  EXPECT_TRUE(resources.admit({1, 1}));
}

TEST(Resources, NeverMoreThanThereIs) {
  Resources resources({8, 1000});
  std::mt19937 random(1);
  std::vector<Amount> running;
  int admitted = 0;
  for (int n = 0; n < 20'000; ++n) {
    const Amount wanted = {static_cast<int>(random() % 11), random() % 1200};
    if (resources.admit(wanted)) {
      running.push_back(wanted);
      ++admitted;
    } else {
      EXPECT_FALSE(running.empty());  // alone, everything is admitted
      const std::size_t one = random() % running.size();
      resources.release(running[one]);
      running.erase(running.begin() + one);
    }
    ASSERT_EQ(resources.running(), static_cast<int>(running.size()));
    if (running.size() > 1) {
      ASSERT_LE(resources.in_use().cores, 8);
      ASSERT_LE(resources.in_use().bytes, 1000u);
    }
  }
  EXPECT_GT(admitted, 5'000);
}

TEST(Resources, NothingIsReleasedTwice) {
  Resources resources({4, 100});
  EXPECT_THROW(resources.release({0, 0}), std::logic_error);
  ASSERT_TRUE(resources.admit({2, 50}));
  EXPECT_THROW(resources.release({3, 50}), std::logic_error);
  EXPECT_THROW(resources.release({2, 51}), std::logic_error);
  resources.release({2, 50});
  EXPECT_THROW(resources.release({2, 50}), std::logic_error);
  EXPECT_THROW(resources.admit({-1, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace semigeo::engine
