#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "io/dataset/dataset.hpp"
#include "jobs/picture/colour_scale.hpp"

namespace semigeo::jobs::cli {

/// The formats that are written, in the order in which messages name them.
enum class ExportFormat { kPly, kObj, kStl, kGlb, kVtp, kNpz, kCsv };

/// What people should know about a format that is written.
struct ExportFormatInfo {
  std::string_view extension;  ///< ".ply"
  bool surfaces;               ///< Surfaces can be written.
  bool tables;                 ///< Features and contours can be written.
  std::string_view content;    ///< What its files hold.
};

/// The formats, by ExportFormat.
inline constexpr std::array<ExportFormatInfo, 7> kExportFormats = {{
    {".ply", true, true,
     "binary: normals, K, H and more as properties of vertices; features, contours"},
    {".obj", true, false, "normals and colours; no field"},
    {".stl", true, false, "binary: triangles alone, relative to the origin"},
    {".glb", true, false,
     "normals, colours, and each field of real numbers as an attribute: _MEAN_CURVATURE"},
    {".vtp", true, false, "VTK: normals, and each field as an array"},
    {".npz", true, false, "NumPy: every array of the level and its features by name"},
    {".csv", false, true, "features, contours"},
}};

/// The programs whose customs a file follows.
enum class Dialect { kNone, kMeshlab, kCloudcompare, kParaview, kBlender };
/// Their names, by Dialect.
inline constexpr std::array<std::string_view, 5> kDialectNames = {"none", "meshlab", "cloudcompare",
                                                                  "paraview", "blender"};

/// Says what is written of a level, and how.
struct LevelExport {
  ExportFormat format = ExportFormat::kPly;
  Dialect dialect = Dialect::kNone;
  std::string quality = "mean_curvature";  ///< The field by which viewers colour.
  std::string features;                    ///< A kind of feature, "all", or empty.
  std::string contours;                    ///< A kind of contour, or empty.
  ColourScale scale = ColourScale::kSafe;

  bool is_surface() const { return features.empty() && contours.empty(); }
};

/// Returns the format of an extension in any case, or nothing.
std::optional<ExportFormat> format_of_extension(const std::string& extension);

/// Writes a level, which must exist, or its features or contours, into a file that appears whole.
/// Returns a line for people that says what is in it. Throws io::Error if that fails.
std::string export_level(const io::Dataset& dataset, int level, const std::filesystem::path& output,
                         const LevelExport& what);

}  // namespace semigeo::jobs::cli
