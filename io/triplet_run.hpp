#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/file_descriptor.hpp"
#include "io/shape_range.hpp"
#include "kernels/recognition_model.hpp"

namespace semigeo::io {

/// Writes a model and its triplets as one file (io/LIBRARY.md), whole or not at all; equal content,
/// equal bytes. std::invalid_argument unless the triplets are sorted by cell, then corners, and
/// refer to features that exist.
void write_triplet_run(const std::filesystem::path& path, const std::string& job_key,
                       const kernels::RecognitionModel& model,
                       const std::vector<kernels::Triplet>& triplets);

/// Reads a run. Opening reads a few kB; each range of shapes and the model are checked against
/// checksums of their own when they are read. Every failure is an Error that names the file and
/// what is wrong with it.
class TripletRun {
 public:
  explicit TripletRun(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const std::string& job_key() const { return job_key_; }
  const std::string& name() const { return name_; }  ///< of the model
  /// XXH3_64 of everything the file says.
  std::uint64_t content_hash() const { return content_hash_; }
  std::int64_t features() const { return features_; }
  std::int64_t samples() const { return samples_; }
  std::int64_t triplets() const { return static_cast<std::int64_t>(offsets_[kernels::kShapes]); }
  std::int64_t triplets(const ShapeRange& shapes) const {
    return static_cast<std::int64_t>(offsets_[shapes.end] - offsets_[shapes.first]);
  }

  /// Sorted by cell, then corners.
  std::vector<kernels::Triplet> read_triplets(const ShapeRange& shapes) const;
  kernels::RecognitionModel read_model() const;

 private:
  [[noreturn]] void refuse(const std::string& place, const std::string& problem) const;

  std::filesystem::path path_;
  FileDescriptor file_;
  std::string job_key_;
  std::string name_;
  std::uint64_t content_hash_ = 0;
  std::int64_t features_ = 0;
  std::int64_t samples_ = 0;
  std::array<std::uint32_t, kernels::kShapes + 1> offsets_ = {};
};

/// The key of the job that made a run; Error if the file is not a whole run of this version. Reads
/// a few kB.
std::string triplet_run_key(const std::filesystem::path& path);

}  // namespace semigeo::io
