#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <string>

#include "io/files/binary_load.hpp"
#include "io/files/byte_source.hpp"
#include "io/scans/place.hpp"
#include "io/scans/ply_header.hpp"
#include "io/scans/scan_builder.hpp"
#include "io/scans/text_scanner.hpp"

namespace semigeo::io {

/// Returns what messages call the records of an element.
inline std::string plural(const PlyElement& element) {
  if (element.name == "vertex") return "vertices";
  if (element.name == "face") return "faces";
  return "records of element '" + element.name + "'";
}

/// Reads the values of an ascii PLY, record by record. Each begins on a line of its own. A record
/// whose line has too few values goes on in the lines behind it, and must end with one of them.
/// What is left of a line behind a record that did not go on is surplus, which is counted.
class PlyAsciiDecoder {
 public:
  PlyAsciiDecoder(ByteSource& source, const PlyHeader& header, ScanBuilder& builder)
      : scanner_(source, {}, header.lines + 1), builder_(builder) {}

  /// Begins record `index` of an element. Throws Error if the file ends.
  void begin_record(const PlyElement& element, std::int64_t index) {
    if (!scanner_.skip_to_content()) fail_end(element, index);
    start_ = scanner_.line();
    first_continued_ = nullptr;
  }
  /// Ends the record. Throws Error if it began on an earlier line and the line has more values.
  void end_record() {
    if (!scanner_.at_line_end()) pass_surplus();
  }
  /// Returns the place of the record.
  Place place() const { return {Place::Unit::kLine, start_}; }

  /// Reads a number.
  double scalar(const PlyProperty& property) {
    reach_value(property);
    return scanner_.number(property.name);
  }
  /// Reads the length of a list. Throws Error if it is negative.
  std::int64_t length(const PlyProperty& property) {
    const std::int64_t length = integer(property);
    if (length < 0) scanner_.fail("the length of list " + property.name + " is negative");
    return length;
  }
  /// Reads the items of a list as integers, and calls receive(item) for each.
  template <typename Receiver>
  void items(const PlyProperty& property, std::int64_t length, Receiver receive) {
    for (std::int64_t i = 0; i < length; ++i) receive(integer(property));
  }
  /// Passes over a number or a list.
  void skip(const PlyProperty& property) {
    const std::int64_t words = property.count_type ? length(property) : 1;
    for (std::int64_t i = 0; i < words; ++i) {
      reach_value(property);
      scanner_.word();
    }
  }

 private:
  std::int64_t integer(const PlyProperty& property) {
    reach_value(property);
    return scanner_.integer(property.name);
  }
  /// Goes on to the next line that holds something if the rest of this one holds nothing. Throws
  /// Error if there is none.
  void reach_value(const PlyProperty& property) {
    if (!scanner_.at_line_end()) return;
    const std::int64_t line = scanner_.line();
    if (first_continued_ == nullptr) {
      first_continued_ = &property;
      continued_line_ = line;
    }
    if (!scanner_.skip_to_content())
      builder_.fail({Place::Unit::kLine, line},
                    "the file ends where " + property.name + " should be",
                    "copy the file again from its source");
  }
  void pass_surplus() {
    if (first_continued_ != nullptr)
      builder_.fail({Place::Unit::kLine, continued_line_},
                    "the line ends where " + first_continued_->name + " should be", kMendLine);
    if (first_surplus_line_ == 0) first_surplus_line_ = scanner_.line();
    std::int64_t words = 0;
    while (!scanner_.word().empty()) ++words;
    builder_.add_surplus_values(words);
  }
  [[noreturn]] void fail_end(const PlyElement& element, std::int64_t found) {
    // Several records in one line look like surplus until the file ends too early.
    const std::string hint = first_surplus_line_ == 0
                                 ? std::string()
                                 : "; line " + std::to_string(first_surplus_line_) +
                                       " has more values than the header declares";
    builder_.fail_promise(plural(element), element.count, found,
                          {Place::Unit::kLine, scanner_.line()}, hint);
  }

  static constexpr const char* kMendLine = "correct the line or export the scan again";

  TextScanner scanner_;
  ScanBuilder& builder_;
  std::int64_t start_ = 0;                        // line of the record
  const PlyProperty* first_continued_ = nullptr;  // first value that is not on the record's line
  std::int64_t continued_line_ = 0;               // the line that ends before it
  std::int64_t first_surplus_line_ = 0;
};

/// Reads the values of a binary PLY of either byte order. It has the functions of PlyAsciiDecoder.
class PlyBinaryDecoder {
 public:
  PlyBinaryDecoder(ByteSource& source, const PlyHeader& header, const ScanBuilder& builder)
      : source_(source),
        builder_(builder),
        order_(header.encoding == PlyHeader::Encoding::kBigEndian ? std::endian::big
                                                                  : std::endian::little) {}

  void begin_record(const PlyElement& element, std::int64_t index) {
    element_ = &element;
    index_ = index;
    start_ = source_.position();
  }
  void end_record() {}
  Place place() const { return {Place::Unit::kByte, start_}; }

  double scalar(const PlyProperty& property) { return next<double>(property.type); }
  std::int64_t length(const PlyProperty& property) {
    const auto length = next<std::int64_t>(*property.count_type);
    if (length < 0) builder_.fail(place(), "the length of list " + property.name + " is negative");
    return length;
  }
  template <typename Receiver>
  void items(const PlyProperty& property, std::int64_t length, Receiver receive) {
    for (std::int64_t i = 0; i < length; ++i) receive(next<std::int64_t>(property.type));
  }
  void skip(const PlyProperty& property) {
    const std::int64_t count = property.count_type ? length(property) : 1;
    const std::int64_t size = ply_type_size(property.type);
    if (count > std::numeric_limits<std::int64_t>::max() / size) fail_end();
    if (source_.skip(count * size) < count * size) fail_end();
  }

 private:
  template <typename Number>
  Number next(PlyType type) {
    const auto size = static_cast<std::size_t>(ply_type_size(type));
    if (!source_.fill(size)) fail_end();
    const char* const from = source_.ahead().data();
    source_.consume(size);
    switch (type) {
      case PlyType::kInt8:
        return load<std::int8_t>(from, order_);
      case PlyType::kUint8:
        return load<std::uint8_t>(from, order_);
      case PlyType::kInt16:
        return load<std::int16_t>(from, order_);
      case PlyType::kUint16:
        return load<std::uint16_t>(from, order_);
      case PlyType::kInt32:
        return load<std::int32_t>(from, order_);
      case PlyType::kUint32:
        return load<std::uint32_t>(from, order_);
      case PlyType::kInt64:
        return static_cast<Number>(load<std::int64_t>(from, order_));
      case PlyType::kUint64:
        return static_cast<Number>(load<std::uint64_t>(from, order_));
      case PlyType::kFloat32:
        return static_cast<Number>(load<float>(from, order_));
      case PlyType::kFloat64:
        return static_cast<Number>(load<double>(from, order_));
    }
    return 0;
  }
  [[noreturn]] void fail_end() {
    source_.skip(ByteSource::kWindowBytes);  // passes over the rest of a number, to the end
    builder_.fail_promise(plural(*element_), element_->count, index_,
                          {Place::Unit::kByte, source_.position()});
  }

  ByteSource& source_;
  const ScanBuilder& builder_;
  std::endian order_;
  const PlyElement* element_ = nullptr;
  std::int64_t index_ = 0;
  std::int64_t start_ = 0;
};

}  // namespace semigeo::io
