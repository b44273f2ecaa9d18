#include "jobs/bench/report.hpp"

#include <gtest/gtest.h>

#include "tests/jobs/bench/made_report.hpp"

namespace semigeo::jobs {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(FigureNumberTest, HasThreeDigits) {
  EXPECT_EQ(figure_number(0.123456), "0.123");
  EXPECT_EQ(figure_number(17.26), "17.3");
  EXPECT_EQ(figure_number(999.4), "999");
  EXPECT_EQ(figure_number(999.6), "1000");
  EXPECT_EQ(figure_number(1234.5), "1234");
  EXPECT_EQ(figure_number(45678), "45.7 k");
  EXPECT_EQ(figure_number(1.234e6), "1.23 M");
  EXPECT_EQ(figure_number(5e9), "5 G");
}

TEST(ReportTest, TableSaysMachineFiguresNightAndLoad) {
  const std::string text = table_of(made_report());
  EXPECT_TRUE(
      has(text, "A Processor, 2 of 2 cores, 4.0 GB of memory; kernels use avx2 (of scalar, avx2)"));
  EXPECT_TRUE(has(text, "semigeo 1.2.3, Release by GNU 12"));
  EXPECT_TRUE(has(text, "job/scan                     1       1.5 scans/s")) << text;
  EXPECT_TRUE(has(text, "33 %"));  // half of 1 to 2, over 1.5
  EXPECT_TRUE(has(text, "1.00 us"));
  EXPECT_TRUE(has(text, "unclear"));
  // 2 scans a second on all threads, not 1.5 on one.
  EXPECT_TRUE(has(text, "72 k like job/scan (55.6 k vertices)")) << text;
  EXPECT_TRUE(has(text, "load average 0.5 before, 1.5 after"));
  EXPECT_FALSE(has(text, "was not free"));
}

TEST(ReportTest, ABusyMachineIsSaid) {
  BenchReport report = made_report();
  report.measurement.load.other_cores = 0.8;
  report.measurement.load.most_other_cores = 1.5;
  report.measurement.load.most_name = "job/scan/threads:1";
  const std::string text = table_of(report);
  EXPECT_TRUE(has(text, "used 0.8 of 2 cores, at most 1.5 during job/scan/threads:1"));
  EXPECT_TRUE(has(text, "The machine was not free"));
}

TEST(ReportTest, ComparisonNamesWhatDiffersAndWhatFell) {
  const auto rates = [](double machine, double scan) {
    Measurement measurement;
    measurement.figures = {made_figure("machine/memory", 1, {machine, machine}),
                           made_figure("job/scan", 1, {scan, scan})};
    return rates_of(measurement, 2);
  };
  const Comparison comparison = compare(rates(10, 2), rates(5, 1));
  const std::string text = table_of(comparison);
  EXPECT_TRUE(has(text, "0.50  slower")) << text;
  EXPECT_TRUE(has(text, "The machine itself differs: machine/memory/threads:1 is 0.50"));
  EXPECT_EQ(fallen_text(fallen(comparison, 0.9), 0.9),
            "fell: job/scan/threads:1: 1 scans/s, was 2 (0.50)\n");
  EXPECT_EQ(fallen_text({}, 0.9), "No figure fell below 0.9 of the baseline.\n");
}

}  // namespace
}  // namespace semigeo::jobs
