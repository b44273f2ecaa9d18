#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/hdf5/hdf5.hpp"

namespace semigeo::io {

/// An array that is being written to a file, which must outlive it and stay where it is.
class Hdf5File::Growing {
 public:
  const ArrayShape& shape() const { return known_->shape; }
  const std::string& path() const { return path_; }
  /// Writes the next chunk, or all rows of a compact array.
  void write_chunk(const EncodedChunk& chunk);
  /// Ends the array. It must be called after the last chunk.
  void close();

 private:
  friend class Hdf5File;
  Growing(const Hdf5File& file, std::string path, KnownArray& known, Hdf5Handle handle)
      : file_(&file), path_(std::move(path)), known_(&known), handle_(std::move(handle)) {}
  void write_compact(const std::vector<std::byte>& rows);

  const Hdf5File* file_;
  std::string path_;
  KnownArray* known_;
  Hdf5Handle handle_;
  std::int64_t written_ = 0;
};

/// An open array of a file, which must outlive it.
class Hdf5File::Array {
 public:
  /// Returns the shape. For a virtual array only type, rows and columns are valid.
  const ArrayShape& shape() const { return known_->shape; }
  const std::string& path() const { return path_; }
  const Hdf5File& file() const { return *file_; }
  bool is_virtual() const { return known_->is_virtual; }
  /// Returns whether the array has attributes.
  bool has_attributes() const;
  /// Returns the number of bytes of all its chunks in the file.
  std::int64_t stored_bytes() const;
  /// Reads a chunk as it lies in the file, without its hash.
  EncodedChunk read_chunk(std::int64_t index) const;
  /// Returns the pieces of a virtual array.
  const std::vector<VirtualPiece>& virtual_pieces() const { return known_->pieces; }

 private:
  friend class Hdf5File;
  Array(const Hdf5File& file, std::string path) : file_(&file), path_(std::move(path)) {}
  std::int64_t opened() const;

  const Hdf5File* file_;
  std::string path_;
  const KnownArray* known_ = nullptr;
  mutable Hdf5Handle handle_;  // opened when it is needed
};

}  // namespace semigeo::io
