// What the parent pays for a child process, small and with memory of its own.
#include "engine/child_process.hpp"

#include <benchmark/benchmark.h>

#include <vector>

namespace semigeo::bench {
namespace {

const engine::Command kNothing = {.arguments = {"/bin/true"}};

/// `start` alone: the child's own time runs beside.
void start_child(benchmark::State& state) {
  const std::vector<char> resident(state.range(0) << 20, 1);
  engine::ChildProcesses children;
  for (auto _ : state) {
    children.start(kNothing);
    state.PauseTiming();
    children.wait();
    state.ResumeTiming();
  }
}
BENCHMARK(start_child)
    ->ArgName("resident_MB")
    ->Arg(0)
    ->Arg(1024)
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();

void start_and_end_child(benchmark::State& state) {
  engine::ChildProcesses children;
  for (auto _ : state) {
    children.start(kNothing);
    children.wait();
  }
}
BENCHMARK(start_and_end_child)->Unit(benchmark::kMicrosecond)->UseRealTime();

/// A line there and one back: what a job given to a persistent child costs.
void line_and_answer(benchmark::State& state) {
  engine::ChildProcesses children;
  const auto child =
      children.start({.arguments = {"/bin/sh", "-c", "while read line; do echo $line >&3; done"},
                      .converses = true});
  for (auto _ : state) {
    children.send(child, "surface some/scan.ply");
    benchmark::DoNotOptimize(children.wait());
  }
}
BENCHMARK(line_and_answer)->Unit(benchmark::kMicrosecond)->UseRealTime();

}  // namespace
}  // namespace semigeo::bench
