#include "jobs/archive/find_scans.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "tests/support/containers.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

class FindScansTest : public testing::Test {
 protected:
  /// An empty file; finding does not look inside.
  fs::path add(const fs::path& file) {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file).flush();
    return folder_ / file;
  }
  std::vector<FoundScan> find(const std::vector<fs::path>& inputs) {
    return find_scans(inputs, folder_ / "archive").scans;
  }
  std::vector<std::string> names(const std::vector<fs::path>& inputs) {
    std::vector<std::string> result;
    for (const FoundScan& scan : find(inputs)) result.push_back(scan.name);
    return result;
  }

  tests::TemporaryFolder folder_;
};

using Names = std::vector<std::string>;

TEST_F(FindScansTest, ScenesMayBeDatasets) {
  add("scenes/a.ply");
  add("scenes/b.vtkhdf");
  add("scenes/b.xdmf");
  const fs::path archive = add("scenes/archive/scans/c.ply.vtkhdf").parent_path().parent_path();
  const auto scenes = [&](const fs::path& input) {
    Names result;
    for (const FoundScan& scene : find_scenes({input}, {folder_ / "other", archive}).scans)
      result.push_back(scene.name);
    return result;
  };
  EXPECT_EQ(scenes(folder_ / "scenes"), (Names{"a.ply", "b.vtkhdf"}));
  EXPECT_EQ(scenes(archive), (Names{"scans__c.ply.vtkhdf"}));
  EXPECT_EQ(scenes(archive / "scans/c.ply.vtkhdf"), (Names{"c.ply.vtkhdf"}));
  EXPECT_THROW(scenes(folder_ / "scenes/b.xdmf"), io::Error);
  EXPECT_EQ(names({folder_ / "scenes"}), (Names{"a.ply"}));
  EXPECT_THROW(find({folder_ / "scenes/b.vtkhdf"}), io::Error);
}

TEST_F(FindScansTest, SearchesFoldersForScansOfEveryFormat) {
  for (const char* file : {"in/b.obj", "in/a.ply", "in/deep/er/c.off", "in/d.STL", "in/e.stl.gz",
                           "in/f.Ply.GZ", "in/notes.txt", "in/g.ply.bak", "in/h.gz", "in/ply"})
    add(file);
  EXPECT_EQ(names({folder_ / "in"}),
            (Names{"a.ply", "b.obj", "d.STL", "deep__er__c.off", "e.stl.gz", "f.Ply.GZ"}));
}

TEST_F(FindScansTest, TheOrderIsThatOfNamesWhateverTheFileSystemSays) {
  for (const char* file : {"in/z.ply", "in/b/z.ply", "in/m.ply", "in/b/a.ply", "in/a.ply"})
    add(file);
  EXPECT_EQ(names({folder_ / "in"}), (Names{"a.ply", "b__a.ply", "b__z.ply", "m.ply", "z.ply"}));
}

TEST_F(FindScansTest, PassesOverHiddenThingsAndTheArchive) {
  for (const char* file : {"in/a.ply", "in/.b.ply", "in/.git/c.ply", "in/x/.y/d.ply"}) add(file);
  add("archive/scans/e.ply");
  EXPECT_EQ(names({folder_ / "in"}), Names{"a.ply"});
  EXPECT_EQ(names({folder_.path()}), Names{"in__a.ply"});
  EXPECT_EQ(find_scans({folder_.path()}, folder_ / "in" / ".." / "archive").scans.size(), 1u);
}

TEST_F(FindScansTest, FoldersMayBeNamedLikeScans) {
  add("in/folder.ply/a.ply");
  EXPECT_EQ(names({folder_ / "in"}), Names{"folder.ply__a.ply"});
}

