#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/files/binary_file.hpp"
#include "io/library/packed_model.hpp"
#include "io/library/shape_range.hpp"
#include "kernels/recognition/recognition_model.hpp"

namespace semigeo::io {

/// Writes a model and its triplets as one file (docs/formats/library.md), whole or not at all. It
/// is not forced to the disk, because there are thousands of such files; so a power cut may damage
/// it. Equal content gives equal bytes. Throws std::invalid_argument if the model is unsound or the
/// triplets are not sorted by cell, then corners, none twice, or refer to features that it does not
/// have.
void write_triplet_run(const std::filesystem::path& path, const std::string& job_key,
                       const kernels::RecognitionModel& model,
                       std::span<const kernels::Triplet> triplets);

/// Reads a run. Opening it reads about 5 kB. The triplets of each shape, and the model, are checked
/// against checksums of their own when they are read. Every failure is an Error that names the file
/// and what is wrong with it. Several threads may use it at once.
class TripletRun {
 public:
  explicit TripletRun(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.path(); }
  const std::string& job_key() const { return job_key_; }
  const std::string& name() const { return model_.name; }  ///< Name of the model.
  /// Returns the XXH3_64 of the head, which has the checksums of all else: equal hashes mean equal
  /// content.
  std::uint64_t content_hash() const { return file_.head_hash(); }
  /// Returns the number of features of the model.
  std::int64_t features() const { return features_; }
  /// Returns the number of samples of the model.
  std::int64_t samples() const { return samples_; }
  /// Returns the number of levels of the model.
  std::int64_t levels() const { return static_cast<std::int64_t>(model_.level_scales.size()); }
  /// Returns the number of triplets of some shapes.
  std::int64_t triplets(const ShapeRange& shapes = {}) const {
    return offsets_[shapes.end] - offsets_[shapes.first];
  }

  /// Reads the triplets of some shapes, sorted by cell, then corners.
  std::vector<kernels::Triplet> read_triplets(const ShapeRange& shapes = {}) const;
  /// Reads the model.
  kernels::RecognitionModel read_model() const { return unpack_model(read_packed_model()); }
  /// Reads the model as it is stored.
  PackedModel read_packed_model() const;

 private:
  void read_head();
  void check_sizes() const;

  BinaryFile file_;
  std::string job_key_;
  PackedModel model_;  // without its tables
  std::int64_t features_ = 0;
  std::int64_t samples_ = 0;
  std::array<std::uint32_t, kernels::kShapes + 1> offsets_ = {};
  std::array<std::uint64_t, kernels::kShapes> shape_hashes_ = {};
  std::uint64_t model_hash_ = 0;
};

/// Returns the key of the job that made a run. Reads all of the file, and throws Error if it is not
/// a whole run of this version, or damaged in any place.
std::string triplet_run_key(const std::filesystem::path& path);

}  // namespace semigeo::io
