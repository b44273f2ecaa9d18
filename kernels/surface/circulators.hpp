#pragma once

#include <cstdint>
#include <iterator>

#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// A range that begins at an iterator and ends where the iterator says so.
template <typename Iterator>
struct Circulation {
  Iterator first;

  Iterator begin() const { return first; }
  std::default_sentinel_t end() const { return {}; }
};

/// Visits half-edges that leave a vertex, anticlockwise; see `outgoing`.
class OutgoingIterator {
 public:
  OutgoingIterator(const Connectivity& mesh, std::int32_t start)
      : mesh_(&mesh), start_(start), h_(start) {}
  std::int32_t operator*() const { return h_; }
  OutgoingIterator& operator++() {
    h_ = mesh_->ccw(h_);
    if (h_ == start_) h_ = kNone;
    return *this;
  }
  bool operator==(std::default_sentinel_t) const { return h_ == kNone; }

 private:
  const Connectivity* mesh_;
  std::int32_t start_;
  std::int32_t h_;  ///< kNone at the end.
};

/// Visits the vertices that an edge joins to a vertex, anticlockwise; see `neighbours`.
class NeighbourIterator {
 public:
  NeighbourIterator(const Connectivity& mesh, std::int32_t start)
      : mesh_(&mesh), start_(start), h_(start) {}
  std::int32_t operator*() const { return past_boundary_ ? mesh_->origin(h_) : mesh_->target(h_); }
  NeighbourIterator& operator++() {
    const std::int32_t entering = prev(h_);
    h_ = past_boundary_ ? kNone : mesh_->twin[entering];
    if (h_ == start_) {
      h_ = kNone;
    } else if (h_ == kNone && !past_boundary_) {
      // No half-edge leaves along the last edge of an open fan.
      h_ = entering;
      past_boundary_ = true;
    }
    return *this;
  }
  bool operator==(std::default_sentinel_t) const { return h_ == kNone; }

 private:
  const Connectivity* mesh_;
  std::int32_t start_;
  std::int32_t h_;              ///< kNone at the end.
  bool past_boundary_ = false;  ///< Whether `h_` enters the vertex instead of leaving it.
};

/// Visits the edges of a range of faces; see `edges`.
class EdgeIterator {
 public:
  EdgeIterator(const Connectivity& mesh, std::int32_t first, std::int32_t end)
      : mesh_(&mesh), h_(first), end_(end) {
    skip();
  }
  std::int32_t operator*() const { return h_; }
  EdgeIterator& operator++() {
    step();
    skip();
    return *this;
  }
  bool operator==(std::default_sentinel_t) const { return h_ == end_; }

 private:
  void step() { h_ += corner_of(h_) == 2 ? 2 : 1; }
  /// Goes on to the next half-edge that stands for its edge.
  void skip() {
    while (h_ != end_ && (mesh_->twin[h_] > h_ || in_gap())) step();
  }
  bool in_gap() const {
    return mesh_->twin[h_] == kNone && mesh_->triangles[face_of(h_)][0] == kNone;
  }

  const Connectivity* mesh_;
  std::int32_t h_;
  std::int32_t end_;
};

/// Returns the half-edges that leave the origin of `start`, anticlockwise from `start` on, until
/// the fan is closed or ends. The mesh must outlive the range; the loop may rename corners, but not
/// change twins.
inline Circulation<OutgoingIterator> outgoing_from(const Connectivity& mesh, std::int32_t start) {
  return {{mesh, start}};
}

/// Returns the half-edges that leave a vertex, anticlockwise, one for each of its faces. On a
/// boundary the first one has no twin. A vertex that was removed has none. The rules of
/// `outgoing_from` hold.
inline Circulation<OutgoingIterator> outgoing(const Connectivity& mesh, std::int32_t vertex) {
  return outgoing_from(mesh, mesh.outgoing[vertex]);
}

/// Returns the vertices that an edge joins to a vertex, each once, anticlockwise. The first one is
/// the target of the vertex's outgoing half-edge.
inline Circulation<NeighbourIterator> neighbours(const Connectivity& mesh, std::int32_t vertex) {
  return {{mesh, mesh.outgoing[vertex]}};
}

/// Returns the edges that belong to faces `first_face` to `end_face` - 1, each as the half-edge
/// with the larger index of its two, in ascending order. Over all faces every edge comes once.
/// Faces that were removed have none.
inline Circulation<EdgeIterator> edges(const Connectivity& mesh, std::int32_t first_face,
                                       std::int32_t end_face) {
  return {{mesh, halfedge(first_face, 0), halfedge(end_face, 0)}};
}

/// Returns all edges, each once.
inline Circulation<EdgeIterator> edges(const Connectivity& mesh) {
  return edges(mesh, 0, static_cast<std::int32_t>(mesh.face_count()));
}

}  // namespace semigeo::kernels
