#include "jobs/stages/partition_job.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>

#include "io/files/error.hpp"
#include "io/library/hash_library_format.hpp"
#include "io/library/posting_partition.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/stages/library_runs.hpp"

namespace semigeo::jobs {
namespace {

using kernels::kCodeTriples;
using kernels::Triplet;

constexpr std::int64_t kModelsOfPartition = 1000;
constexpr int kLeastShapes = 4;  // least number of shapes of a partition

/// A posting that still knows its cell.
struct Entry {
  kernels::Invariants invariants;
  std::uint32_t model;
  std::array<std::uint16_t, 3> corners;
  std::uint16_t codes;  ///< cell % kCodeTriples

  Entry() = default;
  Entry(const Triplet& triplet, std::size_t model_index)
      : invariants(triplet.invariants),
        model(static_cast<std::uint32_t>(model_index)),
        corners(triplet.corners),
        codes(static_cast<std::uint16_t>(triplet.cell % kCodeTriples)) {}
};
// The beginning of an entry is stored as it is.
static_assert(sizeof(Entry) == 28 && offsetof(Entry, model) == offsetof(kernels::Posting, model) &&
              offsetof(Entry, codes) == io::kPostingBytes);

constexpr std::int64_t kSortBytes = sizeof(Entry) + io::kPostingBytes;  // memory for each posting
constexpr std::int64_t kSortedBytes = 1 << 20;  // bytes that a thread sorts at once
constexpr std::int64_t kReadBytes = sizeof(Triplet) + 24;

/// The cells that are sorted at once: all cells of some shapes, or some cells of one shape.
struct Slice {
  std::uint32_t first = 0;
  std::uint32_t end = 0;
  std::int64_t postings = 0;

  io::ShapeRange shapes() const {
    return {.first = static_cast<int>(first / kCodeTriples),
            .end = static_cast<int>((end + kCodeTriples - 1) / kCodeTriples)};
  }
  bool has(const Triplet& triplet) const { return triplet.cell >= first && triplet.cell < end; }
};

class PartitionBuild {
 public:
  PartitionBuild(const PartitionJob& job, const engine::RunContext& context)
      : job_(job),
        workers_(context.workers),
        capacity_(
            std::max<std::int64_t>(1, memory_or_default(job.memory_bytes) / 4 * 3 / kSortBytes)),
        batches_capacity_(memory_or_default(job.memory_bytes) / 4 / kReadBytes),
        shape_counts_(kernels::kShapes),
        cell_counts_(job.shapes.end_cell() - job.shapes.first_cell()) {}

  PartitionJobResult run() {
    const std::uint64_t runs_hash = count_shapes();
    io::PostingPartitionWriter writer(job_.output,
                                      {.job_key = job_.key,
                                       .shapes = job_.shapes,
                                       .models = static_cast<std::int64_t>(job_.runs.size()),
                                       .runs_hash = runs_hash});
    PartitionJobResult result;
    for (const Slice& slice : slices()) {
      if (slice.postings == 0) continue;
      if (slice.postings > capacity_) {
        stream(slice, writer);
      } else {
        const std::unique_ptr<Entry[]> entries = gather(slice);
        write_sorted(slice, {entries.get(), static_cast<std::size_t>(slice.postings)}, writer);
      }
      result.postings += slice.postings;
    }
    writer.finish(cell_counts_);
    return result;
  }

 private:
  // Opens every run. The sums are of integers, so the order in which threads add does not matter.
  std::uint64_t count_shapes() {
    std::vector<std::int64_t> of_run(job_.runs.size());
    std::mutex mutex;
    const std::uint64_t hash =
        for_each_run(job_.runs, workers_, [&](std::size_t i, const io::TripletRun& run) {
          of_run[i] = run.triplets(job_.shapes);
          const std::lock_guard lock(mutex);
          for (int shape = job_.shapes.first; shape < job_.shapes.end; ++shape)
            shape_counts_[shape] += run.triplets({shape, shape + 1});
        });
    batches_ = batches_of(of_run, batches_capacity_);
    return hash;
  }

