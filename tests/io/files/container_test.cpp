#include "io/files/container.hpp"

#include <map>

#include "io/files/byte_source.hpp"
#include "io/files/compression.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/growth.hpp"
#include "tests/io/scans/scan_files.hpp"
#include "tests/support/containers.hpp"

namespace semigeo::io {
namespace {

namespace fs = std::filesystem;
using tests::NewMember;
using tests::write_compressed;
using tests::write_container;

std::string some_bytes(std::size_t count) {
  std::string bytes(count, '\0');
  std::uint32_t state = 7;
  for (char& c : bytes) c = static_cast<char>((state = state * 1664525 + 1013904223) >> 24);
  return bytes;
}

std::string content_of(const fs::path& path) {
  std::string all;
  const auto stream = open_bytes(path);
  std::string buffer(70'001, '\0');
  while (const std::size_t got = stream->read(buffer)) all += buffer.substr(0, got);
  EXPECT_EQ(stream->position(), static_cast<std::int64_t>(all.size()));
  return all;
}

std::string failure_of(const fs::path& path) {
  try {
    content_of(path);
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << path << " was read";
  return {};
}

std::vector<std::string> names_of(const ContainerListing& listing) {
  std::vector<std::string> names;
  for (const Member& member : listing.members) names.push_back(member.name);
  return names;
}

using Names = std::vector<std::string>;

/// The containers that are read, with the format and the filter of libarchive's writer.
struct Format {
  const char* file;
  const char* format;
  const char* filter;
};
constexpr std::array kFormats = {
    Format{"a.zip", "zip", ""},        Format{"a.7z", "7zip", ""},
    Format{"a.tar", "pax", ""},        Format{"a.tar.gz", "pax", "gzip"},
    Format{"a.TGZ", "pax", "gzip"},    Format{"a.tar.bz2", "pax", "bzip2"},
    Format{"a.tar.xz", "pax", "xz"},   Format{"a.txz", "pax", "xz"},
    Format{"a.tar.zst", "pax", "zstd"}};

class ContainerTest : public ::testing::Test {
 protected:
  tests::TemporaryFolder folder_;
};

TEST(ContainerNameTest, IsDecidedByTheExtension) {
  for (const Format& format : kFormats) EXPECT_TRUE(is_container_name(format.file)) << format.file;
  for (const char* name : {"a", "zip", "a.ply", "a.ply.gz", "a.gz", ".tar", "a.zip/b", "a.rar"})
    EXPECT_FALSE(is_container_name(name)) << name;
}

TEST_F(ContainerTest, EveryFormatGivesBackItsMembers) {
  const std::string large = some_bytes(700'000) + std::string(2'000'000, 'x');
  const std::vector<NewMember> members = {{.name = "part/a.ply", .bytes = "first"},
                                          {.name = "part/b.ply", .bytes = large},
                                          {.name = "é 日本.txt", .bytes = ""}};
  for (const Format& format : kFormats) {
    const fs::path file =
        write_container(folder_ / format.file, format.format, members, format.filter);
    const ContainerListing listing = list_container(file);
    EXPECT_EQ(listing.error, "");
    EXPECT_EQ(names_of(listing), (Names{"part/a.ply", "part/b.ply", "é 日本.txt"})) << format.file;
    EXPECT_EQ(listing.members.at(1).bytes, static_cast<std::int64_t>(large.size()));
    EXPECT_EQ(content_of(file / "part/a.ply"), "first") << format.file;
    EXPECT_TRUE(content_of(file / "part/b.ply") == large) << format.file;
    EXPECT_EQ(content_of(file / "é 日本.txt"), "") << format.file;
    EXPECT_EQ(xxh3_of_file(file / "part/b.ply"),
              xxh3_of_file(write_file(folder_ / "plain", large)));
    expect_parts(failure_of(file / "part/c.ply"), {"part/c.ply: the container has no such member"});
  }
}

TEST_F(ContainerTest, AnEmptyContainerHasNoMembers) {
  for (const Format& format : kFormats) {
    const auto listing =
        list_container(write_container(folder_ / format.file, format.format, {}, format.filter));
    EXPECT_EQ(listing.error, "") << format.file;
    EXPECT_TRUE(listing.members.empty()) << format.file;
  }
}

TEST_F(ContainerTest, PathsLeadThroughContainers) {
  const fs::path file = write_container(folder_ / "box.zip", "zip", {{.name = "part/a.ply"}});
  fs::create_directories(folder_ / "folder.zip");
  write_file(folder_ / "folder.zip" / "a.ply", "plain");
  const auto place = member_path(file / "part/a.ply");
  ASSERT_TRUE(place);
  EXPECT_EQ(place->container, file);
  EXPECT_EQ(place->member, "part/a.ply");
  EXPECT_EQ(member_path(file / "./part/../part/a.ply")->member, "part/part/a.ply");
  EXPECT_FALSE(member_path(file));
  EXPECT_EQ(outer_file(file / "part/a.ply"), file);
  EXPECT_EQ(outer_file(file), file);
  EXPECT_EQ(outer_file(folder_ / "gone.zip/a.ply"), folder_ / "gone.zip");
  EXPECT_EQ(outer_file(folder_ / "folder.zip/a.ply"), folder_ / "folder.zip/a.ply");
  EXPECT_FALSE(member_path(folder_ / "folder.zip/a.ply"));
  EXPECT_FALSE(member_path(folder_ / "missing.zip/a.ply"));
  EXPECT_EQ(content_of(folder_ / "folder.zip/a.ply"), "plain");
}

TEST_F(ContainerTest, NamesNeverLeadOutside) {
  const fs::path file = write_container(folder_ / "a.tar", "pax",
                                        {{.name = "/etc/a.ply", .bytes = "1"},
                                         {.name = "../../b.ply", .bytes = "2"},
                                         {.name = "./x//../c.ply", .bytes = "3"},
                                         {.name = "..", .bytes = "4"}});
  EXPECT_EQ(names_of(list_container(file)), (Names{"etc/a.ply", "b.ply", "x/c.ply"}));
  EXPECT_EQ(content_of(file / "etc/a.ply"), "1");
  EXPECT_EQ(content_of(file / "b.ply"), "2");
}

TEST_F(ContainerTest, TheFirstOfSeveralMembersOfANameCounts) {
  for (const char* format : {"zip", "pax"}) {
    const fs::path file = write_container(
        folder_ / (format == std::string("zip") ? "a.zip" : "a.tar"), format,
        {{.name = "a.ply", .bytes = "first"}, {.name = "./a.ply", .bytes = "second"}});
    const auto listing = list_container(file);
    EXPECT_EQ(names_of(listing), Names{"a.ply"});
    EXPECT_EQ(listing.repeated, 1);
    EXPECT_EQ(content_of(file / "a.ply"), "first");
  }
}

TEST_F(ContainerTest, LinksAreCountedAndNotRead) {
  const fs::path file = write_container(folder_ / "a.tar", "pax",
                                        {{.name = "a.ply", .bytes = "bytes"},
                                         {.name = "soft.ply", .link = "/etc/passwd"},
                                         {.name = "hard.ply", .link = "a.ply", .hard = true}});
  const auto listing = list_container(file);
  EXPECT_EQ(names_of(listing), Names{"a.ply"});
  EXPECT_EQ(listing.links, 2);
  expect_parts(failure_of(file / "soft.ply"), {"no such member"});
}

TEST_F(ContainerTest, EncryptedMembersAreNamed) {
  const fs::path file =
      write_container(folder_ / "a.zip", "zip", {{.name = "a.ply", .bytes = "secret"}}, "",
                      "zip:encryption=aes256", "password");
  const auto listing = list_container(file);
  ASSERT_EQ(listing.members.size(), 1u);
  EXPECT_TRUE(listing.members[0].encrypted);
  expect_parts(failure_of(file / "a.ply"), {"a.zip/a.ply: is encrypted", "password"});
}

/// The members before the damage are read; a damaged member harms no other one of a ZIP.
TEST_F(ContainerTest, DamageIsNamed) {
  const std::string bytes = some_bytes(300'000);
  const std::vector<NewMember> members = {{.name = "a.ply", .bytes = bytes},
                                          {.name = "b.ply", .bytes = some_bytes(3'000'000)},
                                          {.name = "c.ply", .bytes = "end"}};
  for (const Format& format : kFormats) {
    const fs::path whole =
        write_container(folder_ / "whole", format.format, members, format.filter);
    fs::copy_file(whole, folder_ / format.file);
    fs::resize_file(folder_ / format.file, fs::file_size(whole) * 6 / 10);
    const auto listing = list_container(folder_ / format.file);
    expect_parts(listing.error, {format.file, "; "});
    EXPECT_EQ(listing.error.find("INTERNAL"), std::string::npos) << listing.error;
    if (format.format != std::string("7zip"))
      EXPECT_TRUE(content_of(folder_ / format.file / "a.ply") == bytes) << format.file;
    fs::remove(whole);
  }
  const fs::path zip = write_container(folder_ / "b.zip", "zip", members);
  std::fstream stream(zip, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(150'000);
  stream.write("damage", 6);
  stream.close();
  expect_parts(
      failure_of(zip / "a.ply"),
      {"b.zip/a.ply: before byte ", "the data of this member is damaged", "copy the container"});
  EXPECT_EQ(content_of(zip / "b.ply").size(), 3'000'000u);
  EXPECT_EQ(list_container(zip).error, "");
}

TEST_F(ContainerTest, DamageBehindAMemberWithoutNameHasItsNumber) {
  const fs::path file = write_container(
      folder_ / "a.tar", "pax",
      {{.name = "a.ply", .bytes = "1"}, {.name = "..", .bytes = std::string(100'000, 'x')}});
  fs::resize_file(file, 50'000);
  expect_parts(list_container(file).error, {"a.tar: behind member number 2: "});
}

TEST_F(ContainerTest, OtherFilesAreRefused) {
  const auto error = [&](const char* name, std::string_view bytes) {
    return list_container(write_file(folder_ / name, bytes)).error;
  };
  expect_parts(error("a.zip", ""), {"a.zip: the file is empty"});
  expect_parts(error("a.zip", "<html>404</html>"), {"is a web page (HTML), not a container"});
  expect_parts(error("a.7z", some_bytes(5000)), {"a.7z: the file is no container of scans"});
  expect_parts(error("a.tar", std::string(3, 'x')), {"no container"});
  expect_parts(error("a.zip", "PK\x03\x04"), {"the container is damaged"});
  expect_parts(list_container(folder_ / "missing.zip").error, {"there is no such file"});
  // The extension may be that of another container.
  EXPECT_EQ(names_of(list_container(
                write_container(folder_ / "b.zip", "pax", {{.name = "a.ply"}}, "gzip"))),
            Names{"a.ply"});
}

using CompressedFiles = ScanFileTest;

TEST_F(CompressedFiles, AreReadWhateverTheName) {
  const std::string bytes = some_bytes(1'300'000) + std::string(3'000'000, 'x');
  for (const auto& [filter, name] : std::map<const char*, std::string_view>{
           {"gzip", "gzip"}, {"bzip2", "bzip2"}, {"xz", "xz"}, {"zstd", "zstd"}}) {
    ByteSource source(write_compressed(folder_ / "a.ply", filter, bytes));
    EXPECT_EQ(source.compression(), name);
    EXPECT_EQ(source.bytes_left(), std::nullopt);
    std::string all;
    while (source.fill(1)) {
      all += source.ahead();
      source.consume(source.ahead().size());
    }
    EXPECT_TRUE(all == bytes) << filter;
    ByteSource empty(write_compressed(folder_ / "b.ply", filter, ""));
    EXPECT_FALSE(empty.fill(1)) << filter;
  }
}

TEST_F(CompressedFiles, AreRefusedIfDamaged) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
  std::string text = obj;
  for (int i = 0; text.size() < 200'000; ++i)
    text += "# " + std::to_string(i * 7919 % 104729) + "\n";
  for (const char* filter : {"bzip2", "xz", "zstd"}) {
    const fs::path whole = write_compressed(folder_ / "whole", filter, text);
    std::string packed(fs::file_size(whole), '\0');
    std::ifstream(whole, std::ios::binary).read(packed.data(), std::ssize(packed));
    const std::string name = filter;
    EXPECT_EQ(read("a.obj", packed).format, "OBJ, " + name);
    for (const std::size_t size : {std::size_t{6}, packed.size() / 2, packed.size() - 1})
      expect_parts(error("cut.obj", packed.substr(0, size)), {"cut.obj: ", name + " data"});
    std::string damaged = packed;
    damaged[packed.size() / 2] = static_cast<char>(damaged[packed.size() / 2] ^ 0x55);
    expect_parts(error("damaged.obj", damaged), {"the " + name + " data is damaged"});
    expect_parts(error("more.obj", packed + "other bytes behind the end"), {name + " data"});
    EXPECT_EQ(read("two.obj", packed + packed).mesh.triangles.size(), 2u) << name;
  }
}

TEST_F(CompressedFiles, ScansInContainersAreScans) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
  const fs::path zip = write_container(folder_ / "a.zip", "zip",
                                       {{.name = "a.obj", .bytes = obj},
                                        {.name = "b.obj.gz", .bytes = gzip(obj)},
                                        {.name = "c.ply", .bytes = "Dear colleague"}});
  EXPECT_EQ(read_scan(zip / "a.obj").format, "OBJ");
  EXPECT_EQ(read_scan(zip / "b.obj.gz").format, "OBJ, gzip");
  try {
    read_scan(zip / "c.ply");
    ADD_FAILURE();
  } catch (const Error& error) {
    expect_parts(error.what(), {"a.zip/c.ply: ", "not a PLY file"});
  }
  expect_parts(error("box.ply", "PK\x03\x04 and more"),
               {"is a ZIP archive", "correct its extension"});
}

TEST(GrowthTest, ABombIsRefused) {
  EXPECT_NO_THROW(check_growth("a", 1, kUnsuspicious));
  EXPECT_NO_THROW(check_growth("a", kMostUnpacked, kMostUnpacked));
  EXPECT_THROW(check_growth("a", kUnsuspicious / 2000, kUnsuspicious + 1), Error);
  EXPECT_THROW(check_growth("a", kMostUnpacked, kMostUnpacked + 1), Error);
}

}  // namespace
}  // namespace semigeo::io
