#include "kernels/surface/surface_editor.hpp"

#include <algorithm>

namespace semigeo::kernels {

SurfaceEditor::SurfaceEditor(Surface& surface)
    : surface_(surface),
      face_count_(surface.face_count()),
      vertex_count_(static_cast<std::int64_t>(surface.outgoing.size())) {}

/// The edge that joins a and b, as the half-edge in either direction, or kNone: both fans are
/// walked side by side, until the smaller one ends.
std::int32_t SurfaceEditor::between(std::int32_t a, std::int32_t b) const {
  const std::array<std::int32_t, 2> start = {surface_.outgoing[a], surface_.outgoing[b]};
  std::array<std::int32_t, 2> h = start;
  while (true)
    for (int side = 0; side < 2; ++side) {
      const std::int32_t sought = side == 0 ? b : a;
      if (surface_.target(h[side]) == sought) return h[side];
      if (surface_.origin(prev(h[side])) == sought) return prev(h[side]);
      h[side] = surface_.ccw(h[side]);
      if (h[side] == kNone || h[side] == start[side]) return kNone;
    }
}

/// Whether the fan of a has at least as many faces as that of b. Walks the smaller one.
bool SurfaceEditor::larger_fan(std::int32_t a, std::int32_t b) const {
  const std::array<std::int32_t, 2> start = {surface_.outgoing[a], surface_.outgoing[b]};
  std::array<std::int32_t, 2> at = start;
  while (true)
    for (const int side : {1, 0}) {
      at[side] = surface_.ccw(at[side]);
      if (at[side] == kNone || at[side] == start[side]) return side == 1;
    }
}

std::int32_t SurfaceEditor::from_larger_fan(std::int32_t h) const {
  const std::int32_t t = surface_.twin[h];
  return t == kNone || larger_fan(surface_.origin(h), surface_.target(h)) ? h : t;
}

std::int32_t SurfaceEditor::survivor(std::int32_t h) const {
  const std::int32_t a = surface_.origin(h);
  const std::int32_t b = surface_.target(h);
  return surface_.twin[h] != kNone || larger_fan(a, b) ? a : b;
}

SurfaceEditor::Collapse SurfaceEditor::may_collapse(std::int32_t h) const {
  const std::int32_t t = surface_.twin[h];
  const std::int32_t a = surface_.origin(h);
  const std::int32_t b = surface_.target(h);
  const std::int32_t c = surface_.origin(prev(h));
  const std::int32_t d = t == kNone ? kNone : surface_.origin(prev(t));
  const auto same_face = [this](std::int32_t g, std::int32_t other) {
    g = surface_.twin[g];
    other = surface_.twin[other];
    return g != kNone && other != kNone && face_of(g) == face_of(other);
  };
  if (t == kNone) {
    if (surface_.twin[next(h)] == kNone && surface_.twin[prev(h)] == kNone)
      return {Obstacle::part, kNone};
  } else {
    if (surface_.on_boundary(a) && surface_.on_boundary(b)) return {Obstacle::chord, kNone};
    // Faces (b, c, d) and (a, c, d) besides (a, b, c) and (b, a, d): a tetrahedron.
    if (same_face(next(h), prev(t)) && same_face(prev(h), next(t))) return {Obstacle::part, kNone};
  }
  Collapse result;
  const std::int32_t kept = survivor(h);
  const auto examine = [&](std::int32_t x) {
    if (x == kept || x == c || x == d || result.obstacle != Obstacle::none) return;
    if (between(x, kept) != kNone) result = {Obstacle::cycle, x};
  };
  each_corner(kept == a ? b : a, [&](std::int32_t g) {
    examine(surface_.target(g));
    if (surface_.twin[prev(g)] == kNone) examine(surface_.origin(prev(g)));
  });
  return result;
}

void SurfaceEditor::unite(std::int32_t h, std::int32_t other) {
  if (h != kNone) surface_.twin[h] = other;
  if (other != kNone) surface_.twin[other] = h;
}

/// A face loses the edge opposite to its corner; the half-edges across its other two edges, one
/// `into` the corner and one `from` it, become twins. `gone` left the corner. result: a half-edge
/// that leaves the vertex where the lost edge was, or kNone.
std::int32_t SurfaceEditor::fold(std::int32_t gone, std::int32_t into, std::int32_t from) {
  std::int32_t& outgoing = surface_.outgoing[surface_.origin(gone)];
  // On a boundary `gone` had no twin, and `from`, which now has none, is the first of the fan.
  if (outgoing == gone) outgoing = from != kNone ? from : next(into);
  unite(into, from);
  return into != kNone ? into : from != kNone ? next(from) : kNone;
}

void SurfaceEditor::remove_face(std::int32_t f) {
  surface_.triangles[f] = {kNone, kNone, kNone};
  for (int i = 0; i < 3; ++i) surface_.twin[halfedge(f, i)] = kNone;
  free_faces_.push_back(f);
  --face_count_;
}

std::int32_t SurfaceEditor::add_face(const std::array<std::int32_t, 3>& corners) {
  ++face_count_;
  if (!free_faces_.empty()) {
    const std::int32_t f = free_faces_.back();
    free_faces_.pop_back();
    surface_.triangles[f] = corners;
    return f;
  }
  surface_.triangles.push_back(corners);
  surface_.twin.resize(surface_.twin.size() + 4, kNone);
  return static_cast<std::int32_t>(surface_.triangles.size()) - 1;
}

std::int32_t SurfaceEditor::add_vertex(const Birth& birth) {
  ++vertex_count_;
  births_.push_back(birth);
  surface_.outgoing.push_back(kNone);
  return static_cast<std::int32_t>(surface_.outgoing.size()) - 1;
}

void SurfaceEditor::collapse(std::int32_t h) {
  const std::int32_t t = surface_.twin[h];
  const std::int32_t kept = survivor(h);
  const std::int32_t gone = kept == surface_.origin(h) ? surface_.target(h) : surface_.origin(h);
  const std::int32_t first = first_after_collapse(h);
  std::int32_t corner = surface_.outgoing[gone];
  const std::int32_t start = corner;
  do {
    surface_.triangles[face_of(corner)][corner_of(corner)] = kept;
    corner = surface_.ccw(corner);
  } while (corner != kNone && corner != start);

  // Face (a, b, c), and (b, a, d) on the other side.
  std::int32_t left = fold(prev(h), surface_.twin[prev(h)], surface_.twin[next(h)]);
  if (t != kNone) {
    const std::int32_t other = fold(prev(t), surface_.twin[prev(t)], surface_.twin[next(t)]);
    if (left == kNone) left = other;
    remove_face(face_of(t));
  }
  remove_face(face_of(h));
  surface_.outgoing[gone] = kNone;
  surface_.outgoing[kept] = first != kNone ? first : left;
  --vertex_count_;
}

/// The half-edge with which the fan of the survivor will begin if that lies on a boundary, else
/// kNone. Nothing is walked: the fan may be large.
std::int32_t SurfaceEditor::first_after_collapse(std::int32_t h) const {
  const std::int32_t t = surface_.twin[h];
  // On a boundary h itself is the first of its origin, and goes.
  std::int32_t first = surface_.outgoing[surface_.target(h)];
  if (surface_.twin[first] != kNone) first = surface_.outgoing[surface_.origin(h)];
  if (surface_.twin[first] != kNone) return kNone;
  // The edge closes up with that of the face's other side.
  if (first == next(h)) return surface_.twin[prev(h)];
  if (t != kNone && first == next(t)) return surface_.twin[prev(t)];
  return first;
}

bool SurfaceEditor::may_flip(std::int32_t h) const {
  const std::int32_t t = surface_.twin[h];
  return t != kNone && between(surface_.origin(prev(h)), surface_.origin(prev(t))) == kNone;
}

std::int32_t SurfaceEditor::flip(std::int32_t h) {
  // (a, b, c) and (b, a, d) become (a, d, c) and (d, b, c).
  const std::int32_t t = surface_.twin[h];
  const std::int32_t f = face_of(h);
  const std::int32_t g = face_of(t);
  const std::int32_t a = surface_.origin(h);
  const std::int32_t b = surface_.target(h);
  const std::int32_t c = surface_.origin(prev(h));
  const std::int32_t d = surface_.origin(prev(t));
  // The four half-edges round them, where they were and where they will be.
  const std::array<std::int32_t, 4> old = {next(t), prev(h), prev(t), next(h)};
  const std::array<std::int32_t, 4> now = {halfedge(f, 0), halfedge(f, 2), halfedge(g, 0),
                                           halfedge(g, 1)};
  std::array<std::int32_t, 4> across;
  for (int k = 0; k < 4; ++k) across[k] = surface_.twin[old[k]];
  const std::array<std::int32_t, 4> vertex = {a, c, d, b};
  for (int k = 0; k < 4; ++k) {
    std::int32_t& outgoing = surface_.outgoing[vertex[k]];
    if (outgoing == old[k] || outgoing == h || outgoing == t) outgoing = now[k];
  }
  surface_.triangles[f] = {a, d, c};
  surface_.triangles[g] = {d, b, c};
  for (int k = 0; k < 4; ++k) unite(now[k], across[k]);
  unite(halfedge(f, 1), halfedge(g, 2));
  return halfedge(f, 1);
}

/// A vertex has come to have two fans: the smaller one gets a copy of it. `starts` lie in the fans,
/// at least one in each; if a fan is open, the half-edge with which it begins is among them.
void SurfaceEditor::separate_fans(std::int32_t v, std::span<const std::int32_t> starts) {
  std::vector<std::int32_t> at(starts.begin(), starts.end());
  const auto begins = [this](std::int32_t h) { return surface_.twin[h] == kNone; };
  // Side by side, until one has been all the way round.
  std::size_t smaller = 0;
  for (bool found = false; !found;)
    for (std::size_t k = 0; k < starts.size() && !found; ++k) {
      if (at[k] == kNone) continue;
      at[k] = surface_.ccw(at[k]);
      found = at[k] == starts[k] || (at[k] == kNone && begins(starts[k]));
      smaller = k;
    }
  const std::int32_t copy = add_vertex({v, kNone});
  surface_.outgoing[copy] = starts[smaller];
  std::int32_t h = starts[smaller];
  do {
    surface_.triangles[face_of(h)][corner_of(h)] = copy;
    h = surface_.ccw(h);
  } while (h != kNone && h != starts[smaller]);
  bool open = false;
  for (const std::int32_t start : starts) {
    if (surface_.origin(start) != v || open) continue;
    surface_.outgoing[v] = start;
    open = begins(start);
  }
}

std::array<std::int32_t, 2> SurfaceEditor::cut_cycle(std::int32_t a, std::int32_t b,
                                                     std::int32_t c) {
  const std::array<std::int32_t, 3> cycle = {a, b, c};
  // Half-edges along the cycle, and those against it.
  std::array<std::array<std::int32_t, 3>, 2> rim;
  for (int i = 0; i < 3; ++i) {
    const std::int32_t h = between(cycle[i], cycle[(i + 1) % 3]);
    const std::int32_t t = surface_.twin[h];
    const bool along = surface_.origin(h) == cycle[i];
    rim[0][i] = along ? h : t;
    rim[1][i] = along ? t : h;
  }
  std::array<std::int32_t, 2> cover = {kNone, kNone};
  std::array<std::array<std::int32_t, 2>, 3> corner;  // of the covers, at each vertex
  for (int side = 0; side < 2; ++side) {
    if (rim[side] == std::array<std::int32_t, 3>{kNone, kNone, kNone}) continue;
    // The cover of one side runs as the rim of the other: corner i of the second leaves cycle[i].
    const std::array<int, 3> order = side == 0 ? std::array{0, 2, 1} : std::array{0, 1, 2};
    cover[side] = add_face({cycle[order[0]], cycle[order[1]], cycle[order[2]]});
    for (int k = 0; k < 3; ++k) {
      const std::int32_t h = halfedge(cover[side], k);
      const int edge = side == 0 ? order[(k + 1) % 3] : order[k];
      corner[order[k]][side] = h;
      unite(h, rim[side][edge]);
    }
  }
  if (cover[0] == kNone || cover[1] == kNone) return cover;  // a hole closed, no fan in two
  for (int i = 0; i < 3; ++i) {
    // An open fan begins where it did, or with the cover's own edge.
    const std::int32_t was = surface_.outgoing[cycle[i]];
    const std::array starts = {corner[i][0], corner[i][1], was};
    separate_fans(cycle[i], std::span(starts).first(surface_.twin[was] == kNone ? 3 : 2));
  }
  return cover;
}

void SurfaceEditor::cut_chord(std::int32_t h) {
  const std::int32_t t = surface_.twin[h];
  const std::int32_t a = surface_.origin(h);
  const std::int32_t b = surface_.target(h);
  surface_.twin[t] = kNone;
  surface_.twin[h] = kNone;
  separate_fans(a, std::array{surface_.outgoing[a], h});
  separate_fans(b, std::array{surface_.outgoing[b], t});
}

std::int32_t SurfaceEditor::split(std::int32_t h) {
  const std::int32_t t = surface_.twin[h];
  const std::int32_t a = surface_.origin(h);
  const std::int32_t b = surface_.target(h);
  const std::int32_t middle = add_vertex({a, b});
  // (a, b, c) becomes (a, m, c) and (m, b, c): `g` goes from `end` to m, the new face takes the
  // edge that left its target.
  const auto halve = [&](std::int32_t g) {
    const std::int32_t end = surface_.target(g);
    const std::int32_t apex = surface_.origin(prev(g));
    const std::int32_t across = surface_.twin[next(g)];
    const std::int32_t f = add_face({middle, end, apex});
    surface_.triangles[face_of(g)][corner_of(next(g))] = middle;
    unite(halfedge(f, 1), across);
    unite(halfedge(f, 2), next(g));
    if (surface_.outgoing[end] == next(g)) surface_.outgoing[end] = halfedge(f, 1);
    return halfedge(f, 0);
  };
  const std::int32_t beyond_h = halve(h);
  surface_.twin[beyond_h] = t;
  if (t != kNone) {
    const std::int32_t beyond_t = halve(t);
    unite(h, beyond_t);
    unite(t, beyond_h);
  }
  surface_.outgoing[middle] = beyond_h;
  return middle;
}

SurfaceEditor::Dropped SurfaceEditor::drop_part(std::int32_t face) {
  Dropped dropped;
  std::vector<std::int32_t> pending = {face};
  while (!pending.empty()) {
    const std::int32_t f = pending.back();
    pending.pop_back();
    if (!has_face(f)) continue;
    for (int i = 0; i < 3; ++i) {
      const std::int32_t t = surface_.twin[halfedge(f, i)];
      if (t != kNone) pending.push_back(face_of(t));
      std::int32_t& outgoing = surface_.outgoing[surface_.triangles[f][i]];
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
