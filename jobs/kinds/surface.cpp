#include "jobs/kinds/surface.hpp"

#include <algorithm>

#include "io/dataset/dataset.hpp"
#include "io/dataset/xdmf.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/json_value.hpp"
#include "io/files/number_text.hpp"
#include "io/files/read_error.hpp"
#include "io/files/small_file.hpp"
#include "jobs/archive/scan_size.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/plan/typed_job_kind.hpp"
#include "jobs/stages/scan_surface.hpp"
#include "jobs/stages/surface_job.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;
using nlohmann::json;

/// It is raised whenever the same scan and parameters give other bytes.
static constexpr const char* kVersion = "surface 14";
/// It is added to the version if the levels are octaves, whose bytes may change alone.
static constexpr const char* kOctavesVersion = ", octaves 2";

/// Names every number and word of a result, for writing and for reading.
template <typename Visit>
static void each_field(SurfaceJobResult& r, const Visit& visit) {
  visit("format", r.format);
  visit("vertices", r.vertices);
  visit("triangles", r.triangles);
  visit("parts", r.parts);
  visit("levels", r.levels);
  visit("vanished", r.vanished);
  each_scan_repair(r.repairs, visit);
  visit("mean_edge_length", r.quality.mean_edge_length);
  visit("coordinate_step", r.quality.coordinate_step);
  visit("weld_distance", r.quality.weld_distance);
  visit("without_patch", r.quality.without_patch);
  visit("on_small_parts", r.quality.on_small_parts);
  visit("holes_loops", r.preparation.holes.loops);
  visit("holes_filled", r.preparation.holes.filled);
  visit("holes_outer", r.preparation.holes.outer);
  visit("holes_too_long", r.preparation.holes.too_long);
  visit("holes_unsplittable", r.preparation.holes.unsplittable);
  visit("filled_vertices", r.preparation.filled_vertices);
  visit("filled_faces", r.preparation.filled_faces);
  visit("removed_vertices", r.preparation.removed_vertices);
  visit("removed_faces", r.preparation.removed_faces);
  visit("tolerance", r.preparation.tolerance);
  visit("distance_maximum", r.preparation.distance.maximum);
  visit("distance_sum", r.preparation.distance.sum);
  visit("distance_count", r.preparation.distance.count);
  visit("flipped", r.remeshed.flipped);
  visit("split", r.remeshed.split);
  visit("collapsed", r.remeshed.collapsed);
  visit("torn", r.remeshed.torn);
  visit("inserted", r.remeshed.inserted);
  visit("removed", r.remeshed.removed);
  visit("dropped_parts", r.remeshed.dropped_parts);
  visit("dropped_faces", r.remeshed.dropped_faces);
}

static void to_json(json& object, const SurfaceJobResult& result) {
  SurfaceJobResult copy = result;
  object = json::object();
  each_field(copy, [&](const char* name, const auto& value) { object[name] = value; });
}

static void from_json(const json& object, SurfaceJobResult& result) {
  each_field(result,
             [&](const char* name, auto& value) { io::read_value(object.at(name), value); });
}

static void to_json(json& object, const SurfaceJobData& data) {
  object = {{"input_name", data.input_name},
            {"input_xxh3", data.input_xxh3},
            {"parameters", json_of(data.parameters)},
            {"sidecar_only", data.sidecar_only}};
}

static void from_json(const json& object, SurfaceJobData& data) {
  object.at("input_name").get_to(data.input_name);
  object.at("input_xxh3").get_to(data.input_xxh3);
  data.parameters = surface_parameters_from_json(object.at("parameters"));
  object.at("sidecar_only").get_to(data.sidecar_only);
}

