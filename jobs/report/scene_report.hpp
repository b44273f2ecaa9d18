#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace semigeo::jobs {

/// The version of what a scene's page shows. It is part of the page's key.
inline constexpr std::string_view kScenePageVersion = "scene page 1";

/// The files that the page of a recognised scene is made of.
struct SceneFiles {
  std::filesystem::path recognised;  ///< What was recognised (jobs/stages/recognised_file.hpp).
  std::filesystem::path scene;       ///< The scan or dataset; empty if nobody knows where it is.
  std::filesystem::path archive;     ///< It has the models' datasets.
};

/// Returns the place of the dataset of a model in its archive. A recognised file may come from
/// anywhere, so only the last part of a name that is a path counts.
std::filesystem::path dataset_of_model(const std::filesystem::path& archive,
                                       const std::string& model);

/// Says how much of a scene and its models a page gets, so that the page stays below 6 MB.
struct ScenePageLimits {
  std::int64_t vertices = 40000;  ///< Vertices of one surface that are shown, at most (65,536).
  double bytes = 5.0e6;           ///< Size of the data of all surfaces, at most, about.
};

/// Returns what the page of a recognised scene shows:
///
///   title, scene, library, search, ...   as the recognised file has them
///   titles    for each model of `objects` and `ranking` the name of its scan, or its own if its
///             dataset is gone
///   ranking   candidates, as the file has them
///   objects   found models, as the file has them, and also `shape`, the place in `models`
///   surface   the scene's surface (add_surface) with its `origin`
///   residual  `limit` in the scene's unit, and for each object the distances of the shown vertices
///             of the scene from the model in its pose, as base64 of 16-bit fractions of the limit;
///             65535 stands for all that is farther. `median` and `share` are those of all shown
///             vertices within the limit.
///   models    the surface of each model that was found: level 0 of its dataset
///
/// What cannot be shown has `missing`, a sentence that says why, in place of its surface: the scene
/// or the dataset of a model is gone, or has changed since the scene was recognised.
///
/// The cost is that of reading the scene and the models, and some microseconds for each vertex and
/// object. Throws io::Error if the recognised file cannot be read.
nlohmann::json scene_report(const SceneFiles& files, const ScenePageLimits& limits = {});

}  // namespace semigeo::jobs
