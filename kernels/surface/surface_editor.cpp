#include "kernels/surface/surface_editor.hpp"

#include <algorithm>

#include "kernels/surface/circulators.hpp"

namespace semigeo::kernels {

SurfaceEditor::SurfaceEditor(Connectivity& mesh)
    : mesh_(mesh), face_count_(mesh.face_count()), vertex_count_(mesh.vertex_count()) {}

/// Tells whether the fan of a has at least as many faces as that of b. The cost is that of the
/// smaller fan.
bool SurfaceEditor::larger_fan(std::int32_t a, std::int32_t b) const {
  const std::array<std::int32_t, 2> start = {mesh_.outgoing[a], mesh_.outgoing[b]};
  std::array<std::int32_t, 2> at = start;
  while (true)
    for (const int side : {1, 0}) {
      at[side] = mesh_.ccw(at[side]);
      if (at[side] == kNone || at[side] == start[side]) return side == 1;
    }
}

std::int32_t SurfaceEditor::from_larger_fan(std::int32_t h) const {
  const std::int32_t t = mesh_.twin[h];
  return t == kNone || larger_fan(mesh_.origin(h), mesh_.target(h)) ? h : t;
}

std::int32_t SurfaceEditor::survivor(std::int32_t h) const {
  const std::int32_t a = mesh_.origin(h);
  const std::int32_t b = mesh_.target(h);
  return mesh_.twin[h] != kNone || larger_fan(a, b) ? a : b;
}

SurfaceEditor::Collapse SurfaceEditor::may_collapse(std::int32_t h) const {
  const std::int32_t t = mesh_.twin[h];
  const std::int32_t a = mesh_.origin(h);
  const std::int32_t b = mesh_.target(h);
  const std::int32_t c = mesh_.origin(prev(h));
  const std::int32_t d = t == kNone ? kNone : mesh_.origin(prev(t));
  const auto same_face = [this](std::int32_t g, std::int32_t other) {
    g = mesh_.twin[g];
    other = mesh_.twin[other];
    return g != kNone && other != kNone && face_of(g) == face_of(other);
  };
  if (t == kNone) {
    if (mesh_.twin[next(h)] == kNone && mesh_.twin[prev(h)] == kNone)
      return {Obstacle::kPart, kNone};
  } else {
    if (mesh_.on_boundary(a) && mesh_.on_boundary(b)) return {Obstacle::kChord, kNone};
    // The part is a tetrahedron if it has the faces (b, c, d) and (a, c, d) besides (a, b, c) and
    // (b, a, d).
    if (same_face(next(h), prev(t)) && same_face(prev(h), next(t))) return {Obstacle::kPart, kNone};
  }
  const std::int32_t kept = survivor(h);
  for (const std::int32_t x : neighbours(mesh_, kept == a ? b : a)) {
    if (x == kept || x == c || x == d) continue;
    if (find_edge(mesh_, x, kept) != kNone) return {Obstacle::kCycle, x};
  }
  return {};
}

void SurfaceEditor::unite(std::int32_t h, std::int32_t other) {
  if (h != kNone) mesh_.twin[h] = other;
  if (other != kNone) mesh_.twin[other] = h;
}

/// Closes a face whose edge opposite to a corner is collapsed. The half-edges across its other two
/// edges, one `into` the corner and one `from` it, become twins. `gone` is the half-edge of the
/// face that left the corner. Returns a half-edge that leaves the vertex where the lost edge was,
/// or kNone.
std::int32_t SurfaceEditor::fold(std::int32_t gone, std::int32_t into, std::int32_t from) {
  std::int32_t& outgoing = mesh_.outgoing[mesh_.origin(gone)];
  // On a boundary `gone` had no twin, and `from`, which now has none, is the first of the fan.
  if (outgoing == gone) outgoing = from != kNone ? from : next(into);
  unite(into, from);
  return into != kNone ? into : from != kNone ? next(from) : kNone;
}

void SurfaceEditor::remove_face(std::int32_t f) {
  mesh_.triangles[f] = {kNone, kNone, kNone};
  for (int i = 0; i < 3; ++i) mesh_.twin[halfedge(f, i)] = kNone;
  free_faces_.push_back(f);
  --face_count_;
}

std::int32_t SurfaceEditor::add_face(const Triangle& corners) {
  ++face_count_;
  if (!free_faces_.empty()) {
    const std::int32_t f = free_faces_.back();
    free_faces_.pop_back();
    mesh_.triangles[f] = corners;
    return f;
  }
  mesh_.triangles.push_back(corners);
  mesh_.twin.resize(mesh_.twin.size() + 4, kNone);
  return static_cast<std::int32_t>(mesh_.triangles.size()) - 1;
}

std::int32_t SurfaceEditor::add_vertex(const Birth& birth) {
  ++vertex_count_;
  births_.push_back(birth);
  mesh_.outgoing.push_back(kNone);
  return static_cast<std::int32_t>(mesh_.outgoing.size()) - 1;
}

/// Replaces the vertex of the fan that begins with half-edge `first`.
void SurfaceEditor::move_fan(std::int32_t first, std::int32_t vertex) {
  for (const std::int32_t h : outgoing_from(mesh_, first))
    mesh_.triangles[face_of(h)][corner_of(h)] = vertex;
}

void SurfaceEditor::collapse(std::int32_t h) {
  const std::int32_t t = mesh_.twin[h];
  const std::int32_t kept = survivor(h);
  const std::int32_t gone = kept == mesh_.origin(h) ? mesh_.target(h) : mesh_.origin(h);
  const std::int32_t first = first_after_collapse(h);
  move_fan(mesh_.outgoing[gone], kept);

  // Face (a, b, c) is closed, and then face (b, a, d) on the other side.
  std::int32_t left = fold(prev(h), mesh_.twin[prev(h)], mesh_.twin[next(h)]);
  if (t != kNone) {
    const std::int32_t other = fold(prev(t), mesh_.twin[prev(t)], mesh_.twin[next(t)]);
    if (left == kNone) left = other;
    remove_face(face_of(t));
  }
  remove_face(face_of(h));
  mesh_.outgoing[gone] = kNone;
  mesh_.outgoing[kept] = first != kNone ? first : left;
  --vertex_count_;
}

/// Returns the half-edge with which the fan of the survivor will begin, or kNone if the survivor
/// will not lie on a boundary. It walks no fan, since fans may be large.
std::int32_t SurfaceEditor::first_after_collapse(std::int32_t h) const {
  const std::int32_t t = mesh_.twin[h];
  // If h lies on a boundary, it is the first half-edge of its origin, and is removed.
  std::int32_t first = mesh_.outgoing[mesh_.target(h)];
  if (mesh_.twin[first] != kNone) first = mesh_.outgoing[mesh_.origin(h)];
  if (mesh_.twin[first] != kNone) return kNone;
  // If the first half-edge is removed, the one across the other edge of its face takes its place.
  if (first == next(h)) return mesh_.twin[prev(h)];
  if (t != kNone && first == next(t)) return mesh_.twin[prev(t)];
  return first;
}

bool SurfaceEditor::may_flip(std::int32_t h) const {
  const std::int32_t t = mesh_.twin[h];
  return t != kNone && find_edge(mesh_, mesh_.origin(prev(h)), mesh_.origin(prev(t))) == kNone;
}

std::int32_t SurfaceEditor::flip(std::int32_t h) {
  // The faces (a, b, c) and (b, a, d) become (a, d, c) and (d, b, c).
  const std::int32_t t = mesh_.twin[h];
  const std::int32_t f = face_of(h);
  const std::int32_t g = face_of(t);
  const std::int32_t a = mesh_.origin(h);
  const std::int32_t b = mesh_.target(h);
  const std::int32_t c = mesh_.origin(prev(h));
  const std::int32_t d = mesh_.origin(prev(t));
  // The four half-edges on the outline of the two faces have these old and new slots.
  const std::array<std::int32_t, 4> old = {next(t), prev(h), prev(t), next(h)};
  const std::array<std::int32_t, 4> now = {halfedge(f, 0), halfedge(f, 2), halfedge(g, 0),
                                           halfedge(g, 1)};
  std::array<std::int32_t, 4> across;
  for (int k = 0; k < 4; ++k) across[k] = mesh_.twin[old[k]];
  const std::array<std::int32_t, 4> vertex = {a, c, d, b};
  for (int k = 0; k < 4; ++k) {
    std::int32_t& outgoing = mesh_.outgoing[vertex[k]];
    if (outgoing == old[k] || outgoing == h || outgoing == t) outgoing = now[k];
  }
  mesh_.triangles[f] = {a, d, c};
  mesh_.triangles[g] = {d, b, c};
  for (int k = 0; k < 4; ++k) unite(now[k], across[k]);
  unite(halfedge(f, 1), halfedge(g, 2));
  return halfedge(f, 1);
}

/// Separates the two fans of a vertex: the smaller one gets a copy of the vertex. `starts` are
/// half-edges in the fans, at least one in each. If a fan is open, its first half-edge is among
/// them.
void SurfaceEditor::separate_fans(std::int32_t v, std::span<const std::int32_t> starts) {
  std::vector<std::int32_t> at(starts.begin(), starts.end());
  const auto begins = [this](std::int32_t h) { return mesh_.twin[h] == kNone; };
  // All fans are walked at the same time, until one has been walked completely.
  std::size_t smaller = 0;
  for (bool found = false; !found;)
    for (std::size_t k = 0; k < starts.size() && !found; ++k) {
      if (at[k] == kNone) continue;
      at[k] = mesh_.ccw(at[k]);
      found = at[k] == starts[k] || (at[k] == kNone && begins(starts[k]));
      smaller = k;
    }
  const std::int32_t copy = add_vertex({v});
  mesh_.outgoing[copy] = starts[smaller];
  move_fan(starts[smaller], copy);
  bool open = false;
  for (const std::int32_t start : starts) {
    if (mesh_.origin(start) != v || open) continue;
    mesh_.outgoing[v] = start;
    open = begins(start);
  }
}

std::array<std::int32_t, 2> SurfaceEditor::cut_cycle(std::int32_t a, std::int32_t b,
                                                     std::int32_t c) {
  const std::array<std::int32_t, 3> cycle = {a, b, c};
  // rim[0] has the half-edges along the cycle, rim[1] those against it.
  std::array<std::array<std::int32_t, 3>, 2> rim;
  for (int i = 0; i < 3; ++i) {
    const std::int32_t h = find_edge(mesh_, cycle[i], cycle[(i + 1) % 3]);
    const std::int32_t t = mesh_.twin[h];
    const bool along = mesh_.origin(h) == cycle[i];
    rim[0][i] = along ? h : t;
    rim[1][i] = along ? t : h;
  }
  std::array<std::int32_t, 2> cover = {kNone, kNone};
  std::array<std::array<std::int32_t, 2>, 3> corner;  // half-edges of the covers at each vertex
  for (int side = 0; side < 2; ++side) {
    if (rim[side] == std::array<std::int32_t, 3>{kNone, kNone, kNone}) continue;
    // The cover of one side has the orientation of the other side's rim.
    const std::array<int, 3> order = side == 0 ? std::array{0, 2, 1} : std::array{0, 1, 2};
    cover[side] = add_face({cycle[order[0]], cycle[order[1]], cycle[order[2]]});
    for (int k = 0; k < 3; ++k) {
      const std::int32_t h = halfedge(cover[side], k);
      const int edge = side == 0 ? order[(k + 1) % 3] : order[k];
      corner[order[k]][side] = h;
      unite(h, rim[side][edge]);
    }
  }
  if (cover[0] == kNone || cover[1] == kNone)
    return cover;  // a hole was closed, and no fan was cut in two
  for (int i = 0; i < 3; ++i) {
    // An open fan begins with its old first half-edge, or with an edge of the cover.
    const std::int32_t was = mesh_.outgoing[cycle[i]];
    const std::array starts = {corner[i][0], corner[i][1], was};
    separate_fans(cycle[i], std::span(starts).first(mesh_.twin[was] == kNone ? 3 : 2));
  }
  return cover;
}

void SurfaceEditor::cut_chord(std::int32_t h) {
  const std::int32_t t = mesh_.twin[h];
  const std::int32_t a = mesh_.origin(h);
  const std::int32_t b = mesh_.target(h);
  mesh_.twin[t] = kNone;
  mesh_.twin[h] = kNone;
  separate_fans(a, std::array{mesh_.outgoing[a], h});
  separate_fans(b, std::array{mesh_.outgoing[b], t});
}

std::int32_t SurfaceEditor::split(std::int32_t h) {
  const std::int32_t t = mesh_.twin[h];
  const std::int32_t a = mesh_.origin(h);
  const std::int32_t b = mesh_.target(h);
  const std::int32_t middle = add_vertex({a, b});
  // The face (a, b, c) becomes (a, m, c) and (m, b, c). The target of `g` changes from `end` to m,
  // and the new face takes the edge that started at `end`.
  const auto halve = [&](std::int32_t g) {
    const std::int32_t end = mesh_.target(g);
    const std::int32_t apex = mesh_.origin(prev(g));
    const std::int32_t across = mesh_.twin[next(g)];
    const std::int32_t f = add_face({middle, end, apex});
    mesh_.triangles[face_of(g)][corner_of(next(g))] = middle;
    unite(halfedge(f, 1), across);
    unite(halfedge(f, 2), next(g));
    if (mesh_.outgoing[end] == next(g)) mesh_.outgoing[end] = halfedge(f, 1);
    return halfedge(f, 0);
  };
  const std::int32_t beyond_h = halve(h);
  mesh_.twin[beyond_h] = t;
  if (t != kNone) {
    const std::int32_t beyond_t = halve(t);
    unite(h, beyond_t);
    unite(t, beyond_h);
  }
  mesh_.outgoing[middle] = beyond_h;
  return middle;
}

std::int32_t SurfaceEditor::split_face(std::int32_t face) {
  const auto [a, b, c] = mesh_.triangles[face];
  const std::int32_t v = add_vertex({a, b, c});
  // The face (a, b, c) becomes (a, b, v), (b, c, v) and (c, a, v).
  const std::int32_t across_b = mesh_.twin[halfedge(face, 1)];
  const std::int32_t across_c = mesh_.twin[halfedge(face, 2)];
  mesh_.triangles[face] = {a, b, v};
  const std::int32_t f = add_face({b, c, v});
  const std::int32_t g = add_face({c, a, v});
  unite(halfedge(f, 0), across_b);
  unite(halfedge(g, 0), across_c);
  unite(halfedge(face, 1), halfedge(f, 2));
  unite(halfedge(f, 1), halfedge(g, 2));
  unite(halfedge(g, 1), halfedge(face, 2));
  if (face_of(mesh_.outgoing[b]) == face) mesh_.outgoing[b] = halfedge(f, 0);
  if (face_of(mesh_.outgoing[c]) == face) mesh_.outgoing[c] = halfedge(g, 0);
  mesh_.outgoing[v] = halfedge(face, 2);
  return v;
}

void SurfaceEditor::remove_vertex(std::int32_t v, std::span<const Triangle> cover) {
  fan_.clear();
  for (const std::int32_t h : outgoing(mesh_, v))
    fan_.push_back({face_of(h), mesh_.target(h), mesh_.origin(prev(h)), mesh_.twin[next(h)]});
  for (const FanFace& side : fan_)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(side.face, i);
      if (mesh_.outgoing[mesh_.origin(h)] == h) mesh_.outgoing[mesh_.origin(h)] = kNone;
    }
  for (std::size_t k = 0; k < fan_.size(); ++k) {
    if (k >= cover.size()) {
      remove_face(fan_[k].face);
      continue;
    }
    mesh_.triangles[fan_[k].face] = cover[k];
    for (int i = 0; i < 3; ++i) mesh_.twin[halfedge(fan_[k].face, i)] = kNone;
  }
  --vertex_count_;
  link_cover(cover);
}

