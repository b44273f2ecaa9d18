#include "engine/machine.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <fstream>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace semigeo::engine {
namespace {

/// A file system root with a /proc and a /sys of the test's making, with 1000 kB of free memory.
class Machine : public testing::Test {
 protected:
  Machine() { write("proc/meminfo", "MemTotal: 2000 kB\nMemFree: 10 kB\nMemAvailable: 1000 kB\n"); }

  void write(const std::string& path, const std::string& text) {
    std::filesystem::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  Amount usable() const { return usable_resources(root_.path()); }

  static constexpr std::uint64_t kAvailable = 1000 * 1024;
  const int cores_ = usable_resources("/nowhere").cores;
  const tests::TemporaryFolder root_;
};

TEST_F(Machine, WithoutControlGroups) {
  EXPECT_EQ(usable().bytes, kAvailable);
  EXPECT_EQ(usable().cores, cores_);
}

TEST_F(Machine, CoresAreThoseOfTheAffinity) {
  cpu_set_t before, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  EXPECT_EQ(cores_, CPU_COUNT(&before));
  CPU_ZERO(&one);
  for (int cpu = 0; CPU_COUNT(&one) == 0; ++cpu)
    if (CPU_ISSET(cpu, &before)) CPU_SET(cpu, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  EXPECT_EQ(usable().cores, 1);
  sched_setaffinity(0, sizeof before, &before);
}

TEST_F(Machine, Version2) {
  write("proc/self/cgroup", "0::/user/job\n");
  write("sys/fs/cgroup/user/job/cpu.max", "max 100000\n");
  write("sys/fs/cgroup/user/job/memory.max", "max\n");
  EXPECT_EQ(usable().cores, cores_);
  EXPECT_EQ(usable().bytes, kAvailable);

  write("sys/fs/cgroup/user/job/cpu.max", "50000 100000\n");
  write("sys/fs/cgroup/user/job/memory.max", "500000\n");
  EXPECT_EQ(usable().cores, 1);
  EXPECT_EQ(usable().bytes, 500'000u);

  write("sys/fs/cgroup/user/job/memory.high", "400000\n");
  EXPECT_EQ(usable().bytes, 400'000u);
}

TEST_F(Machine, WhatIsUsedIsNotLeftButCachesAre) {
  write("proc/self/cgroup", "0::/\n");
  write("sys/fs/cgroup/memory.max", "500000\n");
  write("sys/fs/cgroup/memory.current", "300000\n");
  EXPECT_EQ(usable().bytes, 200'000u);
  write("sys/fs/cgroup/memory.stat", "anon 5\ninactive_file 100000\nactive_file 50000\nslab 7\n");
  EXPECT_EQ(usable().bytes, 350'000u);
  write("sys/fs/cgroup/memory.current", "900000\n");
  EXPECT_EQ(usable().bytes, 0u);
}

TEST_F(Machine, GroupsAroundLimitToo) {
  write("proc/self/cgroup", "0::/user/job/step\n");
  write("sys/fs/cgroup/user/job/step/memory.max", "700000\n");
  write("sys/fs/cgroup/user/memory.max", "600000\n");
  write("sys/fs/cgroup/user/cpu.max", "100000 100000\n");
  EXPECT_EQ(usable().bytes, 600'000u);
  EXPECT_EQ(usable().cores, 1);
}

TEST_F(Machine, Version1) {
  write("proc/self/cgroup", "9:name=systemd:/\n4:memory:/a/b\n2:cpu,cpuacct:/a\n0::/\n");
  write("sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "-1\n");
  write("sys/fs/cgroup/cpu/a/cpu.cfs_period_us", "100000\n");
  write("sys/fs/cgroup/memory/a/b/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(usable().cores, cores_);
  EXPECT_EQ(usable().bytes, kAvailable);

  write("sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "100000\n");
  write("sys/fs/cgroup/memory/a/memory.limit_in_bytes", "500000\n");
  write("sys/fs/cgroup/memory/a/memory.usage_in_bytes", "300000\n");
  write("sys/fs/cgroup/memory/a/memory.stat", "inactive_file 1\ntotal_inactive_file 100000\n");
  EXPECT_EQ(usable().cores, 1);
  EXPECT_EQ(usable().bytes, 300'000u);
}

TEST_F(Machine, PathsFromOutsideAContainer) {
  write("proc/self/cgroup", "4:memory:/docker/0123\n2:cpu:/docker/0123\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "500000\n");
  EXPECT_EQ(usable().bytes, 500'000u);
}

TEST_F(Machine, PartsOfACoreCountAsOne) {
  if (cores_ < 2) GTEST_SKIP() << "needs two cores";
  write("proc/self/cgroup", "0::/\n");
  write("sys/fs/cgroup/cpu.max", "150000 100000\n");
  EXPECT_EQ(usable().cores, 2);
  write("sys/fs/cgroup/cpu.max", "100000 100000\n");
  EXPECT_EQ(usable().cores, 1);
}

TEST(ThisMachine, HasSomething) {
  EXPECT_GE(usable_resources().cores, 1);
  EXPECT_GT(usable_resources().bytes, 1'000'000u);
}

}  // namespace
}  // namespace semigeo::engine
