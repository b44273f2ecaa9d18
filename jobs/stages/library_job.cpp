#include "jobs/stages/library_job.hpp"

#include <algorithm>
#include <deque>
#include <utility>

#include "engine/stopwatch.hpp"
#include "io/error.hpp"
#include "io/hash_library_writer.hpp"
#include "io/posting_partition.hpp"
#include "io/triplet_run.hpp"
#include "jobs/stages/library_runs.hpp"

namespace semigeo::jobs {
namespace {

/// What is known of all runs before they are read.
struct RunTotals {
  io::LibrarySizes sizes;
  std::vector<std::int64_t> triplets;  ///< of each
  std::vector<std::int64_t> bytes;     ///< of each one's tables
  std::uint64_t hash = 0;
};

RunTotals look_at_runs(const LibraryJob& job, engine::Workers& workers) {
  struct Counts {
    std::int64_t features = 0;
    std::int64_t levels = 0;
    std::int64_t samples = 0;
  };
  RunTotals totals;
  totals.triplets.resize(job.runs.size());
  std::vector<Counts> counts(job.runs.size());
  totals.hash = for_each_run(job.runs, workers, [&](std::size_t i, const io::TripletRun& run) {
    totals.triplets[i] = run.triplets();
    counts[i] = {.features = run.features(), .levels = run.levels(), .samples = run.samples()};
  });
  totals.sizes.models = static_cast<std::int64_t>(job.runs.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    totals.sizes.postings += totals.triplets[i];
    totals.sizes.features += counts[i].features;
    totals.sizes.level_scales += counts[i].levels;
    totals.sizes.samples += counts[i].samples;
    totals.bytes.push_back(
        static_cast<std::int64_t>(io::kOrientedFeatureBytes) * counts[i].features +
        static_cast<std::int64_t>(io::kSamplePointBytes + io::kSampleNormalBytes) *
            counts[i].samples);
  }
  return totals;
}

/// All partitions, which together have every shape once.
std::deque<io::PostingPartition> open_partitions(const LibraryJob& job, const RunTotals& runs) {
  std::deque<io::PostingPartition> partitions;
  int next = 0;
  std::int64_t postings = 0;
  const auto refuse = [&](const std::filesystem::path& path, const std::string& problem) {
    throw io::Error(path, "", problem, "remove the partitions and run again");
  };
  for (const std::filesystem::path& path : job.partitions) {
    const io::PartitionHeader& header = partitions.emplace_back(path).header();
    if (header.runs_hash != runs.hash || header.models != runs.sizes.models)
      refuse(path, "was not made of these models");
    if (header.shapes.first != next)
      refuse(path, "begins with shape " + std::to_string(header.shapes.first) + " instead of " +
                       std::to_string(next));
    next = header.shapes.end;
    postings += partitions.back().postings();
  }
  if (next != kernels::kShapes)
    refuse(
        job.partitions.empty() ? job.output : job.partitions.back(),
        "is the last partition, but the shapes from " + std::to_string(next) + " on are missing");
  if (postings != runs.sizes.postings)
    refuse(job.partitions.back(), "and those before it have " + std::to_string(postings) +
                                      " postings instead of " +
                                      std::to_string(runs.sizes.postings));
  return partitions;
}

std::vector<std::uint64_t> cells_of(const std::deque<io::PostingPartition>& partitions) {
  std::vector<std::uint64_t> cells = {0};
  cells.reserve(kernels::kTripletCells + 1);
  for (const io::PostingPartition& partition : partitions)
    for (const std::uint32_t count : partition.cell_counts()) cells.push_back(cells.back() + count);
  return cells;
}

/// The postings of all partitions, one after the other.
class PostingStream {
 public:
  explicit PostingStream(const std::deque<io::PostingPartition>& partitions)
      : partition_(partitions.begin()), end_(partitions.end()) {}