namespace {

/// Curvature is noise if coordinates go in longer steps, in mean edge lengths.
constexpr double kCoarseStep = 1e-3;

json quality_json(const ScanQuality& quality) {
  return {{"mean_edge_length", quality.mean_edge_length},
          {"coordinate_step", quality.coordinate_step},
          {"weld_distance", quality.weld_distance},
          {"without_patch", quality.without_patch},
          {"on_small_parts", quality.on_small_parts}};
}
/// The share of changed vertices from which a scan is worth a look.
constexpr double kManyChanges = 0.01;
/// A surface that has vanished stands before all that have lost parts only.
constexpr double kVanishedLoss = 1e9;

/// Returns "3 welded vertices, 1 split vertices"; empty if nothing was repaired.
std::string repairs_in_words(const SurfaceJobResult& result) {
  std::string text;
  json counts = json_of(result.repairs);
  counts.erase("polygons_triangulated");  // nothing is wrong with polygons
  for (const auto& [name, count] : counts.items()) {
    if (count.get<std::int64_t>() == 0) continue;
    std::string words = name;
    std::ranges::replace(words, '_', ' ');
    text += (text.empty() ? "" : ", ") + count.dump() + " " + words;
    if (name == "gap_vertices")
      text += " (gaps of at most " + io::number_text(result.quality.weld_distance) + ")";
  }
  return text;
}

/// Returns in words why curvatures of the scan are missing or noise, and what to do; or an empty
/// text.
std::string doubts_in_words(const SurfaceJobResult& result) {
  const ScanQuality& quality = result.quality;
  std::string text;
  if (quality.coordinate_step > kCoarseStep * quality.mean_edge_length)
    text =
        "coordinates go in steps of " + io::number_text(quality.coordinate_step) + ", edges are " +
        io::number_text(quality.mean_edge_length) +
        " long: curvature is noise; export the scan in double precision, or nearer to its origin";
  if (2 * quality.without_patch <= result.vertices) return text;
  text += (text.empty() ? "" : ". ") + std::to_string(quality.without_patch) + " of " +
          std::to_string(result.vertices) + " vertices have no curvature at level 0: ";
  if (2 * quality.on_small_parts > quality.without_patch)
    return text +
           "they lie on parts smaller than a patch; close gaps with --weld LENGTH, or join "
           "the surface when it is exported";
  return text +
         "patches do not fit onto triangles so uneven; give a smaller --step, even them out "
         "with --decimate, or remesh the scan";
}

std::string in_words(const kernels::HoleCounts& holes) {
  std::string left;
  const auto add = [&](std::int64_t count, const char* reason) {
    if (count > 0) left += (left.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
  };
  add(holes.outer, "outer");
  add(holes.too_long, "too long");
  add(holes.unsplittable, "without a valid split");
  return std::to_string(holes.filled) + " of " + std::to_string(holes.loops) + " holes filled" +
         (left.empty() ? "" : " (left: " + left + ")");
}

/// Returns in words what was filled and removed, or an empty text if nothing was prepared.
std::string in_words(const PreparationResult& preparation) {
  if (preparation == PreparationResult{}) return "";
  std::string text = preparation.holes.loops > 0 ? in_words(preparation.holes) : "";
  if (preparation.removed_vertices > 0) {
    const std::string distance = io::number_text(preparation.distance.maximum);
    text += (text.empty() ? "" : ", ") + std::to_string(preparation.removed_vertices) +
            " vertices removed, at most " + distance + " from what is left";
  }
  return text.empty() ? "nothing to do" : text;
}

/// Returns in words what was done to the surface from level to level, or an empty text.
std::string evolution_in_words(const SurfaceJobResult& result) {
  std::string text;
  const auto add = [&text](std::int64_t count, const char* one, const char* more) {
    if (count == 0) return;
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : more);
  };
  add(result.remeshed.torn, "neck torn", "necks torn");
  add(result.remeshed.dropped_parts, "part lost", "parts lost");
  if (result.vanished)
    text +=
        (text.empty() ? "" : "; ") + std::string("too thin for so many levels: it has vanished");
  return text;
}

ReportLine repair_line(const SurfaceJobResult& made) {
  const kernels::SurfaceRepairs& repairs = made.repairs.surface;
  ReportLine line{.heading = "repaired", .text = repairs_in_words(made)};
  each_scan_repair(made.repairs, [&](std::string name, std::int64_t count) {
    std::ranges::replace(name, '_', ' ');
    // Bytes are no parts of a surface, and would stand before all of them.
    if (!name.starts_with("bytes")) line.counts.emplace_back(std::move(name), count);
  });
  // Welding is what every STL needs. Dropped faces are worth a look, and so are many changes.
  const auto share = [](std::int64_t count, std::int64_t of) {
    return static_cast<double>(count) / static_cast<double>(std::max<std::int64_t>(of, 1));
  };
  const std::int64_t dropped = repairs.degenerate_faces + repairs.duplicate_faces +
                               made.repairs.faces_skipped + made.repairs.faces_of_bad_vertices;
  const double changed = share(repairs.gap_vertices + repairs.flipped_faces +
                                   repairs.nonmanifold_edges + repairs.split_vertices,
                               made.vertices);
  line.loss = share(dropped, made.triangles + dropped) + (changed >= kManyChanges ? changed : 0);
  return line;
}

ReportLine doubt_line(const SurfaceJobResult& made) {
  const ScanQuality& quality = made.quality;
  ReportLine line{.heading = "doubtful", .text = doubts_in_words(made)};
  if (line.text.empty()) return line;
  const bool coarse = quality.coordinate_step > kCoarseStep * quality.mean_edge_length;
  line.counts = {{"vertices without curvature", quality.without_patch},
                 {"scans with coarse coordinates", coarse ? 1 : 0}};
  line.loss = static_cast<double>(quality.without_patch) /
                  static_cast<double>(std::max<std::int64_t>(made.vertices, 1)) +
              (coarse ? 1 : 0);
  return line;
}

ReportLine preparation_line(const PreparationResult& preparation) {
  const kernels::HoleCounts& holes = preparation.holes;
  return {.heading = "prepared",
          .text = in_words(preparation),
          .counts = {{"holes filled", holes.filled},
                     {"holes left", holes.outer + holes.too_long + holes.unsplittable},
                     {"vertices removed", preparation.removed_vertices}},
          .loss = static_cast<double>(holes.too_long + holes.unsplittable)};
}

ReportLine evolution_line(const SurfaceJobResult& made) {
  const std::int64_t lost = made.remeshed.dropped_parts;
  return {.heading = "evolved",
          .text = evolution_in_words(made),
          .counts = {{"necks torn", made.remeshed.torn},
                     {"parts lost", lost},
                     {"surfaces vanished", made.vanished ? 1 : 0}},
          .loss = static_cast<double>(lost) + (made.vanished ? kVanishedLoss : 0)};
}

/// Returns whether the sidecar could be made. If not, the dataset must be made, too. Throws
/// io::ReadError if the system refuses to read the dataset, which may be whole.
bool remake_sidecar(const Job& job) {
  std::string text;
  try {
    text = io::sidecar_text(job.output);
  } catch (const io::ReadError& error) {
    if (!error.is_absent()) throw;
    return false;
  } catch (const io::Error&) {
    return false;
  }
  io::write_file_atomically(io::sidecar_of(job.output), text);
  return true;
}

class SurfaceKind final : public TypedJobKind<SurfaceJobData, SurfaceJobResult> {
 public:
  const JobWords& words() const override { return words_; }
  bool fills_large_arrays() const override { return true; }

