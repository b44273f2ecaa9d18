#include "jobs/stages/recognition_features.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/dataset/dataset_header.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "jobs/stages/level_features.hpp"
#include "jobs/stages/surface_parameters.hpp"
#include "kernels/recognition/surface_samples.hpp"
#include "kernels/surface/bounding_box.hpp"
#include "kernels/surface/vertex_order.hpp"

namespace semigeo::jobs {
namespace {

using Eigen::Vector3f;
using kernels::Feature;
using kernels::FeatureKind;
using kernels::OrientedFeature;

/// Weaker features depend on noise and triangulation.
constexpr float kMinScaleFree = 0.1F;  // |H| sigma, and sqrt(|K|) sigma

constexpr EvolutionOptions kOctaves = {.schedule = Schedule::kOctaves, .rescale = Rescale::kNone};

OrientedFeature oriented(const Feature& feature, FeatureKind kind, int level, float sigma) {
  OrientedFeature result;
  result.position = feature.initial_position;
  result.normal = feature.normal;
  result.scale_free_gaussian = feature.scale_free_gaussian;
  result.scale_free_mean = feature.scale_free_mean;
  result.value = feature.value * sigma * (kind == FeatureKind::kGaussian ? sigma : 1);
  result.code = kernels::feature_code(kind, feature.value > 0);
  result.level = static_cast<std::uint8_t>(level);
  return result;
}

float strength(const OrientedFeature& feature, FeatureKind kind) {
  switch (kind) {
    case FeatureKind::kGaussian:
      return std::abs(feature.scale_free_gaussian);
    case FeatureKind::kMean:
      return std::abs(feature.scale_free_mean);
    case FeatureKind::kGaussianTorsion:
    case FeatureKind::kMeanTorsion:
      break;
  }
  return std::abs(feature.value);
}

/// Adds the strongest features of one kind, in their order.
void add_strongest(const std::vector<Feature>& features, FeatureKind kind, int level, double scale,
                   const RecognitionParameters& parameters, kernels::OrientedFeatures& result) {
  std::vector<OrientedFeature> strong;
  for (const Feature& feature : features) {
    const OrientedFeature one = oriented(feature, kind, level, static_cast<float>(scale));
    const bool whole = one.normal.squaredNorm() > 0.5F && one.position.allFinite();
    if (whole && strength(one, kind) >= kMinScaleFree) strong.push_back(one);
  }
  if (strong.size() > static_cast<std::size_t>(parameters.most_features)) {
    std::vector<float> strengths;
    strengths.reserve(strong.size());
    for (const OrientedFeature& one : strong) strengths.push_back(strength(one, kind));
    const auto last = strengths.begin() + parameters.most_features;
    std::ranges::nth_element(strengths, last, std::ranges::greater());
    std::erase_if(strong, [&](const OrientedFeature& one) { return strength(one, kind) < *last; });
    strong.resize(std::min<std::size_t>(strong.size(), parameters.most_features));
  }
  result.features.insert(result.features.end(), strong.begin(), strong.end());
}

void add_level(int level, double scale, const RecognitionParameters& parameters,
               const kernels::FeaturesByKind& of_kind, kernels::OrientedFeatures& result) {
  result.level_scale.push_back(static_cast<float>(scale));
  const int kinds = parameters.torsion ? kernels::kFeatureKinds : kernels::kContourKinds;
  for (int kind = 0; kind < kinds; ++kind)
    add_strongest(of_kind[kind], FeatureKind(kind), level, scale, parameters, result);
}

void measure(const std::vector<Vector3f>& points, kernels::RecognitionModel& model) {
  if (points.empty()) return;
  const Eigen::AlignedBox3f box = kernels::bounding_box(points);
  model.centre = box.center();
  model.diagonal = box.sizes().norm();
}

using Triangles = std::vector<std::array<std::int32_t, 3>>;

/// Returns the number of samples, which is smaller for small scans.
std::int64_t samples_of(const Triangles& triangles, const RecognitionParameters& parameters) {
  return std::min<std::int64_t>(parameters.samples,
                                4 * static_cast<std::int64_t>(triangles.size()));
}

/// Returns the number of octave levels if the first one has this sigma.
int levels_of(double first_scale, float diagonal, const RecognitionParameters& parameters) {
  constexpr int kMostLevels = 10;
  int levels = parameters.levels;
  // Two levels double sigma.
  while (levels < kMostLevels &&
         first_scale * std::exp2(0.5 * (levels - 1)) < parameters.least_reach * diagonal)
    ++levels;
  return levels;
}

/// Finds the features on octave levels, and samples level 0.
void evolve(const kernels::Surface& surface, const RecognitionParameters& parameters,
            const engine::RunContext& context, kernels::RecognitionModel& model) {
  EvolvingSurface evolving(kernels::reordered(surface, kernels::locality_order(surface)), kOctaves,
                           context);
  int levels = 1;
  for (int level = 0; level < levels && !evolving.vanished(); ++level) {
    const LevelFields fields = evolving.evaluate();
    if (level == 0) {
      const kernels::Connectivity& first = evolving.mesh().connectivity;
      measure(fields.points, model);
      levels = levels_of(fields.scale, model.diagonal, parameters);
      model.samples = kernels::sample_surface(fields.points, first.triangles, fields.normals,
                                              samples_of(first.triangles, parameters));
      if (parameters.rim) kernels::mark_rim(fields.points, first.triangles, model.samples);
    }
    add_level(level, fields.scale, parameters, find_features(evolving, fields, {}, context).of_kind,
              model.features);
    if (level + 1 < levels) evolving.move();
  }
}

/// Returns whether the dataset has the features that evolving its surface again would give.
bool has_octaves(const io::Dataset& dataset) {
  try {
    const SurfaceParameters made = surface_parameters_from_json(dataset.header().parameters);
    SurfaceParameters wanted = made;
    wanted.evolution = kOctaves;
    wanted.evolution.rescale = made.evolution.rescale;  // octaves are never rescaled
    wanted.evolution.principal = made.evolution.principal;
    wanted.features = {};
    return to_json(made) == to_json(wanted);
  } catch (const std::runtime_error&) {
    return false;
  }
}

std::vector<Vector3f> vectors_of(const std::vector<float>& values) {
  std::vector<Vector3f> vectors(values.size() / 3);
  for (std::size_t i = 0; i < vectors.size(); ++i)
    vectors[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return vectors;
}

Triangles triangles_of(const std::vector<std::int64_t>& corners) {
  Triangles triangles(corners.size() / 3);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      triangles[i][corner] = static_cast<std::int32_t>(corners[3 * i + corner]);
  return triangles;
}

}  // namespace

kernels::RecognitionModel recognition_model(const kernels::BuiltSurface& built,
                                            const RecognitionParameters& parameters,
                                            const engine::RunContext& context) {
  kernels::RecognitionModel model;
  model.origin = built.origin;
  evolve(built.surface, parameters, context, model);
  return model;
}

kernels::RecognitionModel recognition_model(const io::Dataset& dataset,
                                            const RecognitionParameters& parameters,
                                            const engine::RunContext& context) {
  kernels::RecognitionModel model;
  model.digest = dataset.digest();
  model.length_unit = dataset.header().length_unit;
  const auto& origin = dataset.header().origin;
  model.origin = {origin[0], origin[1], origin[2]};
  const std::vector<Vector3f> points = vectors_of(dataset.read_floats(0, "points"));
  const Triangles triangles = triangles_of(dataset.read_integers(0, "triangles"));
  measure(points, model);
  const int levels = levels_of(dataset.scale(0), model.diagonal, parameters);
  if (!has_octaves(dataset) || dataset.level_count() < levels) {
    kernels::TriangleMesh mesh;
    for (const Vector3f& p : points) mesh.points.push_back(p.cast<double>());
    mesh.triangles = triangles;
    const kernels::BuiltSurface built = kernels::build_surface(std::move(mesh));
    model.origin += built.origin;
    evolve(built.surface, parameters, context, model);
    return model;
  }
  model.samples =
      kernels::sample_surface(points, triangles, vectors_of(dataset.read_floats(0, "normals")),
                              samples_of(triangles, parameters));
  if (parameters.rim) kernels::mark_rim(points, triangles, model.samples);
  for (int level = 0; level < levels; ++level)
    add_level(level, dataset.scale(level), parameters, dataset.read_features(level),
              model.features);
  return model;
}

}  // namespace semigeo::jobs
