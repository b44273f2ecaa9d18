#include "kernels/repair/coincident_faces.hpp"

#include <algorithm>
#include <utility>

namespace semigeo::kernels {
namespace {

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Returns the corners in the same sense, the lowest one first.
Triangle turned_to_lowest(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// Calls visit(first, last) for each set of several faces at the same three places, in ascending
/// order.
template <typename Visit>
void for_each_coincidence(const std::vector<Triangle>& triangles, std::int64_t vertex_count,
                          const Visit& visit) {
  // Faces are put into buckets by their lowest vertex, and sorted within a bucket.
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
  for (std::int64_t v = 0; v < vertex_count; ++v) {
    const auto last = order.begin() + bucket[v + 1];
    std::sort(order.begin() + bucket[v], last, [&](std::int32_t a, std::int32_t b) {
      return std::pair(sorted(triangles[a]), a) < std::pair(sorted(triangles[b]), b);
    });
    for (auto first = order.begin() + bucket[v]; first != last;) {
      const auto end = std::find_if(first, last, [&](std::int32_t f) {
        return sorted(triangles[f]) != sorted(triangles[*first]);
      });
      if (end - first > 1) visit(first, end);
      first = end;
    }
  }
}

/// Returns the number of the connected set of each face (F); faces join at edges that have twins.
std::vector<std::int32_t> face_sets(const std::vector<std::int32_t>& twin, std::size_t face_count) {
  std::vector<std::int32_t> set(face_count, kNone);
  std::vector<std::int32_t> pending;
  std::int32_t count = 0;
  for (std::size_t seed = 0; seed < face_count; ++seed) {
    if (set[seed] != kNone) continue;
    set[seed] = count;
    pending.assign(1, static_cast<std::int32_t>(seed));
    while (!pending.empty()) {
      const std::int32_t f = pending.back();
      pending.pop_back();
      for (int i = 0; i < 3; ++i) {
        const std::int32_t t = twin[halfedge(f, i)];
        if (t == kNone || set[face_of(t)] != kNone) continue;
        set[face_of(t)] = count;
        pending.push_back(face_of(t));
      }
    }
    ++count;
  }
  return set;
}

}  // namespace

void Faces::turn_over(std::size_t f) {
  std::swap(places[f][1], places[f][2]);
  if (!own.empty()) std::swap(own[f][1], own[f][2]);
}

std::int64_t Faces::drop(const std::vector<bool>& marked) {
  std::size_t kept = 0;
  for (std::size_t f = 0; f < places.size(); ++f) {
    if (marked[f]) continue;
    places[kept] = places[f];
    if (!own.empty()) own[kept] = own[f];
    ++kept;
  }
  const std::size_t dropped = places.size() - kept;
  places.resize(kept);
  if (!own.empty()) own.resize(kept);
  return static_cast<std::int64_t>(dropped);
}

std::int64_t drop_degenerate(Faces& faces) {
  std::vector<bool> marked(faces.places.size());
  for (std::size_t f = 0; f < marked.size(); ++f) {
    const Triangle& t = faces.places[f];
    marked[f] = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  }
  return faces.drop(marked);
}

std::int64_t drop_duplicates(Faces& faces, std::int64_t vertex_count) {
  std::vector<bool> duplicate(faces.places.size(), false);
  const auto same = [&](std::int32_t a, std::int32_t b) {
    return turned_to_lowest(faces.places[a]) == turned_to_lowest(faces.places[b]) ||
           sorted(faces.vertices(a)) == sorted(faces.vertices(b));
  };
  const auto joined = [&](std::int32_t a, std::int32_t b) {
    const Triangle &s = faces.vertices(a), &t = faces.vertices(b);
    return std::any_of(s.begin(), s.end(),
                       [&](std::int32_t v) { return std::find(t.begin(), t.end(), v) != t.end(); });
  };
  for_each_coincidence(faces.places, vertex_count, [&](auto first, auto last) {
    for (auto f = first + 1; f != last; ++f)
      duplicate[*f] = std::any_of(
          first, f, [&](std::int32_t earlier) { return !duplicate[earlier] && same(*f, earlier); });
    // At most two are left, back to back.
    const auto front = first;
    const auto back = std::find_if(first + 1, last, [&](std::int32_t f) { return !duplicate[f]; });
    if (back != last && joined(*front, *back)) duplicate[*front] = duplicate[*back] = true;
  });
  return faces.drop(duplicate);
}

std::int64_t drop_backs(Faces& faces, const std::vector<std::int32_t>& twin,
                        std::int64_t vertex_count) {
  std::vector<std::int32_t> back(faces.places.size(), kNone);
  bool any = false;
  for_each_coincidence(faces.places, vertex_count, [&](auto first, auto) {
    back[first[0]] = first[1];
    back[first[1]] = first[0];
    any = true;
  });
  if (!any) return 0;
  struct Set {
    bool open = false;
    bool all_backs = true;  ///< Every face has a back.
    bool within = true;     ///< And it is in the same set.
  };
  const std::vector<std::int32_t> set = face_sets(twin, faces.places.size());
  std::vector<Set> sets(*std::max_element(set.begin(), set.end()) + 1);
  for (std::size_t f = 0; f < back.size(); ++f) {
    Set& s = sets[set[f]];
    s.all_backs = s.all_backs && back[f] != kNone;
    s.within = s.within && back[f] != kNone && set[back[f]] == set[f];
    for (int i = 0; i < 3; ++i)
      s.open = s.open || twin[halfedge(static_cast<std::int32_t>(f), i)] == kNone;
  }
  std::vector<bool> marked(back.size(), false);
  for (std::size_t f = 0; f < back.size(); ++f) {
    const Set& s = sets[set[f]];
    if (s.within)
      marked[f] = back[f] < static_cast<std::int32_t>(f);
    else if (s.open && s.all_backs)
      marked[f] = !marked[back[f]];
  }
  return faces.drop(marked);
}

}  // namespace semigeo::kernels
