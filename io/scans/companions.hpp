#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/byte_stream.hpp"

namespace semigeo::io {

/// The bounds of what is looked for beside a scan.
inline constexpr std::int64_t kMostCompanions = 1000;
inline constexpr std::int64_t kMostCompanionJson = std::int64_t{64} << 20;

/// Returns the path below the scan's folder that a reference in a scan leads to, without "." and
/// with %XX decoded. Returns nothing for what leaves the folder: absolute paths, "..", addresses
/// with a scheme, names with a zero byte.
std::optional<std::string> companion_name(std::string_view reference);

/// Returns whether scans of this name may have companions.
bool may_have_companions(const std::filesystem::path& scan);

/// What a scan's own file says about its content.
struct ScanContent {
  std::string xxh3;  ///< XXH3-128 of its bytes.
  /// The files that belong to it, in the order in which it names them; they may be absent. Those of
  /// a member of a container are members.
  std::vector<std::filesystem::path> companions;
};

/// Reads a scan's own file once. The path may lead to a member of a container. Throws Error if it
/// cannot be read. What is no scan, or a damaged one, has no companions.
ScanContent scan_content(const std::filesystem::path& scan);
/// Reads the scan from a stream at its start.
ScanContent scan_content(ByteStream& stream);

/// Returns the XXH3-128 of a scan from that of its own file and those of its companions, in their
/// order; an empty text stands for an absent one. A scan without companions has that of its file.
std::string xxh3_with_companions(const std::string& own, const std::vector<std::string>& others);

/// Opens a companion of a scan, or returns nullptr if there is no such file. Only the companions of
/// a member are looked for in a container. Throws Error if it cannot be opened.
std::unique_ptr<ByteStream> open_companion(const std::filesystem::path& scan,
                                           const std::filesystem::path& companion);

/// Returns the XXH3-128 of a companion of a scan, or an empty text if there is no such file. Throws
/// Error if it cannot be read.
std::string xxh3_of_companion(const std::filesystem::path& scan,
                              const std::filesystem::path& companion);

/// Returns the XXH3-128 of all bytes that a scan is made of. Throws Error if they cannot be read.
std::string xxh3_of_scan(const std::filesystem::path& scan);

/// Returns the size of a scan that is no member of a container: of its file and its companions,
/// without those that are absent. Throws Error if the file cannot be read.
std::uintmax_t bytes_of_scan(const std::filesystem::path& scan);

}  // namespace semigeo::io
