#include "jobs/kinds/leftovers.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "io/files/error.hpp"
#include "io/files/small_file.hpp"
#include "jobs/archive/sources.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

class LeftoversTest : public testing::Test {
 protected:
  LeftoversTest() {
    for (const char* scan : {"in/a.ply", "in/b.ply", "in/day/c.ply", "else/d.ply"}) add_scan(scan);
  }
  fs::path file(const fs::path& path) {
    fs::create_directories((folder_ / path).parent_path());
    std::ofstream(folder_ / path) << "x";
    return folder_ / path;
  }
  /// Adds a scan, and all that an archive has of it. Its name is that of its file.
  void add_scan(const fs::path& path) {
    const std::string name = path.filename().string();
    file(path);
    for (const std::string& made : {"scans/" + name + ".vtkhdf", "scans/" + name + ".xdmf",
                                    "library/triplets/" + name + ".run", "logs/" + name + ".log",
                                    "logs/" + name + ".triplets.log"})
      file("archive" / fs::path(made));
    Sources sources = Sources::read(archive_);
    sources.claim(name, folder_ / path);
    sources.write(archive_);
  }
  void add_scene(const std::string& name, const fs::path& scene) {
    file("archive/recognised/" + name + ".json");
    Sources sources = Sources::read(archive_ / "recognised");
    sources.claim(name, scene);
    sources.write(archive_ / "recognised");
  }
  Leftovers find(const std::vector<fs::path>& folders, const std::set<std::string>& in_use = {}) {
    std::vector<fs::path> named;
    for (const fs::path& folder : folders) named.push_back(folder_ / folder);
    return find_leftovers(archive_, named, in_use);
  }
  Names names(const std::vector<fs::path>& folders, const std::set<std::string>& in_use = {}) {
    Names result;
    for (const Leftover& leftover : find(folders, in_use).list) result.push_back(leftover.name);
    return result;
  }
  std::set<std::string> files() {
    std::set<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(archive_))
      if (entry.is_regular_file() && entry.path().filename() != "sources.json")
        found.insert(entry.path().lexically_relative(archive_).string());
    return found;
  }

  tests::TemporaryFolder folder_;
  const fs::path archive_ = folder_ / "archive";
};

TEST_F(LeftoversTest, NothingIsLeftOverWhileAllScansAreThere) {
  EXPECT_EQ(names({"in", "else"}), Names{});
  EXPECT_TRUE(find({"in"}).emptied.empty());
}

TEST_F(LeftoversTest, AScanThatIsGoneLeavesAllItsFiles) {
  fs::remove(folder_ / "in/b.ply");
  const Leftovers found = find({"in"});
  ASSERT_EQ(found.list.size(), 1u);
  EXPECT_EQ(found.list[0].kind, Leftover::Kind::kDataset);
  EXPECT_EQ(found.list[0].name, "b.ply");
  EXPECT_EQ(found.list[0].scan, folder_ / "in/b.ply");
  EXPECT_EQ(found.list[0].files.size(), 5u);
  EXPECT_EQ(found.list[0].files[0], archive_ / "scans/b.ply.vtkhdf");
  EXPECT_EQ(found.list[0].bytes, 5u);
  const std::set<std::string> before = files();
  remove_leftovers(archive_, found);
  std::set<std::string> after = files();
  EXPECT_EQ(after.size() + 5, before.size());
  for (const std::string& path : after) EXPECT_EQ(path.find("b.ply"), std::string::npos) << path;
  EXPECT_FALSE(Sources::read(archive_).by_name().contains("b.ply"));
  EXPECT_TRUE(Sources::read(archive_).by_name().contains("a.ply"));
  EXPECT_EQ(names({"in"}), Names{});
}

TEST_F(LeftoversTest, WhatBelongsToOtherFoldersStays) {
  for (const char* scan : {"in/b.ply", "in/day/c.ply", "else/d.ply"}) fs::remove(folder_ / scan);
  file("inner/e.ply");
  EXPECT_EQ(names({"in"}), (Names{"b.ply", "c.ply"}));
  EXPECT_EQ(names({"in/day"}), Names{"c.ply"});
  EXPECT_EQ(names({"else"}), Names{"d.ply"});
  EXPECT_EQ(names({"inner"}), Names{});  // its name begins as another's
  EXPECT_EQ(names({"in/../in/day/"}), Names{"c.ply"});
}

