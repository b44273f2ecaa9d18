#include "kernels/repair/surface_builder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "kernels/surface/bounding_box.hpp"
#include "kernels/surface/circulators.hpp"
#include "kernels/surface/edge_groups.hpp"

namespace semigeo::kernels {
namespace {

/// Returns the origin of a surface: zero, or the centre of the bounding box, rounded to a power of
/// ten below the size of the box.
Eigen::Vector3d choose_origin(const std::vector<Eigen::Vector3d>& points) {
  if (points.empty()) return Eigen::Vector3d::Zero();
  const Eigen::AlignedBox3d box = bounding_box(points);
  const double diagonal = box.sizes().norm();
  const Eigen::Vector3d middle = 0.5 * box.min() + 0.5 * box.max();
  if (!(diagonal > 0) || middle.norm() <= diagonal) return Eigen::Vector3d::Zero();
  const double unit = std::pow(10.0, std::floor(std::log10(diagonal)));
  return (middle / unit).array().round() * unit;
}

std::uint64_t hash_point(const Eigen::Vector3f& p) {
  std::uint64_t hash = 0;
  for (int c = 0; c < 3; ++c) {
    hash = (hash ^ std::bit_cast<std::uint32_t>(p[c])) * 0x9E3779B97F4A7C15u;
    hash ^= hash >> 32;
  }
  return hash;
}

/// Merges equal points in place, in the order of first appearance. Returns the new index of each
/// point.
std::vector<std::int32_t> weld(std::vector<Eigen::Vector3f>& points) {
  std::vector<std::int32_t> new_index(points.size());
  std::vector<std::int32_t> table(std::bit_ceil(points.size() * 3 / 2 + 1), kNone);
  const std::size_t mask = table.size() - 1;
  std::int32_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f p = points[i].array() + 0.0f;  // -0 becomes +0
    std::size_t slot = hash_point(p) & mask;
    while (table[slot] != kNone && points[table[slot]] != p) slot = (slot + 1) & mask;
    if (table[slot] == kNone) {
      table[slot] = kept;
      points[kept++] = p;
    }
    new_index[i] = table[slot];
  }
  points.resize(kept);
  points.shrink_to_fit();
  return new_index;
}

std::int64_t drop_degenerate(std::vector<Triangle>& triangles) {
  return static_cast<std::int64_t>(std::erase_if(
      triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }));
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Drops every face whose three vertices, in any order, appeared before.
std::int64_t drop_duplicates(std::vector<Triangle>& triangles, std::int64_t vertex_count) {
  // Faces are sorted into buckets by their lowest vertex. Within a bucket equal faces come one
  // after the other, in the order of the list.
  std::vector<std::int32_t> bucket(vertex_count + 1, 0);
  const auto low = [](const Triangle& t) { return std::min({t[0], t[1], t[2]}); };
  for (const Triangle& t : triangles) ++bucket[low(t) + 1];
  for (std::int64_t v = 0; v < vertex_count; ++v) bucket[v + 1] += bucket[v];
  std::vector<std::int32_t> order(triangles.size());
  {
    std::vector<std::int32_t> cursor(bucket.begin(), bucket.end() - 1);
    for (std::size_t f = 0; f < triangles.size(); ++f)
      order[cursor[low(triangles[f])]++] = static_cast<std::int32_t>(f);
  }
  std::vector<bool> duplicate(triangles.size(), false);
  for (std::int64_t v = 0; v < vertex_count; ++v) {
    const auto first = order.begin() + bucket[v];
    const auto last = order.begin() + bucket[v + 1];
    std::sort(first, last, [&](std::int32_t a, std::int32_t b) {
      return std::pair(sorted(triangles[a]), a) < std::pair(sorted(triangles[b]), b);
    });
    for (auto f = first; f != last; ++f)
      if (f != first && sorted(triangles[*f]) == sorted(triangles[*(f - 1)])) duplicate[*f] = true;
  }
  std::size_t kept = 0;
  for (std::size_t f = 0; f < triangles.size(); ++f)
    if (!duplicate[f]) triangles[kept++] = triangles[f];
  const std::size_t dropped = triangles.size() - kept;
  triangles.resize(kept);
  return static_cast<std::int64_t>(dropped);
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

/// Turns faces over until the two faces of each edge agree. In each connected set of faces the
/// minority is turned. A surface that cannot be oriented keeps some edges whose faces disagree.
std::int64_t orient(std::vector<Triangle>& triangles, std::int64_t vertex_count) {
  const auto partner = pair_twins(group_edges(triangles, vertex_count), triangles.size());
  const auto start_of = [&](std::int32_t h) { return triangles[face_of(h)][corner_of(h)]; };
  enum : std::uint8_t { kUnseen, kKeep, kFlip };
  std::vector<std::uint8_t> state(triangles.size(), kUnseen);
  std::vector<std::int32_t> camp;
  std::int64_t flipped = 0;
  for (std::size_t seed = 0; seed < triangles.size(); ++seed) {
    if (state[seed] != kUnseen) continue;
    state[seed] = kKeep;
    camp.assign(1, static_cast<std::int32_t>(seed));
    std::size_t turned = 0;
    for (std::size_t k = 0; k < camp.size(); ++k) {
      const std::int32_t f = camp[k];
      for (int i = 0; i < 3; ++i) {
        const std::int32_t h = halfedge(f, i);
        if (partner[h] == kNone || state[face_of(partner[h])] != kUnseen) continue;
        // Two faces agree if they run along their edge in opposite directions.
        const bool disagree = start_of(h) == start_of(partner[h]);
        const bool flip = (state[f] == kFlip) != disagree;
        state[face_of(partner[h])] = flip ? kFlip : kKeep;
        turned += flip;
        camp.push_back(face_of(partner[h]));
      }
    }
    const auto minority = 2 * turned > camp.size() ? kKeep : kFlip;
    for (const std::int32_t f : camp) {
      if (state[f] != minority) continue;
      std::swap(triangles[f][1], triangles[f][2]);
      ++flipped;
    }
  }
  return flipped;
}

/// Keeps each face whose directed edges no earlier face has, and drops the others.
std::int64_t drop_nonmanifold(std::vector<Triangle>& triangles, std::int64_t vertex_count) {
  const EdgeGroups groups = group_edges(triangles, vertex_count);
  std::vector<std::int32_t> edge_of(4 * triangles.size(), kNone);
  for (std::int64_t e = 0; e < groups.edge_count(); ++e)
    for (const std::int32_t h : groups.edge(e)) edge_of[h] = static_cast<std::int32_t>(e);

  std::vector<std::array<bool, 2>> taken(groups.edge_count(), {false, false});
  std::size_t kept = 0;
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const Triangle t = triangles[f];
    std::array<bool*, 3> slot{};
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(static_cast<std::int32_t>(f), i);
      slot[i] = &taken[edge_of[h]][t[i] < t[(i + 1) % 3] ? 0 : 1];
    }
    if (*slot[0] || *slot[1] || *slot[2]) continue;
    *slot[0] = *slot[1] = *slot[2] = true;
    triangles[kept++] = t;
  }
  const std::size_t dropped = triangles.size() - kept;
  triangles.resize(kept);
  return static_cast<std::int64_t>(dropped);
}

