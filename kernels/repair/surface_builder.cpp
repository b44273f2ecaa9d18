#include "kernels/repair/surface_builder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/repair/coincident_faces.hpp"
#include "kernels/repair/edge_pairing.hpp"
#include "kernels/repair/part_orientation.hpp"
#include "kernels/repair/welding.hpp"
#include "kernels/surface/circulators.hpp"
#include "kernels/surface/edge_groups.hpp"

namespace semigeo::kernels {
namespace {

/// The distance of two roundings of one number, in steps, with room for the diagonal.
constexpr double kRoundedTwice = 2;
/// The mean length of boundary edges, in gaps, from which a gap may be rounding.
constexpr double kLeastEdge = 100;

/// Returns which points are corners of a face.
std::vector<bool> used_points(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.points.size(), false);
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t) used[v] = true;
  return used;
}

/// Returns the origin of a surface: zero, or the centre of the bounding box of the used points,
/// rounded to a power of ten below the size of the box.
Eigen::Vector3d choose_origin(const std::vector<Eigen::Vector3d>& points,
                              const std::vector<bool>& used) {
  Eigen::AlignedBox3d box;
  for (std::size_t v = 0; v < points.size(); ++v)
    if (used[v]) box.extend(points[v]);
  if (box.isEmpty()) return Eigen::Vector3d::Zero();
  const double diagonal = box.sizes().norm();
  const Eigen::Vector3d middle = 0.5 * box.min() + 0.5 * box.max();
  if (!(diagonal > 0) || middle.norm() <= diagonal) return Eigen::Vector3d::Zero();
  const double unit = std::pow(10.0, std::floor(std::log10(diagonal)));
  return (middle / unit).array().round() * unit;
}

/// Returns the step between neighbouring numbers of single precision at used points: as they lie in
/// memory, or, if the numbers of the file are all of single precision, as they are there. Nine in
/// ten points have no longer steps. `stored` are `points` relative to the origin.
double step_of(const std::vector<Eigen::Vector3d>& points,
               const std::vector<Eigen::Vector3f>& stored, const std::vector<bool>& used) {
  bool single = true;
  for (std::size_t v = 0; v < points.size(); ++v)
    for (const double x : points[v])
      single = single && (!used[v] || static_cast<double>(static_cast<float>(x)) == x);
  std::vector<float> largest;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (!used[v]) continue;
    const float in_memory = stored[v].cwiseAbs().maxCoeff();
    const auto in_file = static_cast<float>(points[v].cwiseAbs().maxCoeff());
    largest.push_back(single ? std::max(in_memory, in_file) : in_memory);
  }
  if (largest.empty()) return 0;
  const auto high = largest.begin() + std::ssize(largest) * 9 / 10;
  std::nth_element(largest.begin(), high, largest.end());
  return std::nextafter(*high, HUGE_VALF) - *high;
}

/// Returns the sums of the normals of points that were welded.
std::vector<Eigen::Vector3f> sums_of(const std::vector<Eigen::Vector3f>& normals,
                                     const std::vector<std::int32_t>& new_index,
                                     std::size_t count) {
  std::vector<Eigen::Vector3f> sums(count, Eigen::Vector3f::Zero());
  for (std::size_t v = 0; v < normals.size(); ++v) sums[new_index[v]] += normals[v];
  return sums;
}

/// Tells whether there is nothing to repair. No edge has more than two faces; the two faces of an
/// edge run along it in opposite directions; and they do not have the same three vertices.
bool is_clean(const EdgeGroups& groups, const std::vector<Triangle>& triangles) {
  const auto corner = [&](std::int32_t h) { return triangles[face_of(h)][corner_of(h)]; };
  for (std::int64_t e = 0; e < groups.edge_count(); ++e) {
    const auto members = groups.edge(e);
    if (members.size() == 1) continue;
    if (members.size() > 2 || corner(members[0]) == corner(members[1]) ||
        corner(prev(members[0])) == corner(prev(members[1])))
      return false;
  }
  return true;
}

/// Copies vertices that have several fans of faces. Each fan but the first gets a copy.
std::int64_t split_fans(Surface& surface, std::vector<Eigen::Vector3f>& normals) {
  std::vector<bool> seen(4 * surface.triangles.size(), false);
  std::vector<bool> has_fan(surface.points.size(), false);
  std::int64_t copies = 0;
  const auto face_count = static_cast<std::int32_t>(surface.face_count());
  for (std::int32_t f = 0; f < face_count; ++f)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t start = halfedge(f, i);
      if (seen[start]) continue;
      std::int32_t vertex = surface.origin(start);
      if (has_fan[vertex]) {
        surface.points.push_back(surface.points[vertex]);
        if (!normals.empty()) normals.push_back(normals[vertex]);
        vertex = static_cast<std::int32_t>(surface.points.size()) - 1;
        ++copies;
      } else {
        has_fan[vertex] = true;
      }
      // The fan is walked anticlockwise, all round or to its end. If it has an end, it is then
      // walked clockwise from the start.
      const auto claim = [&](std::int32_t h) {
        seen[h] = true;
        surface.triangles[face_of(h)][corner_of(h)] = vertex;
      };
      for (const std::int32_t h : outgoing_from(surface, start)) claim(h);
      for (std::int32_t h = surface.twin[start]; h != kNone && !seen[next(h)];
           h = surface.twin[h]) {
        h = next(h);
        claim(h);
      }
    }
  return copies;
}

