#include "io/files/file_signature.hpp"

#include <utility>

#include "tests/io/scans/scan_files.hpp"

namespace semigeo::io {
namespace {

using namespace std::string_literals;

/// Returns the text as UTF-16 without a byte-order mark.
std::string utf16(std::string_view text, bool big_endian) {
  std::string bytes;
  for (const char c : text) {
    if (big_endian) bytes += '\0';
    bytes += c;
    if (!big_endian) bytes += '\0';
  }
  return bytes;
}

std::string tar_begin() {
  std::string bytes(512, '\0');
  bytes.replace(0, 5, "a.ply");
  bytes.replace(257, 5, "ustar");
  return bytes;
}

/// Returns first bytes, and a part of the words for them.
std::vector<std::pair<std::string, std::string>> known_files() {
  return {
      {"version https://git-lfs.github.com/spec/v1\noid sha256:12\nsize 34\n",
       "pointer of Git LFS"},
      {"\n <!DOCTYPE html>\n<html>", "web page (HTML)"},
      {"\xef\xbb\xbf<HTML lang='en'>", "web page (HTML)"},
      {"PK\x03\x04\x14", "ZIP archive"},
      {"7z\xbc\xaf\x27\x1c", "7z archive"},
      {tar_begin(), "tar archive"},
      {"\xff\xfe" + utf16("OFF\n3 1 0\n", false), "UTF-16 text"},
      {"\xfe\xff" + utf16("OFF\n3 1 0\n", true), "UTF-16 text"},
      {utf16("# a comment\nv 0 0 0\n", false), "UTF-16 text"},
      {utf16("# a comment\nv 0 0 0\n", true), "UTF-16 text"},
      {"\xff\xd8\xff\xe0", "JPEG image"},
      {"\x89PNG\r\n\x1a\n", "PNG image"},
      {"II*\0"s, "TIFF image"},
      {"MM\0*"s, "TIFF image"},
      {"%PDF-1.7", "PDF document"},
      {"ASTM-E57", "E57 point cloud"},
      {std::string(500, '\0'), "nothing but zeros"},
  };
}

TEST(FileSignatureTest, NamesWhatIsKnown) {
  for (const auto& [bytes, words] : known_files()) {
    const auto signature = file_signature(bytes);
    ASSERT_TRUE(signature) << words;
    EXPECT_NE(signature->what.find(words), std::string_view::npos) << signature->what;
    EXPECT_FALSE(signature->remedy.empty()) << words;
    EXPECT_EQ(signature->extension, "") << words;
  }
}

TEST(FileSignatureTest, KnowsScans) {
  EXPECT_EQ(file_signature("ply\r\nformat ascii 1.0").value().extension, ".ply");
  EXPECT_EQ(file_signature("solid cube\n").value().extension, ".stl");
  EXPECT_EQ(file_signature("OFF\n3 1 0").value().extension, ".off");
  EXPECT_EQ(file_signature("glTF\2").value().extension, ".glb");
  EXPECT_EQ(file_signature("# vtk DataFile Version 4.2\n").value().extension, ".vtk");
  EXPECT_EQ(file_signature("<VTKFile type=").value().extension, ".vtp");
  EXPECT_EQ(file_signature("<?xml version=\"1.0\"?>\n<VTKFile").value().extension, ".vtp");
  EXPECT_EQ(file_signature("<?xml version=\"1.0\"?>\n<X3D>").value().extension, "");
}

TEST(FileSignatureTest, SaysNothingOfOtherBytes) {
  for (const std::string& bytes : {""s, "v 0 0 0\n"s, "Dear colleague,\n"s, "P"s, "\0\0\0\1"s,
                                   "<a.ply>"s, std::string(80, ' '), utf16("short", false)})
    EXPECT_FALSE(file_signature(bytes)) << bytes;
}

using RefusedFiles = ScanFileTest;

TEST_F(RefusedFiles, AreNamedAsWhatTheyAreByEveryReader) {
  for (const auto& [bytes, words] : known_files()) {
    for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl"})
      expect_parts(error(name, bytes),
                   {std::string(name) + ": the file is ", words, ", not a scan; "});
    expect_parts(error("a.ply.gz", gzip(bytes)), {words});
  }
}

TEST_F(RefusedFiles, ScansOfAnotherExtensionAreNamed) {
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n";
  EXPECT_EQ(error("a.obj", ply), "a.obj: the file is a PLY file; correct its extension to .ply");
  // The reader of the right format knows better.
  expect_parts(error("a.ply", ply), {"line 3", "no property x"});
}

/// A file of zeros has the size of a binary STL by chance.
TEST_F(RefusedFiles, ZerosAreNoTriangles) {
  expect_parts(error("a.stl", std::string(84 + 50 * 10, '\0')), {"nothing but zeros"});
}

std::string binary_stl(std::string_view begin) {
  std::string header(begin);
  header.resize(80, ' ');
  std::string bytes = header + bytes_of(std::uint32_t{1});
  for (const float x : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
    bytes += bytes_of(x);
  return bytes + std::string(2, '\0');
}

TEST_F(RefusedFiles, GoodScansMayBeginWithAnyBytes) {
  for (const std::string& begin :
       {"PK\x03\x04"s, "%PDF-"s, "ply\n"s, "\xff\xfe"s, std::string(80, '\0')})
    EXPECT_EQ(read("a.stl", binary_stl(begin)).mesh.triangles.size(), 1u) << begin;
}

}  // namespace
}  // namespace semigeo::io
