#include "io/scans/gltf_json.hpp"

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/files/binary_load.hpp"
#include "io/files/error.hpp"
#include "io/scans/companions.hpp"
#include "io/scans/whole_source.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kExportAgain = "export the scan again";
constexpr std::int64_t kLargest = std::int64_t{1} << 53;  // JSON's numbers are exact up to here

std::string subscript(std::int64_t index) {
  return "[" + std::to_string(index) + "]";
}

/// Says which parts of a file's JSON are kept while it is parsed: the URIs of the first buffers. So
/// memory is bounded, whatever the file is.
class FirstBuffers {
 public:
  using Event = nlohmann::json::parse_event_t;

  bool operator()(int depth, Event event, const nlohmann::json& parsed) {
    switch (depth) {
      case 0:
        return event == Event::object_start || event == Event::object_end;
      case 1:
        if (event == Event::key) inside_ = parsed == "buffers";
        return inside_ && event != Event::value;
      case 2:
        if (event == Event::object_start) return inside_ && ++buffers_ <= kMostCompanions;
        return event == Event::object_end;
      case 3:
        return event == Event::value || (event == Event::key && parsed == "uri");
      default:
        return false;
    }
  }

 private:
  bool inside_ = false;
  std::int64_t buffers_ = 0;
};

}  // namespace

GltfObject::GltfObject(const std::filesystem::path& path, const nlohmann::json& value,
                       std::string place)
    : path_(&path), value_(&value), place_(std::move(place)) {
  if (!value.is_object()) fail("there is no object in the file's JSON", kExportAgain);
}

void GltfObject::fail(const std::string& problem, const std::string& remedy) const {
  throw Error(*path_, place_, problem, remedy);
}

std::string GltfObject::name_of(std::string_view key) const {
  return (place_.empty() ? "" : place_ + ".") + std::string(key);
}

bool GltfObject::has(const char* key) const {
  return value_->contains(key);
}

GltfObject GltfObject::object(const char* key) const {
  if (!has(key)) fail("it has no '" + std::string(key) + "'", kExportAgain);
  return {*path_, (*value_)[key], name_of(key)};
}

const nlohmann::json& GltfObject::array(const char* key) const {
  static const nlohmann::json kNone = nlohmann::json::array();
  if (!has(key)) return kNone;
  const nlohmann::json& values = (*value_)[key];
  if (!values.is_array()) fail("'" + std::string(key) + "' is not an array", kExportAgain);
  return values;
}

std::int64_t GltfObject::size(const char* key) const {
  return static_cast<std::int64_t>(array(key).size());
}

GltfObject GltfObject::item(const char* key, std::int64_t index) const {
  const nlohmann::json& values = array(key);
  if (index < 0 || index >= std::ssize(values))
    fail("the file refers to " + name_of(key) + subscript(index) + ", but there are only " +
             std::to_string(values.size()),
         kExportAgain);
  return {*path_, values[static_cast<std::size_t>(index)], name_of(key) + subscript(index)};
}

std::int64_t GltfObject::to_index(const nlohmann::json& number, const std::string& name) const {
  const double value = number.is_number() ? number.get<double>() : -1;
  if (!(value >= 0 && value <= static_cast<double>(kLargest)) || value != std::floor(value))
    fail("'" + name + "' is not a whole number from 0 on", kExportAgain);
  return static_cast<std::int64_t>(value);
}

std::int64_t GltfObject::index(const char* key, std::int64_t element) const {
  return to_index(array(key).at(static_cast<std::size_t>(element)), key + subscript(element));
}

std::string GltfObject::text(const char* key, std::int64_t element) const {
  const nlohmann::json& value = array(key).at(static_cast<std::size_t>(element));
  return value.is_string() ? value.get<std::string>() : "";
}

std::int64_t GltfObject::integer(const char* key, std::optional<std::int64_t> fallback) const {
  if (has(key)) return to_index((*value_)[key], key);
  if (!fallback) fail("it has no '" + std::string(key) + "'", kExportAgain);
  return *fallback;
}

std::optional<std::string_view> GltfObject::text(const char* key) const {
  if (!has(key)) return std::nullopt;
  const auto* const text = (*value_)[key].get_ptr<const std::string*>();
  if (text == nullptr) fail("'" + std::string(key) + "' is not a text", kExportAgain);
  return *text;
}

bool GltfObject::flag(const char* key) const {
  const nlohmann::json* const value = has(key) ? &(*value_)[key] : nullptr;
  return value != nullptr && value->is_boolean() && value->get<bool>();
}

void GltfObject::read_numbers(const char* key, double* values, std::size_t size) const {
  const nlohmann::json& numbers = array(key);
  bool good = numbers.size() == size;
  for (std::size_t i = 0; good && i < size; ++i) {
    good = numbers[i].is_number();
    if (good) values[i] = numbers[i].get<double>();
  }
  if (!good)
    fail("'" + std::string(key) + "' is not an array of " + std::to_string(size) + " numbers",
         kExportAgain);
}

std::vector<std::string> gltf_references(ByteSource& source) {
  std::int64_t most = kMostCompanionJson;
  constexpr std::size_t kHeadersBytes = 20;  // of the file and of its first chunk
  if (source.fill(kHeadersBytes) && source.ahead().starts_with("glTF")) {
    const std::int64_t bytes = load<std::uint32_t>(source.ahead().data() + 12, std::endian::little);
    if (bytes > most) return {};
    most = bytes - 1;
    source.consume(kHeadersBytes);
  }
  const std::string text = read_whole(source, most + 1);
  if (std::ssize(text) > kMostCompanionJson) return {};
  FirstBuffers keep;
  const auto json = nlohmann::json::parse(
      text, [&](int depth, auto event, auto& parsed) { return keep(depth, event, parsed); },
      /*allow_exceptions=*/false);
  std::vector<std::string> references;
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return {};
  for (const nlohmann::json& buffer : json["buffers"]) {
    const auto uri = buffer.find("uri");
    if (uri == buffer.end() || !uri->is_string()) continue;
    const auto& reference = uri->get_ref<const std::string&>();
    if (!reference.starts_with("data:")) references.push_back(reference);
  }
  return references;
}

}  // namespace semigeo::io
