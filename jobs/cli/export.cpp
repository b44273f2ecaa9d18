#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "io/dataset/dataset.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "jobs/archive/in_children.hpp"
#include "jobs/cli/choice.hpp"
#include "jobs/cli/chosen_level.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/datasets.hpp"
#include "jobs/cli/export_level.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/run/local_runner.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::string source;  ///< A dataset, or an archive.
  int level = 0;
  std::string levels;  ///< "0,2,4", "all", or empty.
  std::string output;
  std::string format;  ///< An extension without its dot, or empty.
  LevelExport what;
};

/// Returns the extensions that can be written, for a message: ".ply or .csv".
std::string extensions_for(const LevelExport& what) {
  std::vector<std::string> extensions;
  for (const ExportFormatInfo& format : kExportFormats)
    if (what.is_surface() ? format.surfaces : format.tables)
      extensions.emplace_back(format.extension);
  std::string text;
  for (std::size_t i = 0; i < extensions.size(); ++i)
    text += (i == 0 ? "" : i + 1 == extensions.size() ? " or " : ", ") + extensions[i];
  return text;
}

/// Sets the format that an extension names. A surface cannot be written as CSV.
void choose_format(LevelExport& what, const std::string& extension, const char* option,
                   const std::string& given) {
  const auto format = format_of_extension(extension);
  const bool fits =
      format && (what.is_surface() ? kExportFormats[static_cast<std::size_t>(*format)].surfaces
                                   : kExportFormats[static_cast<std::size_t>(*format)].tables);
  if (!fits)
    throw CLI::ValidationError(option, given +
                                           " does not say how to write it: give a name that "
                                           "ends in " +
                                           extensions_for(what));
  what.format = *format;
}

/// Returns the extension that files in a folder get without --format.
std::string usual_extension(const LevelExport& what) {
  if (!what.is_surface()) return ".csv";
  return what.dialect == Dialect::kParaview ? ".vtp" : ".ply";
}

/// Returns the levels that --levels names in a dataset.
std::vector<int> levels_of(const ExportOptions& options, const io::Dataset& dataset) {
  std::vector<int> levels;
  if (options.levels == "all") {
    for (int level = 0; level < dataset.level_count(); ++level) levels.push_back(level);
    return levels;
  }
  if (options.levels.empty()) return {options.level};
  std::istringstream list(options.levels);
  for (std::string number; std::getline(list, number, ',');) levels.push_back(std::stoi(number));
  return levels;
}

/// Returns what is wrong with the text of --levels, or an empty string.
std::string levels_problem(const std::string& text) {
  if (text == "all") return "";
  constexpr std::size_t kMostDigits = 3;
  std::istringstream list(text);
  std::size_t count = 0;
  for (std::string number; std::getline(list, number, ','); ++count)
    if (number.empty() || number.size() > kMostDigits ||
        number.find_first_not_of("0123456789") != std::string::npos)
      return "give numbers of levels with commas between them (0,2,4), or all";
  return count == 0 || text.back() == ',' ? "give levels" : "";
}

/// Returns the name of a file in a folder: "a.ply.004.vtp", "a.ply.004.features.csv".
std::string file_name(const fs::path& dataset, int level, const LevelExport& what) {
  const std::string number = std::to_string(level);
  std::string name = dataset.stem().string() + "." + std::string(3 - number.size(), '0') + number;
  if (!what.features.empty()) name += ".features";
  if (!what.contours.empty()) name += ".contours";
  return name + std::string(kExportFormats[static_cast<std::size_t>(what.format)].extension);
}

/// Exports the levels of a dataset into a folder. Returns lines for people.
std::string export_dataset(const fs::path& path, const ExportOptions& options) {
  const io::Dataset dataset(path);
  const std::vector<int> levels = levels_of(options, dataset);
  for (const int level : levels) require_level(dataset, level);
  std::string lines;
  for (const int level : levels)
    lines +=
        export_level(dataset, level,
                     fs::path(options.output) / file_name(path, level, options.what), options.what);
  return lines;
}

/// CPU seconds that a dataset may take: far more than it needs. HDF5 never ends over some damaged
/// files.
double most_seconds(const fs::path& dataset) {
  constexpr double kLeast = 60;
  constexpr double kBytesPerSecond = 1e6;
  std::error_code error;
  const auto bytes = fs::file_size(dataset, error);
  return kLeast + (error ? 0 : static_cast<double>(bytes) / kBytesPerSecond);
}

/// Returns the memory that exporting a level of a dataset takes at most. Measured on datasets of
/// one level, with which it takes most for their size.
std::uint64_t most_bytes(const fs::path& dataset) {
  constexpr std::uint64_t kBase = 25'000'000;
  constexpr std::uint64_t kPerByte = 4;
  std::error_code error;
  const auto bytes = fs::file_size(dataset, error);
  return kBase + (error ? 0 : kPerByte * bytes);
}

