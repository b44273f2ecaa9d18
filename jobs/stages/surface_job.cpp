#include "jobs/stages/surface_job.hpp"

#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "engine/task_graph.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/dataset/dataset_writer.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "jobs/stages/for_each_on.hpp"
#include "jobs/stages/level_features.hpp"
#include "kernels/features/scale_selection.hpp"
#include "kernels/surface/vertex_order.hpp"
#include "kernels/surface/vertex_rows.hpp"

namespace semigeo::jobs {
namespace {

/// A part with fewer vertices is smaller than a patch of 9 x 9 samples.
constexpr std::int64_t kSmallPart = 81;

/// Encodes arrays chunk by chunk on all workers.
class ParallelEncoder {
 public:
  ParallelEncoder(engine::Workers& workers, io::Compression compression)
      : workers_(workers), compression_(compression) {}

  /// Adds an array. `run` fills `target`; until then `target` and the data of `view` must exist.
  void add(const io::ArrayView& view, io::EncodedArray& target) {
    target.shape = io::shape_of(view, compression_);
    target.chunks.resize(target.shape.chunk_count());
    for (std::int64_t c = 0; c < target.shape.chunk_count(); ++c)
      tasks_.push_back({view, &target, c});
  }

  void run() {
    workers_.for_blocks(static_cast<std::int64_t>(tasks_.size()), 1, [&](engine::IndexRange range) {
      for (auto i = range.begin; i < range.end; ++i)
        tasks_[i].target->chunks[tasks_[i].chunk] =
            io::encode_chunk(tasks_[i].view, tasks_[i].chunk, compression_);
    });
    tasks_.clear();
  }

