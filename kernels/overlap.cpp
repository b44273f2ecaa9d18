#include "kernels/overlap.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

struct Cloud {
  const std::vector<Vector3f>* points;
  std::size_t kdtree_get_point_count() const { return points->size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return (*points)[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

/// The one nearest point within a limit; of equally near ones the first.
class NearestWithin {
 public:
  using DistanceType = float;
  explicit NearestWithin(float squared_limit) : squared_(squared_limit) {}
  std::int64_t index() const { return index_; }
  bool addPoint(float squared, std::size_t index) {
    const auto i = static_cast<std::int64_t>(index);
    if (squared < squared_ || (squared == squared_ && i < index_)) {
      squared_ = squared;
      index_ = i;
    }
    return true;
  }
  float worstDist() const { return squared_; }
  bool full() const { return true; }
  std::size_t size() const { return index_ < 0 ? 0 : 1; }

 private:
  float squared_;
  std::int64_t index_ = -1;
};

/// A similarity in single precision, for many points.
struct FastPose {
  Eigen::Matrix3f scaled;
  Eigen::Matrix3f rotation;
  Vector3f translation;
  explicit FastPose(const Similarity& pose)
      : scaled((pose.scale * pose.rotation).cast<float>()),
        rotation(pose.rotation.cast<float>()),
        translation(pose.translation.cast<float>()) {}
  Vector3f point(const Vector3f& p) const { return scaled * p + translation; }
};

std::size_t bounded(std::int64_t count, const SurfaceSamples& samples) {
  return std::min(static_cast<std::size_t>(count), samples.points.size());
}

/// Whether q with normal n, the sample nearest to p, is the surface that p lies on. Samples stand
/// for the surface round them: beside them it goes on.
bool on_surface(const Vector3f& p, const Vector3f& q, const Vector3f& n, float tolerance,
                float spacing) {
  const Vector3f offset = p - q;
  const float height = offset.dot(n);
  if (std::abs(height) > tolerance) return false;
  const float reach = tolerance + spacing;
  return offset.squaredNorm() - height * height <= reach * reach;
}

}  // namespace

struct SampleTree::Tree {
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>,
                                                    Cloud, 3, std::uint32_t>;
  Cloud cloud;
  Index index;
  explicit Tree(const SurfaceSamples& samples)
      : cloud{&samples.points}, index(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(8)) {
    if (!samples.points.empty()) index.buildIndex();
  }
};

SampleTree::SampleTree(const SurfaceSamples& samples)
    : samples_(&samples), tree_(std::make_unique<Tree>(samples)) {}
SampleTree::~SampleTree() = default;
SampleTree::SampleTree(SampleTree&&) noexcept = default;

std::int64_t SampleTree::nearest(const Vector3f& p, float limit, std::int64_t guess) const {
  if (samples_->points.empty()) return -1;
  NearestWithin result(limit * limit);
  if (guess >= 0) {
    const Vector3f offset = p - samples_->points[guess];
    // As the tree sums squares, so that what is equally near stays so.
    const float squared =
        offset.x() * offset.x() + offset.y() * offset.y() + offset.z() * offset.z();
    result.addPoint(squared, static_cast<std::size_t>(guess));
  }
  tree_->index.findNeighbors(result, p.data(), nanoflann::SearchParams());
  return result.index();
}

double Overlap::agreement() const {
  if (match <= 0) return 0;
  const double share = match / (match + conflict);
  return match * closeness * share * share;
}

Overlap overlap(const SurfaceSamples& model, double diagonal, const Similarity& pose,
                const SampleTree& tree, const OverlapOptions& options, std::int64_t count,
                std::span<const std::uint8_t> used) {
  const FastPose fast(pose);
  const SurfaceSamples& scene = tree.samples();
  const double size = diagonal * pose.scale;
  const auto tolerance = static_cast<float>(options.match * size);
  const auto limit = static_cast<float>(options.conflict * size);
  const std::size_t n = bounded(count, model);
  std::int64_t matches = 0;
  std::int64_t conflicts = 0;
  double closeness = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3f p = fast.point(model.points[i]);
    const std::int64_t near = tree.nearest(p, limit + scene.spacing);
    if (near < 0 || (!used.empty() && used[near] != 0)) continue;
    const Vector3f& q = scene.points[near];
    const Vector3f& normal = scene.normals[near];
    const float cosine = normal.dot(fast.rotation * model.normals[i]);
    const float height = (p - q).dot(normal);
    if (on_surface(p, q, normal, tolerance, scene.spacing) && cosine > options.min_cosine) {
      ++matches;
      closeness += 1 - (height / tolerance) * (height / tolerance);
    } else if (scene.rim.empty() || (scene.rim[near] == 0 && !(cosine < 0 && height < 0))) {
      ++conflicts;
    }
  }
  if (matches == 0 && conflicts == 0) return {};
  return {.match = static_cast<double>(matches) / static_cast<double>(n),
          .conflict = static_cast<double>(conflicts) / static_cast<double>(n),
          .closeness = matches == 0 ? 0 : closeness / static_cast<double>(matches)};
}

std::vector<std::uint8_t> explained(const SampleTree& model, double diagonal,
                                    const Similarity& pose, const SurfaceSamples& scene,
                                    const OverlapOptions& options, std::int64_t count,
                                    std::span<const std::uint8_t> used) {
  const FastPose back(pose.inverse());
  const auto tolerance = static_cast<float>(options.match * diagonal);
  const float spacing = model.samples().spacing;
  std::vector<std::uint8_t> result(bounded(count, scene));
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (!used.empty() && used[i] != 0) continue;
    const Vector3f p = back.point(scene.points[i]);
    const std::int64_t near = model.nearest(p, tolerance + spacing);
    if (near < 0) continue;
    const Vector3f& normal = model.samples().normals[near];
    result[i] = on_surface(p, model.samples().points[near], normal, tolerance, spacing) &&
                        normal.dot(back.rotation * scene.normals[i]) > options.min_cosine
                    ? 1
                    : 0;
  }
  return result;
}

