#include "engine/lack_of_memory.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <cerrno>
#include <cstdlib>
#include <initializer_list>
#include <new>
#include <stdexcept>
#include <string>

#include "engine/fork_child.hpp"
#include "tests/support/sanitizers.hpp"

namespace semigeo::engine {
namespace {

/// Returns how a child process ends that does this.
template <typename Do>
ForkedResult end_of(const Do& work) {
  return ForkedChild(
             [&] {
               work();
               return std::string("went on");
             },
             0)
      .wait();
}

void crash() {
  raise(SIGSEGV);
}

/// Lets an exception leave a function that must not throw.
template <typename Exception>
void let_go(const Exception& exception) noexcept {
  [&] { throw exception; }();
}

TEST(LackOfMemory, WhatMustNotThrowEndsTheProcessWithItsCode) {
  EXPECT_EQ(end_of([] { let_go(std::bad_alloc()); }).exit_code, kNoMemoryCode);
  EXPECT_EQ(end_of([] { let_go(std::runtime_error("other")); }).signal, SIGABRT);
}

TEST(LackOfMemory, ACrashAfterAFailedAllocationIsOne) {
  if (tests::kSanitized) GTEST_SKIP() << "sanitizers have handlers of their own";
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT}) {
    EXPECT_EQ(end_of([number] {
                errno = ENOMEM;
                raise(number);
              }).exit_code,
              kNoMemoryCode);
  }
}

/// Uses up the stack, a page in each call.
int dig(int depth) {
  volatile char page[4096] = {};
  page[depth % 4096] = 1;
  return depth < 0 ? 0 : dig(depth + 1) + page[0];
}

TEST(LackOfMemory, AStackThatIsUsedUpAfterAFailedAllocationIsOne) {
  if (tests::kSanitized) GTEST_SKIP() << "sanitizers have handlers of their own";
  EXPECT_EQ(end_of([] {
              errno = ENOMEM;
              return dig(0);
            }).exit_code,
            kNoMemoryCode);
}

TEST(LackOfMemory, ALibraryThatEndsTheProcessHasNone) {
  EXPECT_EQ(end_of([] { std::exit(-1); }).exit_code, kNoMemoryCode);
  EXPECT_EQ(end_of([] { std::exit(3); }).exit_code, 3);
}

TEST(LackOfMemory, AnyOtherCrashStaysACrash) {
  if (tests::kSanitized) GTEST_SKIP() << "sanitizers have handlers of their own";
  errno = ENOMEM;  // what failed here is not known to a child
  EXPECT_EQ(end_of(crash).signal, SIGSEGV);
  errno = 0;
}

TEST(LackOfMemory, TheLastCallSaysHowTheProcessEnds) {
  EXPECT_EQ(end_of([] {
              end_for_lack_of_memory("", 7);
              let_go(std::bad_alloc());
            }).exit_code,
            7);
  EXPECT_EXIT(
      {
        end_for_lack_of_memory("no memory\n", 1);
        let_go(std::bad_alloc());
      },
      testing::ExitedWithCode(1), "^no memory\n$");
}

}  // namespace
}  // namespace semigeo::engine
