#include "tests/fuzz/hdf5_tree.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "io/hdf5/array_reader.hpp"

namespace semigeo::fuzz {
namespace {

/// The most bytes of rows that an array may have after a change.
constexpr std::size_t kMostBytes = std::size_t{1} << 22;

/// Returns a number over which a reader may stumble.
std::int64_t odd_integer(Numbers& numbers) {
  constexpr std::int64_t kOdd[] = {0,
                                   1,
                                   -1,
                                   2,
                                   3,
                                   255,
                                   65'536,
                                   std::numeric_limits<std::int32_t>::max(),
                                   std::numeric_limits<std::int32_t>::min(),
                                   std::numeric_limits<std::int64_t>::max(),
                                   std::numeric_limits<std::int64_t>::min(),
                                   std::int64_t{1} << 40};
  const unsigned kind = numbers.below(16);
  return kind < std::size(kOdd) ? kOdd[kind] : static_cast<std::int64_t>(numbers.word());
}

double odd_double(Numbers& numbers) {
  using Limits = std::numeric_limits<double>;
  constexpr double kOdd[] = {0.0, -1.0, 1e300, Limits::infinity(), Limits::quiet_NaN(), 1e-300};
  const unsigned kind = numbers.below(8);
  return kind < std::size(kOdd) ? kOdd[kind] : numbers.word() / 16.0;
}

std::string odd_text(Numbers& numbers) {
  const char* const odd[] = {"",
                             "{}",
                             "[]",
                             "null",
                             "{\"levels\":[[[[[[]]]]]]}",
                             "/levels/000",
                             "slope",
                             "option",
                             "\xff\xfe",
                             "semigeo-dataset",
                             "semigeo-library"};
  const unsigned kind = numbers.below(16);
  if (kind < std::size(odd)) return odd[kind];
  return std::string(numbers.bytes(numbers.below(64)));
}

io::AttributeValue odd_value(Numbers& numbers) {
  switch (numbers.below(5)) {
    case 0:
      return odd_integer(numbers);
    case 1:
      return odd_double(numbers);
    case 2:
      return odd_text(numbers);
    case 3: {
      std::vector<std::int64_t> values(1 + numbers.below(4));
      for (std::int64_t& value : values) value = odd_integer(numbers);
      return values;
    }
    default: {
      std::vector<double> values(1 + numbers.below(4));
      for (double& value : values) value = odd_double(numbers);
      return values;
    }
  }
}

/// Puts a number of the given size into bytes.
template <typename Number>
void put(std::vector<std::byte>& bytes, std::size_t at, Number number) {
  if (at + sizeof number <= bytes.size()) std::memcpy(bytes.data() + at, &number, sizeof number);
}

constexpr io::ElementType kTypes[] = {io::ElementType::kFloat32, io::ElementType::kFloat64,
                                      io::ElementType::kInt32,   io::ElementType::kInt64,
                                      io::ElementType::kUint8,   io::ElementType::kUint16,
                                      io::ElementType::kFeature, io::ElementType::kContour,
                                      io::ElementType::kPosting, io::ElementType::kOrientedFeature};

}  // namespace

Hdf5Tree::Hdf5Tree(const io::Hdf5File& file) {
  std::map<std::uint64_t, std::string> known;
  objects_.push_back({.path = "/", .attributes = file.attributes("/")});
  std::erase_if(objects_.front().attributes, [](const io::Hdf5Attribute& attribute) {
    return attribute.name == "digest" || attribute.name == "complete";
  });
  read_group(file, "/", known);
}

void Hdf5Tree::read_group(const io::Hdf5File& file, const std::string& path,
                          std::map<std::uint64_t, std::string>& known) {
  for (const io::Hdf5Link& link : file.links(path)) {
    Object object{.path = (path == "/" ? path : path + "/") + link.name};
    const auto [first, is_new] = known.emplace(link.address, object.path);
    if (!is_new) {
      object.link = first->second;
    } else if (link.kind == io::Hdf5Link::Kind::kArray) {
      object.is_array = true;
      object.array = read_array(file, object.path);
      arrays_.push_back(objects_.size());
    }
    if (is_new) object.attributes = file.attributes(object.path);
    const bool is_group = is_new && !object.is_array;
    const std::string here = object.path;
    objects_.push_back(std::move(object));
    if (is_group) read_group(file, here, known);
  }
}

Hdf5Tree::Array Hdf5Tree::read_array(const io::Hdf5File& file, const std::string& path) const {
  const io::Hdf5File::Array stored = file.open_array(path);
  Array array{.shape = stored.shape(), .is_virtual = stored.is_virtual()};
  if (array.is_virtual) {
    array.pieces = stored.virtual_pieces();
    return array;
  }
  io::for_each_chunk(stored, [&](std::span<const std::byte> rows) {
    array.rows.insert(array.rows.end(), rows.begin(), rows.end());
  });
  const auto chunk = static_cast<std::size_t>(array.shape.chunk_bytes());
  const std::span<const std::byte> rows = array.rows;
  for (std::size_t at = 0; at < rows.size(); at += chunk)
    array.chunks.push_back(
        io::encode_rows(array.shape, rows.subspan(at, std::min(chunk, rows.size() - at))));
  return array;
}

void Hdf5Tree::edit(Numbers& numbers) {
  for (int edits = 0; edits < 12 && !numbers.empty(); ++edits) {
    const unsigned kind = numbers.below(8);
    if (kind < 5) {
      edit_array(objects_[arrays_[numbers.byte() % arrays_.size()]].array, numbers);
      continue;
    }
    const std::size_t at = numbers.byte() % objects_.size();
    Object& object = objects_[at];
    if (kind < 7) {
      edit_attribute(object, numbers);
    } else if (numbers.below(3) == 0) {
      object.path += "x";  // what it held is then missing, and something is there that is unknown
    } else if (!object.link.empty()) {
      object.link = objects_[arrays_[numbers.byte() % arrays_.size()]].path;
    }
  }
}

void Hdf5Tree::edit_array(Array& array, Numbers& numbers) {
  io::ArrayShape& shape = array.shape;
  array.chunks.clear();
  if (array.is_virtual) {
    if (array.pieces.empty()) return;
    io::VirtualPiece& piece = array.pieces[numbers.byte() % array.pieces.size()];
    const unsigned kind = numbers.below(4);
    if (kind == 0) piece.rows = numbers.byte();
    if (kind == 1) piece.source = objects_[arrays_[numbers.byte() % arrays_.size()]].path;
    if (kind == 2) array.pieces.pop_back();
    if (kind == 3) array.pieces.push_back(array.pieces.front());
    return;
  }
  const auto row_bytes = static_cast<std::size_t>(shape.row_bytes());
  const std::size_t at = numbers.word() % std::max<std::size_t>(array.rows.size(), 1);
  switch (numbers.below(8)) {
    case 0:
      put(array.rows, at - at % 8, odd_integer(numbers));
      break;
    case 1:
      put(array.rows, at - at % 4, static_cast<std::int32_t>(odd_integer(numbers)));
      break;
    case 2:
      put(array.rows, at - at % 4, static_cast<float>(odd_double(numbers)));
      break;
    case 3:
      put(array.rows, at - at % 8, odd_double(numbers));
      break;
    case 4:
      put(array.rows, at, static_cast<std::uint8_t>(numbers.byte()));
      break;
    case 5:
      array.rows.resize(std::min(array.rows.size() + row_bytes * numbers.below(4), kMostBytes));
      break;
    case 6:
      array.rows.resize(array.rows.size() / row_bytes * row_bytes / 2 / row_bytes * row_bytes);
      break;
    default:
      shape.type = kTypes[numbers.below(std::size(kTypes))];
      shape.columns = static_cast<int>(1 + numbers.below(3));
      array.rows.resize(array.rows.size() / static_cast<std::size_t>(shape.row_bytes()) *
                        static_cast<std::size_t>(shape.row_bytes()));
  }
  shape.rows = static_cast<std::int64_t>(array.rows.size()) / shape.row_bytes();
  if (shape.compact) shape.chunk_rows = std::max<std::int64_t>(shape.rows, 1);
}

void Hdf5Tree::edit_attribute(Object& object, Numbers& numbers) {
  std::vector<io::Hdf5Attribute>& attributes = object.attributes;
  const unsigned kind = numbers.below(8);
  if (attributes.empty() || kind == 0) {
    attributes.push_back({.name = "more", .type = "", .value = odd_value(numbers)});
    return;
  }
  const std::size_t at = numbers.byte() % attributes.size();
  if (kind == 1) {
    attributes.erase(attributes.begin() + static_cast<std::ptrdiff_t>(at));
  } else if (kind < 4) {
    attributes[at].value = odd_value(numbers);
  } else {  // of the same type
    io::AttributeValue& value = attributes[at].value;
    if (auto* integer = std::get_if<std::int64_t>(&value)) *integer = odd_integer(numbers);
    if (auto* number = std::get_if<double>(&value)) *number = odd_double(numbers);
    if (auto* text = std::get_if<std::string>(&value)) *text = odd_text(numbers);
    if (auto* list = std::get_if<std::vector<double>>(&value))
      for (double& number : *list) number = odd_double(numbers);
    if (auto* list = std::get_if<std::vector<std::int64_t>>(&value))
      for (std::int64_t& number : *list) number = odd_integer(numbers);
  }
}

void Hdf5Tree::write_object(io::DigestedFile& file, const Object& object) const {
  if (!object.link.empty()) return file.link(object.link, object.path);
  if (!object.is_array) {
    if (object.path != "/") file.create_group(object.path);
  } else if (object.array.is_virtual) {
    file.write_virtual(object.path, object.array.shape.type, object.array.shape.columns,
                       object.array.pieces);
  } else {
    const Array& array = object.array;
    io::DigestedFile::Growing growing = file.begin_array(object.path, array.shape);
    for (const io::EncodedChunk& chunk : array.chunks) growing.write_chunk(chunk);
    if (array.chunks.empty()) {
      const auto size = static_cast<std::size_t>(array.shape.chunk_bytes());
      const std::span<const std::byte> rows = array.rows;
      for (std::size_t at = 0; at < rows.size(); at += size)
        growing.write_chunk(
            io::encode_rows(array.shape, rows.subspan(at, std::min(size, rows.size() - at))));
    }
    growing.close();
  }
  for (const io::Hdf5Attribute& attribute : object.attributes)
    file.write_attribute(object.path, attribute.name, attribute.value);
}

void Hdf5Tree::write(const std::filesystem::path& path) const {
  io::DigestedFile file(io::Hdf5File::create(path));
  for (const Object& object : objects_) write_object(file, object);
  file.file().write_attribute("/", "digest", file.digest().hex());
  file.file().write_attribute("/", "complete", std::int64_t{1});
  file.file().close();
}

}  // namespace semigeo::fuzz
