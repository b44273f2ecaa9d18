#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/hdf5/content_digest.hpp"
#include "io/hdf5/hdf5.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::fuzz {

/// What an HDF5 file of semigeo holds, in memory, to be changed and written again with a digest
/// that is right.
class Hdf5Tree {
 public:
  /// Reads all of a file.
  explicit Hdf5Tree(const io::Hdf5File& file);

  /// Makes the changes that the numbers describe, of arrays, attributes, groups and links.
  void edit(Numbers& numbers);
  /// Writes a file. Throws io::Error or std::invalid_argument if HDF5 or the writer refuse it.
  void write(const std::filesystem::path& path) const;

 private:
  struct Array {
    io::ArrayShape shape;
    std::vector<std::byte> rows;
    std::vector<io::EncodedChunk> chunks;  ///< Empty if the rows have changed since.
    bool is_virtual = false;
    std::vector<io::VirtualPiece> pieces = {};
  };
  struct Object {
    std::string path;
    std::string link = {};  ///< The path of an earlier object that is the same; or empty.
    bool is_array = false;
    Array array = {};
    std::vector<io::Hdf5Attribute> attributes = {};
  };

  void read_group(const io::Hdf5File& file, const std::string& path,
                  std::map<std::uint64_t, std::string>& known);
  Array read_array(const io::Hdf5File& file, const std::string& path) const;
  void edit_array(Array& array, Numbers& numbers);
  void edit_attribute(Object& object, Numbers& numbers);
  void write_object(io::DigestedFile& file, const Object& object) const;
  std::vector<std::size_t> arrays_;  ///< Indices of objects that are arrays.
  std::vector<Object> objects_;      ///< Groups stand before what they hold.
};

}  // namespace semigeo::fuzz
