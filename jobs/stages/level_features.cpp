#include "jobs/stages/level_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "kernels/features/extrema.hpp"
#include "kernels/features/torsion.hpp"
#include "kernels/features/zero_crossings.hpp"
#include "kernels/surface/quadratic_face.hpp"

namespace semigeo::jobs {
namespace {

using engine::IndexRange;
using kernels::ArcPoint;
using kernels::CurvatureField;
using kernels::EdgePoint;
using kernels::Feature;
using kernels::FeatureKind;
using kernels::SampledContours;

/// The largest number of pieces into which a contour is cut for each face that it crosses, in the
/// mean. On meshes without outliers it is never reached (see `kernels::edge_lengths`).
constexpr double kMostPieces = 20;
constexpr std::int64_t kVertexBlock = 4096;
constexpr std::int64_t kPeakBlock = 64;
constexpr std::int64_t kContourBlock = 16;
/// Values of |K| sigma^2 and |H| sigma on a surface that is flat up to the rounding of its points.
constexpr double kFlatGaussian = 1e-6;
constexpr double kFlatMean = 1e-5;
/// The least prominence of a peak, in |value|. Peaks below it come from the errors of K and H on
/// surfaces where they are constant, like spheres.
constexpr float kLeastProminence = 1e-3f;
/// A mesh counts as coarsened if its mean edge is longer than so many of level 0.
constexpr double kCoarsened = 1.2;
/// The distance of the samples along a contour on a coarsened mesh, in mean edge lengths. A contour
/// crosses an edge about as often, and fewer samples would smooth its torsion more than its level.
constexpr double kCoarseSpacing = 0.7;

/// Returns what `find(range, found)` appends for the blocks of [0, count), in the order of the
/// blocks.
template <typename Value, typename Find>
std::vector<Value> collect(engine::Workers& workers, std::int64_t count, std::int64_t block,
                           const Find& find) {
  std::vector<std::vector<Value>> found((count + block - 1) / block);
  workers.for_blocks(count, block,
                     [&](IndexRange range) { find(range, found[range.begin / block]); });
  std::vector<Value> all;
  for (std::vector<Value>& some : found)
    all.insert(all.end(), std::make_move_iterator(some.begin()),
               std::make_move_iterator(some.end()));
  return all;
}

/// A contour and the features on it.
struct Contour {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> torsion;
  std::vector<std::int32_t> maxima;
  std::vector<Feature> features;
  bool closed = false;
  double length = 0;
};

class Finder {
 public:
  Finder(const EvolvingSurface& surface, const LevelFields& fields, const FeatureOptions& options,
         const engine::RunContext& context)
      : surface_(surface.mesh().connectivity),
        mesh_(surface.mesh()),
        normals_(surface.smoothed_normals()),
        fields_(fields),
        workers_(context.workers),
        curved_(surface.options().curved),
        coarse_(surface.options().schedule == Schedule::kOctaves &&
                fields.mean_edge_length > kCoarsened * surface.first_edge_length()),
        contour_spacing_(coarse_ ? std::max(surface.first_edge_length(),
                                            kCoarseSpacing * fields.mean_edge_length)
                                 : fields.mean_edge_length),
        radius_(options.radius * fields.scale / surface.unit()),
        row_(fields.stored_order->size()) {
    const double scale = fields.scale;
    const std::array flat = {kFlatGaussian / (scale * scale), kFlatMean / scale};
    workers_.for_blocks(2, 1, [&](IndexRange range) {
      const auto kind = static_cast<int>(range.begin);
      heights_[kind] = kernels::heights_of(values(kind), fields.patch_completeness,
                                           static_cast<float>(options.min_completeness),
                                           static_cast<float>(flat[kind]));
    });
    const std::vector<std::int32_t>& order = *fields.stored_order;
    workers_.for_blocks(static_cast<std::int64_t>(order.size()), kVertexBlock,
                        [&](IndexRange range) {
                          for (auto i = range.begin; i < range.end; ++i)
                            row_[order[i]] = static_cast<std::int32_t>(i);
                        });
  }

  kernels::LevelFeatures find() {
    kernels::LevelFeatures result;
    std::array<std::vector<std::int32_t>, 2> ascents = steepest_ascents();
    // Parts of each search are serial, so all four run at once.
    workers_.for_blocks(4, 1, [&](IndexRange range) {
      const auto kind = static_cast<int>(range.begin % kernels::kContourKinds);
      if (range.begin < 2)
        result.of_kind[kind] = maxima(kind, std::move(ascents[kind]));
      else
        contours(field(kind), result.contours[kind], result.of_kind[kernels::torsion_of(kind)]);
    });
    return result;
  }

