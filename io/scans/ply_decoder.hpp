#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

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

/// Reads the values of an ascii PLY, record by record: one line each.
class PlyAsciiDecoder {
 public:
  PlyAsciiDecoder(ByteSource& source, const PlyHeader& header, const ScanBuilder& builder)
      : scanner_(source, {}, header.lines + 1), builder_(builder) {}

  /// Begins record `index` of an element. Throws Error if the file ends.
  void begin_record(const PlyElement& element, std::int64_t index) {
    if (!scanner_.skip_to_content())
      builder_.fail_promise(plural(element), element.count, index, place());
  }
  /// Ends the record. Throws Error if its line has more values.
  void end_record() {
    if (!scanner_.at_line_end())
      scanner_.fail("the line has more values than the header declares",
                    "correct the line or export the scan again");
  }
  /// Returns the place of the record.
  Place place() const { return {Place::Unit::kLine, scanner_.line()}; }

  /// Reads a number.
  double scalar(const PlyProperty& property) { return scanner_.number(property.name); }
  /// Reads the length of a list. Throws Error if it is negative.
  std::int64_t length(const PlyProperty& property) {
    const std::int64_t length = scanner_.integer(property.name);
    if (length < 0) scanner_.fail("the length of list " + property.name + " is negative");
    return length;
  }
  /// Reads the items of a list as integers, and calls receive(item) for each.
  template <typename Receiver>
  void items(const PlyProperty& property, std::int64_t length, Receiver receive) {
    for (std::int64_t i = 0; i < length; ++i) receive(scanner_.integer(property.name));
  }
  /// Passes over a number or a list.
  void skip(const PlyProperty& property) {
    const std::int64_t words = property.count_type ? length(property) : 1;
    for (std::int64_t i = 0; i < words; ++i)
      if (scanner_.word().empty())
        scanner_.fail("the line ends where " + property.name + " should be",
                      "correct the line or export the scan again");
  }

 private:
  TextScanner scanner_;
  const ScanBuilder& builder_;
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
    const std::int64_t bytes = count * ply_type_size(property.type);
    if (source_.skip(bytes) < bytes) fail_end();
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
