#include "jobs/run/drain.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <optional>
#include <thread>

namespace semigeo::jobs {
namespace {

using engine::ChildProcesses;

constexpr double kLong = 60;  // a test that waits so long has failed

bool wakes(ChildProcesses& children) {
  return std::holds_alternative<ChildProcesses::Woken>(children.wait(kLong));
}

volatile sig_atomic_t seen = 0;

/// Someone who handled a signal before.
class Handler {
 public:
  explicit Handler(int number) : number_(number) {
    seen = 0;
    struct sigaction action = {};
    action.sa_handler = [](int) { seen = seen + 1; };
    sigaction(number_, &action, &before_);
  }
  ~Handler() { sigaction(number_, &before_, nullptr); }
  Handler(const Handler&) = delete;
  Handler& operator=(const Handler&) = delete;

 private:
  int number_;
  struct sigaction before_ = {};
};

TEST(DrainTest, CountsSignalsAndWakesWhoWaits) {
  ChildProcesses children;
  const Drain drain(children);
  EXPECT_EQ(drain.requests(), 0);
  EXPECT_TRUE(std::holds_alternative<ChildProcesses::TimedOut>(children.wait(0)));
  raise(SIGINT);
  EXPECT_EQ(drain.requests(), 1);
  EXPECT_TRUE(wakes(children));
  raise(SIGTERM);
  EXPECT_EQ(drain.requests(), 2);
  EXPECT_TRUE(wakes(children));
}

TEST(DrainTest, WakesWhoIsWaitingAlready) {
  ChildProcesses children;
  const Drain drain(children);
  const pthread_t waiting = pthread_self();
  std::thread other([waiting] { pthread_kill(waiting, SIGTERM); });
  EXPECT_TRUE(wakes(children));
  other.join();
  EXPECT_EQ(drain.requests(), 1);
}

TEST(DrainTest, EachStartsAtNothing) {
  ChildProcesses children;
  {
    const Drain drain(children);
    raise(SIGINT);
    EXPECT_EQ(drain.requests(), 1);
  }
  const Drain drain(children);
  EXPECT_EQ(drain.requests(), 0);
}

TEST(DrainTest, AfterItSignalsDoWhatTheyDid) {
  for (const int number : {SIGINT, SIGTERM}) {
    const Handler handler(number);
    std::optional<ChildProcesses> children(std::in_place);
    {
      const Drain drain(*children);
      raise(number);
      EXPECT_EQ(seen, 0);
    }
    children.reset();
    raise(number);
    EXPECT_EQ(seen, 1);
  }
}

TEST(EarlySignalsTest, ADrainGoesOnCounting) {
  const Handler handler(SIGTERM);
  ChildProcesses children;
  {
    const EarlySignals early;
    raise(SIGTERM);
    const Drain drain(children);
    EXPECT_EQ(drain.requests(), 1);
    EXPECT_TRUE(wakes(children));
    raise(SIGTERM);
    EXPECT_EQ(drain.requests(), 2);
  }
  EXPECT_EQ(seen, 0);
  raise(SIGTERM);
  EXPECT_EQ(seen, 1);
}

void end_with_75() {
  _exit(75);
}

/// Returns the exit code of a child process that does this and then ends with 1.
int code_of(void (*action)()) {
  const pid_t child = fork();
  if (child == 0) {
    action();
    _exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(EndAtOnceTest, ASignalEndsTheProcess) {
  EXPECT_EQ(code_of([] {
              const EarlySignals early;
              const EndAtOnce scope(end_with_75);
              raise(SIGINT);
            }),
            75);
  EXPECT_EQ(code_of([] {  // one that came before
              const EarlySignals early;
              raise(SIGTERM);
              const EndAtOnce scope(end_with_75);
            }),
            75);
  EXPECT_EQ(code_of([] {  // one that comes after it is counted
              const EarlySignals early;
              { const EndAtOnce scope(end_with_75); }
              raise(SIGTERM);
              _exit(0);
            }),
            0);
}

TEST(EndAtOnceTest, AForkedChildDoesNotCallIt) {
  EXPECT_EQ(code_of([] {
              const EarlySignals early;
              const EndAtOnce scope(end_with_75);
              _exit(code_of([] { raise(SIGTERM); }) == 1 ? 0 : 2);
            }),
            0);
}

}  // namespace
}  // namespace semigeo::jobs
