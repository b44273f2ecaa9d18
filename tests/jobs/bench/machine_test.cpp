#include "jobs/bench/machine.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

class MachineTest : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    const auto path = root_ / "proc" / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  tests::TemporaryFolder root_;
};

TEST_F(MachineTest, BusyIsAllButIdleAndStolen) {
  write("stat", "cpu  100 200 300 5000 700 10 20 40 1 2\ncpu0 1 2 3 4 5 6 7 8 9 10\n");
  const auto ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
  const MachineTimes times = machine_times(root_.path());
  EXPECT_DOUBLE_EQ(times.busy, 630 / ticks);
  EXPECT_DOUBLE_EQ(times.stolen, 40 / ticks);
}

TEST_F(MachineTest, WhatLinuxDoesNotSayIsZero) {
  EXPECT_EQ(machine_times(root_.path()).busy, 0);
  EXPECT_EQ(load_average(root_.path()), 0);
  write("stat", "nonsense\n");
  EXPECT_EQ(machine_times(root_.path()).busy, 0);
}

TEST_F(MachineTest, TheQueueIsThatOfAllThreads) {
  EXPECT_FALSE(seconds_in_queue(root_.path()));
  write("self/task/1/schedstat", "5000000000 1000000000 17\n");
  write("self/task/2/schedstat", "7000000000 500000000 3\n");
  EXPECT_DOUBLE_EQ(seconds_in_queue(root_.path()).value(), 1.5);
  EXPECT_GE(seconds_in_queue().value_or(0), 0);
}

TEST_F(MachineTest, DescriptionNamesProcessorAndFolder) {
  write("cpuinfo", "processor\t: 0\nmodel name\t: A Processor @ 2 GHz\n");
  write("loadavg", "1.25 0.5 0.1 1/100 42\n");
  const MachineDescription machine = describe_machine(root_ / "temporary", root_.path());
  EXPECT_EQ(machine.processor, "A Processor @ 2 GHz");
  EXPECT_EQ(machine.temporary_folder, root_.path().string());
  EXPECT_GE(machine.machine_cores, 1);
  EXPECT_GE(machine.usable_cores, 1);
  EXPECT_EQ(load_average(root_.path()), 1.25);
}

TEST(MachineLoadTest, AFewProcessesBesideAreNotBusy) {
  EXPECT_FALSE((MachineLoad{.other_cores = 0.1, .stolen = 0.01}).was_busy());
  EXPECT_TRUE((MachineLoad{.other_cores = 0.5}).was_busy());
  EXPECT_TRUE((MachineLoad{.stolen = 0.1}).was_busy());
}

}  // namespace
}  // namespace semigeo::jobs
