#include "jobs/archive/in_children.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace semigeo::jobs {
namespace {

/// Runs three pieces of work that need this memory, on two cores, with memory of 10 bytes. Returns
/// how many had begun when the first had ended.
std::size_t begun_before_the_first_end(std::uint64_t bytes) {
  std::size_t begun = 0;
  std::size_t asked_for_first = 0;
  std::size_t result = 0;
  const auto results = in_children(
      3, {.cores = 2, .bytes = 10}, [](std::size_t i) { return std::to_string(i); },
      [&](std::size_t) {
        ++begun;
        return 60.0;
      },
      [&](std::size_t i) {
        // It is asked for when the work begins, and when it has ended.
        if (i == 0 && ++asked_for_first == 2) result = begun;
        return bytes;
      });
  EXPECT_EQ(results.size(), 3u);
  for (std::size_t i = 0; i < results.size(); ++i) EXPECT_EQ(results[i].text, std::to_string(i));
  EXPECT_EQ(begun, 3u);
  return result;
}

TEST(InChildrenTest, AsManyRunAsThereAreCoresAndMemoryFor) {
  EXPECT_EQ(begun_before_the_first_end(1), 2u);
  EXPECT_EQ(begun_before_the_first_end(5), 2u);
  EXPECT_EQ(begun_before_the_first_end(6), 1u);
}

TEST(InChildrenTest, WhatNeedsMoreThanThereIsRunsAlone) {
  EXPECT_EQ(begun_before_the_first_end(11), 1u);
  EXPECT_EQ(begun_before_the_first_end(std::numeric_limits<std::uint64_t>::max()), 1u);
}

}  // namespace
}  // namespace semigeo::jobs
