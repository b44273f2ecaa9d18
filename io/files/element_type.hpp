#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace semigeo::io {

/// The element types of stored arrays, all little endian. A record is an element as well: it is a
/// row of named members, one after the other without gaps (a compound of HDF5).
enum class ElementType {
  kFloat32,
  kFloat64,
  kInt32,
  kInt64,
  kUint8,
  kUint16,
  kFeature,
  kContour,
  kOrientedFeature,
  kPosting
};

/// A member of a record: one number, or a short array of `columns` of them.
struct RecordMember {
  const char* name;
  ElementType type;
  int columns = 1;
};

/// The members of ElementType::kFeature, a row of a level's features. kernels::Feature says what
/// most members mean.
inline constexpr std::array<RecordMember, 10> kFeatureMembers = {{
    {"vertex", ElementType::kInt64},
    {"value", ElementType::kFloat32},
    {"prominence", ElementType::kFloat32},
    {"position", ElementType::kFloat32, 3},
    {"initial_position", ElementType::kFloat32, 3},
    {"normal", ElementType::kFloat32, 3},
    {"scale_free_gaussian", ElementType::kFloat32},
    {"scale_free_mean", ElementType::kFloat32},
    {"kind", ElementType::kInt32},
    {"contour_point", ElementType::kInt64},
}};

/// The members of ElementType::kContour, a row of a level's contours.
inline constexpr std::array<RecordMember, 4> kContourMembers = {{
    {"first", ElementType::kInt64},
    {"count", ElementType::kInt64},
    {"kind", ElementType::kInt32},
    {"closed", ElementType::kInt32},
}};

/// The members of ElementType::kOrientedFeature, a feature of a library's model:
/// kernels::OrientedFeature.
inline constexpr std::array<RecordMember, 7> kOrientedFeatureMembers = {{
    {"position", ElementType::kFloat32, 3},
    {"normal", ElementType::kFloat32, 3},
    {"scale_free_gaussian", ElementType::kFloat32},
    {"scale_free_mean", ElementType::kFloat32},
    {"value", ElementType::kFloat32},
    {"code", ElementType::kUint8},
    {"level", ElementType::kUint8},
}};

/// The members of ElementType::kPosting, a triplet of a library: kernels::Posting.
inline constexpr std::array<RecordMember, 3> kPostingMembers = {{
    {"invariants", ElementType::kUint8, 16},
    {"model", ElementType::kInt32},
    {"corners", ElementType::kUint16, 3},
}};

/// Returns the members of a record; a number has none.
constexpr std::span<const RecordMember> members_of(ElementType type) {
  switch (type) {
    case ElementType::kFeature:
      return kFeatureMembers;
    case ElementType::kContour:
      return kContourMembers;
    case ElementType::kOrientedFeature:
      return kOrientedFeatureMembers;
    case ElementType::kPosting:
      return kPostingMembers;
    default:
      return {};
  }
}

/// Returns the size of an element in bytes.
constexpr std::int64_t size_of(ElementType type) {
  switch (type) {
    case ElementType::kFloat32:
    case ElementType::kInt32:
      return 4;
    case ElementType::kFloat64:
    case ElementType::kInt64:
      return 8;
    case ElementType::kUint8:
      return 1;
    case ElementType::kUint16:
      return 2;
    default:
      break;  // a record
  }
  std::int64_t size = 0;
  for (const RecordMember& member : members_of(type)) size += member.columns * size_of(member.type);
  return size;
}
static_assert(size_of(ElementType::kFeature) == 72);
static_assert(size_of(ElementType::kContour) == 24);
static_assert(size_of(ElementType::kOrientedFeature) == 38);
static_assert(size_of(ElementType::kPosting) == 26);

/// Returns the name that messages and the content digest use; that of a record lists its members.
constexpr std::string_view name_of(ElementType type) {
  switch (type) {
    case ElementType::kFloat32:
      return "float32";
    case ElementType::kFloat64:
      return "float64";
    case ElementType::kInt32:
      return "int32";
    case ElementType::kInt64:
      return "int64";
    case ElementType::kUint8:
      return "uint8";
    case ElementType::kUint16:
      return "uint16";
    case ElementType::kFeature:
      return "{vertex:int64,value:float32,prominence:float32,position:float32[3],"
             "initial_position:float32[3],normal:float32[3],scale_free_gaussian:float32,"
             "scale_free_mean:float32,kind:int32,contour_point:int64}";
    case ElementType::kContour:
      return "{first:int64,count:int64,kind:int32,closed:int32}";
    case ElementType::kOrientedFeature:
      return "{position:float32[3],normal:float32[3],scale_free_gaussian:float32,"
             "scale_free_mean:float32,value:float32,code:uint8,level:uint8}";
    case ElementType::kPosting:
      return "{invariants:uint8[16],model:int32,corners:uint16[3]}";
  }
  return "?";
}

}  // namespace semigeo::io