 private:
  const std::vector<float>& values(int kind) const {
    return kind == 0 ? fields_.gaussian_curvature : fields_.mean_curvature;
  }
  CurvatureField field(int kind) const { return {heights_[kind]}; }

  /// Returns for K and for H the steepest ascent from each vertex; see `kernels::uphill`.
  std::array<std::vector<std::int32_t>, 2> steepest_ascents() const {
    const auto n = static_cast<std::int64_t>(row_.size());
    const std::array fields = {field(0), field(1)};
    std::array<std::vector<std::int32_t>, 2> ascents;
    for (auto& ascent : ascents) ascent.resize(n);
    workers_.for_blocks(n, kVertexBlock, [&](IndexRange range) {
      for (auto v = range.begin; v < range.end; ++v) {
        const auto next = kernels::uphill(surface_, fields, static_cast<std::int32_t>(v));
        for (std::size_t kind = 0; kind < next.size(); ++kind) ascents[kind][v] = next[kind];
      }
    });
    return ascents;
  }

  std::vector<Feature> maxima(int kind, std::vector<std::int32_t> uphill) const {
    const CurvatureField field = this->field(kind);
    std::vector<std::int32_t> peaks;
    for (std::size_t v = 0; v < uphill.size(); ++v)
      if (uphill[v] == static_cast<std::int32_t>(v)) peaks.push_back(uphill[v]);
    if (peaks.empty()) return {};
    const std::vector<float> prominences =
        kernels::prominences(surface_, field, kernels::peaks_of(std::move(uphill)));
    if (radius_ > 0) peaks = highest_within_radius(field, peaks, prominences);
    std::sort(peaks.begin(), peaks.end(),
              [&](std::int32_t a, std::int32_t b) { return row_[a] < row_[b]; });
    std::vector<Feature> features;
    features.reserve(peaks.size());
    for (const std::int32_t v : peaks) {
      Feature feature = feature_at([v](const auto& values) { return values[v]; });
      const kernels::Summit summit =
          coarse_ ? kernels::fitted_summit(surface_, mesh_.points, field, values(kind), v)
                  : kernels::summit(surface_, mesh_.points, field, v);
      feature.position = summit.of(fields_.points);
      feature.initial_position = summit.of(mesh_.initial_points);
      feature.vertex = row_[v];
      feature.value = values(kind)[v];
      feature.prominence = prominences[v];
      features.push_back(feature);
    }
    return features;
  }

  /// Returns the prominent peaks that are higher than all vertices within the radius.
  std::vector<std::int32_t> highest_within_radius(const CurvatureField& field,
                                                  const std::vector<std::int32_t>& peaks,
                                                  const std::vector<float>& prominences) const {
    return collect<std::int32_t>(
        workers_, static_cast<std::int64_t>(peaks.size()), kPeakBlock,
        [&](IndexRange range, std::vector<std::int32_t>& found) {
          kernels::GeodesicBall ball;
          for (auto i = range.begin; i < range.end; ++i) {
            const std::int32_t v = peaks[i];
            if (prominences[v] >= kLeastProminence * field.magnitude(v) &&
                kernels::is_maximum(surface_, mesh_.points, field, v, radius_, ball))
              found.push_back(v);
          }
        });
  }

  /// Returns the fields that features of all kinds have. `at(values)` interpolates the values of
  /// all vertices at the feature.
  template <typename At>
  Feature feature_at(const At& at) const {
    Feature feature;
    feature.position = at(fields_.points);
    feature.initial_position = at(mesh_.initial_points);
    feature.normal = Eigen::Vector3f(at(normals_)).stableNormalized();
    const float gaussian = at(fields_.gaussian_curvature);
    const auto scale = static_cast<float>(fields_.scale);
    feature.scale_free_gaussian = std::copysign(std::sqrt(std::abs(gaussian)) * scale, gaussian);
    feature.scale_free_mean = at(fields_.mean_curvature) * scale;
    return feature;
  }

  void contours(const CurvatureField& field, SampledContours& sampled,
                std::vector<Feature>& features) const {
    const std::vector<std::int32_t> faces = collect<std::int32_t>(
        workers_, surface_.face_count(), kVertexBlock,
        [&](IndexRange range, std::vector<std::int32_t>& found) {
          kernels::find_crossing_faces(surface_, field, static_cast<std::int32_t>(range.begin),
                                       static_cast<std::int32_t>(range.end), found);
        });
    const kernels::Contours traced = kernels::trace_contours(surface_, field, faces);
    const std::vector<Contour> contours = collect<Contour>(
        workers_, traced.count(), kContourBlock,
        [&](IndexRange range, std::vector<Contour>& found) {
          for (auto c = range.begin; c < range.end; ++c)
            found.push_back(
                contour(std::span(traced.points)
                            .subspan(traced.offsets[c], traced.offsets[c + 1] - traced.offsets[c]),
                        traced.closed[c] != 0));
        });
    sampled.offsets.push_back(0);
    for (const Contour& contour : contours) {
      for (const std::int32_t sample : contour.maxima)
        sampled.maxima.push_back(sampled.offsets.back() + sample);
      sampled.points.insert(sampled.points.end(), contour.points.begin(), contour.points.end());
      sampled.torsion.insert(sampled.torsion.end(), contour.torsion.begin(), contour.torsion.end());
      sampled.offsets.push_back(static_cast<std::int64_t>(sampled.points.size()));
      sampled.closed.push_back(contour.closed ? 1 : 0);
      sampled.length += contour.length;
      features.insert(features.end(), contour.features.begin(), contour.features.end());
    }
  }

