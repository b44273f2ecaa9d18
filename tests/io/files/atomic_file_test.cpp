#include "io/files/atomic_file.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>

#include "io/files/error.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string read(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

int entries(const tests::TemporaryFolder& folder) {
  return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder.path()), {}));
}

std::string host() {
  char name[256] = {};
  gethostname(name, sizeof name - 1);
  return name;
}

// The id of a process that has just died.
pid_t dead_process() {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  return child;
}

TEST(AtomicFile, AppearsWithItsCommit) {
  const tests::TemporaryFolder folder;
  AtomicFile file(folder / "a.bin");
  write(file.temporary_path(), "content");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.bin"));
  file.commit();
  EXPECT_EQ(read(folder / "a.bin"), "content");
  EXPECT_EQ(entries(folder), 1);
}

TEST(AtomicFile, ReplacesAndOutlivesTheWriter) {
  const tests::TemporaryFolder folder;
  write(folder / "a.bin", "old");
  {
    AtomicFile file(folder / "a.bin");
    write(file.temporary_path(), "new");
    file.commit();
  }
  EXPECT_EQ(read(folder / "a.bin"), "new");
}

TEST(AtomicFile, LeavesNothingWithoutACommit) {
  const tests::TemporaryFolder folder;
  write(folder / "a.bin", "old");
  {
    const AtomicFile file(folder / "a.bin");
    write(file.temporary_path(), "new");
    EXPECT_EQ(entries(folder), 2);
  }
  EXPECT_EQ(read(folder / "a.bin"), "old");
  EXPECT_EQ(entries(folder), 1);
}

TEST(AtomicFile, NameTellsWhoWritesAndWhere) {
  const AtomicFile file("some/folder/a.bin");
  EXPECT_EQ(file.temporary_path(),
            "some/folder/.a.bin." + host() + "." + std::to_string(getpid()) + ".partial");
  EXPECT_EQ(AtomicFile("a.bin").temporary_path().parent_path(), ".");
}

TEST(AtomicFile, LongNamesFit) {
  const tests::TemporaryFolder folder;
  const std::string name(255, 'x');
  write_file_atomically(folder / name, "content");
  EXPECT_EQ(read(folder / name), "content");
  const AtomicFile first(folder / (std::string(250, 'x') + "1"));
  const AtomicFile second(folder / (std::string(250, 'x') + "2"));
  EXPECT_NE(first.temporary_path(), second.temporary_path());
}

TEST(AtomicFile, NamesWhatItCannotDo) {
  const tests::TemporaryFolder folder;
  try {
    write_file_atomically(folder / "missing" / "a.txt", "content");
    FAIL() << "a folder that does not exist was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), folder / "missing" / "a.txt");
    EXPECT_NE(std::string(error.what()).find("No such file or directory"), std::string::npos);
  }
}

TEST(AtomicFile, FullDiskIsAnErrorAndLeavesNothing) {
  const tests::TemporaryFolder folder;
  {
    const tests::FileSizeLimit limit(1000);
    EXPECT_THROW(write_file_atomically(folder / "a.txt", std::string(2000, 'x')), Error);
  }
  EXPECT_EQ(entries(folder), 0);
}

TEST(RemoveStalePartials, RemovesThoseOfDeadProcessesOfThisHost) {
  const tests::TemporaryFolder folder;
  const std::string dead = std::to_string(dead_process());
  write(folder / (".a.b.vtkhdf." + host() + "." + dead + ".partial"), "");
  write(folder / (".c." + host() + "." + dead + ".partial"), "");
  EXPECT_EQ(remove_stale_partials(folder.path()), 2);
  EXPECT_EQ(entries(folder), 0);
}

/// Whoever started it may never ask how it ended.
TEST(RemoveStalePartials, AProcessThatNobodyWaitsForIsDeadToo) {
  tests::TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) _exit(0);
  siginfo_t info{};
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOWAIT), 0);
  write(folder / (".a." + host() + "." + std::to_string(child) + ".partial"), "");
  EXPECT_EQ(remove_stale_partials(folder.path()), 1);
  waitpid(child, nullptr, 0);
}

TEST(RemoveStalePartials, LeavesEverythingElse) {
  const tests::TemporaryFolder folder;
  const std::string dead = std::to_string(dead_process());
  const std::string living = std::to_string(getpid());
  for (const std::string& name :
       {".a." + host() + "." + living + ".partial", ".a.another-host." + dead + ".partial",
        ".a.x" + host() + "." + dead + ".partial", "a." + host() + "." + dead + ".partial",
        ".a." + host() + "." + dead + ".part", ".a." + host() + ".1x.partial",
        ".a." + host() + "..partial", std::string(".partial")})
    write(folder / name, "");
  EXPECT_EQ(remove_stale_partials(folder.path()), 0);
  EXPECT_EQ(entries(folder), 8);
  EXPECT_EQ(remove_stale_partials(folder / "missing"), 0);
}

}  // namespace
}  // namespace semigeo::io
