#include <algorithm>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/files/container.hpp"
#include "io/files/error.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/container_info.hpp"
#include "jobs/cli/datasets.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/output.hpp"
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

using Rows = std::vector<std::vector<std::string>>;

std::string whole(const nlohmann::json& number) {
  return std::to_string(number.get<std::int64_t>());
}

std::string real(const nlohmann::json& number) {
  return io::number_text(number.get<double>());
}

/// Returns a number that the dataset holds as a float.
std::string small_real(const nlohmann::json& number) {
  return io::number_text(number.get<float>());
}

std::string from_to(const nlohmann::json& range) {
  return small_real(range[0]) + " .. " + small_real(range[1]);
}

void print_levels(const nlohmann::json& d) {
  Rows rows = {{"level", "scale", "vertices", "triangles", "parts", "K from .. to", "H from .. to",
                "truncated", "invalid", "remeshed"}};
  for (const auto& level : d["levels"])
    rows.push_back({std::to_string(rows.size() - 1), real(level["scale"]), whole(level["vertices"]),
                    whole(level["triangles"]), whole(level["parts"]),
                    from_to(level["gaussian_curvature"]), from_to(level["mean_curvature"]),
                    whole(level["truncated_vertices"]), whole(level["invalid_vertices"]),
                    remeshing_in_words(level["remeshing"])});
  print_text(table_text(rows, 2, "rlllllllll"));
}

void print_features(const nlohmann::json& d) {
  Rows rows = {{"level", "max |K|", "max |H|", "torsion on K = 0", "on H = 0", "features",
                "smoothed", "K = 0", "length", "H = 0", "length"}};
  const nlohmann::json& selection = d["selection"];
  for (const auto& level : d["levels"]) {
    const std::size_t k = rows.size() - 1;
    const nlohmann::json& features = level["features"];
    const nlohmann::json& gaussian = level["contours"]["gaussian"];
    const nlohmann::json& mean = level["contours"]["mean"];
    rows.push_back({std::to_string(k), whole(features["gaussian"]), whole(features["mean"]),
                    whole(features["gaussian_torsion"]), whole(features["mean_torsion"]),
                    whole(selection["feature_counts"][k]),
                    io::fixed_text(selection["smoothed"][k].get<double>(), 2),
                    whole(gaussian["count"]), real(gaussian["length"]), whole(mean["count"]),
                    real(mean["length"])});
  }
  print_text(table_text(rows, 2, "rllllllllll"));
}

/// Returns "3 welded_vertices, 1 split_vertices"; "none" if nothing was repaired.
std::string repairs_in_words(const nlohmann::json& repairs) {
  std::string text;
  for (const auto& [name, count] : repairs.items())
    if (count != 0) text += (text.empty() ? "" : ", ") + count.dump() + " " + name;
  return text.empty() ? "none" : text;
}

void print_dataset(const nlohmann::json& d) {
  const auto text = [&](const char* name) { return d[name].get<std::string>(); };
  print(text("file"), "\n");
  print("  input       ", text("input_name"), " (xxh3 ", text("input_xxh3"), ")\n");
  print("  made by     semigeo ", text("creator_version"), " with ", d["parameters"].dump(), "\n");
  print("  repairs     ", repairs_in_words(d["repairs"]), "\n");
  if (!d["preparation"].empty()) print("  preparation ", d["preparation"].dump(), "\n");
  print("  length unit ", text("length_unit"), ", digest ", text("digest"), "\n");
  print("  origin      ", real(d["origin"][0]), " ", real(d["origin"][1]), " ",
        real(d["origin"][2]), "\n");
  const std::string_view chosen =
      d["selection"]["chosen"] == "slope" ? "the curve of its features" : "the user";
  print("  selection   level ", whole(d["selection"]["level"]), ", chosen by ", chosen, "\n");
  print_levels(d);
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
  constexpr std::size_t kNameWidth = 40;
  const auto number = [&](const char* name, std::size_t width) {
    const std::string digits = whole(d[name]);
    return std::string(width > digits.size() ? width - digits.size() : 0, ' ') + digits;
  };
  print_text(padded(io::printable(d["input_name"].get<std::string>()), kNameWidth));
  print(" ", number("vertices", 9), " vertices ", number("triangles", 9), " triangles ",
        number("parts", 4), " parts ", number("levels", 3), " levels, scale ", real(d["scales"][0]),
        " .. ", real(d["scales"][1]), "\n");
}

int info(const InfoOptions& options) {
  if (io::is_container_name(options.target) && std::filesystem::is_regular_file(options.target))
    return print_container(options.target, options.json);
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
      complain(e);
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
  CLI::App* command =
      app.add_subcommand("info", "Say what a dataset, an archive or a container of scans holds");
  command->footer(
      "Examples:\n"
      "  semigeo info archive                            one line per dataset\n"
      "  semigeo info archive/scans/x.ply.vtkhdf         levels, scales, curvature ranges, "
      "features\n"
      "  semigeo info archive/scans/x.ply.vtkhdf --json  the same for programs\n");
  command
      ->add_option("target", options->target,
                   "A dataset, an archive, or a container of scans (.zip, .7z, .tar)")
      ->required();
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options, &exit_code] { exit_code = info(*options); });
}

}  // namespace semigeo::jobs::cli
