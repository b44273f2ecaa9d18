#include "jobs/bench/figure.hpp"

#include <gtest/gtest.h>

#include "tests/jobs/bench/made_report.hpp"

namespace semigeo::jobs {
namespace {

TEST(FigureTest, RatesAreMediansOverRepetitions) {
  const Figure figure = made_figure("level/even", 2, {10, 30, 20});
  EXPECT_EQ(figure.full_name(), "level/even/threads:2");
  EXPECT_EQ(figure.rate().median, 20);
  EXPECT_EQ(figure.cpu_rate(), 20);
  EXPECT_EQ(figure.microseconds_per_vertex_level(), 1);
  EXPECT_EQ(figure.total(&BenchRepetition::seconds), 3);
  EXPECT_EQ(figure.total(&BenchWork::amount), 60);
}

TEST(FigureTest, MissingCoresAreThoseThatTheMachineDoesNotHave) {
  Figure figure = made_figure("level/even", 2, {1, 1});
  figure.repetitions[0].other_cores = 1;
  EXPECT_EQ(figure.other_cores(), 0.5);
  EXPECT_EQ(figure.missing_cores(2), 0);  // nothing waited for a core
  for (BenchRepetition& repetition : figure.repetitions) repetition.queued_seconds.reset();
  EXPECT_EQ(figure.missing_cores(2), 0.5);
  EXPECT_TRUE(figure.was_disturbed(2));
  EXPECT_EQ(figure.missing_cores(64), 0);
  EXPECT_FALSE(figure.was_disturbed(64));
}

TEST(FigureTest, WhatWaitsForACoreMissesIt) {
  Figure figure = made_figure("level/even", 2, {1, 1});
  figure.repetitions[0].queued_seconds = 0.5;
  EXPECT_EQ(figure.missing_cores(64), 0.25);
  EXPECT_TRUE(figure.was_disturbed(64));
}

TEST(FindBoundsTest, TakesTheEvidenceFromAllFigures) {
  std::vector<Figure> figures = {
      made_figure("machine/memory", 1, {10}), made_figure("level/even", 1, {100}),
      made_figure("level/even", 2, {190}), made_figure("read/obj", 1, {50})};
  for (Figure& figure : figures)
    for (BenchRepetition& repetition : figure.repetitions) {
      repetition.cpu_seconds = figure.threads;
      repetition.work.memory_bytes = 1e8;  // a hundredth of 10 GB/s
    }
  figures[3].repetitions[0].work.memory_bytes = 9e9;
  find_bounds(figures, 2);
  EXPECT_EQ(figures[1].bound, Bound::kArithmetic);
  EXPECT_EQ(figures[2].bound, Bound::kCores);
  EXPECT_EQ(figures[3].bound, Bound::kMemory);
}

TEST(FindBoundsTest, WithoutRepetitionsNothingIsClear) {
  std::vector<Figure> figures = {made_figure("level/even", 1, {})};
  find_bounds(figures, 2);
  EXPECT_EQ(figures[0].bound, Bound::kUnclear);
}

}  // namespace
}  // namespace semigeo::jobs
