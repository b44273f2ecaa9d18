#pragma once

#include <cstddef>
#include <cstdint>

#include "io/hdf5/complete_file.hpp"
#include "kernels/recognition/recognition_model.hpp"

namespace semigeo::io {

// What the writer and the reader of a library agree on; docs/formats/library.md is its description.

inline constexpr FileFormat kLibraryFormat = {.name = "semigeo-library",
                                              .version = 1,
                                              .noun = "library",
                                              .remedy = "give a library.h5 that semigeo made"};

inline constexpr std::int64_t kBlockPostings = 65536;
inline constexpr std::int64_t kMostModels = std::int64_t{1} << 24;

/// Describes an array of /models, beside the texts. `chunk_rows` keeps small what reading one model
/// reads.
struct ModelArray {
  const char* path;
  ElementType type;
  int columns;
  std::int64_t chunk_rows;
};
/// These hold rows of a model, one model after the other; /models/<...>_offsets say where each
/// begins.
inline constexpr ModelArray kFeatureArray = {"/models/features", ElementType::kOrientedFeature, 1,
                                             2048};
inline constexpr ModelArray kLevelScaleArray = {"/models/level_scales", ElementType::kFloat32, 1,
                                                65536};
inline constexpr ModelArray kSamplePointArray = {"/models/sample_points", ElementType::kFloat32, 3,
                                                 4096};
inline constexpr ModelArray kSampleNormalArray = {"/models/sample_normals", ElementType::kUint16, 2,
                                                  4096};

/// These hold texts of all models, each ended by NUL.
inline constexpr const char* kModelNames = "/models/names";
inline constexpr const char* kModelDigests = "/models/digests";
inline constexpr const char* kModelUnits = "/models/length_units";

/// A record of /postings is what the struct is in memory, without the padding at its end.
inline constexpr std::size_t kPostingBytes = size_of(ElementType::kPosting);
static_assert(offsetof(kernels::Posting, model) == 16 &&
              offsetof(kernels::Posting, corners) + 6 == kPostingBytes);

}  // namespace semigeo::io
