#include "engine/fork_child.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cstdlib>
#include <stdexcept>
#include <vector>

namespace semigeo::engine {
namespace {

TEST(ForkChild, ReturnsWhatTheFunctionReturns) {
  const std::string seen = "what the parent knows";
  ForkedChild child([&] { return seen + ", and more"; }, 0);
  const ForkedResult result = child.wait();
  EXPECT_EQ(result.text, "what the parent knows, and more");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.signal, 0);
}

TEST(ForkChild, TextMayBeEmptyOrLongerThanAPipeHolds) {
  EXPECT_EQ(ForkedChild([] { return std::string(); }, 0).wait().text, "");
  EXPECT_EQ(ForkedChild([] { return std::string(1'000'000, 'x'); }, 0).wait().text,
            std::string(1'000'000, 'x'));
}

TEST(ForkChild, ChangesNothingHere) {
  int value = 1;
  ForkedChild child(
      [&] {
        value = 2;
        return std::to_string(value);
      },
      0);
  EXPECT_EQ(child.wait().text, "2");
  EXPECT_EQ(value, 1);
}

TEST(ForkChild, ACrashEndsTheChildAlone) {
  ForkedChild killed(
      []() -> std::string {
        raise(SIGKILL);
        return "";
      },
      0);
  ForkedChild aborted([]() -> std::string { std::abort(); }, 0);
  ForkedChild thrown([]() -> std::string { throw std::runtime_error("nobody catches it"); }, 0);
  EXPECT_EQ(killed.wait().signal, SIGKILL);
  for (ForkedChild* child : {&aborted, &thrown}) {
    const ForkedResult result = child->wait();
    EXPECT_EQ(result.signal, SIGABRT);
    EXPECT_EQ(result.exit_code, -1);
    EXPECT_EQ(result.text, "");
  }
}

TEST(ForkChild, AnEndlessFunctionIsEndedByItsLimit) {
  ForkedChild child(
      []() -> std::string {
        const volatile bool endless = true;
        while (endless) {
        }
        return "";
      },
      1);
  EXPECT_EQ(child.wait().signal, SIGXCPU);
}

TEST(ForkChild, DumpsNoCore) {
  ForkedChild child(
      [] {
        rlimit limit{};
        getrlimit(RLIMIT_CORE, &limit);
        return std::to_string(limit.rlim_cur) + ' ' + std::to_string(limit.rlim_max);
      },
      0);
  EXPECT_EQ(child.wait().text, "0 0");
}

TEST(ForkChild, SeveralRunAtOnce) {
  // Each waits for the one after it.
  constexpr int kChildren = 4;
  std::vector<Pipe> pipes;
  for (int i = 0; i <= kChildren; ++i) pipes.push_back(make_pipe());
  std::vector<ForkedChild> children;
  for (int i = 0; i < kChildren; ++i)
    children.emplace_back(
        [&pipes, i] {
          char byte = '\0';
          if (read(pipes[i + 1].from.get(), &byte, 1) != 1) return std::string("nothing to read");
          ++byte;
          if (write(pipes[i].to.get(), &byte, 1) != 1) return std::string("cannot write");
          return std::string(1, byte);
        },
        0);
  ASSERT_EQ(write(pipes[kChildren].to.get(), "a", 1), 1);
  std::string texts;
  for (ForkedChild& child : children) texts += child.wait().text;
  EXPECT_EQ(texts, "edcb");
}

TEST(ForkChild, IsKilledIfNobodyWaits) {
  const Pipe pipe = make_pipe();
  Pipe alive = make_pipe();
  {
    const ForkedChild child(
        [&] {
          char byte = '\0';
          while (read(pipe.from.get(), &byte, 1) != 1) {
          }
          return std::string();
        },
        0);
  }
  alive.to.close();  // ours; the child's is closed by its end
  char byte = '\0';
  EXPECT_EQ(read(alive.from.get(), &byte, 1), 0);
}

}  // namespace
}  // namespace semigeo::engine
