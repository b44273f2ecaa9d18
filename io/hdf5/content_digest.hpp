#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/hdf5/for_each.hpp"
#include "io/hdf5/hdf5_array.hpp"

namespace semigeo::io {

/// Computes the digest of all that a file holds. It is the XXH3_128 of a text with one line for
/// each object. The lines are sorted, so that neither the order of writing nor HDF5's layout
/// matters. docs/formats/dataset.md lists the lines. The attributes `digest` and `complete` of the
/// root are left out.
class ContentDigest {
 public:
  /// Adds a group.
  void add_group(const std::string& path);
  /// Adds an array. `chunk_hashes` are EncodedChunk::raw_xxh3 of every chunk, in order.
  void add_array(const std::string& path, const ArrayShape& shape,
                 std::span<const std::uint64_t> chunk_hashes);
  /// Adds a virtual array and the pieces that it shows.
  void add_virtual(const std::string& path, ElementType type, std::int64_t rows, int columns,
                   std::span<const VirtualPiece> pieces);
  /// Adds an attribute of an object. `type` is what `attribute_type` returns.
  void add_attribute(const std::string& object, const std::string& name, const std::string& type,
                     const AttributeValue& value);
  /// Adds a further name of an object whose first name, in the order of paths, is `first`.
  void add_link(const std::string& path, const std::string& first);

  /// Returns the digest as 32 hexadecimal digits.
  std::string hex() const;

 private:
  std::set<std::string> lines_;
};

/// Receives the path of an array, the number of the first row of a chunk, and the rows of the
/// chunk.
using SeenRows = std::function<void(const std::string&, std::int64_t, std::span<const std::byte>)>;

/// Returns the digest of what `file` holds, by reading all of it. One chunk at a time is in memory,
/// or several if `for_each` has several threads. Throws Error if a checksum is wrong, or if there
/// is an object of a kind that is not used. `seen` receives each chunk of each array: in order, or
/// from several threads at once.
std::string content_digest(const Hdf5File& file, const SeenRows& seen = {},
                           const ForEach& for_each = {});

/// An HDF5 file in the making that enters each object in the digest as it is written.
class DigestedFile {
 public:
  explicit DigestedFile(Hdf5File file) : file_(std::move(file)) { digest_.add_group("/"); }

  // These functions do what those of Hdf5File do, and enter the object in the digest.
  void create_group(const std::string& path);
  void write_array(const std::string& path, const EncodedArray& array);
  /// An array whose chunks come one by one. The DigestedFile must outlive it and stay where it is.
  class Growing {
   public:
    const ArrayShape& shape() const { return array_.shape(); }
    void write_chunk(const EncodedChunk& chunk);  ///< Writes the next chunk.
    /// Ends the array. It must be called after the last chunk.
    void close();

   private:
    friend class DigestedFile;
    Growing(ContentDigest& digest, Hdf5File::Growing array)
        : digest_(&digest), array_(std::move(array)) {}
    ContentDigest* digest_;
    Hdf5File::Growing array_;
    std::vector<std::uint64_t> hashes_;
  };
  Growing begin_array(const std::string& path, const ArrayShape& shape);
  void write_virtual(const std::string& path, ElementType type, int columns,
                     std::span<const VirtualPiece> pieces);
  void write_attribute(const std::string& object, const std::string& name,
                       const AttributeValue& value);
  void link(const std::string& existing, const std::string& path);

  const ContentDigest& digest() const { return digest_; }
  /// Returns the file itself, for what the digest leaves out.
  Hdf5File& file() { return file_; }

 private:
  Hdf5File file_;
  ContentDigest digest_;
};

}  // namespace semigeo::io
