#pragma once

#include <cstdint>

namespace semigeo::kernels {

/// Counts what remeshing did to a surface.
struct RemeshCounts {
  std::int64_t flipped = 0;        ///< Edges turned to the other diagonal of their two faces.
  std::int64_t split = 0;          ///< Edges halved by a new vertex.
  std::int64_t collapsed = 0;      ///< Edges whose ends became one vertex.
  std::int64_t torn = 0;           ///< Necks, handles and strips that were cut.
  std::int64_t inserted = 0;       ///< New vertices: in halved edges, along cuts.
  std::int64_t removed = 0;        ///< Lost vertices: collapsed, or dropped with a part.
  std::int64_t dropped_parts = 0;  ///< Parts removed: shrunk, or too small for a patch.
  std::int64_t dropped_faces = 0;  ///< Faces of those parts.

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
