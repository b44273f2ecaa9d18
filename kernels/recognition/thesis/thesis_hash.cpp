#include "kernels/recognition/thesis/thesis_hash.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <utility>

namespace semigeo::kernels {
namespace {

/// Holds the order of the corners, and which of them is the strongest.
struct Order {
  std::array<int, 3> corners;
  int strongest;
};

/// Describes a triangle of features, in the order in which they were chosen.
struct MeasuredTriangle {
  std::array<std::uint16_t, 3> features;
  std::array<double, 3> values;
  std::array<double, 3> sides;  ///< Length of the side opposite to each feature.
};

bool collinear(const std::array<Eigen::Vector3d, 3>& p, double longest, double min_height) {
  const double twice_area = (p[1] - p[0]).cross(p[2] - p[0]).norm();
  return !(twice_area > min_height * longest * longest);
}

ThesisTriplet triplet_of(const MeasuredTriangle& t, const Order& order) {
  ThesisTriplet result;
  const auto& c = order.corners;
  for (int i = 0; i < 3; ++i) result.corners[i] = t.features[c[i]];
  result.strongest = static_cast<std::uint8_t>(order.strongest);
  const double longest = t.sides[c[0]];
  const double k_a = t.values[c[order.strongest]];
  const double k_b = t.values[c[(order.strongest + 1) % 3]];
  const double k_c = t.values[c[(order.strongest + 2) % 3]];
  const double features = (k_b + k_c) / k_a;
  const double lengths = (t.sides[c[1]] + t.sides[c[2]]) / longest;
  result.indexed = static_cast<float>(features * lengths);       // (4.17)
  result.address = static_cast<float>(10 * features + lengths);  // (4.18)
  result.length_ratios = {static_cast<float>(t.sides[c[1]] / longest),
                          static_cast<float>(t.sides[c[2]] / longest)};
  result.feature_ratios = {static_cast<float>(k_b / k_a), static_cast<float>(k_c / k_a)};
  return result;
}

/// Tells whether the sides descend and no value exceeds that of the strongest corner, up to these
/// tolerances.
bool in_order(const MeasuredTriangle& t, const Order& order, double length, double feature) {
  const auto& c = order.corners;
  const double longest = t.sides[c[0]];
  const double strongest = std::abs(t.values[c[order.strongest]]);
  for (int i = 0; i + 1 < 3; ++i)
    if (t.sides[c[i + 1]] > t.sides[c[i]] + length * longest) return false;
  for (int i = 0; i < 3; ++i)
    if (std::abs(t.values[c[i]]) > strongest * (1 + feature)) return false;
  return true;
}

constexpr std::array<std::array<int, 3>, 6> kPermutations = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

/// Returns the order in which a model has the triangle. If sides or values are equal, it is the
/// first such order.
Order order_of(const MeasuredTriangle& t) {
  Order order{{0, 1, 2}, 0};
  std::ranges::stable_sort(order.corners, std::ranges::greater(),
                           [&](int i) { return t.sides[i]; });
  for (int i = 1; i < 3; ++i)
    if (std::abs(t.values[order.corners[i]]) > std::abs(t.values[order.corners[order.strongest]]))
      order.strongest = i;
  return order;
}

void add_triplets(const MeasuredTriangle& t, const ThesisOptions& options, bool every_order,
                  std::vector<ThesisTriplet>& result) {
  if (!every_order) {
    result.push_back(triplet_of(t, order_of(t)));
    return;
  }
  for (const auto& corners : kPermutations)
    for (int strongest = 0; strongest < 3; ++strongest)
      if (const Order order{corners, strongest};
          in_order(t, order, options.length_ratio, options.feature_ratio))
        result.push_back(triplet_of(t, order));
}

}  // namespace

std::vector<std::uint16_t> strongest_features(const OrientedFeatures& features, FeatureKind kind,
                                              int level, int most) {
  std::vector<std::uint16_t> chosen;
  for (std::size_t i = 0; i < features.features.size(); ++i) {
    const OrientedFeature& feature = features.features[i];
    if (feature.level == level && feature.code / 2 == static_cast<int>(kind))
      chosen.push_back(static_cast<std::uint16_t>(i));
  }
  std::ranges::stable_sort(chosen, std::ranges::greater(),
                           [&](std::uint16_t i) { return std::abs(features.features[i].value); });
  chosen.resize(std::min<std::size_t>(chosen.size(), std::max(most, 0)));
  return chosen;
}

std::vector<ThesisTriplet> thesis_triplets(const OrientedFeatures& features,
                                           std::span<const std::uint16_t> chosen,
                                           const ThesisOptions& options, bool every_order) {
  std::vector<ThesisTriplet> result;
  for (std::size_t a = 0; a < chosen.size(); ++a)
    for (std::size_t b = a + 1; b < chosen.size(); ++b)
      for (std::size_t c = b + 1; c < chosen.size(); ++c) {
        MeasuredTriangle triangle{
            .features = {chosen[a], chosen[b], chosen[c]}, .values = {}, .sides = {}};
        std::array<Eigen::Vector3d, 3> p;
        for (int i = 0; i < 3; ++i) {
          const OrientedFeature& feature = features.features[triangle.features[i]];
          p[i] = feature.position.cast<double>();
          triangle.values[i] = feature.value;
        }
        for (int i = 0; i < 3; ++i) triangle.sides[i] = (p[(i + 1) % 3] - p[(i + 2) % 3]).norm();
        if (collinear(p, *std::ranges::max_element(triangle.sides), options.min_height)) continue;
        if (std::ranges::count(triangle.values, 0.0) > 0) continue;
        add_triplets(triangle, options, every_order, result);
      }
  return result;
}

ThesisTable::ThesisTable(std::vector<Entry> entries, const ThesisOptions& options)
    : options_(options),
      address_(static_cast<float>(options.address)),
      entries_(std::move(entries)) {
  std::ranges::stable_sort(entries_, {},
                           [this](const Entry& entry) { return cell_of(entry.triplet.address); });
  first_.assign(cell_of(100.0F) + 2, 0);
  for (const Entry& entry : entries_) ++first_[cell_of(entry.triplet.address) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
}

/// Returns the cell of an address. A lies between -19 and 22, and slightly beyond if tolerances
/// admit another feature as the strongest.
std::size_t ThesisTable::cell_of(float address) const {
  return static_cast<std::size_t>((std::clamp(address, -25.0F, 28.0F) + 25.0F) / address_);
}

double thesis_score(std::int64_t votes, std::int64_t features) {
  if (features < 3) return 0;
  const auto n = static_cast<double>(features);
  return static_cast<double>(votes) / (n * (n - 1) * (n - 2) / 6) * 100;
}

}  // namespace semigeo::kernels
