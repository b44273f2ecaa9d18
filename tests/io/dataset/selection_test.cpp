#include "io/dataset/selection.hpp"

#include <gtest/gtest.h>

#include "io/dataset/dataset.hpp"
#include "io/files/error.hpp"
#include "io/hdf5/hdf5_library.hpp"
#include "tests/io/dataset/sample_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

class SelectionTest : public ::testing::Test {
 protected:
  std::string failure(const Selection& selection, int levels) {
    {
      DigestedFile file(Hdf5File::create(path_));
      write_selection(file, selection, Compression::kDeflate);
      file.file().close();
    }
    try {
      read_selection(Hdf5File::open(path_), levels);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  void expect_refused(const Selection& selection, int levels, const std::string& part) {
    const std::string found = failure(selection, levels);
    EXPECT_NE(found.find(part), std::string::npos) << found;
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.h5";
};

TEST_F(SelectionTest, MustFitTheLevels) {
  const Selection right = {
      .feature_counts = {1, 2}, .smoothed = {0.5, 1}, .level = 1, .chosen = Chosen::kOption};
  EXPECT_EQ(failure(right, 2), "");
  EXPECT_EQ(read_selection(Hdf5File::open(path_), 2).chosen, Chosen::kOption);
  expect_refused(right, 3, "/selection/feature_counts: has not one row for each of 3 levels");
  Selection wrong = right;
  wrong.smoothed.pop_back();
  expect_refused(wrong, 2, "/selection/smoothed: has not one row for each of 2 levels");
  wrong = right;
  wrong.level = 2;
  expect_refused(wrong, 2, "chose level 2 of 2");
  wrong.level = -1;
  expect_refused(wrong, 2, "chose level -1 of 2");
}

TEST_F(SelectionTest, ItsWordsAreKnown) {
  ASSERT_EQ(failure({.feature_counts = {1}, .smoothed = {1}}, 1), "");
  {
    const Hdf5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const Hdf5Handle group(H5Oopen(file.get(), "/selection", H5P_DEFAULT), H5Oclose);
    const Hdf5Handle chosen(H5Aopen(group.get(), "chosen", H5P_DEFAULT), H5Aclose);
    const Hdf5Handle type(H5Aget_type(chosen.get()), H5Tclose);
    ASSERT_GE(H5Awrite(chosen.get(), type.get(), "dice!"), 0);
  }
  EXPECT_THROW(read_selection(Hdf5File::open(path_), 1), Error);
}

// Through HDF5 itself, which puts its checksums right.
TEST_F(SelectionTest, VerifyComparesItWithTheLevels) {
  tests::write_sample(path_, {.vertices = 10, .triangles = 10});
  {
    const Hdf5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const Hdf5Handle set(H5Dopen2(file.get(), "/selection/feature_counts", H5P_DEFAULT), H5Dclose);
    const std::vector<std::int64_t> counts = {0, 27, 52};
    ASSERT_GE(H5Dwrite(set.get(), H5T_STD_I64LE, H5S_ALL, H5S_ALL, H5P_DEFAULT, counts.data()), 0);
  }
  try {
    Dataset(path_).verify();
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(error.problem().find("does not count the features of level 1"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace semigeo::io
