#include "io/files/compression.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "io/files/error.hpp"
#include "io/files/growth.hpp"
#include "io/files/gzip_stream.hpp"
#include "io/files/libarchive.hpp"
#include "io/files/lower_case.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kCopyAgain = "copy the file again from its source";

/// Gives bytes back that were read from the start of a stream, and then the rest of it.
class WholeStream final : public ByteStream {
 public:
  WholeStream(std::unique_ptr<ByteStream> rest, std::string start)
      : rest_(std::move(rest)), start_(std::move(start)) {}

  const std::filesystem::path& path() const override { return rest_->path(); }
  std::int64_t position() const override {
    return rest_->position() - static_cast<std::int64_t>(start_.size() - given_);
  }
  std::size_t read(std::span<char> bytes) override {
    if (given_ == start_.size()) return rest_->read(bytes);
    const std::size_t step = std::min(bytes.size(), start_.size() - given_);
    std::copy_n(start_.begin() + static_cast<std::ptrdiff_t>(given_), step, bytes.begin());
    given_ += step;
    return step;
  }

 private:
  std::unique_ptr<ByteStream> rest_;
  std::string start_;
  std::size_t given_ = 0;
};

/// Decompresses bzip2, xz or zstd.
class FilterStream final : public ByteStream {
 public:
  FilterStream(std::unique_ptr<ByteStream> packed, const FileCompression& compression)
      : path_(packed->path()), compression_(compression), archive_(std::move(packed)) {
    if (compression.name == "bzip2") archive_read_support_filter_bzip2(archive_.get());
    if (compression.name == "xz") archive_read_support_filter_xz(archive_.get());
    if (compression.name == "zstd") archive_read_support_filter_zstd(archive_.get());
    archive_read_support_format_raw(archive_.get());
    archive_read_support_format_empty(archive_.get());
    if (archive_.open() != ARCHIVE_OK) fail();
    archive_entry* entry = nullptr;
    const int code =
        archive_.call([&] { return archive_read_next_header(archive_.get(), &entry); });
    ended_ = code == ARCHIVE_EOF;  // there is nothing in it
    const bool known = archive_filter_code(archive_.get(), 0) != ARCHIVE_FILTER_NONE;
    if (code < ARCHIVE_WARN || !known) fail();
  }

  const std::filesystem::path& path() const override { return path_; }
  std::int64_t position() const override { return position_; }

  std::size_t read(std::span<char> bytes) override {
    if (ended_) return 0;
    const auto got = archive_.call(
        [&] { return archive_read_data(archive_.get(), bytes.data(), bytes.size()); });
    if (got < 0) fail();
    position_ += got;
    check_growth(path_, archive_.fed(), position_);
    ended_ = got == 0;
    if (ended_ && archive_.has_other_bytes())
      throw Error(path_, "", "there are other bytes after the end of the " + name() + " data",
                  kCopyAgain);
    return static_cast<std::size_t>(got);
  }

 private:
  std::string name() const { return std::string(compression_.name); }

  [[noreturn]] void fail() const {
    const std::string reason = archive_.message();
    const bool cut = reason.find("runcated") != std::string::npos ||
                     reason.find("No progress") != std::string::npos;
    const std::string place = "byte " + std::to_string(archive_.fed());
    if (cut)
      throw Error(path_, place, "the file ends in the middle of its " + name() + " data",
                  kCopyAgain);
    throw Error(path_, "before " + place,
                "the " + name() + " data is damaged" + (reason.empty() ? "" : " (" + reason + ")"),
                kCopyAgain);
  }

  std::filesystem::path path_;
  const FileCompression& compression_;
  Libarchive archive_;
  std::int64_t position_ = 0;
  bool ended_ = false;
};

/// Returns whether a block or the end of the data follows the four bytes of the head, because the
/// head alone could be text.
bool is_bzip2_block(std::string_view begin) {
  const std::string_view block = begin.substr(std::min<std::size_t>(4, begin.size()), 2);
  return std::string_view("1A").starts_with(block) || std::string_view("\x17r").starts_with(block);
}

}  // namespace

const FileCompression* compression_of(std::string_view begin) {
  const auto* const found =
      std::ranges::find_if(kFileCompressions, [&](const FileCompression& compression) {
        return begin.starts_with(compression.magic) &&
               (compression.name != "bzip2" || is_bzip2_block(begin));
      });
  return found == kFileCompressions.end() ? nullptr : found;
}

const FileCompression* compression_of_name(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  const auto* const found =
      std::ranges::find(kFileCompressions, extension, &FileCompression::extension);
  return found == kFileCompressions.end() ? nullptr : found;
}

Unpacked unpacked(std::unique_ptr<ByteStream> stream) {
  std::string start(kMagicBytes, '\0');
  std::size_t got = 0;
  while (got < start.size()) {
    const std::size_t step = stream->read(std::span(start).subspan(got));
    if (step == 0) break;
    got += step;
  }
  start.resize(got);
  const FileCompression* const compression = compression_of(start);
  if (compression == nullptr)
    return {std::make_unique<WholeStream>(std::move(stream), std::move(start)), nullptr};
  if (compression->magic == GzipStream::kMagic)
    return {std::make_unique<GzipStream>(std::move(stream), start), compression};
  auto whole = std::make_unique<WholeStream>(std::move(stream), std::move(start));
  return {std::make_unique<FilterStream>(std::move(whole), *compression), compression};
}

}  // namespace semigeo::io
