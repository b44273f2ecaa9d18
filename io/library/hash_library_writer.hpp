#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "io/library/hash_library_format.hpp"
#include "io/library/packed_model.hpp"

namespace semigeo::io {

/// Says where a library comes from.
struct LibraryHeader {
  /// Parameters with which its triplets were made.
  nlohmann::json parameters = nlohmann::json::object();
  std::string job_key;  ///< Hash of everything that the content depends on.
};

/// Holds the sizes of a library that is going to be written.
struct LibrarySizes {
  std::int64_t postings = 0;
  std::int64_t models = 0;
  std::int64_t features = 0;      ///< Number in all models.
  std::int64_t level_scales = 0;  ///< Number in all models.
  std::int64_t samples = 0;       ///< Number in all models.
};

/// Writes a library (docs/formats/library.md), first its postings, block by block, then its models.
/// Equal content gives equal bytes. It keeps a few chunks, the index and about 200 bytes for each
/// model in memory. The file appears under its final name when it is whole and verified. Throws
/// std::invalid_argument on wrong use, and Error if the disk fails. Only one thread may use it at a
/// time.
class HashLibraryWriter {
 public:
  HashLibraryWriter(const std::filesystem::path& final_path, const LibraryHeader& header,
                    const LibrarySizes& sizes);

  /// Returns the shape of the postings. Every block but the last has posting_shape().chunk_rows
  /// postings, packed (kPostingBytes each); encode_rows(posting_shape(), rows) makes it, on any
  /// thread.
  const ArrayShape& posting_shape() const { return postings_.shape(); }
  /// Writes the next block, in the order of cell, model, corners.
  void write_block(const EncodedChunk& block);

  /// Writes the next model, after the last block; names ascend. `triplets` is the number of its
  /// postings.
  void write_model(const PackedModel& model, std::int64_t triplets);

  /// Ends the file and gives it its name. `cells` are those of HashLibrary::cells. Returns the
  /// content digest.
  std::string finish(std::span<const std::uint64_t> cells, const ForEach& for_each = {});

 private:
  /// An array that is gathered row by row.
  struct Rows {
    DigestedFile::Growing array;
    std::vector<std::byte> pending;
    std::vector<std::int64_t> offsets = {0};  ///< Where each model begins, and the end.

    void add(std::span<const std::byte> rows);
    void close();
  };
  Rows begin_rows(const ModelArray& array, std::int64_t rows);
  void write_small(const std::string& path, const ArrayView& view);

  AtomicFile target_;
  DigestedFile file_;
  LibrarySizes sizes_;
  DigestedFile::Growing postings_;
  std::int64_t blocks_ = 0;
  Rows features_;
  Rows level_scales_;
  Rows sample_points_;
  Rows sample_normals_;
  std::string last_name_;
  std::string names_;
  std::string digests_;
  std::string units_;
  std::vector<float> centres_;  // (models, 3)
  std::vector<float> diagonals_;
  std::vector<double> origins_;  // (models, 3)
  std::vector<float> spacings_;
  std::vector<std::int64_t> triplets_;
};

}  // namespace semigeo::io
