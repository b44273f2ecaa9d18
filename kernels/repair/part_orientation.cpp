#include "kernels/repair/part_orientation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kernels/surface/circulators.hpp"

namespace semigeo::kernels {
namespace {

/// The distance from the middle of a part, in median distances, beyond which points are drawn in.
constexpr double kFar = 4;
/// The number of vertices of a part that its middle is taken from.
constexpr std::int32_t kSample = 999;

struct Part {
  Eigen::AlignedBox3d box;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< Median of each coordinate.
  double radius = 0;                                 ///< Median distance from the middle.
  double volume = 0;  ///< Six times the enclosed volume. It means nothing for an open part.
  bool closed = true;
  std::int64_t along = 0;    ///< Number of faces that look along the normals of their corners.
  std::int64_t against = 0;  ///< Number of faces that look the other way.
};

double median(std::vector<double>& values) {
  const auto at = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Finds the middle and the radius of each part, by medians over some of its vertices, so that a
/// few vertices far out do not move them.
void find_middles(const Surface& surface, std::vector<Part>& parts) {
  std::vector<std::int32_t> count(parts.size(), 0);
  for (const std::int32_t p : surface.part) ++count[p];
  std::vector<std::vector<std::int32_t>> sample(parts.size());
  std::vector<std::int32_t> seen(parts.size(), 0);
  for (std::int32_t v = 0; v < surface.vertex_count(); ++v) {
    const std::int32_t p = surface.part[v];
    if (seen[p]++ % (count[p] / kSample + 1) == 0) sample[p].push_back(v);
  }
  std::vector<double> values;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto median_of = [&](const auto& value) {
      values.clear();
      for (const std::int32_t v : sample[p]) values.push_back(value(surface.points[v]));
      return median(values);
    };
    for (int c = 0; c < 3; ++c)
      parts[p].middle[c] =
          median_of([c](const Eigen::Vector3f& q) { return static_cast<double>(q[c]); });
    parts[p].radius = median_of(
        [&](const Eigen::Vector3f& q) { return (q.cast<double>() - parts[p].middle).norm(); });
  }
}

/// Measures all parts. The volume is that of the part with its far points drawn in towards the
/// middle: one vertex far out, on the wrong side, may otherwise outweigh all others.
std::vector<Part> measure(const Surface& surface, std::span<const Eigen::Vector3f> normals) {
  std::vector<Part> parts(surface.part_count);
  find_middles(surface, parts);
  for (std::int32_t f = 0; f < surface.face_count(); ++f) {
    const Triangle& t = surface.triangles[f];
    Part& part = parts[surface.part[t[0]]];
    std::array<Eigen::Vector3d, 3> p;
    for (int i = 0; i < 3; ++i) {
      part.box.extend(surface.points[t[i]].cast<double>());
      part.closed = part.closed && surface.twin[halfedge(f, i)] != kNone;
      p[i] = surface.points[t[i]].cast<double>() - part.middle;
      const double distance = p[i].norm();
      if (distance > kFar * part.radius) p[i] *= kFar * part.radius / distance;
    }
    part.volume += p[0].dot(p[1].cross(p[2]));
    if (normals.empty()) continue;
    const Eigen::Vector3f normal = normals[t[0]] + normals[t[1]] + normals[t[2]];
    const double side = normal.cast<double>().dot((p[1] - p[0]).cross(p[2] - p[0]));
    part.along += side > 0;
    part.against += side < 0;
  }
  return parts;
}

/// Tells which of some points lie inside a closed part, by the parity of the faces above them.
/// Faces are looked up by their place seen from above.
class Inside {
 public:
  Inside(const Surface& surface, std::int32_t part, const Eigen::AlignedBox3d& box)
      : surface_(surface), box_(box) {
    for (std::int32_t f = 0; f < surface.face_count(); ++f)
      if (surface.part[surface.triangles[f][0]] == part) faces_.push_back(f);
    cells_ =
        std::clamp(static_cast<int>(std::sqrt(static_cast<double>(faces_.size()) / 2)), 1, 512);
    begin_.assign(static_cast<std::size_t>(cells_) * cells_ + 1, 0);
    for (const bool filling : {false, true}) {
      for (const std::int32_t f : faces_) visit_cells(f, filling);
      if (filling) break;
      for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
      in_cell_.resize(begin_.back());
      cursor_.assign(begin_.begin(), begin_.end() - 1);
    }
  }

  bool contains(Eigen::Vector3d p) const {
    // Beside the point by less than matters, so that the ray meets no edge.
    p.x() += 1.2345e-9 * box_.sizes().x();
    p.y() += 2.7182e-9 * box_.sizes().y();
    const std::size_t cell =
        cell_at(p.x(), 0) * static_cast<std::size_t>(cells_) + cell_at(p.y(), 1);
    bool inside = false;
    for (std::int64_t k = begin_[cell]; k < begin_[cell + 1]; ++k)
      inside ^= is_below(p, in_cell_[k]);
    return inside;
  }

