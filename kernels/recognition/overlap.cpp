#include "kernels/recognition/overlap.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <numbers>
#include <optional>

#include "kernels/recognition/slippage.hpp"

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

/// Collects the nearest point within a limit. If several are equally near, it is the first one.
class NearestWithin {
 public:
  using DistanceType = float;
  explicit NearestWithin(float squared_limit) : squared_(squared_limit) {}
  std::int64_t index() const { return index_; }
  // nanoflann asks for these names.
  // NOLINTBEGIN(readability-identifier-naming)
  bool addPoint(float squared, std::size_t index) {
    const auto i = static_cast<std::int64_t>(index);
    if (squared < squared_ || (squared == squared_ && i < index_)) {
      squared_ = squared;
      index_ = i;
    }
    return true;
  }
  float worstDist() const { return squared_; }
  // NOLINTEND(readability-identifier-naming)
  bool full() const { return true; }
  std::size_t size() const { return index_ < 0 ? 0 : 1; }

 private:
  float squared_;
  std::int64_t index_ = -1;
};

/// Collects the nearest sample within a limit that faces the same way.
class NearestFacing : public NearestWithin {
 public:
  NearestFacing(float squared_limit, const std::vector<Vector3f>& normals, const Vector3f& normal)
      : NearestWithin(squared_limit), normals_(normals), normal_(normal) {}
  // NOLINTNEXTLINE(readability-identifier-naming): nanoflann asks for this name
  bool addPoint(float squared, std::size_t index) {
    return !(normals_[index].dot(normal_) > 0) || NearestWithin::addPoint(squared, index);
  }

 private:
  const std::vector<Vector3f>& normals_;
  const Vector3f& normal_;
};

/// Collects all points within a limit.
class AllWithin {
 public:
  using DistanceType = float;
  AllWithin(float squared_limit, std::vector<std::uint32_t>& found)
      : squared_(squared_limit), found_(found) {}
  // nanoflann asks for these names.
  // NOLINTBEGIN(readability-identifier-naming)
  bool addPoint(float squared, std::size_t index) {
    if (squared < squared_) found_.push_back(static_cast<std::uint32_t>(index));
    return true;
  }
  float worstDist() const { return squared_; }
  // NOLINTEND(readability-identifier-naming)
  bool full() const { return true; }
  std::size_t size() const { return found_.size(); }

 private:
  float squared_;
  std::vector<std::uint32_t>& found_;
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

/// Returns the mean of the first n samples.
Vector3d middle_of(const SurfaceSamples& samples, std::size_t n) {
  Vector3d middle = Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i)
    middle += samples.points[i].cast<double>() / static_cast<double>(n);
  return middle;
}

/// Tells whether p lies on the surface that is sampled at q with normal n. q is the sample nearest
/// to p. A sample stands for the surface around it, so p may lie beside it by the spacing.
bool on_surface(const Vector3f& p, const Vector3f& q, const Vector3f& n, float tolerance,
                float spacing) {
  const Vector3f offset = p - q;
  const float height = offset.dot(n);
  if (std::abs(height) > tolerance) return false;
  const float reach = tolerance + spacing;
  return offset.squaredNorm() - height * height <= reach * reach;
}

/// Holds a sample of a posed model and how it lies to the nearest sample of the scene.
struct Contact {
  OrientedPoint posed;
  std::int64_t near = -1;  ///< Nearest sample of the scene; -1: none within the limit.
  bool matches = false;    ///< Both lie on one surface.
  float height = 0;        ///< Height over the scene's surface.
  float cosine = 0;        ///< Cosine between the normals.
};

/// Compares samples of a model in one pose with a scene.
class PosedModel {
 public:
  PosedModel(const SurfaceSamples& model, double diagonal, const Similarity& pose,
             const SampleTree& tree, const OverlapOptions& options)
      : model_(model),
        pose_(pose),
        tree_(tree),
        tolerance_(static_cast<float>(options.match * diagonal * pose.scale)),
        min_cosine_(options.min_cosine) {}

  float tolerance() const { return tolerance_; }

  Contact contact(std::size_t i, float limit) const {
    const SurfaceSamples& scene = tree_.samples();
    Contact c;
    c.posed = {pose_.point(model_.points[i]), pose_.rotation * model_.normals[i]};
    c.near = tree_.nearest(c.posed.point, limit + scene.spacing);
    if (c.near < 0) return c;
    compare(c);
    const float reach = tolerance_ + scene.spacing;
    if (c.cosine < 0 && (c.posed.point - scene.points[c.near]).squaredNorm() < reach * reach) {
      Contact facing = c;
      facing.near = tree_.nearest_facing(c.posed.point, c.posed.normal, reach);
      if (facing.near >= 0) compare(facing);
      if (facing.matches) return facing;
    }
    return c;
  }

