#pragma once

#include "jobs/bench/report.hpp"

namespace semigeo::jobs {

/// Returns a figure with a repetition of one second for each rate.
inline Figure made_figure(const std::string& name, int threads, const std::vector<double>& rates) {
  Figure figure = {.name = name, .unit = "scans/s", .threads = threads};
  for (const double rate : rates)
    figure.repetitions.push_back({.calls = 2,
                                  .seconds = 1,
                                  .cpu_seconds = 0.5 * threads,
                                  .work = {.amount = rate, .vertex_levels = 1e6}});
  return figure;
}

/// Returns a report of a machine of two cores with some figures.
inline BenchReport made_report() {
  BenchReport report;
  report.machine = {.host = "host",
                    .processor = "A Processor",
                    .machine_cores = 2,
                    .usable_cores = 2,
                    .usable_bytes = 4'000'000'000,
                    .system = "Linux 6",
                    .temporary_folder = "/tmp",
                    .file_system = "ext"};
  report.version = "1.2.3";
  report.build = "Release by GNU 12";
  report.instruction_set = "avx2";
  report.instruction_sets = "scalar, avx2";
  report.date = "2026-01-02T03:04:05Z";
  report.seconds = 42;
  report.measurement.figures = {made_figure("machine/memory", 1, {10, 10, 10}),
                                made_figure("job/scan", 1, {1, 1.5, 2}),
                                made_figure("job/scan", 2, {2, 2, 2})};
  report.measurement.load = {.load_before = 0.5, .load_after = 1.5, .other_cores = 0.05};
  return report;
}

}  // namespace semigeo::jobs
