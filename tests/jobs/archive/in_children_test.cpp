#include "jobs/archive/in_children.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>
#include <string>
#include <utility>

#include "engine/lack_of_memory.hpp"
#include "tests/support/descriptor_limit.hpp"
#include "tests/support/temporary_folder.hpp"

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

/// Returns how a child process ends that dies from this signal as often as `times` says.
engine::ForkedResult end_after(int signal, int times) {
  tests::TemporaryFolder folder;
  const auto work = [&](std::size_t) -> std::string {
    for (int i = 0; i < times; ++i) {
      if (std::filesystem::exists(folder / std::to_string(i))) continue;
      std::ofstream(folder / std::to_string(i)).put('x');
      raise(signal);
    }
    return "done";
  };
  return in_children(1, 1, work, [](std::size_t) { return 60.0; }).front();
}

TEST(InChildrenTest, WhatCrashesIsTriedOnceMore) {
  EXPECT_EQ(end_after(SIGSEGV, 1).text, "done");
  EXPECT_EQ(end_after(SIGSEGV, 2).signal, SIGSEGV);
  EXPECT_EQ(end_after(SIGABRT, 1).text, "done");
  EXPECT_EQ(end_after(SIGKILL, 1).signal, SIGKILL);
}

TEST(InChildrenTest, OnlyACrashAndAnEndlessLoopTellOfDamage) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGXCPU}) {
    const engine::ForkedResult result{.text = "", .exit_code = -1, .signal = signal};
    EXPECT_TRUE(tells_of_damage(result));
    EXPECT_NE(std::string(unfinished_reading(result, "x").what()).find("is damaged"),
              std::string::npos);
  }
  for (const auto& [code, signal] :
       {std::pair(-1, SIGKILL), std::pair(-1, SIGTERM), std::pair(engine::kNoMemoryCode, 0),
        std::pair(EXIT_FAILURE, 0), std::pair(-1, 0)}) {
    const engine::ForkedResult result{.text = "", .exit_code = code, .signal = signal};
    EXPECT_FALSE(tells_of_damage(result));
    const std::string problem = unfinished_reading(result, "x").what();
    EXPECT_TRUE(problem.starts_with("x: was not read to its end: ")) << problem;
    EXPECT_EQ(problem.find("remove"), std::string::npos) << problem;
  }
}

TEST(InChildrenTest, WhatCannotBeStartedNowIsStartedWhenAnotherHasEnded) {
  const tests::DescriptorLimit limit(2);  // enough for the pipe of one child
  const auto results = in_children(
      3, 3, [](std::size_t i) { return std::to_string(i); }, [](std::size_t) { return 60.0; });
  ASSERT_EQ(results.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(results[i].text, std::to_string(i));
}

TEST(InChildrenTest, NoMemoryIsWhatItIs) {
  const auto results = in_children(
      1, 1, [](std::size_t) -> std::string { throw std::bad_alloc(); },
      [](std::size_t) { return 60.0; });
  const std::string problem = unfinished_reading(results.front(), "x").what();
  EXPECT_EQ(problem,
            "x: was not read to its end: there was no memory for it; the file itself may be whole: "
            "free some memory, and run again");
}

}  // namespace
}  // namespace semigeo::jobs
