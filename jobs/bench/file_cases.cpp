#include <chrono>
#include <filesystem>
#include <string>

#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/dataset/dataset_writer.hpp"
#include "io/files/chunk_codec.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/archive/verification.hpp"
#include "jobs/bench/cases.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kLevels = 8;  // smoothings of the dataset, as of one with default options

/// Calls `work` with 0, 1, ... on every thread: files side by side, as jobs have them.
template <typename Work>
BenchWork side_by_side(engine::Workers& workers, double bytes, const Work& work) {
  workers.for_blocks(workers.threads(), 1, [&](engine::IndexRange range) {
    for (auto i = range.begin; i < range.end; ++i) work(i);
  });
  const double all = bytes * workers.threads();
  return {.amount = 1e-6 * all, .memory_bytes = 2 * all};
}

double size_of_file(const fs::path& path) {
  return static_cast<double>(fs::file_size(path));
}

/// Holds the content of a dataset in memory, so that it can be written again.
class DatasetCopy {
 public:
  explicit DatasetCopy(const fs::path& path) {
    const io::Dataset dataset(path);
    header_ = dataset.header();
    selection_ = dataset.selection();
    selection_.feature_counts.assign(kLevels + 1, 0);
    triangles_ = dataset.read_integers(0, "triangles");
    source_ = dataset.read_integers(0, "source_vertex");
    for (const std::int64_t part : dataset.read_integers(0, "part"))
      part_.push_back(static_cast<std::int32_t>(part));
    for (const char* name : kNames) fields_.push_back(dataset.read_floats(0, name));
    level_ = dataset.level(0);
  }

  /// Encodes on all workers and writes on one thread, level by level. Returns the seconds that the
  /// one thread took.
  double write(const fs::path& path, engine::Workers& workers) const {
    double locked = 0;
    const auto timed = [&locked](const auto& work) {
      const Clock::time_point start = Clock::now();
      work();
      locked += std::chrono::duration<double>(Clock::now() - start).count();
    };
    io::DatasetWriter writer(path, header_, kCompression);
    for (int level = 0; level <= kLevels; ++level) {
      if (level == 0) {
        io::EncodedConnectivity connectivity;
        encode(
            {rows(triangles_, 3), io::array_of(std::span(source_)), io::array_of(std::span(part_))},
            {&connectivity.triangles, &connectivity.source_vertex, &connectivity.part}, workers);
        timed([&] { writer.write_connectivity(connectivity); });
      }
      const io::EncodedFields fields = encode_fields(workers);
      io::LevelAttributes attributes = level_;
      attributes.iteration = level;
      attributes.scale = level_.scale * (1 + level);
      timed([&] { writer.write_level(attributes, fields); });
    }
    timed([&] {
      writer.write_selection(selection_);
      writer.finish();
    });
    return locked;
  }

 private:
  static constexpr io::Compression kCompression = io::Compression::kDeflate;
  static constexpr const char* kNames[] = {"points", "normals", "gaussian_curvature",
                                           "mean_curvature", "patch_completeness"};

  template <typename Value>
  static io::ArrayView rows(const std::vector<Value>& values, int columns) {
    io::ArrayView view = io::array_of(std::span<const Value>(values));
    view.columns = columns;
    view.row_stride *= columns;
    view.rows /= columns;
    return view;
  }

  /// Encodes arrays chunk by chunk on all workers.
  static void encode(const std::vector<io::ArrayView>& views,
                     const std::vector<io::EncodedArray*>& targets, engine::Workers& workers) {
    std::vector<std::pair<std::size_t, std::int64_t>> tasks;
    for (std::size_t i = 0; i < views.size(); ++i) {
      targets[i]->shape = io::shape_of(views[i], kCompression);
      targets[i]->chunks.resize(targets[i]->shape.chunk_count());
      for (std::int64_t c = 0; c < targets[i]->shape.chunk_count(); ++c) tasks.emplace_back(i, c);
    }
    workers.for_blocks(static_cast<std::int64_t>(tasks.size()), 1, [&](engine::IndexRange range) {
      for (auto k = range.begin; k < range.end; ++k) {
        const auto& [i, c] = tasks[k];
        targets[i]->chunks[c] = io::encode_chunk(views[i], c, kCompression);
      }
    });
  }