Similarity refined(const SurfaceSamples& model, double diagonal, const Similarity& start,
                   const SampleTree& scene, const RefineOptions& options) {
  using Vector7d = Eigen::Matrix<double, 7, 1>;
  using Matrix7d = Eigen::Matrix<double, 7, 7>;
  constexpr int kFewest = 12;
  const std::size_t n = bounded(options.count, model);
  Vector3d centre = Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i)
    centre += model.points[i].cast<double>() / static_cast<double>(n);
  Similarity pose = start;
  std::vector<std::int64_t> nearest(n, -1);  // to each sample, before the last step
  for (const double reach : options.reach)
    for (int iteration = 0; iteration < options.iterations; ++iteration) {
      const FastPose fast(pose);
      const double size = diagonal * pose.scale;
      const auto limit = static_cast<float>(reach * size);
      const float spacing = scene.samples().spacing;
      Matrix7d normal_matrix = Matrix7d::Zero();
      Vector7d right = Vector7d::Zero();
      // About the middle, in units of the model's size: all seven unknowns are of one magnitude.
      const Vector3d middle = pose.apply(centre);
      int matched = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const Vector3f p = fast.point(model.points[i]);
        const std::int64_t near = scene.nearest(p, limit + spacing, nearest[i]);
        nearest[i] = near;
        if (near < 0) continue;
        const Vector3f& q = scene.samples().points[near];
        const Vector3f& nq = scene.samples().normals[near];
        if (!on_surface(p, q, nq, limit, spacing) ||
            nq.dot(fast.rotation * model.normals[i]) < options.min_cosine)
          continue;
        const Vector3d normal = nq.cast<double>();
        const Vector3d arm = (p.cast<double>() - middle) / size;
        Vector7d row;
        row << arm.cross(normal), normal, arm.dot(normal);
        normal_matrix.selfadjointView<Eigen::Lower>().rankUpdate(row);
        right += row * normal.dot((q - p).cast<double>()) / size;
        ++matched;
      }
      if (matched < kFewest) return pose;
      // Directions that no plane holds stay as they are.
      normal_matrix.diagonal().array() += 1e-4 * matched * reach;
      const Vector7d step =
          Matrix7d(normal_matrix.selfadjointView<Eigen::Lower>()).ldlt().solve(right);
      if (!step.allFinite()) return pose;
      Similarity move;
      const Vector3d turn = step.head<3>();
      if (turn.norm() > 0)
        move.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
      move.scale = std::exp(std::clamp(step[6], -0.2, 0.2));
      move.translation = middle + size * step.segment<3>(3) - move.scale * (move.rotation * middle);
      pose = move * pose;
      if (step.norm() < 1e-5) break;
    }
  return pose;
}

}  // namespace semigeo::kernels
