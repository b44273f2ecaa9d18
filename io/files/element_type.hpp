#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace semigeo::io {

/// Element types of stored arrays, all little endian. A record is an element as well: a row of
/// named members, one after the other without gaps (a compound of HDF5).
enum class ElementType {
  float32,
  float64,
  int32,
  int64,
  uint8,
  uint16,
  feature,
  contour,
  oriented_feature,
  posting
};

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

/// ElementType::oriented_feature, a feature of a library's model: kernels::OrientedFeature.
inline constexpr std::array<RecordMember, 7> kOrientedFeatureMembers = {{
    {"position", ElementType::float32, 3},
    {"normal", ElementType::float32, 3},
    {"scale_free_gaussian", ElementType::float32},
    {"scale_free_mean", ElementType::float32},
    {"value", ElementType::float32},
    {"code", ElementType::uint8},
    {"level", ElementType::uint8},
}};

/// ElementType::posting, a triplet of a library: kernels::Posting.
inline constexpr std::array<RecordMember, 3> kPostingMembers = {{
    {"invariants", ElementType::uint8, 16},
    {"model", ElementType::int32},
    {"corners", ElementType::uint16, 3},
}};

/// Of a record; a number has none.
constexpr std::span<const RecordMember> members_of(ElementType type) {
  switch (type) {
    case ElementType::feature:
      return kFeatureMembers;
    case ElementType::contour:
      return kContourMembers;
    case ElementType::oriented_feature:
      return kOrientedFeatureMembers;
    case ElementType::posting:
      return kPostingMembers;
    default:
      return {};
  }
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
    case ElementType::uint16:
      return 2;
    default:
      break;  // a record
  }
  std::int64_t size = 0;
  for (const RecordMember& member : members_of(type)) size += member.columns * size_of(member.type);
  return size;
}
static_assert(size_of(ElementType::feature) == 72);
static_assert(size_of(ElementType::contour) == 24);
static_assert(size_of(ElementType::oriented_feature) == 38);
static_assert(size_of(ElementType::posting) == 26);

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
    case ElementType::uint16:
      return "uint16";
    case ElementType::feature:
      return "{vertex:int64,value:float32,prominence:float32,position:float32[3],"
             "initial_position:float32[3],normal:float32[3],scale_free_gaussian:float32,"
             "scale_free_mean:float32,kind:int32,contour_point:int64}";
    case ElementType::contour:
      return "{first:int64,count:int64,kind:int32,closed:int32}";
    case ElementType::oriented_feature:
      return "{position:float32[3],normal:float32[3],scale_free_gaussian:float32,"
             "scale_free_mean:float32,value:float32,code:uint8,level:uint8}";
    case ElementType::posting:
      return "{invariants:uint8[16],model:int32,corners:uint16[3]}";
  }
  return "?";
}

}  // namespace semigeo::io
