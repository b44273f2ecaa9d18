#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "io/files/chunk_codec.hpp"

namespace semigeo::io {

/// Starts HDF5 in this process, if that has not been done. Throws std::bad_alloc if there is no
/// memory for it. Then no file can be opened in this process any more.
void start_hdf5();

/// The values that attributes of our files have.
using AttributeValue =
    std::variant<std::int64_t, double, std::string, std::vector<std::int64_t>, std::vector<double>>;

/// Returns how an attribute is stored: "int64", "float64[3]", "ascii[8]" or "utf8[9]" (bytes).
std::string attribute_type(const AttributeValue& value);

/// A whole dataset of the same file that a virtual dataset shows as its next rows.
struct VirtualPiece {
  std::string source;  ///< Absolute path.
  std::int64_t rows;   ///< Rows of the virtual dataset: (F, 3) seen as one column has 3 F of them.
  friend bool operator==(const VirtualPiece&, const VirtualPiece&) = default;
};

/// An entry of a group.
struct Hdf5Link {
  /// The kinds of objects.
  enum class Kind { kGroup, kArray, kOther };
  std::string name;
  Kind kind;
  std::uint64_t address;  ///< The same for every hard link to one object.
};

/// An attribute of an object.
struct Hdf5Attribute {
  std::string name;
  std::string type;  ///< Type as io::attribute_type names it.
  AttributeValue value;
};

/// Owns an HDF5 identifier (hid_t, whose header only hdf5_library.hpp includes).
class Hdf5Handle {
 public:
  /// Closes an identifier. Returns a negative number on failure.
  using Close = int (*)(std::int64_t);
  Hdf5Handle() = default;
  Hdf5Handle(std::int64_t id, Close closer) : id_(id), close_(closer) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Handle() { close(); }
  std::int64_t get() const { return id_; }
  /// Closes the identifier. Returns a negative number if HDF5 reports a failure. Closing twice does
  /// nothing.
  int close() { return id_ < 0 ? 0 : close_(std::exchange(id_, -1)); }

 private:
  std::int64_t id_ = -1;
  Close close_ = nullptr;
};

/// An HDF5 file restricted to what semigeo stores: groups, attributes of AttributeValue's types
/// with strings of fixed length, arrays of one or two dimensions chunked by rows or compact,
/// virtual arrays over arrays of the same file, and hard links. Anything else is an Error when it
/// is met.
///
/// Every failure is an Error that names the file, the object and HDF5's innermost reason. One
/// thread at a time may use a file; HDF5 itself serialises calls for different files.
class Hdf5File {
 public:
  /// Creates or overwrites a file. The same sequence of calls gives the same bytes. Messages name
  /// `shown_as` if it is given: the final name of a file that is written under a temporary one.
  static Hdf5File create(const std::filesystem::path& file,
                         const std::filesystem::path& shown_as = {});
  /// Opens a file for reading only.
  static Hdf5File open(const std::filesystem::path& file,
                       const std::filesystem::path& shown_as = {});

  const std::filesystem::path& path() const { return shown_as_; }

  /// Creates a group, whose parent must exist.
  void create_group(const std::string& path);
  /// Writes a whole array.
  void write_array(const std::string& path, const EncodedArray& array);
  class Growing;  // io/hdf5/hdf5_array.hpp
  /// Begins an array whose chunks come one by one; others may be written in between.
  Growing begin_array(const std::string& path, const ArrayShape& shape);
  /// Writes a virtual array, whose rows are those of all pieces, one after the other.
  void write_virtual(const std::string& path, ElementType type, int columns,
                     std::span<const VirtualPiece> pieces);
  /// Writes an attribute of an object.
  void write_attribute(const std::string& object, const std::string& name,
                       const AttributeValue& value);
  /// Gives the object `existing` the further name `path`: a hard link.
  void link(const std::string& existing, const std::string& path);
  /// Hands all that was written to the operating system.
  void flush();
  /// Flushes and closes the file. Nothing else may be called afterwards. The destructor closes the
  /// file as well, but reports no failure.
  void close();

