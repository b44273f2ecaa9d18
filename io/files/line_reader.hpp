#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "io/files/input_file.hpp"

namespace semigeo::io {

/// Reads the lines of a regular file of any size in bounded memory. A pipe, a device or a folder at
/// the path is an Error, without waiting for it. What the system refuses is a ReadError.
class LineReader {
 public:
  /// No line may have more bytes than `longest`.
  explicit LineReader(std::filesystem::path path, std::size_t longest = std::size_t{64} << 20);

  /// Replaces `line` by the next line, without its end. Returns false at the end of the file. The
  /// last line need not have an end. A longer line than allowed is an Error that names its number.
  bool next(std::string& line);

 private:
  bool fill();

  InputFile file_;
  std::size_t longest_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  ///< What has not been returned yet is from here
  std::size_t end_ = 0;    ///< to here in the buffer.
  std::size_t number_ = 0;
};

}  // namespace semigeo::io
