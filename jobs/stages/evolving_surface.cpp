#include "jobs/stages/evolving_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/stopwatch.hpp"
#include "jobs/stages/chosen_instruction_set.hpp"
#include "jobs/stages/remesh_surface.hpp"
#include "kernels/evolution/evolution.hpp"
#include "kernels/lanes/evolve_vertices.hpp"
#include "kernels/repair/coarsening.hpp"
#include "kernels/surface/vertex_rows.hpp"

namespace semigeo::jobs {
namespace {

using engine::IndexRange;

/// Vertices or faces per task, which is about a millisecond of work for patches.
constexpr std::int64_t kVertexBlock = 512;
constexpr std::int64_t kFaceBlock = 8192;
/// The largest factor of rescaling. A part that shrank more in one pass is too small for the step;
/// restoring it in full would only magnify rounding.
constexpr double kMaxRestoration = 8;
/// The number of further passes for the normals of vertices with truncated patches. Errors along a
/// rim influence each other; two passes suffice.
constexpr int kRimPasses = 2;

/// The area of an equilateral triangle with edges of length 1.
constexpr double kUnitTriangle = 0.4330127018922193;
/// The number of faces below which no part is coarsened. A patch crosses about 180 faces. Where a
/// part has few more, patches are bent round it, and too few vertices are left to place features:
/// with 600 faces, fewer objects are recognised in scenes that are cut. So small a mesh costs
/// little.
constexpr double kLeastFaces = 4000;
/// A part is coarsened if it has at least so many times the faces that it should have.
constexpr double kWorthCoarsening = 1.25;

/// Computes the patches of `count` vertices, at most `kVertexBlock`, and calls
/// `use(v, its result)` for each. `vertex_at(i)` is vertex i.
template <typename VertexAt, typename Use>
void evolve_block(const kernels::SampledSurface& surface, const kernels::PatchLayout& layout,
                  kernels::InstructionSet set, std::int64_t count, const VertexAt& vertex_at,
                  const Use& use) {
  std::array<std::int32_t, kVertexBlock> first;
  std::array<kernels::EvolvedVertex, kVertexBlock> evolved;
  const auto n = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < n; ++i) first[i] = kernels::first_edge(surface.mesh, vertex_at(i));
  kernels::evolve_vertices(surface, {first.data(), n}, layout, set, {evolved.data(), n});
  for (std::size_t i = 0; i < n; ++i) use(vertex_at(i), evolved[i]);
}

/// Sets the mark. Any number of threads may call it; reading first keeps the cache line shared.
void note_patch(std::uint8_t& has_patch) {
  std::atomic_ref flag(has_patch);
  if (flag.load(std::memory_order_relaxed) == 0) flag.store(1, std::memory_order_relaxed);
}

/// Returns the order of the rows of a level: vertices by the vertex of level 0 that they come from,
/// then inserted vertices.
std::vector<std::int32_t> order_by_source(const std::vector<std::int32_t>& source) {
  std::int32_t rows = 0;
  for (const std::int32_t s : source) rows = std::max(rows, s + 1);
  std::vector<std::int32_t> begin(rows + 2, 0);
  const auto bucket = [rows](std::int32_t s) { return s == kernels::kNone ? rows : s; };
  for (const std::int32_t s : source) ++begin[bucket(s) + 1];
  for (std::int32_t k = 0; k <= rows; ++k) begin[k + 1] += begin[k];
  std::vector<std::int32_t> order(source.size());
  for (std::size_t v = 0; v < source.size(); ++v)
    order[begin[bucket(source[v])]++] = static_cast<std::int32_t>(v);
  return order;
}

}  // namespace

EvolvingSurface::EvolvingSurface(kernels::Surface surface, const EvolutionOptions& options,
                                 const engine::RunContext& context, Origins origins)
    : context_(context), options_(options), instruction_set_(chosen_instruction_set()) {
  const kernels::EdgeLengths lengths = kernels::edge_lengths(surface);
  if (lengths.mean > 0) unit_ = std::exp2(std::round(std::log2(lengths.mean)));
  mean_edge_length_ = first_edge_length_ = lengths.mean / unit_;
  first_edge_limit_ = lengths.limit / unit_;
  first_step_ = options_.step_factor * mean_edge_length_;
  set_step(first_step_);

  mesh_.points.resize(surface.points.size());
  for (std::size_t v = 0; v < mesh_.points.size(); ++v) {
    const Eigen::Vector3f p = (surface.points[v].cast<double>() / unit_).cast<float>();
    mesh_.points[v] = {p.x(), p.y(), p.z(), 0};
  }
  mesh_.normals.resize(mesh_.points.size());
  mesh_.source = std::move(origins.vertex);
  if (mesh_.source.empty()) {
    mesh_.source.resize(mesh_.points.size());
    std::iota(mesh_.source.begin(), mesh_.source.end(), 0);
  }
  mesh_.vertex_filled = std::move(origins.vertex_filled);
  mesh_.face_filled = std::move(origins.face_filled);
  mesh_.initial_points = std::move(surface.points);
  mesh_.part = std::move(surface.part);
  mesh_.part_count = surface.part_count;
  mesh_.connectivity = std::move(surface);
  target_faces_ = mesh_.connectivity.face_count();
  part_reference_ = measure_parts(mesh_, edge_limit(), context_);

  adopt_mesh();
  angle_weighted_normals();
  prepare_faces();
  if (options_.curved) sharpen_normals();
}

