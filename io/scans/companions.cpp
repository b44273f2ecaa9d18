#include "io/scans/companions.hpp"

#include <algorithm>
#include <charconv>

#include "io/files/byte_source.hpp"
#include "io/files/container.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/hashed_stream.hpp"
#include "io/files/input_file.hpp"
#include "io/files/read_error.hpp"
#include "io/scans/scan_formats.hpp"

namespace semigeo::io {
namespace {

namespace fs = std::filesystem;

std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    const char* const digits = text.data() + i + 1;
    const bool is_code = text[i] == '%' && i + 2 < text.size() &&
                         std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
    decoded += is_code ? static_cast<char>(byte) : text[i];
    if (is_code) i += 2;
  }
  return decoded;
}

/// Returns the companions that a scan names. One that is damaged has none: its reader says what is
/// wrong.
std::vector<fs::path> companions_of(ByteStream& stream) {
  const ScanFormat* const format = scan_format_of(stream.path());
  if (format == nullptr || format->companions == nullptr) return {};
  std::vector<fs::path> companions;
  try {
    ByteSource source(stream);
    for (const std::string& reference : format->companions(source)) {
      const std::optional<std::string> name = companion_name(reference);
      if (!name) continue;
      fs::path path = stream.path().parent_path() / *name;
      if (std::ranges::find(companions, path) == companions.end())
        companions.push_back(std::move(path));
    }
  } catch (const ReadError&) {
    throw;
  } catch (const Error&) {
    return {};
  }
  return companions;
}

}  // namespace

std::optional<std::string> companion_name(std::string_view reference) {
  const std::size_t colon = reference.find(':');
  if (colon < reference.find('/')) return std::nullopt;
  const std::string decoded = percent_decoded(reference);
  if (decoded.starts_with('/') || decoded.find('\0') != std::string::npos) return std::nullopt;
  std::string name;
  for (std::size_t begin = 0; begin <= decoded.size();) {
    const std::size_t end = std::min(decoded.find('/', begin), decoded.size());
    const std::string part = decoded.substr(begin, end - begin);
    begin = end + 1;
    if (part == "..") return std::nullopt;
    if (part.empty() || part == ".") continue;
    name += (name.empty() ? "" : "/") + part;
  }
  return name.empty() ? std::nullopt : std::optional(name);
}

bool may_have_companions(const fs::path& scan) {
  const ScanFormat* const format = scan_format_of(scan);
  return format != nullptr && format->companions != nullptr;
}

ScanContent scan_content(const fs::path& scan) {
  return scan_content(*open_bytes(scan));
}

ScanContent scan_content(ByteStream& stream) {
  HashedStream hashed(stream);
  std::vector<fs::path> companions = companions_of(hashed);
  return {.xxh3 = hashed.finish(), .companions = std::move(companions)};
}

std::string xxh3_with_companions(const std::string& own, const std::vector<std::string>& others) {
  if (others.empty()) return own;
  std::string text = own;
  for (const std::string& other : others) text += '\n' + other;
  return xxh3_of_text(text);
}

std::unique_ptr<ByteStream> open_companion(const fs::path& scan, const fs::path& companion) {
  const auto place = member_path(scan) ? member_path(companion) : std::nullopt;
  if (!place) return is_there(companion) ? std::make_unique<InputFile>(companion) : nullptr;
  auto reader = std::make_unique<ContainerReader>(place->container);
  while (reader->next())
    if (reader->kind() == ContainerReader::Kind::kFile && reader->name() == place->member)
      return reader;
  return nullptr;
}

std::string xxh3_of_companion(const fs::path& scan, const fs::path& companion) {
  const std::unique_ptr<ByteStream> stream = open_companion(scan, companion);
  return stream == nullptr ? "" : xxh3_of_stream(*stream);
}

std::string xxh3_of_scan(const fs::path& scan) {
  const ScanContent content = scan_content(scan);
  std::vector<std::string> others;
  for (const fs::path& companion : content.companions)
    others.push_back(xxh3_of_companion(scan, companion));
  return xxh3_with_companions(content.xxh3, others);
}

std::uintmax_t bytes_of_scan(const fs::path& scan) {
  InputFile file(scan);
  std::error_code error;
  auto bytes = static_cast<std::uintmax_t>(file.size());
  for (const fs::path& companion : companions_of(file)) {
    const std::uintmax_t more = fs::file_size(companion, error);
    if (!error) bytes += more;
  }
  return bytes;
}

}  // namespace semigeo::io
