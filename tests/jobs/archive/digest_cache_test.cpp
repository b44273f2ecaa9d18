#include "jobs/archive/digest_cache.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>

#include "engine/run_context.hpp"
#include "io/files/file_digest.hpp"
#include "io/scans/companions.hpp"
#include "jobs/stages/surface_job.hpp"
#include "tests/support/containers.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void set_text(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// The kernel's own time of change cannot be set, but a cache can live later.
std::int64_t in_an_hour() {
  return DigestCache::system_clock() + std::int64_t{3600} * 1'000'000'000;
}

class DigestCacheTest : public testing::Test {
 protected:
  DigestCacheTest() {
    fs::create_directories(folder_ / "scans");
    set_text(scan_, "first");
  }
  FoundScan found(const fs::path& file) const { return {file, "", "", file, ""}; }
  std::string file() const { return text_of(folder_ / "digests.txt"); }
  /// A run: reads what the last one knew, looks at the scans, and writes what it knows.
  std::vector<ScanDigest> run(const std::vector<fs::path>& scans, int threads = 1,
                              DigestCache::Clock clock = in_an_hour) {
    DigestCache cache = DigestCache::read(folder_.path(), clock);
    std::vector<FoundScan> wanted;
    for (const fs::path& scan : scans) wanted.push_back(found(scan));
    auto digests = cache.scan_digests(wanted, threads);
    cache.write();
    return digests;
  }
  /// Writes another digest over the one in the file, as if it had been right: who then tells it has
  /// not read the scan.
  void forge(const std::string& from, const std::string& to) {
    std::string body = file();
    body = body.substr(body.find('\n') + 1);
    ASSERT_NE(body.find(from), std::string::npos) << body;
    body.replace(body.find(from), from.size(), to);
    std::string head = file().substr(0, file().find('\n'));
    head = head.substr(0, head.rfind(' ') + 1) + io::xxh3_of_text(body);
    set_text(folder_ / "digests.txt", head + "\n" + body);
  }
  bool is_remembered(const fs::path& scan) {
    return file().find(scan.string()) != std::string::npos;
  }

  tests::TemporaryFolder folder_;
  const fs::path scan_ = folder_ / "a.ply";
  const std::string first_ = io::xxh3_of_text("first");
  const std::string forged_ = std::string(32, 'f');
};

TEST_F(DigestCacheTest, WhatHasNotChangedIsNotReadAgain) {
  EXPECT_EQ(run({scan_})[0].xxh3, first_);
  forge(first_, forged_);
  EXPECT_EQ(run({scan_})[0].xxh3, forged_);
  EXPECT_EQ(run({scan_}, 7)[0].xxh3, forged_);
}

TEST_F(DigestCacheTest, MembersOfAContainerAreReadOnceAndRemembered) {
  const auto members = [&] { return find_scans({folder_ / "box.tgz"}, folder_ / "none").scans; };
  const auto digests_of = [&](const std::vector<FoundScan>& scans) {
    DigestCache cache = DigestCache::read(folder_.path(), in_an_hour);
    const auto digests = cache.scan_digests(scans, 1);
    cache.write();
    return digests;
  };
  const auto write = [&](const std::string& second) {
    tests::write_container(
        folder_ / "box.tgz", "pax",
        {{.name = "a.ply", .bytes = "first"}, {.name = "b.ply", .bytes = second}}, "gzip");
  };
  write("second");
  const auto digests = digests_of(members());
  ASSERT_EQ(digests.size(), 2u);
  EXPECT_EQ(digests[0].xxh3, first_);
  EXPECT_EQ(digests[1].xxh3, io::xxh3_of_text("second"));
  forge(first_, forged_);
  EXPECT_EQ(digests_of(members())[0].xxh3, forged_);
  run({scan_});  // other scans do not make it forget
  EXPECT_EQ(digests_of(members())[0].xxh3, forged_);
  write("another");
  const auto changed = digests_of(members());
  EXPECT_EQ(changed[0].xxh3, first_);
  EXPECT_EQ(changed[1].xxh3, io::xxh3_of_text("another"));
  fs::remove(folder_ / "box.tgz");
  run({scan_});
  EXPECT_EQ(file().find("box.tgz"), std::string::npos) << file();
}

