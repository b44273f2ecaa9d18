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

/// What is known of a model without reading it.
struct ModelInfo {
  std::string name;
  std::string digest;  ///< of its dataset
  float diagonal = 0;
  std::int64_t features = 0;
  std::int64_t samples = 0;
  std::int64_t triplets = 0;
};

/// Reads a library (docs/formats/library.md). Opening reads the index and a few bytes a model;
/// postings and models are read as they are asked for, each checked against its checksum. Every
/// failure is an Error that names the file and the object.
class HashLibrary {
 public:
  /// Refuses other formats, versions of the future and unfinished files.
  explicit HashLibrary(const std::filesystem::path& path);
  ~HashLibrary();
  HashLibrary(HashLibrary&&) noexcept;
  HashLibrary& operator=(HashLibrary&&) noexcept;

  const std::filesystem::path& path() const;
  const nlohmann::json& parameters() const;  ///< with which triplets were made
  const std::string& digest() const;         ///< content digest, 32 hexadecimal digits
  const std::vector<ModelInfo>& models() const;

  /// (kTripletCells + 1): postings of cell c are those from cells[c] to cells[c + 1].
  std::span<const std::uint64_t> cells() const;
  std::int64_t posting_count() const;
  /// Postings are read by blocks of so many, the last may be shorter: block b begins with posting
  /// b * block_size().
  std::int64_t block_size() const;
  /// Sorted by cell, then model, then corners. May be called by several threads at once.
  std::vector<kernels::Posting> read_block(std::int64_t block) const;

  /// May be called by several threads at once.
  kernels::RecognitionModel read_model(std::int64_t model) const;

  /// Reads everything against checksums and the digest; order, ranges and indices too. Memory: some
  /// chunks. Threads that are none of for_each's wait meanwhile.
  void verify(const ForEach& for_each = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The key of the job that made a library; Error if the file is absent, unreadable, of another
/// format or version, or incomplete. Reads a few kB.
std::string library_key(const std::filesystem::path& path);

}  // namespace semigeo::io
