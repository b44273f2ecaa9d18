#include "kernels/repair/decimation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "kernels/repair/vertex_removal.hpp"

namespace semigeo::kernels {
namespace {

/// The distance of a vertex counts as at least this share of its mean edge length. So small regions
/// come first where the surface is flat.
constexpr double kSizeMatters = 1e-6;
/// The factor by which a removal may move the surface farther than its key. A removal that moves it
/// farther goes back into the queue with its true key, if there is no tolerance.
constexpr double kPatience = 1.5;

class Decimation {
 public:
  Decimation(const Surface& surface, const DecimationOptions& options)
      : surface_(surface),
        options_(options),
        thinning_(surface),
        version_(surface.points.size(), 0),
        first_covered_(surface.triangles.size(), kNone),
        next_covered_(surface.points.size(), kNone),
        covered_at_(surface.points.size(), 0.0f) {}

  void run() {
    const auto vertices = static_cast<std::int32_t>(surface_.vertex_count());
    {
      std::vector<Candidate> all;
      for (std::int32_t v = 0; v < vertices; ++v) {
        thinning_.examine(v, region_);
        const double key = key_of(region_);
        if (key <= options_.tolerance) all.push_back({static_cast<float>(key), v, 0});
      }
      queue_ = Queue(std::greater<>(), std::move(all));
    }
    left_ = vertices;
    while (!queue_.empty() && left_ > options_.target_vertices) {
      const Candidate candidate = queue_.top();
      queue_.pop();
      if (candidate.version == version_[candidate.vertex]) try_to_remove(candidate);
    }
  }

  DecimatedSurface result() const {
    DecimatedSurface result;
    result.surface = thinning_.compacted(result.source_vertex);
    result.removed_vertices = surface_.vertex_count() - result.surface.vertex_count();
    result.removed_faces = surface_.face_count() - result.surface.face_count();
    if (options_.measure) result.distance = measure(result);
    return result;
  }

 private:
  struct Candidate {
    float key;
    std::int32_t vertex;
    std::uint32_t version;
    bool operator>(const Candidate& other) const {
      return key != other.key ? key > other.key : vertex > other.vertex;
    }
  };
  using Queue = std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>>;

  static double key_of(const ThinningSurface::Region& region) {
    return std::max(region.distance, kSizeMatters * region.reach);
  }

  void try_to_remove(const Candidate& candidate) {
    const std::int32_t v = candidate.vertex;
    thinning_.examine(v, region_);
    const auto cover = thinning_.cover(region_);
    if (cover.empty()) return;
    const double error = find_covering_faces(cover);
    if (!(error <= options_.tolerance)) return;
    if (std::isinf(options_.tolerance) && error > kPatience * candidate.key) {
      queue_.push({static_cast<float>(error), v, version_[v]});
      return;
    }
    thinning_.replace(region_, cover);
    for (const std::int32_t h : region_.spokes) first_covered_[face_of(h)] = kNone;
    for (const Covered& c : covered_) {
      std::int32_t& first = first_covered_[face_of(region_.spokes[c.face])];
      next_covered_[c.vertex] = first;
      first = c.vertex;
      covered_at_[c.vertex] = c.distance;
    }
    ++version_[v];
    --left_;
    const std::vector<std::int32_t>& ring = region_.ring;
    for (const std::int32_t w : ring) {
      thinning_.examine(w, neighbour_);
      ++version_[w];
      const double key = key_of(neighbour_);
      if (key <= options_.tolerance) queue_.push({static_cast<float>(key), w, version_[w]});
    }
  }

  /// Collects the vertex itself and all removed vertices that its faces cover. Each gets the
  /// nearest face of the new cover. Returns the largest distance.
  double find_covering_faces(std::span<const Triangle> cover) {
    covered_.assign(1, {region_.vertex, 0, 0.0f});
    for (const std::int32_t h : region_.spokes)
      for (std::int32_t w = first_covered_[face_of(h)]; w != kNone; w = next_covered_[w])
        covered_.push_back({w, 0, 0.0f});
    corners_.clear();
    for (const auto& t : cover)
      for (const std::int32_t v : t) corners_.push_back(thinning_.point(v).cast<double>());
    double largest = 0;
    for (Covered& c : covered_) {
      const Eigen::Vector3d p = surface_.points[c.vertex].cast<double>();
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < cover.size(); ++k) {
        const double distance2 =
            (p - nearest_on_triangle(p, corners_[3 * k], corners_[3 * k + 1], corners_[3 * k + 2]))
                .squaredNorm();
        if (!(distance2 < nearest)) continue;
        nearest = distance2;
        c.face = static_cast<std::int32_t>(k);
      }
      c.distance = static_cast<float>(std::sqrt(nearest));
      largest = std::max(largest, std::sqrt(nearest));
      if (!(largest <= options_.tolerance)) break;
    }
    return largest;
  }

  DistanceSummary measure(const DecimatedSurface& decimated) const {
    const NearestSurface nearest(decimated.surface);
    DistanceSummary summary;
    summary.count = surface_.vertex_count();
    auto kept = decimated.source_vertex.begin();
    for (std::int32_t v = 0; v < surface_.vertex_count(); ++v) {
      if (kept != decimated.source_vertex.end() && *kept == v) {
        ++kept;
        continue;
      }
      // The surface is not farther than the face that covers the vertex. The margin is for
      // rounding.
      const double limit = 1.001 * static_cast<double>(covered_at_[v]) + 1e-30;
      const NearestPoint found = nearest.nearest(surface_.points[v].cast<double>(), limit);
      const double distance =
          found.face == kNone ? static_cast<double>(covered_at_[v]) : found.distance;
      summary.maximum = std::max(summary.maximum, distance);
      summary.sum += distance;
    }
    return summary;
  }

  struct Covered {
    std::int32_t vertex;
    std::int32_t face;  ///< Index of the face in the cover.
    float distance;
  };

  const Surface& surface_;
  DecimationOptions options_;
  ThinningSurface thinning_;
  Queue queue_;
  std::vector<std::uint32_t>
      version_;  ///< Version of each vertex' region. Older candidates are void.
  std::vector<std::int32_t> first_covered_;  ///< First removed vertex that each face covers.
  std::vector<std::int32_t> next_covered_;   ///< Next removed vertex under the same face.
  std::vector<float> covered_at_;            ///< Distance of each removed vertex from its face.
  std::int64_t left_ = 0;
  ThinningSurface::Region region_;
  ThinningSurface::Region neighbour_;
  std::vector<Covered> covered_;
  std::vector<Eigen::Vector3d> corners_;
};

}  // namespace

DecimatedSurface decimate(const Surface& surface, const DecimationOptions& options) {
  Decimation decimation(surface, options);
  decimation.run();
  return decimation.result();
}

}  // namespace semigeo::kernels
