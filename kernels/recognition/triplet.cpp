#include "kernels/recognition/triplet.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include "kernels/recognition/near_features.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;
using Corners = std::array<std::uint16_t, 3>;

constexpr float kRatioTolerance = 0.09F;
constexpr float kLeastSecondRatio = 0.5F;
constexpr float kLeastThirdRatio = 0.08F;
constexpr float kLeastScale = 0.693F;  // log 2

// Curvatures are stored on a warped scale. On it their tolerance is one unit everywhere.
constexpr float kMostWarped = 6;

constexpr float kNormalChord = 0.5177F;  // 2 sin 15 degrees

/// Maps the interval [low, high] to bytes.
struct Bytes {
  float low;
  float high;
  constexpr float step() const { return (high - low) / 255; }
  std::uint8_t of(float value) const {
    const double clamped = std::clamp((value - low) / step(), 0.0F, 255.0F);
    return static_cast<std::uint8_t>(std::floor(clamped + 0.5));
  }
  /// Returns a tolerance in bytes. It is rounded down, because both values have been rounded.
  constexpr std::uint8_t tolerance(float width) const {
    return static_cast<std::uint8_t>(width / step());
  }
};
constexpr Bytes kRatio = {0, 1.2F};
constexpr Bytes kScale = {kLeastScale, kLeastScale + kScaleBins* kScaleTolerance};
constexpr Bytes kCurvature = {-kMostWarped, kMostWarped};
constexpr Bytes kShare = {-1, 1};

enum Invariant { kSecondRatio, kThirdRatio, kLogScale, kCurvatures, kNormals = 9, kSigns = 15 };

constexpr Invariants tolerances() {
  Invariants result = {};
  result[kSecondRatio] = result[kThirdRatio] = kRatio.tolerance(kRatioTolerance);
  result[kLogScale] = kScale.tolerance(kScaleTolerance);
  for (int i = kCurvatures; i < kNormals; ++i) result[i] = kCurvature.tolerance(1);
  for (int i = kNormals; i < kSigns; ++i) result[i] = kShare.tolerance(kNormalChord);
  result[kSigns] = 255;
  return result;
}
constexpr Invariants kTolerances = tolerances();

std::uint8_t curvature_byte(float q) {
  const float warped =
      std::log1p(kCurvatureSlope / kCurvatureTolerance * std::abs(q)) / kCurvatureSlope;
  return kCurvature.of(std::copysign(warped, q));
}

int bin(float value, float least, float width, int bins) {
  return static_cast<int>(std::clamp((value - least) / width, 0.0F, static_cast<float>(bins - 1)));
}

/// Returns a normal in the frame of its triangle. The axes are the triangle's normal, the longest
/// side and the height.
Vector3f normal_of(const Invariants& invariants, int corner) {
  const float a = kShare.low + kShare.step() * invariants[kNormals + 2 * corner];
  const float b = kShare.low + kShare.step() * invariants[kNormals + 2 * corner + 1];
  const float rest = std::sqrt(std::max(0.0F, 1 - a * a - b * b));
  const bool negative = ((invariants[kSigns] >> corner) & 1) != 0;
  return {a, b, negative ? -rest : rest};
}

/// Holds sixteen bytes in one register. GCC and Clang have this type on every machine.
using SixteenBytes = std::uint8_t __attribute__((vector_size(kInvariants)));

SixteenBytes bytes_of(const Invariants& invariants) {
  SixteenBytes bytes;
  std::memcpy(&bytes, invariants.data(), sizeof bytes);
  return bytes;
}

bool within_tolerances(SixteenBytes a, SixteenBytes b) {
  const SixteenBytes larger = a > b ? a : b;
  const SixteenBytes smaller = a > b ? b : a;
  const auto beyond =
      (larger - smaller) > bytes_of(kTolerances);  // 255 in each byte that is beyond, else 0
  std::array<std::uint64_t, 2> halves;
  std::memcpy(halves.data(), &beyond, sizeof halves);
  return (halves[0] | halves[1]) == 0;
}

using Normals = std::array<Vector3f, 3>;

Normals normals_of(const Invariants& invariants) {
  return {normal_of(invariants, 0), normal_of(invariants, 1), normal_of(invariants, 2)};
}

bool same_normals(const Normals& a, const Invariants& b) {
  for (int corner = 0; corner < 3; ++corner)
    if (a[corner].dot(normal_of(b, corner)) < kCosNormalTolerance) return false;
  return true;
}

std::uint64_t packed(const Corners& corners) {
  return std::uint64_t{corners[0]} << 32 | std::uint64_t{corners[1]} << 16 | corners[2];
}

/// Holds what a triplet needs of one feature.
struct Corner {
  Vector3f position;
  Vector3f normal;
  std::uint8_t gaussian;
  std::uint8_t mean;
  std::uint8_t code;
};

class LevelTriplets {
 public:
  LevelTriplets(const TripletOptions& options, std::vector<Triplet>& result)
      : options_(options), result_(result) {}

