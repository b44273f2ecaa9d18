#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/files/binary_file.hpp"
#include "io/library/shape_range.hpp"

namespace semigeo::io {

/// Describes a partition.
struct PartitionHeader {
  std::string job_key;
  ShapeRange shapes;
  std::int64_t models = 0;      ///< Number of models of the library.
  std::uint64_t runs_hash = 0;  ///< runs_hash of the runs that it was made of.
};

/// Returns the XXH3_64 of TripletRun::content_hash of all runs, in the order of models.
std::uint64_t runs_hash(std::span<const std::uint64_t> content_hashes);

/// Writes the postings of a range of shapes (docs/formats/library.md), piece by piece. The file
/// appears under its name when it is whole. It is not forced to the disk, because it is removed as
/// soon as the library is made; so a power cut may damage it. It keeps two blocks in memory.
class PostingPartitionWriter {
 public:
  PostingPartitionWriter(const std::filesystem::path& path, PartitionHeader header);
  /// Adds the next postings, packed as ElementType::kPosting, in the order of cell, model, corners.
  void add(std::span<const std::byte> rows);
  /// Ends the file. `cell_counts` says how many postings each cell of the range has. Throws
  /// std::invalid_argument if these are not as many as were added.
  void finish(std::span<const std::uint32_t> cell_counts);

 private:
  void write_block(std::span<const std::byte> rows);

  PartitionHeader header_;
  BinaryWriter file_;
  std::vector<std::byte> pending_;
  std::vector<std::uint64_t> block_hashes_;
  std::uint64_t postings_ = 0;
};

/// Reads a partition: its head at once, its postings block by block, each against a checksum. Every
/// failure is an Error that names the file and what is wrong with it. Several threads may use it at
/// once.
class PostingPartition {
 public:
  explicit PostingPartition(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.path(); }
  const PartitionHeader& header() const { return header_; }
  /// Returns the number of postings of each cell of the range.
  std::span<const std::uint32_t> cell_counts() const { return cell_counts_; }
  std::int64_t postings() const { return postings_; }
  std::int64_t blocks() const { return static_cast<std::int64_t>(block_hashes_.size()); }
  /// Reads a block of packed postings, at most 65,536.
  std::vector<std::byte> read_block(std::int64_t block) const;

 private:
  BinaryFile file_;
  PartitionHeader header_;
  std::vector<std::uint32_t> cell_counts_;
  std::int64_t postings_ = 0;
  std::vector<std::uint64_t> block_hashes_;
};

/// Returns the key of the job that made a partition. Reads all of the file, and throws Error if it
/// is not a whole partition of this version, or damaged in any place.
std::string posting_partition_key(const std::filesystem::path& path);

}  // namespace semigeo::io
