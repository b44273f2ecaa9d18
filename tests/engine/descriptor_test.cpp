#include "engine/descriptor.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/time.h>

#include <cerrno>
#include <type_traits>

#include "tests/support/file_size_limit.hpp"
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

const char* pipe_to_open;
volatile sig_atomic_t signals = 0;

// The first signals interrupt whoever waits; a later one lets the pipe be opened.
void interrupt(int) {
  signals = signals + 1;
  if (signals == 3) open(pipe_to_open, O_RDONLY | O_NONBLOCK);
}

TEST(Descriptor, ASignalDoesNotKeepAFileFromBeingOpened) {
  const tests::TemporaryFolder folder;
  const std::string path = (folder / "pipe").string();
  ASSERT_EQ(mkfifo(path.c_str(), 0666), 0);
  pipe_to_open = path.c_str();
  signals = 0;
  struct sigaction action = {}, before = {};
  action.sa_handler = interrupt;  // without SA_RESTART
  sigaction(SIGALRM, &action, &before);
  const itimerval often = {{0, 1000}, {0, 1000}}, never = {};
  setitimer(ITIMER_REAL, &often, nullptr);
  const Descriptor pipe = open_file(path, O_WRONLY);  // waits for a reader
  setitimer(ITIMER_REAL, &never, nullptr);
  sigaction(SIGALRM, &before, nullptr);
  EXPECT_TRUE(pipe);
  EXPECT_GE(signals, 3);
}

TEST(Descriptor, AllIsWrittenOrTheErrorIsTold) {
  const tests::TemporaryFolder folder;
  const Descriptor file = open_file(folder / "file", O_RDWR | O_CREAT);
  EXPECT_TRUE(write_all(file, "some text"));
  EXPECT_TRUE(sync_file(file));
  const tests::FileSizeLimit full(12);  // the first write is short, the second fails
  EXPECT_FALSE(write_all(file, "more text"));
  EXPECT_EQ(errno, EFBIG);
  EXPECT_EQ(std::filesystem::file_size(folder / "file"), 12u);
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
