#include "io/files/gzip_stream.hpp"

#include <algorithm>
#include <new>

#include "io/files/error.hpp"

namespace semigeo::io {
namespace {

constexpr std::size_t kInputBytes = std::size_t{1} << 16;
constexpr int kGzipOnly = 16 + MAX_WBITS;
constexpr const char* kCopyAgain = "copy the file again from its source";

}  // namespace

GzipStream::GzipStream(InputFile& file, std::string_view start) : file_(file), input_(kInputBytes) {
  std::copy(start.begin(), start.end(), input_.begin());
  stream_.next_in = reinterpret_cast<Bytef*>(input_.data());
  stream_.avail_in = static_cast<uInt>(start.size());
  if (inflateInit2(&stream_, kGzipOnly) != Z_OK) throw std::bad_alloc();
}

GzipStream::~GzipStream() {
  inflateEnd(&stream_);
}

std::string GzipStream::place() const {
  return "byte " + std::to_string(file_.position() - stream_.avail_in);
}

bool GzipStream::refill() {
  stream_.next_in = reinterpret_cast<Bytef*>(input_.data());
  stream_.avail_in = static_cast<uInt>(file_.read(input_));
  return stream_.avail_in > 0;
}

bool GzipStream::start_member() {
  if (!first_member_) {
    // Zeros after a member are the padding of tapes and block devices. All else must be a member.
    for (;; ++stream_.next_in, --stream_.avail_in) {
      if (stream_.avail_in == 0 && !refill()) return false;
      if (*stream_.next_in != 0) break;
    }
    if (*stream_.next_in != static_cast<Bytef>(kMagic[0]))
      throw Error(file_.path(), place(), "there are other bytes after the end of the gzip data",
                  kCopyAgain);
    inflateReset(&stream_);
  }
  first_member_ = false;
  inside_member_ = true;
  return true;
}

std::size_t GzipStream::read(std::span<char> bytes) {
  stream_.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream_.avail_out = static_cast<uInt>(bytes.size());
  while (stream_.avail_out > 0) {
    if (!inside_member_ && !start_member()) break;
    if (stream_.avail_in == 0 && !refill())
      throw Error(file_.path(), place(), "the file ends in the middle of its gzip data",
                  kCopyAgain);
    const int status = inflate(&stream_, Z_NO_FLUSH);
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    if (status == Z_STREAM_END) {
      inside_member_ = false;
    } else if (status != Z_OK && status != Z_BUF_ERROR) {
      const std::string reason = stream_.msg ? std::string(" (") + stream_.msg + ")" : "";
      throw Error(file_.path(), place(), "the gzip data is damaged" + reason, kCopyAgain);
    }
  }
  return bytes.size() - stream_.avail_out;
}

}  // namespace semigeo::io