/// Resizes everything that has the size of the mesh.
void EvolvingSurface::adopt_mesh() {
  const std::size_t faces = mesh_.connectivity.triangles.size();
  next_points_.resize(mesh_.points.size());
  next_normals_.resize(mesh_.points.size());
  faces_.resize(faces);
  if (options_.curved) curved_.resize(faces + 1);  // see `SampledSurface`
  stored_order_ = std::make_shared<const std::vector<std::int32_t>>(order_by_source(mesh_.source));
}

kernels::SampledSurface EvolvingSurface::sampled() const {
  return {{faces_, mesh_.connectivity.outgoing, mesh_.points, mesh_.normals, max_crossings_},
          curved_};
}

kernels::PatchLayout EvolvingSurface::layout() const {
  return {.step = static_cast<float>(step_),
          .coordinates = options_.coordinates,
          .principal = options_.principal};
}

/// Sets the step. Half-lines of steps longer than four edges may cross more faces in proportion.
void EvolvingSurface::set_step(double step) {
  step_ = step;
  const double edges = mean_edge_length_ > 0 ? step / mean_edge_length_ : 1;
  max_crossings_ = static_cast<int>(kernels::kMaxCrossings * std::max(1.0, edges / 4));
}

/// Returns the length above which edges are outliers. Coarser meshes have longer ones.
double EvolvingSurface::edge_limit() const {
  if (!(first_edge_length_ > 0)) return first_edge_limit_;
  return first_edge_limit_ * std::max(1.0, mean_edge_length_ / first_edge_length_);
}

void EvolvingSurface::angle_weighted_normals() {
  context_.workers.for_blocks(vertex_count(), kFaceBlock, [&](IndexRange range) {
    for (auto v = range.begin; v < range.end; ++v)
      mesh_.normals[v] = kernels::angle_weighted_normal(mesh_.connectivity, mesh_.points,
                                                        static_cast<std::int32_t>(v));
  });
}

void EvolvingSurface::prepare_faces() {
  context_.workers.for_blocks(mesh_.connectivity.face_count(), kFaceBlock, [&](IndexRange range) {
    for (auto f = range.begin; f < range.end; ++f)
      kernels::measure_face(mesh_.connectivity, mesh_.points, static_cast<std::int32_t>(f),
                            faces_[f]);
  });
  context_.workers.for_blocks(mesh_.connectivity.face_count(), kFaceBlock, [&](IndexRange range) {
    for (auto f = range.begin; f < range.end; ++f) {
      kernels::unfold_face(faces_, static_cast<std::int32_t>(f));
      if (!options_.curved) continue;
      const auto& t = mesh_.connectivity.triangles[f];
      for (int i = 0; i < 3; ++i) {
        const std::int32_t p = t[i];
        const std::int32_t q = t[i == 2 ? 0 : i + 1];
        curved_[f].bulge[i] =
            kernels::edge_bulge(mesh_.points[p].head<3>(), mesh_.points[q].head<3>(),
                                mesh_.normals[p], mesh_.normals[q]);
      }
    }
  });
}

/// Replaces angle-weighted normals, which are only first-order on uneven meshes, by those of the
/// fitted surface. Later levels get them from smoothing. Only level 0 needs a pass of its own, and
/// two more along rims, where patches depend on fewer normals.
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
    evolve_block(
        surface, layout(), instruction_set_, range.end - range.begin,
        [&](std::size_t i) { return vertex_at(range.begin + static_cast<std::int64_t>(i)); },
        [&](std::int32_t v, const kernels::EvolvedVertex& e) {
          next_normals_[v] = e.normal;
          truncated[v] = e.patch_completeness > 0 && e.patch_completeness < 1;
        });
  });
  context_.workers.for_blocks(count, kFaceBlock, [&](IndexRange range) {
    for (auto i = range.begin; i < range.end; ++i) {
      const std::int32_t v = vertex_at(i);
      mesh_.normals[v] = next_normals_[v];
    }
  });
  prepare_faces();
}

