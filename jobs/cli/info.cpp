#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/files/error.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/datasets.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/stages/surface_job.hpp"

namespace semigeo::jobs::cli {
namespace {

struct InfoOptions {
  std::string target;
  bool json = false;
};

/// The extremes of a field over the valid vertices of a level.
struct Range {
  float low = 0;
  float high = 0;
};

Range range_over_valid(const std::vector<float>& values, const std::vector<float>& completeness) {
  Range range;
  bool first = true;
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (completeness[v] <= 0) continue;
    range.low = first ? values[v] : std::min(range.low, values[v]);
    range.high = first ? values[v] : std::max(range.high, values[v]);
    first = false;
  }
  return range;
}

nlohmann::json features_json(const io::FeatureCounts& counts) {
  nlohmann::json json;
  for (int kind = 0; kind < kernels::kFeatureKinds; ++kind)
    json[kernels::kFeatureKindNames[kind]] = counts.of_kind[kind];
  return json;
}

nlohmann::json contours_json(const io::FeatureCounts& counts) {
  nlohmann::json json;
  for (int kind = 0; kind < io::kContourKinds; ++kind)
    json[kernels::kFeatureKindNames[kind]] = {{"count", counts.contours[kind]},
                                              {"length", counts.contour_length[kind]}};
  return json;
}

nlohmann::json selection_json(const io::Selection& selection) {
  return {{"level", selection.level},
          {"chosen", io::name_of(selection.chosen)},
          {"feature_counts", selection.feature_counts},
          {"smoothed", selection.smoothed}};
}

nlohmann::json level_json(const io::Dataset& dataset, int k) {
  const io::LevelInfo info = dataset.level(k);
  const auto completeness = dataset.read_floats(k, "patch_completeness");
  const Range gaussian =
      range_over_valid(dataset.read_floats(k, "gaussian_curvature"), completeness);
  const Range mean = range_over_valid(dataset.read_floats(k, "mean_curvature"), completeness);
  const auto invalid = std::count(completeness.begin(), completeness.end(), 0.0f);
  const auto truncated =
      std::count_if(completeness.begin(), completeness.end(), [](float c) { return c < 1; });
  return {{"iteration", info.iteration},
          {"scale", info.scale},
          {"step", info.step},
          {"mean_edge_length", info.mean_edge_length},
          {"vertices", info.vertices},
          {"triangles", info.triangles},
          {"parts", info.parts},
          {"shortest_side", info.shortest_side},
          {"remeshing", json_of(info.remeshed)},
          {"features", features_json(info.features)},
          {"contours", contours_json(info.features)},
          {"gaussian_curvature", {gaussian.low, gaussian.high}},
          {"mean_curvature", {mean.low, mean.high}},
          {"invalid_vertices", invalid},
          {"truncated_vertices", truncated - invalid}};
}

nlohmann::json dataset_json(const std::filesystem::path& path) {
  const io::Dataset dataset(path);
  const io::DatasetHeader& header = dataset.header();
  nlohmann::json levels = nlohmann::json::array();
  for (int k = 0; k < dataset.level_count(); ++k) levels.push_back(level_json(dataset, k));
  return {{"file", path.string()},
          {"input_name", header.input_name},
          {"input_xxh3", header.input_xxh3},
          {"creator_version", dataset.creator_version()},
          {"parameters", header.parameters},
          {"repairs", header.repairs},
          {"preparation", header.preparation},
          {"length_unit", header.length_unit},
          {"origin", header.origin},
          {"digest", dataset.digest()},
          {"selection", selection_json(dataset.selection())},
          {"levels", std::move(levels)}};
}

/// Returns "12 split, 9 collapsed, 1 torn", without the counts that are zero.
std::string remeshing_in_words(const nlohmann::json& counts) {
  std::string text;
  for (const auto& [name, word] : {std::pair("flipped", "flipped"), std::pair("split", "split"),
                                   std::pair("collapsed", "collapsed"), std::pair("torn", "torn"),
                                   std::pair("dropped_parts", "parts lost")})
    if (counts[name] != 0) text += (text.empty() ? "" : ", ") + counts[name].dump() + " " + word;
  return text;
}

void print_features(const nlohmann::json& d) {
  std::printf(
      "  level  max |K|  max |H|  torsion on K = 0, H = 0  features  smoothed   "
      "K = 0    length     H = 0    length\n");
  int k = 0;
  for (const auto& level : d["levels"]) {
    const nlohmann::json& features = level["features"];
    const nlohmann::json& contours = level["contours"];
    const auto count = [](const nlohmann::json& number) { return number.get<long long>(); };
    const auto length = [](const nlohmann::json& number) { return number.get<double>(); };
    std::printf(
        "  %5d  %-7lld  %-7lld  %-16lld  %-5lld  %-8lld  %-9.4g  %-7lld  %-9.4g  %-7lld  %.4g\n", k,
        count(features["gaussian"]), count(features["mean"]), count(features["gaussian_torsion"]),
        count(features["mean_torsion"]), count(d["selection"]["feature_counts"][k]),
        length(d["selection"]["smoothed"][k]), count(contours["gaussian"]["count"]),
        length(contours["gaussian"]["length"]), count(contours["mean"]["count"]),
        length(contours["mean"]["length"]));
    ++k;
  }
}

void print_dataset(const nlohmann::json& d) {
  std::printf("%s\n", d["file"].get<std::string>().c_str());
  std::printf("  input       %s (xxh3 %s)\n", d["input_name"].get<std::string>().c_str(),
              d["input_xxh3"].get<std::string>().c_str());
  std::printf("  made by     semigeo %s with %s\n", d["creator_version"].get<std::string>().c_str(),
              d["parameters"].dump().c_str());
  std::string repairs;
  for (const auto& [name, count] : d["repairs"].items())
    if (count != 0) repairs += (repairs.empty() ? "" : ", ") + count.dump() + " " + name;
  std::printf("  repairs     %s\n", repairs.empty() ? "none" : repairs.c_str());
  if (!d["preparation"].empty()) std::printf("  preparation %s\n", d["preparation"].dump().c_str());
  std::printf("  length unit %s, digest %s\n", d["length_unit"].get<std::string>().c_str(),
              d["digest"].get<std::string>().c_str());
  std::printf("  selection   level %lld, chosen by %s\n", d["selection"]["level"].get<long long>(),
              d["selection"]["chosen"] == "slope" ? "the curve of its features" : "the user");
  std::printf(
      "  level  scale       vertices   triangles  parts  K from .. to              "
      "H from .. to              truncated  invalid  remeshed\n");
  int k = 0;
  for (const auto& level : d["levels"])
    std::printf(
        "  %5d  %-10.4g  %-9lld  %-9lld  %-5lld  %-11.4g .. %-11.4g  %-11.4g .. %-11.4g  "
        "%-9lld  %-7lld  %s\n",
        k++, level["scale"].get<double>(), level["vertices"].get<long long>(),
        level["triangles"].get<long long>(), level["parts"].get<long long>(),
        level["gaussian_curvature"][0].get<double>(), level["gaussian_curvature"][1].get<double>(),
        level["mean_curvature"][0].get<double>(), level["mean_curvature"][1].get<double>(),
        level["truncated_vertices"].get<long long>(), level["invalid_vertices"].get<long long>(),
        remeshing_in_words(level["remeshing"]).c_str());
  print_features(d);
}

/// Returns the line of a dataset in the list of an archive, from attributes and sizes alone.
nlohmann::json summary_json(const std::filesystem::path& path) {
  const io::Dataset dataset(path);
  const io::LevelInfo first = dataset.level(0);
  const io::LevelInfo last = dataset.level(dataset.level_count() - 1);
  return {{"file", path.string()},
          {"input_name", dataset.header().input_name},
          {"vertices", first.vertices},
          {"triangles", first.triangles},
          {"parts", first.parts},
          {"levels", dataset.level_count()},
          {"scales", {first.scale, last.scale}},
          {"length_unit", dataset.header().length_unit}};
}

void print_summary(const nlohmann::json& d) {
  std::printf("%-40s %9lld vertices %9lld triangles %4lld parts %3lld levels, scale %.4g .. %.4g\n",
              d["input_name"].get<std::string>().c_str(), d["vertices"].get<long long>(),
              d["triangles"].get<long long>(), d["parts"].get<long long>(),
              d["levels"].get<long long>(), d["scales"][0].get<double>(),
              d["scales"][1].get<double>());
}

int info(const InfoOptions& options) {
  const auto datasets = datasets_at(options.target);
  const bool archive = std::filesystem::is_directory(options.target);
  nlohmann::json all = nlohmann::json::array();
  int exit_code = kAllDone;
  for (const auto& path : datasets) {
    try {
      auto document = archive ? summary_json(path) : dataset_json(path);
      if (!options.json) (archive ? print_summary : print_dataset)(document);
      all.push_back(std::move(document));
    } catch (const io::Error& e) {
      std::fprintf(stderr, "semigeo: %s\n", e.what());
      exit_code = kSomeFailed;
    }
  }
  if (options.json)
    print_document(archive       ? nlohmann::json{{"datasets", all}}
                   : all.empty() ? nlohmann::json::object()
                                 : all.front());
  return exit_code;
}

}  // namespace

void add_info(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand("info", "Say what a dataset or an archive holds");
  command->footer(
      "Examples:\n"
      "  semigeo info archive                            one line per dataset\n"
      "  semigeo info archive/scans/x.ply.vtkhdf         levels, scales, curvature ranges, "
      "features\n"
      "  semigeo info archive/scans/x.ply.vtkhdf --json  the same for programs\n");
  command->add_option("target", options->target, "A dataset, or an archive")->required();
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options, &exit_code] { exit_code = info(*options); });
}

}  // namespace semigeo::jobs::cli
