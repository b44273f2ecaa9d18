#include "bench/recognition/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "bench/recognition/heap_scene.hpp"
#include "bench/support/quantile.hpp"

namespace semigeo::recognition {
namespace {

using Json = nlohmann::json;

bool absent(const Outcome& outcome) {
  return outcome.kind.starts_with(kAbsent);
}

std::vector<std::string> kinds_of(std::span<const Outcome> outcomes) {
  std::vector<std::string> kinds;
  for (const Outcome& outcome : outcomes)
    if (std::ranges::count(kinds, outcome.kind) == 0) kinds.push_back(outcome.kind);
  return kinds;
}

/// Collects numbers over the scenes of a kind.
struct Summary {
  int scenes = 0, named = 0, posed = 0, reported = 0;
  int objects = 0, objects_reported = 0;
  int false_scenes = 0, false_objects = 0;
  std::vector<double> right, wrong;                     ///< Scores in the ranking.
  std::vector<double> degrees, centre;                  ///< Errors of right poses.
  std::vector<double> scale_space, search, total, cpu;  ///< In seconds.
};

Summary summary(std::span<const Outcome> outcomes, const std::string& kind) {
  Summary s;
  for (const Outcome& o : outcomes) {
    if (o.kind != kind) continue;
    ++s.scenes;
    s.named += o.named() ? 1 : 0;
    s.posed += o.posed() ? 1 : 0;
    s.reported += o.reported() ? 1 : 0;
    s.objects += static_cast<int>(o.objects.size());
    s.false_scenes += o.false_objects > 0 ? 1 : 0;
    s.false_objects += o.false_objects;
    for (const ObjectOutcome& object : o.objects) {
      s.objects_reported += object.reported ? 1 : 0;
      if (!right(object.ranked)) continue;
      s.right.push_back(object.score);
      s.degrees.push_back(object.ranked.degrees);
      s.centre.push_back(object.ranked.centre);
    }
    if (!o.best_wrong.empty()) s.wrong.push_back(o.best_wrong_score);
    s.scale_space.push_back(o.scale_space.wall);
    s.search.push_back(o.search.wall);
    s.total.push_back(o.scale_space.wall + o.search.wall);
    s.cpu.push_back(o.scale_space.cpu + o.search.cpu);
  }
  return s;
}

std::string number(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

/// Returns quantiles as the text of one cell.
std::string spread(std::vector<double>& values, std::array<double, 3> shares) {
  std::string text;
  for (const double share : shares)
    text += (text.empty() ? "" : " ") + number(bench::quantile(values, share), 3);
  return text;
}

void print_rates(std::span<const Outcome> outcomes) {
  std::printf("%-6s %6s %6s %6s %8s %11s %12s | %-19s | %-19s | %s\n", "kind", "scenes", "named",
              "posed", "reported", "objects", "false", "right: min 5% med", "wrong: med 95% max",
              "turned, moved (median)");
  for (const std::string& kind : kinds_of(outcomes)) {
    Summary s = summary(outcomes, kind);
    char objects[32], wrong[32];
    std::snprintf(objects, sizeof objects, "%d of %d", s.objects_reported, s.objects);
    std::snprintf(wrong, sizeof wrong, "%d in %d", s.false_objects, s.false_scenes);
    std::printf("%-6s %6d %6d %6d %8d %11s %12s | %-19s | %-19s | %s deg, %s %%\n", kind.c_str(),
                s.scenes, s.named, s.posed, s.reported, objects, wrong,
                spread(s.right, {0, 0.05, 0.5}).c_str(), spread(s.wrong, {0.5, 0.95, 1}).c_str(),
                number(bench::median(s.degrees), 2).c_str(),
                number(100 * bench::median(s.centre), 2).c_str());
  }
}

void print_seconds(std::span<const Outcome> outcomes) {
  std::printf("\n%-6s %12s %12s %14s %14s %14s\n", "kind", "median s", "max s", "scale space",
              "search", "cpu, median");
  for (const std::string& kind : kinds_of(outcomes)) {
    Summary s = summary(outcomes, kind);
    std::printf("%-6s %12.2f %12.2f %14.2f %14.2f %14.2f\n", kind.c_str(), bench::median(s.total),
                bench::quantile(s.total, 1), bench::median(s.scale_space), bench::median(s.search),
                bench::median(s.cpu));
  }
}

void print_scene(const Outcome& o) {
  std::printf("  %-5s %-24s seed %-3llu", o.kind.c_str(), o.scene.c_str(),
              static_cast<unsigned long long>(o.seed));
}

void print_object(const ObjectOutcome& object) {
  std::printf(" %s: rank %d, score %.3f", object.model.c_str(), object.rank, object.score);
  const PoseError& error = object.ranked;
  if (error.known() && !right(error))
    std::printf(", off by %.0f degrees, %.1f %%, scale %.1f %%, surface %.1f %%", error.degrees,
                100 * error.centre, 100 * error.scale, 100 * error.surface);
  std::printf("%s;", object.reported ? "" : ", not reported");
}

Json pose_json(const PoseError& error) {
  if (!error.known()) return nullptr;
  return {{"degrees", error.degrees}, {"centre", error.centre},   {"box", error.box},
          {"scale", error.scale},     {"surface", error.surface}, {"right", right(error)}};
}

Json seconds_json(const Seconds& seconds) {
  return {{"wall", seconds.wall}, {"cpu", seconds.cpu}};
}

Json diagnosis_json(const std::optional<Diagnosis>& diagnosis) {
  if (!diagnosis) return nullptr;
  return {{"features", diagnosis->features},
          {"matches", diagnosis->matches},
          {"votes", diagnosis->votes},
          {"cluster", diagnosis->cluster},
          {"score", diagnosis->score}};
}

/// Returns what the scores of a ranking are made of.
Json ranking_json(const std::vector<RankedModel>& ranking) {
  Json list = Json::array();
  for (const auto& [model, is_right, c] : ranking) {
    const kernels::View view = c.view.value_or(kernels::View{});
    list.push_back({{"model", model},
                    {"right", is_right},
                    {"score", c.score},
                    {"match", c.match},
                    {"conflict", c.conflict},
                    {"closeness", c.closeness},
                    {"stability", c.stability},
                    {"support", c.support},
                    {"explained", c.explained},
                    {"view_score", c.view_score},
                    {"there", view.there},
                    {"behind", view.behind},
                    {"nothing", view.nothing},
                    {"opposed", view.opposed}});
  }
  return list;
}

Json outcome_json(const Outcome& o) {
  Json objects = Json::array();
  for (const ObjectOutcome& object : o.objects)
    objects.push_back({{"model", object.model},
                       {"rank", object.rank},
                       {"score", object.score},
                       {"pose_error", pose_json(object.ranked)},
                       {"occlusion", object.occlusion},
                       {"clutter", object.clutter},
                       {"diagnosis", diagnosis_json(object.diagnosis)},
                       {"reported", object.reported}});
  return {{"kind", o.kind},
          {"ranking", ranking_json(o.ranking)},
          {"single_view", o.single_view},
          {"scene", o.scene},
          {"seed", o.seed},
          {"vertices", o.vertices},
          {"features", o.features},
          {"noise", o.noise},
          {"mixed_pixels", o.mixed_pixels},
          {"scene_triplets", o.scene_triplets},
          {"matches", o.matches},
          {"named", o.named()},
          {"posed", o.posed()},
          {"reported", o.reported()},
          {"objects", objects},
          {"first", o.first},
          {"best_wrong", {{"model", o.best_wrong}, {"score", o.best_wrong_score}}},
          {"false_objects", o.false_objects},
          {"false_score", o.false_score},
          {"false_best", o.false_best},
          {"scale_space_seconds", seconds_json(o.scale_space)},
          {"search_seconds", seconds_json(o.search)}};
}

Json summary_json(std::span<const Outcome> outcomes, const std::string& kind) {
  Summary s = summary(outcomes, kind);
  return {{"scenes", s.scenes},
          {"named", s.named},
          {"posed", s.posed},
          {"reported", s.reported},
          {"objects", s.objects},
          {"objects_reported", s.objects_reported},
          {"false_scenes", s.false_scenes},
          {"false_objects", s.false_objects},
          {"median_seconds", bench::median(s.total)},
          {"max_seconds", bench::quantile(s.total, 1)},
          {"median_scale_space_seconds", bench::median(s.scale_space)}};
}

}  // namespace

void print(std::span<const Outcome> outcomes) {
  if (outcomes.empty()) return;
  print_rates(outcomes);
  print_seconds(outcomes);
}

void print_misses(std::span<const Outcome> outcomes) {
  bool any = false;
  for (const Outcome& o : outcomes) {
    // Heaps have a report of their own.
    if (absent(o) || o.kind == kHeap || (o.posed() && o.reported())) continue;
    if (!std::exchange(any, true)) std::printf("\nMissed\n");
    print_scene(o);
    std::printf(" %s, first %s;",
                !o.named()   ? "not named"
                : !o.posed() ? "wrong pose"
                             : "not reported",
                o.first.empty() ? "nothing" : o.first.c_str());
    for (const ObjectOutcome& object : o.objects) print_object(object);
    if (!o.best_wrong.empty())
      std::printf(" best wrong %s %.3f", o.best_wrong.c_str(), o.best_wrong_score);
    std::printf("\n");
  }
  any = false;
  for (const Outcome& o : outcomes) {
    if (o.false_objects == 0) continue;
    if (!std::exchange(any, true)) std::printf("\nReported, but not there or not so\n");
    print_scene(o);
    std::printf(" %d, the best %s %.3f\n", o.false_objects, o.false_best.c_str(), o.false_score);
  }
}

std::string json(std::span<const Outcome> outcomes, const std::vector<std::string>& arguments,
                 const std::vector<std::string>& models) {
  Json document = {{"arguments", arguments},
                   {"models", models},
                   {"kinds", Json::object()},
                   {"scenes", Json::array()}};
  for (const std::string& kind : kinds_of(outcomes))
    document["kinds"][kind] = summary_json(outcomes, kind);
  for (const Outcome& outcome : outcomes) document["scenes"].push_back(outcome_json(outcome));
  return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace semigeo::recognition
