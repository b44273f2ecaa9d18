#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "kernels/surface/circulators.hpp"

namespace semigeo::tests {

/// The first promise of kernels/surface/connectivity.hpp that the connectivity of a surface breaks,
/// in words; empty if it is sound. Gaps that editing leaves (corners and `outgoing` kNone) are
/// passed over.
inline std::string fault_of(const kernels::Connectivity& s) {
  using namespace kernels;
  const auto name = [](std::int32_t h) { return "half-edge " + std::to_string(h); };
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> directed;
  std::vector<int> corners(s.outgoing.size(), 0);
  if (s.twin.size() != 4 * s.triangles.size()) return "twins do not fit the faces";
  for (std::int32_t f = 0; f < s.face_count(); ++f)
    for (int i = 0; i < 3 && s.triangles[f][0] != kNone; ++i) {
      const std::int32_t h = halfedge(f, i);
      if (s.origin(h) < 0 || s.origin(h) >= static_cast<std::int32_t>(s.outgoing.size()))
        return name(h) + " starts nowhere";
      if (s.origin(h) == s.target(h)) return name(h) + " is a loop";
      if (!directed.emplace(std::pair(s.origin(h), s.target(h)), h).second)
        return name(h) + " is there twice";
      ++corners[s.origin(h)];
    }
  for (const auto& [ends, h] : directed) {
    const auto back = directed.find({ends.second, ends.first});
    const std::int32_t wanted = back == directed.end() ? kNone : back->second;
    if (s.twin[h] != wanted) return name(h) + " has the wrong twin";
  }
  for (std::size_t v = 0; v < s.outgoing.size(); ++v) {
    const std::string vertex = "vertex " + std::to_string(v);
    const std::int32_t start = s.outgoing[v];
    if (start == kNone) {
      if (corners[v] != 0) return vertex + " has faces, but nothing leaves it";
      continue;
    }
    if (s.triangles[face_of(start)][0] == kNone) return vertex + " leads into a gap";
    int met = 0;
    for (const std::int32_t h : outgoing(s, static_cast<std::int32_t>(v))) {
      if (s.origin(h) != static_cast<std::int32_t>(v)) return vertex + " is left from elsewhere";
      if (++met > corners[v]) break;
    }
    if (met != corners[v]) return vertex + " has more than one fan, or starts it in the middle";
  }
  return "";
}

/// Vertices - edges + faces.
inline std::int64_t euler_characteristic(const kernels::Connectivity& s) {
  std::int64_t sum = 0;
  for (const std::int32_t h : s.outgoing) sum += h != kernels::kNone;
  for (const auto& t : s.triangles) sum += t[0] != kernels::kNone;
  for ([[maybe_unused]] const std::int32_t h : kernels::edges(s)) --sum;
  return sum;
}

}  // namespace semigeo::tests
