#include "io/hdf5/content_digest.hpp"

#include <xxhash.h>

#include <cstring>
#include <map>
#include <numeric>
#include <utility>

#include "io/hdf5/array_reader.hpp"

namespace semigeo::io {
namespace {

constexpr std::size_t kDeepestPath = 1024;

std::string hex64(std::uint64_t value) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text(16, '0');
  for (int i = 15; i >= 0; --i, value >>= 4) text[i] = kDigits[value & 15];
  return text;
}

std::string hash_of(const AttributeValue& value) {
  return std::visit(
      [](const auto& v) {
        if constexpr (requires { v.data(); })
          return hex64(XXH3_64bits(v.data(), v.size() * sizeof v[0]));
        else
          return hex64(XXH3_64bits(&v, sizeof v));
      },
      value);
}

std::string described(std::string_view kind, const std::string& path, ElementType type,
                      std::int64_t rows, int columns) {
  std::string line = std::string(kind) + " " + path + " " + std::string(name_of(type)) + " " +
                     std::to_string(rows);
  if (columns > 1) line.append("x").append(std::to_string(columns));
  return line + " ";
}

// Reads all objects of a file and enters them in a digest.
class Walk {
 public:
  Walk(const Hdf5File& file, const SeenRows& seen, const ForEach& for_each)
      : file_(file), seen_(seen), for_each_(for_each) {}

  std::string digest() {
    first_path_.emplace(file_.address("/"), "/");
    visit_group("/");
    return digest_.hex();
  }

 private:
  void visit_group(const std::string& path) {
    if (path.size() > kDeepestPath) file_.refuse(path, "its groups are nested too deeply");
    digest_.add_group(path);
    visit_attributes(path);
    for (const Hdf5Link& link : file_.links(path)) {
      const std::string child = (path == "/" ? "" : path) + "/" + link.name;
      if (link.kind == Hdf5Link::Kind::kOther)
        file_.refuse(child, "it is neither a group nor a dataset of this file");
      const auto [known, is_first] = first_path_.try_emplace(link.address, child);
      if (!is_first) {
        digest_.add_link(child, known->second);
      } else if (link.kind == Hdf5Link::Kind::kGroup) {
        visit_group(child);
      } else {
        visit_array(child);
      }
    }
  }

  void visit_attributes(const std::string& path) {
    for (const Hdf5Attribute& attribute : file_.attributes(path)) {
      if (path == "/" && (attribute.name == "digest" || attribute.name == "complete")) continue;
      digest_.add_attribute(path, attribute.name, attribute.type, attribute.value);
    }
  }

  void visit_array(const std::string& path) {
    const Hdf5File::Array array = file_.open_array(path);
    if (array.has_attributes()) visit_attributes(path);
    if (array.is_virtual()) {
      digest_.add_virtual(path, array.shape().type, array.shape().rows, array.shape().columns,
                          array.virtual_pieces());
      return;
    }
    std::vector<std::uint64_t> hashes(array.shape().rows == 0 ? 0 : array.shape().chunk_count());
    for_each_chunk(array, for_each_, [&](std::int64_t chunk, std::span<const std::byte> rows) {
      hashes[chunk] = xxh3_64(rows);
      if (seen_) seen_(path, chunk * array.shape().chunk_rows, rows);
    });
    digest_.add_array(path, array.shape(), hashes);
  }

  const Hdf5File& file_;
  const SeenRows& seen_;
  const ForEach& for_each_;
  std::map<std::uint64_t, std::string> first_path_;
  ContentDigest digest_;
};

}  // namespace

void ContentDigest::add_group(const std::string& path) {
  lines_.insert("group " + path);
}

void ContentDigest::add_array(const std::string& path, const ArrayShape& shape,
                              std::span<const std::uint64_t> chunk_hashes) {
  lines_.insert(described("dataset", path, shape.type, shape.rows, shape.columns) +
                hex64(xxh3_64(std::as_bytes(chunk_hashes))));
}

void ContentDigest::add_virtual(const std::string& path, ElementType type, std::int64_t rows,
                                int columns, std::span<const VirtualPiece> pieces) {
  std::string text;
  for (const VirtualPiece& piece : pieces)
    text += piece.source + " " + std::to_string(piece.rows) + "\n";
  lines_.insert(described("virtual", path, type, rows, columns) +
                hex64(XXH3_64bits(text.data(), text.size())));
}

void ContentDigest::add_attribute(const std::string& object, const std::string& name,
                                  const std::string& type, const AttributeValue& value) {
  lines_.insert("attribute " + object + " " + name + " " + type + " " + hash_of(value));
}

void ContentDigest::add_link(const std::string& path, const std::string& first) {
  lines_.insert("link " + path + " -> " + first);
}

std::string ContentDigest::hex() const {
  std::string text;
  for (const std::string& line : lines_) text += line + "\n";
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return hex64(hash.high64) + hex64(hash.low64);
}

std::string content_digest(const Hdf5File& file, const SeenRows& seen, const ForEach& for_each) {
  return Walk(file, seen, for_each).digest();
}

void DigestedFile::create_group(const std::string& path) {
  file_.create_group(path);
  digest_.add_group(path);
}

void DigestedFile::write_array(const std::string& path, const EncodedArray& array) {
  file_.write_array(path, array);
  std::vector<std::uint64_t> hashes;
  for (const EncodedChunk& chunk : array.chunks) hashes.push_back(chunk.raw_xxh3);
  digest_.add_array(path, array.shape, hashes);
}

DigestedFile::Growing DigestedFile::begin_array(const std::string& path, const ArrayShape& shape) {
  return {digest_, file_.begin_array(path, shape)};
}

void DigestedFile::Growing::write_chunk(const EncodedChunk& chunk) {
  array_.write_chunk(chunk);
  hashes_.push_back(chunk.raw_xxh3);
}

void DigestedFile::Growing::close() {
  array_.close();
  digest_->add_array(array_.path(), array_.shape(), hashes_);
}

void DigestedFile::write_virtual(const std::string& path, ElementType type, int columns,
                                 std::span<const VirtualPiece> pieces) {
  file_.write_virtual(path, type, columns, pieces);
  const std::int64_t rows =
      std::accumulate(pieces.begin(), pieces.end(), std::int64_t{0},
                      [](std::int64_t sum, const VirtualPiece& piece) { return sum + piece.rows; });
  digest_.add_virtual(path, type, rows, columns, pieces);
}

void DigestedFile::write_attribute(const std::string& object, const std::string& name,
                                   const AttributeValue& value) {
  file_.write_attribute(object, name, value);
  digest_.add_attribute(object, name, attribute_type(value), value);
}

void DigestedFile::link(const std::string& existing, const std::string& path) {
  file_.link(existing, path);
  digest_.add_link(path, existing);
}

}  // namespace semigeo::io