TEST_F(LeftoversTest, FoldersBehindLinksBelongToTheFolderOfTheLink) {
  fs::create_directory_symlink(folder_ / "else", folder_ / "in/day/link");
  fs::create_directory_symlink(folder_ / "in", folder_ / "else/back");
  fs::remove(folder_ / "else/d.ply");
  EXPECT_EQ(names({"in"}), Names{"d.ply"});
  EXPECT_EQ(find({"in"}).emptied, std::vector{folder_ / "else"}) << "its disk may not be mounted";
  EXPECT_EQ(names({"in/day/link"}), Names{"d.ply"});
  file("else/e.ply");
  fs::remove(folder_ / "in/day/link");
  EXPECT_EQ(names({"in"}), Names{}) << "nothing leads there any more";
}

TEST_F(LeftoversTest, WhatIsInUseUnderItsNameStays) {
  fs::remove(folder_ / "in/b.ply");
  EXPECT_EQ(names({"in"}, {"b.ply"}), Names{});
  EXPECT_EQ(names({"in"}, {"a.ply"}), Names{"b.ply"});
  EXPECT_TRUE(find({"in"}, {"a.ply", "c.ply"}).emptied.empty());
}

TEST_F(LeftoversTest, WhatSourcesDoNotNameIsNobodysLeftover) {
  file("archive/scans/foreign.vtkhdf");
  file("archive/scans/b.ply.vtkhdf.bak");
  fs::remove(folder_ / "in/b.ply");
  remove_leftovers(archive_, find({"in"}));
  EXPECT_TRUE(files().contains("scans/foreign.vtkhdf"));
  EXPECT_TRUE(files().contains("scans/b.ply.vtkhdf.bak"));
}

TEST_F(LeftoversTest, NoNameLeadsOutOfTheArchive) {
  file("outside.vtkhdf");
  file("archive/sources.json");
  std::ofstream(archive_ / "sources.json")
      << "{\"../../outside\": \"" << (folder_ / "in/gone.ply").string() << "\", \"a.ply\": \""
      << (folder_ / "in/a.ply").string() << "\", \"..\": \"" << (folder_ / "in/x.ply").string()
      << "\"}";
  EXPECT_EQ(names({"in"}), Names{});
}

TEST_F(LeftoversTest, AFolderThatDoesNotExistIsRefused) {
  fs::remove_all(folder_ / "in");
  for (const char* folder : {"in", "in/day", "else/d.ply"}) {
    try {
      find({folder});
      ADD_FAILURE() << folder << " was accepted";
    } catch (const io::Error& error) {
      EXPECT_EQ(error.file(), folder_ / folder);
      EXPECT_NE(error.remedy().find("mounted"), std::string::npos);
    }
  }
}

// A disk that is not mounted leaves an empty folder.
TEST_F(LeftoversTest, AFolderThatHasLostAllIsNamed) {
  fs::remove(folder_ / "else/d.ply");
  EXPECT_EQ(find({"in", "else"}).emptied, std::vector{folder_ / "else"});
  EXPECT_EQ(find({"."}).emptied, std::vector{folder_ / "else"});  // it is empty
  file("else/other.ply");
  EXPECT_EQ(find({"else"}).emptied, std::vector{folder_ / "else"});
  EXPECT_TRUE(find({"."}).emptied.empty());
}

TEST_F(LeftoversTest, AFolderThatWasRemovedFromAnotherIsNoMissingDisk) {
  fs::remove_all(folder_ / "in/day");
  EXPECT_EQ(names({"in"}), Names{"c.ply"});
  EXPECT_TRUE(find({"in"}).emptied.empty());
  fs::create_directories(folder_ / "in/day");
  EXPECT_EQ(find({"in"}).emptied, std::vector{folder_ / "in/day"});
}

TEST_F(LeftoversTest, AScanThatCannotBeSeenIsNotGone) {
  fs::permissions(folder_ / "in/day", fs::perms::none);
  fs::permissions(folder_.path(), fs::perms(0755));
  const bool root = geteuid() == 0;
  if (root) ASSERT_EQ(seteuid(65534), 0);
  const Leftovers found = find({"in"});
  if (root) ASSERT_EQ(seteuid(0), 0);
  fs::permissions(folder_ / "in/day", fs::perms::owner_all);
  EXPECT_TRUE(found.list.empty());
  ASSERT_EQ(found.unknown.size(), 1u);
  EXPECT_EQ(found.unknown[0].file(), folder_ / "in/day/c.ply");
  EXPECT_EQ(found.unknown[0].code(), EACCES);
}