std::int64_t drop_isolated(Surface& surface, std::vector<Eigen::Vector3f>& normals) {
  std::vector<std::int32_t> new_index(surface.points.size(), kNone);
  for (const Triangle& t : surface.triangles)
    for (const std::int32_t v : t) new_index[v] = 0;
  std::int32_t kept = 0;
  for (std::size_t v = 0; v < new_index.size(); ++v) {
    if (new_index[v] == kNone) continue;
    surface.points[kept] = surface.points[v];
    if (!normals.empty()) normals[kept] = normals[v];
    new_index[v] = kept++;
  }
  const std::size_t dropped = surface.points.size() - kept;
  surface.points.resize(kept);
  for (Triangle& t : surface.triangles)
    for (std::int32_t& v : t) v = new_index[v];
  return static_cast<std::int64_t>(dropped);
}

/// Returns the faces that run along an edge, from vertex to vertex, as an earlier face does. Once
/// fans are split, only fans that meet themselves have such edges.
std::vector<std::int32_t> conflicting_faces(const Surface& surface) {
  const EdgeGroups groups = group_edges(surface.triangles, std::ssize(surface.points));
  std::vector<std::int32_t> faces;
  for (std::int64_t e = 0; e < groups.edge_count(); ++e) {
    const auto members = groups.edge(e);
    for (std::size_t k = 1; k < members.size(); ++k)
      for (std::size_t j = 0; j < k; ++j)
        if (surface.origin(members[j]) == surface.origin(members[k])) {
          faces.push_back(face_of(members[k]));
          break;
        }
  }
  return faces;
}

/// Joins faces where more than two may meet in an edge, and counts what that takes.
void pair_and_split(Faces faces, Surface& surface, std::vector<Eigen::Vector3f>& normals,
                    SurfaceRepairs& repairs) {
  const std::int64_t vertex_count = std::ssize(surface.points);
  repairs.duplicate_faces = drop_duplicates(faces, vertex_count);
  PairedEdges paired;
  for (bool again = true; again;) {
    paired = pair_edges(faces, surface.points);
    repairs.flipped_faces += paired.flipped_faces;
    const std::int64_t backs = drop_backs(faces, paired.twin, vertex_count);
    repairs.duplicate_faces += backs;
    again = backs > 0;
  }
  repairs.nonmanifold_edges = paired.nonmanifold_edges;
  surface.triangles = std::move(faces.places);
  surface.twin = std::move(paired.twin);
  repairs.split_vertices = split_fans(surface, normals);
  for (auto alone = conflicting_faces(surface); !alone.empty();
       alone = conflicting_faces(surface)) {
    for (const std::int32_t f : alone)
      for (int i = 0; i < 3; ++i) {
        std::int32_t& twin = surface.twin[halfedge(f, i)];
        if (twin != kNone) surface.twin[twin] = kNone;
        twin = kNone;
      }
    repairs.nonmanifold_edges += std::ssize(alone);
    repairs.split_vertices += split_fans(surface, normals);
  }
}

}  // namespace

BuiltSurface build_surface(TriangleMesh&& mesh, const Welding& welding) {
  BuiltSurface built;
  Surface& surface = built.surface;
  SurfaceRepairs& repairs = built.repairs;
  {
    const std::vector<bool> used = used_points(mesh);
    built.origin = choose_origin(mesh.points, used);
    surface.points.reserve(mesh.points.size());
    for (const auto& p : mesh.points) surface.points.push_back((p - built.origin).cast<float>());
    built.coordinate_step = step_of(mesh.points, surface.points, used);
    built.weld_distance =
        welding.distance ? *welding.distance
                         : kRoundedTwice * rounding_of(mesh.points, used, built.coordinate_step);
  }
  std::vector<Eigen::Vector3d>().swap(mesh.points);
  std::vector<Eigen::Vector3f> normals = std::move(mesh.normals);

  Faces faces{std::move(mesh.triangles), {}};
  {
    const std::int64_t before = std::ssize(surface.points);
    const auto new_index = weld_equal(surface.points);
    repairs.welded_vertices = before - std::ssize(surface.points);
    if (repairs.welded_vertices > 0) faces.own = faces.places;
    if (!normals.empty()) normals = sums_of(normals, new_index, surface.points.size());
    for (Triangle& t : faces.places)
      for (std::int32_t& v : t) v = new_index[v];
  }
  repairs.degenerate_faces = drop_degenerate(faces);
  const std::int64_t vertex_count = std::ssize(surface.points);
  EdgeGroups groups = group_edges(faces.places, vertex_count);
  repairs.gap_vertices = close_gaps(faces.places, groups, surface.points, built.weld_distance,
                                    welding.distance ? 0 : kLeastEdge);
  if (repairs.gap_vertices > 0) {
    repairs.degenerate_faces += drop_degenerate(faces);
    groups = group_edges(faces.places, vertex_count);
  }
  if (is_clean(groups, faces.places)) {
    surface.triangles = std::move(faces.places);
    surface.twin = pair_twins(groups, surface.triangles.size());
    repairs.split_vertices = split_fans(surface, normals);  // renames vertices only
  } else {
    groups = {};
    pair_and_split(std::move(faces), surface, normals, repairs);
  }
  surface.triangles.shrink_to_fit();
  repairs.isolated_vertices = drop_isolated(surface, normals) - repairs.gap_vertices;
  connect(surface);
  repairs.turned_parts = turn_inverted_parts(surface, normals);
  return built;
}

}  // namespace semigeo::kernels