 private:
  Eigen::Vector3d corner(std::int32_t f, int i) const {
    return surface_.points[surface_.triangles[f][i]].cast<double>();
  }
  std::size_t cell_at(double x, int axis) const {
    const double share = (x - box_.min()[axis]) / std::max(box_.sizes()[axis], 1e-300);
    return static_cast<std::size_t>(std::clamp(static_cast<int>(share * cells_), 0, cells_ - 1));
  }
  void visit_cells(std::int32_t f, bool filling) {
    Eigen::AlignedBox3d of_face;
    for (int i = 0; i < 3; ++i) of_face.extend(corner(f, i));
    for (auto x = cell_at(of_face.min().x(), 0); x <= cell_at(of_face.max().x(), 0); ++x)
      for (auto y = cell_at(of_face.min().y(), 1); y <= cell_at(of_face.max().y(), 1); ++y) {
        const std::size_t cell = x * static_cast<std::size_t>(cells_) + y;
        if (filling)
          in_cell_[cursor_[cell]++] = f;
        else
          ++begin_[cell + 1];
      }
  }
  /// Tells whether the ray from p upwards (along z) meets the face.
  bool is_below(const Eigen::Vector3d& p, std::int32_t f) const {
    const std::array<Eigen::Vector3d, 3> q = {corner(f, 0) - p, corner(f, 1) - p, corner(f, 2) - p};
    const auto turn = [&](int a, int b) { return q[a].x() * q[b].y() - q[a].y() * q[b].x(); };
    const double w0 = turn(1, 2), w1 = turn(2, 0), w2 = turn(0, 1);
    if ((w0 > 0) != (w1 > 0) || (w1 > 0) != (w2 > 0)) return false;
    const double sum = w0 + w1 + w2;
    return sum != 0 && (w0 * q[0].z() + w1 * q[1].z() + w2 * q[2].z()) / sum > 0;
  }

  const Surface& surface_;
  Eigen::AlignedBox3d box_;
  std::vector<std::int32_t> faces_;
  int cells_ = 1;
  std::vector<std::int64_t> begin_, cursor_;
  std::vector<std::int32_t> in_cell_;
};

/// Tells which parts lie inside which.
class Nesting {
 public:
  Nesting(const Surface& surface, const std::vector<Part>& parts)
      : surface_(surface), parts_(parts), a_vertex_(parts.size(), kNone) {
    for (std::int32_t v = 0; v < surface.vertex_count(); ++v) a_vertex_[surface.part[v]] = v;
  }

  /// Returns the candidates that lie inside a closed part.
  std::vector<std::size_t> within(std::size_t outer,
                                  const std::vector<std::size_t>& candidates) const {
    std::vector<std::size_t> found;
    for (const std::size_t p : candidates)
      if (p != outer && parts_[outer].box.contains(parts_[p].box)) found.push_back(p);
    if (found.empty()) return found;
    const Inside around(surface_, static_cast<std::int32_t>(outer), parts_[outer].box);
    std::erase_if(found, [&](std::size_t p) {
      return !around.contains(surface_.points[a_vertex_[p]].cast<double>());
    });
    return found;
  }

 private:
  const Surface& surface_;
  const std::vector<Part>& parts_;
  std::vector<std::int32_t> a_vertex_;
};

/// Returns the closed parts that are inside out. A part that encloses a negative volume is, unless
/// it lies inside another one, where it may be the wall of a cavity. A body all of whose faces look
/// the wrong way is turned as a whole: of the parts inside an outermost one that is turned, those
/// whose volume then has the wrong sign for the number of parts around them are turned with it.
std::vector<std::size_t> inverted(const Surface& surface, const std::vector<Part>& parts) {
  std::vector<std::size_t> closed;
  std::vector<std::size_t> outermost;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!parts[p].closed) continue;
    closed.push_back(p);
    if (parts[p].volume < 0) outermost.push_back(p);
  }
  if (outermost.empty()) return {};
  const Nesting nesting(surface, parts);
  for (const std::size_t outer : closed) {
    const std::vector<std::size_t> inner = nesting.within(outer, outermost);
    std::erase_if(outermost, [&](std::size_t p) { return std::ranges::binary_search(inner, p); });
  }
  std::vector<std::size_t> result = outermost;
  for (const std::size_t outer : outermost) {
    const std::vector<std::size_t> inner = nesting.within(outer, closed);
    std::vector<int> around(parts.size(), 1);
    for (const std::size_t middle : inner)
      for (const std::size_t p : nesting.within(middle, inner)) ++around[p];
    for (const std::size_t p : inner)
      if ((parts[p].volume > 0) == (around[p] % 2 == 1)) result.push_back(p);
  }
  return result;
}

}  // namespace

std::int64_t turn_inverted_parts(Surface& surface, std::span<const Eigen::Vector3f> normals) {
  const std::vector<Part> parts = measure(surface, normals);
  std::vector<bool> turned(parts.size(), false);
  for (const std::size_t p : inverted(surface, parts)) turned[p] = true;
  for (std::size_t p = 0; p < parts.size(); ++p)
    if (!parts[p].closed && parts[p].against > parts[p].along) turned[p] = true;
  const std::int64_t count = std::ranges::count(turned, true);
  if (count == 0) return 0;
  // Corners 1 and 2 change places, and with them half-edges 0 and 2.
  const auto renamed = [](std::int32_t h) { return (h & 1) == 0 ? h ^ 2 : h; };
  for (std::int32_t f = 0; f < surface.face_count(); ++f) {
    Triangle& t = surface.triangles[f];
    if (!turned[surface.part[t[0]]]) continue;
    std::swap(t[1], t[2]);
    std::swap(surface.twin[halfedge(f, 0)], surface.twin[halfedge(f, 2)]);
    for (int i = 0; i < 3; ++i) {
      std::int32_t& twin = surface.twin[halfedge(f, i)];
      twin = renamed(twin);  // of the same part, which is turned as a whole; kNone stays
    }
  }
  choose_outgoing(surface, surface.vertex_count());
  return count;
}

}  // namespace semigeo::kernels
