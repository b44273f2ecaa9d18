#include "io/files/npz_file.hpp"

#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <bit>
#include <exception>
#include <new>
#include <string_view>

#include "io/files/error.hpp"
#include "io/files/output_file.hpp"
#include "io/files/utf8.hpp"

namespace semigeo::io {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they are");

/// Returns the head of an .npy file. Source: NumPy's format, version 1.0.
std::string npy_head(const std::string& type, const std::string& shape) {
  std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  constexpr std::size_t kMagicBytes = 10;
  constexpr std::size_t kAlignment = 64;
  const std::size_t used = kMagicBytes + text.size() + 1;
  text.append((kAlignment - used % kAlignment) % kAlignment, ' ');
  text += '\n';
  std::string head("\x93NUMPY\x01\x00", 8);
  head += static_cast<char>(text.size() & 0xff);
  head += static_cast<char>(text.size() >> 8);
  return head + text;
}

/// Returns the characters of a text as UTF-32, little endian; a byte that is none is U+FFFD.
std::string utf32(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const char32_t code = take_utf8_character(text);
    for (int shift = 0; shift < 32; shift += 8) result += static_cast<char>(code >> shift & 0xff);
  }
  return result;
}

}  // namespace

/// A ZIP that is written by libarchive into a file that appears whole.
class NpzFile::Zip {
 public:
  explicit Zip(const std::filesystem::path& path) : output_(path), archive_(archive_write_new()) {
    if (archive_ == nullptr) throw std::bad_alloc();
    check(archive_write_set_format_zip(archive_));
    // The ZIP is not padded to whole records of a tape.
    check(archive_write_set_bytes_in_last_block(archive_, 1));
    check(archive_write_open(archive_, this, nullptr, &Zip::write, nullptr));
  }
  ~Zip() {
    // libarchive writes the end of an open ZIP when it is freed.
    ended_ = true;
    archive_write_free(archive_);
  }
  Zip(const Zip&) = delete;
  Zip& operator=(const Zip&) = delete;

  void add(const std::string& name, const std::string& head, std::string_view bytes) {
    archive_entry* entry = archive_entry_new2(archive_);
    if (entry == nullptr) throw std::bad_alloc();
    archive_entry_set_pathname(entry, (name + ".npy").c_str());
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_entry_set_perm(entry, 0644);
    archive_entry_set_size(entry, static_cast<la_int64_t>(head.size() + bytes.size()));
    const int code = archive_write_header(archive_, entry);
    archive_entry_free(entry);
    check(code);
    for (const std::string_view part : {std::string_view(head), bytes})
      if (!part.empty() && archive_write_data(archive_, part.data(), part.size()) < 0) fail();
    check(archive_write_finish_entry(archive_));
  }

  void commit() {
    check(archive_write_close(archive_));
    output_.commit();
  }

 private:
  static la_ssize_t write(archive*, void* self, const void* bytes, std::size_t count) {
    auto& zip = *static_cast<Zip*>(self);
    if (zip.ended_) return static_cast<la_ssize_t>(count);
    try {
      zip.output_.text({static_cast<const char*>(bytes), count});
      return static_cast<la_ssize_t>(count);
    } catch (...) {  // an exception must not pass through libarchive
      zip.problem_ = std::current_exception();
      return -1;
    }
  }
  void check(int code) {
    if (code != ARCHIVE_OK) fail();
  }
  [[noreturn]] void fail() {
    if (problem_) std::rethrow_exception(problem_);
    const char* text = archive_error_string(archive_);
    throw Error(output_.path(), "",
                std::string("cannot be written: ") + (text == nullptr ? "no reason given" : text));
  }

  OutputFile output_;
  std::exception_ptr problem_;
  bool ended_ = false;
  archive* archive_;
};

NpzFile::NpzFile(const std::filesystem::path& path) : zip_(std::make_unique<Zip>(path)) {}
NpzFile::~NpzFile() = default;

template <typename Number>
void NpzFile::add_numbers(const std::string& name, const char* type,
                          std::span<const Number> numbers, int columns) {
  const std::string rows = std::to_string(numbers.size() / static_cast<std::size_t>(columns));
  const std::string shape =
      columns == 1 ? "(" + rows + ",)" : "(" + rows + ", " + std::to_string(columns) + ")";
  zip_->add(name, npy_head(type, shape),
            {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()});
}

void NpzFile::add(const std::string& name, std::span<const float> numbers, int columns) {
  add_numbers(name, "<f4", numbers, columns);
}
void NpzFile::add(const std::string& name, std::span<const double> numbers, int columns) {
  add_numbers(name, "<f8", numbers, columns);
}
void NpzFile::add(const std::string& name, std::span<const std::int64_t> numbers, int columns) {
  add_numbers(name, "<i8", numbers, columns);
}

void NpzFile::add_text(const std::string& name, const std::string& text) {
  constexpr std::size_t kCharacterBytes = 4;
  std::string characters = utf32(text);
  // NumPy has no texts of no characters, but drops NULs at the end.
  characters.resize(std::max(characters.size(), kCharacterBytes));
  zip_->add(name, npy_head("<U" + std::to_string(characters.size() / kCharacterBytes), "()"),
            characters);
}

void NpzFile::add_number(const std::string& name, double number) {
  zip_->add(name, npy_head("<f8", "()"), {reinterpret_cast<const char*>(&number), sizeof number});
}

void NpzFile::commit() {
  zip_->commit();
}

}  // namespace semigeo::io
