#include "io/dataset/dataset_writer.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/dataset/xdmf.hpp"
#include "io/files/error.hpp"

namespace semigeo::io {
namespace {

const LevelArray& format_of(std::string_view name) {
  return *std::ranges::find(kLevelArrays, name, &LevelArray::name);
}

void write_header(DigestedFile& file, const DatasetHeader& header) {
  const std::vector<double> origin(header.origin.begin(), header.origin.end());
  const std::pair<const char*, AttributeValue> attributes[] = {
      {"length_unit", header.length_unit},      {"origin", origin},
      {"parameters", header.parameters.dump()}, {"input_name", header.input_name},
      {"input_xxh3", header.input_xxh3},        {"job_key", header.job_key},
      {"repairs", header.repairs.dump()},       {"preparation", header.preparation.dump()},
  };
  write_format(file, kDatasetFormat);
  for (const auto& [name, value] : attributes) file.write_attribute("/", name, value);
}

}  // namespace

DatasetWriter::DatasetWriter(const std::filesystem::path& final_path, const DatasetHeader& header,
                             Compression compression)
    : target_(final_path),
      file_(Hdf5File::create(target_.temporary_path(), final_path)),
      compression_(compression) {
  write_header(file_, header);
  file_.create_group("/levels");
}

void DatasetWriter::begin_level() {
  if (selected_) throw std::invalid_argument("the selection comes after the last level");
  if (std::exchange(level_begun_, true)) return;
  if (steps_.size() >= kMostLevels) throw std::invalid_argument("too many levels");
  file_.create_group(level_path(static_cast<std::int64_t>(steps_.size())));
}

void DatasetWriter::write(const std::string& level, const LevelArray& format,
                          const EncodedArray& array, std::int64_t rows) {
  const ArrayShape& shape = array.shape;
  if (shape.type != format.type || shape.columns != format.columns || shape.rows != rows)
    throw std::invalid_argument(level + "/" + format.name + " does not fit the other arrays");
  file_.write_array(level + "/" + format.name, array);
}

void DatasetWriter::write_connectivity(const EncodedConnectivity& connectivity) {
  if (connectivity_pending_) throw std::invalid_argument("a level has one connectivity");
  begin_level();
  vertices_ = connectivity.part.shape.rows;
  triangles_ = connectivity.triangles.shape.rows;
  connectivity_level_ = level_path(static_cast<std::int64_t>(steps_.size()));
  connectivity_pending_ = true;
  write(connectivity_level_, format_of("triangles"), connectivity.triangles, triangles_);
  write(connectivity_level_, format_of("source_vertex"), connectivity.source_vertex, vertices_);
  write(connectivity_level_, format_of("part"), connectivity.part, vertices_);
  const bool filled = connectivity.vertex_filled && connectivity.face_filled;
  if (filled != (connectivity.vertex_filled || connectivity.face_filled) ||
      (!steps_.empty() && filled != filled_))
    throw std::invalid_argument("all levels have marks of filled vertices and faces or none");
  filled_ = filled;
  if (filled) {
    write(connectivity_level_, format_of("vertex_filled"), *connectivity.vertex_filled, vertices_);
    write(connectivity_level_, format_of("face_filled"), *connectivity.face_filled, triangles_);
  }
}

void DatasetWriter::write_level(const LevelAttributes& attributes, const EncodedFields& fields) {
  if (connectivity_level_.empty()) throw std::invalid_argument("level 0 brings no connectivity");
  begin_level();
  const std::string level = level_path(static_cast<std::int64_t>(steps_.size()));
  if (!steps_.empty() && !(attributes.scale > steps_.back().value))
    throw Error(target_.final_path(), level, "its scale does not exceed that of the level before",
                "the scan has no extent at this scale: ask for fewer levels");
  file_.write_attribute(level, "iteration", attributes.iteration);
  file_.write_attribute(level, "step", attributes.step);
  file_.write_attribute(level, "scale", attributes.scale);
  file_.write_attribute(level, "mean_edge_length", attributes.mean_edge_length);
  file_.write_attribute(level, "parts", attributes.parts);
  file_.write_attribute(level, "shortest_side", attributes.shortest_side);
  if (attributes.point_quantum > 0)
    file_.write_attribute(level, "point_quantum", attributes.point_quantum);
  for (const LevelCount& count : kLevelCounts)
    file_.write_attribute(level, count.name, attributes.remeshed.*count.count);

  write(level, format_of("points"), fields.points, vertices_);
  write(level, format_of("normals"), fields.normals, vertices_);
  write(level, format_of("gaussian_curvature"), fields.gaussian_curvature, vertices_);
  write(level, format_of("mean_curvature"), fields.mean_curvature, vertices_);
  write(level, format_of("patch_completeness"), fields.patch_completeness, vertices_);
  if (!steps_.empty() && steps_.front().principal != fields.principal.has_value())
    throw std::invalid_argument("all levels have principal curvatures or none");
  if (fields.principal) {
    write(level, format_of("principal_curvature_1"), fields.principal->curvature_1, vertices_);
    write(level, format_of("principal_curvature_2"), fields.principal->curvature_2, vertices_);
    write(level, format_of("principal_direction_1"), fields.principal->direction_1, vertices_);
    write(level, format_of("principal_direction_2"), fields.principal->direction_2, vertices_);
  }
  write_features(file_, level, fields.features);
  feature_counts_.push_back(fields.features.counts.total());
  if (!connectivity_pending_)
    for (const LevelArray& array : kLevelArrays)
      if (array.connectivity && (filled_ || array.presence != Presence::kFilled))
        file_.link(connectivity_level_ + "/" + array.name, level + "/" + array.name);
  steps_.push_back({.value = attributes.scale,
                    .level = level,
                    .vertices = vertices_,
                    .triangles = triangles_,
                    .new_connectivity = connectivity_pending_,
                    .principal = fields.principal.has_value(),
                    .filled = filled_});
  connectivity_pending_ = false;
  level_begun_ = false;
}

void DatasetWriter::write_selection(const Selection& selection) {
  if (steps_.empty() || level_begun_) throw std::invalid_argument("the last level is not complete");
  if (selected_) throw std::invalid_argument("a dataset has one selection");
  if (selection.feature_counts != feature_counts_ ||
      selection.smoothed.size() != feature_counts_.size() || selection.level < 0 ||
      selection.level >= static_cast<std::int64_t>(feature_counts_.size()))
    throw std::invalid_argument("the selection does not fit the levels");
  io::write_selection(file_, selection, compression_);
  selected_ = true;
}

std::string DatasetWriter::finish(const ForEach& for_each) {
  if (!selected_) throw std::invalid_argument("the last level or the selection was not written");
  write_vtkhdf(file_, vtkhdf_layout(steps_), compression_);
  std::string digest = complete_file(file_, target_, [&](const std::filesystem::path& path) {
    const Dataset written(path);
    written.verify(for_each);
    return written.digest();
  });
  // The sidecar is written first, because a dataset under its final name counts as done.
  write_file_atomically(sidecar_of(target_.final_path()),
                        xdmf_text(target_.final_path().filename().string(), steps_), Folder::kLeft);
  target_.commit();
  return digest;
}

}  // namespace semigeo::io
