#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>

#include "io/hdf5.hpp"

namespace semigeo::io {

/// Fingerprint of everything a file says: XXH3_128 over one line of text per object, sorted, so
/// that neither the order of writing nor HDF5's layout matters. io/DATASET.md lists the lines.
/// The attributes `digest` and `complete` of the root are left out.
class ContentDigest {
 public:
  void add_group(const std::string& path);
  /// `chunk_hashes`: EncodedChunk::raw_xxh3 of every chunk, in order.
  void add_array(const std::string& path, const ArrayShape& shape,
                 std::span<const std::uint64_t> chunk_hashes);
  void add_virtual(const std::string& path, ElementType type, std::int64_t rows, int columns,
                   std::span<const VirtualPiece> pieces);
  void add_attribute(const std::string& object, const std::string& name, const std::string& type,
                     const AttributeValue& value);
  /// A further name of an object whose first name, in the order of paths, is `first`.
  void add_link(const std::string& path, const std::string& first);

  /// 32 hexadecimal digits.
  std::string hex() const;

 private:
  std::set<std::string> lines_;
};

/// The digest of what `file` holds, by reading all of it, one chunk in memory at a time. Error when
/// a checksum is wrong or an object is none that a dataset uses.
std::string content_digest(const Hdf5File& file);

/// An HDF5 file in the making that enters each object in the digest as it is written.
class DigestedFile {
 public:
  explicit DigestedFile(Hdf5File file) : file_(std::move(file)) { digest_.add_group("/"); }

  void create_group(const std::string& path);
  void write_array(const std::string& path, const EncodedArray& array);
  void write_virtual(const std::string& path, ElementType type, int columns,
                     std::span<const VirtualPiece> pieces);
  void write_attribute(const std::string& object, const std::string& name,
                       const AttributeValue& value);
  void link(const std::string& existing, const std::string& path);

  const ContentDigest& digest() const { return digest_; }
  /// For what the digest leaves out.
  Hdf5File& file() { return file_; }

 private:
  Hdf5File file_;
  ContentDigest digest_;
};

}  // namespace semigeo::io
