#include "io/scans/gltf_file.hpp"

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/files/base64.hpp"
#include "io/files/binary_load.hpp"
#include "io/files/error.hpp"
#include "io/files/printable.hpp"
#include "io/scans/companions.hpp"
#include "io/scans/whole_source.hpp"

namespace semigeo::io {
namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::int64_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr const char* kExportAgain = "copy the file again from its source or export it again";
constexpr const char* kMeshopt = "EXT_meshopt_compression";

std::int64_t load_u32(std::string_view bytes, std::int64_t at) {
  return load<std::uint32_t>(bytes.data() + at, std::endian::little);
}

/// Returns whether an extension that the file requires is read, or changes nothing about the
/// surface.
bool is_known(std::string_view extension) {
  if (extension == "KHR_mesh_quantization" || extension == "KHR_draco_mesh_compression")
    return true;  // both are read
  for (const std::string_view start :
       {"KHR_materials_", "KHR_texture_", "KHR_lights_", "KHR_xmp", "KHR_animation_",
        "EXT_texture_", "EXT_lights_", "MSFT_texture_", "ADOBE_materials_", "AGI_stk_",
        "MSFT_packing_"})
    if (extension.starts_with(start)) return true;
  return false;
}

}  // namespace

GltfFile::GltfFile(ByteSource& source) : path_(source.path()) {
  source.fill(kHeaderBytes);
  binary_ = source.ahead().starts_with(kMagic);
  if (binary_) {
    parse(read_binary(source));
  } else {
    const std::string text = read_whole(source);
    file_bytes_ = std::ssize(text);
    parse(text);
  }
  check_extensions();
}

GltfFile::~GltfFile() = default;

std::size_t DecodedBuffers::bytes() const {
  std::size_t sum = 0;
  for (const Kept& kept : kept_) sum += kept.bytes->size();
  return sum;
}

void DecodedBuffers::drop() {
  while (kept_.size() > 1 && bytes() > kMostBytes + kept_.front().bytes->size()) kept_.pop_back();
}

GltfObject GltfFile::root() const {
  return {path_, *json_, ""};
}

/// Returns the chunk of JSON.
std::string_view GltfFile::read_binary(ByteSource& source) {
  const auto fail = [&](std::int64_t at, const std::string& problem) {
    throw Error(path_, source.place(at), problem, kExportAgain);
  };
  if (!source.fill(kHeaderBytes)) fail(4, "the file ends in its header");
  const std::int64_t version = load_u32(source.ahead(), 4), length = load_u32(source.ahead(), 8);
  if (version != 2)
    throw Error(path_, source.place(4),
                "glTF of version " + std::to_string(version) + " is not supported",
                "export the scan as glTF 2.0");
  bytes_ = read_whole(source, length);
  file_bytes_ = std::ssize(bytes_);
  if (file_bytes_ < length)
    fail(file_bytes_, "the header promises " + std::to_string(length) +
                          " bytes, but the file ends after " + std::to_string(file_bytes_));
  std::string_view json;
  for (std::int64_t at = kHeaderBytes; at + kChunkHeaderBytes <= length;) {
    const std::int64_t size = load_u32(bytes_, at), type = load_u32(bytes_, at + 4);
    const std::int64_t begin = at + kChunkHeaderBytes;
    if (size > length - begin) fail(at, "a chunk reaches beyond the end of the file");
    const auto chunk = std::string_view(bytes_).substr(static_cast<std::size_t>(begin),
                                                       static_cast<std::size_t>(size));
    if (at == kHeaderBytes && type != kJsonChunk) fail(at, "the first chunk is not JSON");
    if (at == kHeaderBytes) json = chunk;
    if (type == kBinaryChunk && chunk_.data() == nullptr) chunk_ = chunk;
    at = begin + size;
  }
  if (json.empty()) fail(kHeaderBytes, "there is no JSON in the file");
  return json;
}

