#include "io/scans/scan_reader.hpp"

#include <cstddef>
#include <optional>
#include <string_view>

#include "io/files/byte_source.hpp"
#include "io/files/compression.hpp"
#include "io/files/error.hpp"
#include "io/files/file_signature.hpp"
#include "io/files/lower_case.hpp"
#include "io/scans/companions.hpp"
#include "io/scans/scan_formats.hpp"

namespace semigeo::io {
namespace {

constexpr std::size_t kVariantBytes = 1024;  // these many first bytes tell the variant, or the kind

/// Returns "PLY ascii, gzip".
std::string with_compression(const std::string& format, std::string_view compression) {
  return compression.empty() ? format : format + ", " + std::string(compression);
}

/// Throws the Error of a file that is something else than its extension says, if its first bytes
/// show what it is.
void refuse_other_kind(const ByteSource& source, const ScanFormat& format,
                       const std::optional<FileSignature>& signature) {
  if (!signature || signature->extension == format.extension) return;
  const std::string not_scan = signature->extension.empty() ? ", not a scan" : "";
  throw Error(source.path(), "", "the file is " + std::string(signature->what) + not_scan,
              std::string(signature->remedy));
}

}  // namespace

const ScanFormat* scan_format_of(const std::filesystem::path& path) {
  const std::filesystem::path name = compression_of_name(path) == nullptr ? path : path.stem();
  const std::string extension = lower_case(name.extension().string());
  for (const ScanFormat* format : kScanFormats)
    if (format->extension == extension) return format;
  return nullptr;
}

bool is_scan_name(const std::filesystem::path& path) {
  return scan_format_of(path) != nullptr;
}

std::string scan_variant(const std::filesystem::path& path) {
  const ScanFormat* format = scan_format_of(path);
  if (format == nullptr) return "";
  ByteSource source(path);
  source.fill(kVariantBytes);
  const std::string variant = format->variant(source.ahead().substr(0, kVariantBytes));
  return with_compression(variant, source.compression());
}

std::string likely_scan_variant(const std::filesystem::path& path) {
  const ScanFormat* format = scan_format_of(path);
  if (format == nullptr) return "";
  const FileCompression* compression = compression_of_name(path);
  return with_compression(format->variant({}), compression == nullptr ? "" : compression->name);
}

std::string scan_extensions(std::string_view separator, std::string_view last_separator) {
  std::string text;
  for (const ScanFormat* format : kScanFormats) {
    if (format != kScanFormats.front())
      text += format == kScanFormats.back() ? last_separator : separator;
    text += format->extension;
  }
  return text;
}

Scan read_scan(const std::filesystem::path& path, const ScanOptions& options) {
  ByteSource source(path);
  const ScanFormat* format = scan_format_of(path);
  if (format == nullptr)
    throw Error(path, "", "its name is not that of a scan",
                "scans are " + scan_extensions(", ", " and ") +
                    ", and the same with .gz, .bz2, .xz or .zst");
  if (!source.fill(1)) throw Error(path, "", "the file is empty", "copy it again from its source");
  source.fill(kVariantBytes);
  const std::optional<FileSignature> signature = file_signature(source.ahead());
  if (signature && signature->is_zeros) refuse_other_kind(source, *format, signature);
  try {
    Scan scan = format->read(source, options);
    scan.bytes_after_end = source.drain();
    scan.xxh3 = format->companions == nullptr ? source.xxh3() : xxh3_of_scan(path);
    scan.format = with_compression(scan.format, source.compression());
    return scan;
  } catch (const Error&) {
    source.drain();  // throws if compressed data is damaged, which explains the failure better
    refuse_other_kind(source, *format, signature);
    throw;
  }
}

}  // namespace semigeo::io
