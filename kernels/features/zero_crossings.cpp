#include "kernels/features/zero_crossings.hpp"

#include <utility>
#include <vector>

namespace semigeo::kernels {
namespace {

bool positive(const CurvatureField& field, std::int32_t v) {
  return field.heights[v] >= 0;
}

bool crossed(const Connectivity& surface, const CurvatureField& field, std::int32_t f) {
  const auto& t = surface.triangles[f];
  if (!field.takes_part(t[0]) || !field.takes_part(t[1]) || !field.takes_part(t[2])) return false;
  const bool first = positive(field, t[0]);
  return positive(field, t[1]) != first || positive(field, t[2]) != first;
}

/// Holds the half-edges through which a contour crosses a face. With positive values to its left,
/// it enters over the half-edge from positive to negative, and leaves over the one that leads back.
struct Passage {
  std::int32_t entry = kNone;
  std::int32_t exit = kNone;
};

Passage passage(const Connectivity& surface, const CurvatureField& field, std::int32_t f) {
  Passage result;
  for (int i = 0; i < 3; ++i) {
    const std::int32_t h = halfedge(f, i);
    const bool from = positive(field, surface.origin(h));
    if (from == positive(field, surface.target(h))) continue;
    (from ? result.entry : result.exit) = h;
  }
  return result;
}

class Tracer {
 public:
  Tracer(const Connectivity& surface, const CurvatureField& field,
         std::span<const std::int32_t> faces)
      : surface_(surface),
        field_(field),
        faces_(faces),
        crossed_(surface.face_count(), false),
        traced_(surface.face_count(), false) {
    contours_.offsets.push_back(0);
    for (const std::int32_t f : faces) crossed_[f] = true;
  }

  Contours trace() {
    for (const bool open : {true, false})
      for (const std::int32_t f : faces_) {
        if (traced_[f]) continue;
        const std::int32_t entry = passage(surface_, field_, f).entry;
        if (!open || !leads_on(entry)) follow(entry);
      }
    return std::move(contours_);
  }

 private:
  /// Tells whether the face across h is one of the faces.
  bool leads_on(std::int32_t h) const {
    const std::int32_t t = surface_.twin[h];
    return t != kNone && crossed_[face_of(t)];
  }

  void add(std::int32_t h) {
    std::int32_t p = surface_.origin(h);
    std::int32_t n = surface_.target(h);
    if (!positive(field_, p)) std::swap(p, n);
    const float a = field_.heights[p];
    const EdgePoint point{p, n, a / (a - field_.heights[n])};
    if (static_cast<std::int32_t>(contours_.points.size()) > contours_.offsets.back() &&
        same(contours_.points.back(), point))
      return;
    contours_.points.push_back(point);
  }

  /// Tells whether both points lie at the same vertex.
  static bool same(const EdgePoint& a, const EdgePoint& b) {
    return a.t == 0 && b.t == 0 && a.positive == b.positive;
  }

  void follow(std::int32_t entry) {
    const std::int32_t first = entry;
    bool closed = false;
    add(entry);
    while (true) {
      const std::int32_t f = face_of(entry);
      traced_[f] = true;
      const std::int32_t exit = passage(surface_, field_, f).exit;
      if (!leads_on(exit)) {
        add(exit);
        break;
      }
      entry = surface_.twin[exit];
      if (entry == first) {
        closed = true;
        break;
      }
      add(entry);
    }
    auto& points = contours_.points;
    const std::int32_t begin = contours_.offsets.back();
    if (closed && static_cast<std::int32_t>(points.size()) - begin > 1 &&
        same(points[begin], points.back()))
      points.pop_back();
    if (static_cast<std::int32_t>(points.size()) - begin < 2) {
      points.resize(begin);
      return;
    }
    contours_.closed.push_back(closed ? 1 : 0);
    contours_.offsets.push_back(static_cast<std::int32_t>(points.size()));
  }

  const Connectivity& surface_;
  const CurvatureField& field_;
  std::span<const std::int32_t> faces_;
  std::vector<bool> crossed_;  ///< Whether a face is one of the faces.
  std::vector<bool> traced_;   ///< Whether a contour was traced through a face.
  Contours contours_;
};

}  // namespace

void find_crossing_faces(const Connectivity& surface, const CurvatureField& field,
                         std::int32_t begin, std::int32_t end, std::vector<std::int32_t>& faces) {
  for (std::int32_t f = begin; f < end; ++f)
    if (crossed(surface, field, f)) faces.push_back(f);
}

Contours trace_contours(const Connectivity& surface, const CurvatureField& field,
                        std::span<const std::int32_t> faces) {
  return Tracer(surface, field, faces).trace();
}

}  // namespace semigeo::kernels
