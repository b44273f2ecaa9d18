#pragma once

#include <cstdint>

namespace semigeo::kernels {

/// What remeshing did to a surface.
struct RemeshCounts {
  std::int64_t flipped = 0;        ///< edges turned to the other diagonal of their two faces
  std::int64_t split = 0;          ///< edges halved by a new vertex
  std::int64_t collapsed = 0;      ///< edges whose ends became one vertex
  std::int64_t torn = 0;           ///< necks, handles and strips cut
  std::int64_t inserted = 0;       ///< vertices that are new: in halved edges, along cuts
  std::int64_t removed = 0;        ///< vertices that are gone: collapsed, or dropped with a part
  std::int64_t dropped_parts = 0;  ///< parts removed: collapsed, or too small to carry a patch
  std::int64_t dropped_faces = 0;  ///< faces of those

  bool operator==(const RemeshCounts&) const = default;
  RemeshCounts& operator+=(const RemeshCounts& other) {
    flipped += other.flipped;
    split += other.split;
    collapsed += other.collapsed;
    torn += other.torn;
    inserted += other.inserted;
    removed += other.removed;
    dropped_parts += other.dropped_parts;
    dropped_faces += other.dropped_faces;
    return *this;
  }
};

}  // namespace semigeo::kernels
