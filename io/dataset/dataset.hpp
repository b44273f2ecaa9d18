#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/dataset/dataset_format.hpp"
#include "io/dataset/feature_tables.hpp"
#include "io/dataset/selection.hpp"
#include "io/hdf5/for_each.hpp"
#include "io/hdf5/hdf5.hpp"

namespace semigeo::io {

struct DatasetHeader;  // io/dataset/dataset_header.hpp

/// Attributes and sizes of a level.
struct LevelInfo : LevelAttributes {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  FeatureCounts features;
};

/// Reads a dataset (docs/formats/dataset.md). Every failure is an Error that names the file and the
/// object. Sizes are checked against what the file holds before anything is allocated. Only one
/// thread may use it at a time.
class Dataset {
 public:
  /// Opens a dataset for reading only. Throws Error on other formats, other versions, and
  /// unfinished files.
  explicit Dataset(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.path(); }
  const DatasetHeader& header() const { return *header_; }
  const std::string& creator_version() const { return creator_version_; }
  /// Returns the content digest as stored: 32 hexadecimal digits.
  const std::string& digest() const { return digest_; }

  int level_count() const { return level_count_; }
  /// Returns whether its levels have principal curvatures and directions.
  bool has_principal() const { return principal_; }
  /// Returns whether its levels have marks of filled vertices and faces.
  bool has_filled() const { return filled_; }
  /// Reads attributes and sizes of a level. Throws Error if an array is missing or does not fit the
  /// others.
  LevelInfo level(int level) const;
  /// Reads the sigma of a level alone, in length units.
  double scale(int level) const;

  /// Reads an array of a level, row after row: points and normals have 3 N floats, the others N.
  /// Throws Error if it does not have a row for each vertex, or for each triangle.
  std::vector<float> read_floats(int level, std::string_view name) const;
  /// Reads triangles (3 F), source_vertex (N), part (N), vertex_filled (N) or face_filled (F).
  std::vector<std::int64_t> read_integers(int level, std::string_view name) const;

  /// Reads the features of a level by kind. Throws Error also if a feature is at a vertex that the
  /// level does not have.
  kernels::FeaturesByKind read_features(int level) const;
  /// Reads the contours K = 0 (gaussian) or H = 0 (mean). Throws Error also if they are not one
  /// after the other, or a maximum is at a point that does not exist.
  kernels::SampledContours read_contours(int level, kernels::FeatureKind kind) const;
  /// Reads the level at which the scan is recognised.
  Selection selection() const;

  /// Reads everything: every chunk against its checksum, all of it against the digest, every level
  /// for completeness, /selection against the levels, /VTKHDF for conformance. Throws Error on the
  /// first fault. Chunks are decoded by `for_each`, a few MiB at a time.
  void verify(const ForEach& for_each = {}) const;

 private:
  DatasetHeader read_header() const;
  std::string text(const char* name) const;
  /// Returns the path of a level that exists.
  std::string existing(int level) const;
  void check_rows(const std::string& level, const LevelArray& array) const;

  Hdf5File file_;
  std::shared_ptr<const DatasetHeader> header_;
  std::string creator_version_;
  std::string digest_;
  int level_count_ = 0;
  bool principal_ = false;
  bool filled_ = false;
};

/// Holds what the root of a dataset says about its origin.
struct DatasetOrigin {
  std::string job_key;          ///< Hash of all that the dataset depends on.
  std::string input_xxh3;       ///< XXH3_128 of the scan that it was made of.
  std::string parameters_json;  ///< Parameters that it was made with, as the text of the file.
  std::string creator_version;  ///< Version of the program that made it.
};

/// Reads the origin of a dataset. Only a few kB are read, so that all files of an archive can be
/// looked at. Throws Error if the file is absent, unreadable, of another format or version, or
/// incomplete.
DatasetOrigin read_origin(const std::filesystem::path& path);

}  // namespace semigeo::io