/// Sets the twins of the faces that took the first slots of the fan, and the outgoing half-edges of
/// their corners.
void SurfaceEditor::link_cover(std::span<const Triangle> cover) {
  const auto halfedge_from = [&](std::int32_t a, std::int32_t b) {
    for (std::size_t k = 0; k < cover.size(); ++k)
      for (int i = 0; i < 3; ++i)
        if (cover[k][i] == a && cover[k][(i + 1) % 3] == b) return halfedge(fan_[k].face, i);
    return kNone;
  };
  for (const FanFace& side : fan_)
    if (side.across != kNone) unite(halfedge_from(side.from, side.to), side.across);
  for (std::size_t k = 0; k < cover.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(fan_[k].face, i);
      if (mesh_.twin[h] == kNone) mesh_.twin[h] = halfedge_from(mesh_.target(h), mesh_.origin(h));
    }
  for (std::size_t k = 0; k < cover.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(fan_[k].face, i);
      std::int32_t& chosen = mesh_.outgoing[cover[k][i]];
      if (chosen == kNone || mesh_.twin[h] == kNone) chosen = h;
    }
}

SurfaceEditor::Dropped SurfaceEditor::drop_part(std::int32_t face) {
  Dropped dropped;
  std::vector<std::int32_t> pending = {face};
  while (!pending.empty()) {
    const std::int32_t f = pending.back();
    pending.pop_back();
    if (!has_face(f)) continue;
    for (int i = 0; i < 3; ++i) {
      const std::int32_t t = mesh_.twin[halfedge(f, i)];
      if (t != kNone) pending.push_back(face_of(t));
      std::int32_t& outgoing = mesh_.outgoing[mesh_.triangles[f][i]];
      if (outgoing == kNone) continue;
      outgoing = kNone;
      ++dropped.vertices;
    }
    remove_face(f);
    ++dropped.faces;
  }
  vertex_count_ -= dropped.vertices;
  return dropped;
}

}  // namespace semigeo::kernels