TEST_F(FindScansTest, LinksToFoldersAreFollowedOnce) {
  add("in/a/x.ply");
  add("elsewhere/y.ply");
  add("elsewhere/deep/z.ply");
  fs::create_directory_symlink(folder_ / "in", folder_ / "in/a/up");
  fs::create_directory_symlink(".", folder_ / "in/same");
  fs::create_directory_symlink(folder_ / "elsewhere", folder_ / "in/there");
  fs::create_directory_symlink(folder_ / "in/there", folder_ / "elsewhere/here");
  EXPECT_EQ(names({folder_ / "in"}), (Names{"a__x.ply", "there__deep__z.ply", "there__y.ply"}));
  EXPECT_EQ(names({folder_ / "in/there"}), (Names{"deep__z.ply", "y.ply"}));
}

/// The way without links wins, however deep it is, and then the first link by name.
TEST_F(FindScansTest, AFolderWithSeveralWaysHasTheNameOfTheFirst) {
  add("in/z/real/x.ply");
  add("elsewhere/y/y.ply");
  fs::create_directory_symlink(folder_ / "in/z/real", folder_ / "in/a_link");
  fs::create_directory_symlink(folder_ / "elsewhere", folder_ / "in/n");
  fs::create_directory_symlink(folder_ / "elsewhere/y", folder_ / "in/m");
  EXPECT_EQ(names({folder_ / "in"}), (Names{"m__y.ply", "z__real__x.ply"}));
}

TEST_F(FindScansTest, ALinkToTheArchiveIsNotFollowed) {
  add("in/a.ply");
  add("archive/scans/e.ply");
  fs::create_directory_symlink(folder_ / "archive", folder_ / "in/results");
  EXPECT_EQ(names({folder_ / "in"}), Names{"a.ply"});
}

TEST_F(FindScansTest, CountsWhatItPassesOver) {
  for (const char* file : {"in/a.ply", "in/a.jpg", "in/b/b.JPG", "in/b/c.jpg", "in/b/c.mtl",
                           "in/README", "in/x.a file", "in/.hidden.jpg", "in/.git/x.jpg"})
    add(file);
  fs::create_directory_symlink(folder_ / "in/b", folder_ / "in/link");
  for (const auto& inputs : {std::vector<fs::path>{folder_ / "in"},
                             {folder_ / "in", folder_ / "in/b", folder_ / "in/a.ply"}}) {
    const PassedOver passed_over = find_scans(inputs, folder_ / "archive").passed_over;
    EXPECT_EQ(passed_over.files,
              (std::map<std::string, std::int64_t>{{".jpg", 3}, {".mtl", 1}, {"other", 2}}));
    EXPECT_EQ(in_words(passed_over), "3 .jpg, 1 .mtl, 2 other");
  }
  EXPECT_EQ(in_words({}), "");
}

TEST_F(FindScansTest, ContainersAreSearchedLikeFolders) {
  fs::create_directories(folder_ / "in/sub");
  const fs::path box = tests::write_container(folder_ / "in/sub/box.zip", "zip",
                                              {{.name = "part/b.ply", .bytes = "1"},
                                               {.name = "part/a.obj.xz", .bytes = "22"},
                                               {.name = "../../out.ply", .bytes = "3"},
                                               {.name = "t.jpg", .bytes = "4"},
                                               {.name = "inner.zip", .bytes = "5"},
                                               {.name = "__MACOSX/._a.ply", .bytes = "6"},
                                               {.name = "out.ply", .bytes = "7"}});
  tests::write_container(folder_ / "in/a.tgz", "pax",
                         {{.name = "x.ply"}, {.name = "y.ply", .link = "x.ply"}}, "gzip");
  add("in/z.ply");
  EXPECT_EQ(names({folder_ / "in"}),
            (Names{"a.tgz__x.ply", "sub__box.zip__out.ply", "sub__box.zip__part__a.obj.xz",
                   "sub__box.zip__part__b.ply", "z.ply"}));
  const FoundScans found = find_scans({box, folder_ / "in"}, folder_ / "archive");
  EXPECT_EQ(found.scans.size(), 5u);
  const FoundScan& scan = found.scans.at(2);
  EXPECT_EQ(scan.input, box / "part/b.ply");
  EXPECT_EQ(scan.relative, "box.zip/part/b.ply");
  EXPECT_EQ(scan.file, fs::canonical(box) / "part/b.ply");
  EXPECT_EQ(scan.container, box);
  EXPECT_EQ(scan.bytes, 1u);
  EXPECT_EQ(in_words(found.passed_over), "1 .jpg, 1 .zip, 1 links in containers");
  ASSERT_EQ(found.passed_over.notes.size(), 2u);
  EXPECT_EQ(found.passed_over.notes[0],
            (box / "inner.zip").string() + ": a container in a container is not opened; unpack it");
  EXPECT_NE(found.passed_over.notes[1].find("1 members have the name"), std::string::npos);
}

