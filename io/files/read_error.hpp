#pragma once

#include <cerrno>
#include <filesystem>
#include <string>
#include <utility>

#include "io/files/error.hpp"

namespace semigeo::io {

/// The error when the system refuses to open or to read a file. It carries the number of the
/// system's error. Such an error says nothing about the content: the file may be whole.
class ReadError : public Error {
 public:
  /// `code` is the errno of the call that failed. The remedy depends on it.
  ReadError(int code, std::filesystem::path file, std::string place, std::string problem);

  int code() const { return code_; }
  /// Returns whether there is no such file.
  bool is_absent() const { return code_ == ENOENT || code_ == ENOTDIR; }

 private:
  int code_;
};

/// Throws the error again if the system refused to read a file that is there. It is for those who
/// go on without what is damaged: such a file may be whole the next time.
void rethrow_if_unread(const Error& error);

/// Returns the error when a file cannot be opened for reading. `code` is the errno of that call.
ReadError open_error(const std::filesystem::path& path, int code);

/// Returns whether there is a file at the path, behind symbolic links. Throws ReadError if that
/// cannot be known.
bool is_there(const std::filesystem::path& path);

/// Returns whether there is a folder at the path, behind symbolic links. Throws ReadError if that
/// cannot be known.
bool is_folder(const std::filesystem::path& path);

}  // namespace semigeo::io