  std::string read_key(const fs::path& output, KeyCheck) const override {
    return io::read_origin(output).job_key;
  }

  bool has_all_outputs(const Job& job) const override {
    return io::is_there(io::sidecar_of(job.output));
  }

  void discard_output(const Job& job) const override {
    std::error_code ignored;
    fs::remove(data(job).sidecar_only ? io::sidecar_of(job.output) : job.output, ignored);
  }

  std::vector<ExternalFile> external_files(const PlannedJob& planned) const override {
    return {{.kind = "scan", .path = planned.scan, .is_readable = is_readable(planned)}};
  }

  Estimate estimate(const PlannedJob& planned, const EstimateContext& context) const override {
    const SurfaceJobData& surface = data(planned.job);
    if (surface.sidecar_only) return {};
    return context.learned.of(scan_size(planned), surface.parameters.levels + 1, 1);
  }

  std::uintmax_t bytes_to_read(const Job& job) const override {
    if (data(job).sidecar_only) return 0;
    return scan_size(job.input).bytes;
  }

  std::any run(const Job& job, const JobContext& context) const override {
    const SurfaceJobData& surface = data(job);
    if (surface.sidecar_only && remake_sidecar(job)) return {};
    return run_surface_job({.input = job.input,
                            .input_name = surface.input_name,
                            .name = job.name,
                            .output = job.output,
                            .input_xxh3 = surface.input_xxh3,
                            .key = job.key},
                           surface.parameters, context.engine);
  }

  std::int64_t vertex_levels(const std::any& value) const override {
    const SurfaceJobResult* made = result(value);
    return made == nullptr ? 0 : made->vertices * made->levels;
  }

  void describe(const Job& job, const std::any& value, JobEnded& event) const override {
    if (!data(job).sidecar_only) {
      ScanSize size = scan_size(job.input);
      event.format = std::move(size.format);
      event.input_bytes = static_cast<std::int64_t>(size.bytes);
    }
    if (const SurfaceJobResult* made = result(value)) {
      event.vertices = made->vertices;
      event.levels = made->levels;
    }
  }

  JobReport report(const Job& job, const std::any& value) const override {
    const SurfaceJobResult& made = *result(value);
    const PreparationOptions& wanted = data(job).parameters.preparation;
    JobReport report;
    report.name = data(job).input_name;
    report.fields = {{"format", made.format},
                     {"vertices", made.vertices},
                     {"triangles", made.triangles},
                     {"parts", made.parts},
                     {"levels", made.levels},
                     {"repairs", json_of(made.repairs)},
                     {"quality", quality_json(made.quality)},
                     {"preparation", json_of(made.preparation, wanted)},
                     {"vanished", made.vanished},
                     {"remeshing", json_of(made.remeshed)}};
    report.lines = {repair_line(made), doubt_line(made), preparation_line(made.preparation),
                    evolution_line(made)};
    return report;
  }

  bool remember(const Job& job, DigestCache& cache) const override {
    cache.dataset_keys(job.name);
    return true;
  }

 private:
  const JobWords words_ = {.kind = "surface",
                           .output = "dataset",
                           .inputs = "the scan",
                           .plural = "scans",
                           .kill_remedy = " or leave the scan out",
                           .memory_remedy = ", or decimate the scan",
                           .stands_for_scan = true};
};

}  // namespace

const JobKind& surface_kind() {
  static const SurfaceKind kind;
  return kind;
}

const SurfaceJobData& surface_data(const Job& job) {
  return SurfaceKind::data(job);
}

SurfaceJobData& surface_data(Job& job) {
  return SurfaceKind::data(job);
}

std::string surface_key(const std::string& name, const std::string& input_xxh3,
                        const std::string& parameters_json) {
  const json parameters = io::parse_json(parameters_json, {});
  const bool octaves = parameters.is_object() && parameters.contains("schedule") &&
                       parameters["schedule"] == "octaves";
  return io::xxh3_of_text(kVersion + std::string(octaves ? kOctavesVersion : "") + '\n' +
                          parameters_json + '\n' + name + '\n' + input_xxh3);
}

}  // namespace semigeo::jobs
