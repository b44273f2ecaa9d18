#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/content_digest.hpp"
#include "kernels/features.hpp"

namespace semigeo::io {

// Features and contours of a level in its groups `features` and `contours`; io/DATASET.md is their
// description.

using kernels::kContourKinds;
using kernels::torsion_of;

/// Contours of one kind: C of them, with M points together.
struct EncodedContours {
  EncodedArray points;   ///< float32 (M, 3), relative to the header's origin
  EncodedArray torsion;  ///< float32 (M), length^-1
  EncodedArray offsets;  ///< int64 (C + 1): first point of each, and M
  EncodedArray closed;   ///< uint8 (C): 1 = the last point joins the first
  EncodedArray maxima;   ///< int64, one for each torsion feature: the point that it is
  double length = 0;     ///< of all together
};

/// What a level has of kernels::LevelFeatures.
struct EncodedFeatures {
  std::array<EncodedArray, kernels::kFeatureKinds> of_kind;  ///< ElementType::feature, one each
  std::array<EncodedContours, kContourKinds> contours;
};

/// (M) records.
ArrayView array_of(std::span<const kernels::Feature> features);

/// Calls add(view, target) for every array, so that the caller may encode them as he likes.
/// Both arguments must live as long as the views are used.
template <typename Add>
void for_each_array(const kernels::LevelFeatures& features, EncodedFeatures& encoded, Add&& add) {
  for (std::size_t kind = 0; kind < features.of_kind.size(); ++kind)
    add(array_of(std::span(features.of_kind[kind])), encoded.of_kind[kind]);
  for (std::size_t kind = 0; kind < features.contours.size(); ++kind) {
    const kernels::SampledContours& contours = features.contours[kind];
    EncodedContours& target = encoded.contours[kind];
    add(array_of(std::span(contours.points)), target.points);
    add(array_of(std::span(contours.torsion)), target.torsion);
    add(array_of(std::span(contours.offsets)), target.offsets);
    add(array_of(std::span(contours.closed)), target.closed);
    add(array_of(std::span(contours.maxima)), target.maxima);
    target.length = contours.length;
  }
}

/// Every array, one after the other.
EncodedFeatures encode_features(const kernels::LevelFeatures& features, Compression compression);

/// How many there are, as attributes and shapes tell.
struct FeatureCounts {
  std::array<std::int64_t, kernels::kFeatureKinds> of_kind = {};
  std::array<std::int64_t, kContourKinds> contours = {};
  std::array<double, kContourKinds> contour_length = {};

  std::int64_t total() const;
};

FeatureCounts counts_of(const EncodedFeatures& features);

/// Writes both groups of `level`, a path. std::invalid_argument when arrays do not fit each other.
void write_features(DigestedFile& file, const std::string& level, const EncodedFeatures& features);

/// Reads attributes and shapes; Error if an array is missing or does not fit the others.
FeatureCounts check_features(const Hdf5File& file, const std::string& level);

/// One table of a level that has so many vertices and passed check_features. Error if a feature is
/// at a vertex that the level does not have.
std::vector<kernels::Feature> read_features(const Hdf5File& file, const std::string& level,
                                            kernels::FeatureKind kind, std::int64_t vertices);

/// The contours K = 0 (gaussian) or H = 0 (mean) of a level that passed check_features. Error if
/// contours are not one after the other, from the first point to the last, or a maximum is at a
/// point that does not exist; std::invalid_argument for the other kinds.
kernels::SampledContours read_contours(const Hdf5File& file, const std::string& level,
                                       kernels::FeatureKind kind);

}  // namespace semigeo::io