LevelFields EvolvingSurface::advance(bool move) {
  LevelFields fields = evaluate();
  if (move) this->move();
  return fields;
}

LevelFields EvolvingSurface::evaluate() {
  const std::int64_t n = vertex_count();
  LevelFields fields;
  fields.points.resize(n);
  fields.normals = mesh_.normals;
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
  fields.parts = mesh_.part_count;
  fields.remeshed = remeshed_;
  fields.shortest_side = shortest_side_ * unit_;
  fields.stored_order = stored_order_;
  fields.connectivity = std::exchange(connectivity_, std::nullopt);
  part_has_patch_.assign(mesh_.part_count, 0);

  const kernels::SampledSurface surface = sampled();
  const kernels::PatchLayout patch = layout();
  const auto per_length = static_cast<float>(1 / unit_);
  context_.workers.for_blocks(n, kVertexBlock, [&](IndexRange range) {
    const auto vertex_at = [&](std::size_t i) {
      return static_cast<std::int32_t>(range.begin + static_cast<std::int64_t>(i));
    };
    const auto keep = [&](std::int32_t v, const kernels::EvolvedVertex& e) {
      fields.points[v] = mesh_.points[v].head<3>() * static_cast<float>(unit_);
      fields.gaussian_curvature[v] = e.gaussian_curvature * per_length * per_length;
      fields.mean_curvature[v] = e.mean_curvature * per_length;
      fields.patch_completeness[v] = e.patch_completeness;
      if (options_.principal) {
        fields.principal_curvature_1[v] = e.principal.k1 * per_length;
        fields.principal_curvature_2[v] = e.principal.k2 * per_length;
        fields.principal_direction_1[v] = e.principal.first;
        fields.principal_direction_2[v] = e.principal.second;
      }
      if (e.patch_completeness > 0) note_patch(part_has_patch_[mesh_.part[v]]);
      next_points_[v] << e.position, 0.0f;
      next_normals_[v] = e.smoothed_normal;
    };
    evolve_block(surface, patch, instruction_set_, range.end - range.begin, vertex_at, keep);
    context_.observer.worked(range.end - range.begin);
  });
  return fields;
}

void EvolvingSurface::move() {
  mesh_.points.swap(next_points_);
  mesh_.normals.swap(next_normals_);
  variance_ += kernels::gaussian_filters().variance * step_ * step_;
  std::vector<PartMeasure> parts = restore_size();
  if (options_.schedule == Schedule::kOctaves) step_ = std::max(first_step_, std::sqrt(variance_));
  if (options_.remesh) parts = remesh(std::move(parts));
  mean_edge_length_ = jobs::mean_edge_length(parts);
  if (options_.schedule == Schedule::kOctaves) set_step(step_);
  if (!options_.curved) angle_weighted_normals();
  prepare_faces();
}

/// Returns the scale factor of 5.1. Differs: the thesis compares mean edge lengths, which noise
/// makes longer. Noise hardly changes volume and radius of gyration. Thin walls keep their volume,
/// and blades that shrink to their axis keep their radius, so the smaller factor is right for both.
double EvolvingSurface::restoring_factor(const PartMeasure& was, const PartMeasure& is) const {
  const auto ratio = [](double before, double after) {
    if (!(before > 0 && after > 0)) return 1.0;
    return std::clamp(before / after, 1 / kMaxRestoration, kMaxRestoration);
  };
  if (options_.rescale == Rescale::kEdges)
    return ratio(was.mean_edge_length(), is.mean_edge_length());
  const double factor = ratio(was.radius_of_gyration(), is.radius_of_gyration());
  if (!(was.volume() > 0 && is.volume() > 0)) return factor;
  return std::min(factor, ratio(std::cbrt(was.volume()), std::cbrt(is.volume())));
}

