#include "bench/evolution/level_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "jobs/stages/part_measures.hpp"
#include "kernels/surface/edge_groups.hpp"

namespace semigeo::evolution {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double count(std::int64_t value) {
  return static_cast<double>(value);
}

double shortest_edge(const kernels::LevelMesh& mesh) {
  double shortest2 = std::numeric_limits<double>::infinity();
  for (std::int32_t f = 0; f < mesh.connectivity.face_count(); ++f)
    for (int i = 0; i < 3; ++i)
      shortest2 = std::min(shortest2, mesh.length2(kernels::halfedge(f, i)));
  return std::sqrt(shortest2);
}

/// Returns the mean distance of each row from the nearest row of the earlier level that comes from
/// the same vertex of level 0. Both levels' rows ascend by that vertex; those of inserted vertices
/// are last.
double mean_distance(const kernels::LevelMesh& mesh,
                     const std::vector<std::int32_t>& earlier_source,
                     const std::vector<Eigen::Vector3f>& earlier_points) {
  double sum = 0;
  std::int64_t used = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < mesh.source.size() && mesh.source[i] != kernels::kNone; ++i) {
    const auto in_order = [&](std::size_t k) {
      return k < earlier_source.size() && earlier_source[k] != kernels::kNone;
    };
    while (in_order(begin) && earlier_source[begin] < mesh.source[i]) ++begin;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = begin; in_order(k) && earlier_source[k] == mesh.source[i]; ++k)
      nearest = std::min(
          nearest,
          (mesh.point(static_cast<std::int32_t>(i)) - earlier_points[k].cast<double>()).norm());
    if (!std::isfinite(nearest)) continue;
    sum += nearest;
    ++used;
  }
  return used > 0 ? sum / count(used) : kNaN;
}

constexpr Column kColumns[] = {
    {"vertices", [](const LevelReport& r) { return count(r.vertices); }, true},
    {"triangles", [](const LevelReport& r) { return count(r.triangles); }, true},
    {"parts", [](const LevelReport& r) { return count(r.parts); }, true},
    {"boundary_edges", [](const LevelReport& r) { return count(r.boundary_edges); }, true},
    {"moved", [](const LevelReport& r) { return r.moved; }, false},
    {"moved_from_first", [](const LevelReport& r) { return r.moved_from_first; }, false},
    {"volume", [](const LevelReport& r) { return r.volume; }, false},
    {"area", [](const LevelReport& r) { return r.area; }, false},
    {"mean_edge", [](const LevelReport& r) { return r.mean_edge; }, false},
    {"shortest_edge", [](const LevelReport& r) { return r.shortest_edge; }, false},
    {"split", [](const LevelReport& r) { return count(r.remeshed.split); }, true},
    {"collapsed", [](const LevelReport& r) { return count(r.remeshed.collapsed); }, true},
    {"torn", [](const LevelReport& r) { return count(r.remeshed.torn); }, true},
    {"dropped_parts", [](const LevelReport& r) { return count(r.remeshed.dropped_parts); }, true},
    {"remeshing_seconds", [](const LevelReport& r) { return r.remeshing.wall; }, false},
    {"remeshing_cpu_seconds", [](const LevelReport& r) { return r.remeshing.cpu; }, false},
    {"smoothing_seconds", [](const LevelReport& r) { return r.smoothing.wall; }, false},
    {"smoothing_cpu_seconds", [](const LevelReport& r) { return r.smoothing.cpu; }, false},
};

}  // namespace

std::span<const Column> columns() {
  return kColumns;
}

LevelMeter::LevelMeter(const kernels::Surface& first)
    : first_edge_(kernels::mean_edge_length(first)), first_points_(first.points) {
  mesh_.connectivity.triangles = first.triangles;
  mesh_.connectivity.twin = first.twin;
  mesh_.part = first.part;
  mesh_.source.resize(first.points.size());
  std::iota(mesh_.source.begin(), mesh_.source.end(), 0);
  before_source_ = mesh_.source;
  before_points_ = first_points_;
}

void LevelMeter::adopt(const jobs::LevelConnectivity& connectivity) {
  mesh_.connectivity.triangles = connectivity.triangles;
  mesh_.part = connectivity.part;
  mesh_.connectivity.twin = kernels::pair_twins(
      kernels::group_edges(connectivity.triangles, std::ssize(connectivity.part)),
      connectivity.triangles.size());
  mesh_.source = connectivity.source_vertex;
}

LevelReport LevelMeter::measure(const jobs::LevelFields& fields,
                                const engine::RunContext& context) {
  if (fields.connectivity) adopt(*fields.connectivity);
  const std::vector<std::int32_t>& order = *fields.stored_order;
  mesh_.points.resize(order.size());
  std::vector<Eigen::Vector3f> points(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    points[i] = fields.points[order[i]];
    mesh_.points[i] << points[i], 0.0f;
  }
  mesh_.part_count = static_cast<std::int32_t>(fields.parts);

  LevelReport report;
  report.vertices = mesh_.vertex_count();
  report.triangles = mesh_.connectivity.face_count();
  report.parts = fields.parts;
  for (const jobs::PartMeasure& part :
       jobs::measure_parts(mesh_, std::numeric_limits<double>::infinity(), context)) {
    report.boundary_edges += part.boundary_edges;
    report.volume += part.volume();
    report.area += part.twice_area / 2;
  }
  report.mean_edge = fields.mean_edge_length;
  report.shortest_edge = shortest_edge(mesh_);
  report.remeshed = fields.remeshed;
  std::vector<std::int32_t> every(first_points_.size());
  std::iota(every.begin(), every.end(), 0);
  report.moved_from_first = mean_distance(mesh_, every, first_points_) / first_edge_;
  report.moved = mean_distance(mesh_, before_source_, before_points_) / first_edge_;
  before_source_ = mesh_.source;
  before_points_ = std::move(points);
  return report;
}

}  // namespace semigeo::evolution
