#include "bench/repeatability/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

#include "bench/support/quantile.hpp"
#include "bench/support/quoted.hpp"

namespace semigeo::repeatability {
namespace {

using kernels::FeatureKind;

/// Meshes with fewer features are left out of medians, because one feature is too large a share.
constexpr std::int64_t kFewest = 5;

constexpr const char* kCsvHeader =
    "mesh,case,kind,level,radius,mean_edge_length,scale,changed_level,changed_scale,features,"
    "features_changed,share,chance,share_prominent,share_2_edges,share_scale,"
    "median_distance_edges,median_miss_edges\n";

const char* name_of(FeatureKind kind) {
  return kernels::kFeatureKindNames[static_cast<int>(kind)];
}

/// Returns the different values in the order of their first appearance.
template <typename Value, typename Get>
std::vector<Value> distinct(std::span<const Row> rows, const Get& get) {
  std::vector<Value> values;
  for (const Row& row : rows)
    if (std::ranges::count(values, Value(std::invoke(get, row))) == 0)
      values.push_back(std::invoke(get, row));
  return values;
}

/// Names the rows of different meshes that belong together.
struct Key {
  FeatureKind kind = FeatureKind::kGaussian;
  int level = 0;
  double radius = 0;
  bool operator==(const Key&) const = default;
};
Key key_of(const Row& row) {
  return {row.kind, row.level, row.radius};
}

/// Holds medians over the meshes.
struct Summary {
  Key key;
  std::int64_t features = 0;  ///< Number of features of all meshes together.
  std::int64_t meshes = 0;    ///< Number of meshes with enough features for the medians.
  Repeats median;
};

Summary summary(std::span<const Row> rows, const std::string& change, const Key& key) {
  Summary result;
  result.key = key;
  std::vector<const Repeats*> used;
  for (const Row& row : rows)
    if (row.change == change && key_of(row) == key) {
      result.features += row.repeats.features;
      if (row.repeats.features >= kFewest) used.push_back(&row.repeats);
    }
  result.meshes = std::ssize(used);
  for (double Repeats::*value :
       {&Repeats::share, &Repeats::chance, &Repeats::share_prominent, &Repeats::share_twice,
        &Repeats::share_scale, &Repeats::median_distance, &Repeats::median_miss}) {
    std::vector<double> values;
    for (const Repeats* repeats : used)
      if (!std::isnan(repeats->*value)) values.push_back(repeats->*value);
    result.median.*value = bench::median(values);
  }
  return result;
}

std::string percent(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.0f", 100 * share);
  return std::isnan(share) ? "-" : text;
}

void print_case(std::span<const Row> rows, const std::string& change,
                const std::vector<double>& radii) {
  std::printf("\n%-18s %5s", change.c_str(), "level");
  for (const double radius : radii) std::printf(" | radius %-12g", radius);
  std::printf("\n");
  for (const auto kind : distinct<FeatureKind>(rows, &Row::kind))
    for (const int level : distinct<int>(rows, &Row::level)) {
      std::printf("%-18s %5d", name_of(kind), level);
      for (const double radius : has_radius(kind) ? radii : std::vector{0.0}) {
        const Summary s = summary(rows, change, {kind, level, radius});
        std::printf(" | %3s (%3s) %9lld", percent(s.median.share).c_str(),
                    percent(s.median.chance).c_str(), static_cast<long long>(s.features));
      }
      std::printf("\n");
    }
}

/// Returns the kind, level and radius whose features reappear most often beyond chance, by the mean
/// of these cases. At least half of the meshes must have enough features; otherwise there is no
/// result.
std::optional<Key> best_key(std::span<const Row> rows, const std::vector<std::string>& changes) {
  const auto meshes = std::ssize(distinct<std::string>(rows, &Row::mesh));
  std::optional<Key> best;
  double best_gain = 0;
  for (const Key& key : distinct<Key>(rows, key_of)) {
    double gain = 0;
    bool enough = true;
    for (const std::string& change : changes) {
      const Summary s = summary(rows, change, key);
      enough = enough && s.meshes > 0 && 2 * s.meshes >= meshes;
      gain += s.median.share - s.median.chance;
    }
    if (!enough || gain <= best_gain) continue;
    best_gain = gain;
    best = key;
  }
  return best;
}

void print_best(std::span<const Row> rows, const std::vector<std::string>& changes,
                const char* name) {
  const std::optional<Key> key = best_key(rows, changes);
  if (!key) {
    std::printf("best kind and level, %s: too few features\n", name);
    return;
  }
  std::printf("best kind and level, %s: %s, level %d", name, name_of(key->kind), key->level);
  if (has_radius(key->kind)) std::printf(", radius %g", key->radius);
  std::printf("\n");
  for (const std::string& change : changes) {
    const Summary s = summary(rows, change, *key);
    std::printf(
        "  %-16s %3s %% (chance %s %%), of the more prominent half %s %%, within 2 edges %s %%",
        change.c_str(), percent(s.median.share).c_str(), percent(s.median.chance).c_str(),
        percent(s.median.share_prominent).c_str(), percent(s.median.share_twice).c_str());
    if (!std::isnan(s.median.median_miss))
      std::printf("; misses at %.1f edges", s.median.median_miss);
    std::printf("\n");
  }
}

}  // namespace

std::string csv(std::span<const Row> rows) {
  std::string text = kCsvHeader;
  for (const Row& row : rows) {
    const Repeats& r = row.repeats;
    char cells[400];
    std::snprintf(cells, sizeof cells,
                  ",%s,%s,%d,%g,%.9g,%.9g,%d,%.9g,%lld,%lld,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g\n",
                  row.change.c_str(), name_of(row.kind), row.level, row.radius,
                  row.mean_edge_length, row.scale, row.changed_level, row.changed_scale,
                  static_cast<long long>(r.features), static_cast<long long>(r.found), r.share,
                  r.chance, r.share_prominent, r.share_twice, r.share_scale, r.median_distance,
                  r.median_miss);
    text += bench::quoted(row.mesh) + cells;
  }
  return text;
}

void print(std::span<const Row> rows) {
  const auto changes = distinct<std::string>(rows, &Row::change);
  std::vector<double> radii;
  for (const Row& row : rows)
    if (has_radius(row.kind) && std::ranges::count(radii, row.radius) == 0)
      radii.push_back(row.radius);
  std::printf(
      "Share of the features that come back, %% (by chance, %%), and their number, all meshes "
      "together.\nMedian over the meshes that have at least %lld.\n",
      static_cast<long long>(kFewest));
  for (const std::string& change : changes) print_case(rows, change, radii);
  std::printf("\n");
  for (const std::string& change : changes) print_best(rows, {change}, change.c_str());
  std::vector<std::string> hard;
  for (const std::string& change : changes)
    if (change != "identity" && change != "rotated") hard.push_back(change);
  if (hard.size() > 1) print_best(rows, hard, "on average");
}

}  // namespace semigeo::repeatability
