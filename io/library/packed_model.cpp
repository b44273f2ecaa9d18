#include "io/library/packed_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include "io/files/element_type.hpp"
#include "io/library/packed_normal.hpp"
#include "io/library/packed_rows.hpp"

namespace semigeo::io {
namespace {

using kernels::OrientedFeature;

// A record is the struct as it is in memory, without the padding at its end.
static_assert(kOrientedFeatureBytes == size_of(ElementType::kOrientedFeature) &&
              offsetof(OrientedFeature, code) == 36 &&
              offsetof(OrientedFeature, level) + 1 == kOrientedFeatureBytes);
static_assert(sizeof(Eigen::Vector3f) == kSamplePointBytes &&
              sizeof(PackedNormal) == kSampleNormalBytes);

constexpr const char* kNotFinite = "has numbers that are not finite";

bool is_finite(const OrientedFeature& f) {
  return f.position.allFinite() && f.normal.allFinite() && std::isfinite(f.scale_free_gaussian) &&
         std::isfinite(f.scale_free_mean) && std::isfinite(f.value);
}

}  // namespace

std::int64_t PackedModel::feature_count() const {
  return static_cast<std::int64_t>(features.size() / kOrientedFeatureBytes);
}

std::int64_t PackedModel::sample_count() const {
  return static_cast<std::int64_t>(sample_points.size() / kSamplePointBytes);
}

PackedModel pack_model(const kernels::RecognitionModel& model) {
  if (model.samples.points.size() != model.samples.normals.size())
    throw std::invalid_argument(model.name + " has not a normal for each sample");
  std::vector<PackedNormal> normals;
  normals.reserve(model.samples.normals.size());
  for (const Eigen::Vector3f& normal : model.samples.normals)
    normals.push_back(pack_normal(normal));
  return {.name = model.name,
          .digest = model.digest,
          .length_unit = model.length_unit,
          .origin = model.origin,
          .centre = model.centre,
          .diagonal = model.diagonal,
          .sample_spacing = model.samples.spacing,
          .level_scales = model.features.level_scale,
          .features = packed(std::span<const OrientedFeature>(model.features.features),
                             kOrientedFeatureBytes),
          .sample_points = packed(std::span<const Eigen::Vector3f>(model.samples.points)),
          .sample_normals = packed(std::span<const PackedNormal>(normals))};
}

kernels::RecognitionModel unpack_model(const PackedModel& model) {
  kernels::RecognitionModel result{
      .name = model.name,
      .digest = model.digest,
      .length_unit = model.length_unit,
      .origin = model.origin,
      .centre = model.centre,
      .diagonal = model.diagonal,
      .features = {.features = unpacked<OrientedFeature>(model.features, kOrientedFeatureBytes),
                   .level_scale = model.level_scales},
      .samples = {.points = unpacked<Eigen::Vector3f>(model.sample_points),
                  .normals = {},
                  .spacing = model.sample_spacing}};
  for (const PackedNormal& normal : unpacked<PackedNormal>(model.sample_normals))
    result.samples.normals.push_back(unpack_normal(normal));
  return result;
}

std::optional<std::string> problem_of_features(std::span<const std::byte> records,
                                               std::size_t levels) {
  for (const OrientedFeature& f : unpacked<OrientedFeature>(records, kOrientedFeatureBytes)) {
    if (f.code >= kernels::kFeatureCodes) return "has a feature of no kind";
    if (f.level >= levels) return "has a feature of a level that it does not have";
    if (!is_finite(f)) return kNotFinite;
  }
  return std::nullopt;
}

std::optional<std::string> problem_of_floats(std::span<const std::byte> floats) {
  // A number is not finite if all bits of its exponent are set. The loop has no branch, so it is
  // fast.
  constexpr std::uint32_t kExponent = 0x7f800000;
  std::uint32_t found = 0;
  for (std::size_t at = 0; at + sizeof(float) <= floats.size(); at += sizeof(float)) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, floats.data() + at, sizeof bits);
    found |= static_cast<std::uint32_t>((bits & kExponent) == kExponent);
  }
  if (found == 0) return std::nullopt;
  return kNotFinite;
}

std::optional<std::string> problem_of(const PackedModel& model) {
  if (model.name.empty()) return "has no name";
  for (const std::string* text : {&model.name, &model.digest, &model.length_unit})
    if (text->find('\0') != std::string::npos) return "has a text with NUL";
  if (model.features.size() > kernels::kMostFeatures * kOrientedFeatureBytes ||
      model.level_scales.size() > kMostModelLevels)
    return "has too many features or levels";
  if (model.sample_normals.size() / kSampleNormalBytes !=
      model.sample_points.size() / kSamplePointBytes)
    return "has not a normal for each sample";
  if (!std::isfinite(model.diagonal) || !std::isfinite(model.sample_spacing) ||
      !model.centre.allFinite() || !model.origin.allFinite())
    return kNotFinite;
  if (auto problem = problem_of_floats(std::as_bytes(std::span(model.level_scales))))
    return problem;
  if (auto problem = problem_of_floats(model.sample_points)) return problem;
  return problem_of_features(model.features, model.level_scales.size());
}

}  // namespace semigeo::io
