#include "engine/descriptor.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <type_traits>

#include "tests/support/temporary_folder.hpp"

namespace semigeo::engine {
namespace {

static_assert(!std::is_copy_constructible_v<Descriptor> && !std::is_copy_assignable_v<Descriptor>);

bool is_open(int descriptor) {
  return fcntl(descriptor, F_GETFD) != -1;
}

TEST(Descriptor, ClosesWhatItOwnsOnce) {
  int number = -1;
  {
    const Descriptor file = open_file("/dev/null", O_RDONLY);
    ASSERT_TRUE(file);
    number = file.get();
    EXPECT_TRUE(is_open(number));
  }
  EXPECT_FALSE(is_open(number));

  Descriptor file = open_file("/dev/null", O_RDONLY);
  EXPECT_EQ(file.close(), 0);
  EXPECT_FALSE(file);
  EXPECT_EQ(file.get(), -1);
  EXPECT_EQ(file.close(), 0);
}

TEST(Descriptor, TellsThatClosingFailed) {
  Descriptor file = open_file("/dev/null", O_RDONLY);
  ASSERT_EQ(::close(file.get()), 0);
  EXPECT_EQ(file.close(), -1);
  EXPECT_EQ(errno, EBADF);
}

TEST(Descriptor, MovingHandsTheDescriptorOver) {
  Descriptor first = open_file("/dev/null", O_RDONLY);
  const int number = first.get();
  Descriptor second = std::move(first);
  EXPECT_FALSE(first);  // NOLINT(bugprone-use-after-move)
  EXPECT_EQ(second.get(), number);

  Descriptor third = open_file("/dev/null", O_RDONLY);
  const int replaced = third.get();
  third = std::move(second);
  EXPECT_EQ(third.get(), number);
  EXPECT_FALSE(is_open(replaced));
}

TEST(Descriptor, OpenedFilesAreNotInheritedByOtherPrograms) {
  const tests::TemporaryFolder folder;
  const Descriptor file = open_file(folder / "new", O_WRONLY | O_CREAT | O_EXCL);
  ASSERT_TRUE(file);
  EXPECT_EQ(fcntl(file.get(), F_GETFD), FD_CLOEXEC);

  EXPECT_FALSE(open_file(folder / "new", O_WRONLY | O_CREAT | O_EXCL));
  EXPECT_EQ(errno, EEXIST);
}

TEST(Descriptor, APipeGivesWhatIsWrittenAndThenEnds) {
  Pipe pipe = make_pipe();
  ASSERT_TRUE(pipe.from && pipe.to);
  EXPECT_EQ(fcntl(pipe.from.get(), F_GETFD), FD_CLOEXEC);
  EXPECT_EQ(fcntl(pipe.to.get(), F_GETFD), FD_CLOEXEC);
  ASSERT_EQ(write(pipe.to.get(), "ab", 2), 2);
  pipe.to.close();
  char text[4] = {};
  EXPECT_EQ(read(pipe.from.get(), text, sizeof text), 2);
  EXPECT_STREQ(text, "ab");
  EXPECT_EQ(read(pipe.from.get(), text, sizeof text), 0);
}

}  // namespace
}  // namespace semigeo::engine
