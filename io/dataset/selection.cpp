#include "io/dataset/selection.hpp"

#include <string>

#include "io/hdf5/array_reader.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kGroup = "/selection";
constexpr const char* kCounts = "/selection/feature_counts";
constexpr const char* kSmoothed = "/selection/smoothed";

}  // namespace

const char* name_of(Chosen chosen) {
  return chosen == Chosen::kSlope ? "slope" : "option";
}

void write_selection(DigestedFile& file, const Selection& selection, Compression compression) {
  file.create_group(kGroup);
  file.write_attribute(kGroup, "level", selection.level);
  file.write_attribute(kGroup, "chosen", name_of(selection.chosen));
  file.write_array(kCounts, encode_array(array_of(selection.feature_counts), compression));
  file.write_array(kSmoothed, encode_array(array_of(selection.smoothed), compression));
}

Selection read_selection(const Hdf5File& file, int levels) {
  const auto check_rows = [&](const std::string& path) {
    if (file.shape_of(path).rows != levels)
      file.refuse(path, "has not one row for each of " + std::to_string(levels) + " levels");
  };
  Selection selection;
  check_rows(kCounts);
  check_rows(kSmoothed);
  selection.feature_counts = read_integers(file, kCounts, 1);
  selection.smoothed = read_doubles(file, kSmoothed, 1);
  selection.level = file.read_attribute_as<std::int64_t>(kGroup, "level");
  if (selection.level < 0 || selection.level >= levels)
    file.refuse(kGroup,
                "chose level " + std::to_string(selection.level) + " of " + std::to_string(levels));
  const auto chosen = file.read_attribute_as<std::string>(kGroup, "chosen");
  if (chosen != name_of(Chosen::kSlope) && chosen != name_of(Chosen::kOption))
    file.refuse(kGroup, "its attribute chosen is neither slope nor option");
  selection.chosen = chosen == name_of(Chosen::kSlope) ? Chosen::kSlope : Chosen::kOption;
  return selection;
}

}  // namespace semigeo::io
