#include "jobs/archive/sources.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>

#include "io/files/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

class SourcesTest : public testing::Test {
 protected:
  fs::path add(const std::string& file) {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file).flush();
    return folder_ / file;
  }
  /// Names of scans in an archive that knows `sources_` and whose datasets are of `bytes_`.
  Names choose(const std::vector<Unnamed>& scans) {
    return choose_names(scans, sources_, [&](const std::string& name, const std::string& xxh3) {
      const auto found = bytes_.find(name);
      return found != bytes_.end() && found->second == xxh3;
    });
  }

  tests::TemporaryFolder folder_;
  Sources sources_;
  std::map<std::string, std::string> bytes_;
};

TEST_F(SourcesTest, ComeBackWhateverTheirBytes) {
  const Names paths = {"/a b/x.ply",          "/100%.ply",        "/%41.ply",
                       "/Krug Nº 7/日本.ply", "/bad\xff\xfe.ply", "/new\nline\\\".ply"};
  for (const std::string& path : paths) sources_.claim("name of " + path.substr(1, 2), path);
  sources_.write(folder_.path());
  EXPECT_EQ(Sources::read(folder_.path()).by_name(), sources_.by_name());
  EXPECT_EQ(sources_.by_name().size(), paths.size());
}

TEST_F(SourcesTest, AreWrittenOnlyWhenTheyChange) {
  sources_.claim("x.ply", "/x.ply");
  sources_.write(folder_.path());
  struct stat before {};
  struct stat after {};
  stat((folder_ / "sources.json").c_str(), &before);
  Sources::read(folder_.path()).write(folder_.path());
  stat((folder_ / "sources.json").c_str(), &after);
  EXPECT_EQ(before.st_ino, after.st_ino);
  EXPECT_TRUE(Sources::read(folder_ / "elsewhere").by_name().empty());
}

TEST_F(SourcesTest, ADamagedFileIsNamed) {
  for (const char* text : {"", "{", "{\"x.ply\": 7}"}) {
    std::ofstream(folder_ / "sources.json") << text;
    try {
      Sources::read(folder_.path());
      ADD_FAILURE() << text << " was accepted";
    } catch (const io::Error& error) {
      EXPECT_EQ(error.file(), folder_ / "sources.json");
      EXPECT_FALSE(error.remedy().empty());
    }
  }
}

TEST_F(SourcesTest, WhatIsNoFileIsNamedWithoutWaiting) {
  const fs::path file = folder_ / "sources.json";
  ASSERT_EQ(mkfifo(file.c_str(), 0666), 0);
  const auto sentence = [&]() -> std::string {
    try {
      Sources::read(folder_.path());
      return "";
    } catch (const io::Error& error) {
      return error.what();
    }
  };
  EXPECT_NE(sentence().find("is not a regular file"), std::string::npos) << sentence();
  fs::remove(file);
  fs::create_symlink(file, file);  // not absent: the archive would forget its names
  EXPECT_NE(sentence().find("symbolic link"), std::string::npos) << sentence();
  fs::remove(file);
  std::ofstream(file) << std::string(1000, '[');
  EXPECT_NE(sentence().find("is damaged"), std::string::npos) << sentence();
}

TEST_F(SourcesTest, AClaimHoldsWhileTheScanExists) {
  const fs::path first = add("a/x.ply");
  sources_.claim("x.ply", first);
  sources_.claim("x.ply", folder_ / "b/x.ply");
  EXPECT_EQ(sources_.by_name().at("x.ply"), first);
  fs::remove(first);
  sources_.claim("x.ply", folder_ / "b/x.ply");
  EXPECT_EQ(sources_.by_name().at("x.ply"), folder_ / "b/x.ply");
}

TEST_F(SourcesTest, OfOneRunTheOrderDoesNotMatter) {
  const Unnamed a = {"x.ply", add("a/x.ply"), "1"};
  const Unnamed b = {"x.ply", add("b/x.ply"), "2"};
  const Unnamed c = {"y.ply", add("c/y.ply"), "3"};
  const Names names = choose({a, b, c});
  EXPECT_EQ(names[0], "x.ply");
  EXPECT_TRUE(names[1].starts_with("x.ply--")) << names[1];
  EXPECT_EQ(names[2], "y.ply");
  EXPECT_EQ(choose({c, b, a}), (Names{names[2], names[1], names[0]}));
}

TEST_F(SourcesTest, AnotherScanOfAKnownNameGetsAHash) {
  sources_.claim("x.ply", add("a/x.ply"));
  const Unnamed b = {"x.ply", add("b/x.ply"), "2"};
  const Names names = choose({b});
  EXPECT_TRUE(names[0].starts_with("x.ply--")) << names[0];
  // And keeps it, even when the plain name becomes free.
  sources_.claim(names[0], b.scan);
  fs::remove(folder_ / "a/x.ply");
  EXPECT_EQ(choose({b}), names);
}

TEST_F(SourcesTest, AScanThatMovedKeepsItsName) {
  sources_.claim("x.ply", folder_ / "gone/x.ply");
  sources_.claim("x.ply--01234567", folder_ / "gone/too/x.ply");
  bytes_ = {{"x.ply", "1"}, {"x.ply--01234567", "2"}};
  const Unnamed a = {"x.ply", add("a/x.ply"), "1"};
  const Unnamed b = {"x.ply", add("b/x.ply"), "2"};
  EXPECT_EQ(choose({b}), Names{"x.ply--01234567"});
  EXPECT_EQ(choose({a}), Names{"x.ply"});
  EXPECT_EQ(choose({b, a}), (Names{"x.ply--01234567", "x.ply"}));
  // Moved and changed since.
  EXPECT_EQ(choose({{"x.ply", a.scan, "3"}}), Names{"x.ply"});
}

TEST_F(SourcesTest, ACopyIsTheSameScanUntilOneChanges) {
  sources_.claim("x.ply", add("a/x.ply"));
  bytes_ = {{"x.ply", "1"}};
  const fs::path copy = add("b/x.ply");
  EXPECT_EQ(choose({{"x.ply", copy, "1"}}), Names{"x.ply"});
  EXPECT_NE(choose({{"x.ply", copy, "2"}}), Names{"x.ply"});
}

TEST_F(SourcesTest, AnArchiveThatKnowsNothingIsTakenToHoldTheScansGiven) {
  bytes_ = {{"x.ply", "1"}};
  EXPECT_EQ(choose({{"x.ply", add("a/x.ply"), "2"}}), Names{"x.ply"});
}

// "a b.ply" is named "a_b.ply-HASH": no scan that shares a name with a_b.ply.
TEST_F(SourcesTest, NamesWithAHashOfTheirOwnAreOtherNames) {
  sources_.claim("a_b.ply-01234567", folder_ / "gone/a b.ply");
  bytes_ = {{"a_b.ply-01234567", "1"}};
  EXPECT_EQ(choose({{"a_b.ply", add("a/a_b.ply"), "1"}}), Names{"a_b.ply"});
}

}  // namespace
}  // namespace semigeo::jobs