  /// The next `bytes` of them, fewer only at the end.
  std::vector<std::byte> take(std::size_t bytes) {
    while (ahead_.size() - taken_ < bytes && partition_ != end_) {
      if (block_ == partition_->blocks()) {
        ++partition_;
        block_ = 0;
        continue;
      }
      ahead_.erase(ahead_.begin(), ahead_.begin() + static_cast<std::ptrdiff_t>(taken_));
      taken_ = 0;
      const std::vector<std::byte> rows = partition_->read_block(block_++);
      ahead_.insert(ahead_.end(), rows.begin(), rows.end());
    }
    const auto begin = ahead_.begin() + static_cast<std::ptrdiff_t>(taken_);
    bytes = std::min(bytes, ahead_.size() - taken_);
    taken_ += bytes;
    return {begin, begin + static_cast<std::ptrdiff_t>(bytes)};
  }

 private:
  std::deque<io::PostingPartition>::const_iterator partition_;
  std::deque<io::PostingPartition>::const_iterator end_;
  std::int64_t block_ = 0;
  std::vector<std::byte> ahead_;
  std::size_t taken_ = 0;
};

void write_postings(const std::deque<io::PostingPartition>& partitions, std::int64_t memory,
                    io::HashLibraryWriter& writer, engine::Workers& workers) {
  const io::ArrayShape& shape = writer.posting_shape();
  const auto block_bytes = static_cast<std::size_t>(shape.chunk_bytes());
  // Of each block there are its rows and its stored form.
  const std::int64_t at_once =
      std::clamp<std::int64_t>(memory / 4 / shape.chunk_bytes(), 1, 4 * workers.threads());
  PostingStream stream(partitions);
  for (std::int64_t first = 0; first < shape.chunk_count(); first += at_once) {
    const std::int64_t count = std::min(at_once, shape.chunk_count() - first);
    std::vector<std::vector<std::byte>> rows;
    for (std::int64_t i = 0; i < count; ++i) rows.push_back(stream.take(block_bytes));
    std::vector<io::EncodedChunk> blocks(rows.size());
    workers.for_blocks(count, 1, [&](engine::IndexRange range) {
      for (auto i = range.begin; i < range.end; ++i) blocks[i] = io::encode_rows(shape, rows[i]);
    });
    for (const io::EncodedChunk& block : blocks) writer.write_block(block);
  }
}

void write_models(const LibraryJob& job, const RunTotals& runs, std::int64_t memory,
                  io::HashLibraryWriter& writer, engine::Workers& workers) {
  for (const engine::IndexRange batch :
       batches_of(runs.bytes, std::min<std::int64_t>(memory / 4, std::int64_t{16} << 20))) {
    std::vector<io::PackedModel> models(static_cast<std::size_t>(batch.end - batch.begin));
    workers.for_blocks(batch.end - batch.begin, 8, [&](engine::IndexRange range) {
      for (auto i = range.begin; i < range.end; ++i)
        models[i] = io::TripletRun(job.runs[batch.begin + i]).read_packed_model();
    });
    for (std::size_t i = 0; i < models.size(); ++i)
      writer.write_model(models[i], runs.triplets[batch.begin + i]);
  }
}

}  // namespace

LibraryJobResult run_library_job(const LibraryJob& job, const engine::RunContext& context) {
  const std::int64_t memory = memory_or_default(job.memory_bytes);
  const RunTotals runs = look_at_runs(job, context.workers);
  const std::deque<io::PostingPartition> partitions = open_partitions(job, runs);
  io::HashLibraryWriter writer(
      job.output, {.parameters_json = job.parameters_json, .job_key = job.key}, runs.sizes);
  {
    const engine::Stopwatch stopwatch(context.observer, "postings");
    write_postings(partitions, memory, writer, context.workers);
  }
  {
    const engine::Stopwatch stopwatch(context.observer, "models");
    write_models(job, runs, memory, writer, context.workers);
  }
  const engine::Stopwatch stopwatch(context.observer, "verification");
  return {.models = runs.sizes.models,
          .postings = runs.sizes.postings,
          .digest = writer.finish(cells_of(partitions))};
}

}  // namespace semigeo::jobs
