#pragma once

#include <cerrno>
#include <filesystem>
#include <string>
#include <utility>

#include "io/files/error.hpp"

namespace semigeo::io {

/// The error when the system refuses to write a file. It carries the number of the system's error,
/// so that nobody has to read it out of the sentence.
class WriteError : public Error {
 public:
  /// `code` is the errno of the call that failed.
  WriteError(int code, std::filesystem::path file, std::string place, std::string problem,
             std::string remedy = {})
      : Error(std::move(file), std::move(place), std::move(problem), std::move(remedy)),
        code_(code) {}

  int code() const { return code_; }

 private:
  int code_;
};

/// Returns whether an error of this number means that no other file can be written in the same
/// place either: the disk is full or a quota is used up, the disk or its connection is broken, it
/// cannot be written any more, or the folder is gone.
constexpr bool concerns_the_place(int code) {
  switch (code) {
    case ENOSPC:
    case EDQUOT:
    case EIO:
    case EROFS:
    case ENOENT:
    case ENOTDIR:
    case ESTALE:
    case ENODEV:
    case ENXIO:
    case ENOTCONN:
      return true;
    default:
      return false;
  }
}

}  // namespace semigeo::io