  /// Returns the point on the curved edge. Torsion needs it: chords of a bent surface have corners,
  /// whose third derivative is much larger than that of the contour.
  Eigen::Vector3d point_at(const EdgePoint& e) const {
    const Eigen::Vector3f& p = fields_.points[e.positive];
    const Eigen::Vector3f& q = fields_.points[e.negative];
    Eigen::Vector3d point =
        e.between(Eigen::Vector3d(p.cast<double>()), Eigen::Vector3d(q.cast<double>()));
    if (!curved_) return point;
    const Eigen::Vector3f bulge =
        kernels::edge_bulge(p, q, fields_.normals[e.positive], fields_.normals[e.negative]);
    return point + e.t * (1 - e.t) * bulge.cast<double>();
  }

  Contour contour(std::span<const EdgePoint> crossings, bool closed) const {
    const auto crossing = [&](const EdgePoint& e, const auto& values) {
      return e.between(values[e.positive], values[e.negative]);
    };
    std::vector<Eigen::Vector3d> polyline;
    polyline.reserve(crossings.size());
    for (const EdgePoint& e : crossings) polyline.push_back(point_at(e));
    const double length = kernels::length_of(polyline, closed);
    // A contour that crosses the faces of a vertex far out would have no end of samples.
    const double spacing =
        std::max(contour_spacing_, length / (kMostPieces * static_cast<double>(polyline.size())));
    const kernels::ArcSamples samples = kernels::resample(polyline, closed, spacing);
    const auto next = [&](const ArcPoint& p) {
      return p.segment + 1 < static_cast<std::int32_t>(polyline.size()) ? p.segment + 1 : 0;
    };
    std::vector<Eigen::Vector3d> points;
    points.reserve(samples.at.size());
    for (const ArcPoint& p : samples.at)
      points.push_back(polyline[p.segment] +
                       p.fraction * (polyline[next(p)] - polyline[p.segment]));

    Contour result;
    result.closed = closed;
    result.length = length;
    result.points.reserve(points.size());
    for (const Eigen::Vector3d& p : points) result.points.push_back(p.cast<float>());
    result.torsion = kernels::torsion(points, closed);
    result.maxima = kernels::torsion_maxima(result.torsion, closed);
    const std::vector<float> prominences = kernels::torsion_prominences(result.torsion, closed);
    for (const std::int32_t sample : result.maxima) {
      const ArcPoint& p = samples.at[sample];
      const EdgePoint& from = crossings[p.segment];
      const EdgePoint& to = crossings[next(p)];
      Feature feature = feature_at([&](const auto& values) {
        const auto a = crossing(from, values);
        const auto b = crossing(to, values);
        return std::decay_t<decltype(values[0])>(a + p.fraction * (b - a));
      });
      const EdgePoint& nearer = p.fraction < 0.5f ? from : to;
      feature.vertex = row_[nearer.t < 0.5f ? nearer.positive : nearer.negative];
      feature.position = result.points[sample];
      feature.value = result.torsion[sample];
      feature.prominence = prominences[sample];
      result.features.push_back(feature);
    }
    return result;
  }

  const kernels::Connectivity& surface_;
  const kernels::LevelMesh& mesh_;
  const std::vector<Eigen::Vector3f>& normals_;
  const LevelFields& fields_;
  engine::Workers& workers_;
  bool curved_;
  bool coarse_;                                ///< The mesh was coarsened.
  double contour_spacing_;                     ///< Distance of the samples along contours.
  double radius_;                              ///< In internal units.
  std::vector<std::int32_t> row_;              ///< Row of each vertex.
  std::array<std::vector<float>, 2> heights_;  ///< Of K and of H; see `kernels::heights_of`.
};

}  // namespace

kernels::LevelFeatures find_features(const EvolvingSurface& surface, const LevelFields& fields,
                                     const FeatureOptions& options,
                                     const engine::RunContext& context) {
  return Finder(surface, fields, options, context).find();
}

}  // namespace semigeo::jobs
