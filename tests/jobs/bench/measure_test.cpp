#include "jobs/bench/measure.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace semigeo::jobs {
namespace {

/// Returns a case that counts its calls.
BenchCase counted(const std::string& name, int threads, std::vector<std::string>& calls) {
  return {.name = name,
          .unit = "calls/s",
          .threads = threads,
          .run = [&calls, name](engine::Workers& workers) -> BenchWork {
            calls.push_back(name + std::to_string(workers.threads()));
            return {.amount = 1};
          },
          .prepare = [&calls](engine::Workers&) { calls.push_back("prepare"); }};
}

MeasureSettings settings(int repetitions) {
  return {.repetitions = {.least = repetitions, .most = repetitions}, .least_seconds = 0};
}

TEST(MeasureTest, WorkersStayFromOneMeasurementToTheNext) {
  WorkerSets workers;
  std::vector<engine::Workers*> kept;
  const std::vector<BenchCase> cases = {
      {.name = "a", .unit = "u", .threads = 2, .run = [&](engine::Workers& given) -> BenchWork {
         kept.push_back(&given);
         return {.amount = 1};
       }}};
  measure(cases, workers, settings(1));
  measure(cases, workers, settings(1));
  for (const engine::Workers* given : kept) EXPECT_EQ(given, kept.front());
  EXPECT_EQ(kept.front(), &workers.of(2));
}

TEST(MeasureTest, EveryCaseIsPreparedCalledAndCounted) {
  WorkerSets workers;
  std::vector<std::string> calls;
  const std::vector<BenchCase> cases = {counted("a", 1, calls), counted("b", 2, calls)};
  const Measurement measurement = measure(cases, workers, settings(3));
  EXPECT_TRUE(measurement.complete);
  ASSERT_EQ(measurement.figures.size(), 2U);
  EXPECT_EQ(measurement.figures[1].full_name(), "b/threads:2");
  for (const Figure& figure : measurement.figures) {
    EXPECT_EQ(figure.repetitions.size(), 3U);
    EXPECT_EQ(figure.total(&BenchWork::amount), 3);  // calls to warm up do not count
    EXPECT_GT(figure.rate().median, 0);
  }
  for (std::size_t i = 0; i < calls.size(); ++i) EXPECT_EQ(calls[i] == "prepare", i % 2 == 0);
  EXPECT_EQ(calls[calls.size() - 3], "a1");  // one after the other, not each for itself
  EXPECT_EQ(calls[calls.size() - 1], "b2");
}

TEST(MeasureTest, FastCasesAreCalledUntilARepetitionTakesLongEnough) {
  WorkerSets workers;
  std::vector<std::string> calls;
  MeasureSettings longer = settings(1);
  longer.least_seconds = 0.02;
  const Measurement measurement = measure(std::vector{counted("a", 1, calls)}, workers, longer);
  EXPECT_GT(measurement.figures[0].repetitions.at(0).calls, 10);
}

TEST(MeasureTest, StopsWhenAskedTo) {
  WorkerSets workers;
  std::vector<std::string> calls;
  MeasureSettings stopping = settings(5);
  stopping.progress = [](int done, int, const std::string&) { return done < 2; };
  const Measurement measurement = measure(std::vector{counted("a", 1, calls)}, workers, stopping);
  EXPECT_FALSE(measurement.complete);
  EXPECT_EQ(measurement.figures[0].repetitions.size(), 2U);
}

TEST(MeasureTest, WhatACaseThrowsEndsTheMeasurement) {
  WorkerSets workers;
  const std::vector<BenchCase> cases = {
      {.name = "a", .unit = "u", .run = [](engine::Workers&) -> BenchWork {
         throw std::runtime_error("broken");
       }}};
  EXPECT_THROW(measure(cases, workers, settings(1)), std::runtime_error);
}

}  // namespace
}  // namespace semigeo::jobs