/// Exports datasets into a folder, each in a child process: what one of them does stops no other.
int export_all(const ExportOptions& options, const std::vector<fs::path>& datasets) {
  std::error_code error;
  fs::create_directories(options.output, error);
  if (error) throw io::Error(options.output, "", "cannot be made: " + error.message());
  constexpr char kDone = '+';
  constexpr char kFailed = '-';
  const auto work = [&](std::size_t i) {
    try {
      return kDone + export_dataset(datasets[i], options);
    } catch (const io::Error& e) {
      return kFailed + std::string(e.what());
    } catch (const std::exception& e) {  // it does not name the dataset
      return kFailed + std::string(io::Error(datasets[i], "", e.what()).what());
    }
  };
  const auto results = in_children(
      datasets.size(), execution_settings({}).total, work,
      [&](std::size_t i) { return most_seconds(datasets[i]); },
      [&](std::size_t i) { return most_bytes(datasets[i]); });
  std::size_t failed = 0;
  for (std::size_t i = 0; i < datasets.size(); ++i) {
    const std::string& text = results[i].text;
    if (results[i].exit_code == 0 && text.starts_with(kDone)) {
      print_text(text.substr(1));
      continue;
    }
    ++failed;
    if (text.starts_with(kFailed)) {
      complain(text.substr(1));
    } else {
      complain(unfinished_reading(results[i], datasets[i]));
    }
  }
  io::remove_stale_partials(options.output);
  if (datasets.size() > 1)
    print(datasets.size() - failed, " datasets exported, ", failed, " failed\n");
  return failed == 0 ? kAllDone : kSomeFailed;
}

/// Returns whether the output is a folder for files of several levels or datasets.
bool has_folder(const ExportOptions& options) {
  std::error_code error;
  return !options.levels.empty() || fs::is_directory(options.source, error) ||
         fs::is_directory(options.output, error) || options.output.ends_with('/');
}

int export_source(ExportOptions options) {
  if (has_folder(options)) {
    const std::string extension =
        options.format.empty() ? usual_extension(options.what) : "." + options.format;
    choose_format(options.what, extension, "--format", options.format);
    return export_all(options, datasets_at(options.source));
  }
  const std::string extension =
      options.format.empty() ? fs::path(options.output).extension().string() : "." + options.format;
  choose_format(options.what, extension, "--output", options.output);
  const io::Dataset dataset(options.source);
  require_level(dataset, options.level);
  print_text(export_level(dataset, options.level, options.output, options.what));
  return kAllDone;
}

void add_content_options(CLI::App& command, LevelExport& what) {
  CLI::Option* quality =
      command
          .add_option("--quality", what.quality,
                      "Field that becomes `quality`, and that colours show")
          ->check(CLI::IsMember({"gaussian_curvature", "mean_curvature", "patch_completeness",
                                 "principal_curvature_1", "principal_curvature_2"}));
  CLI::Option* features =
      command
          .add_option("--features", what.features,
                      "Features of this kind instead of the surface: maxima of |K|, of |H|, of "
                      "torsion along K = 0, along H = 0")
          ->check(CLI::IsMember({"gaussian", "mean", "gaussian_torsion", "mean_torsion", "all"}))
          ->excludes(quality);
  command
      .add_option("--contours", what.contours,
                  "Contours K = 0 (gaussian) or H = 0 (mean) instead of the surface")
      ->check(CLI::IsMember({"gaussian", "mean"}))
      ->excludes(quality)
      ->excludes(features);
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand(
      "export",
      "Write levels of a dataset or an archive for other programs: surfaces, features, "
      "contours");
  command->footer(
      "Examples:\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --level 4 --output smooth.ply\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --output k.ply --quality gaussian_curvature\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --level 4 --features all --output f.csv\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --level 4 --contours mean --output lines.ply\n"
      "  semigeo export archive --levels 0,4,8 --for cloudcompare --output folder\n"
      "  semigeo export archive --levels all --format npz --output folder\n"
      "\n"
      "The extension of --output says the format; `semigeo formats` lists them. Of an archive or\n"
      "of several levels, --output is a folder, and files are named after dataset and level:\n"
      "x.ply.004.ply. A dataset that cannot be exported does not stop the others.\n");
  command->add_option("dataset", options->source, "A dataset, or an archive")->required();
  CLI::Option* level =
      command->add_option("--level", options->level, "Scale level")->check(CLI::Range(0, 999));
  command->add_option("--levels", options->levels, "Several levels: 0,2,4, or all of them: all")
      ->check(CLI::Validator(levels_problem, ""))
      ->excludes(level);
  command->add_option("-o,--output", options->output, "The file or folder to write")->required();
  command
      ->add_option("--format", options->format,
                   "Format of files in a folder; without it .ply, .vtp for paraview, .csv for "
                   "features and contours")
      ->check(CLI::IsMember({"ply", "obj", "stl", "glb", "vtp", "npz", "csv"}));
  add_choice(*command, "--for", options->what.dialect, kDialectNames,
             "Program that will read it: fields under its names, and colours where it has them");
  add_choice(*command, "--colours", options->what.scale, kColourScaleNames,
             "Colours of --quality: safe for all kinds of sight, or those of the thesis");
  add_content_options(*command, options->what);
  command->callback([options, &exit_code] { exit_code = export_source(*options); });
}

}  // namespace semigeo::jobs::cli
