#include "kernels/repair/welding.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace semigeo::kernels {
namespace {

/// The cosine between two faces from which they lie on the same side of a gap.
constexpr double kSameSide = 0.5;

std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9E3779B97F4A7C15u;
  return hash ^ hash >> 32;
}

std::uint64_t hash_point(const Eigen::Vector3f& p) {
  std::uint64_t hash = 0;
  for (int c = 0; c < 3; ++c) hash = mixed(hash, std::bit_cast<std::uint32_t>(p[c]));
  return hash;
}

using Cell = std::array<std::int64_t, 3>;

struct HashCell {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t c : cell) hash = mixed(hash, static_cast<std::uint64_t>(c));
    return hash;
  }
};

/// Describes an edge with one face: its ends, in the sense of the face, and the opposite corner.
struct OpenEdge {
  std::int32_t from, to, apex;
};

std::vector<OpenEdge> open_edges(const std::vector<Triangle>& triangles, const EdgeGroups& groups) {
  std::vector<OpenEdge> open;
  for (std::int64_t e = 0; e < groups.edge_count(); ++e) {
    if (groups.edge(e).size() != 1) continue;
    const std::int32_t h = groups.edge(e)[0];
    const Triangle& t = triangles[face_of(h)];
    open.push_back({t[corner_of(h)], t[corner_of(next(h))], t[corner_of(prev(h))]});
  }
  return open;
}

/// Finds the open edges whose middle is near a point.
class MiddleGrid {
 public:
  MiddleGrid(const std::vector<OpenEdge>& edges, std::span<const Eigen::Vector3f> points,
             double distance)
      : edges_(edges), points_(points), size_(4 * distance) {
    cells_.reserve(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e)
      cells_[cell_of(middle_of(e))].push_back(static_cast<std::int32_t>(e));
  }

  Eigen::Vector3d middle_of(std::size_t e) const {
    return (points_[edges_[e].from].cast<double>() + points_[edges_[e].to].cast<double>()) / 2;
  }

  /// Calls visit(edge) for each edge in the cells round that of edge e, in no particular order.
  template <typename Visit>
  void near(std::size_t e, const Visit& visit) const {
    const Cell centre = cell_of(middle_of(e));
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto found = cells_.find({centre[0] + x, centre[1] + y, centre[2] + z});
          if (found == cells_.end()) continue;
          for (const std::int32_t other : found->second) visit(static_cast<std::size_t>(other));
        }
  }

 private:
  Cell cell_of(const Eigen::Vector3d& p) const {
    constexpr double kFarthest = 1e18;  // beyond it all cells are one: they must fit into 64 bits
    Cell cell{};
    for (int c = 0; c < 3; ++c)
      cell[c] =
          static_cast<std::int64_t>(std::clamp(std::floor(p[c] / size_), -kFarthest, kFarthest));
    return cell;
  }

  const std::vector<OpenEdge>& edges_;
  std::span<const Eigen::Vector3f> points_;
  double size_;
  std::unordered_map<Cell, std::vector<std::int32_t>, HashCell> cells_;
};

}  // namespace

std::vector<std::int32_t> weld_equal(std::vector<Eigen::Vector3f>& points) {
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

double rounding_of(std::span<const Eigen::Vector3d> points, const std::vector<bool>& used,
                   double step) {
  constexpr std::size_t kSample = 4096;
  constexpr int kMostDecimals = 9;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kSample);
  const auto shown_with = [&](double per_unit) {
    for (std::size_t i = 0; i < points.size(); i += stride)
      for (int c = 0; c < 3; ++c) {
        const double scaled = points[i][c] * per_unit;
        if (used[i] && std::abs(scaled - std::round(scaled)) > 1e-12 * std::abs(scaled) + 1e-9)
          return false;
      }
    return true;
  };
  double decimal = 1;
  for (int decimals = 0; decimals <= kMostDecimals; ++decimals, decimal /= 10)
    if (shown_with(std::pow(10.0, decimals))) return std::max(decimal, step);
  return step;
}

std::int64_t close_gaps(std::vector<Triangle>& triangles, const EdgeGroups& groups,
                        std::span<const Eigen::Vector3f> points, double distance,
                        double least_edge) {
  const std::vector<OpenEdge> open = open_edges(triangles, groups);
  if (open.empty() || !(distance > 0)) return 0;
  const auto apart = [&](std::int32_t a, std::int32_t b) {
    return (points[a].cast<double>() - points[b].cast<double>()).norm();
  };
  double length = 0;
  for (const OpenEdge& e : open) length += apart(e.from, e.to);
  if (length < least_edge * distance * static_cast<double>(open.size())) return 0;
  const auto inwards = [&](std::size_t e) {
    return Eigen::Vector3d(
        (points[open[e].apex] - points[open[e].from]).cast<double>().stableNormalized() +
        (points[open[e].apex] - points[open[e].to]).cast<double>().stableNormalized());
  };
  // Each edge with its nearest partner, if that is mutual.
  const MiddleGrid grid(open, points, distance);
  std::vector<std::int32_t> nearest(open.size(), kNone);
  for (std::size_t e = 0; e < open.size(); ++e) {
    std::pair<double, std::int32_t> best = {0, kNone};
    // An edge no longer than the gap would collapse.
    if (apart(open[e].from, open[e].to) <= 2 * distance) continue;
    grid.near(e, [&](std::size_t o) {
      if (o == e) return;
      const double one = apart(open[e].from, open[o].to);
      const double two = apart(open[e].to, open[o].from);
      if (one > distance || two > distance) return;
      // The two rims of a thin wall have their faces on the same side, a gap has them on two.
      const Eigen::Vector3d a = inwards(e), b = inwards(o);
      if (a.dot(b) > kSameSide * a.norm() * b.norm()) return;
      const std::pair candidate(one + two, static_cast<std::int32_t>(o));
      if (best.second == kNone || candidate < best) best = candidate;
    });
    nearest[e] = best.second;
  }
  std::vector<std::int32_t> merged(points.size());
  std::iota(merged.begin(), merged.end(), 0);
  const auto root_of = [&](std::int32_t v) {
    while (merged[v] != v) v = merged[v] = merged[merged[v]];
    return v;
  };
  std::int64_t count = 0;
  const auto merge = [&](std::int32_t a, std::int32_t b) {
    a = root_of(a);
    b = root_of(b);
    if (a == b) return;
    merged[std::max(a, b)] = std::min(a, b);
    ++count;
  };
  for (std::size_t e = 0; e < open.size(); ++e) {
    const std::int32_t o = nearest[e];
    if (o == kNone || nearest[o] != static_cast<std::int32_t>(e)) continue;
    merge(open[e].from, open[o].to);
    merge(open[e].to, open[o].from);
  }
  if (count > 0)
    for (Triangle& t : triangles)
      for (std::int32_t& v : t) v = root_of(v);
  return count;
}

}  // namespace semigeo::kernels
