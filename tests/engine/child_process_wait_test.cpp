#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <string>
#include <thread>
#include <variant>

#include "engine/child_process.hpp"
#include "tests/engine/children.hpp"

namespace semigeo::engine {
namespace {

using Ended = ChildProcesses::Ended;
using Id = ChildProcesses::Id;
using TimedOut = ChildProcesses::TimedOut;
using Woken = ChildProcesses::Woken;

TEST(ChildProcessWait, WaitTimesOut) {
  ChildProcesses children;
  EXPECT_TRUE(std::holds_alternative<TimedOut>(children.wait(0)));
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(std::holds_alternative<TimedOut>(children.wait(0.05)));
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(50));
}

TEST(ChildProcessWait, WakeEndsAWait) {
  ChildProcesses children;
  children.start(conversing("read forever"));
  children.wake();  // before
  children.wake();
  next<Woken>(children);
  EXPECT_TRUE(std::holds_alternative<TimedOut>(children.wait(0)));
  std::thread other([&] { children.wake(); });
  next<Woken>(children);
  other.join();
}

TEST(ChildProcessWait, WakeEndsAWaitFromASignalHandler) {
  static ChildProcesses* woken;
  ChildProcesses children;
  woken = &children;
  const auto before = signal(SIGUSR2, [](int) { woken->wake(); });
  children.start(shell("kill -USR2 " + std::to_string(getpid())));
  bool has_woken = false;
  for (bool ended = false; !ended || !has_woken;) {
    const auto event = children.wait(kLong);
    ASSERT_FALSE(std::holds_alternative<TimedOut>(event));
    ended |= std::holds_alternative<Ended>(event);
    has_woken |= std::holds_alternative<Woken>(event);
  }
  signal(SIGUSR2, before);
}

TEST(ChildProcessWait, WaitingTakesNoCpuTime) {
  ChildProcesses children;
  // Closes its ends and lives on: a hang-up must not be reported again and again.
  const Id child = children.start(conversing("exec 0<&- 3>&-; exec sleep 1000"));
  const std::clock_t before = std::clock();
  EXPECT_TRUE(std::holds_alternative<TimedOut>(children.wait(0.5)));
  EXPECT_LT(std::clock() - before, CLOCKS_PER_SEC / 10);
  children.kill(child);
  next<Ended>(children);
}

}  // namespace
}  // namespace semigeo::engine
