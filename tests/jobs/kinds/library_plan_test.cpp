#include "jobs/kinds/library_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "jobs/kinds/library.hpp"
#include "jobs/kinds/triplets.hpp"
#include "jobs/run/local_runner.hpp"
#include "jobs/stages/library_job.hpp"
#include "tests/jobs/scans_to_run.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

class LibraryPlanTest : public testing::Test {
 protected:
  LibraryPlanTest() {
    fs::create_directories(folder_ / "in");
    config_.inputs = {folder_ / "in"};
    config_.archive = folder_ / "archive";
    config_.surface.levels = 1;
    add("a.obj", 3);
    add("b.obj", 2);
  }
  void add(const char* name, int subdivisions) {
    tests::write_obj(folder_ / "in" / name, shapes::icosphere(subdivisions));
  }
  std::vector<PlannedJob> plan(bool with_scans = true) {
    DigestCache nothing(config_.archive);
    std::vector<PlannedJob> plan;
    if (with_scans) plan = plan_scans(config_);
    const auto models = models_of(config_.archive, plan, nothing);
    plan_library(plan, models, place_of_archive(config_.archive), config_.recognition);
    return plan;
  }
  std::vector<JobOutcome> run(const std::vector<PlannedJob>& plan) {
    Progress progress(0, 0);
    testing::internal::CaptureStderr();
    auto outcomes =
        run_jobs(plan, {.program = SEMIGEO_PROGRAM, .logs = config_.archive / "logs", .threads = 2},
                 progress);
    testing::internal::GetCapturedStderr();
    return outcomes;
  }
  static std::vector<JobState> states(const std::vector<JobOutcome>& outcomes) {
    std::vector<JobState> result;
    for (const JobOutcome& outcome : outcomes) result.push_back(outcome.state);
    return result;
  }
  static Names ids(const std::vector<PlannedJob>& plan) {
    Names result;
    for (const PlannedJob& planned : plan) result.push_back(job_id(planned.job));
    return result;
  }

  tests::TemporaryFolder folder_;
  tests::ScansToRun config_;
};

/// The files of one model of an archive.
struct PlacesOfB {
  explicit PlacesOfB(const fs::path& archive)
      : dataset(dataset_path(archive, "b.obj")),
        run(run_path(place_of_archive(archive).parts, "b.obj")),
        library(place_of_archive(archive).library) {}
  fs::path dataset, run, library;
};