void GltfFile::parse(std::string_view text) {
  json_bytes_ = std::ssize(text);
  try {
    json_ = std::make_unique<nlohmann::json>(nlohmann::json::parse(text));
  } catch (const nlohmann::json::parse_error& error) {
    throw Error(path_, "byte " + std::to_string(error.byte) + (binary_ ? " of its JSON" : ""),
                "the JSON of the file is damaged", kExportAgain);
  } catch (const nlohmann::json::out_of_range&) {  // a number such as 1e999
    throw Error(path_, "", "the JSON of the file has a number that is too large", kExportAgain);
  }
  if (!json_->is_object() || !json_->contains("asset"))
    throw Error(path_, "", "this is no glTF file: its JSON has no 'asset'",
                "correct its extension or export the scan again");
  const std::string_view version = root().object("asset").text("version").value_or("");
  if (!version.starts_with("2."))
    root().object("asset").fail(
        version.empty()
            ? "the version of glTF is missing"
            : "glTF of version " + printable(std::string(version)) + " is not supported",
        "export the scan as glTF 2.0");
}

void GltfFile::check_extensions() const {
  for (std::int64_t i = 0; i < root().size("extensionsRequired"); ++i) {
    const std::string extension = root().text("extensionsRequired", i);
    if (extension == kMeshopt)
      throw Error(path_, "", "its meshes are compressed by meshopt, which is not supported",
                  "export the scan without compression (EXT_meshopt_compression)");
    if (!is_known(extension))
      throw Error(
          path_, "",
          "it requires the extension '" + printable(extension) + "', which is not supported",
          "export the scan without this extension");
  }
}

std::string GltfFile::decode_uri(const GltfObject& buffer, std::string_view uri) const {
  if (!uri.starts_with("data:")) return read_companion(buffer, uri);
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
    buffer.fail("its data is not in Base64", kExportAgain);
  Base64Decoder decoder(uri.substr(comma + 1));
  std::string bytes;
  decoder.read(uri.size(), bytes);
  if (!decoder.at_end()) buffer.fail("its Base64 data is damaged", kExportAgain);
  return bytes;
}

/// Reads the bytes of a buffer that stand in a file beside the scan.
std::string GltfFile::read_companion(const GltfObject& buffer, std::string_view uri) const {
  constexpr const char* kConvert =
      "convert the scan to .glb, which is one file (in Blender or with gltf-transform)";
  const std::string shown = "'" + printable(std::string(uri.substr(0, 200))) + "'";
  const std::optional<std::string> name = companion_name(uri);
  if (!name) {
    const bool remote = uri.find("://") != std::string_view::npos;
    buffer.fail(std::string("its bytes stand ") +
                    (remote ? "on the network: " : "outside of the folder of the scan: ") + shown,
                kConvert);
  }
  if (json_bytes_ > kMostCompanionJson || root().size("buffers") > kMostCompanions)
    buffer.fail("its bytes stand in another file, " + shown +
                    ", and the scan has more than 1000 buffers or 64 MiB of JSON",
                kConvert);
  const std::unique_ptr<ByteStream> stream = open_companion(path_, path_.parent_path() / *name);
  if (stream == nullptr)
    buffer.fail("its bytes stand in " + shown + ", and there is no such file",
                "copy that file to its place beside the scan");
  std::string bytes;
  const std::int64_t most = std::min(buffer.integer("byteLength"), kMaxWholeBytes);
  for (std::string part(std::size_t{1} << 20, '\0'); std::ssize(bytes) < most;) {
    const std::size_t got = stream->read(part);
    if (got == 0) break;
    bytes.append(part, 0, got);
  }
  return bytes;
}

