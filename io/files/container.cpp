#include "io/files/container.hpp"

#include <archive_entry.h>
#include <locale.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <new>
#include <set>

#include "io/files/compression.hpp"
#include "io/files/error.hpp"
#include "io/files/file_signature.hpp"
#include "io/files/growth.hpp"
#include "io/files/input_file.hpp"
#include "io/files/libarchive.hpp"
#include "io/files/lower_case.hpp"

namespace semigeo::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCopyAgain = "copy the container again from its source";
constexpr const char* kDecrypt = "unpack it with its password and give the scans";

/// Lets the calls of libarchive take and give names as UTF-8, whatever the locale of the program.
class Utf8Names {
 public:
  Utf8Names() : before_(uselocale(utf8())) {}
  ~Utf8Names() { uselocale(before_); }
  Utf8Names(const Utf8Names&) = delete;
  Utf8Names& operator=(const Utf8Names&) = delete;

 private:
  static locale_t utf8() {
    static const locale_t locale = newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr);
    return locale;  // null changes nothing
  }
  locale_t before_;
};

std::string safe_name(std::string_view name) {
  std::string safe;
  while (!name.empty()) {
    const std::size_t end = std::min(name.find('/'), name.size());
    const std::string_view part = name.substr(0, end);
    name.remove_prefix(std::min(end + 1, name.size()));
    if (part.empty() || part == "." || part == "..") continue;
    if (!safe.empty()) safe += '/';
    safe += part;
  }
  return safe;
}

std::string name_of(archive_entry* entry) {
  const char* name = archive_entry_pathname(entry);
  if (name == nullptr) name = archive_entry_pathname_utf8(entry);
  return name == nullptr ? "" : safe_name(name);
}

ContainerReader::Kind kind_of(archive_entry* entry) {
  using Kind = ContainerReader::Kind;
  if (archive_entry_hardlink(entry) != nullptr) return Kind::kLink;
  switch (archive_entry_filetype(entry)) {
    case AE_IFREG:
      return Kind::kFile;
    case AE_IFDIR:
      return Kind::kFolder;
    case AE_IFLNK:
      return Kind::kLink;
    default:
      return Kind::kOther;
  }
}

/// Opens the file and enables the formats that it may have. Only tar is read through a compression:
/// the others have their own.
std::unique_ptr<Libarchive> libarchive_of(std::unique_ptr<InputFile> file) {
  std::array<char, kMagicBytes> begin{};
  const std::size_t got = file->read_at(0, begin);
  std::unique_ptr<Libarchive> archive;
  if (compression_of({begin.data(), got}) != nullptr) {
    archive = std::make_unique<Libarchive>(unpacked(std::move(file)).stream);
  } else {
    archive = std::make_unique<Libarchive>(std::move(file));
    archive_read_support_format_zip(archive->get());
    archive_read_support_format_7zip(archive->get());
  }
  archive_read_support_format_tar(archive->get());
  return archive;
}

constexpr const char* kTar = ".tar";
/// Extensions of containers, without those of a tar file that has that of its compression behind
/// it.
constexpr std::array<std::string_view, 7> kContainerExtensions = {".zip",  ".7z",  kTar,   ".tgz",
                                                                  ".tbz2", ".txz", ".tzst"};

/// Throws the Error of a file that is no container.
[[noreturn]] void refuse(const fs::path& container) {
  std::array<char, 1024> begin{};
  const std::size_t got = InputFile(container).read_at(0, begin);
  const std::optional<FileSignature> signature = file_signature({begin.data(), got});
  if (signature && !signature->is_container)
    throw Error(container, "",
                "the file is " + std::string(signature->what) + ", not a container of scans",
                std::string(signature->remedy));
  throw Error(
      container, "",
      signature ? "the container is damaged at its beginning" : "the file is no container of scans",
      signature ? kCopyAgain : "correct its extension or copy it again from its source");
}

bool is_about_encryption(const std::string& message) {
  const std::string text = lower_case(message);
  return text.find("encrypt") != std::string::npos ||
         text.find("passphrase") != std::string::npos || text.find("password") != std::string::npos;
}

std::string in_brackets(const std::string& message) {
  return message.empty() ? "" : " (" + message + ")";
}

}  // namespace

bool is_container_name(const fs::path& path) {
  const std::string name = lower_case(path.filename().string());
  const std::string extension = fs::path(name).extension().string();
  if (std::ranges::find(kContainerExtensions, extension) != kContainerExtensions.end()) return true;
  return compression_of_name(name) != nullptr && fs::path(name).stem().extension() == kTar;
}

std::vector<std::string> container_extensions() {
  std::vector<std::string> extensions(kContainerExtensions.begin(), kContainerExtensions.end());
  for (const FileCompression& compression : kFileCompressions)
    extensions.push_back(kTar + std::string(compression.extension));
  return extensions;
}