 private:
  /// Says how the sample lies to the scene's sample near it.
  void compare(Contact& c) const {
    const SurfaceSamples& scene = tree_.samples();
    const Vector3f& q = scene.points[c.near];
    const Vector3f& normal = scene.normals[c.near];
    c.cosine = normal.dot(c.posed.normal);
    c.height = (c.posed.point - q).dot(normal);
    c.matches =
        on_surface(c.posed.point, q, normal, tolerance_, scene.spacing) && c.cosine > min_cosine_;
  }

  const SurfaceSamples& model_;
  const FastPose pose_;
  const SampleTree& tree_;
  const float tolerance_;
  const double min_cosine_;
};

/// Counts how samples of a posed model lie in what a scanner saw.
class ViewCount {
 public:
  ViewCount(const OverlapOptions& options, float spacing, float tolerance)
      : depths_(options.depths), tolerance_(kLooser * tolerance + spacing / 2) {}

  /// `at_rim` tells whether the sample lies nearest to the rim of what was seen. Nobody knows how
  /// the surface goes on there, and whether the sample belongs to another face of an edge.
  void add(const Contact& c, bool at_rim) {
    const Vector3f& p = c.posed.point;
    const Vector3f to_eye = depths_->eye() - p;
    if (c.posed.normal.dot(to_eye) < kLeastFacing * to_eye.norm()) return;
    switch (depths_->look(p, tolerance_)) {
      case Sight::kThere:
        ++there_;
        if (c.near >= 0 && !c.matches && !at_rim) ++opposed_;
        break;
      case Sight::kBehind:
        ++behind_;
        break;
      case Sight::kNothing:
        ++nothing_;
        break;
      case Sight::kInFront:
      case Sight::kUnmapped:
        break;
    }
  }

  View shares(std::size_t samples) const {
    const auto share = [&](std::int64_t count) {
      return static_cast<double>(count) / static_cast<double>(samples);
    };
    return {share(there_), share(behind_), share(nothing_), share(opposed_)};
  }

 private:
  static constexpr float kLooser = 1.5F;        // distances along a ray exceed those of surfaces
  static constexpr float kLeastFacing = 0.35F;  // flatter surfaces are often not measured

  const DepthMap* depths_;
  float tolerance_;
  std::int64_t there_ = 0;
  std::int64_t behind_ = 0;
  std::int64_t nothing_ = 0;
  std::int64_t opposed_ = 0;
};

/// Returns how those of the first n samples of a posed model that match can slip.
Slippage slippage_of_match(const PosedModel& posed, std::size_t n) {
  std::vector<OrientedPoint> matched;
  for (std::size_t i = 0; i < n; ++i)
    if (const Contact c = posed.contact(i, posed.tolerance()); c.matches)
      matched.push_back(c.posed);
  return Slippage(matched);
}

/// Returns the 23 rotations that bring a cube onto itself, without the identity.
std::vector<Eigen::Matrix3d> turns_of_a_cube() {
  std::vector<Eigen::Matrix3d> turns;
  std::array<int, 3> axis = {0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
      for (int i = 0; i < 3; ++i) turn(axis[i], i) = (signs >> i & 1) != 0 ? -1 : 1;
      if (turn.determinant() > 0 && !turn.isIdentity()) turns.push_back(turn);
    }
  } while (std::ranges::next_permutation(axis).found);
  return turns;
}

Similarity turn_about(const Axis& axis, double angle) {
  Similarity turn;
  turn.rotation = Eigen::AngleAxisd(angle, axis.direction).toRotationMatrix();
  turn.translation = axis.point - turn.rotation * axis.point;
  return turn;
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
    // The squares are summed as the tree sums them, so that equal distances stay equal.
    const float squared =
        offset.x() * offset.x() + offset.y() * offset.y() + offset.z() * offset.z();
    result.addPoint(squared, static_cast<std::size_t>(guess));
  }
  tree_->index.findNeighbors(result, p.data(), nanoflann::SearchParams());
  return result.index();
}

std::int64_t SampleTree::nearest_facing(const Vector3f& p, const Vector3f& normal,
                                        float limit) const {
  if (samples_->points.empty()) return -1;
  NearestFacing result(limit * limit, samples_->normals, normal);
  tree_->index.findNeighbors(result, p.data(), nanoflann::SearchParams());
  return result.index();
}

void SampleTree::within(const Vector3f& p, float limit, std::vector<std::uint32_t>& found) const {
  found.clear();
  if (samples_->points.empty()) return;
  AllWithin result(limit * limit, found);
  tree_->index.findNeighbors(result, p.data(), nanoflann::SearchParams());
  std::ranges::sort(found);
}

double Overlap::agreement() const {
  if (match <= 0) return 0;
  const double share = match / (match + conflict);
  return match * closeness * share * share;
}

