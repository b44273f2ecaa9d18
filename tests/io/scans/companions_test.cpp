#include "io/scans/companions.hpp"

#include <set>

#include "io/files/file_digest.hpp"
#include "tests/io/scans/gltf_files.hpp"
#include "tests/support/containers.hpp"

namespace semigeo::io {
namespace {

namespace fs = std::filesystem;

class Companions : public ScanFileTest {
 protected:
  /// Returns the names of companions of a file of these bytes, without its folder.
  std::vector<std::string> names(std::string_view name, std::string_view bytes) {
    std::vector<std::string> found;
    for (const fs::path& path : scan_content(write_file(folder_ / name, bytes)).companions)
      found.push_back(path.lexically_relative(folder_.path()).string());
    return found;
  }
  std::vector<std::string> names_of(const std::string& buffers) {
    return names("a.gltf", R"({"asset":{"version":"2.0"},"buffers":)" + buffers + "}");
  }
};

using Names = std::vector<std::string>;

TEST(CompanionName, StaysWithinTheFolder) {
  EXPECT_EQ(companion_name("a.bin"), "a.bin");
  EXPECT_EQ(companion_name("./part//a%20b%2e.bin"), "part/a b..bin");
  EXPECT_EQ(companion_name("100%.bin"), "100%.bin");
  EXPECT_EQ(companion_name("part/a:b.bin"), "part/a:b.bin");
  EXPECT_EQ(companion_name("%C3%A9.bin"), "\xc3\xa9.bin");
  for (const std::string_view outside :
       {"/etc/passwd", "../a.bin", "a/../../b.bin", "a/..", "%2e%2e/a.bin", "%2Fetc",
        "http://x/a.bin", "file:a.bin", "C:\\a.bin", "", ".", "a%00b"})
    EXPECT_EQ(companion_name(outside), std::nullopt) << outside;
}

TEST_F(Companions, AreTheFilesOfBuffersInTheirOrder) {
  EXPECT_EQ(names_of(R"([{"uri":"z.bin"},{"byteLength":3},{"uri":"a/b%20c.bin"},{"uri":"z.bin"}])"),
            (Names{"z.bin", "a/b c.bin"}));
  EXPECT_EQ(names_of(R"([{"uri":"data:;base64,AA"},{"uri":"../a"},{"uri":7},{"uri":["a"]},[1],2])"),
            Names());
  const GltfParts parts = square_parts();
  EXPECT_EQ(names("a.gltf", parts.gltf()), Names());
  EXPECT_EQ(names("a.glb", glb(parts.json(R"(,"uri":"a.bin")"), "")), Names{"a.bin"});
  EXPECT_EQ(names("a.gltf.gz", gzip(parts.json(R"(,"uri":"a.bin")"))), Names{"a.bin"});
  EXPECT_EQ(names("a.ply", parts.json(R"(,"uri":"a.bin")")), Names());
}

TEST_F(Companions, OtherObjectsDoNotCountAsBuffers) {
  std::string nodes = "{}";
  for (int i = 0; i < 2 * kMostCompanions; ++i) nodes += ",{\"uri\":\"x\"}";
  EXPECT_EQ(names("a.gltf", R"({"nodes":[)" + nodes + R"(],"buffers":[{"uri":"a.bin"}]})"),
            Names{"a.bin"});
}

TEST_F(Companions, DamagedAndHostileFilesHaveFewOrNone) {
  for (const std::string text :
       {"", "{", "[]", "7", "[[[[", "{\"buffers\":{}}", "glTF", "glTF\2\0\0\0"})
    EXPECT_EQ(names("a.gltf", text), Names()) << text;
  EXPECT_EQ(names("a.gltf", "[" + std::string(1'000'000, '[')), Names());
  std::string many = "{\"uri\":\"a0.bin\"}";
  for (int i = 1; i < 3 * kMostCompanions; ++i)
    many += ",{\"uri\":\"a" + std::to_string(i) + ".bin\"}";
  EXPECT_EQ(std::ssize(names_of("[" + many + "]")), kMostCompanions);
  EXPECT_EQ(names("a.gltf.gz", "\x1f\x8b nonsense"), Names());
  EXPECT_EQ(names("a.gltf.xz", std::string("\xfd"
                                           "7zXZ\0nonsense",
                                           14)),
            Names());
}

TEST_F(Companions, TheDigestCoversThem) {
  const fs::path scan =
      write_file(folder_ / "a.gltf", R"({"buffers":[{"uri":"a.bin"},{"uri":"b.bin"}]})");
  const std::string absent = xxh3_of_scan(scan);
  EXPECT_NE(absent, xxh3_of_file(scan));
  write_file(folder_ / "a.bin", "");
  const std::string empty = xxh3_of_scan(scan);
  write_file(folder_ / "a.bin", "one");
  const std::string first = xxh3_of_scan(scan);
  fs::rename(folder_ / "a.bin", folder_ / "b.bin");
  const std::string second = xxh3_of_scan(scan);
  EXPECT_EQ((std::set{absent, empty, first, second}.size()), 4u);
  EXPECT_EQ(bytes_of_scan(scan), fs::file_size(scan) + 3);
  fs::rename(folder_ / "b.bin", folder_ / "a.bin");
  EXPECT_EQ(xxh3_of_scan(scan), first);
  const fs::path plain = write_file(folder_ / "a.ply", "ply");
  EXPECT_EQ(xxh3_of_scan(plain), xxh3_of_file(plain));
  EXPECT_EQ(bytes_of_scan(plain), 3u);
}

TEST_F(Companions, OfAMemberAreMembers) {
  const std::string json = R"({"buffers":[{"uri":"a%20b.bin"}]})";
  write_file(folder_ / "a b.bin", "one");
  const fs::path plain = write_file(folder_ / "a.gltf", json);
  tests::write_container(
      folder_ / "box.zip", "zip",
      {{.name = "part/a b.bin", .bytes = "one"}, {.name = "part/a.gltf", .bytes = json}});
  const fs::path member = folder_ / "box.zip/part/a.gltf";
  EXPECT_EQ(scan_content(member).companions,
            (std::vector<fs::path>{folder_ / "box.zip/part/a b.bin"}));
  EXPECT_EQ(xxh3_of_scan(member), xxh3_of_scan(plain)) << "wherever it is";
}

TEST_F(Companions, OfAFileAreNotLookedForInContainersBesideIt) {
  const fs::path scan = write_file(folder_ / "a.gltf", R"({"buffers":[{"uri":"box.zip/a.bin"}]})");
  const std::string absent = xxh3_of_scan(scan);
  tests::write_container(folder_ / "box.zip", "zip", {{.name = "a.bin", .bytes = "one"}});
  EXPECT_EQ(xxh3_of_scan(scan), absent);
  write_file(folder_ / "box.zip", "no container");
  EXPECT_EQ(xxh3_of_scan(scan), absent);
  fs::remove(folder_ / "box.zip");
  fs::create_directory(folder_ / "box.zip");
  write_file(folder_ / "box.zip/a.bin", "one");
  EXPECT_NE(xxh3_of_scan(scan), absent) << "a folder may have any name";
}

TEST_F(Companions, WhatWasReadHasTheDigestOfTheFiles) {
  const GltfParts parts = square_parts();
  write_file(folder_ / "a.bin", parts.bytes);
  for (const auto& [name, bytes] : {std::pair<std::string, std::string>{"a.glb", parts.glb()},
                                    {"b.glb.gz", gzip(parts.glb())},
                                    {"c.gltf", parts.json(R"(,"uri":"a.bin")")},
                                    {"d.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\nrest"}}) {
    const std::string of_read = read(name, bytes).xxh3;
    EXPECT_EQ(of_read, xxh3_of_scan(folder_ / name)) << name;
  }
}

}  // namespace
}  // namespace semigeo::io
