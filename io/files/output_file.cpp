#include "io/files/output_file.hpp"

#include <fcntl.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "io/files/write_error.hpp"

namespace semigeo::io {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;

}  // namespace

OutputFile::OutputFile(const std::filesystem::path& path)
    : file_(path),
      descriptor_(engine::open_file(file_.temporary_path(), O_WRONLY | O_CREAT | O_EXCL)) {
  if (!descriptor_) fail("cannot be created");
  buffer_.reserve(kBufferBytes + 64);
}

void OutputFile::commit() {
  close();
  file_.commit();
}

void OutputFile::commit_unsynced() {
  close();
  file_.commit_unsynced();
}

void OutputFile::close() {
  flush();
  // Some failures are reported only when the file is closed.
  if (descriptor_.close() != 0) fail("cannot be written");
}

void OutputFile::add(const char* bytes, std::size_t count) {
  buffer_.insert(buffer_.end(), bytes, bytes + count);
  if (buffer_.size() >= kBufferBytes) flush();
}

void OutputFile::flush() {
  if (!engine::write_all(descriptor_, {buffer_.data(), buffer_.size()})) fail("cannot be written");
  buffer_.clear();
}

void OutputFile::fail(const char* problem) const {
  const int code = errno;
  throw WriteError(code, path(), "",
                   std::string(problem) + ": " + std::generic_category().message(code),
                   "check the folder, its permissions and the free space");
}

}  // namespace semigeo::io