Overlap overlap(const SurfaceSamples& model, double diagonal, const Similarity& pose,
                const SampleTree& tree, const OverlapOptions& options, std::int64_t count,
                std::span<const std::uint8_t> used) {
  const PosedModel posed(model, diagonal, pose, tree, options);
  const auto limit = static_cast<float>(options.conflict * diagonal * pose.scale);
  const std::vector<std::uint8_t>& rim = tree.samples().rim;
  const std::size_t n = bounded(count, model);
  std::int64_t matches = 0;
  std::int64_t conflicts = 0;
  double closeness = 0;
  ViewCount view(options, tree.samples().spacing, posed.tolerance());
  std::vector<OrientedPoint> matched;
  for (std::size_t i = 0; i < n; ++i) {
    const Contact c = posed.contact(i, limit);
    const bool at_rim = c.near >= 0 && !rim.empty() && rim[c.near] != 0;
    if (options.depths != nullptr) view.add(c, at_rim);
    if (c.near < 0 || (!used.empty() && used[c.near] != 0)) continue;
    if (c.matches) {
      ++matches;
      closeness += 1 - (c.height / posed.tolerance()) * (c.height / posed.tolerance());
      if (options.stability) matched.push_back(c.posed);
    } else if (rim.empty() || (!at_rim && !(c.cosine < 0 && c.height < 0))) {
      ++conflicts;
    }
  }
  if (n == 0) return {};
  return {.match = static_cast<double>(matches) / static_cast<double>(n),
          .conflict = static_cast<double>(conflicts) / static_cast<double>(n),
          .closeness = matches == 0 ? 0 : closeness / static_cast<double>(matches),
          .stability = Slippage(matched).stability(posed.tolerance()),
          .view = view.shares(n)};
}

std::vector<Similarity> symmetric_poses(const SurfaceSamples& model, double diagonal,
                                        const Similarity& pose, const SampleTree& tree,
                                        const OverlapOptions& options, std::int64_t count) {
  constexpr int kTurns = 36;
  constexpr double kFree = 0.02;  // the handle of a cup holds it by less
  std::vector<Similarity> result;
  const std::size_t n = bounded(count, model);
  if (n == 0) return result;
  const Vector3d middle = middle_of(model, n);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d arm = model.points[i].cast<double>() - middle;
    spread += arm * arm.transpose();
  }
  const Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  for (const Eigen::Matrix3d& turn : turns_of_a_cube()) {
    const Eigen::Matrix3d rotation = axes * turn * axes.transpose();
    result.push_back(pose *
                     Similarity{.rotation = rotation, .translation = middle - rotation * middle});
  }
  const Slippage matched = slippage_of_match(PosedModel(model, diagonal, pose, tree, options), n);
  if (const std::optional<Axis> axis = matched.free_rotation(kFree))
    for (int k = 1; k < kTurns; ++k)
      result.push_back(turn_about(*axis, 2 * std::numbers::pi * k / kTurns) * pose);
  return result;
}

std::optional<ScalingMotion> free_scaling(const SurfaceSamples& model, double diagonal,
                                          const Similarity& pose, const SampleTree& tree,
                                          const OverlapOptions& options, std::int64_t count,
                                          double most) {
  const PosedModel posed(model, diagonal, pose, tree, options);
  return slippage_of_match(posed, bounded(count, model)).free_scaling(most);
}

std::vector<std::uint8_t> samples_on_model(const SampleTree& model, double diagonal,
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
    const Vector3f facing = back.rotation * scene.normals[i];
    const std::int64_t near = model.nearest_facing(p, facing, tolerance + spacing);
    if (near < 0) continue;
    const Vector3f& normal = model.samples().normals[near];
    result[i] = on_surface(p, model.samples().points[near], normal, tolerance, spacing) &&
                        normal.dot(facing) > options.min_cosine
                    ? 1
                    : 0;
  }
  return result;
}

Similarity refine_pose(const SurfaceSamples& model, double diagonal, const Similarity& start,
                       const SampleTree& scene, const RefineOptions& options) {
  using Matrix7d = Eigen::Matrix<double, 7, 7>;
  constexpr int kFewest = 12;
  const std::size_t n = bounded(options.count, model);
  const Vector3d centre = middle_of(model, n);
  Similarity pose = start;
  std::vector<std::int64_t> nearest(n, -1);  // nearest sample of the scene in the last step
  for (const double reach : options.reach)
    for (int iteration = 0; iteration < options.iterations; ++iteration) {
      const FastPose fast(pose);
      const double size = diagonal * pose.scale;
      const auto limit = static_cast<float>(reach * size);
      const float spacing = scene.samples().spacing;
      Matrix7d normal_matrix = Matrix7d::Zero();
      Constraint right = Constraint::Zero();
      // Motions are taken about the middle and in units of the model's size, so that all seven
      // unknowns have the same magnitude.
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
        const Constraint row = plane_constraint(arm, normal);
        normal_matrix.selfadjointView<Eigen::Lower>().rankUpdate(row);
        right += row * normal.dot((q - p).cast<double>()) / size;
        ++matched;
      }
      if (matched < kFewest) return pose;
      // A small weight on each unknown makes it 0 if no plane determines it.
      normal_matrix.diagonal().array() += 1e-4 * matched * reach;
      const Constraint step =
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
