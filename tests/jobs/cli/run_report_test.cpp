#include "jobs/cli/run_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "io/files/printable.hpp"
#include "jobs/kinds/surface.hpp"
#include "jobs/stages/surface_job.hpp"

namespace semigeo::jobs::cli {
namespace {

constexpr std::size_t kColumns = 80;

/// Returns the result of a run over scans, of which every third has failed, and all others needed
/// repairs and have lost parts. The later ones have lost more.
RunResult result_of(int scans) {
  RunResult result;
  for (int i = 0; i < scans; ++i) {
    const std::string name = "site_" + std::to_string(i) + "__a_rather_long_name_of_a_scan.ply";
    PlannedJob& planned = result.plan.emplace_back();
    planned.job = {.kind = &surface_kind(),
                   .name = name,
                   .input = "/data/scans/2026/" + name,
                   .output = "archive/scans/" + name + ".vtkhdf",
                   .key = "k",
                   .data = SurfaceJobData()};
    JobOutcome& outcome = result.outcomes.emplace_back();
    if (i % 3 == 0) {
      outcome.state = JobState::kFailed;
      outcome.error = planned.job.input.string() + ": line " + std::to_string(i) + ": problem " +
                      std::string(1, static_cast<char>('a' + i % 7)) +
                      " of the file that takes some words to describe; export the scan again from "
                      "the program that made it, or leave it out";
      ++result.summary.failed;
      continue;
    }
    SurfaceJobResult made;
    made.vertices = 1000;
    made.triangles = 2000;
    made.levels = 9;
    made.repairs.surface.welded_vertices = 10;
    made.repairs.surface.degenerate_faces = i;
    made.repairs.surface.flipped_faces = 3;
    made.repairs.bad_vertices = 1;
    made.preparation.holes.loops = 3;
    made.preparation.holes.filled = 2;
    made.preparation.holes.outer = 1;
    made.preparation.removed_vertices = 5;
    made.remeshed.torn = 1;
    made.remeshed.dropped_parts = i;
    outcome.state = JobState::kDone;
    outcome.result = made;
    ++result.summary.done;
  }
  return result;
}

std::string printed(const RunResult& result, const RunNotes& notes = {}) {
  testing::internal::CaptureStdout();
  print_run(result, notes);
  return testing::internal::GetCapturedStdout();
}

std::size_t rows_on_a_terminal(const std::string& text) {
  std::istringstream lines(text);
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line);)
    rows += std::max<std::size_t>(1, (io::count_characters(line) + kColumns - 1) / kColumns);
  return rows;
}

TEST(RunReportTest, TheEndOfALargeRunFitsOnAScreen) {
  RunNotes notes{.passed_over = {.files = {{".jpg", 4000}, {".mtl", 3000}, {"other", 20}}},
                 .home = "/data/archive"};
  notes.leftovers.text = "leftovers: " + std::string(140, 'x');
  const std::string text = printed(result_of(4000), notes);
  EXPECT_LE(rows_on_a_terminal(text), 23u) << text;  // and the prompt
  EXPECT_NE(text.find("repaired: 2666 scans: "), std::string::npos) << text;
  EXPECT_NE(text.find("evolved: 2666 scans: "), std::string::npos) << text;
  EXPECT_NE(text.find("details: semigeo status /data/archive --details\n"), std::string::npos);
}

TEST(RunReportTest, SumsAndTheWorstScansAreNamed) {
  const std::string text = printed(result_of(12));
  // 1 + 2 + 4 + 5 + 7 + 8 + 10 + 11
  EXPECT_NE(
      text.find("repaired: 8 scans: 80 welded vertices, 48 degenerate faces, 24 flipped faces "
                "and others\n  most: site_11__"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("evolved: 8 scans: 48 parts lost, 8 necks torn\n  most: site_11__"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("failed: /data/scans"), std::string::npos);
}

TEST(RunReportTest, AFewScansHaveTheirOwnLines) {
  const std::string text = printed(result_of(5));
  EXPECT_NE(text.find("repaired: site_1__a_rather_long_name_of_a_scan.ply: 1 bad vertices, "
                      "1 degenerate faces, 3 flipped faces, 10 welded vertices\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("details:"), std::string::npos);
}

TEST(RunReportTest, FailuresThatWereToldAreNotRepeated) {
  EXPECT_EQ(printed(result_of(5), {.failures_were_told = true}).find("failed: "),
            std::string::npos);
}

TEST(RunReportTest, JsonHasEveryScan) {
  testing::internal::CaptureStdout();
  print_json(result_of(300));
  const auto document = nlohmann::json::parse(testing::internal::GetCapturedStdout());
  ASSERT_EQ(document["scans"].size(), 300u);
  EXPECT_EQ(document["scans"][299]["repairs"]["degenerate_faces"], 299);
  EXPECT_FALSE(document["scans"][0]["error"].empty());
}

}  // namespace
}  // namespace semigeo::jobs::cli