  /// Returns whether there is an object of this path.
  bool has(const std::string& path) const;
  /// Returns whether an object has an attribute of this name.
  bool has_attribute(const std::string& object, const std::string& name) const;
  /// Returns the entries of a group, by name.
  std::vector<Hdf5Link> links(const std::string& group) const;
  /// Returns the address of an object, which is the same for every hard link to it.
  std::uint64_t address(const std::string& path) const;
  /// Returns all attributes of an object, by name. They are kept in memory.
  const std::vector<Hdf5Attribute>& attributes(const std::string& object) const;
  /// Reads an attribute. Throws Error if it is missing or of a type that is not used.
  AttributeValue read_attribute(const std::string& object, const std::string& name) const;
  /// Reads an attribute that must have this type. Throws Error if it has another.
  template <typename Value>
  Value read_attribute_as(const std::string& object, const std::string& name) const {
    const AttributeValue value = read_attribute(object, name);
    if (const Value* known = std::get_if<Value>(&value)) return *known;
    refuse(object, "its attribute " + name + " has the wrong type");
  }
  /// Returns the type as io::attribute_type names it, or "unsupported".
  std::string attribute_type(const std::string& object, const std::string& name) const;

  class Array;  // io/hdf5/hdf5_array.hpp
  /// Opens an array for reading. Its description is kept in memory, and the rows of a compact array
  /// as well.
  Array open_array(const std::string& path) const;
  /// Returns the shape of an array.
  ArrayShape shape_of(const std::string& path) const { return look_at(path).shape; }
  /// Returns whether an array is virtual.
  bool is_virtual(const std::string& path) const { return look_at(path).is_virtual; }

  /// Reads a whole array through HDF5's own filters and virtual mappings, as little-endian rows.
  /// It is for tests: it is slow, and does not check the size that the file states.
  std::vector<std::byte> read_through_library(const std::string& path) const;

  /// Throws the Error for a problem at a place of this file.
  [[noreturn]] void refuse(const std::string& place, const std::string& problem) const;

 private:
  Hdf5File(Hdf5Handle handle, std::filesystem::path shown_as, bool writing)
      : handle_(std::move(handle)), shown_as_(std::move(shown_as)), writing_(writing) {}
  [[noreturn]] void fail(const std::string& place, const std::string& action) const;
  std::int64_t checked(std::int64_t result, const std::string& place, const char* action) const;
  std::int64_t id() const;
  /// Returns an object, which stays open until another one is opened, since most calls concern the
  /// same object as the call before.
  std::int64_t opened(const std::string& path) const;
  struct Entry {
    std::int64_t group;  // the open group that has the object
    const char* name;    // name of the object in the group; valid as long as the path
  };
  Entry entry(const std::string& path) const;
  std::int64_t type_of(ElementType type) const;
  std::optional<ElementType> element_type(std::int64_t type) const;
  Hdf5Attribute read(const Hdf5Handle& attribute, const std::string& object,
                     const std::string& name) const;
  const Hdf5Attribute* find_known(const std::string& object, const std::string& name) const;
  Hdf5Handle open_attribute(const std::string& object, const std::string& name) const;

  struct KnownArray {
    ArrayShape shape;
    bool is_virtual = false;
    std::vector<VirtualPiece> pieces;  // pieces of a virtual array
    std::vector<std::byte> rows;       // rows of a compact array
  };
  const KnownArray& look_at(const std::string& path) const;
  KnownArray described(const std::string& path, std::int64_t array) const;
  void describe_chunks(const std::string& path, std::int64_t creation, ArrayShape& shape) const;
  std::vector<std::byte> compact_rows(const std::string& path, std::int64_t array,
                                      const ArrayShape& shape) const;
  std::vector<VirtualPiece> pieces_of(const std::string& path, std::int64_t creation,
                                      int columns) const;

  Hdf5Handle handle_;
  std::filesystem::path shown_as_;
  bool writing_ = false;
  // Descriptions of objects that were read or written. They do not change any more.
  mutable std::map<std::string, KnownArray> arrays_;
  mutable std::map<std::string, std::vector<Hdf5Attribute>> attributes_;
  mutable std::map<ElementType, Hdf5Handle> records_;  // HDF5 types of records
  mutable std::string opened_path_;
  mutable Hdf5Handle opened_;  // after handle_, so that it is closed before
};

}  // namespace semigeo::io
