#include "jobs/bench/bound.hpp"

#include <gtest/gtest.h>

namespace semigeo::jobs {
namespace {

TEST(BoundTest, OneBusyThreadComputesUnlessMemoryIsAtItsLimit) {
  EXPECT_EQ(bound_of({.busy = 0.99, .memory = 0.05}), Bound::kArithmetic);
  EXPECT_EQ(bound_of({.busy = 0.99, .memory = 0.7}), Bound::kMemory);
  EXPECT_EQ(bound_of({.busy = 0.99, .memory = 0.3}), Bound::kUnclear);
  EXPECT_EQ(bound_of({.busy = 0.99}), Bound::kUnclear);
}

TEST(BoundTest, OneWaitingThreadWaitsForTheDiskIfItUsesIt) {
  EXPECT_EQ(bound_of({.busy = 0.3, .used_disk = true}), Bound::kDisk);
  EXPECT_EQ(bound_of({.busy = 0.3}), Bound::kUnclear);
}

TEST(BoundTest, WhatGrowsWithTheThreadsIsBoundByCores) {
  EXPECT_EQ(bound_of({.threads = 4, .busy = 3.9, .speedup = 3.6, .memory = 0.6}), Bound::kCores);
  EXPECT_EQ(bound_of({.threads = 4, .busy = 3.9, .speedup = 2, .memory = 0.6}), Bound::kMemory);
  EXPECT_EQ(bound_of({.threads = 4, .busy = 3.9, .speedup = 2}), Bound::kUnclear);
}

TEST(BoundTest, IdleThreadsWaitForALockOrHaveNothingToDo) {
  EXPECT_EQ(bound_of({.threads = 4, .busy = 1.5, .speedup = 1.4, .locked = 0.8}), Bound::kLock);
  EXPECT_EQ(bound_of({.threads = 4, .busy = 1.02, .speedup = 1}), Bound::kOneCore);
  EXPECT_EQ(bound_of({.threads = 4, .busy = 2.5, .speedup = 2.4}), Bound::kOneCore);
  EXPECT_EQ(bound_of({.threads = 4, .busy = 2.8, .speedup = 2.7}), Bound::kUnclear);
  EXPECT_EQ(bound_of({.threads = 2, .busy = 1.1, .speedup = 1.9, .alone_on_disk = true}),
            Bound::kDisk);
  EXPECT_EQ(bound_of({.threads = 4, .busy = 0.2, .speedup = 1, .used_disk = true}), Bound::kDisk);
}

TEST(BoundTest, WaitingIsUnclearWhileOthersHaveTheCores) {
  EXPECT_EQ(bound_of({.busy = 0.3, .disturbed = true, .used_disk = true}), Bound::kUnclear);
  EXPECT_EQ(bound_of({.threads = 4, .busy = 1, .locked = 0.9, .disturbed = true}), Bound::kUnclear);
  EXPECT_EQ(bound_of({.busy = 0.9, .memory = 0.05, .disturbed = true}), Bound::kArithmetic);
}

TEST(BoundTest, EveryBoundHasAName) {
  EXPECT_EQ(name_of(Bound::kArithmetic), "arithmetic");
  EXPECT_EQ(name_of(Bound::kMemory), "memory");
  EXPECT_EQ(name_of(Bound::kDisk), "disk");
  EXPECT_EQ(name_of(Bound::kLock), "lock");
  EXPECT_EQ(name_of(Bound::kCores), "cores");
  EXPECT_EQ(name_of(Bound::kOneCore), "one core");
  EXPECT_EQ(name_of(Bound::kUnclear), "unclear");
}

}  // namespace
}  // namespace semigeo::jobs
