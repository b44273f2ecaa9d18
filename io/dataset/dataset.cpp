#include "io/dataset/dataset.hpp"

#include <algorithm>

#include "io/dataset/dataset_header.hpp"
#include "io/dataset/vtkhdf.hpp"
#include "io/files/error.hpp"
#include "io/hdf5/array_reader.hpp"
#include "io/hdf5/complete_file.hpp"
#include "io/hdf5/content_digest.hpp"

namespace semigeo::io {
namespace {

const LevelArray* find_array(std::string_view name) {
  const auto* found = std::ranges::find(kLevelArrays, name, &LevelArray::name);
  return found == kLevelArrays.end() ? nullptr : found;
}

}  // namespace

std::string level_path(std::int64_t level) {
  const std::string digits = std::to_string(level);
  return "/levels/" + std::string(digits.size() < 3 ? 3 - digits.size() : 0, '0') + digits;
}

Dataset::Dataset(const std::filesystem::path& path) : file_(open_complete(path, kDatasetFormat)) {
  digest_ = text("digest");
  creator_version_ = text("creator_version");
  header_ = std::make_shared<const DatasetHeader>(read_header());
  const std::vector<Hdf5Link> levels = file_.links("/levels");
  if (levels.empty() || levels.size() > kMostLevels)
    file_.refuse("/levels", "must hold 1 to " + std::to_string(kMostLevels) + " levels");
  level_count_ = static_cast<int>(levels.size());
  principal_ = file_.has(level_path(0) + "/principal_curvature_1");
  filled_ = file_.has(level_path(0) + "/vertex_filled");
  for (int k = 0; k < level_count_; ++k)
    if ("/levels/" + levels[k].name != level_path(k))
      file_.refuse("/levels", "its levels are not numbered from 000 without gaps");
}

DatasetHeader Dataset::read_header() const {
  DatasetHeader header = {.parameters = read_json_attribute(file_, "parameters"),
                          .input_name = text("input_name"),
                          .input_xxh3 = text("input_xxh3"),
                          .job_key = text("job_key"),
                          .length_unit = text("length_unit"),
                          .repairs = read_json_attribute(file_, "repairs"),
                          .preparation = read_json_attribute(file_, "preparation")};
  const auto origin = file_.read_attribute_as<std::vector<double>>("/", "origin");
  if (origin.size() != 3) file_.refuse("/", "its attribute origin must have three values");
  std::ranges::copy(origin, header.origin.begin());
  return header;
}

std::string Dataset::text(const char* name) const {
  return file_.read_attribute_as<std::string>("/", name);
}

std::string Dataset::existing(int level) const {
  if (level < 0 || level >= level_count_)
    throw Error(path(), level_path(level), "does not exist",
                "the levels are 0 to " + std::to_string(level_count_ - 1));
  return level_path(level);
}

void Dataset::check_rows(const std::string& level, const LevelArray& array) const {
  const std::string name = level + "/" + array.name;
  const ArrayShape shape = file_.shape_of(name);
  const char* const counted = array.per_triangle ? "/triangles" : "/points";
  if (shape.type != array.type || shape.columns != array.columns ||
      shape.rows != file_.shape_of(level + counted).rows)
    file_.refuse(
        name, "has not the type or shape that a level's " + std::string(array.name) + " must have");
}

double Dataset::scale(int level) const {
  return file_.read_attribute_as<double>(existing(level), "scale");
}

LevelInfo Dataset::level(int level) const {
  const std::string path = existing(level);
  LevelInfo info;
  info.iteration = file_.read_attribute_as<std::int64_t>(path, "iteration");
  info.step = file_.read_attribute_as<double>(path, "step");
  info.scale = file_.read_attribute_as<double>(path, "scale");
  info.mean_edge_length = file_.read_attribute_as<double>(path, "mean_edge_length");
  info.parts = file_.read_attribute_as<std::int64_t>(path, "parts");
  info.shortest_side = file_.read_attribute_as<double>(path, "shortest_side");
  for (const LevelCount& count : kLevelCounts)
    info.remeshed.*count.count = file_.read_attribute_as<std::int64_t>(path, count.name);
  info.vertices = file_.shape_of(path + "/points").rows;
  info.triangles = file_.shape_of(path + "/triangles").rows;
  for (const LevelArray& array : kLevelArrays) {
    if (array.presence == Presence::kPrincipal && !principal_) continue;
    if (array.presence == Presence::kFilled && !filled_) continue;
    check_rows(path, array);
  }
  info.features = check_features(file_, path);
  return info;
}

std::vector<float> Dataset::read_floats(int level, std::string_view name) const {
  const std::string place = existing(level);
  const LevelArray* array = find_array(name);
  if (array == nullptr || array->type != ElementType::kFloat32)
    throw Error(path(), place + "/" + std::string(name), "is no array of floats");
  check_rows(place, *array);
  return io::read_floats(file_, place + "/" + array->name, array->columns);
}

std::vector<std::int64_t> Dataset::read_integers(int level, std::string_view name) const {
  const std::string place = existing(level);
  const LevelArray* array = find_array(name);
  if (array == nullptr || array->type == ElementType::kFloat32)
    throw Error(path(), place + "/" + std::string(name), "is no array of integers");
  check_rows(place, *array);
  return io::read_integers(file_, place + "/" + array->name, array->columns);
}

kernels::FeaturesByKind Dataset::read_features(int level) const {
  const std::string place = existing(level);
  return io::read_features(file_, place, file_.shape_of(place + "/points").rows);
}

kernels::SampledContours Dataset::read_contours(int level, kernels::FeatureKind kind) const {
  return io::read_contours(file_, existing(level), kind);
}

Selection Dataset::selection() const {
  return read_selection(file_, level_count_);
}

void Dataset::verify(const ForEach& for_each) const {
  // The digest comes first, because it opens every array.
  const std::string found = content_digest(file_, {}, for_each);
  const Selection selected = selection();
  for (int k = 0; k < level_count_; ++k)
    if (level(k).features.total() != selected.feature_counts[k])
      file_.refuse("/selection/feature_counts",
                   "does not count the features of level " + std::to_string(k));
  check_vtkhdf(file_);
  if (found != digest_)
    file_.refuse("attribute digest", "is " + digest_ + ", but the content has the digest " + found);
}

DatasetOrigin read_origin(const std::filesystem::path& path) {
  const Hdf5File file = open_complete(path, kDatasetFormat);
  const auto text = [&](const char* name) {
    return file.read_attribute_as<std::string>("/", name);
  };
  return {.job_key = text("job_key"),
          .input_xxh3 = text("input_xxh3"),
          .parameters_json = text("parameters"),
          .creator_version = text("creator_version")};
}

}  // namespace semigeo::io
