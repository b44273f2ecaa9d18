#include "jobs/archive/scan_size.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

class ScanSizeTest : public testing::Test {
 protected:
  std::string format(const char* name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    const ScanSize size = scan_size(folder_ / name);
    if (!size.format.empty()) {
      EXPECT_EQ(size.bytes, text.size());
    }
    return size.format;
  }
  tests::TemporaryFolder folder_;
};

TEST_F(ScanSizeTest, TellsFormatsByTheirFirstBytes) {
  EXPECT_EQ(format("a.ply", "ply\nformat ascii 1.0\nelement"), "PLY ascii");
  EXPECT_EQ(format("a.PLY", "ply\nformat binary_big_endian 1.0\n"), "PLY binary");
  EXPECT_EQ(format("a.obj", "v 0 0 0\n"), "OBJ");
  EXPECT_EQ(format("a.off", "OFF\n3 1 0\n"), "OFF");
  EXPECT_EQ(format("b.off", "OFF BINARY\n"), "OFF binary");
  EXPECT_EQ(format("a.stl", "solid a\nfacet normal 0 0 1\n"), "STL ascii");
  EXPECT_EQ(format("b.stl", "solid binary" + std::string(80, '\0')), "STL binary");
  EXPECT_EQ(format("c.stl", std::string(84, '\0')), "STL binary");
}

TEST_F(ScanSizeTest, LooksIntoCompressedFiles) {
  const auto path = folder_ / "a.ply.gz";
  const gzFile file = gzopen(path.c_str(), "wb");
  gzputs(file, "ply\nformat ascii 1.0\n");
  gzclose(file);
  const ScanSize size = scan_size(path);
  EXPECT_EQ(size.format, "PLY ascii, gzip");
  EXPECT_EQ(size.bytes, std::filesystem::file_size(path));
}

TEST_F(ScanSizeTest, CountsTheFilesBesideAScan) {
  std::ofstream(folder_ / "a.bin") << "twelve bytes";
  const std::string json = R"({"buffers":[{"uri":"a.bin"}]})";
  std::ofstream(folder_ / "a.gltf") << json;
  EXPECT_EQ(scan_size(folder_ / "a.gltf").bytes, json.size() + 12);
}

TEST_F(ScanSizeTest, OfWhatCannotBeReadNothingIsTold) {
  EXPECT_EQ(scan_size(folder_ / "none.ply").format, "");
  EXPECT_EQ(format("a.txt", "text"), "");
  EXPECT_EQ(format("b.ply.gz", "\x1f\x8b nonsense"), "");
  EXPECT_EQ(format("empty.ply", ""), "PLY binary");
}

}  // namespace
}  // namespace semigeo::jobs