TEST_F(DigestCacheTest, CompanionsOfAScanBelongToIt) {
  const fs::path scan = folder_ / "a.gltf";
  set_text(scan, R"({"buffers":[{"uri":"a.bin"},{"uri":"b.bin"}]})");
  set_text(folder_ / "a.bin", "one");
  const auto digest = [&] { return run({scan})[0].xxh3; };
  const std::string first = digest();
  EXPECT_EQ(first, io::xxh3_of_scan(scan));
  EXPECT_TRUE(is_remembered(folder_ / "a.bin"));
  forge(first, forged_);
  EXPECT_EQ(digest(), forged_) << "nothing has changed";
  set_text(folder_ / "a.bin", "two");
  const std::string second = digest();
  EXPECT_EQ(second, io::xxh3_of_scan(scan));
  forge(second, forged_);
  set_text(folder_ / "b.bin", "it was absent");
  const std::string third = digest();
  EXPECT_EQ(third, io::xxh3_of_scan(scan));
  EXPECT_NE(third, second);
  run({scan_});  // other scans do not make it forget
  forge(third, forged_);
  EXPECT_EQ(digest(), forged_);
  fs::remove(folder_ / "b.bin");
  EXPECT_EQ(digest(), second);
}

TEST_F(DigestCacheTest, CompanionsThatChangedAMomentAgoAreNotRemembered) {
  const fs::path scan = folder_ / "a.gltf";
  set_text(scan, R"({"buffers":[{"uri":"a.bin"}]})");
  set_text(folder_ / "a.bin", "one");
  EXPECT_EQ(run({scan}, 1, DigestCache::system_clock)[0].xxh3, io::xxh3_of_scan(scan));
  EXPECT_FALSE(is_remembered(scan));
}

TEST_F(DigestCacheTest, CompanionsOfMembersAreMembers) {
  const std::string json = R"({"buffers":[{"uri":"a.bin"},{"uri":"none.bin"}]})";
  const auto digests = [&](const std::string& bytes) {
    tests::write_container(folder_ / "box.tgz", "pax",
                           {{.name = "part/a.bin", .bytes = bytes},
                            {.name = "part/a.gltf", .bytes = json},
                            {.name = "b.ply", .bytes = "second"}},
                           "gzip");
    DigestCache cache = DigestCache::read(folder_.path(), in_an_hour);
    return cache.scan_digests(find_scans({folder_ / "box.tgz"}, folder_ / "none").scans, 1);
  };
  const auto first = digests("one");
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first[0].xxh3, io::xxh3_of_text("second"));
  EXPECT_EQ(first[1].xxh3, io::xxh3_of_scan(folder_ / "box.tgz/part/a.gltf"));
  EXPECT_EQ(first[1].companion_bytes, 3u);
  EXPECT_EQ(first[1].companions.size(), 2u);
  EXPECT_NE(digests("two")[1].xxh3, first[1].xxh3);
}

TEST_F(DigestCacheTest, WhatChangedAMomentAgoIsNotRemembered) {
  EXPECT_EQ(run({scan_}, 1, DigestCache::system_clock)[0].xxh3, first_);
  EXPECT_FALSE(is_remembered(scan_)) << file();
  // An old time of modification does not make it older.
  const timespec times[] = {{1'000'000'000, 0}, {1'000'000'000, 0}};
  ASSERT_EQ(utimensat(AT_FDCWD, scan_.c_str(), times, 0), 0);
  run({scan_}, 1, DigestCache::system_clock);
  EXPECT_FALSE(is_remembered(scan_)) << file();
  run({scan_});
  EXPECT_TRUE(is_remembered(scan_)) << file();
  // Nor is what was remembered trusted once the scan has changed again.
  set_text(scan_, "other");
  EXPECT_EQ(run({scan_}, 1, DigestCache::system_clock)[0].xxh3, io::xxh3_of_text("other"));
  EXPECT_FALSE(is_remembered(scan_)) << file();
}

TEST_F(DigestCacheTest, ATimeOfModificationToComeIsNotTrusted) {
  const timespec times[] = {{4'000'000'000, 0}, {4'000'000'000, 0}};
  ASSERT_EQ(utimensat(AT_FDCWD, scan_.c_str(), times, 0), 0);
  run({scan_});
  EXPECT_FALSE(is_remembered(scan_)) << file();
}

TEST_F(DigestCacheTest, AnyChangeOfTheStampMakesItRead) {
  const fs::path other = folder_ / "b.ply";
  set_text(other, "first");
  run({scan_, other});
  forge(first_, forged_);
  const std::string remembered = file();
  const auto forged_again = [&] {
    set_text(folder_ / "digests.txt", remembered);
    return run({scan_})[0].xxh3 == forged_;
  };
  EXPECT_TRUE(forged_again());

  const FileStamp before = *stamp_of(scan_);
  const timespec restored[] = {{before.modified / 1'000'000'000, before.modified % 1'000'000'000},
                               {before.modified / 1'000'000'000, before.modified % 1'000'000'000}};
  set_text(scan_, "other");  // of the same size, and as if it had not been touched since
  ASSERT_EQ(utimensat(AT_FDCWD, scan_.c_str(), restored, 0), 0);
  const FileStamp after = *stamp_of(scan_);
  EXPECT_EQ(after.size, before.size);
  EXPECT_EQ(after.modified, before.modified);
  EXPECT_EQ(after.inode, before.inode);
  EXPECT_NE(after.changed, before.changed);
  set_text(folder_ / "digests.txt", remembered);
  EXPECT_EQ(run({scan_})[0].xxh3, io::xxh3_of_text("other"));

  fs::rename(other, scan_);  // another inode
  EXPECT_FALSE(forged_again());
  EXPECT_EQ(run({scan_})[0].xxh3, first_);
}

