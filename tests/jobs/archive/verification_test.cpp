#include "jobs/archive/verification.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "engine/run_context.hpp"
#include "io/files/file_digest.hpp"
#include "io/hdf5/hdf5.hpp"
#include "jobs/stages/surface_job.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// All that HDF5 itself reads in a file.
std::string everything_in(const io::Hdf5File& file, const std::string& group) {
  std::string text = group + "\n";
  for (const io::Hdf5Attribute& attribute : file.attributes(group))
    text += attribute.name + " " + attribute.type + "\n";
  for (const io::Hdf5Link& link : file.links(group)) {
    const std::string path = (group == "/" ? "" : group) + "/" + link.name;
    if (link.kind == io::Hdf5Link::Kind::kGroup) {
      text += everything_in(file, path);
    } else {
      const auto bytes = file.read_through_library(path);
      text.append(path).append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }
  }
  return text;
}

class VerificationTest : public testing::Test {
 protected:
  VerificationTest() {
    const fs::path scan = tests::write_obj(folder_ / "scan.obj", shapes::icosphere(3));
    SurfaceJob job;
    job.input = scan;
    job.output = folder_ / "whole.vtkhdf";
    job.input_xxh3 = io::xxh3_of_file(scan);
    engine::Workers workers(1);
    engine::Observer observer;
    run_surface_job(job, {.levels = 1}, {workers, observer, {}});
    whole_ = bytes_of(job.output);
  }
  /// A copy in which one bit is wrong.
  fs::path damaged(std::size_t at) {
    std::string bytes = whole_;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
    const fs::path path = folder_ / (std::to_string(at) + ".vtkhdf");
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

  tests::TemporaryFolder folder_;
  std::string whole_;
};

TEST_F(VerificationTest, EachHasItsOwnResult) {
  std::ofstream(folder_ / "text.vtkhdf") << "text";
  const std::vector<fs::path> datasets = {folder_ / "whole.vtkhdf", folder_ / "text.vtkhdf",
                                          folder_ / "gone.vtkhdf", folder_ / "whole.vtkhdf"};
  for (const int at_once : {0, 1, 3, 100}) {
    const auto problems = verify_datasets(datasets, at_once);
    ASSERT_EQ(problems.size(), 4u);
    EXPECT_EQ(problems[0].problem, "");
    EXPECT_TRUE(problems[1].problem.starts_with(datasets[1].string() + ": "))
        << problems[1].problem;
    EXPECT_TRUE(problems[2].problem.starts_with(datasets[2].string() + ": "))
        << problems[2].problem;
    EXPECT_NE(problems[1].problem.find("run with --verify"), std::string::npos)
        << problems[1].problem;
    EXPECT_EQ(problems[3].problem, "");
    EXPECT_TRUE(std::ranges::all_of(problems, &Verified::was_read));
  }
  EXPECT_TRUE(verify_datasets({}, 0).empty());
}

TEST_F(VerificationTest, WhatTheSystemRefusesIsNotDamaged) {
  const fs::path circle = folder_ / "circle.vtkhdf";
  fs::create_symlink(circle, circle);
  for (const Verified& verified :
       {verify_datasets({circle}, 1).front(), verify_libraries({circle}).front()}) {
    EXPECT_FALSE(verified.was_read);
    EXPECT_TRUE(verified.problem.starts_with(circle.string() + ": ")) << verified.problem;
    EXPECT_EQ(verified.problem.find("damaged"), std::string::npos) << verified.problem;
  }
}

// Bytes that nothing uses may change; whatever means something must not. The list of what the
// virtual datasets show is where HDF5 itself crashes: it is read densely.
TEST_F(VerificationTest, AWrongBitAnywhereIsFoundOrMeansNothing) {
  const std::string wanted = everything_in(io::Hdf5File::open(folder_ / "whole.vtkhdf"), "/");
  const std::size_t heap = whole_.find("GCOL");
  ASSERT_NE(heap, std::string::npos);
  std::vector<fs::path> datasets;
  const std::size_t step = std::max<std::size_t>(211, whole_.size() / 200) | 1;
  for (std::size_t at = 0; at < whole_.size(); at += at >= heap && at < heap + 1500 ? 7 : step)
    datasets.push_back(damaged(at));
  const auto problems = verify_datasets(datasets, 2);
  int found = 0;
  int crashes = 0;
  int endless = 0;
  for (std::size_t i = 0; i < datasets.size(); ++i) {
    found += problems[i].problem.empty() ? 0 : 1;
    crashes += problems[i].problem.find("crashes") != std::string::npos ? 1 : 0;
    endless += problems[i].problem.find("never ends") != std::string::npos ? 1 : 0;
    if (problems[i].problem.empty())
      ASSERT_TRUE(everything_in(io::Hdf5File::open(datasets[i]), "/") == wanted) << datasets[i];
  }
  EXPECT_GT(found, 100);
  RecordProperty("crashes", crashes);
  RecordProperty("endless", endless);
}

}  // namespace
}  // namespace semigeo::jobs
