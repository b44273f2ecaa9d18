#include "io/files/libarchive.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <new>
#include <utility>

namespace semigeo::io {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;

bool has_other(const char* begin, const char* end) {
  return std::any_of(begin, end, [](char c) { return c != 0; });
}

}  // namespace

Libarchive::Libarchive(std::unique_ptr<ByteStream> stream)
    : stream_(std::move(stream)), buffer_(kBufferBytes), archive_(archive_read_new()) {
  if (archive_ == nullptr) throw std::bad_alloc();
}

Libarchive::Libarchive(std::unique_ptr<InputFile> file)
    : file_(std::move(file)), buffer_(kBufferBytes), archive_(archive_read_new()) {
  if (archive_ == nullptr) throw std::bad_alloc();
}

Libarchive::~Libarchive() {
  archive_read_free(archive_);
}

int Libarchive::open() {
  archive_read_set_callback_data(archive_, this);
  archive_read_set_read_callback(archive_, read);
  if (file_) {
    archive_read_set_skip_callback(archive_, skip);
    archive_read_set_seek_callback(archive_, seek);
  }
  return call([&] { return archive_read_open1(archive_); });
}

std::string Libarchive::message() const {
  const char* const text = archive_error_string(archive_);
  return text == nullptr ? "" : text;
}

bool Libarchive::has_other_bytes() {
  const auto unused = static_cast<std::size_t>(std::clamp<std::int64_t>(
      offset_ - archive_filter_bytes(archive_, -1), 0, static_cast<std::int64_t>(got_)));
  bool found = has_other(buffer_.data() + got_ - unused, buffer_.data() + got_);
  while (const std::size_t got = stream_->read(buffer_))
    found = found || has_other(buffer_.data(), buffer_.data() + got);
  return found;
}

la_ssize_t Libarchive::read(archive* reader, void* self, const void** bytes) {
  auto& source = *static_cast<Libarchive*>(self);
  try {
    const std::size_t got =
        source.file_
            ? source.file_->read_at(static_cast<std::uint64_t>(source.offset_), source.buffer_)
            : source.stream_->read(source.buffer_);
    source.offset_ += static_cast<std::int64_t>(got);
    if (got > 0) source.got_ = got;
    *bytes = source.buffer_.data();
    return static_cast<la_ssize_t>(got);
  } catch (...) {
    source.problem_ = std::current_exception();
    archive_set_error(reader, EIO, "cannot be read");
    return ARCHIVE_FATAL;
  }
}

la_int64_t Libarchive::skip(archive*, void* self, la_int64_t bytes) {
  auto& source = *static_cast<Libarchive*>(self);
  const std::int64_t step =
      std::clamp<std::int64_t>(bytes, 0, source.file_->size() - source.offset_);
  source.offset_ += step;
  return step;
}

la_int64_t Libarchive::seek(archive*, void* self, la_int64_t offset, int whence) {
  auto& source = *static_cast<Libarchive*>(self);
  std::int64_t from = 0;
  if (whence == SEEK_CUR) from = source.offset_;
  if (whence == SEEK_END) from = source.file_->size();
  if (from + offset < 0) return ARCHIVE_FATAL;
  return source.offset_ = from + offset;
}

}  // namespace semigeo::io
