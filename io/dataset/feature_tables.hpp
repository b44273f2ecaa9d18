#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/hdf5/content_digest.hpp"
#include "kernels/features/features.hpp"

namespace semigeo::io {

// The tables `features`, `contours` and `contour_points` of a level. docs/formats/dataset.md
// describes them.

using kernels::kContourKinds;
using kernels::torsion_of;

/// Counts features and contours of each kind. They are attributes of the level, because the tables
/// hold all kinds.
struct FeatureCounts {
  std::array<std::int64_t, kernels::kFeatureKinds> of_kind = {};  ///< Number of features.
  std::array<std::int64_t, kContourKinds> contours = {};          ///< Number of contours.
  std::array<double, kContourKinds> contour_length = {};  ///< Length of contours, in length units.

  /// Returns the number of features of all kinds.
  std::int64_t total() const;
};

/// A row of `features`, as it is stored.
struct FeatureRow {
  std::int64_t vertex;
  float value;
  float prominence;
  std::array<float, 3> position;
  std::array<float, 3> initial_position;
  std::array<float, 3> normal;
  float scale_free_gaussian;
  float scale_free_mean;
  std::int32_t kind;           ///< A kernels::FeatureKind. Rows ascend by it.
  std::int64_t contour_point;  ///< The row of `contour_points` that a maximum of torsion is; -1 for
                               ///< other kinds.
};

/// A row of `contours`.
struct ContourRow {
  std::int64_t first;   ///< Row of `contour_points` of its first point.
  std::int64_t count;   ///< Number of its points.
  std::int32_t kind;    ///< 0: K = 0, 1: H = 0. Rows ascend by it.
  std::int32_t closed;  ///< 1 if the last point joins the first.
};

/// A point of a contour, relative to the header's origin, and its torsion, in length^-1.
using ContourPointRow = std::array<float, 4>;

/// kernels::LevelFeatures as a dataset stores them.
struct FeatureTables {
  std::vector<FeatureRow> features;
  std::vector<ContourRow> contours;
  std::vector<ContourPointRow> contour_points;
  FeatureCounts counts;
};

/// Returns the tables of what was found on a level.
FeatureTables tables_of(const kernels::LevelFeatures& features);

/// The tables of a level, ready to be written.
struct EncodedFeatures {
  EncodedArray features;        ///< ElementType::kFeature
  EncodedArray contours;        ///< ElementType::kContour
  EncodedArray contour_points;  ///< float32 (M, 4)
  FeatureCounts counts;
};

/// Returns a view of the rows of a table.
ArrayView array_of(std::span<const FeatureRow> rows);
ArrayView array_of(std::span<const ContourRow> rows);
ArrayView array_of(std::span<const ContourPointRow> rows);

/// Calls add(view, target) for every table, so that the caller may encode them in any way. Both
/// arguments must live as long as the views are used.
template <typename Add>
void for_each_array(const FeatureTables& tables, EncodedFeatures& encoded, Add&& add) {
  encoded.counts = tables.counts;
  add(array_of(tables.features), encoded.features);
  add(array_of(tables.contours), encoded.contours);
  add(array_of(tables.contour_points), encoded.contour_points);
}

/// Encodes every table, one after the other.
EncodedFeatures encode_features(const FeatureTables& tables, Compression compression);

/// Writes the tables and counts of `level`, a path. Throws std::invalid_argument if they do not fit
/// each other.
void write_features(DigestedFile& file, const std::string& level, const EncodedFeatures& features);

/// Reads attributes and shapes of the tables. Throws Error if a table is missing or does not fit
/// the counts.
FeatureCounts check_features(const Hdf5File& file, const std::string& level);

/// Reads the features of a level by kind; the level has this number of vertices. Throws Error if
/// the tables do not fit the counts, or a feature is at a vertex that the level does not have, or
/// among those of another kind.
kernels::FeaturesByKind read_features(const Hdf5File& file, const std::string& level,
                                      std::int64_t vertices);

/// Reads the contours K = 0 (gaussian) or H = 0 (mean) of a level that passed check_features.
/// Throws Error if contours are not one after the other, from the first point to the last, or a
/// maximum is at a point of another kind, and std::invalid_argument for the other kinds.
kernels::SampledContours read_contours(const Hdf5File& file, const std::string& level,
                                       kernels::FeatureKind kind);

}  // namespace semigeo::io