  /// Adds the triplets of one level. `first` is the index of its first feature.
  void add(std::span<const OrientedFeature> of_level, float sigma, std::size_t first) {
    first_ = first;
    sigma_ = sigma;
    corners_.clear();
    for (const OrientedFeature& f : of_level)
      corners_.push_back({f.position, f.normal, curvature_byte(f.scale_free_gaussian),
                          curvature_byte(f.scale_free_mean), f.code});
    near_.find(of_level, options_.nearest * sigma_, options_.farthest * sigma_,
               options_.neighbours);
    number_.assign(corners_.size(), kNobody);
    for (std::size_t i = 0; i < corners_.size(); ++i) enter_triangles_of(i);
  }

 private:
  static constexpr std::uint16_t kNobody = 0xffff;  // no feature has this index

  /// Enters the triangles of a feature and two of its neighbours. It leaves out triangles that were
  /// entered from one of these neighbours, namely an earlier feature that has the two other corners
  /// as its own neighbours.
  void enter_triangles_of(std::size_t i) {
    const std::span<const std::uint16_t> near = near_.of(i);
    const double nearest = options_.nearest * sigma_;
    for (std::size_t a = 0; a < near.size(); ++a) number_[near[a]] = static_cast<std::uint16_t>(a);
    number_[i] = static_cast<std::uint16_t>(near.size());
    const std::size_t width = near.size() + 1;
    entered_.assign(near.size() * width, 0);
    for (std::size_t a = 0; a < near.size(); ++a)
      if (near[a] < i)
        for (const std::uint16_t other : near_.of(near[a]))
          if (number_[other] != kNobody) entered_[a * width + number_[other]] = 1;
    const auto entered_by = [&](std::size_t a, std::size_t b) {
      return entered_[a * width + near.size()] != 0 && entered_[a * width + b] != 0;
    };
    for (std::size_t a = 0; a < near.size(); ++a)
      for (std::size_t b = a + 1; b < near.size(); ++b) {
        const std::uint16_t j = near[a];
        const std::uint16_t k = near[b];
        if (entered_by(a, b) || entered_by(b, a) ||
            (corners_[j].position - corners_[k].position).squaredNorm() < nearest * nearest)
          continue;
        Corners triangle = {static_cast<std::uint16_t>(i), j, k};
        order(triangle, [](std::uint16_t one, std::uint16_t other) { return one < other; });
        enter(triangle);
      }
    for (const std::uint16_t j : near) number_[j] = kNobody;
    number_[i] = kNobody;
  }

  /// Sorts three values. Equal values keep their order.
  template <typename Value, typename Before>
  static void order(std::array<Value, 3>& three, const Before& before) {
    if (before(three[1], three[0])) std::swap(three[0], three[1]);
    if (before(three[2], three[1])) {
      std::swap(three[1], three[2]);
      if (before(three[1], three[0])) std::swap(three[0], three[1]);
    }
  }

  /// Returns the length of the side opposite to each corner.
  std::array<float, 3> sides(const Corners& t) const {
    const auto length = [&](int a, int b) {
      return (corners_[t[a]].position - corners_[t[b]].position).norm();
    };
    return {length(1, 2), length(2, 0), length(0, 1)};
  }

  void enter(const Corners& triangle) {
    const std::array<float, 3> all = sides(triangle);
    const auto enter_in = [&](const std::array<int, 3>& o) {
      enter({triangle[o[0]], triangle[o[1]], triangle[o[2]]}, {all[o[0]], all[o[1]], all[o[2]]});
    };
    if (!options_.every_order) {
      std::array<int, 3> longest_first = {0, 1, 2};
      order(longest_first, [&](int one, int other) { return all[one] > all[other]; });
      return enter_in(longest_first);
    }
    std::array<int, 3> permuted = {0, 1, 2};
    do {
      // In the model a side may be the shorter one although here it is the longer one, within the
      // tolerance.
      const float slack = kRatioTolerance * all[permuted[0]];
      if (all[permuted[1]] <= all[permuted[0]] + slack &&
          all[permuted[2]] <= all[permuted[1]] + slack &&
          all[permuted[2]] <= all[permuted[0]] + slack)
        enter_in(permuted);
    } while (std::ranges::next_permutation(permuted).found);
  }

