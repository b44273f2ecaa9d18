#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/recognition/recognition_model.hpp"

namespace semigeo::io {

/// A recognition model with its tables as they are stored: docs/formats/library.md.
struct PackedModel {
  std::string name;
  std::string digest;
  std::string length_unit;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();
  float diagonal = 0;
  float sample_spacing = 0;
  std::vector<float> level_scales;
  std::vector<std::byte> features;        ///< Records of ElementType::kOrientedFeature.
  std::vector<std::byte> sample_points;   ///< float32 (samples, 3).
  std::vector<std::byte> sample_normals;  ///< One PackedNormal for each sample.

  /// Returns the number of features.
  std::int64_t feature_count() const;
  /// Returns the number of samples.
  std::int64_t sample_count() const;
};

// The sizes of packed rows, in bytes.
inline constexpr std::size_t kOrientedFeatureBytes = 38;
inline constexpr std::size_t kSamplePointBytes = 12;
inline constexpr std::size_t kSampleNormalBytes = 4;
/// The largest number of levels of a model, because the level of a feature is one byte.
inline constexpr int kMostModelLevels = 256;

/// Packs the tables of a model.
PackedModel pack_model(const kernels::RecognitionModel& model);
/// Unpacks the tables of a model.
kernels::RecognitionModel unpack_model(const PackedModel& model);

/// Returns what is wrong with a model ("has a feature of no kind or level"), or nothing if it is
/// sound. Recognition can use every sound model, whatever its file held.
std::optional<std::string> problem_of(const PackedModel& model);
/// Returns what is wrong with records of features of a model with so many levels, or nothing.
std::optional<std::string> problem_of_features(std::span<const std::byte> records,
                                               std::size_t levels);
/// Returns what is wrong with packed floats, or nothing: they must be finite.
std::optional<std::string> problem_of_floats(std::span<const std::byte> floats);

}  // namespace semigeo::io