TEST_F(FindScansTest, InputsMayLeadThroughContainers) {
  const fs::path box = tests::write_container(
      folder_ / "box.tar", "pax", {{.name = "a/x.ply"}, {.name = "a/y.ply"}, {.name = "ab/z.ply"}});
  EXPECT_EQ(names({box / "a/x.ply"}), Names{"box.tar__a__x.ply"});
  EXPECT_EQ(names({box / "a"}), (Names{"box.tar__a__x.ply", "box.tar__a__y.ply"}));
  EXPECT_EQ(names({box / "ab", box / "a/y.ply", box}),
            (Names{"box.tar__ab__z.ply", "box.tar__a__y.ply", "box.tar__a__x.ply"}));
  EXPECT_THROW(find({box / "b"}), io::Error);
  EXPECT_THROW(find({box / "a/x"}), io::Error);
}

TEST_F(FindScansTest, ADamagedContainerHarmsNoOther) {
  add("in/z.ply");
  std::ofstream(folder_ / "in/bad.zip") << "<html>not found</html>";
  const std::string bytes(5000, 'x');
  const fs::path cut = tests::write_container(
      folder_ / "in/cut.tar", "pax",
      {{.name = "a.ply", .bytes = bytes}, {.name = "b.ply", .bytes = bytes}});
  fs::resize_file(cut, 10'000);
  tests::write_container(folder_ / "in/secret.zip", "zip", {{.name = "s.ply", .bytes = "1"}}, "",
                         "zip:encryption=aes256", "password");
  const auto found = find({folder_ / "in"});
  ASSERT_EQ(found.size(), 6u);
  EXPECT_NE(found[0].error.find("bad.zip: the file is a web page"), std::string::npos);
  EXPECT_EQ(found[1].name, "cut.tar__a.ply");
  EXPECT_EQ(found[1].error, "");
  EXPECT_EQ(found[2].name, "cut.tar__b.ply");
  EXPECT_NE(found[3].error.find("cut.tar: "), std::string::npos) << found[3].error;
  EXPECT_NE(found[4].error.find("s.ply: is encrypted"), std::string::npos) << found[4].error;
  EXPECT_EQ(found[5].name, "z.ply");
}

TEST(PassedOverTest, NamesTheMostFrequentKinds) {
  PassedOver passed_over;
  for (int i = 0; i < 30; ++i) passed_over.files["." + std::to_string(100 + i)] = i < 10 ? 1 : 2;
  const std::string words = in_words(passed_over);
  EXPECT_TRUE(words.starts_with("2 .110, 2 .111, ")) << words;
  EXPECT_TRUE(words.ends_with("2 .129, 10 other")) << words;
}

TEST_F(FindScansTest, LinksToScansAreScansOnce) {
  const fs::path real = add("in/real.ply");
  fs::create_symlink(real, folder_ / "in/z.ply");
  EXPECT_EQ(names({folder_ / "in"}), Names{"real.ply"});
}

// Only its own job may fail, later and by name.
TEST_F(FindScansTest, LinksThatLeadNowhereDoNotHideTheOthers) {
  add("in/good.ply");
  fs::create_symlink("b.ply", folder_ / "in/a.ply");
  fs::create_symlink("a.ply", folder_ / "in/b.ply");
  fs::create_symlink("gone", folder_ / "in/dangling.ply");
  EXPECT_EQ(names({folder_ / "in"}), (Names{"a.ply", "b.ply", "dangling.ply", "good.ply"}));
}

TEST_F(FindScansTest, AScanNamedTwiceIsOneScan) {
  add("in/a.ply");
  add("in/b/c.ply");
  EXPECT_EQ(names({folder_ / "in", folder_ / "in/a.ply", folder_ / "in/b",
                   folder_ / "in/b/../a.ply", folder_ / "in"}),
            (Names{"a.ply", "b__c.ply"}));
}

TEST_F(FindScansTest, TheWayAFolderIsWrittenDoesNotMatter) {
  add("in/b/c.ply");
  for (const char* way : {"in", "in/", "in/.", "in/b/..", "./in"})
    EXPECT_EQ(names({folder_ / way}), Names{"b__c.ply"}) << way;
}

TEST_F(FindScansTest, NamesAreSafeWhateverThePath) {
  const std::string parts[] = {"Krug Nº 7",   "spaces in it", "a..b", "..hidden..", "new\nline",
                               "back\\slash", "quote'\"",     "-x",   "%41",        "\xff\xfe",
                               "__",          "a__b",         "*?",   "~",          "日本"};
  for (const auto& part : parts) add("in/d/" + part + ".ply");
  for (const auto& part : parts)
    if (!part.starts_with('.')) add("in/" + part + "/x.ply");
  const auto found = names({folder_ / "in"});
  EXPECT_EQ(found.size(), 14u + 14u);
  for (const std::string& name : found) {
    EXPECT_TRUE(std::ranges::all_of(name, [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '.' || c == '-' || c == '_';
    })) << name;
    EXPECT_FALSE(name.starts_with('.')) << name;
  }
  EXPECT_EQ(std::set(found.begin(), found.end()).size(), found.size());
}

TEST_F(FindScansTest, HiddenScansThatTheUserNamesGetVisibleNames) {
  add(".a.ply");
  const auto found = names({folder_ / ".a.ply"});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_FALSE(found[0].starts_with('.')) << found[0];
}

TEST_F(FindScansTest, NamesThatCouldBeMisreadEndInAHash) {
  for (const char* file : {"in/a/b.ply", "in/a__b.ply", "in/a b.ply", "in/a_b.ply", "in/a/_b.ply",
                           "in/a_/b.ply", "in/a/_/b.ply"})
    add(file);
  const auto found = names({folder_ / "in"});
  EXPECT_EQ(std::set(found.begin(), found.end()).size(), 7u);
  EXPECT_EQ(std::ranges::count(found, "a__b.ply"), 1);
  EXPECT_EQ(std::ranges::count(found, "a_b.ply"), 1);
}

// Or adding one scan would rename, and compute again, another.
TEST_F(FindScansTest, ANameDependsOnThePathAlone) {
  const char* const files[] = {"in/a_/b.ply", "in/a/_b.ply", "in/a__b.ply", "in/a b.ply",
                               "in/a/b.ply"};
  for (const char* file : files) add(file);
  const auto together = find({folder_ / "in"});
  ASSERT_EQ(together.size(), 5u);
  for (const FoundScan& scan : together) {
    fs::remove_all(folder_ / "in");
    add(scan.input.lexically_relative(folder_.path()));
    EXPECT_EQ(names({folder_ / "in"}), Names{scan.name}) << scan.input;
  }
}

TEST_F(FindScansTest, LongPathsGetShortNames) {
  std::string path = "in";
  for (int i = 0; i < 20; ++i) path += "/" + std::string(30, static_cast<char>('a' + i));
  add(path + "/x.ply");
  add(path.replace(3, 1, "b") + "/x.ply");  // differs in what is cut off
  const auto found = names({folder_ / "in"});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NE(found[0], found[1]);
  for (const auto& name : found) EXPECT_LT(name.size(), 200u);
}

TEST_F(FindScansTest, SaysWhereAScanWasFoundAndWhichFileItIs) {
  const fs::path real = add("in/deep/a b.ply");
  fs::create_symlink(real, folder_ / "link.ply");
  const auto in_folder = find({folder_ / "in/../in"});
  ASSERT_EQ(in_folder.size(), 1u);
  EXPECT_EQ(in_folder[0].relative, "deep/a b.ply");
  EXPECT_EQ(in_folder[0].file, fs::canonical(real));
  const auto alone = find({folder_ / "link.ply"});
  ASSERT_EQ(alone.size(), 1u);
  EXPECT_EQ(alone[0].relative, "link.ply");
  EXPECT_EQ(alone[0].file, fs::canonical(real));
}

// One who may not look into a folder must not hide the others.
TEST_F(FindScansTest, AFolderThatCannotBeSearchedIsNamedAndTheOthersAreSearched) {
  for (const char* file : {"in/a.ply", "in/locked/b.ply", "in/z/c.ply"}) add(file);
  fs::permissions(folder_ / "in/locked", fs::perms::none);
  fs::permissions(folder_.path(), fs::perms(0755));
  const bool root = geteuid() == 0;
  if (root) ASSERT_EQ(seteuid(65534), 0);
  const auto found = find({folder_ / "in"});
  EXPECT_THROW(find({folder_ / "in/locked"}), io::Error);
  if (root) ASSERT_EQ(seteuid(0), 0);
  fs::permissions(folder_ / "in/locked", fs::perms::owner_all);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].name, "a.ply");
  EXPECT_EQ(found[1].name, "z__c.ply");
  EXPECT_TRUE(found[0].error.empty());
  EXPECT_EQ(found[2].input, folder_ / "in/locked");
  EXPECT_TRUE(found[2].error.starts_with((folder_ / "in/locked").string() + ": cannot be searched"))
      << found[2].error;
}

