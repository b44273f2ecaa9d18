#pragma once

#include <cstddef>
#include <cstdint>

#include "io/hdf5/complete_file.hpp"
#include "kernels/recognition/recognition_model.hpp"

namespace semigeo::io {

// The format of a library, for its writer and its reader. docs/formats/library.md describes it.

/// The words by which a library is recognised.
inline constexpr FileFormat kLibraryFormat = {.name = "semigeo-library",
                                              .version = 1,
                                              .noun = "library",
                                              .remedy = "give a library.h5 that semigeo made"};

/// The number of postings in a block.
inline constexpr std::int64_t kBlockPostings = 65536;
/// The largest number of models.
inline constexpr std::int64_t kMostModels = std::int64_t{1} << 24;

/// Describes an array of /models.
struct ModelArray {
  const char* path;
  ElementType type;
  int columns;
  std::int64_t chunk_rows;  ///< Rows of a chunk. Small chunks make it cheap to read one model.
};
// These arrays hold the rows of all models, one model after the other. /models/<...>_offsets say
// where each model begins.
inline constexpr ModelArray kFeatureArray = {"/models/features", ElementType::kOrientedFeature, 1,
                                             2048};
inline constexpr ModelArray kLevelScaleArray = {"/models/level_scales", ElementType::kFloat32, 1,
                                                65536};
inline constexpr ModelArray kSamplePointArray = {"/models/sample_points", ElementType::kFloat32, 3,
                                                 4096};
inline constexpr ModelArray kSampleNormalArray = {"/models/sample_normals", ElementType::kUint16, 2,
                                                  4096};

// These arrays hold a text of each model, ended by NUL.
inline constexpr const char* kModelNames = "/models/names";
inline constexpr const char* kModelDigests = "/models/digests";
inline constexpr const char* kModelUnits = "/models/length_units";

/// The size of a record of /postings in bytes. It is a kernels::Posting as it is in memory, without
/// the padding at its end.
inline constexpr std::size_t kPostingBytes = size_of(ElementType::kPosting);
static_assert(offsetof(kernels::Posting, model) == 16 &&
              offsetof(kernels::Posting, corners) + 6 == kPostingBytes);

}  // namespace semigeo::io
