#include "jobs/stages/surface_parameters.hpp"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "io/files/printable.hpp"
#include "io/files/utf8.hpp"
#include "jobs/stages/depth_jump_row.hpp"
#include "jobs/stages/parameter_json.hpp"

namespace semigeo::jobs {
namespace {

using Surface = SurfaceParameters;
using Table = ParameterTable<Surface>;
using Integer = NumberIn<Surface, int>;
using BigInteger = NumberIn<Surface, std::int64_t>;
using Number = NumberIn<Surface, double>;

/// Returns what is wrong with the name of a unit, or an empty string.
std::string unit_problem(const std::string& unit) {
  constexpr const char* kRemedy = "give a short name such as mm or inch";
  if (!io::is_utf8(unit)) return std::string("is not UTF-8; ") + kRemedy;
  const bool plain = !unit.empty() && unit.size() <= 32 && io::printable(unit) == unit &&
                     unit.find_first_of("\"\\") == std::string::npos;
  return plain ? std::string() : kRemedy;
}

/// Returns the length that a text is, or nothing.
std::optional<double> length_in(const std::string& text) {
  double length = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, length);
  if (error != std::errc() || rest != end || !std::isfinite(length) || length <= 0) return {};
  return length;
}

/// Returns what is wrong with a choice of gaps, or an empty string.
std::string weld_problem(const std::string& weld) {
  if (weld == "auto" || weld == "exact" || length_in(weld)) return {};
  return "give auto, exact or a positive length in the scan's unit";
}

/// Returns the rows for what is done to a scan before it is smoothed.
Table preparation_rows() {
  using Options = PreparationOptions;
  constexpr auto kGroup = &Surface::preparation;
  return {
      depth_jump_row(field<&Surface::depth_jump>()),
      {.key = "weld",
       .name = "weld",
       .help =
           "Close gaps between triangles whose corners differ. auto: by what the numbers of the\n"
           "file are rounded to; exact: none; LENGTH: by at most so much, in the scan's unit",
       .value = Text<Surface>{field<&Surface::weld>(), weld_problem}},
      {.key = "fill_holes",
       .name = "fill-holes",
       .help = "Fill holes of at most so many edges; outer boundaries stay. 0: none",
       .value = BigInteger{field<kGroup, &Options::fill_holes>(), 0, 1000000}},
      {.key = "decimate",
       .name = "decimate",
       .help = "Remove vertices that lie this close to their surroundings: in mean edge\n"
               "lengths (0.1), or in the unit that --unit names (0.05mm)",
       .value = Tolerance<Surface>{field<kGroup, &Options::decimate>(),
                                   field<kGroup, &Options::decimate_in_length_units>()}},
      {.key = "target_vertices",
       .name = "target-vertices",
       .help = "Remove vertices, nearest to their surroundings first, until so many are left.\n"
               "0: no limit",
       .value = BigInteger{field<kGroup, &Options::target_vertices>(), 0, std::int64_t{1} << 31}},
  };
}

/// Returns the rows for levels, patches and steps.
Table evolution_rows() {
  using Options = EvolutionOptions;
  using kernels::Coordinates;
  constexpr auto kGroup = &Surface::evolution;
  return {
      {.key = "levels",
       .name = "levels",
       .help = "Smoothing iterations; every level is stored",
       .value = Integer{field<&Surface::levels>(), 0, 999}},
      {.key = "surface",
       .name = "surface",
       .help = "What patches sample: quadratic faces, or flat ones as in the thesis",
       .value = choice(field<kGroup, &Options::curved>(), {{"curved", true}, {"flat", false}})},
      {.key = "coordinates",
       .name = "coordinates",
       .help = "How patches are laid: a base line and its perpendiculars, or rays",
       .value =
           choice(field<kGroup, &Options::coordinates>(),
                  {{"semigeodesic", Coordinates::kSemigeodesic}, {"polar", Coordinates::kPolar}})},
      {.key = "schedule",
       .name = "schedule",
       .help =
           "Sample distance from level to level: the same, as in the thesis, or growing\n"
           "with the scale reached, so that two levels double it and the mesh is coarsened along",
       .value = choice(field<kGroup, &Options::schedule>(),
                       {{"uniform", Schedule::kUniform}, {"octaves", Schedule::kOctaves}})},
      {.key = "rescale",
       .name = "rescale",
       .help =
           "What each part gets back after a uniform smoothing: its size (radius of gyration),\n"
           "its mean edge length, as in the thesis, or nothing. Noise makes edges longer: noisy\n"
           "scans swell by the second",
       .value = choice(
           field<kGroup, &Options::rescale>(),
           {{"size", Rescale::kSize}, {"edges", Rescale::kEdges}, {"none", Rescale::kNone}})},
      {.key = "remesh",
       .name = "no-remesh",
       .help = "Keep the connectivity of level 0: no odd triangles removed, no necks torn,\n"
               "no small parts dropped",
       .value = Flag<Surface>{field<kGroup, &Options::remesh>(), false}},
      {.key = "principal",
       .name = "principal",
       .help = "Store principal curvatures and their directions as well",
       .value = Flag<Surface>{field<kGroup, &Options::principal>()}},
      {.key = "step",
       .name = "step",
       .help = "Sample distance of patches at level 0, in mean edge lengths",
       .value = Number{field<kGroup, &Options::step_factor>(), 0.05, 20}},
  };
}

/// Returns the rows for features and the level for recognition.
Table feature_rows() {
  using Options = FeatureOptions;
  constexpr auto kGroup = &Surface::features;
  return {
      {.key = "feature_radius",
       .name = "feature-radius",
       .help = "Maxima of curvature outdo all of their sign within so many scales of the level.\n"
               "0: only the ring of neighbours, as in the thesis",
       .value = Number{field<kGroup, &Options::radius>(), 0, 20}},
      {.key = "feature_completeness",
       .name = "feature-completeness",
       .help = "Vertices with less of their patch are no features: 1 is all of it",
       .value = Number{field<kGroup, &Options::min_completeness>(), 0, 1}},
      {.key = "level",
       .name = "level",
       .help = "The level for recognition; else that at which the number of features changes\n"
               "least",
       .value = OptionalNumber<Surface>{field<&Surface::recognition_level>(), 0, 999, "slope"}},
  };
}

/// Returns the rows for how datasets are stored and labelled.
Table storage_rows() {
  using io::Compression;
  return {
      {.key = "compression",
       .name = "compression",
       .help = "Of the stored arrays",
       .value = choice(field<&Surface::compression>(),
                       {{"deflate", Compression::kDeflate}, {"none", Compression::kNone}})},
      // JSON does not have the default, so that keys are what they would be without the row.
      {.key = "precision",
       .name = "precision",
       .help = "full: numbers as they were computed; scan: what is finer than a scan is rounded\n"
               "away (a thousandth of the step, 0.001 in normals, 0.0001 of a curvature), and the\n"
               "dataset is smaller",
       .value = choice(field<&Surface::precision>(),
                       {{"full", Precision::kFull}, {"scan", Precision::kScan}}),
       .default_in_json = false},
      {.key = "length_unit",
       .name = "unit",
       .help = "Length unit of the scans, as a label",
       .value = Text<Surface>{field<&Surface::length_unit>(), unit_problem}},
  };
}

}  // namespace

const ParameterTable<SurfaceParameters>& surface_parameter_table() {
  static const Table table =
      joined({preparation_rows(), evolution_rows(), feature_rows(), storage_rows()});
  return table;
}

kernels::Welding welding_of(const SurfaceParameters& parameters) {
  if (parameters.weld == "exact") return {.distance = 0};
  return {.distance = length_in(parameters.weld)};
}

nlohmann::json json_of(const SurfaceParameters& parameters) {
  return json_of(surface_parameter_table(), parameters);
}

std::string to_json(const SurfaceParameters& parameters) {
  return json_of(parameters).dump();
}

SurfaceParameters surface_parameters_from_json(const nlohmann::json& json) {
  SurfaceParameters parameters = from_json(surface_parameter_table(), json);
  if (json_of(parameters).dump() != json.dump())
    throw std::runtime_error("are no parameters of this version: " + json.dump());
  return parameters;
}

}  // namespace semigeo::jobs
