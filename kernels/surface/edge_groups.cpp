#include "kernels/surface/edge_groups.hpp"

#include <algorithm>
#include <utility>

namespace semigeo::kernels {

EdgeGroups group_edges(std::span<const Triangle> triangles, std::int64_t vertex_count) {
  const auto low = [&](std::int32_t h) {
    const auto& t = triangles[face_of(h)];
    return std::min(t[corner_of(h)], t[corner_of(next(h))]);
  };
  const auto high = [&](std::int32_t h) {
    const auto& t = triangles[face_of(h)];
    return std::max(t[corner_of(h)], t[corner_of(next(h))]);
  };

  // A counting sort by the lower vertex comes first, then a small sort by the higher one.
  const auto face_count = static_cast<std::int32_t>(triangles.size());
  std::vector<std::int32_t> bucket(vertex_count + 1, 0);
  for (std::int32_t f = 0; f < face_count; ++f)
    for (int i = 0; i < 3; ++i) ++bucket[low(halfedge(f, i)) + 1];
  for (std::int64_t v = 0; v < vertex_count; ++v) bucket[v + 1] += bucket[v];

  EdgeGroups groups;
  groups.members.resize(3 * triangles.size());
  {
    std::vector<std::int32_t> cursor(bucket.begin(), bucket.end() - 1);
    for (std::int32_t f = 0; f < face_count; ++f)
      for (int i = 0; i < 3; ++i) groups.members[cursor[low(halfedge(f, i))]++] = halfedge(f, i);
  }

  groups.begin.reserve(3 * triangles.size() / 2 + 2);
  for (std::int64_t v = 0; v < vertex_count; ++v) {
    const auto first = groups.members.begin() + bucket[v];
    const auto last = groups.members.begin() + bucket[v + 1];
    std::sort(first, last, [&](std::int32_t a, std::int32_t b) {
      return std::pair(high(a), a) < std::pair(high(b), b);
    });
    for (auto m = first; m != last; ++m)
      if (m == first || high(*m) != high(*(m - 1)))
        groups.begin.push_back(static_cast<std::int32_t>(m - groups.members.begin()));
  }
  groups.begin.push_back(static_cast<std::int32_t>(groups.members.size()));
  return groups;
}

std::vector<std::int32_t> pair_twins(const EdgeGroups& groups, std::size_t face_count) {
  std::vector<std::int32_t> twin(4 * face_count, kNone);
  for (std::int64_t e = 0; e < groups.edge_count(); ++e) {
    const auto members = groups.edge(e);
    if (members.size() != 2) continue;
    twin[members[0]] = members[1];
    twin[members[1]] = members[0];
  }
  return twin;
}

}  // namespace semigeo::kernels
