// From runs of triplets to a library: postings per second of the partitions and of the library, its
// verification included, on both cores. Made-up models of the usual size; SEMIGEO_BENCH_MODELS
// says how many (1,000 have 7 million postings and take 1 GB of /tmp, or of TMPDIR).
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <map>
#include <mutex>

#include "bench/support/memory.hpp"
#include "engine/stopwatch.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/stages/library_job.hpp"
#include "jobs/stages/partition_job.hpp"
#include "tests/support/generated_models.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::bench {
namespace {

constexpr tests::ModelSize kUsual{.features = 900, .samples = 4000, .triplets = 7000};

int model_count() {
  const char* text = std::getenv("SEMIGEO_BENCH_MODELS");
  return text == nullptr ? 300 : std::atoi(text);
}

/// What each stretch took, by the clock and of all threads.
class Times : public engine::Observer {
 public:
  void timed(std::string_view stretch, double seconds, double cpu_seconds) override {
    const std::lock_guard lock(mutex_);
    seconds_[std::string(stretch)] += seconds;
    seconds_[std::string(stretch) + "_cpu"] += cpu_seconds;
  }
  void report(benchmark::State& state) const {
    for (const auto& [stretch, seconds] : seconds_) state.counters[stretch] = seconds;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, double> seconds_;
};

std::vector<std::filesystem::path> write_runs(const std::filesystem::path& folder, int models,
                                              engine::Workers& workers) {
  std::vector<std::filesystem::path> runs;
  for (int i = 0; i < models; ++i) runs.push_back(folder / (tests::generated_name(i) + ".run"));
  workers.for_blocks(models, 1, [&](engine::IndexRange range) {
    for (auto i = range.begin; i < range.end; ++i) {
      const int index = static_cast<int>(i);
      const kernels::RecognitionModel model = tests::generated_model(index, kUsual);
      io::write_triplet_run(runs[i], "key", model, tests::generated_triplets(index, model, kUsual));
    }
  });
  return runs;
}

void library(benchmark::State& state) {
  const tests::TemporaryFolder folder;
  engine::Workers workers(static_cast<int>(state.range(0)));
  Times times;
  const engine::RunContext context{workers, times, {}};
  jobs::LibraryJob job{.runs = {},
                       .partitions = {},
                       .parameters = nlohmann::json::object(),
                       .output = folder / "library.h5",
                       .key = "key",
                       .memory_bytes = std::int64_t{512} << 20};
  {
    const engine::Stopwatch stopwatch(times, "runs");
    job.runs = write_runs(folder.path(), model_count(), workers);
  }
  std::int64_t postings = 0;
  const PeakMemory memory;
  for (auto _ : state) {
    {
      const engine::Stopwatch stopwatch(times, "partitions");
      for (const io::ShapeRange& shapes : jobs::partition_shapes(model_count())) {
        const jobs::PartitionJob partition{
            .runs = job.runs,
            .shapes = shapes,
            .output = folder / ("partition" + std::to_string(shapes.first)),
            .key = "key",
            .memory_bytes = job.memory_bytes};
        run_partition_job(partition, context);
        job.partitions.push_back(partition.output);
      }
    }
    const engine::Stopwatch stopwatch(times, "library");
    postings = run_library_job(job, context).postings;
  }
  times.report(state);
  state.SetLabel(std::to_string(model_count()) + " models");
  state.SetItemsProcessed(postings);
  state.counters["peak_memory"] = static_cast<double>(memory.peak_bytes());
}
BENCHMARK(library)->ArgName("threads")->Arg(1)->Arg(2)->Iterations(1)->UseRealTime()->Unit(
    benchmark::kMillisecond);

/// A run written, and read.
void triplet_run(benchmark::State& state) {
  const tests::TemporaryFolder folder;
  const kernels::RecognitionModel model = tests::generated_model(1, kUsual);
  const auto triplets = tests::generated_triplets(1, model, kUsual);
  io::write_triplet_run(folder / "run", "key", model, triplets);
  for (auto _ : state) {
    if (state.range(0) == 0) {
      io::write_triplet_run(folder / "run", "key", model, triplets);
    } else if (state.range(0) == 1) {
      benchmark::DoNotOptimize(io::TripletRun(folder / "run"));
    } else {
      benchmark::DoNotOptimize(io::triplet_run_key(folder / "run"));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(triplets.size()));
  state.SetLabel(state.range(0) == 0 ? "written" : state.range(0) == 1 ? "opened" : "read");
}
BENCHMARK(triplet_run)->DenseRange(0, 2)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace semigeo::bench
