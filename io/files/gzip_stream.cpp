#include "io/files/gzip_stream.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "io/files/error.hpp"
#include "io/files/growth.hpp"

namespace semigeo::io {
namespace {

constexpr std::size_t kInputBytes = std::size_t{1} << 16;
constexpr int kGzipOnly = 16 + MAX_WBITS;
constexpr const char* kCopyAgain = "copy the file again from its source";

}  // namespace

GzipStream::GzipStream(std::unique_ptr<ByteStream> packed, std::string_view start)
    : packed_(std::move(packed)), input_(std::max(kInputBytes, start.size())) {
  std::copy(start.begin(), start.end(), input_.begin());
  stream_.next_in = reinterpret_cast<Bytef*>(input_.data());
  stream_.avail_in = static_cast<uInt>(start.size());
  if (inflateInit2(&stream_, kGzipOnly) != Z_OK) throw std::bad_alloc();
}

GzipStream::~GzipStream() {
  inflateEnd(&stream_);
}

std::string GzipStream::place() const {
  return "byte " + std::to_string(packed_->position() - stream_.avail_in);
}

bool GzipStream::refill() {
  stream_.next_in = reinterpret_cast<Bytef*>(input_.data());
  stream_.avail_in = static_cast<uInt>(packed_->read(input_));
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
      throw Error(path(), place(), "there are other bytes after the end of the gzip data",
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
  if (damage_) std::rethrow_exception(damage_);
  try {
    while (stream_.avail_out > 0 && step()) {
    }
  } catch (const Error&) {
    // What came before the damage is given first. The next call fails.
    damage_ = std::current_exception();
    if (stream_.avail_out == bytes.size()) throw;
  }
  const std::size_t done = bytes.size() - stream_.avail_out;
  position_ += static_cast<std::int64_t>(done);
  check_growth(path(), packed_->position(), position_);
  return done;
}

bool GzipStream::step() {
  if (!inside_member_ && !start_member()) return false;
  if (stream_.avail_in == 0 && !refill())
    throw Error(path(), place(), "the file ends in the middle of its gzip data", kCopyAgain);
  const int status = inflate(&stream_, Z_NO_FLUSH);
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (status == Z_STREAM_END) {
    inside_member_ = false;
  } else if (status != Z_OK && status != Z_BUF_ERROR) {
    const std::string reason = stream_.msg ? std::string(" (") + stream_.msg + ")" : "";
    throw Error(path(), place(), "the gzip data is damaged" + reason, kCopyAgain);
  }
  return true;
}

}  // namespace semigeo::io
