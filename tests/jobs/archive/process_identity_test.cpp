#include "jobs/archive/process_identity.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace semigeo::jobs {
namespace {

/// A child that waits to be killed.
pid_t start_child() {
  const pid_t child = fork();
  if (child == 0)
    for (;;) pause();
  return child;
}

TEST(ProcessIdentityTest, ThisProcessIsAliveAndKnowsAllOfItself) {
  const ProcessIdentity self = this_process();
  EXPECT_EQ(self.pid, getpid());
  EXPECT_FALSE(self.host.empty());
  EXPECT_EQ(self.boot_id.size(), 36u);
  EXPECT_GT(self.started, 0u);
  EXPECT_EQ(self, this_process());
  EXPECT_EQ(life_of(self), Life::kAlive);
}

TEST(ProcessIdentityTest, AKilledProcessIsDeadBeforeAndAfterItIsWaitedFor) {
  ProcessIdentity child = this_process();
  child.pid = start_child();
  child.started = 0;  // not told
  EXPECT_EQ(life_of(child), Life::kAlive);
  kill(child.pid, SIGKILL);
  siginfo_t info;
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child.pid), &info, WEXITED | WNOWAIT), 0);
  EXPECT_EQ(life_of(child), Life::kDead);
  waitpid(child.pid, nullptr, 0);
  EXPECT_EQ(life_of(child), Life::kDead);
}

TEST(ProcessIdentityTest, AProcessIdThatWasGivenAgainIsAnotherProcess) {
  ProcessIdentity other = this_process();
  --other.started;
  EXPECT_EQ(life_of(other), Life::kDead);
}

TEST(ProcessIdentityTest, NobodySurvivesABoot) {
  ProcessIdentity before = this_process();
  before.boot_id.back() = before.boot_id.back() == '0' ? '1' : '0';
  EXPECT_EQ(life_of(before), Life::kDead);
  before.boot_id.clear();  // not told
  EXPECT_EQ(life_of(before), Life::kAlive);
}

TEST(ProcessIdentityTest, OfAnotherHostNothingIsKnown) {
  ProcessIdentity other = this_process();
  other.host += "-2";
  other.boot_id.clear();
  other.pid = 0;
  EXPECT_EQ(life_of(other), Life::kOnAnotherHost);
}

TEST(ProcessIdentityTest, NoProcessIsNumberedZeroOrLess) {
  for (const pid_t pid : {0, -1}) {
    ProcessIdentity none = this_process();
    none.pid = pid;
    EXPECT_EQ(life_of(none), Life::kDead);
  }
}

}  // namespace
}  // namespace semigeo::jobs
