#include "io/files/read_error.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "io/files/input_file.hpp"
#include "io/hdf5/hdf5.hpp"
#include "tests/support/descriptor_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

namespace fs = std::filesystem;

class ReadErrorTest : public testing::Test {
 protected:
  ReadErrorTest() {
    std::ofstream(file_) << "bytes";
    fs::create_symlink(circle_, circle_);
  }
  /// The number and the sentence of the error when a file is opened.
  template <typename Open>
  static std::pair<int, std::string> error_of(const Open& open) {
    try {
      open();
    } catch (const ReadError& error) {
      return {error.code(), error.what()};
    } catch (const Error& error) {
      return {0, error.what()};
    }
    return {0, "no error"};
  }

  tests::TemporaryFolder folder_;
  const fs::path file_ = folder_ / "file";
  const fs::path circle_ = folder_ / "circle";
};

TEST_F(ReadErrorTest, TheNumberDecidesAboutTheRemedy) {
  const auto open = [&](const fs::path& path) { return error_of([&] { InputFile file(path); }); };
  const std::string folder = folder_.path().string();
  using Told = std::pair<int, std::string>;
  EXPECT_EQ(open(folder_ / "gone"),
            Told(ENOENT, folder + "/gone: there is no such file; check the path"));
  EXPECT_EQ(open(file_ / "in"),
            Told(ENOTDIR, folder + "/file/in: there is no such file; check the path"));
  EXPECT_EQ(open(circle_),
            Told(ELOOP, folder + "/circle: cannot be opened: Too many levels of symbolic "
                                 "links; replace the symbolic link by a file"));
  const tests::DescriptorLimit none;
  EXPECT_EQ(open(file_),
            Told(EMFILE, folder + "/file: cannot be opened: Too many open files; the file "
                                  "itself may be whole: allow more open files (ulimit -n), "
                                  "and run again"));
}

TEST_F(ReadErrorTest, NobodyIsToldToRemoveWhatWasNotRead) {
  for (const int code : {EACCES, EPERM, EMFILE, ENFILE, ENOMEM, EIO, ELOOP, ESTALE}) {
    const std::string sentence = open_error("file", code).what();
    EXPECT_EQ(sentence.find("damaged"), std::string::npos) << sentence;
    EXPECT_EQ(sentence.find("remove"), std::string::npos) << sentence;
    EXPECT_FALSE(open_error("file", code).is_absent());
  }
  EXPECT_TRUE(open_error("file", ENOENT).is_absent());
}

TEST_F(ReadErrorTest, Hdf5FilesHaveTheSame) {
  const auto open = [&](const fs::path& path) { return error_of([&] { Hdf5File::open(path); }); };
  EXPECT_EQ(open(folder_ / "gone").first, ENOENT);
  EXPECT_EQ(open(circle_).first, ELOOP);
  {
    const tests::DescriptorLimit none;
    const auto [code, sentence] = open(file_);
    EXPECT_EQ(code, EMFILE);
    EXPECT_EQ(sentence.find("remove"), std::string::npos) << sentence;
  }
  EXPECT_EQ(open(file_).first, 0);  // this one is no HDF5 file
}

TEST_F(ReadErrorTest, OnlyWhatMayBeReadTheNextTimeIsThrownAgain) {
  EXPECT_THROW(rethrow_if_unread(ReadError(EIO, "a", "", "")), ReadError);
  EXPECT_THROW(rethrow_if_unread(ReadError(EMFILE, "a", "", "")), ReadError);
  EXPECT_NO_THROW(rethrow_if_unread(ReadError(ENOENT, "a", "", "")));
  EXPECT_NO_THROW(rethrow_if_unread(Error("a", "", "is damaged")));
}

TEST_F(ReadErrorTest, WhatCannotBeKnownIsNotAbsent) {
  EXPECT_TRUE(is_there(file_));
  EXPECT_TRUE(is_there(folder_.path()));
  EXPECT_FALSE(is_there(folder_ / "gone"));
  EXPECT_FALSE(is_there(file_ / "in"));
  EXPECT_THROW(is_there(circle_), ReadError);
  EXPECT_TRUE(is_folder(folder_.path()));
  EXPECT_FALSE(is_folder(file_));
  EXPECT_FALSE(is_folder(folder_ / "gone"));
  EXPECT_THROW(is_folder(circle_), ReadError);
}

}  // namespace
}  // namespace semigeo::io
