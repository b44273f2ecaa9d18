#include "kernels/repair/edge_pairing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "kernels/surface/edge_groups.hpp"

namespace semigeo::kernels {
namespace {

std::int32_t start_of(const std::vector<Triangle>& triangles, std::int32_t h) {
  return triangles[face_of(h)][corner_of(h)];
}

/// Describes one face at an edge of many faces, seen along the edge from its lower vertex.
struct Leaf {
  double angle;        ///< Of the face round the edge.
  bool ends;           ///< The material lies before the face, in the sense of the angle.
  std::int32_t place;  ///< Vertex opposite to the edge: faces at the same place have equal angles.
  std::int32_t halfedge;
};

class Pairing {
 public:
  Pairing(Faces& faces, std::span<const Eigen::Vector3f> points)
      : faces_(faces),
        triangles_(faces.places),
        points_(points),
        groups_(group_edges(triangles_, std::ssize(points))),
        partner_(4 * triangles_.size(), kNone) {}

  PairedEdges pair() {
    for (std::int64_t e = 0; e < groups_.edge_count(); ++e) {
      const auto members = groups_.edge(e);
      if (members.size() == 2)
        join(members[0], members[1]);
      else if (members.size() > 2)
        join_by_own_vertices(members);
    }
    orient();
    groups_ = group_edges(triangles_, std::ssize(points_));
    for (std::int64_t e = 0; e < groups_.edge_count(); ++e) {
      const auto members = groups_.edge(e);
      if (members.size() > 2) {
        join_by_camp(members);
        join_by_angle(members);
      }
      bool cut = members.size() > 2;
      for (const std::int32_t h : members) {
        const std::int32_t p = partner_[h];
        if (p == kNone || start_of(triangles_, h) != start_of(triangles_, p)) continue;
        partner_[h] = partner_[p] = kNone;  // they cannot be oriented alike
        cut = true;
      }
      result_.nonmanifold_edges += cut;
    }
    result_.twin = std::move(partner_);
    return std::move(result_);
  }

 private:
  void join(std::int32_t a, std::int32_t b) {
    partner_[a] = b;
    partner_[b] = a;
  }

  void join_by_own_vertices(std::span<const std::int32_t> members) {
    const auto own_edge = [&](std::int32_t h) {
      const Triangle& t = faces_.vertices(face_of(h));
      const std::int32_t a = t[corner_of(h)];
      const std::int32_t b = t[corner_of(next(h))];
      return std::pair(std::min(a, b), std::max(a, b));
    };
    std::vector<std::int32_t> sorted(members.begin(), members.end());
    std::sort(sorted.begin(), sorted.end(), [&](std::int32_t a, std::int32_t b) {
      return std::pair(own_edge(a), a) < std::pair(own_edge(b), b);
    });
    for (auto first = sorted.begin(); first != sorted.end();) {
      const auto last = std::find_if(
          first, sorted.end(), [&](std::int32_t h) { return own_edge(h) != own_edge(*first); });
      if (last - first == 2) join(first[0], first[1]);
      first = last;
    }
  }

  /// Turns faces over until joined neighbours agree; the larger camp of each connected set of faces
  /// keeps its orientation. A surface that cannot be oriented keeps some disagreement.
  void orient() {
    enum : std::uint8_t { kUnseen, kKeep, kFlip };
    std::vector<std::uint8_t> state(triangles_.size(), kUnseen);
    camp_.resize(triangles_.size());
    std::vector<std::int32_t> camp;
    std::vector<std::int32_t> flipped;
    for (std::size_t seed = 0; seed < triangles_.size(); ++seed) {
      if (state[seed] != kUnseen) continue;
      state[seed] = kKeep;
      camp.assign(1, static_cast<std::int32_t>(seed));
      std::size_t turned = 0;
      for (std::size_t k = 0; k < camp.size(); ++k) {
        const std::int32_t f = camp[k];
        for (int i = 0; i < 3; ++i) {
          const std::int32_t h = halfedge(f, i);
          const std::int32_t p = partner_[h];
          if (p == kNone || state[face_of(p)] != kUnseen) continue;
          // Two faces agree when they run along their edge in opposite directions.
          const bool disagree = start_of(triangles_, h) == start_of(triangles_, p);
          const bool flip = (state[f] == kFlip) != disagree;
          state[face_of(p)] = flip ? kFlip : kKeep;
          turned += flip;
          camp.push_back(face_of(p));
        }
      }
      const auto minority = 2 * turned > camp.size() ? kKeep : kFlip;
      for (const std::int32_t f : camp) {
        camp_[f] = camp.front();
        if (state[f] == minority) flipped.push_back(f);
      }
    }
    for (const std::int32_t f : flipped) turn_over(f);
    result_.flipped_faces = std::ssize(flipped);
  }

