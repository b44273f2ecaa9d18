#include <memory>
#include <string>
#include <vector>

#include "io/dataset/dataset.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "io/files/lower_case.hpp"
#include "io/files/png.hpp"
#include "jobs/cli/choice.hpp"
#include "jobs/cli/chosen_level.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/cli/table_options.hpp"
#include "jobs/picture/picture.hpp"

namespace semigeo::jobs::cli {
namespace {

using kernels::kContourKinds;
using kernels::kFeatureKindNames;
using kernels::kFeatureKinds;

/// A picture has at most so many pixels. It and its PNG take about two gigabytes of memory then.
constexpr std::int64_t kMostPixels = 200'000'000;

/// Bounds of --limit.
constexpr double kLeastLimit = 1e-30;
constexpr double kGreatestLimit = 1e30;

struct PictureCommand {
  std::string dataset;
  std::string output;
  std::string features;  ///< A kind of feature, "all", or empty.
  std::string contours;  ///< A kind of contour, "all", or empty.
  double limit = 0;      ///< 0: a robust limit.
  PictureOptions picture;
};

/// Returns what is wrong with the text of --limit, or an empty string. Colours are computed in
/// single precision.
std::string limit_problem(const std::string& text) {
  double value = 0;
  const bool is_number = CLI::detail::lexical_cast(text, value);
  if (is_number && (value == 0 || (value >= kLeastLimit && value <= kGreatestLimit))) return "";
  return "give a curvature from 1e-30 to 1e30, or 0";
}

int make_picture(PictureCommand& command) {
  if (io::lower_case(std::filesystem::path(command.output).extension().string()) != ".png")
    throw CLI::ValidationError("--output", command.output +
                                               " does not say how to write it: give a name that "
                                               "ends in .png");
  if (std::error_code ignored; std::filesystem::is_directory(command.dataset, ignored))
    throw io::Error(command.dataset, "", "is a folder, not a dataset",
                    "give one dataset: " +
                        (std::filesystem::path(command.dataset) / "scans/NAME.vtkhdf").string());
  PictureOptions& options = command.picture;
  const io::Dataset dataset(command.dataset);
  if (options.levels.empty()) options.levels = {static_cast<int>(dataset.selection().level)};
  for (const int level : options.levels) require_level(dataset, level);
  if (static_cast<std::int64_t>(options.levels.size()) * 2 * options.size * options.size >
      kMostPixels)
    throw CLI::ValidationError("--size",
                               "the picture would have more than 200 million pixels: give "
                               "a smaller one, or fewer levels");
  for (int kind = 0; kind < kFeatureKinds; ++kind)
    options.features[kind] =
        command.features == "all" || command.features == kFeatureKindNames[kind];
  for (int kind = 0; kind < kContourKinds; ++kind)
    options.contours[kind] =
        command.contours == "all" || command.contours == kFeatureKindNames[kind];
  if (command.limit > 0) options.limit = command.limit;

  const DatasetPicture picture = picture_of(dataset, options);
  io::write_file_atomically(command.output, io::png_of(picture.image));
  print(command.output, ": ", picture.image.width, " x ", picture.image.height, " pixels");
  if (options.field != PictureField::kNone)
    print(", colours from ", -picture.limit, " to ", picture.limit);
  print("\n");
  return kAllDone;
}

}  // namespace

void add_picture(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<PictureCommand>();
  CLI::App* command = app.add_subcommand(
      "picture", "Draw levels of a dataset as a PNG: shaded, coloured by curvature, with a legend");
  command->footer(
      "Examples:\n"
      "  semigeo picture archive/scans/x.ply.vtkhdf --output x.png\n"
      "  semigeo picture archive/scans/x.ply.vtkhdf --level 4 --field gaussian --view front -o "
      "k.png\n"
      "  semigeo picture archive/scans/x.ply.vtkhdf --levels 0,2,4,8 --size 400 --output "
      "strip.png\n"
      "  semigeo picture archive/scans/x.ply.vtkhdf --features mean --contours all --output f.png\n"
      "\n"
      "No display is needed. The colours of all levels of a picture mean the same. Their ends are\n"
      "the 98th percentile of |H| or |K| over the valid vertices, unless --limit names them.\n");
  command->add_option("dataset", options->dataset, "A dataset")->required();
  CLI::Option* level =
      command
          ->add_option_function<int>(
              "--level", [options](int value) { options->picture.levels = {value}; },
              "Scale level; without it, the one at which the scan is recognised")
          ->check(CLI::Range(0, 999));
  command
      ->add_option("--levels", options->picture.levels, "Several levels beside each other: 0,2,4,8")
      ->delimiter(',')
      ->default_str("")
      ->check(CLI::Range(0, 999))
      ->excludes(level);
  PictureOptions& picture = options->picture;
  add_choice(*command, "--field", picture.field, kPictureFieldNames,
             "Colour by mean or Gaussian curvature, or not");
  add_choice(*command, "--view", picture.view, kViewNames,
             "From where: the front is towards +z, or towards -y with --up z");
  add_choice(*command, "--up", picture.up, kUpAxisNames, "Axis of the scan that points upwards");
  add_choice(*command, "--colours", picture.scale, kColourScaleNames,
             "safe: blue, white, orange, for all kinds of sight; thesis: blue, green, red");
  command
      ->add_option("--limit", options->limit,
                   "End of the colours, as a curvature in the scan's unit; 0: found in the data")
      ->check(CLI::Validator(limit_problem, ""));
  command->add_option("--features", options->features, "Mark features of this kind")
      ->check(CLI::IsMember({"gaussian", "mean", "gaussian_torsion", "mean_torsion", "all"}));
  command
      ->add_option("--contours", options->contours, "Draw contours K = 0 (gaussian), H = 0 (mean)")
      ->check(CLI::IsMember({"gaussian", "mean", "all"}));
  command
      ->add_option("--size", picture.size, "Height in pixels; the width follows from the surface")
      ->check(CLI::Range(64, 8192));
  command->add_option("-o,--output", options->output, "The file to write, .png")->required();
  command->callback([options, &exit_code] { exit_code = make_picture(*options); });
}

}  // namespace semigeo::jobs::cli
