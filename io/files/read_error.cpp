#include "io/files/read_error.hpp"

#include <system_error>

namespace semigeo::io {
namespace {

const char* remedy_of(int code) {
  switch (code) {
    case ENOENT:
    case ENOTDIR:
      return "check the path";
    case EACCES:
    case EPERM:
      return "change its permissions (chmod +r)";
    case EMFILE:
    case ENFILE:
      return "the file itself may be whole: allow more open files (ulimit -n), and run again";
    case ENOMEM:
      return "the file itself may be whole: free some memory, and run again";
    case ELOOP:
      return "replace the symbolic link by a file";
    default:
      return "check the disk it is on";
  }
}

std::filesystem::file_type type_of(const std::filesystem::path& path) {
  std::error_code error;
  const auto type = std::filesystem::status(path, error).type();
  if (type == std::filesystem::file_type::none) throw open_error(path, error.value());
  return type;
}

}  // namespace

ReadError::ReadError(int code, std::filesystem::path file, std::string place, std::string problem)
    : Error(std::move(file), std::move(place), std::move(problem), remedy_of(code)), code_(code) {}

void rethrow_if_unread(const Error& error) {
  const auto* refused = dynamic_cast<const ReadError*>(&error);
  if (refused != nullptr && !refused->is_absent()) throw ReadError(*refused);
}

ReadError open_error(const std::filesystem::path& path, int code) {
  if (code == ENOENT || code == ENOTDIR) return {code, path, "", "there is no such file"};
  if (code == EACCES || code == EPERM) return {code, path, "", "reading is not permitted"};
  return {code, path, "", "cannot be opened: " + std::generic_category().message(code)};
}

bool is_there(const std::filesystem::path& path) {
  return type_of(path) != std::filesystem::file_type::not_found;
}

bool is_folder(const std::filesystem::path& path) {
  return type_of(path) == std::filesystem::file_type::directory;
}

}  // namespace semigeo::io