GltfBytes GltfFile::buffer(std::int64_t index) {
  const GltfObject buffer = root().item("buffers", index);
  const std::optional<std::string_view> uri = buffer.text("uri");
  GltfBytes result;
  std::string_view& bytes = result.bytes;
  if (uri) {
    result.keeper = decoded_.get(index, [&] { return decode_uri(buffer, *uri); });
    bytes = *result.keeper;
  } else {
    if (index != 0 || chunk_.data() == nullptr) buffer.fail("it has no bytes", kExportAgain);
    bytes = chunk_;
  }
  const std::int64_t length = buffer.integer("byteLength");
  if (length > std::ssize(bytes))
    buffer.fail("it promises " + std::to_string(length) + " bytes, but has only " +
                    std::to_string(bytes.size()),
                kExportAgain);
  bytes = bytes.substr(0, static_cast<std::size_t>(length));
  return result;
}

bool GltfFile::has_elements(std::int64_t accessor) const {
  const GltfObject object = root().item("accessors", accessor);
  return object.has("bufferView") || object.has("sparse");
}

GltfBytes GltfFile::view_bytes(std::int64_t index) {
  const GltfObject view = root().item("bufferViews", index);
  if (view.has("extensions") && view.object("extensions").has(kMeshopt))
    view.fail("it is compressed by meshopt, which is not supported",
              "export the scan without compression (EXT_meshopt_compression)");
  GltfBytes result = buffer(view.integer("buffer"));
  const std::string_view bytes = result.bytes;
  const std::int64_t view_offset = view.integer("byteOffset", 0);
  const std::int64_t length = view.integer("byteLength");
  if (view_offset > std::ssize(bytes) || length > std::ssize(bytes) - view_offset)
    view.fail("it reaches beyond the end of its buffer", kExportAgain);
  result.bytes =
      bytes.substr(static_cast<std::size_t>(view_offset), static_cast<std::size_t>(length));
  return result;
}

GltfBytes GltfFile::locate(const GltfObject& owner, Elements& elements) {
  const std::int64_t index = owner.integer("bufferView");
  const GltfObject view = root().item("bufferViews", index);
  GltfBytes view_of_all = view_bytes(index);
  const std::int64_t length = std::ssize(view_of_all.bytes);
  const std::int64_t element_bytes = component_bytes(elements.type) * elements.components;
  elements.stride = view.integer("byteStride", element_bytes);
  if (elements.stride < element_bytes)
    view.fail("its byteStride is smaller than an element", kExportAgain);
  const std::int64_t offset = owner.integer("byteOffset", 0);
  const std::int64_t room = length - offset - element_bytes;
  if (elements.count > 0 && (room < 0 || (elements.count - 1) > room / elements.stride))
    owner.fail("its " + std::to_string(elements.count) +
                   " elements reach beyond the end of their bufferView",
               kExportAgain);
  if (elements.count > 0) elements.data = view_of_all.bytes.data() + offset;
  return view_of_all;
}

std::int64_t GltfFile::component_bytes(Type type) {
  if (type == Type::kByte || type == Type::kUnsignedByte) return 1;
  return type == Type::kShort || type == Type::kUnsignedShort ? 2 : 4;
}