/// Rescales each part about its centroid to its size before (thesis 5.1), if the options say so.
/// Returns the measures of the parts afterwards.
std::vector<PartMeasure> EvolvingSurface::restore_size() {
  struct Restoration {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double factor = 1;
  };
  std::vector<PartMeasure> parts = measure_parts(mesh_, edge_limit(), context_);
  if (options_.rescale == Rescale::kNone || options_.schedule != Schedule::kUniform) return parts;
  std::vector<Restoration> restorations(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    restorations[i] = {parts[i].centroid(), restoring_factor(part_reference_[i], parts[i])};
    parts[i] = parts[i].scaled(restorations[i].factor);
  }
  context_.workers.for_blocks(vertex_count(), kFaceBlock, [&](IndexRange range) {
    for (auto v = range.begin; v < range.end; ++v) {
      const Restoration& r = restorations[mesh_.part[v]];
      const Eigen::Vector3d p = mesh_.points[v].head<3>().cast<double>();
      mesh_.points[v].head<3>() = (r.centre + r.factor * (p - r.centre)).cast<float>();
    }
  });
  return parts;
}

/// Coarsens the mesh until its mean edge length has grown as the step has. Adds what was done to
/// `counts`. Returns the measures of the parts afterwards.
std::vector<PartMeasure> EvolvingSurface::coarsen(std::vector<PartMeasure> parts,
                                                  kernels::RemeshCounts& counts) {
  const double grown = first_edge_length_ * step_ / first_step_;
  std::vector<double> lengths(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double triangles = parts[i].twice_area / 2 / kUnitTriangle;  // with edges of length 1
    const double length = std::min(grown, std::sqrt(triangles / kLeastFaces));
    const double faces = triangles / (length * length);
    if (static_cast<double>(parts[i].faces) > kWorthCoarsening * faces) lengths[i] = length;
  }
  if (std::ranges::count(lengths, 0) == std::ssize(lengths)) return parts;
  const kernels::RemeshCounts coarsened = kernels::coarsen(mesh_, lengths);
  if (coarsened == kernels::RemeshCounts{}) return parts;
  counts += coarsened;
  target_faces_ = std::min(target_faces_, mesh_.connectivity.face_count());
  return measure_parts(mesh_, edge_limit(), context_);
}

/// Coarsens the moved mesh under octaves, and removes odd triangles and parts on which no patch was
/// valid. Returns the measures of the parts afterwards.
std::vector<PartMeasure> EvolvingSurface::remesh(std::vector<PartMeasure> parts) {
  const engine::Stopwatch stopwatch(context_.observer, "remeshing");
  kernels::RemeshCounts coarsened;
  if (options_.schedule == Schedule::kOctaves && options_.coarsen)
    parts = coarsen(std::move(parts), coarsened);
  std::vector<std::uint8_t> dropped(parts.size());
  std::size_t largest = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    dropped[i] = part_has_patch_[i] == 0;
    if (parts[i].twice_area > parts[largest].twice_area) largest = i;
  }
  dropped[largest] = 0;
  RemeshResult result = remesh_surface(mesh_, std::move(parts),
                                       {.curved = options_.curved,
                                        .first_edge_length = first_edge_length_,
                                        .edge_limit = edge_limit(),
                                        .faces = target_faces_,
                                        .dropped = dropped},
                                       context_);
  result.counts += coarsened;
  shortest_side_ = result.shortest_side;
  remeshed_ = result.counts;
  vanished_ = vanished_ || result.vanished;
  if (!result.changed()) return std::move(result.parts);
  target_faces_ =
      vanished_ ? mesh_.connectivity.face_count() : target_faces_ - result.counts.dropped_faces;
  part_reference_ = result.parts;
  adopt_mesh();
  connectivity_ = connectivity();
  return std::move(result.parts);
}

LevelConnectivity EvolvingSurface::connectivity() const {
  const std::vector<std::int32_t>& order = *stored_order_;
  const std::size_t n = order.size();
  LevelConnectivity result;
  result.source_vertex = kernels::gathered(mesh_.source, order);
  result.vertex_filled = kernels::gathered(mesh_.vertex_filled, order);
  result.part.resize(n);
  result.face_filled = mesh_.face_filled;
  std::vector<std::int32_t> row(n);
  std::vector<std::int32_t> part_number(mesh_.part_count, kernels::kNone);
  std::int32_t parts = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::int32_t v = order[i];
    row[v] = static_cast<std::int32_t>(i);
    std::int32_t& part = part_number[mesh_.part[v]];
    if (part == kernels::kNone) part = parts++;
    result.part[i] = part;
  }
  result.triangles.resize(mesh_.connectivity.triangles.size());
  context_.workers.for_blocks(mesh_.connectivity.face_count(), kFaceBlock, [&](IndexRange range) {
    for (auto f = range.begin; f < range.end; ++f)
      for (int i = 0; i < 3; ++i) result.triangles[f][i] = row[mesh_.connectivity.triangles[f][i]];
  });
  return result;
}

}  // namespace semigeo::jobs