  // Returns slices of as many cells as memory can hold, or of one cell.
  std::vector<Slice> slices() {
    std::vector<Slice> slices;
    const auto add = [&](std::uint32_t first, std::uint32_t end, std::int64_t postings, bool open) {
      if (open && !slices.empty() && slices.back().end == first &&
          slices.back().postings + postings <= capacity_) {
        slices.back().end = end;
        slices.back().postings += postings;
      } else {
        slices.push_back({first, end, postings});
      }
    };
    bool whole = false;  // the last slice consists of whole shapes
    for (int shape = job_.shapes.first; shape < job_.shapes.end; ++shape) {
      const Slice all{static_cast<std::uint32_t>(shape) * kCodeTriples,
                      static_cast<std::uint32_t>(shape + 1) * kCodeTriples, shape_counts_[shape]};
      if (all.postings <= capacity_) {
        add(all.first, all.end, all.postings, whole);
        whole = true;
        continue;
      }
      const std::vector<std::int64_t> counts = count_cells(all);
      for (std::uint32_t code = 0; code < kCodeTriples; ++code)
        add(all.first + code, all.first + code + 1, counts[code], code > 0);
      whole = false;
    }
    return slices;
  }

  std::vector<std::int64_t> count_cells(const Slice& shape) {
    std::vector<std::int64_t> counts(kCodeTriples);
    for_each_triplet(
        shape, [&](const Triplet& triplet, std::size_t) { ++counts[triplet.cell - shape.first]; });
    return counts;
  }

  // Calls use(triplet, model) for each triplet of the slice, in the order of models, corners.
  template <typename Use>
  void for_each_triplet(const Slice& slice, const Use& use) {
    std::vector<std::vector<Triplet>> read;
    for (const engine::IndexRange batch : batches_) {
      read.resize(static_cast<std::size_t>(batch.end - batch.begin));
      workers_.for_blocks(batch.end - batch.begin, 16, [&](engine::IndexRange range) {
        for (auto i = range.begin; i < range.end; ++i)
          read[i] = io::TripletRun(job_.runs[batch.begin + i]).read_triplets(slice.shapes());
      });
      for (std::size_t i = 0; i < read.size(); ++i)
        for (const Triplet& triplet : read[i])
          if (slice.has(triplet)) use(triplet, static_cast<std::size_t>(batch.begin) + i);
    }
  }

  /// The triplets of a run in a slice, with their number for each shape; later with their places.
  struct RunPart {
    std::vector<Triplet> triplets;
    std::vector<std::size_t> of_shape;
  };

  // Collects the triplets shape after shape. Those of a shape are in the order of models.
  std::unique_ptr<Entry[]> gather(const Slice& slice) {
    const io::ShapeRange shapes = slice.shapes();
    const std::size_t shape_count = shapes.end - shapes.first;
    const std::vector<std::size_t> begin = begin_of_shapes(slice);
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    auto entries =
        std::make_unique_for_overwrite<Entry[]>(static_cast<std::size_t>(slice.postings));
    for (const engine::IndexRange batch : batches_) {
      std::vector<RunPart> parts(static_cast<std::size_t>(batch.end - batch.begin));
      for_each_part(parts, [&](RunPart& part, std::size_t i) {
        part.triplets = io::TripletRun(job_.runs[batch.begin + i]).read_triplets(shapes);
        std::erase_if(part.triplets, [&](const Triplet& triplet) { return !slice.has(triplet); });
        part.of_shape.resize(shape_count);
        for (const Triplet& triplet : part.triplets)
          ++part.of_shape[triplet.cell / kCodeTriples - shapes.first];
      });
      for (RunPart& part : parts)
        for (std::size_t shape = 0; shape < shape_count; ++shape)
          next[shape] += std::exchange(part.of_shape[shape], next[shape]);
      for (std::size_t shape = 0; shape < shape_count; ++shape)
        if (next[shape] > begin[shape + 1]) refuse_changed();
      for_each_part(parts, [&](const RunPart& part, std::size_t i) {
        std::vector<std::size_t> at = part.of_shape;
        for (const Triplet& triplet : part.triplets)
          entries[at[triplet.cell / kCodeTriples - shapes.first]++] =
              Entry(triplet, static_cast<std::size_t>(batch.begin) + i);
      });
    }
    if (!std::equal(next.begin(), next.end(), begin.begin() + 1)) refuse_changed();
    return entries;
  }

  template <typename Parts, typename Body>
  void for_each_part(Parts& parts, const Body& body) {
    workers_.for_blocks(std::ssize(parts), 8, [&](engine::IndexRange range) {
      for (auto i = range.begin; i < range.end; ++i) body(parts[i], static_cast<std::size_t>(i));
    });
  }