// A folder may be listed by those who may look at nothing in it.
TEST_F(FindScansTest, EachThingThatCannotBeLookedAtIsNamed) {
  for (const char* file : {"in/a.ply", "in/listed/one/b.ply", "in/listed/two/c.ply"}) add(file);
  fs::create_directory_symlink("one", folder_ / "in/listed/way");
  const fs::perms listed = fs::perms(0444);
  fs::permissions(folder_ / "in/listed", listed);
  fs::permissions(folder_.path(), fs::perms(0755));
  const bool root = geteuid() == 0;
  if (root) ASSERT_EQ(seteuid(65534), 0);
  const auto found = find({folder_ / "in"});
  EXPECT_THROW(find({folder_ / "in/listed/one"}), io::ReadError);
  if (root) ASSERT_EQ(seteuid(0), 0);
  fs::permissions(folder_ / "in/listed", fs::perms::owner_all);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].name, "a.ply");
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(found[1 + i].input, folder_ / "in/listed" /
                                      (i == 0   ? "one"
                                       : i == 1 ? "two"
                                                : "way"));
    EXPECT_NE(found[1 + i].error.find(": cannot be searched"), std::string::npos);
  }
}

TEST_F(FindScansTest, InputsThatAreNoScansAreErrorsThatNameThem) {
  add("in/a.ply");
  add("in/notes.txt");
  for (const char* input : {"in/missing.ply", "missing", "in/notes.txt", "in/a.ply/b.ply"}) {
    try {
      find({folder_ / "in/a.ply", folder_ / input});
      ADD_FAILURE() << input << " was accepted";
    } catch (const io::Error& error) {
      EXPECT_EQ(error.file(), folder_ / input);
      EXPECT_FALSE(error.remedy().empty());
    }
  }
}

TEST_F(FindScansTest, AnEmptyFolderHoldsNothing) {
  fs::create_directories(folder_ / "in");
  EXPECT_TRUE(find({folder_ / "in"}).empty());
}

TEST_F(FindScansTest, FilesThatBelongToAScanAreNotPassedOver) {
  add("in/a.bin");
  add("in/part/b.bin");
  add("in/other.bin");
  std::ofstream(folder_ / "in/a.gltf")
      << R"({"asset":{"version":"2.0"},"buffers":[{"uri":"a.bin","byteLength":1},)"
         R"({"uri":"part/b.bin","byteLength":1},{"uri":"gone.bin","byteLength":1}]})";
  fs::copy_file(folder_ / "in/a.gltf", folder_ / "in/again.gltf");
  EXPECT_EQ(in_words(find_scans({folder_ / "in"}, folder_ / "archive").passed_over), "1 .bin");
}

}  // namespace
}  // namespace semigeo::jobs
