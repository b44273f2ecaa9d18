#include "engine/run_command.hpp"

#include <gtest/gtest.h>

#include <string_view>
#include <system_error>

#include "tests/engine/children.hpp"

namespace semigeo::engine {
namespace {

using Bound = CommandResult::Bound;

CommandResult run_script(const std::string& script, const CommandBounds& bounds = {}) {
  return run_command(shell(script).arguments, bounds);
}

TEST(RunCommand, ReturnsOutputErrorsAndExitCode) {
  const CommandResult result = run_script("echo out; echo err >&2; cat; exit 7");
  EXPECT_EQ(result.text, "out\nerr\n");
  EXPECT_EQ(result.exit_code, 7);
  EXPECT_EQ(result.exceeded, Bound::kNone);
}

TEST(RunCommand, TellsThatASignalEndedIt) {
  const CommandResult result = run_script("echo before; kill -TERM $$");
  EXPECT_EQ(result.text, "before\n");
  EXPECT_EQ(result.exit_code, -1);
  EXPECT_EQ(result.exceeded, Bound::kNone);
}

TEST(RunCommand, KillsWhatTakesTooLong) {
  for (const char* script :
       {"echo begun; while :; do :; done", "echo begun; exec >&- 2>&-; while :; do :; done",
        "echo begun; (while :; do :; done) & wait"}) {
    const CommandResult result = run_script(script, {.seconds = 0.3});
    // On a busy machine it may be killed before it says anything.
    EXPECT_TRUE(std::string_view("begun\n").starts_with(result.text)) << result.text;
    EXPECT_EQ(result.exit_code, -1) << script;
    EXPECT_EQ(result.exceeded, Bound::kSeconds) << script;
  }
}

TEST(RunCommand, KillsWhatPrintsTooMuch) {
  const CommandResult result =
      run_script("while :; do echo 0123456789; done", {.seconds = kLong, .bytes = 100'000});
  EXPECT_EQ(result.text.size(), 100'000u);
  EXPECT_EQ(result.exit_code, -1);
  EXPECT_EQ(result.exceeded, Bound::kBytes);

  const CommandResult exact = run_script("printf 0123456789", {.seconds = kLong, .bytes = 10});
  EXPECT_EQ(exact.text, "0123456789");
  EXPECT_EQ(exact.exceeded, Bound::kNone);
}

TEST(RunCommand, ThrowsIfThereIsNoProgram) {
  EXPECT_THROW(run_command({"/nonexistent/program"}, {}), std::system_error);
}

}  // namespace
}  // namespace semigeo::engine
