#include "io/files/byte_source.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "io/files/compression.hpp"
#include "io/files/container.hpp"
#include "io/files/input_file.hpp"

namespace semigeo::io {

namespace {

/// Lends a stream to an owner.
class LentStream final : public ByteStream {
 public:
  explicit LentStream(ByteStream& stream) : stream_(stream) {}
  const std::filesystem::path& path() const override { return stream_.path(); }
  std::int64_t position() const override { return stream_.position(); }
  std::size_t read(std::span<char> bytes) override { return stream_.read(bytes); }

 private:
  ByteStream& stream_;
};

}  // namespace

ByteSource::ByteSource(const std::filesystem::path& path) : ByteSource(open_bytes(path)) {}

ByteSource::ByteSource(ByteStream& stream) : ByteSource(std::make_unique<LentStream>(stream)) {}

ByteSource::ByteSource(std::unique_ptr<ByteStream> given)
    : path_(given->path()), file_(std::move(given)), raw_(*file_) {
  const auto* const file = dynamic_cast<const InputFile*>(file_.get());
  Unpacked content = unpacked(std::make_unique<LentStream>(raw_));
  stream_ = std::move(content.stream);
  if (content.compression != nullptr) {
    compression_ = content.compression->name;
  } else if (file != nullptr) {
    size_ = file->size();
    window_bytes_ = std::min(kWindowBytes, static_cast<std::size_t>(file->size()) + 1);
  }
  window_ = std::make_unique_for_overwrite<char[]>(window_bytes_);
  cursor_ = end_ = window_.get();
}

ByteSource::~ByteSource() = default;

std::string ByteSource::place(std::int64_t byte) const {
  return "byte " + std::to_string(byte) + (compression_.empty() ? "" : " after decompression");
}

bool ByteSource::refill(std::size_t bytes) {
  auto kept = static_cast<std::size_t>(end_ - cursor_);
  window_position_ += cursor_ - window_.get();
  std::memmove(window_.get(), cursor_, kept);
  cursor_ = window_.get();
  while (kept < bytes && !ended_) {
    const std::size_t got = stream_->read({window_.get() + kept, window_bytes_ - kept});
    ended_ = got == 0;
    kept += got;
  }
  end_ = cursor_ + kept;
  return kept >= bytes;
}

std::int64_t ByteSource::skip(std::int64_t bytes) {
  std::int64_t done = 0;
  while (done < bytes && fill(1)) {
    const auto step = std::min<std::int64_t>(bytes - done, end_ - cursor_);
    cursor_ += step;
    done += step;
  }
  return done;
}

std::optional<std::int64_t> ByteSource::bytes_left() const {
  if (!size_) return std::nullopt;
  return std::max<std::int64_t>(*size_ - position(), 0);
}

std::int64_t ByteSource::drain() {
  constexpr std::string_view kEmpty("\0 \t\r\n\x1a", 6);  // DOS ends texts with 1a
  std::int64_t found = 0;
  for (; fill(1); cursor_ = end_)
    found += std::count_if(cursor_, end_, [&](char c) { return kEmpty.find(c) == kEmpty.npos; });
  return found;
}

}  // namespace semigeo::io
