#include "jobs/archive/dataset_files.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "io/files/read_error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

TEST(DatasetFilesTest, AreCompleteDatasetsByName) {
  const tests::TemporaryFolder folder;
  for (const char* name : {"b.ply.vtkhdf", "a.ply.vtkhdf", "a.ply.xdmf", ".c.ply.vtkhdf"})
    std::ofstream(folder / name) << 'x';
  EXPECT_EQ(dataset_files(folder.path()),
            (std::vector<fs::path>{folder / "a.ply.vtkhdf", folder / "b.ply.vtkhdf"}));
}

TEST(DatasetFilesTest, AreNoneInAFolderThatDoesNotExist) {
  const tests::TemporaryFolder folder;
  EXPECT_TRUE(dataset_files(folder / "absent").empty());
}

TEST(DatasetFilesTest, AFolderThatCannotBeReadIsNotTakenForAnEmptyOne) {
  const tests::TemporaryFolder folder;
  std::ofstream(folder / "file") << 'x';
  EXPECT_THROW(dataset_files(folder / "file"), io::ReadError);
}

}  // namespace
}  // namespace semigeo::jobs