  void enter(const Corners& t, const std::array<float, 3>& side) {
    const Corner& p = corners_[t[0]];
    const Corner& q = corners_[t[1]];
    const Corner& r = corners_[t[2]];
    const Vector3f base = (r.position - q.position) / side[0];
    const Vector3f across = (q.position - p.position).cross(r.position - p.position);
    const float longest = std::max({side[0], side[1], side[2]});
    const float twice_area = across.norm();
    if (twice_area < options_.min_height * longest * longest || twice_area <= 0) return;
    const Vector3f normal = across / twice_area;
    const Vector3f height = normal.cross(base);

    Triplet triplet;
    const float second = side[1] / side[0];
    const float third = side[2] / side[0];
    const float scale = std::log(side[0] / sigma_);
    Invariants& v = triplet.invariants;
    v[kSecondRatio] = kRatio.of(second);
    v[kThirdRatio] = kRatio.of(third);
    v[kLogScale] = kScale.of(scale);
    for (int i = 0; i < 3; ++i) {
      const Corner& corner = corners_[t[i]];
      v[kCurvatures + 2 * i] = corner.gaussian;
      v[kCurvatures + 2 * i + 1] = corner.mean;
      v[kNormals + 2 * i] = kShare.of(corner.normal.dot(normal));
      v[kNormals + 2 * i + 1] = kShare.of(corner.normal.dot(base));
      if (corner.normal.dot(height) < 0) v[kSigns] |= static_cast<std::uint8_t>(1 << i);
      triplet.corners[i] = static_cast<std::uint16_t>(first_ + t[i]);
    }
    const int shape =
        (bin(second, kLeastSecondRatio, kRatioTolerance, kSecondRatioBins) * kThirdRatioBins +
         bin(third, kLeastThirdRatio, kRatioTolerance, kThirdRatioBins)) *
            kScaleBins +
        bin(scale, kLeastScale, kScaleTolerance, kScaleBins);
    const int codes = (p.code * kFeatureCodes + q.code) * kFeatureCodes + r.code;
    triplet.cell = static_cast<std::uint32_t>(shape * kCodeTriples + codes);
    result_.push_back(triplet);
  }

  const TripletOptions& options_;
  std::vector<Triplet>& result_;
  std::size_t first_ = 0;
  float sigma_ = 1;
  std::vector<Corner> corners_;
  NearFeatures near_;
  // These vectors belong to the feature whose triangles are being entered.
  std::vector<std::uint16_t> number_;  ///< Place of each feature among its neighbours.
  /// (neighbours, neighbours + 1) 1 where an earlier neighbour has another neighbour, or the
  /// feature itself (last column), as a neighbour of its own.
  std::vector<std::uint8_t> entered_;
};

/// Returns the triplets sorted by cell, then corners.
std::vector<Triplet> sorted(const std::vector<Triplet>& triplets) {
  struct Key {
    std::uint64_t codes_and_corners;
    std::uint32_t index;
  };
  std::vector<std::uint32_t> next(kShapes + 1);
  for (const Triplet& t : triplets) ++next[t.cell / kCodeTriples + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<Key> keys(triplets.size());
  for (std::uint32_t i = 0; i < triplets.size(); ++i) {
    const Triplet& t = triplets[i];
    const std::uint64_t codes = t.cell % kCodeTriples;
    keys[next[t.cell / kCodeTriples]++] = {codes << 48 | packed(t.corners), i};
  }
  auto first = keys.begin();
  for (int shape = 0; shape < kShapes; ++shape) {
    const auto last = keys.begin() + next[shape];
    std::sort(first, last,
              [](const Key& a, const Key& b) { return a.codes_and_corners < b.codes_and_corners; });
    first = last;
  }
  std::vector<Triplet> result;
  result.reserve(triplets.size());
  for (const Key& key : keys) result.push_back(triplets[key.index]);
  return result;
}

}  // namespace

std::vector<Triplet> local_triplets(const OrientedFeatures& features,
                                    const TripletOptions& options) {
  std::vector<Triplet> result;
  LevelTriplets triplets(options, result);
  for_each_level(features, [&](auto of_level, float sigma, std::size_t first) {
    triplets.add(of_level, sigma, first);
  });
  return sorted(result);
}

std::vector<std::uint32_t> cells_around(std::uint32_t cell) {
  const auto codes = cell % kCodeTriples;
  const int shape = static_cast<int>(cell / kCodeTriples);
  const int scale = shape % kScaleBins;
  const int third = shape / kScaleBins % kThirdRatioBins;
  const int second = shape / kScaleBins / kThirdRatioBins;
  std::vector<std::uint32_t> cells;
  for (int i = std::max(second - 1, 0); i <= std::min(second + 1, kSecondRatioBins - 1); ++i)
    for (int j = std::max(third - 1, 0); j <= std::min(third + 1, kThirdRatioBins - 1); ++j)
      for (int k = std::max(scale - 1, 0); k <= std::min(scale + 1, kScaleBins - 1); ++k)
        cells.push_back(((i * kThirdRatioBins + j) * kScaleBins + k) * kCodeTriples + codes);
  return cells;
}

bool compatible(const Invariants& a, const Invariants& b) {
  return within_tolerances(bytes_of(a), bytes_of(b)) && same_normals(normals_of(a), b);
}

void find_compatible(const Invariants& wanted, std::span<const Posting> postings,
                     std::vector<std::uint32_t>& found) {
  const SixteenBytes bytes = bytes_of(wanted);
  const Normals normals = normals_of(wanted);
  for (std::uint32_t i = 0; i < postings.size(); ++i) {
    const Invariants& other = postings[i].invariants;
    if (within_tolerances(bytes, bytes_of(other)) && same_normals(normals, other))
      found.push_back(i);
  }
}

}  // namespace semigeo::kernels
