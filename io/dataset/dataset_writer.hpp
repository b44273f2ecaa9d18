#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "io/dataset/dataset_format.hpp"
#include "io/dataset/feature_tables.hpp"
#include "io/dataset/selection.hpp"
#include "io/dataset/vtkhdf.hpp"
#include "io/files/atomic_file.hpp"
#include "io/hdf5/content_digest.hpp"
#include "io/hdf5/for_each.hpp"

namespace semigeo::io {

struct DatasetHeader;  // io/dataset/dataset_header.hpp

/// Holds what levels share while their connectivity stays the same.
struct EncodedConnectivity {
  EncodedArray triangles;      ///< int64 (F, 3).
  EncodedArray source_vertex;  ///< int64 (N): the vertex of level 0, or -1.
  EncodedArray part;           ///< int32 (N): the connected part.
  /// Marks what filling holes has made with 1, all else with 0. Every level has the marks, or none.
  std::optional<EncodedArray> vertex_filled = {};  ///< uint8 (N).
  std::optional<EncodedArray> face_filled = {};    ///< uint8 (F).
};

/// Principal curvatures k1 >= k2, in length^-1, and their unit directions.
struct EncodedPrincipal {
  EncodedArray curvature_1;  ///< float32 (N)
  EncodedArray curvature_2;
  EncodedArray direction_1;  ///< float32 (N, 3)
  EncodedArray direction_2;
};

/// Holds the fields of one level.
struct EncodedFields {
  EncodedArray points;              ///< float32 (N, 3), relative to the header's origin
  EncodedArray normals;             ///< float32 (N, 3)
  EncodedArray gaussian_curvature;  ///< float32 (N), length^-2
  EncodedArray mean_curvature;      ///< float32 (N), length^-1
  EncodedArray patch_completeness;  ///< float32 (N), 1 = whole patch, 0 = invalid
  EncodedFeatures features;
  std::optional<EncodedPrincipal> principal = {};  ///< Every level has it, or none.
};

/// Writes one dataset (docs/formats/dataset.md), which appears under its final name whole and
/// verified or not at all. The same calls give the same bytes. Encode with
/// io/files/chunk_codec.hpp, on any number of threads; call the writer from one thread at a time.
///
/// Throws Error, which names the final path, when the disk refuses, and std::invalid_argument when
/// arrays do not fit each other. After either the writer can only be destroyed, which removes what
/// it wrote.
class DatasetWriter {
 public:
  DatasetWriter(const std::filesystem::path& final_path, const DatasetHeader& header,
                Compression compression);

  /// Writes the connectivity of the next level and those after it. Level 0 must bring one.
  void write_connectivity(const EncodedConnectivity& connectivity);

  /// Writes the next level, from 0 on.
  void write_level(const LevelAttributes& attributes, const EncodedFields& fields);

  /// Writes the selection, after the last level. Its counts must be those of the levels' features.
  void write_selection(const Selection& selection);

  /// Writes /VTKHDF, the content digest and `complete`, forces the file to the disk, reads all of
  /// it back and compares, writes the XDMF sidecar and gives the file its name. Returns the content
  /// digest. At least one level and the selection must have been written. What is read back is
  /// decoded by `for_each`.
  std::string finish(const ForEach& for_each = {});

 private:
  void begin_level();
  void write(const std::string& level, const LevelArray& format, const EncodedArray& array,
             std::int64_t rows);

  AtomicFile target_;
  DigestedFile file_;  // after target_, so that it is closed before its name is removed
  Compression compression_;
  std::vector<VtkhdfStep> steps_;
  std::vector<std::int64_t> feature_counts_;
  bool selected_ = false;
  bool filled_ = false;
  bool level_begun_ = false;
  bool connectivity_pending_ = false;
  std::int64_t vertices_ = 0;
  std::int64_t triangles_ = 0;
  std::string connectivity_level_;
};

}  // namespace semigeo::io
