#include "io/scans/vtk_cells.hpp"

#include <algorithm>

#include "io/files/binary_load.hpp"
#include "io/scans/triangle_strip.hpp"

namespace semigeo::io {
namespace {

template <typename Number, typename Signed, typename Unsigned>
Number load_whole(const char* from, std::endian order, bool is_signed) {
  if (is_signed) return static_cast<Number>(load<Signed>(from, order));
  return static_cast<Number>(load<Unsigned>(from, order));
}

}  // namespace

template <typename Number>
Number VtkType::load_from(const char* from, std::endian order) const {
  if (kind == Kind::kFloat)
    return bytes == 8 ? static_cast<Number>(load<double>(from, order))
                      : static_cast<Number>(load<float>(from, order));
  const bool is_signed = kind == Kind::kSigned;
  switch (bytes) {
    case 1:
      return load_whole<Number, std::int8_t, std::uint8_t>(from, order, is_signed);
    case 2:
      return load_whole<Number, std::int16_t, std::uint16_t>(from, order, is_signed);
    case 4:
      return load_whole<Number, std::int32_t, std::uint32_t>(from, order, is_signed);
    default:
      return load_whole<Number, std::int64_t, std::uint64_t>(from, order, is_signed);
  }
}

template double VtkType::load_from<double>(const char*, std::endian) const;
template std::int64_t VtkType::load_from<std::int64_t>(const char*, std::endian) const;

std::int64_t VtkCells::first_bad_cell() const {
  std::int64_t begin = 0;
  for (std::int64_t i = 0; i < count(); ++i) {
    if (ends[i] < begin || ends[i] > std::ssize(corners)) return i;
    begin = ends[i];
  }
  return -1;
}

void add_vtk_polygon(ScanBuilder& builder, std::span<const std::int64_t> corners,
                     std::int64_t face) {
  const Place place{Place::Unit::kFace, face};
  builder.check_corner_count(std::ssize(corners), place);
  builder.add_face(corners, place);
}

void add_vtk_strip(ScanBuilder& builder, std::span<const std::int64_t> corners, std::int64_t face) {
  if (corners.size() < 3) return add_vtk_part(builder, corners, face);
  TriangleStrip strip;
  for (const std::int64_t corner : corners)
    if (const auto triangle = strip.next(corner))
      builder.add_face(*triangle, {Place::Unit::kFace, face});
}

void add_vtk_part(ScanBuilder& builder, std::span<const std::int64_t> corners, std::int64_t face) {
  builder.add_face(corners.first(std::min<std::size_t>(corners.size(), 2)),
                   {Place::Unit::kFace, face});
}

}  // namespace semigeo::io
