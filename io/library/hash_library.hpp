#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "io/hdf5/for_each.hpp"
#include "kernels/recognition/recognition_model.hpp"

namespace semigeo::io {

/// Holds what is known about a model before it is read.
struct ModelInfo {
  std::string name;
  std::string digest;  ///< Digest of its dataset.
  float diagonal = 0;
  std::int64_t features = 0;
  std::int64_t samples = 0;
  std::int64_t triplets = 0;
};

/// Reads a library (docs/formats/library.md). Opening it reads the index and a few bytes for each
/// model; postings and models are read as they are asked for, each checked against its checksum.
/// Every failure is an Error that names the file and the object.
class HashLibrary {
 public:
  /// Opens a library for reading only. Throws Error on other formats, other versions and unfinished
  /// files.
  explicit HashLibrary(const std::filesystem::path& path);
  ~HashLibrary();
  HashLibrary(HashLibrary&&) noexcept;
  HashLibrary& operator=(HashLibrary&&) noexcept;

  const std::filesystem::path& path() const;
  /// Returns the parameters with which triplets were made. A text of the file that is not JSON
  /// is a string here.
  const nlohmann::json& parameters() const;
  /// Returns the content digest: 32 hexadecimal digits.
  const std::string& digest() const;
  /// Returns what is known of each model, sorted by name.
  const std::vector<ModelInfo>& models() const;

  /// Returns (kTripletCells + 1) numbers: postings of cell c are those from cells[c] to cells[c +
  /// 1].
  std::span<const std::uint64_t> cells() const;
  /// Returns the number of postings of all models.
  std::int64_t posting_count() const;
  /// Returns the number of postings in a block; the last may be shorter. Block b begins with
  /// posting b * block_size().
  std::int64_t block_size() const;
  /// Reads a block of postings, sorted by cell, then model, then corners. May be called by several
  /// threads at once.
  std::vector<kernels::Posting> read_block(std::int64_t block) const;

  /// Reads a model. May be called by several threads at once.
  kernels::RecognitionModel read_model(std::int64_t model) const;

  /// Reads everything against checksums and the digest, and checks order, ranges and indices too.
  /// Throws Error on the first fault. It keeps several chunks in memory. Threads other than those
  /// of for_each wait meanwhile.
  void verify(const ForEach& for_each = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns the key of the job that made a library. Throws Error if the file is absent, unreadable,
/// of another format or version, or incomplete. Reads a few kB.
std::string library_key(const std::filesystem::path& path);

}  // namespace semigeo::io