TEST_F(LibraryPlanTest, AllOfItIsKnownBeforeAnythingRuns) {
  const auto before = plan();
  EXPECT_EQ(ids(before), (Names{"surface a.obj", "surface b.obj", "triplets a.obj",
                                "triplets b.obj", "partition 000.part", "library library.h5"}));
  EXPECT_EQ(before[3].after, (std::vector<std::size_t>{1}));
  EXPECT_EQ(before[4].after, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(before[5].after, (std::vector<std::size_t>{4}));
  EXPECT_EQ(in_words(before[2].reasons.front()), "no run yet");
  const auto outcomes = run(before);
  EXPECT_EQ(states(outcomes), std::vector<JobState>(6, JobState::kDone));
  // The keys were those of what was made.
  for (const PlannedJob& planned : before) EXPECT_TRUE(is_complete(planned.job));
  const auto after = plan();
  EXPECT_TRUE(std::ranges::all_of(after, &PlannedJob::up_to_date));
  EXPECT_EQ(std::any_cast<const LibraryJobResult&>(outcomes[5].result).models, 2);
}

TEST_F(LibraryPlanTest, DatasetsWhoseScansAreGoneBelongToIt) {
  const auto first = plan();
  run(first);
  fs::remove(folder_ / "in/a.obj");
  EXPECT_TRUE(std::ranges::all_of(plan(), &PlannedJob::up_to_date));
  const auto without_scans = plan(false);
  EXPECT_EQ(without_scans.back().job.key, first.back().job.key);
  EXPECT_TRUE(without_scans.back().up_to_date);
}

TEST_F(LibraryPlanTest, AScanThatFailsCostsItsModelOnly) {
  std::ofstream(folder_ / "in/bad.obj") << "v 0 0 0\nf 1 2 7\n";
  const auto planned = plan();
  const auto outcomes = run(planned);
  using enum JobState;
  EXPECT_EQ(states(outcomes),
            (std::vector{kDone, kDone, kFailed, kDone, kDone, kSkipped, kDone, kDone}));
  EXPECT_EQ(missing_models(planned.back().job, kDone), (Names{"bad.obj"}));
  // It fails again; what the others gave is up to date all the same.
  EXPECT_EQ(states(run(plan())), (std::vector{kUpToDate, kUpToDate, kFailed, kUpToDate, kUpToDate,
                                              kSkipped, kUpToDate, kUpToDate}));
}

/// Puts a file at the path that the system refuses to open, whoever asks for it (ELOOP).
void refuse(const fs::path& path) {
  fs::remove(path);
  fs::create_symlink(path, path);
}

TEST_F(LibraryPlanTest, ARunThatCannotBeOpenedIsNotAbsent) {
  run(plan());
  const PlacesOfB b(config_.archive);
  refuse(b.run);
  using enum JobState;
  auto outcomes = run(plan());
  EXPECT_EQ(states(outcomes),
            (std::vector{kUpToDate, kUpToDate, kUpToDate, kFailed, kUpToDate, kUpToDate}));
  EXPECT_TRUE(outcomes[3].error.starts_with(b.run.string() + ": cannot be opened"))
      << outcomes[3].error;
  // A library without its model is not made.
  fs::remove(b.library);
  outcomes = run(plan());
  EXPECT_EQ(outcomes[3].state, kFailed);
  EXPECT_EQ(outcomes[5].state, kFailed);
  EXPECT_TRUE(outcomes[5].error.starts_with(b.run.string() + ": ")) << outcomes[5].error;
  EXPECT_FALSE(fs::exists(b.library));
  EXPECT_TRUE(fs::is_symlink(b.run));  // nobody has removed what could not be read
}

TEST_F(LibraryPlanTest, ADatasetThatCannotBeOpenedIsNeitherMadeAgainNorLost) {
  run(plan());
  const PlacesOfB b(config_.archive);
  refuse(b.dataset);
  using enum JobState;
  const auto outcomes = run(plan());
  EXPECT_EQ(outcomes[1].state, kFailed);
  EXPECT_TRUE(outcomes[1].error.starts_with(b.dataset.string() + ": ")) << outcomes[1].error;
  EXPECT_TRUE(fs::is_symlink(b.dataset));
  EXPECT_TRUE(fs::is_regular_file(b.run));
}

TEST_F(LibraryPlanTest, ALibraryNamesTheModelsThatItWasToHave) {
  const auto planned = plan();
  run(planned);
  Job library = planned.back().job;
  EXPECT_FALSE(library.kind->summary(library, JobState::kDone)->is_incomplete);
  fs::remove(PlacesOfB(config_.archive).run);  // what counts is what the library holds
  EXPECT_EQ(missing_models(library, JobState::kDone), Names{});
  std::any_cast<LibraryJobData&>(library.data).models = {"a.obj", "b.obj", "c.obj"};
  const auto told = library.kind->summary(library, JobState::kUpToDate);
  EXPECT_TRUE(told->is_incomplete);
  EXPECT_NE(told->text.find(": 2 of 3 models, up to date; missing: c.obj"), std::string::npos)
      << told->text;
}

TEST_F(LibraryPlanTest, AnotherScanMakesItsModelAgain) {
  run(plan());
  add("b.obj", 3);
  const auto planned = plan();
  EXPECT_TRUE(planned[2].up_to_date);
  EXPECT_EQ(in_short(planned[3].reasons), "the dataset, the parameters or the program changed");
  EXPECT_EQ(in_short(planned[5].reasons), "the models, the parameters or the program changed");
  using enum JobState;
  EXPECT_EQ(states(run(planned)), (std::vector{kUpToDate, kDone, kUpToDate, kDone, kDone, kDone}));
}

TEST_F(LibraryPlanTest, WhatHasFailedSinceKeepsTheModelOfItsDataset) {
  run(plan());
  std::ofstream(folder_ / "in/a.obj") << "v 0 0 0\nf 1 2 7\n";
  using enum JobState;
  EXPECT_EQ(states(run(plan())),
            (std::vector{kFailed, kUpToDate, kUpToDate, kUpToDate, kUpToDate, kUpToDate}));
}

TEST_F(LibraryPlanTest, WithoutAnyModelThereIsNoLibrary) {
  fs::remove_all(folder_ / "in");
  fs::create_directories(folder_ / "in");
  std::ofstream(folder_ / "in/bad.obj") << "v 0 0 0\nf 1 2 7\n";
  using enum JobState;
  EXPECT_EQ(states(run(plan())), (std::vector{kFailed, kSkipped, kSkipped, kSkipped}));
  EXPECT_FALSE(fs::exists(config_.archive / "library.h5"));
}

TEST_F(LibraryPlanTest, SparePartsGo) {
  const auto planned = plan();
  run(planned);
  const fs::path parts = config_.archive / "library";
  fs::copy(run_path(parts, "a.obj"), run_path(parts, "old.obj"));
  EXPECT_TRUE(fs::exists(parts / "partitions/000.part"));
  library_kind().clean_up(planned.back().job);
  EXPECT_FALSE(fs::exists(parts / "partitions"));
  EXPECT_FALSE(fs::exists(run_path(parts, "old.obj")));
  EXPECT_TRUE(std::ranges::all_of(plan(), &PlannedJob::up_to_date));
}

TEST_F(LibraryPlanTest, VerificationFindsDamageBehindHeaders) {
  run(plan());
  const auto damage = [](const fs::path& path) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(fs::file_size(path) / 2));
    file.put('\x55');
  };
  damage(run_path(config_.archive / "library", "a.obj"));
  auto found = plan();
  EXPECT_TRUE(found[2].up_to_date);
  verify_library_plan(found);
  EXPECT_FALSE(found[2].up_to_date);
  EXPECT_EQ(found[2].reasons.front().kind, Reason::Kind::kDamagedOutput);
  EXPECT_TRUE(found[5].up_to_date);
  remove_damaged_outputs(found);
  using enum JobState;
  EXPECT_EQ(states(run(found))[2], kDone);
}

TEST(LibraryPlaceTest, TellsLibrariesOfArchivesFromOthers) {
  const tests::TemporaryFolder folder;
  EXPECT_EQ(place_of(folder / "library.h5").parts, folder / "library.h5.parts");
  fs::create_directories(folder / "scans");
  EXPECT_EQ(place_of(folder / "library.h5").parts, folder / "library");
  EXPECT_EQ(place_of(folder / "library.h5").home, folder.path());
  EXPECT_EQ(place_of(folder / "other.h5").home, folder / "other.h5.parts");
}

}  // namespace
}  // namespace semigeo::jobs