std::optional<MemberPath> member_path(const fs::path& path) {
  const std::string& text = path.native();
  for (std::size_t end = text.find('/', 1); end != std::string::npos;
       end = text.find('/', end + 1)) {
    const fs::path container = text.substr(0, end);
    struct stat status {};
    if (!is_container_name(container) || stat(container.c_str(), &status) != 0) continue;
    std::string member = safe_name(std::string_view(text).substr(end + 1));
    if (S_ISREG(status.st_mode)) return MemberPath{container, std::move(member)};
  }
  return std::nullopt;
}

fs::path outer_file(const fs::path& path) {
  const std::string& text = path.native();
  std::error_code ignored;
  for (std::size_t end = text.find('/', 1); end != std::string::npos;
       end = text.find('/', end + 1)) {
    fs::path container = text.substr(0, end);
    if (is_container_name(container) && !fs::is_directory(container, ignored)) return container;
  }
  return path;
}

ContainerReader::ContainerReader(const fs::path& container) : container_(container) {
  auto file = std::make_unique<InputFile>(container);
  container_bytes_ = file->size();
  if (container_bytes_ == 0)
    throw Error(container, "", "the file is empty", "copy it again from its source");
  archive_ = libarchive_of(std::move(file));
  const Utf8Names utf8;
  if (archive_->open() != ARCHIVE_OK) refuse(container);
}

ContainerReader::~ContainerReader() = default;

bool ContainerReader::next() {
  const Utf8Names utf8;
  archive_entry* entry = nullptr;
  int code = ARCHIVE_RETRY;
  while (code == ARCHIVE_RETRY)
    code = archive_->call([&] { return archive_read_next_header(archive_->get(), &entry); });
  if (code == ARCHIVE_EOF) return false;
  if (code < ARCHIVE_WARN) fail_listing();
  if (++members_ > kMostMembers)
    throw Error(container_, "", "has more than " + std::to_string(kMostMembers) + " members",
                "unpack it and give the scans");
  name_ = name_of(entry);
  path_ = container_ / name_;
  kind_ = name_.empty() ? Kind::kOther : kind_of(entry);
  encrypted_ = archive_entry_is_encrypted(entry) != 0;
  size_.reset();
  if (archive_entry_size_is_set(entry) != 0) size_ = archive_entry_size(entry);
  position_ = 0;
  return true;
}

std::size_t ContainerReader::read(std::span<char> bytes) {
  if (encrypted_) throw Error(path_, "", "is encrypted", kDecrypt);
  const Utf8Names utf8;
  la_ssize_t got = 0;
  try {
    got = archive_->call(
        [&] { return archive_read_data(archive_->get(), bytes.data(), bytes.size()); });
  } catch (const Error& error) {  // in the compression of the container
    throw Error(path_, error.place() + " of the container", error.problem(), error.remedy());
  }
  if (got < 0) fail_member();
  position_ += got;
  check_growth(path_, std::max(container_bytes_, archive_->fed()), position_);
  return static_cast<std::size_t>(got);
}

void ContainerReader::fail_listing() {
  const std::string message = archive_->message();
  if (is_about_encryption(message)) throw Error(container_, "", "is encrypted", kDecrypt);
  if (members_ == 0) refuse(container_);
  const std::string last = name_.empty() ? "number " + std::to_string(members_) : name_;
  throw Error(container_, "behind member " + last,
              "the container is damaged" + in_brackets(message), kCopyAgain);
}

void ContainerReader::fail_member() {
  const std::string message = archive_->message();
  if (is_about_encryption(message)) throw Error(path_, "", "is encrypted", kDecrypt);
  throw Error(path_, "before byte " + std::to_string(position_),
              "the data of this member is damaged" + in_brackets(message), kCopyAgain);
}

ContainerListing list_container(const fs::path& container) {
  ContainerListing listing;
  std::set<std::string> names;
  try {
    ContainerReader reader(container);
    while (reader.next()) {
      if (reader.kind() == ContainerReader::Kind::kLink) ++listing.links;
      if (reader.kind() != ContainerReader::Kind::kFile) continue;
      if (!names.insert(reader.name()).second) {
        ++listing.repeated;
        continue;
      }
      listing.members.push_back({.name = reader.name(),
                                 .bytes = std::max<std::int64_t>(reader.size().value_or(0), 0),
                                 .encrypted = reader.is_encrypted()});
    }
  } catch (const Error& error) {
    listing.error = error.what();
  }
  return listing;
}

std::unique_ptr<ByteStream> open_bytes(const fs::path& path) {
  const std::optional<MemberPath> place = member_path(path);
  if (!place) return std::make_unique<InputFile>(path);
  auto reader = std::make_unique<ContainerReader>(place->container);
  while (reader->next())
    if (reader->kind() == ContainerReader::Kind::kFile && reader->name() == place->member)
      return reader;
  throw Error(path, "", "the container has no such member", "check the path");
}

}  // namespace semigeo::io
