#include "io/files/write_error.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "io/files/atomic_file.hpp"
#include "io/files/output_file.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

/// Returns the number of the system's error that an action throws; 0 if it throws none.
template <typename Action>
int code_of(const Action& action) {
  try {
    action();
    return 0;
  } catch (const WriteError& error) {
    return error.code();
  }
}

TEST(WriteErrorTest, AFolderThatIsGoneIsTold) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder / "gone/file";
  EXPECT_EQ(code_of([&] { write_file_atomically(file, "text"); }), ENOENT);
  EXPECT_EQ(code_of([&] { OutputFile(file).commit(); }), ENOENT);
}

TEST(WriteErrorTest, WritingThatFailsIsTold) {
  const tests::TemporaryFolder folder;
  const std::string text(5000, 'x');
  const tests::FileSizeLimit limit(1000);
  EXPECT_EQ(code_of([&] { write_file_atomically(folder / "a", text); }), EFBIG);
  EXPECT_EQ(code_of([&] {
              OutputFile file(folder / "b");
              file.text(text);
              file.commit();
            }),
            EFBIG);
}

TEST(WriteErrorTest, SomeErrorsConcernEveryFileOfThePlace) {
  for (const int code : {ENOSPC, EDQUOT, EIO, EROFS, ENOENT, ENOTDIR, ESTALE})
    EXPECT_TRUE(concerns_the_place(code)) << code;
  for (const int code : {0, EFBIG, EACCES, ENAMETOOLONG, EINTR})
    EXPECT_FALSE(concerns_the_place(code)) << code;
}

}  // namespace
}  // namespace semigeo::io
