#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace semigeo::io {

/// Element types of stored arrays, all little endian. A record is an element as well: a row of
/// named members, one after the other without gaps (a compound of HDF5).
enum class ElementType { float32, float64, int32, int64, uint8, feature, contour };

/// A member of a record: one number, or a short array of `columns` of them.
struct RecordMember {
  const char* name;
  ElementType type;
  int columns = 1;
};

/// ElementType::feature, a row of a level's features; kernels::Feature says what most members mean.
inline constexpr std::array<RecordMember, 10> kFeatureMembers = {{
    {"vertex", ElementType::int64},
    {"value", ElementType::float32},
    {"prominence", ElementType::float32},
    {"position", ElementType::float32, 3},
    {"initial_position", ElementType::float32, 3},
    {"normal", ElementType::float32, 3},
    {"scale_free_gaussian", ElementType::float32},
    {"scale_free_mean", ElementType::float32},
    {"kind", ElementType::int32},
    {"contour_point", ElementType::int64},
}};

/// ElementType::contour, a row of a level's contours.
inline constexpr std::array<RecordMember, 4> kContourMembers = {{
    {"first", ElementType::int64},
    {"count", ElementType::int64},
    {"kind", ElementType::int32},
    {"closed", ElementType::int32},
}};

/// Of a record; none of a number.
constexpr std::span<const RecordMember> members_of(ElementType type) {
  if (type == ElementType::feature) return kFeatureMembers;
  if (type == ElementType::contour) return kContourMembers;
  return {};
}

constexpr std::int64_t size_of(ElementType type) {
  switch (type) {
    case ElementType::float32:
    case ElementType::int32:
      return 4;
    case ElementType::float64:
    case ElementType::int64:
      return 8;
    case ElementType::uint8:
      return 1;
    case ElementType::feature:
    case ElementType::contour:
      break;
  }
  std::int64_t size = 0;
  for (const RecordMember& member : members_of(type)) size += member.columns * size_of(member.type);
  return size;
}
static_assert(size_of(ElementType::feature) == 72 && size_of(ElementType::contour) == 24);

/// As messages and the content digest have it; of a record with its members.
constexpr std::string_view name_of(ElementType type) {
  switch (type) {
    case ElementType::float32:
      return "float32";
    case ElementType::float64:
      return "float64";
    case ElementType::int32:
      return "int32";
    case ElementType::int64:
      return "int64";
    case ElementType::uint8:
      return "uint8";
    case ElementType::feature:
      return "{vertex:int64,value:float32,prominence:float32,position:float32[3],"
             "initial_position:float32[3],normal:float32[3],scale_free_gaussian:float32,"
             "scale_free_mean:float32,kind:int32,contour_point:int64}";
    case ElementType::contour:
      return "{first:int64,count:int64,kind:int32,closed:int32}";
  }
  return "?";
}

}  // namespace semigeo::io
