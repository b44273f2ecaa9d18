#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string_view>

#include "io/files/byte_stream.hpp"

namespace semigeo::io {

/// One of the formats of compression that a file may have, whatever its name.
struct FileCompression {
  std::string_view name;       ///< "gzip"
  std::string_view extension;  ///< ".gz"
  std::string_view magic;      ///< The first bytes of the data.
};

inline constexpr std::array kFileCompressions = {
    FileCompression{"gzip", ".gz", "\x1f\x8b"}, FileCompression{"bzip2", ".bz2", "BZh"},
    FileCompression{"xz",
                    ".xz",
                    {"\xfd"
                     "7zXZ\0",
                     6}},
    FileCompression{"zstd", ".zst", "\x28\xb5\x2f\xfd"}};

/// Returns the number of first bytes that tell the compression.
inline constexpr std::size_t kMagicBytes = 6;

/// Returns the compression that first bytes show, or nullptr.
const FileCompression* compression_of(std::string_view begin);

/// Returns the compression that the last extension of a name shows in any case, or nullptr.
const FileCompression* compression_of_name(const std::filesystem::path& path);

/// The bytes of a stream without their compression.
struct Unpacked {
  std::unique_ptr<ByteStream> stream;
  const FileCompression* compression;  ///< nullptr if the bytes are not compressed.
};

/// Decompresses a stream, which must be at its start, while it is read, if its first bytes show
/// that it is compressed. Damaged or cut data, a wrong checksum, other bytes behind the data and
/// data that grows beyond all bounds (growth.hpp) are `Error`s.
Unpacked unpacked(std::unique_ptr<ByteStream> stream);

}  // namespace semigeo::io
