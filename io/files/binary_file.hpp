#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "io/files/input_file.hpp"
#include "io/files/output_file.hpp"

namespace semigeo::io {

/// Describes a kind of binary file of ours (docs/formats/library.md): it has a magic and a version,
/// data, a head that tells what the data is, and a trailer that finds the head and has its
/// checksum. All of it is little endian.
struct BinaryFormat {
  std::string_view magic;  ///< 8 characters.
  std::uint32_t version;   ///< The version that this program reads.
  const char* noun;        ///< Name of the kind in messages: "a run of triplets".
};

/// Collects numbers and texts for the head of a file, one after the other.
class HeadWriter {
 public:
  /// Adds a number.
  template <typename Number>
  void number(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    numbers(std::span<const Number>(&value, 1));
  }
  /// Adds numbers, without their count.
  template <typename Number>
  void numbers(std::span<const Number> values) {
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }
  /// Adds a text, its length first.
  void text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    bytes_.append(text);
  }
  /// Returns all that was added.
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Writes a binary file: data first, the head last. Every failure is an Error.
class BinaryWriter {
 public:
  /// Begins a file, which has its name only when it is finished.
  BinaryWriter(const std::filesystem::path& path, const BinaryFormat& format);
  /// Appends bytes to the data.
  void data(std::span<const std::byte> bytes);
  /// Ends the file, which then appears under its name.
  void finish(const HeadWriter& head);
  /// Ends the file as AtomicFile::commit_unsynced does.
  void finish_unsynced(const HeadWriter& head);

 private:
  void write_end(const HeadWriter& head);

  OutputFile file_;
};

/// Reads a binary file. Every failure is an Error. `read` may be called by several threads at once.
class BinaryFile {
 public:
  /// Opens a file, and checks everything but the data.
  BinaryFile(const std::filesystem::path& path, const BinaryFormat& format);

  const std::filesystem::path& path() const { return file_.path(); }
  /// Returns the XXH3_64 of the head.
  std::uint64_t head_hash() const { return head_hash_; }
  /// Returns the number of bytes of the data.
  std::uint64_t data_bytes() const { return data_bytes_; }

  // These read the head from its beginning to its end. They throw Error if it ends too early.
  template <typename Number>
  Number number() {
    Number value;
    take(&value, sizeof value);
    return value;
  }
  template <typename Number>
  void numbers(std::span<Number> values) {
    take(values.data(), values.size_bytes());
  }
  /// Reads `count` numbers. Throws Error before anything is allocated if the head has fewer.
  template <typename Number>
  std::vector<Number> numbers(std::uint64_t count) {
    if (count > (head_.size() - taken_) / sizeof(Number)) refuse("head", "ends too early");
    std::vector<Number> values(count);
    numbers(std::span<Number>(values));
    return values;
  }
  /// Reads a text that HeadWriter::text has added.
  std::string text();
  /// Ends the reading of the head. Throws Error if there is more of it.
  void end_of_head();

  /// Reads a piece of the data; `offset` counts from its first byte. The content is not checked.
  std::vector<std::byte> read(std::uint64_t offset, std::uint64_t bytes) const;

  /// Throws the Error for a problem at a place of this file.
  [[noreturn]] void refuse(const std::string& place, const std::string& problem) const;

 private:
  void take(void* to, std::size_t bytes);

  InputFile file_;
  std::string head_;
  std::size_t taken_ = 0;
  std::uint64_t head_hash_ = 0;
  std::uint64_t data_bytes_ = 0;
};

}  // namespace semigeo::io
