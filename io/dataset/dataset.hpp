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
#include "io/hdf5/hdf5.hpp"

namespace semigeo::io {

struct DatasetHeader;  // io/dataset/dataset_header.hpp

struct LevelInfo : LevelAttributes {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  FeatureCounts features;
};

/// Reads a dataset (docs/formats/dataset.md). Every failure is an Error that names the file and the
/// object. Sizes are checked against what the file holds before anything is allocated. One thread
/// at a time.
class Dataset {
 public:
  /// Opens read-only; refuses other formats, versions of the future, and unfinished files.
  explicit Dataset(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.path(); }
  const DatasetHeader& header() const { return *header_; }
  const std::string& creator_version() const { return creator_version_; }
  /// The content digest as stored: 32 hexadecimal digits.
  const std::string& digest() const { return digest_; }

  int level_count() const { return level_count_; }
  /// Whether its levels have principal curvatures and directions.
  bool has_principal() const { return principal_; }
  /// Whether they have marks of filled vertices and faces.
  bool has_filled() const { return filled_; }
  /// Attributes and sizes; Error if an array is missing or does not fit the others.
  LevelInfo level(int level) const;
  /// The sigma of a level alone, in length units.
  double scale(int level) const;

  /// An array of a level, row after row: points and normals 3 N floats, the others N. Error if it
  /// has not a row for each vertex, or for each triangle.
  std::vector<float> read_floats(int level, std::string_view name) const;
  /// triangles (3 F), source_vertex (N), part (N), vertex_filled (N), face_filled (F).
  std::vector<std::int64_t> read_integers(int level, std::string_view name) const;

  /// By kind. Error also if a feature is at a vertex that the level does not have.
  kernels::FeaturesByKind read_features(int level) const;
  /// Contours K = 0 (gaussian) or H = 0 (mean). Error also if they are not one after the other,
  /// or a maximum is at a point that does not exist.
  kernels::SampledContours read_contours(int level, kernels::FeatureKind kind) const;
  Selection selection() const;

  /// Reads everything: every chunk against its checksum, all of it against the digest, every level
  /// for completeness, /selection against the levels, /VTKHDF for conformance. Memory: one chunk.
  void verify() const;

 private:
  DatasetHeader read_header() const;
  std::string text(const char* name) const;
  /// The path of a level that exists.
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

/// What the root of a dataset says of where it comes from.
struct DatasetOrigin {
  std::string job_key;
  std::string input_xxh3;       ///< XXH3_128 of the scan it was made of
  std::string parameters_json;  ///< that it was made with
  std::string creator_version;  ///< of the program that made it
};

/// Reads a few kB: what a scan of the whole archive can afford for every file. Error if the file is
/// absent, unreadable, of another format or version, or incomplete.
DatasetOrigin read_origin(const std::filesystem::path& path);

}  // namespace semigeo::io
