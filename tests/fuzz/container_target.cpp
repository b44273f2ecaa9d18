// A container of files. The first byte tells whether the checksums of tar headers are made right
// again; the rest are the bytes of the file.
#include <algorithm>
#include <cstdio>

#include "io/files/container.hpp"
#include "io/files/error.hpp"
#include "io/scans/scan_reader.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::fuzz {
namespace {

constexpr std::size_t kBlock = 512;       // of a tar
constexpr std::size_t kChecksumAt = 148;  // in a header
constexpr std::size_t kChecksumBytes = 8;
constexpr std::size_t kMagicAt = 257;

/// Makes the checksums right of all that looks like the header of a tar's member.
void mend_tar(std::string& bytes) {
  for (std::size_t at = 0; at + kBlock <= bytes.size(); at += kBlock) {
    if (bytes.compare(at + kMagicAt, 5, "ustar") != 0) continue;
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at + kChecksumAt), kChecksumBytes, ' ');
    unsigned sum = 0;
    for (std::size_t i = 0; i < kBlock; ++i) sum += static_cast<unsigned char>(bytes[at + i]);
    std::snprintf(&bytes[at + kChecksumAt], kChecksumBytes, "%06o", sum);
  }
}

void check_name(const std::string& name) {
  check(!name.empty() && name.front() != '/' && name.back() != '/', "a name is none of a file");
  check(("/" + name + "/").find("/../") == std::string::npos, "a name leads out");
  check(("/" + name + "/").find("/./") == std::string::npos, "a name is not simple");
  check(name.find("//") == std::string::npos, "a name has an empty part");
}

/// Members may unpack to 1 GiB; more than this takes too long here.
constexpr std::int64_t kMostBytes = 1 << 20;

/// Reads the beginning of each member.
void read_members(const std::filesystem::path& path) {
  constexpr int kMostRead = 4;
  std::string buffer(1 << 12, '\0');
  io::ContainerReader reader(path);
  for (int read = 0; read < kMostRead && reader.next();) {
    check(reader.path() == path / reader.name(), "the path of a member is wrong");
    if (reader.kind() != io::ContainerReader::Kind::kFile) continue;
    ++read;
    while (reader.position() < kMostBytes && reader.read(buffer) > 0) {
    }
  }
}

void read_first_scan(const std::filesystem::path& path, const io::ContainerListing& listing) {
  const auto scan = std::ranges::find_if(listing.members, [](const io::Member& member) {
    return io::is_scan_name(member.name) && member.bytes <= kMostBytes;
  });
  io::read_scan(path / (scan == listing.members.end() ? "none.ply" : scan->name));
}

}  // namespace

void read_input(std::string_view bytes) {
  Numbers numbers(bytes);
  const bool mend = numbers.below(2) != 0;
  std::string content(numbers.rest());
  if (mend) mend_tar(content);
  const std::filesystem::path path = write("scans.zip", content);
  const io::ContainerListing listing = io::list_container(path);
  for (const io::Member& member : listing.members) {
    check_name(member.name);
    check(member.bytes >= 0, "a size is negative");
  }
  for (const auto& read :
       {+[](const std::filesystem::path&file, const io::ContainerListing&) { read_members(file); },
        +read_first_scan}) {
    try {
      read(path, listing);
    } catch (const io::Error& error) {
      check(error.file().native().starts_with(path.native()), "an error names another file");
    }
  }
}

}  // namespace semigeo::fuzz
