#include "io/files/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "io/files/read_error.hpp"

namespace semigeo::io {

InputFile::InputFile(std::filesystem::path path) : path_(std::move(path)) {
  // With O_NONBLOCK the opening of a pipe does not wait for a writer. Regular files are not
  // affected.
  descriptor_ = engine::open_file(path_, O_RDONLY | O_NONBLOCK);
  struct stat status {};
  // Sockets, and devices without a driver, cannot even be opened.
  const bool refused = !descriptor_ && errno != ENXIO;
  if (refused || (descriptor_ && ::fstat(descriptor_.get(), &status) != 0))
    throw open_error(path_, errno);
  if (S_ISREG(status.st_mode)) {
    size_ = status.st_size;
    return;
  }
  if (S_ISDIR(status.st_mode))
    throw Error(path_, "", "is a folder, not a file", "name a file in it");
  throw Error(path_, "", "is not a regular file", "copy its contents into a file first");
}

std::size_t InputFile::read(std::span<char> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = ::read(descriptor_.get(), bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(static_cast<std::uint64_t>(position_));
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
    position_ += got;
  }
  return done;
}

std::size_t InputFile::read_at(std::uint64_t offset, std::span<char> bytes) const {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = ::pread(descriptor_.get(), bytes.data() + done, bytes.size() - done,
                                static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(offset + done);
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

void InputFile::fail(std::uint64_t offset) const {
  throw ReadError(errno, path_, "byte " + std::to_string(offset),
                  "cannot be read: " + std::generic_category().message(errno));
}

}  // namespace semigeo::io
