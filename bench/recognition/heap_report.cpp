#include "bench/recognition/heap_report.hpp"

#include <array>
#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "bench/recognition/heap_scene.hpp"

namespace semigeo::recognition {
namespace {

/// A range of occlusions.
struct Bin {
  const char* name;
  double from, to;
};
constexpr std::array kBins = {
    Bin{"below 50 %", -1, 0.5}, Bin{"50-60 %", 0.5, 0.6},   Bin{"60-70 %", 0.6, 0.7},
    Bin{"70-80 %", 0.7, 0.8},   Bin{"80-84 %", 0.8, 0.84},  Bin{"84-90 %", 0.84, 0.9},
    Bin{"beyond 90 %", 0.9, 2}, Bin{"up to 80 %", -1, 0.8}, Bin{"up to 84 %", -1, 0.84}};

/// A column of the table: the scenes that belong to it.
struct Column {
  const char* name;
  std::function<bool(const Outcome&)> has;
};

/// Returns "reported of all" for the objects of a bin in the scenes of a column.
std::string rate(std::span<const Outcome> outcomes, const Bin& bin, const Column& column) {
  int all = 0;
  int reported = 0;
  for (const Outcome& o : outcomes) {
    if (o.kind != kHeap || !column.has(o)) continue;
    for (const ObjectOutcome& object : o.objects) {
      if (object.occlusion < bin.from || object.occlusion >= bin.to) continue;
      ++all;
      reported += object.reported ? 1 : 0;
    }
  }
  return all == 0 ? "-" : std::to_string(reported) + " of " + std::to_string(all);
}

void print_rates(std::span<const Outcome> outcomes) {
  const std::array columns = {
      Column{"reported", [](const Outcome&) { return true; }},
      Column{"noise 0", [](const Outcome& o) { return o.noise == 0; }},
      Column{"0.1", [](const Outcome& o) { return o.noise == 0.1; }},
      Column{"0.25", [](const Outcome& o) { return o.noise == 0.25; }},
      Column{"sharp", [](const Outcome& o) { return !o.mixed_pixels; }},
      Column{"mixed", [](const Outcome& o) { return o.mixed_pixels; }},
  };
  std::printf("\n%-12s", "occlusion");
  for (const Column& column : columns) std::printf(" %10s", column.name);
  std::printf("\n");
  for (const Bin& bin : kBins) {
    std::printf("%-12s", bin.name);
    for (const Column& column : columns) std::printf(" %10s", rate(outcomes, bin, column).c_str());
    std::printf("\n");
  }
}

void print_missed(const Outcome& o, const ObjectOutcome& object, double min_score) {
  std::printf("  %-8s seed %llu  %-28s occlusion %.2f, clutter %.2f; rank %d, score %.3f, %s",
              o.scene.c_str(), static_cast<unsigned long long>(o.seed), object.model.c_str(),
              object.occlusion, object.clutter, object.rank, object.score,
              right(object.ranked) ? "right" : "wrong");
  if (object.diagnosis)
    std::printf("; lost at %s: %lld features, %lld matches, votes %.1f, cluster %.1f, score %.3f",
                object.diagnosis->lost(min_score).c_str(),
                static_cast<long long>(object.diagnosis->features),
                static_cast<long long>(object.diagnosis->matches), object.diagnosis->votes,
                object.diagnosis->cluster, object.diagnosis->score);
  std::printf("\n");
}

}  // namespace

void print_heaps(std::span<const Outcome> outcomes, double min_score) {
  bool any = false;
  for (const Outcome& o : outcomes) any = any || o.kind == kHeap;
  if (!any) return;
  print_rates(outcomes);
  std::printf("\nMissed in heaps\n");
  std::map<std::string, int> lost;
  for (const Outcome& o : outcomes) {
    if (o.kind != kHeap) continue;
    for (const ObjectOutcome& object : o.objects) {
      if (object.reported) continue;
      print_missed(o, object, min_score);
      if (object.diagnosis) ++lost[object.diagnosis->lost(min_score)];
    }
  }
  for (const auto& [where, count] : lost) std::printf("  %d lost at %s\n", count, where.c_str());
}

}  // namespace semigeo::recognition
