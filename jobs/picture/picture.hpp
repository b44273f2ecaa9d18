#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "io/dataset/dataset.hpp"
#include "io/files/image.hpp"
#include "jobs/picture/camera.hpp"
#include "jobs/picture/colour_scale.hpp"
#include "kernels/features/features.hpp"

namespace semigeo::jobs {

/// The fields by which a surface is coloured.
enum class PictureField { kMean, kGaussian, kNone };
/// The names of the fields, by PictureField.
inline constexpr std::array<std::string_view, 3> kPictureFieldNames = {"mean", "gaussian", "none"};

/// What a picture of a dataset shows.
struct PictureOptions {
  std::vector<int> levels;  ///< One panel for each; at least one.
  PictureField field = PictureField::kMean;
  View view = View::kIso;
  UpAxis up = UpAxis::kY;
  ColourScale scale = ColourScale::kSafe;
  std::optional<double> limit;  ///< The end of the colour scale; without it, a robust limit.
  int size = 1200;              ///< Height of the picture, in pixels.
  std::array<bool, kernels::kFeatureKinds> features = {};  ///< Kinds that are marked.
  std::array<bool, kernels::kContourKinds> contours = {};  ///< Kinds that are drawn.
};

/// A picture, and what its colours mean.
struct DatasetPicture {
  io::Image image;
  float limit = 0;  ///< The value at the end of the colour scale; 0 without a field.
};

/// Draws levels of a dataset beside each other from the same place, at the same scale and in the
/// same colours, with their numbers and sigmas below them and a legend of the colours at the right.
/// Throws io::Error if the dataset cannot be read or has no such level.
DatasetPicture picture_of(const io::Dataset& dataset, const PictureOptions& options);

}  // namespace semigeo::jobs