template <typename Number>
Number GltfFile::load_component(const Elements& elements, const char* from) {
  const auto scaled = [&](auto number, double largest) {
    if (!elements.normalized) return static_cast<Number>(number);
    return static_cast<Number>(std::max(static_cast<double>(number) / largest, -1.0));
  };
  constexpr std::endian kOrder = std::endian::little;
  switch (elements.type) {
    case Type::kByte:
      return scaled(load<std::int8_t>(from, kOrder), 127);
    case Type::kUnsignedByte:
      return scaled(load<std::uint8_t>(from, kOrder), 255);
    case Type::kShort:
      return scaled(load<std::int16_t>(from, kOrder), 32'767);
    case Type::kUnsignedShort:
      return scaled(load<std::uint16_t>(from, kOrder), 65'535);
    case Type::kUnsignedInt:
      return static_cast<Number>(load<std::uint32_t>(from, kOrder));
    case Type::kFloat:
      return static_cast<Number>(load<float>(from, kOrder));
  }
  return 0;
}

template <typename Number>
void GltfFile::copy(const Elements& elements, Number* to) {
  for (std::int64_t i = 0; i < elements.count; ++i) {
    const char* const from = elements.data + i * elements.stride;
    for (std::int64_t k = 0; k < elements.components; ++k)
      *to++ = load_component<Number>(elements, from + k * component_bytes(elements.type));
  }
}

template <typename Number>
std::vector<Number> GltfFile::read(const GltfObject& accessor, Elements elements) {
  elements.count = accessor.integer("count");
  GltfBytes held;
  if (accessor.has("bufferView")) {
    held = locate(accessor, elements);
  } else if (elements.count > file_bytes_ && elements.count > bytes_of_buffers()) {
    accessor.fail("it has more elements than the file has bytes", kExportAgain);
  }
  std::vector<Number> numbers(static_cast<std::size_t>(elements.count * elements.components));
  if (accessor.has("bufferView")) copy(elements, numbers.data());
  if (accessor.has("sparse")) replace_sparse(accessor.object("sparse"), elements, numbers);
  return numbers;
}

template <typename Number>
void GltfFile::replace_sparse(const GltfObject& sparse, const Elements& all,
                              std::vector<Number>& numbers) {
  const GltfObject places = sparse.object("indices"), values = sparse.object("values");
  Elements index{.count = sparse.integer("count"), .type = index_type(places)};
  const GltfBytes held_places = locate(places, index);
  Elements value = all;
  value.count = index.count;
  const GltfBytes held_values = locate(values, value);
  std::vector<std::uint32_t> indices(static_cast<std::size_t>(index.count));
  copy(index, indices.data());
  Elements one = value;
  one.count = 1;
  for (std::int64_t i = 0; i < index.count; ++i) {
    if (indices[i] >= all.count)
      places.fail(
          "it refers to element " + std::to_string(indices[i]) + " of " + std::to_string(all.count),
          kExportAgain);
    one.data = value.data + i * value.stride;
    copy(one, numbers.data() + indices[i] * all.components);
  }
}

std::int64_t GltfFile::bytes_of_buffers() {
  if (bytes_of_buffers_) return *bytes_of_buffers_;
  std::int64_t bytes = 0;
  for (std::int64_t i = 0; i < root().size("buffers"); ++i) bytes += std::ssize(buffer(i).bytes);
  bytes_of_buffers_ = bytes;
  return bytes;
}

GltfFile::Type GltfFile::index_type(const GltfObject& owner) {
  const auto type = static_cast<Type>(owner.integer("componentType"));
  if (type != Type::kUnsignedByte && type != Type::kUnsignedShort && type != Type::kUnsignedInt)
    owner.fail("its componentType is not one of indices", kExportAgain);
  return type;
}

std::vector<double> GltfFile::positions(std::int64_t accessor) {
  const GltfObject object = root().item("accessors", accessor);
  const std::int64_t type = object.integer("componentType");
  if (object.text("type") != "VEC3" || type < 5120 || type > 5126 || type == 5124 || type == 5125)
    object.fail("its type is not one of positions", kExportAgain);
  return read<double>(
      object,
      {.components = 3, .type = static_cast<Type>(type), .normalized = object.flag("normalized")});
}

std::vector<std::uint32_t> GltfFile::indices(std::int64_t accessor) {
  const GltfObject object = root().item("accessors", accessor);
  if (object.text("type") != "SCALAR") object.fail("its type is not one of indices", kExportAgain);
  return read<std::uint32_t>(object, {.type = index_type(object)});
}

std::uint32_t GltfFile::largest_index(std::int64_t accessor) const {
  const std::int64_t bytes = component_bytes(index_type(root().item("accessors", accessor)));
  return static_cast<std::uint32_t>((std::uint64_t{1} << 8 * bytes) - 1);
}

}  // namespace semigeo::io
