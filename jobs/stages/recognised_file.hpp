#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "io/library/hash_library.hpp"
#include "jobs/stages/recognise_scene.hpp"
#include "jobs/stages/scan_surface.hpp"
#include "jobs/stages/search_parameters.hpp"

namespace semigeo::jobs {

// The objects that were recognised in a scene, as a JSON file with its key and a digest of its
// content. It holds no time, path or host: the same scene and library give the same bytes.

/// The scene as the file describes it.
struct RecognisedScene {
  std::string name = {};
  std::string input_name = {};  ///< File name of the scene, as UTF-8.
  std::string xxh3 = {};
  std::string format = {};                  ///< File format of the scene.
  std::optional<ScanRepairs> repairs = {};  ///< Empty if the scene is a dataset.
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  std::int64_t features = 0;
  std::int64_t samples = 0;
  std::string dataset_digest = {};  ///< Content digest of the scene; empty if it is no dataset.
  bool turned = false;  ///< Objects were found only with its triangles facing the other way.
  /// The place that it was scanned from, in coordinates of the file, if it is taken to be one.
  std::optional<Eigen::Vector3d> eye = {};
};

/// The largest number of models in the ranking of the file.
inline constexpr std::size_t kMostRanked = 20;
/// The number of models in the list of those that resemble the scene as a whole, besides those of
/// the ranking.
inline constexpr std::size_t kMostResembling = 50;

/// Writes the file completely or not at all. Throws io::Error if it cannot be written.
void write_recognised(const std::filesystem::path& path, const std::string& key,
                      const RecognisedScene& scene, const io::HashLibrary& library,
                      const SearchParameters& parameters, const Recognition& recognition);

/// Returns the content of the file. Throws io::Error if the file is absent, damaged, or of another
/// format or version.
nlohmann::json read_recognised(const std::filesystem::path& path);

/// Returns the key of the job that made the file. Throws io::Error as `read_recognised` does.
std::string recognised_key(const std::filesystem::path& path);

}  // namespace semigeo::jobs
