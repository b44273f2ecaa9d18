#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "io/complete_file.hpp"
#include "kernels/recognition_model.hpp"

namespace semigeo::io {

// What the writer and the reader of a library agree on; io/LIBRARY.md is its description.

inline constexpr FileFormat kLibraryFormat = {.name = "semigeo-library",
                                              .version = 1,
                                              .noun = "library",
                                              .remedy = "give a library.h5 that semigeo made"};

inline constexpr std::int64_t kBlockPostings = 65536;
inline constexpr std::int64_t kMostModels = std::int64_t{1} << 24;
inline constexpr int kMostModelLevels = 256;  ///< a feature's level is one byte

/// An array of /models, beside the texts. `chunk_rows` keeps small what reading one model reads.
struct ModelArray {
  const char* path;
  ElementType type;
  int columns;
  std::int64_t chunk_rows;
};
/// Rows of a model, one model after the other; /models/<...>_offsets say where each begins.
inline constexpr ModelArray kFeatureArray = {"/models/features", ElementType::oriented_feature, 1,
                                             2048};
inline constexpr ModelArray kLevelScaleArray = {"/models/level_scales", ElementType::float32, 1,
                                                65536};
inline constexpr ModelArray kSamplePointArray = {"/models/sample_points", ElementType::float32, 3,
                                                 4096};
inline constexpr ModelArray kSampleNormalArray = {"/models/sample_normals", ElementType::uint16, 2,
                                                  4096};

/// Texts of all models, each ended by NUL.
inline constexpr const char* kModelNames = "/models/names";
inline constexpr const char* kModelDigests = "/models/digests";
inline constexpr const char* kModelUnits = "/models/length_units";

/// Bytes of the records, which are those of the structs in memory without the padding at the end.
inline constexpr std::size_t kPostingBytes = size_of(ElementType::posting);
inline constexpr std::size_t kOrientedFeatureBytes = size_of(ElementType::oriented_feature);
static_assert(offsetof(kernels::Posting, model) == 16 &&
              offsetof(kernels::Posting, corners) + 6 == kPostingBytes);
static_assert(offsetof(kernels::OrientedFeature, code) == 36 &&
              offsetof(kernels::OrientedFeature, level) + 1 == kOrientedFeatureBytes);

/// The values of packed rows of `stride` bytes, each the beginning of a Value.
template <typename Value>
std::vector<Value> unpacked(std::span<const std::byte> rows, std::size_t stride = sizeof(Value)) {
  std::vector<Value> values(rows.size() / stride);
  for (std::size_t i = 0; i < values.size(); ++i)
    std::memcpy(static_cast<void*>(&values[i]), rows.data() + i * stride, stride);
  return values;
}

/// The other way round, appended to `rows`.
template <typename Value>
void append_packed(std::span<const Value> values, std::size_t stride,
                   std::vector<std::byte>& rows) {
  const std::size_t before = rows.size();
  rows.resize(before + values.size() * stride);
  for (std::size_t i = 0; i < values.size(); ++i)
    std::memcpy(rows.data() + before + i * stride, &values[i], stride);
}

}  // namespace semigeo::io