/// Copies vertices that have several fans of faces. Each fan but the first gets a copy.
std::int64_t split_fans(Surface& surface) {
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

std::int64_t drop_isolated(Surface& surface) {
  std::vector<std::int32_t> new_index(surface.points.size(), kNone);
  for (const Triangle& t : surface.triangles)
    for (const std::int32_t v : t) new_index[v] = 0;
  std::int32_t kept = 0;
  for (std::size_t v = 0; v < new_index.size(); ++v) {
    if (new_index[v] == kNone) continue;
    surface.points[kept] = surface.points[v];
    new_index[v] = kept++;
  }
  const std::size_t dropped = surface.points.size() - kept;
  surface.points.resize(kept);
  for (Triangle& t : surface.triangles)
    for (std::int32_t& v : t) v = new_index[v];
  return static_cast<std::int64_t>(dropped);
}

}  // namespace

BuiltSurface build_surface(TriangleMesh&& mesh) {
  BuiltSurface built;
  built.origin = choose_origin(mesh.points);
  Surface& surface = built.surface;
  surface.points.reserve(mesh.points.size());
  for (const auto& p : mesh.points) surface.points.push_back((p - built.origin).cast<float>());
  std::vector<Eigen::Vector3d>().swap(mesh.points);
  surface.triangles = std::move(mesh.triangles);

  SurfaceRepairs& repairs = built.repairs;
  {
    const std::int64_t before = std::ssize(surface.points);
    const auto new_index = weld(surface.points);
    for (Triangle& t : surface.triangles)
      for (std::int32_t& v : t) v = new_index[v];
    repairs.welded_vertices = before - std::ssize(surface.points);
  }
  repairs.degenerate_faces = drop_degenerate(surface.triangles);
  const std::int64_t vertex_count = std::ssize(surface.points);
  EdgeGroups groups = group_edges(surface.triangles, vertex_count);
  if (!is_clean(groups, surface.triangles)) {
    repairs.duplicate_faces = drop_duplicates(surface.triangles, vertex_count);
    repairs.flipped_faces = orient(surface.triangles, vertex_count);
    repairs.nonmanifold_faces = drop_nonmanifold(surface.triangles, vertex_count);
    groups = group_edges(surface.triangles, vertex_count);
  }
  surface.triangles.shrink_to_fit();
  surface.twin = pair_twins(groups, surface.triangles.size());
  // The two functions that follow only rename vertices, so the twins stay valid.
  repairs.split_vertices = split_fans(surface);
  repairs.isolated_vertices = drop_isolated(surface);
  connect(surface);
  return built;
}

}  // namespace semigeo::kernels
