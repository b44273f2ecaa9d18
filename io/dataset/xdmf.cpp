#include "io/dataset/xdmf.hpp"

#include <charconv>
#include <vector>

#include "io/dataset/dataset.hpp"

namespace semigeo::io {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

// Returns the shortest text that reads back as the same number, in any locale.
std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string data_item(const std::string& dataset, const std::string& path, ElementType type,
                      std::int64_t rows, int columns) {
  const bool real = type == ElementType::kFloat32 || type == ElementType::kFloat64;
  std::string shape = std::to_string(rows);
  if (columns > 1) shape.append(" ").append(std::to_string(columns));
  const std::string kind = real ? "Float" : type == ElementType::kUint8 ? "UChar" : "Int";
  return "          <DataItem Format=\"HDF\" NumberType=\"" + kind + "\" Precision=\"" +
         std::to_string(size_of(type)) + "\" Dimensions=\"" + shape + "\">" +
         escaped(dataset + ":" + path) + "</DataItem>\n";
}

std::string grid(const std::string& dataset, const VtkhdfStep& step) {
  std::string text =
      "      <Grid Name=\"" + escaped(step.level) + "\" GridType=\"Uniform\">\n" +
      "        <Time Value=\"" + number(step.value) + "\"/>\n" +
      "        <Topology TopologyType=\"Triangle\" NumberOfElements=\"" +
      std::to_string(step.triangles) + "\">\n" +
      data_item(dataset, step.level + "/triangles", ElementType::kInt64, step.triangles, 3) +
      "        </Topology>\n        <Geometry GeometryType=\"XYZ\">\n" +
      data_item(dataset, step.level + "/points", ElementType::kFloat32, step.vertices, 3) +
      "        </Geometry>\n";
  for (const VtkhdfPointArray& array : point_arrays_of(step))
    text += std::string("        <Attribute Name=\"") + array.name + "\" AttributeType=\"" +
            (array.columns == 3 ? "Vector" : "Scalar") + "\" Center=\"Node\">\n" +
            data_item(dataset, step.level + "/" + array.source, array.type, step.vertices,
                      array.columns) +
            "        </Attribute>\n";
  return text + "      </Grid>\n";
}

}  // namespace

std::string xdmf_text(const std::string& dataset_name, std::span<const VtkhdfStep> steps) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<Xdmf Version=\"3.0\">\n"
      "  <Domain>\n"
      "    <Grid Name=\"levels\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const VtkhdfStep& step : steps) text += grid(dataset_name, step);
  return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

std::filesystem::path sidecar_of(const std::filesystem::path& dataset) {
  return std::filesystem::path(dataset).replace_extension(".xdmf");
}

std::string sidecar_text(const std::filesystem::path& dataset) {
  const Dataset source(dataset);
  std::vector<VtkhdfStep> steps;
  for (int k = 0; k < source.level_count(); ++k) {
    const LevelInfo level = source.level(k);
    steps.push_back({.value = level.scale,
                     .level = level_path(k),
                     .vertices = level.vertices,
                     .triangles = level.triangles,
                     .new_connectivity = k == 0,
                     .principal = source.has_principal(),
                     .filled = source.has_filled()});
  }
  return xdmf_text(dataset.filename().string(), steps);
}

}  // namespace semigeo::io