TEST_F(LeftoversTest, RecognisedFilesGoWithTheirScenes) {
  add_scene("a.ply", folder_ / "in/a.ply");
  add_scene("scene.ply", file("in/scene.ply"));
  add_scene("other.ply", file("else/other.ply"));
  add_scene("b.ply.vtkhdf", archive_ / "scans/b.ply.vtkhdf");
  for (const char* scan : {"in/scene.ply", "in/b.ply", "else/other.ply"})
    fs::remove(folder_ / scan);
  EXPECT_EQ(names({"in"}), (Names{"b.ply", "b.ply.vtkhdf", "scene.ply"}));
  remove_leftovers(archive_, find({"in"}));
  EXPECT_FALSE(files().contains("recognised/scene.ply.json"));
  EXPECT_FALSE(files().contains("recognised/b.ply.vtkhdf.json"));
  EXPECT_TRUE(files().contains("recognised/a.ply.json"));
  EXPECT_TRUE(files().contains("recognised/other.ply.json"));
  EXPECT_EQ(Sources::read(archive_ / "recognised").by_name().size(), 2u);
}

TEST_F(LeftoversTest, TheRecordedFoldersAreTheHighestOnes) {
  EXPECT_EQ(recorded_folders(archive_), (std::vector{folder_ / "else", folder_ / "in"}));
  add_scene("b.ply.vtkhdf", archive_ / "scans/b.ply.vtkhdf");
  EXPECT_EQ(recorded_folders(archive_).size(), 2u);
  EXPECT_TRUE(recorded_folders(folder_ / "in").empty());
}

TEST_F(LeftoversTest, NothingIsRemovedBehindALink) {
  fs::remove(folder_ / "in/b.ply");
  const Leftovers found = find({"in"});
  for (const char* folder : {"scans", "logs", "library/triplets"}) {
    const fs::path elsewhere = folder_ / "elsewhere";
    fs::rename(archive_ / folder, elsewhere);
    fs::create_directory_symlink(elsewhere, archive_ / folder);
    EXPECT_THROW(remove_leftovers(archive_, found), io::Error) << folder;
    fs::remove(archive_ / folder);
    fs::rename(elsewhere, archive_ / folder);
  }
  EXPECT_TRUE(files().contains("scans/b.ply.vtkhdf"));
}

TEST_F(LeftoversTest, WhatCannotBeRemovedStaysAndHarmsNoOther) {
  fs::remove(folder_ / "in/b.ply");
  fs::remove(folder_ / "in/day/c.ply");
  const Leftovers found = find({"in"});
  fs::remove(archive_ / "scans/b.ply.xdmf");
  file("archive/scans/b.ply.xdmf/inside");
  const Removal removal = remove_leftovers(archive_, found);
  ASSERT_EQ(removal.removed.size(), 1u);
  EXPECT_EQ(removal.removed[0].name, "c.ply");
  ASSERT_EQ(removal.left.size(), 1u);
  EXPECT_EQ(removal.left[0].name, "b.ply");
  ASSERT_EQ(removal.failures.size(), 1u);
  EXPECT_EQ(removal.failures[0].file(), archive_ / "scans/b.ply.xdmf");
  EXPECT_TRUE(Sources::read(archive_).by_name().contains("b.ply"));
  EXPECT_FALSE(Sources::read(archive_).by_name().contains("c.ply"));
}

TEST_F(LeftoversTest, AScanOfWhichOnlyTheRecordIsThereIsForgotten) {
  fs::remove(folder_ / "in/b.ply");
  const std::string record = io::read_text(archive_ / "sources.json", {});
  remove_leftovers(archive_, find({"in"}));
  const std::string after = io::read_text(archive_ / "sources.json", {});
  std::ofstream(archive_ / "sources.json") << record;  // as if it could not be written
  EXPECT_EQ(names({"in"}), Names{});
  EXPECT_TRUE(remove_leftovers(archive_, find({"in"})).removed.empty());
  EXPECT_EQ(io::read_text(archive_ / "sources.json", {}), after);
}

TEST_F(LeftoversTest, RecordsOfAFolderThatMayBeMissingStay) {
  fs::remove(folder_ / "else/d.ply");
  fs::remove(archive_ / "scans/d.ply.vtkhdf");
  const std::vector<Leftover> found = find({"else"}).list;
  for (const fs::path& path : found[0].files) fs::remove(path);
  EXPECT_TRUE(find({"else"}).recorded.empty());
  EXPECT_TRUE(find({"else"}).emptied.empty());
}

}  // namespace
}  // namespace semigeo::jobs
