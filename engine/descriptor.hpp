#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <utility>

namespace semigeo::engine {

/// Owns a file descriptor and closes it at the end of its own life.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    if (this != &other) {
      close();
      descriptor_ = std::exchange(other.descriptor_, -1);
    }
    return *this;
  }

  explicit operator bool() const { return descriptor_ >= 0; }
  /// Returns the descriptor, or -1 if there is none, which poll passes over.
  int get() const { return descriptor_; }
  /// Closes the descriptor. Returns 0, or -1 with errno if that failed. Closing twice does nothing.
  /// A signal is no failure: Linux has closed the descriptor then.
  int close() {
    if (descriptor_ < 0 || ::close(std::exchange(descriptor_, -1)) == 0) return 0;
    return errno == EINTR ? 0 : -1;
  }

 private:
  int descriptor_ = -1;
};

/// Opens a file with the flags of open(2). Child processes that run another program do not inherit
/// the descriptor. A file that is created may be read and written by all whom the umask allows.
/// A signal does not interrupt it. Returns no descriptor if that fails; errno says why.
inline Descriptor open_file(const std::filesystem::path& path, int flags) {
  int descriptor;
  do {
    descriptor = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  } while (descriptor < 0 && errno == EINTR);
  return Descriptor(descriptor);
}

/// Writes all bytes, however few the system takes at a time. Returns false with errno if it fails.
inline bool write_all(const Descriptor& file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// Forces what was written to the disk. Returns false with errno if it fails.
inline bool sync_file(const Descriptor& file) {
  while (::fsync(file.get()) != 0)
    if (errno != EINTR) return false;
  return true;
}

/// The two ends of a pipe.
struct Pipe {
  Descriptor from;  ///< What was written is read here.
  Descriptor to;
};

/// Makes a pipe that child processes that run another program do not inherit. Returns a pipe
/// without ends if that fails; errno says why.
inline Pipe make_pipe() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return {};
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

}  // namespace semigeo::engine
