#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
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
  int close() { return descriptor_ < 0 ? 0 : ::close(std::exchange(descriptor_, -1)); }

 private:
  int descriptor_ = -1;
};

/// Opens a file with the flags of open(2). Child processes that run another program do not inherit
/// the descriptor. A file that is created may be read and written by all whom the umask allows.
/// Returns no descriptor if that fails; errno says why.
inline Descriptor open_file(const std::filesystem::path& path, int flags) {
  return Descriptor(::open(path.c_str(), flags | O_CLOEXEC, 0666));
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