  io::EncodedFields encode_fields(engine::Workers& workers) const {
    io::EncodedFields encoded;
    encode({rows(fields_[0], 3), rows(fields_[1], 3), rows(fields_[2], 1), rows(fields_[3], 1),
            rows(fields_[4], 1)},
           {&encoded.points, &encoded.normals, &encoded.gaussian_curvature, &encoded.mean_curvature,
            &encoded.patch_completeness},
           workers);
    kernels::LevelFeatures none;
    for (kernels::SampledContours& contours : none.contours) contours.offsets = {0};
    encoded.features = io::encode_features(io::tables_of(none), kCompression);
    return encoded;
  }

  io::DatasetHeader header_;
  io::Selection selection_;
  io::LevelAttributes level_;
  std::vector<std::int64_t> triangles_, source_;
  std::vector<std::int32_t> part_;
  std::vector<std::vector<float>> fields_;
};

/// Makes the files of the cases when they are first asked for.
class Files {
 public:
  explicit Files(BenchInputsPointer inputs) : inputs_(std::move(inputs)) {}

  const fs::path& ply() {
    if (ply_.empty()) {
      ply_ = inputs_->folder() / "read.ply";
      write_mesh(ply_, inputs_->scan_mesh());
    }
    return ply_;
  }
  const fs::path& obj() {
    if (obj_.empty()) {
      obj_ = inputs_->folder() / "read.obj";
      write_obj(obj_, inputs_->scan_mesh());
    }
    return obj_;
  }
  const fs::path& dataset(engine::Workers& workers) {
    if (dataset_.empty()) {
      dataset_ = inputs_->folder() / "read.vtkhdf";
      write_dataset(ply(), dataset_, kLevels, {workers, inputs_->observer(), {}});
    }
    return dataset_;
  }
  const DatasetCopy& copy(engine::Workers& workers) {
    if (!copy_) copy_ = std::make_unique<DatasetCopy>(dataset(workers));
    return *copy_;
  }

  BenchWork read(const fs::path& scan, engine::Workers& workers) const {
    return side_by_side(workers, size_of_file(scan), [&](auto) { io::read_scan(scan); });
  }
  BenchWork write_scans(engine::Workers& workers) {
    return side_by_side(workers, size_of_file(ply()), [&](auto i) {
      write_mesh(inputs_->folder() / ("write" + std::to_string(i) + ".ply"), inputs_->scan_mesh());
    });
  }
  BenchWork verify(engine::Workers& workers) {
    const fs::path& path = dataset(workers);
    const std::vector<fs::path> all(workers.threads(), path);
    for (const Verified& verified : verify_datasets(all, workers.threads()))
      if (!verified.problem.empty()) throw std::runtime_error(verified.problem);
    const double bytes = size_of_file(path) * workers.threads();
    return {.amount = 1e-6 * bytes, .memory_bytes = 2 * bytes};
  }
  BenchWork rewrite(engine::Workers& workers) {
    const fs::path path = inputs_->folder() / "write.vtkhdf";
    const double locked = copy(workers).write(path, workers);
    const double bytes = size_of_file(path);
    return {.amount = 1e-6 * bytes, .memory_bytes = 3 * bytes, .locked_seconds = locked};
  }

 private:
  BenchInputsPointer inputs_;
  fs::path ply_, obj_, dataset_;
  std::unique_ptr<DatasetCopy> copy_;
};

}  // namespace

void add_file_cases(std::vector<BenchCase>& cases, const BenchInputsPointer& inputs,
                    const std::vector<int>& threads) {
  const auto files = std::make_shared<Files>(inputs);
  using engine::Workers;
  const auto add = [&](const char* name, auto run, auto prepare, bool in_children = false) {
    for (const int count : threads)
      cases.push_back({.name = name,
                       .unit = "MB/s",
                       .threads = count,
                       .run = run,
                       .prepare = prepare,
                       .in_children = in_children});
  };
  add(
      "read/ply", [files](Workers& w) { return files->read(files->ply(), w); },
      [files](Workers&) { files->ply(); });
  add(
      "read/obj", [files](Workers& w) { return files->read(files->obj(), w); },
      [files](Workers&) { files->obj(); });
  add(
      "read/dataset", [files](Workers& w) { return files->verify(w); },
      [files](Workers& w) { files->dataset(w); }, true);
  add(
      "write/ply", [files](Workers& w) { return files->write_scans(w); },
      [files](Workers&) { files->ply(); });
  add(
      "write/dataset", [files](Workers& w) { return files->rewrite(w); },
      [files](Workers& w) { files->copy(w); });
}

}  // namespace semigeo::jobs