TEST_F(DigestCacheTest, ADamagedFileIsIgnored) {
  run({scan_});
  forge(first_, forged_);
  const std::string whole = file();
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    set_text(folder_ / "digests.txt", damaged);
    EXPECT_EQ(run({scan_})[0].xxh3, first_) << at;
  }
  for (const std::string& text : {std::string(), std::string("\n"), whole.substr(0, 20),
                                  whole.substr(0, whole.size() - 1), whole + "x"}) {
    set_text(folder_ / "digests.txt", text);
    EXPECT_EQ(run({scan_})[0].xxh3, first_) << text;
  }
}

TEST_F(DigestCacheTest, WhatIsNoFileIsReplacedWithoutWaiting) {
  ASSERT_EQ(mkfifo((folder_ / "digests.txt").c_str(), 0666), 0);
  EXPECT_EQ(run({scan_}).front().error, "");
  EXPECT_TRUE(fs::is_regular_file(folder_ / "digests.txt"));
}

TEST_F(DigestCacheTest, IsWrittenOnlyWhenItChanges) {
  run({scan_});
  const FileStamp before = *stamp_of(folder_ / "digests.txt");
  run({scan_});
  EXPECT_EQ(*stamp_of(folder_ / "digests.txt"), before);
}

TEST_F(DigestCacheTest, KeepsWhatOtherRunsLookAtButNotWhatIsGone) {
  const fs::path other = folder_ / "b.ply";
  set_text(other, "second");
  run({scan_, other});
  run({other});
  EXPECT_TRUE(is_remembered(scan_));
  fs::remove(scan_);
  run({other});
  EXPECT_FALSE(is_remembered(scan_));
  EXPECT_TRUE(is_remembered(other));
}

TEST_F(DigestCacheTest, NamesOfAnyBytesAreRightEvenIfNotRemembered) {
  std::vector<fs::path> scans;
  for (const char* name : {"a b.ply", "new\nline.ply", "bad\xff.ply", " .ply", "%0A.ply"}) {
    scans.push_back(folder_ / name);
    set_text(scans.back(), name);
  }
  for (int i = 0; i < 2; ++i) {
    const auto digests = run(scans, 3);
    for (std::size_t k = 0; k < scans.size(); ++k)
      EXPECT_EQ(digests[k].xxh3, io::xxh3_of_text(text_of(scans[k]))) << scans[k];
  }
  EXPECT_TRUE(is_remembered(scans[0]));
  EXPECT_FALSE(is_remembered(scans[1]));
}

TEST_F(DigestCacheTest, WhatCannotBeReadSaysWhy) {
  FoundScan locked = found(folder_ / "locked");
  locked.error = "cannot be searched";
  DigestCache cache(folder_.path());
  const auto digests = cache.scan_digests({found(folder_ / "none.ply"), found(scan_), locked}, 2);
  EXPECT_NE(digests[0].error.find("none.ply"), std::string::npos) << digests[0].error;
  EXPECT_EQ(digests[1].xxh3, first_);
  EXPECT_EQ(digests[2].error, "cannot be searched");
}

TEST_F(DigestCacheTest, DatasetsAreReadOnceToo) {
  SurfaceJob job;
  job.input = tests::write_obj(folder_ / "a.obj", shapes::icosphere(0));
  job.input_xxh3 = io::xxh3_of_file(job.input);
  job.output = dataset_path(folder_.path(), "a.obj");
  job.key = std::string(32, 'a');
  engine::Workers workers(1);
  engine::Observer observer;
  run_surface_job(job, {.levels = 0}, {workers, observer, {}});

  const auto keys = [&](DigestCache::Clock clock = in_an_hour) {
    DigestCache cache = DigestCache::read(folder_.path(), clock);
    const auto found = cache.dataset_keys("a.obj");
    cache.write();
    return found;
  };
  EXPECT_FALSE(DigestCache(folder_.path()).dataset_keys("b.obj"));
  ASSERT_TRUE(keys(DigestCache::system_clock));
  EXPECT_EQ(file().find("a.obj"), std::string::npos);  // just made
  EXPECT_EQ(keys()->job_key, job.key);
  EXPECT_EQ(keys()->input_xxh3, job.input_xxh3);
  forge(job.key, forged_);
  EXPECT_EQ(keys()->job_key, forged_);
  set_text(job.output, "no dataset");
  EXPECT_FALSE(keys());
  EXPECT_FALSE(keys());
}

}  // namespace
}  // namespace semigeo::jobs