  /// Half-edges 0 and 2 of the face change places.
  void turn_over(std::int32_t f) {
    faces_.turn_over(f);
    const std::int32_t a = halfedge(f, 0);
    const std::int32_t b = halfedge(f, 2);
    std::swap(partner_[a], partner_[b]);
    for (const std::int32_t h : {a, b})
      if (partner_[h] != kNone) partner_[partner_[h]] = h;
  }

  /// Joins two of the members that are still alone if no other one belongs to their camp: what is
  /// one surface elsewhere goes on as one.
  void join_by_camp(std::span<const std::int32_t> members) {
    std::vector<std::int32_t> alone;
    for (const std::int32_t h : members)
      if (partner_[h] == kNone) alone.push_back(h);
    std::sort(alone.begin(), alone.end(), [&](std::int32_t a, std::int32_t b) {
      return std::pair(camp_[face_of(a)], a) < std::pair(camp_[face_of(b)], b);
    });
    for (auto first = alone.begin(); first != alone.end();) {
      const auto last = std::find_if(first, alone.end(), [&](std::int32_t h) {
        return camp_[face_of(h)] != camp_[face_of(*first)];
      });
      if (last - first == 2 && start_of(triangles_, first[0]) != start_of(triangles_, first[1]))
        join(first[0], first[1]);
      first = last;
    }
  }

  /// Joins those of the members that are still alone. Round the edge, material begins at one face
  /// and ends at the next; two such faces are joined.
  void join_by_angle(std::span<const std::int32_t> members) {
    std::vector<Leaf> leaves;
    for (const std::int32_t h : members)
      if (partner_[h] == kNone) leaves.push_back(leaf_of(h));
    std::sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) {
      // Where solids touch in a face, one ends before the other begins.
      return std::tuple(a.angle, a.place, !a.ends, a.halfedge) <
             std::tuple(b.angle, b.place, !b.ends, b.halfedge);
    });
    for (bool found = true; found && leaves.size() > 1;) {
      found = false;
      for (std::size_t i = 0; i < leaves.size(); ++i) {
        const std::size_t j = i + 1 < leaves.size() ? i + 1 : 0;
        if (leaves[i].ends || !leaves[j].ends) continue;
        join(leaves[i].halfedge, leaves[j].halfedge);
        leaves.erase(leaves.begin() + static_cast<std::ptrdiff_t>(std::max(i, j)));
        leaves.erase(leaves.begin() + static_cast<std::ptrdiff_t>(std::min(i, j)));
        found = true;
        break;
      }
    }
  }

  Leaf leaf_of(std::int32_t h) const {
    const std::int32_t from = start_of(triangles_, h);
    const std::int32_t to = start_of(triangles_, next(h));
    const std::int32_t apex = start_of(triangles_, prev(h));
    const Eigen::Vector3d low = points_[std::min(from, to)].cast<double>();
    const Eigen::Vector3d axis =
        (points_[std::max(from, to)].cast<double>() - low).stableNormalized();
    const Eigen::Vector3d x = axis.unitOrthogonal();
    const Eigen::Vector3d way = points_[apex].cast<double>() - low;
    // The outside of a face that runs upwards along the edge is where the angle grows.
    return {std::atan2(way.dot(axis.cross(x)), way.dot(x)), from < to, apex, h};
  }

  Faces& faces_;
  const std::vector<Triangle>& triangles_;  ///< Places of the faces.
  std::span<const Eigen::Vector3f> points_;
  EdgeGroups groups_;
  std::vector<std::int32_t> partner_;
  std::vector<std::int32_t> camp_;  ///< First face of the connected set of each face.
  PairedEdges result_;
};

}  // namespace

PairedEdges pair_edges(Faces& faces, std::span<const Eigen::Vector3f> points) {
  return Pairing(faces, points).pair();
}

}  // namespace semigeo::kernels
