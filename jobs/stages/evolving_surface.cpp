#include "jobs/stages/evolving_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/evolution.hpp"

namespace semigeo::jobs {
namespace {

using engine::IndexRange;

/// Vertices or faces per task: about a millisecond of work for a patch.
constexpr std::int64_t kVertexBlock = 512;
constexpr std::int64_t kFaceBlock = 8192;
/// A part that shrank more than this in one pass is no surface at this step any more; restoring it
/// in full would only magnify rounding.
constexpr double kMaxRestoration = 8;
/// Further passes for the normals of vertices with truncated patches: errors along a rim feed on
/// each other, and after two have settled.
constexpr int kRimPasses = 2;

}  // namespace

/// Sums over (some of) the faces of a part.
struct EvolvingSurface::PartMeasure {
  double edge_length = 0;
  double edges = 0;
  double area = 0;                                   ///< twice
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< twice the area times three centroids

  PartMeasure& operator+=(const PartMeasure& other) {
    edge_length += other.edge_length;
    edges += other.edges;
    area += other.area;
    moment += other.moment;
    return *this;
  }
  double mean_edge_length() const { return edges > 0 ? edge_length / edges : 0; }
};

EvolvingSurface::EvolvingSurface(kernels::Surface surface, const EvolutionOptions& options,
                                 const engine::RunContext& context)
    : context_(context), options_(options), surface_(std::move(surface)) {
  const double mean = kernels::mean_edge_length(surface_);
  if (mean > 0) unit_ = std::exp2(std::round(std::log2(mean)));
  mean_edge_length_ = mean / unit_;
  first_step_ = options_.step_factor * mean_edge_length_;
  set_step(first_step_);

  points_.resize(surface_.points.size());
  for (std::size_t v = 0; v < points_.size(); ++v) {
    const Eigen::Vector3f p = (surface_.points[v].cast<double>() / unit_).cast<float>();
    points_[v] = {p.x(), p.y(), p.z(), 0};
  }
  std::vector<Eigen::Vector3f>().swap(surface_.points);

  for (std::int32_t f = 0; f < surface_.face_count(); ++f) {
    const std::int32_t part = surface_.part[surface_.triangles[f][0]];
    const bool fresh = face_blocks_.empty() || face_blocks_.back().part != part ||
                       f - face_blocks_.back().begin == kFaceBlock;
    if (fresh) face_blocks_.push_back({part, f, f});
    face_blocks_.back().end = f + 1;
  }

  normals_.resize(points_.size());
  next_points_.resize(points_.size());
  next_normals_.resize(points_.size());
  faces_.resize(surface_.triangles.size());
  if (options_.curved) curved_.resize(surface_.triangles.size());
  for (const PartMeasure& part : measure_parts())
    part_edge_length_.push_back(part.mean_edge_length());

  angle_weighted_normals();
  prepare_faces();
  if (options_.curved) sharpen_normals();
}

kernels::SampledSurface EvolvingSurface::sampled() const {
  return {{faces_, surface_.outgoing, points_, normals_, max_crossings_}, curved_};
}

kernels::PatchLayout EvolvingSurface::layout() const {
  return {.step = static_cast<float>(step_),
          .coordinates = options_.coordinates,
          .principal = options_.principal};
}

/// Half-lines of steps beyond four edges may cross as many more faces as they are longer.
void EvolvingSurface::set_step(double step) {
  step_ = step;
  const double edges = mean_edge_length_ > 0 ? step / mean_edge_length_ : 1;
  max_crossings_ = static_cast<int>(kernels::kMaxCrossings * std::max(1.0, edges / 4));
}

void EvolvingSurface::angle_weighted_normals() {
  context_.workers.for_blocks(vertex_count(), kFaceBlock, [&](IndexRange range) {
    for (auto v = range.begin; v < range.end; ++v)
      normals_[v] = kernels::angle_weighted_normal(surface_, points_, static_cast<std::int32_t>(v));
  });
}

void EvolvingSurface::prepare_faces() {
  context_.workers.for_blocks(surface_.face_count(), kFaceBlock, [&](IndexRange range) {
    for (auto f = range.begin; f < range.end; ++f)
      kernels::measure_face(surface_, points_, static_cast<std::int32_t>(f), faces_[f]);
  });
  context_.workers.for_blocks(surface_.face_count(), kFaceBlock, [&](IndexRange range) {
    for (auto f = range.begin; f < range.end; ++f) {
      kernels::unfold_face(faces_, static_cast<std::int32_t>(f));
      if (!options_.curved) continue;
      const auto& t = surface_.triangles[f];
      for (int i = 0; i < 3; ++i) {
        const std::int32_t p = t[i];
        const std::int32_t q = t[i == 2 ? 0 : i + 1];
        curved_[f].bulge[i] = kernels::edge_bulge(points_[p].head<3>(), points_[q].head<3>(),
                                                  normals_[p], normals_[q]);
      }
    }
  });
}

/// Angle-weighted normals are first-order on uneven meshes; those of the fitted surface are far
/// better, and later levels get theirs for nothing. Only level 0 needs a pass of its own; along
/// rims, where a patch leans on fewer normals, two more.
void EvolvingSurface::sharpen_normals() {
  const std::int64_t n = vertex_count();
  std::vector<std::uint8_t> truncated(n);
  sharpen(
      n, [&](std::int64_t i) { return static_cast<std::int32_t>(i); }, truncated);
  std::vector<std::int32_t> rim;
  for (std::int64_t v = 0; v < n; ++v)
    if (truncated[v] != 0) rim.push_back(static_cast<std::int32_t>(v));
  for (int pass = 0; pass < kRimPasses && !rim.empty(); ++pass)
    sharpen(
        static_cast<std::int64_t>(rim.size()), [&](std::int64_t i) { return rim[i]; }, truncated);
}

/// Gives `count` vertices the normals of the surface that their patches fit.
template <typename VertexAt>
void EvolvingSurface::sharpen(std::int64_t count, const VertexAt& vertex_at,
                              std::vector<std::uint8_t>& truncated) {
  const kernels::SampledSurface surface = sampled();
  context_.workers.for_blocks(count, kVertexBlock, [&](IndexRange range) {
    for (auto i = range.begin; i < range.end; ++i) {
      const std::int32_t v = vertex_at(i);
      const auto e = kernels::evolve_vertex(surface, v, layout());
      next_normals_[v] = e.normal;
      truncated[v] = e.patch_completeness > 0 && e.patch_completeness < 1;
    }
  });
  context_.workers.for_blocks(count, kFaceBlock, [&](IndexRange range) {
    for (auto i = range.begin; i < range.end; ++i) {
      const std::int32_t v = vertex_at(i);
      normals_[v] = next_normals_[v];
    }
  });
  prepare_faces();
}

LevelFields EvolvingSurface::advance(bool move) {
  const std::int64_t n = vertex_count();
  LevelFields fields;
  fields.points.resize(n);
  fields.normals = normals_;
  fields.gaussian_curvature.resize(n);
  fields.mean_curvature.resize(n);
  fields.patch_completeness.resize(n);
  if (options_.principal) {
    fields.principal_curvature_1.resize(n);
    fields.principal_curvature_2.resize(n);
    fields.principal_direction_1.resize(n);
    fields.principal_direction_2.resize(n);
  }
  fields.step = step_ * unit_;
  fields.scale = std::sqrt(variance_ + step_ * step_) * unit_;
  fields.mean_edge_length = mean_edge_length_ * unit_;

  const kernels::SampledSurface surface = sampled();
  const kernels::PatchLayout patch = layout();
  const auto per_length = static_cast<float>(1 / unit_);
  context_.workers.for_blocks(n, kVertexBlock, [&](IndexRange range) {
    for (auto v = range.begin; v < range.end; ++v) {
      const kernels::EvolvedVertex e =
          kernels::evolve_vertex(surface, static_cast<std::int32_t>(v), patch);
      fields.points[v] = points_[v].head<3>() * static_cast<float>(unit_);
      fields.gaussian_curvature[v] = e.gaussian_curvature * per_length * per_length;
      fields.mean_curvature[v] = e.mean_curvature * per_length;
      fields.patch_completeness[v] = e.patch_completeness;
      if (options_.principal) {
        fields.principal_curvature_1[v] = e.principal.k1 * per_length;
        fields.principal_curvature_2[v] = e.principal.k2 * per_length;
        fields.principal_direction_1[v] = e.principal.first;
        fields.principal_direction_2[v] = e.principal.second;
      }
      next_points_[v] << e.position, 0.0f;
      next_normals_[v] = e.smoothed_normal;
    }
    context_.observer.worked(range.end - range.begin);
  });
  if (!move) return fields;

  points_.swap(next_points_);
  normals_.swap(next_normals_);
  variance_ += kernels::gaussian_filters().variance * step_ * step_;
  mean_edge_length_ = restore_size();
  if (options_.schedule == Schedule::octaves) set_step(std::max(first_step_, std::sqrt(variance_)));
  if (!options_.curved) angle_weighted_normals();
  prepare_faces();
  return fields;
}

std::vector<EvolvingSurface::PartMeasure> EvolvingSurface::measure_parts() const {
  std::vector<PartMeasure> blocks(face_blocks_.size());
  context_.workers.for_blocks(static_cast<std::int64_t>(blocks.size()), 1, [&](IndexRange range) {
    for (auto b = range.begin; b < range.end; ++b)
      for (std::int32_t f = face_blocks_[b].begin; f < face_blocks_[b].end; ++f) {
        const auto& t = surface_.triangles[f];
        std::array<Eigen::Vector3d, 3> p;
        for (int i = 0; i < 3; ++i) p[i] = points_[t[i]].head<3>().cast<double>();
        for (int i = 0; i < 3; ++i) {
          const std::int32_t h = kernels::halfedge(f, i);
          if (surface_.twin[h] > h) continue;  // counted from the other side
          blocks[b].edge_length += (p[i == 2 ? 0 : i + 1] - p[i]).norm();
          blocks[b].edges += 1;
        }
        const Eigen::Vector3d a = p[1] - p[0];
        const Eigen::Vector3d c = p[2] - p[0];
        const double area = a.cross(c).norm();
        blocks[b].area += area;
        blocks[b].moment += area * (p[0] + p[1] + p[2]);
      }
  });
  std::vector<PartMeasure> parts(surface_.part_count);
  for (std::size_t b = 0; b < blocks.size(); ++b) parts[face_blocks_[b].part] += blocks[b];
  return parts;
}

/// Rescales each part about its centroid to its mean edge length of level 0 (thesis 5.1), if
/// that is wanted. Result: the mean edge length of the whole surface.
double EvolvingSurface::restore_size() {
  struct Restoration {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double factor = 1;
  };
  std::vector<Restoration> restorations(surface_.part_count);
  PartMeasure total;
  const auto parts = measure_parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PartMeasure& part = parts[i];
    Restoration& r = restorations[i];
    const bool restorable = part.edge_length > 0 && part.area > 0;
    if (restorable && options_.rescale && options_.schedule == Schedule::uniform) {
      r.factor = std::clamp(part_edge_length_[i] / part.mean_edge_length(), 1 / kMaxRestoration,
                            kMaxRestoration);  // 5.1, scale factor
      r.centre = part.moment / (3 * part.area);
    }
    total.edge_length += part.edge_length * r.factor;
    total.edges += part.edges;
  }
  context_.workers.for_blocks(vertex_count(), kFaceBlock, [&](IndexRange range) {
    for (auto v = range.begin; v < range.end; ++v) {
      const Restoration& r = restorations[surface_.part[v]];
      const Eigen::Vector3d p = points_[v].head<3>().cast<double>();
      points_[v].head<3>() = (r.centre + r.factor * (p - r.centre)).cast<float>();
    }
  });
  return total.mean_edge_length();
}

}  // namespace semigeo::jobs
