#include "jobs/stages/library_job.hpp"

#include <algorithm>
#include <deque>
#include <utility>

#include "engine/stopwatch.hpp"
#include "io/files/error.hpp"
#include "io/library/hash_library_format.hpp"
#include "io/library/hash_library_writer.hpp"
#include "io/library/posting_partition.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/stages/for_each_on.hpp"
#include "jobs/stages/library_runs.hpp"

namespace semigeo::jobs {
namespace {

/// The sizes of all runs, known before their content is read.
struct RunTotals {
  io::LibrarySizes sizes;
  std::vector<std::int64_t> triplets;  ///< Number of triplets of each run.
  std::vector<std::int64_t> bytes;     ///< Size of the tables of each run.
  std::uint64_t hash = 0;
};

RunTotals totals_of(const LibraryJob& job, engine::Workers& workers) {
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

/// Opens all partitions, and checks that together they have every shape once.
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

/// The rows of all partitions, one after the other.
class PartitionRows {
 public:
  explicit PartitionRows(const std::deque<io::PostingPartition>& partitions) {
    for (const io::PostingPartition& partition : partitions) {
      if (partition.postings() == 0) continue;
      parts_.push_back({&partition, end_});
      end_ += partition.postings();
    }
  }

  /// Returns the rows from `first` to `last` - 1, or to the end. It is thread-safe.
  std::vector<std::byte> read(std::int64_t first, std::int64_t last) const {
    last = std::min(last, end_);
    std::vector<std::byte> rows;
    rows.reserve(static_cast<std::size_t>(last - first) * io::kPostingBytes);
    auto part = std::ranges::upper_bound(parts_, first, {}, &Part::first) - 1;
    for (std::int64_t at = first; at < last;) {
      if (at == part->first + part->partition->postings()) ++part;
      const std::int64_t block = (at - part->first) / io::kBlockPostings;
      const std::int64_t block_first = part->first + block * io::kBlockPostings;
      const std::vector<std::byte> all = part->partition->read_block(block);
      const auto row = [&](std::int64_t index) {
        return all.begin() + (index - block_first) * static_cast<std::int64_t>(io::kPostingBytes);
      };
      const std::int64_t stop =
          std::min(last, block_first + static_cast<std::int64_t>(all.size() / io::kPostingBytes));
      rows.insert(rows.end(), row(at), row(stop));
      at = stop;
    }
    return rows;
  }

 private:
  struct Part {
    const io::PostingPartition* partition;
    std::int64_t first;
  };
  std::vector<Part> parts_;
  std::int64_t end_ = 0;
};

void write_postings(const std::deque<io::PostingPartition>& partitions, std::int64_t memory,
                    io::HashLibraryWriter& writer, engine::Workers& workers) {
  const io::ArrayShape& shape = writer.posting_shape();
  // For each block, its rows, its stored form and the stored form of a block before it are in
  // memory.
  const std::int64_t at_once =
      std::clamp<std::int64_t>(memory / 6 / shape.chunk_bytes(), 1, 4 * workers.threads());
  const PartitionRows rows(partitions);
  make_and_write(
      shape.rows == 0 ? 0 : shape.chunk_count(), at_once, workers,
      [&](std::int64_t block) {
        const std::int64_t first = block * shape.chunk_rows;
        return io::encode_rows(shape, rows.read(first, first + shape.chunk_rows));
      },
      [&](const io::EncodedChunk& block) { writer.write_block(block); });
}

void write_models(const LibraryJob& job, const RunTotals& runs, std::int64_t memory,
                  io::HashLibraryWriter& writer, engine::Workers& workers) {
  using Models = std::vector<io::PackedModel>;
  const std::vector<engine::IndexRange> batches =
      batches_of(runs.bytes, std::min<std::int64_t>(memory / 32, std::int64_t{2} << 20));
  std::size_t model = 0;
  make_and_write(
      std::ssize(batches), 8, workers,
      [&](std::int64_t batch) {
        Models models;
        for (auto i = batches[batch].begin; i < batches[batch].end; ++i)
          models.push_back(io::TripletRun(job.runs[i]).read_packed_model());
        return models;
      },
      [&](const Models& models) {
        for (const io::PackedModel& one : models) writer.write_model(one, runs.triplets[model++]);
      });
}

}  // namespace

LibraryJobResult run_library_job(const LibraryJob& job, const engine::RunContext& context) {
  const std::int64_t memory = memory_or_default(job.memory_bytes);
  const RunTotals runs = totals_of(job, context.workers);
  const std::deque<io::PostingPartition> partitions = open_partitions(job, runs);
  io::HashLibraryWriter writer(job.output, {.parameters = job.parameters, .job_key = job.key},
                               runs.sizes);
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
          .digest = writer.finish(cells_of(partitions), for_each_on(context.workers))};
}

}  // namespace semigeo::jobs
