#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace semigeo::fuzz {

/// Reads the bytes as the target's kind of input. Each target defines it once. What the input may
/// cause, such as an io::Error, is caught there. Whatever else happens is a finding: another
/// exception, a crash, a `check` that fails, more than a second of CPU time, or an allocation of
/// more than the limit of scripts/fuzz.
void read_input(std::string_view bytes);

/// Ends the program with a message, which makes the input a finding, unless `holds` is true.
void check(bool holds, const char* what);

/// Returns a folder in memory for the files of this process. It is empty when the program begins.
const std::filesystem::path& folder();

/// Writes a file of these bytes into `folder` in place of the one that was there, and returns its
/// path.
std::filesystem::path write(const std::string& name, std::string_view bytes);

/// Gives numbers of an input one after the other. Behind its end all of them are 0.
class Numbers {
 public:
  explicit Numbers(std::string_view bytes) : rest_(bytes) {}

  bool empty() const { return rest_.empty(); }
  /// Returns the next byte.
  unsigned byte() {
    if (rest_.empty()) return 0;
    const auto value = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }
  /// Returns the next byte as a number below `limit`, which is at most 256 and not 0.
  unsigned below(unsigned limit) { return byte() % limit; }
  /// Returns the next two bytes as a number.
  unsigned word() {
    const unsigned high = byte();
    return high << 8 | byte();
  }
  /// Returns the next bytes, at most so many.
  std::string_view bytes(std::size_t count) {
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(taken.size());
    return taken;
  }
  /// Returns all bytes that are left.
  std::string_view rest() { return bytes(rest_.size()); }

 private:
  std::string_view rest_;
};

}  // namespace semigeo::fuzz
