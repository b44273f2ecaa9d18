#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "io/files/binary_load.hpp"
#include "io/scans/lzf.hpp"
#include "io/scans/pcd_header.hpp"
#include "io/scans/scan_builder.hpp"
#include "io/scans/scan_formats.hpp"
#include "io/scans/text_scanner.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kCopyAgain = "copy the file again from its source";

/// Reads the coordinate that a field holds.
double coordinate(const char* from, const PcdField& field) {
  return field.size == 4 ? load<float>(from, std::endian::little)
                         : load<double>(from, std::endian::little);
}

/// Reads the points of an organised PCD, row after row.
class PcdBody {
 public:
  PcdBody(ByteSource& source, const PcdHeader& header, ScanBuilder& builder)
      : source_(source),
        header_(header),
        builder_(builder),
        count_(header.width * header.height),
        grid_{.rows = header.height, .columns = header.width, .cells = {}, .eye = header.eye} {}

  void read() {
    switch (header_.encoding) {
      case PcdHeader::Encoding::kAscii:
        read_ascii();
        break;
      case PcdHeader::Encoding::kBinary:
        read_binary();
        break;
      case PcdHeader::Encoding::kCompressed:
        read_compressed();
        break;
    }
    builder_.add_grid(std::move(grid_), {Place::Unit::kLine, header_.lines});
  }

 private:
  void add(const Eigen::Vector3d& p, Place place) {
    // Rays that met nothing have a coordinate that is no number.
    const bool measured = p.allFinite();
    grid_.cells.push_back(measured ? static_cast<std::int32_t>(builder_.point_count()) : -1);
    if (measured) builder_.add_point(p.x(), p.y(), p.z(), place);
  }

  void read_ascii() {
    TextScanner scanner(source_, {}, header_.lines + 1);
    std::int64_t last = 0;
    for (const std::int64_t axis : header_.axes) last = std::max(last, header_.fields[axis].column);
    for (std::int64_t i = 0; i < count_; ++i) {
      const bool more = scanner.skip_to_content();
      const Place place = {Place::Unit::kLine, scanner.line()};
      if (!more) builder_.fail_promise("points", count_, i, place);
      Eigen::Vector3d p;
      for (std::int64_t column = 0; column <= last; ++column) {
        int axis = 0;
        while (axis < 3 && header_.axis(axis).column != column) ++axis;
        if (axis < 3) {
          p[axis] = scanner.number(header_.axis(axis).name);
        } else {
          scanner.word();
        }
      }
      add(p, place);
      scanner.next_line();
    }
  }

  void read_binary() {
    const auto bytes = static_cast<std::size_t>(header_.point_bytes);
    for (std::int64_t i = 0; i < count_; ++i) {
      const Place place = {Place::Unit::kByte, source_.position()};
      if (!source_.fill(bytes)) builder_.fail_promise("points", count_, i, place);
      const char* const from = source_.ahead().data();
      Eigen::Vector3d p;
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = coordinate(from + header_.axis(axis).offset, header_.axis(axis));
      source_.consume(bytes);
      add(p, place);
    }
  }

  /// Reads data that is packed as a whole: all values of the first field, then of the second, ...
  void read_compressed() {
    const Place place = {Place::Unit::kByte, source_.position()};
    const std::string plain = unpacked(place);
    for (std::int64_t i = 0; i < count_; ++i) {
      Eigen::Vector3d p;
      for (int axis = 0; axis < 3; ++axis) {
        const PcdField& field = header_.axis(axis);
        p[axis] = coordinate(plain.data() + count_ * field.offset + i * field.size, field);
      }
      add(p, place);
    }
  }

  std::string unpacked(Place place) {
    if (!source_.fill(8)) builder_.fail_promise("points", count_, 0, place);
    const auto packed_size = load<std::uint32_t>(source_.ahead().data(), std::endian::little);
    const auto size = load<std::uint32_t>(source_.ahead().data() + 4, std::endian::little);
    source_.consume(8);
    if (size % header_.point_bytes != 0 || size / header_.point_bytes != count_)
      builder_.fail(place,
                    "the compressed data holds " + std::to_string(size) + " bytes, not " +
                        std::to_string(count_) + " points of " +
                        std::to_string(header_.point_bytes) + " bytes",
                    "export the scan again");
    std::string packed;
    while (packed.size() < packed_size && source_.fill(1)) {
      const std::string_view ahead = source_.ahead().substr(0, packed_size - packed.size());
      packed += ahead;
      source_.consume(ahead.size());
    }
    if (packed.size() < packed_size)
      builder_.fail({Place::Unit::kByte, source_.position()},
                    "the file ends within its compressed data", kCopyAgain);
    std::optional<std::string> plain = unpack_lzf(packed, size);
    if (!plain) builder_.fail(place, "the compressed data is damaged", kCopyAgain);
    return std::move(*plain);
  }

  ByteSource& source_;
  const PcdHeader& header_;
  ScanBuilder& builder_;
  std::int64_t count_;
  kernels::RangeGrid grid_;
};

Scan read_pcd(ByteSource& source, const ScanOptions& options) {
  const PcdHeader header = read_pcd_header(source);
  ScanBuilder builder(source, options);
  builder.add_unknown_header_lines(header.unknown_lines);
  PcdBody(source, header, builder).read();
  switch (header.encoding) {
    case PcdHeader::Encoding::kAscii:
      return builder.finish("PCD ascii");
    case PcdHeader::Encoding::kBinary:
      return builder.finish("PCD binary");
    case PcdHeader::Encoding::kCompressed:
      break;
  }
  return builder.finish("PCD binary compressed");
}

std::string variant_of(std::string_view begin) {
  if (begin.find("DATA binary_compressed") != std::string_view::npos)
    return "PCD binary compressed";
  return begin.find("DATA binary") != std::string_view::npos ? "PCD binary" : "PCD ascii";
}

}  // namespace

const ScanFormat kPcdFormat = {.extension = ".pcd",
                               .read = read_pcd,
                               .variant = variant_of,
                               .content = "range grids",
                               .variants = "ascii, binary, binary_compressed"};

}  // namespace semigeo::io