 private:
  struct Task {
    io::ArrayView view;
    io::EncodedArray* target;
    std::int64_t chunk;
  };
  engine::Workers& workers_;
  io::Compression compression_;
  std::vector<Task> tasks_;
};

io::EncodedConnectivity encode_connectivity(const LevelConnectivity& connectivity,
                                            ParallelEncoder& encoder) {
  io::EncodedConnectivity encoded;
  encoder.add(io::array_of(std::span(connectivity.triangles)), encoded.triangles);
  encoder.add(io::array_of(std::span<const std::int32_t>(connectivity.source_vertex),
                           io::ElementType::kInt64),
              encoded.source_vertex);
  encoder.add(io::array_of(std::span<const std::int32_t>(connectivity.part)), encoded.part);
  if (!connectivity.face_filled.empty()) {
    encoder.add(io::array_of(std::span(connectivity.vertex_filled)),
                encoded.vertex_filled.emplace());
    encoder.add(io::array_of(std::span(connectivity.face_filled)), encoded.face_filled.emplace());
  }
  encoder.run();
  return encoded;
}

/// Returns the connectivity of level 0, with vertices and faces in the order of the scan.
LevelConnectivity first_connectivity(const PreparedSurface& prepared) {
  LevelConnectivity first{
      .triangles = prepared.surface.triangles,
      .source_vertex = std::vector<std::int32_t>(prepared.surface.points.size()),
      .part = prepared.surface.part,
      .vertex_filled = prepared.vertex_filled,
      .face_filled = prepared.face_filled};
  std::iota(first.source_vertex.begin(), first.source_vertex.end(), 0);
  return first;
}

io::EncodedFields encode_fields(const LevelFields& fields, const kernels::LevelFeatures& features,
                                ParallelEncoder& encoder) {
  const io::RowOrder order = *fields.stored_order;
  io::EncodedFields encoded;
  encoder.add(io::array_of(std::span(fields.points), order), encoded.points);
  encoder.add(io::array_of(std::span(fields.normals), order), encoded.normals);
  encoder.add(io::array_of(std::span(fields.gaussian_curvature), order),
              encoded.gaussian_curvature);
  encoder.add(io::array_of(std::span(fields.mean_curvature), order), encoded.mean_curvature);
  encoder.add(io::array_of(std::span(fields.patch_completeness), order),
              encoded.patch_completeness);
  if (!fields.principal_direction_1.empty()) {
    io::EncodedPrincipal& principal = encoded.principal.emplace();
    encoder.add(io::array_of(std::span(fields.principal_curvature_1), order),
                principal.curvature_1);
    encoder.add(io::array_of(std::span(fields.principal_curvature_2), order),
                principal.curvature_2);
    encoder.add(io::array_of(std::span(fields.principal_direction_1), order),
                principal.direction_1);
    encoder.add(io::array_of(std::span(fields.principal_direction_2), order),
                principal.direction_2);
  }
  const io::FeatureTables tables = io::tables_of(features);
  io::for_each_array(
      tables, encoded.features,
      [&](const io::ArrayView& view, io::EncodedArray& target) { encoder.add(view, target); });
  encoder.run();
  return encoded;
}

io::LevelAttributes attributes_of(const LevelFields& fields, int iteration) {
  return {.iteration = iteration,
          .step = fields.step,
          .scale = fields.scale,
          .mean_edge_length = fields.mean_edge_length,
          .parts = fields.parts,
          .shortest_side = fields.shortest_side,
          .remeshed = fields.remeshed};
}

/// Counts the vertices of level 0 whose curvature is not known.
void count_missing(const LevelFields& fields, const kernels::LevelMesh& mesh,
                   ScanQuality& quality) {
  std::vector<std::int64_t> vertices_of(static_cast<std::size_t>(mesh.part_count));
  for (const std::int32_t part : mesh.part) ++vertices_of[part];
  for (std::size_t v = 0; v < mesh.part.size(); ++v) {
    if (fields.patch_completeness[v] > 0) continue;
    ++quality.without_patch;
    if (vertices_of[mesh.part[v]] < kSmallPart) ++quality.on_small_parts;
  }
}

/// The totals over all levels.
struct LevelTotals {
  double first_step = 0;  ///< Step of level 0.
  ScanQuality quality;    ///< What level 0 tells of it.
  kernels::RemeshCounts remeshed;
  std::vector<std::int64_t> feature_counts;  ///< Number of features of each level.
};

/// Evolves and writes all levels: pass k + 1 runs beside encoding and writing of level k. A pass is
/// curvature, features, and then the move to the next level.
///
///   pass 0 ──► move 0 ──► pass 1 ──► move 1 ──► pass 2 ──► ...
///     └► encode 0 ─► write 0 ─────────────────► (pass 2)   at most two levels are in memory
///                                └► encode 1 ─► write 1 ─► ...
LevelTotals write_levels(EvolvingSurface& surface, const SurfaceParameters& parameters,
                         io::DatasetWriter& writer, const engine::RunContext& context) {
  struct Level {
    std::unique_ptr<LevelFields> fields;
    kernels::LevelFeatures features;
    io::LevelAttributes attributes;
    std::optional<io::EncodedConnectivity> connectivity;
    io::EncodedFields encoded;
  };
  LevelTotals totals;
  std::vector<Level> levels(parameters.levels + 1);
  const auto cost = static_cast<double>(surface.vertex_count());
  engine::TaskGraph graph;
  std::vector<engine::TaskGraph::Task> move, write;
  for (int k = 0; k <= parameters.levels; ++k) {
    Level& level = levels[k];
    const std::string name = std::to_string(k);
    std::vector<engine::TaskGraph::Task> after;
    if (k >= 1) after.push_back(move[k - 1]);
    if (k >= 2) after.push_back(write[k - 2]);
    const auto pass = graph.add(
        "pass " + name, after,
        [&surface, &parameters, &context, &level, &totals, k] {
          level.fields = std::make_unique<LevelFields>(surface.evaluate());
          if (k == 0) {
            totals.first_step = level.fields->step;
            count_missing(*level.fields, surface.mesh(), totals.quality);
          }
          level.features = find_features(surface, *level.fields, parameters.features, context);
        },
        cost);
    if (k < parameters.levels)
      move.push_back(graph.add(
          "move " + name, {pass}, [&surface] { surface.move(); }, cost / 4));
    const auto encode = graph.add(
        "encode " + name, {pass},
        [&context, &parameters, &level, &totals, k] {
          LevelFields& fields = *level.fields;
          if (parameters.precision == Precision::kScan)
            round_to_scan(fields, level.features, totals.first_step, k == 0, context.workers);
          ParallelEncoder encoder(context.workers, parameters.compression);
          if (fields.connectivity)
            level.connectivity = encode_connectivity(*fields.connectivity, encoder);
          level.encoded = encode_fields(fields, level.features, encoder);
          level.attributes = attributes_of(fields, k);
          if (parameters.precision == Precision::kScan && k > 0)
            level.attributes.point_quantum = position_quantum(fields.step);
          level.fields.reset();
          level.features = {};
        },
        cost / 10);
    after = {encode};
    if (k >= 1) after.push_back(write[k - 1]);
    write.push_back(graph.add(
        "write " + name, after,
        [&writer, &level, &totals] {
          if (level.connectivity) writer.write_connectivity(*level.connectivity);
          writer.write_level(level.attributes, level.encoded);
          totals.remeshed += level.attributes.remeshed;
          totals.feature_counts.push_back(level.encoded.features.counts.total());
          level.connectivity.reset();
          level.encoded = {};
        },
        cost / 20));
  }
  rethrow_first(graph.run(context));
  return totals;
}

/// Selects the level at which the scan will be recognised.
io::Selection selection(std::vector<std::int64_t> feature_counts, std::optional<int> told) {
  kernels::ScaleSelection scale = kernels::select_scale(feature_counts);
  return {.feature_counts = std::move(feature_counts),
          .smoothed = std::move(scale.smoothed),
          .level = told.value_or(scale.level),
          .chosen = told ? io::Chosen::kOption : io::Chosen::kSlope};
}

}  // namespace

nlohmann::json json_of(const kernels::RemeshCounts& remeshed) {
  nlohmann::json json;
  for (const io::LevelCount& count : io::kLevelCounts) json[count.name] = remeshed.*count.count;
  return json;
}

SurfaceJobResult run_surface_job(const SurfaceJob& job, const SurfaceParameters& parameters,
                                 const engine::RunContext& context) {
  SurfaceJobResult result;
  io::DatasetHeader header;
  header.parameters = json_of(parameters);
  header.length_unit = parameters.length_unit;
  header.input_name = job.input_name;
  header.input_xxh3 = job.input_xxh3;
  header.job_key = job.key;

  std::unique_ptr<io::DatasetWriter> writer;
  Origins origins;
  kernels::Surface surface;
  {
    ScanSurface scan =
        read_surface(job.input, job.input_xxh3, parameters.depth_jump, welding_of(parameters));
    result.format = scan.format;
    result.repairs = scan.repairs;
    result.quality.coordinate_step = scan.built.coordinate_step;
    if (scan.repairs.surface.gap_vertices > 0)
      result.quality.weld_distance = scan.built.weld_distance;
    header.repairs = json_of(scan.repairs);
    header.origin = {scan.built.origin.x(), scan.built.origin.y(), scan.built.origin.z()};
    PreparedSurface prepared =
        prepare_surface(std::move(scan.built.surface), parameters.preparation, context);
    result.preparation = prepared.result;
    header.preparation = json_of(prepared.result, parameters.preparation);
    result.vertices = prepared.surface.vertex_count();
    result.triangles = prepared.surface.face_count();
    result.parts = prepared.surface.part_count;
    result.levels = parameters.levels + 1;

    writer = std::make_unique<io::DatasetWriter>(job.output, header, parameters.compression);
    ParallelEncoder encoder(context.workers, parameters.compression);
    writer->write_connectivity(encode_connectivity(first_connectivity(prepared), encoder));
    origins.vertex = kernels::locality_order(prepared.surface);
    std::vector<std::int32_t> faces;
    surface = kernels::reordered(prepared.surface, origins.vertex, &faces);
    origins.vertex_filled = kernels::gathered(prepared.vertex_filled, origins.vertex);
    origins.face_filled = kernels::gathered(prepared.face_filled, faces);
  }
  EvolvingSurface evolving(std::move(surface), parameters.evolution, context, std::move(origins));
  LevelTotals totals = write_levels(evolving, parameters, *writer, context);
  result.quality.mean_edge_length = evolving.first_edge_length();
  result.quality.without_patch = totals.quality.without_patch;
  result.quality.on_small_parts = totals.quality.on_small_parts;
  result.remeshed = totals.remeshed;
  result.vanished = evolving.vanished();
  writer->write_selection(
      selection(std::move(totals.feature_counts), parameters.recognition_level));
  writer->finish(for_each_on(context.workers));
  return result;
}

}  // namespace semigeo::jobs
