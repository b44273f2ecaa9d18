#pragma once

#include <optional>
#include <string_view>

namespace semigeo::io {

/// Says what a file is that is no scan of its extension, and what to do with it.
struct FileSignature {
  std::string_view what;       ///< "a JPEG image": completes the sentence "the file is ...".
  std::string_view remedy;     ///< Says what to do.
  std::string_view extension;  ///< ".ply": extension that fits. Empty if it is no scan.
  bool is_container = false;   ///< It is a container that semigeo opens if its extension fits.
  bool is_zeros = false;       ///< The bytes are all zeros.
};

/// Returns what the first bytes of a file show it to be, or nothing if they are not known. At least
/// 300 bytes should be given if the file has them.
///
/// The first bytes alone prove nothing, because a binary STL may begin with any bytes. Therefore
/// the result explains why a file was refused, and is no reason to refuse one, unless all bytes of
/// a whole file or of its first megabyte are zeros.
std::optional<FileSignature> file_signature(std::string_view begin);

}  // namespace semigeo::io
