#include "io/files/small_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <fstream>

#include "io/files/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

namespace fs = std::filesystem;

class SmallFileTest : public testing::Test {
 protected:
  fs::path file(const std::string& text) {
    std::ofstream(folder_ / "file", std::ios::binary) << text;
    return folder_ / "file";
  }

  tests::TemporaryFolder folder_;
  const TextBounds bounds_{.bytes = 100, .depth = 3};
};

TEST_F(SmallFileTest, AFileIsReadAsItIs) {
  for (const std::string& text : {std::string(), std::string("a\0b", 3), std::string(100, 'x')})
    EXPECT_EQ(read_text(file(text), bounds_), text);
  EXPECT_EQ(read_json(file(R"({"a": [{"b]]]]]\"[[[": 1}]})"), bounds_).at("a").at(0).size(), 1u);
}

TEST_F(SmallFileTest, WhatIsNoFileIsRefusedAtOnce) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0666), 0);
  fs::create_directory(folder_ / "folder");
  for (const fs::path& path : {folder_ / "pipe", folder_ / "folder", fs::path("/dev/zero")}) {
    EXPECT_THROW(read_text(path, bounds_), Error) << path;
    EXPECT_THROW(read_json(path, bounds_), Error) << path;
  }
  EXPECT_THROW(read_text(file(std::string(101, 'x')), bounds_), Error);
  EXPECT_THROW(read_json(file(std::string(101, ' ')), bounds_), Error);
}

TEST_F(SmallFileTest, OnlyShallowObjectsAreRead) {
  for (const char* text : {"", "1", "[]", "{", "}", "{]", "[[[[", R"({"a":[[[1]]]})"}) {
    EXPECT_TRUE(read_json(file(text), bounds_).is_discarded()) << text;
    EXPECT_TRUE(parse_json(text, bounds_).is_discarded()) << text;
  }
  EXPECT_EQ(parse_json(R"({"a":[[1]]})", bounds_).size(), 1u);
}

TEST_F(SmallFileTest, BracketsWithoutEndTakeNoMemory) {
  const fs::path path = folder_ / "brackets";
  {
    std::ofstream stream(path);
    const std::string piece(1 << 20, '[');
    stream << R"({"a":)";
    for (int i = 0; i < 100; ++i) stream << piece;
  }
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  EXPECT_TRUE(read_json(path, {.bytes = std::int64_t{1} << 30}).is_discarded());
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 8 << 10);  // kB
}

}  // namespace
}  // namespace semigeo::io