  [[noreturn]] void refuse_changed() const {
    throw io::Error(job_.output, "", "the runs changed while they were read", "run again");
  }

  // Returns the first entry of each shape, and the end. A slice of cells has one shape.
  std::vector<std::size_t> begin_of_shapes(const Slice& slice) const {
    const io::ShapeRange shapes = slice.shapes();
    std::vector<std::size_t> begin = {0};
    for (int shape = shapes.first; shape + 1 < shapes.end; ++shape)
      begin.push_back(begin.back() + shape_counts_[shape]);
    begin.push_back(static_cast<std::size_t>(slice.postings));
    return begin;
  }

  // Packs the postings of each shape by cell, with a counting sort, which keeps the order of
  // models.
  void write_sorted(const Slice& slice, std::span<const Entry> entries,
                    io::PostingPartitionWriter& writer) {
    const io::ShapeRange shapes = slice.shapes();
    const std::vector<std::size_t> begin = begin_of_shapes(slice);
    std::vector<std::int64_t> bytes;
    for (std::size_t i = 0; i + 1 < begin.size(); ++i)
      bytes.push_back(static_cast<std::int64_t>((begin[i + 1] - begin[i]) * io::kPostingBytes));
    const std::vector<engine::IndexRange> batches = batches_of(bytes, kSortedBytes);
    make_and_write(
        std::ssize(batches), 4 * workers_.threads(), workers_,
        [&](std::int64_t batch) {
          const auto [first, last] = batches[batch];
          std::vector<std::byte> rows((begin[last] - begin[first]) * io::kPostingBytes);
          for (auto i = first; i < last; ++i)
            sort_shape(shapes.first + static_cast<int>(i),
                       entries.subspan(begin[i], begin[i + 1] - begin[i]),
                       rows.data() + (begin[i] - begin[first]) * io::kPostingBytes);
          return rows;
        },
        [&](const std::vector<std::byte>& rows) { writer.add(rows); });
  }

  void sort_shape(int shape, std::span<const Entry> entries, std::byte* rows) {
    std::array<std::uint32_t, kCodeTriples> counts = {};
    for (const Entry& entry : entries) ++counts[entry.codes];
    std::array<std::size_t, kCodeTriples> next = {};
    std::exclusive_scan(counts.begin(), counts.end(), next.begin(), std::size_t{0});
    for (const Entry& entry : entries)
      std::memcpy(rows + next[entry.codes]++ * io::kPostingBytes, &entry, io::kPostingBytes);
    for (std::uint32_t code = 0; code < kCodeTriples; ++code)
      cell_counts_[(shape - job_.shapes.first) * kCodeTriples + code] += counts[code];
  }

  // A cell that does not fit into memory needs no sorting.
  void stream(const Slice& cell, io::PostingPartitionWriter& writer) {
    for_each_triplet(cell, [&](const Triplet& triplet, std::size_t model) {
      const Entry entry(triplet, model);
      writer.add(std::as_bytes(std::span(&entry, 1)).first(io::kPostingBytes));
    });
    cell_counts_[cell.first - job_.shapes.first_cell()] = static_cast<std::uint32_t>(cell.postings);
  }

  const PartitionJob& job_;
  engine::Workers& workers_;
  std::int64_t capacity_;          ///< Number of postings sorted at once.
  std::int64_t batches_capacity_;  ///< Number of triplets read at once.
  std::vector<engine::IndexRange> batches_;
  std::vector<std::int64_t> shape_counts_;
  std::vector<std::uint32_t> cell_counts_;
};

}  // namespace

PartitionJobResult run_partition_job(const PartitionJob& job, const engine::RunContext& context) {
  return PartitionBuild(job, context).run();
}

std::vector<io::ShapeRange> partition_shapes(std::int64_t models) {
  const std::int64_t count = std::clamp<std::int64_t>(
      (models + kModelsOfPartition - 1) / kModelsOfPartition, 1, kernels::kShapes / kLeastShapes);
  std::vector<io::ShapeRange> ranges;
  for (std::int64_t i = 0; i < count; ++i)
    ranges.push_back({.first = static_cast<int>(i * kernels::kShapes / count),
                      .end = static_cast<int>((i + 1) * kernels::kShapes / count)});
  return ranges;
}

}  // namespace semigeo::jobs
