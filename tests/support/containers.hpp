#pragma once

#include <archive.h>
#include <archive_entry.h>
#include <locale.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// Containers and compressed files for tests, made by libarchive.
namespace semigeo::tests {

/// A member of a container: a file, or a symbolic link if `link` is not empty.
struct NewMember {
  std::string name;
  std::string bytes = {};
  std::string link = {};
  bool hard = false;  ///< The link is a hard link.
};

inline void check_archive(archive* writer, int code) {
  if (code >= ARCHIVE_WARN) return;
  const char* const reason = archive_error_string(writer);
  throw std::runtime_error(reason == nullptr ? "libarchive" : reason);
}

/// Writes a container. `format` is "zip", "7zip", "pax" or "raw", `filter` is "", "gzip", "bzip2",
/// "xz" or "zstd". `options` and `password` are those of libarchive. Returns its path.
inline std::filesystem::path write_container(const std::filesystem::path& path, const char* format,
                                             const std::vector<NewMember>& members,
                                             const char* filter = "", const char* options = "",
                                             const char* password = nullptr) {
  const locale_t utf8 = newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr);
  const locale_t before = uselocale(utf8);
  archive* const writer = archive_write_new();
  check_archive(writer, archive_write_set_format_by_name(writer, format));
  if (*filter != 0) check_archive(writer, archive_write_add_filter_by_name(writer, filter));
  if (*options != 0) check_archive(writer, archive_write_set_options(writer, options));
  if (password != nullptr) check_archive(writer, archive_write_set_passphrase(writer, password));
  check_archive(writer, archive_write_set_bytes_in_last_block(writer, 1));
  check_archive(writer, archive_write_open_filename(writer, path.c_str()));
  for (const NewMember& member : members) {
    archive_entry* const entry = archive_entry_new();
    archive_entry_set_pathname(entry, member.name.c_str());
    archive_entry_set_perm(entry, 0644);
    archive_entry_set_filetype(entry, member.link.empty() || member.hard ? AE_IFREG : AE_IFLNK);
    if (!member.link.empty() && member.hard) archive_entry_set_hardlink(entry, member.link.c_str());
    if (!member.link.empty() && !member.hard) archive_entry_set_symlink(entry, member.link.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(member.bytes.size()));
    check_archive(writer, archive_write_header(writer, entry));
    if (!member.bytes.empty())
      check_archive(writer, archive_write_data(writer, member.bytes.data(), member.bytes.size()) < 0
                                ? ARCHIVE_FATAL
                                : ARCHIVE_OK);
    archive_entry_free(entry);
  }
  check_archive(writer, archive_write_close(writer));
  archive_write_free(writer);
  uselocale(before);
  freelocale(utf8);
  return path;
}

/// Writes a compressed file and returns its path.
inline std::filesystem::path write_compressed(const std::filesystem::path& path, const char* filter,
                                              std::string_view bytes) {
  return write_container(path, "raw", {{.name = "data", .bytes = std::string(bytes)}}, filter);
}

}  // namespace semigeo::tests
