#include "jobs/stages/scan_surface.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "io/files/error.hpp"
#include "io/scans/scan_reader.hpp"

namespace semigeo::jobs {
namespace {

/// Beyond these mean edge lengths single precision cannot hold curvatures (length^-2).
constexpr double kShortestMeanEdge = 1e-12;
constexpr double kLongestMeanEdge = 1e12;

/// Returns "320 degenerate faces, 162 isolated vertices": the counts that are not 0.
std::string in_words(const kernels::SurfaceRepairs& repairs) {
  std::string text;
  const nlohmann::json counts = json_of(repairs);
  for (const auto& [name, count] : counts.items()) {
    if (count == 0) continue;
    std::string words = name;
    std::ranges::replace(words, '_', ' ');
    text += (text.empty() ? "" : ", ") + count.dump() + ' ' + words;
  }
  return text;
}

void check_usable(const std::filesystem::path& scan, const kernels::BuiltSurface& built) {
  if (built.surface.face_count() == 0)
    throw io::Error(scan, "",
                    "no usable triangle is left after repair (" + in_words(built.repairs) + ")",
                    "check how the scan was exported");
  const double edge = kernels::mean_edge_length(built.surface);
  if (!(edge >= kShortestMeanEdge && edge <= kLongestMeanEdge))
    throw io::Error(
        scan, "",
        "the mean edge length, " + nlohmann::json(edge).dump() + ", is outside 1e-12 ... 1e12",
        "export the scan in a unit that suits its size");
}

}  // namespace

nlohmann::json json_of(const kernels::SurfaceRepairs& repairs) {
  nlohmann::json json;
  each_repair(repairs, [&](const char* name, std::int64_t count) { json[name] = count; });
  return json;
}

nlohmann::json json_of(const ScanRepairs& repairs) {
  nlohmann::json json;
  each_scan_repair(repairs, [&](const char* name, std::int64_t count) { json[name] = count; });
  each_rare_repair(repairs, [&](const char* name, std::int64_t count) {
    if (count == 0) json.erase(name);
  });
  return json;
}

std::string to_json(const kernels::SurfaceRepairs& repairs) {
  return json_of(repairs).dump();
}

ScanSurface read_surface(const std::filesystem::path& path, const std::string& xxh3,
                         double depth_jump, const kernels::Welding& welding) {
  io::Scan scan = io::read_scan(path, {.depth_jump = depth_jump});
  if (scan.xxh3 != xxh3)
    throw io::Error(path, "", "the file changed while it was read", "run again");
  ScanSurface result;
  result.built = kernels::build_surface(std::move(scan.mesh), welding);
  check_usable(path, result.built);
  result.format = scan.format;
  result.eye = scan.eye;
  result.repairs = {.surface = result.built.repairs,
                    .polygons_triangulated = scan.polygons_triangulated,
                    .faces_skipped = scan.faces_skipped,
                    .bad_vertices = scan.bad_vertices,
                    .faces_of_bad_vertices = scan.faces_of_bad_vertices,
                    .bytes_after_end = scan.bytes_after_end,
                    .wrong_counts = scan.wrong_counts,
                    .surplus_values = scan.surplus_values,
                    .unknown_header_lines = scan.unknown_header_lines,
                    .depth_jump_triangles = scan.depth_jump_triangles};
  return result;
}

}  // namespace semigeo::jobs
