#include "jobs/bench/bench_json.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/jobs/bench/made_report.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

using nlohmann::json;

TEST(GoogleDocumentTest, HasEveryRepetitionAndFourAggregates) {
  const json document = google_document(made_report());
  std::vector<json> scans;
  for (const json& entry : document["benchmarks"])
    if (entry["run_name"] == "job/scan/threads:1") scans.push_back(entry);
  ASSERT_EQ(scans.size(), 7U);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(scans[i]["name"], "job/scan/threads:1");
    EXPECT_EQ(scans[i]["run_type"], "iteration");
    EXPECT_EQ(scans[i]["repetition_index"], i);
    EXPECT_EQ(scans[i]["repetitions"], 3);
    EXPECT_EQ(scans[i]["iterations"], 2);
    EXPECT_EQ(scans[i]["threads"], 1);
    EXPECT_EQ(scans[i]["time_unit"], "ms");
    EXPECT_EQ(scans[i]["real_time"], 500);
    EXPECT_EQ(scans[i]["cpu_time"], 250);
    EXPECT_EQ(scans[i]["microseconds_per_vertex_level"], 1);
  }
  EXPECT_EQ(scans[1]["items_per_second"], 1.5);
  EXPECT_EQ(scans[3]["name"], "job/scan/threads:1_mean");
  EXPECT_EQ(scans[3]["run_type"], "aggregate");
  EXPECT_EQ(scans[4]["aggregate_name"], "median");
  EXPECT_EQ(scans[4]["items_per_second"], 1.5);
  EXPECT_EQ(scans[5]["items_per_second"], 0.5);  // standard deviation of 1, 1.5, 2
  EXPECT_EQ(scans[6]["aggregate_unit"], "percentage");
}

TEST(GoogleDocumentTest, ContextSaysWhereAndUnderWhichLoad) {
  const json context = google_document(made_report())["context"];
  EXPECT_EQ(context["date"], "2026-01-02T03:04:05Z");
  EXPECT_EQ(context["num_cpus"], 2);
  EXPECT_EQ(context["load_avg"], (json{0.5, 1.5}));
  EXPECT_EQ(context["processor"], "A Processor");
  EXPECT_EQ(context["semigeo_version"], "1.2.3");
  EXPECT_EQ(context["instruction_set"], "avx2");
}

TEST(GithubDocumentTest, IsAListOfNamesUnitsValuesAndRanges) {
  const json list = github_document(made_report());
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[1]["name"], "job/scan/threads:1");
  EXPECT_EQ(list[1]["unit"], "scans/s");
  EXPECT_EQ(list[1]["value"], 1.5);
  EXPECT_EQ(list[1]["range"], "± 0.5");
}

class BaselineTest : public testing::Test {
 protected:
  std::filesystem::path write(const json& document) {
    const auto path = folder_ / "baseline.json";
    std::ofstream(path) << document;
    return path;
  }
  std::string refused(const json& document) {
    try {
      read_baseline(write(document), {});
    } catch (const BaselineError& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return "";
  }
  tests::TemporaryFolder folder_;
};

TEST_F(BaselineTest, WhatWasWrittenIsReadBack) {
  const std::vector<NamedRate> rates = read_baseline(write(google_document(made_report())), {});
  ASSERT_EQ(rates.size(), 3U);
  EXPECT_EQ(rates[1].name, "job/scan/threads:1");
  EXPECT_EQ(rates[1].unit, "scans/s");
  EXPECT_EQ(rates[1].rate.median, 1.5);
  EXPECT_EQ(rates[1].rate.low, 1);
  EXPECT_EQ(rates[1].rate.high, 2);
  EXPECT_EQ(rates[1].cpu_rate, 3);
}

TEST_F(BaselineTest, OtherSurfacesAreRefused) {
  json document = google_document(made_report());
  EXPECT_THROW(read_baseline(write(document), {.quick = true}), BaselineError);
  EXPECT_THROW(read_baseline(write(document), {.scan_xxh3 = "a"}), BaselineError);
  document["context"]["workload"] = 0;
  EXPECT_NE(refused(document).find("was measured on other surfaces"), std::string::npos);
}

TEST_F(BaselineTest, OtherFilesAreRefused) {
  for (const json& document :
       {json(), json{1, 2}, json{{"context", 1}}, json{{"a", "b"}}, github_document(made_report())})
    EXPECT_NE(refused(document).find("has no rates"), std::string::npos) << document;
  std::ofstream(folder_ / "text") << "no JSON";
  EXPECT_THROW(read_baseline(folder_ / "text", {}), BaselineError);
  EXPECT_THROW(read_baseline(folder_ / "missing", {}), BaselineError);
}

}  // namespace
}  // namespace semigeo::jobs
