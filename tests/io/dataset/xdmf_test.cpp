#include "io/dataset/xdmf.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "io/files/error.hpp"
#include "tests/io/dataset/sample_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

std::string written_sidecar(const std::filesystem::path& path) {
  std::ifstream stream(sidecar_of(path));
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

// What stands between `before` and `after` in `text`, from `from` on.
std::string between(const std::string& text, std::size_t from, const std::string& before,
                    const std::string& after) {
  const std::size_t begin = text.find(before, from) + before.size();
  return text.substr(begin, text.find(after, begin) - begin);
}

TEST(Xdmf, EveryReferenceHasTheShapeAndTypeOfItsArray) {
  const tests::TemporaryFolder folder;
  tests::write_sample(folder / "s.vtkhdf", {.changing = true});
  const std::string text = written_sidecar(folder / "s.vtkhdf");
  const Hdf5File file = Hdf5File::open(folder / "s.vtkhdf");
  std::set<std::string> seen;
  for (std::size_t at = text.find("<DataItem "); at != std::string::npos;
       at = text.find("<DataItem ", at + 1)) {
    EXPECT_EQ(between(text, at, "Format=\"", "\""), "HDF");
    EXPECT_EQ(between(text, at, ">", ":"), "s.vtkhdf");
    const std::string path = between(text, at, ":", "<");
    const ArrayShape shape = file.open_array(path).shape();
    EXPECT_EQ(between(text, at, "NumberType=\"", "\""),
              shape.type == ElementType::kFloat32 ? "Float" : "Int")
        << path;
    EXPECT_EQ(between(text, at, "Precision=\"", "\""), std::to_string(size_of(shape.type)));
    std::string dimensions = std::to_string(shape.rows);
    if (shape.columns > 1) dimensions.append(" ").append(std::to_string(shape.columns));
    EXPECT_EQ(between(text, at, "Dimensions=\"", "\""), dimensions) << path;
    seen.insert(path);
  }
  EXPECT_EQ(seen.size(), 3U * 8U);
}

TEST(Xdmf, IsMadeAgainFromTheDatasetAlone) {
  const tests::TemporaryFolder folder;
  for (const bool changing : {false, true}) {
    tests::write_sample(folder / "s.vtkhdf", {.changing = changing});
    EXPECT_EQ(sidecar_text(folder / "s.vtkhdf"), written_sidecar(folder / "s.vtkhdf"));
  }
  std::filesystem::resize_file(folder / "s.vtkhdf", 1000);
  EXPECT_THROW(sidecar_text(folder / "s.vtkhdf"), Error);
}

TEST(Xdmf, OneGridPerLevelInATemporalCollection) {
  const std::vector<VtkhdfStep> steps = {{0.1, "/levels/000", 4, 2, true},
                                         {1.5, "/levels/001", 4, 2, false}};
  const std::string text = xdmf_text("s.vtkhdf", steps);
  EXPECT_EQ(count(text, "CollectionType=\"Temporal\""), 1U);
  EXPECT_EQ(count(text, "GridType=\"Uniform\""), 2U);
  EXPECT_EQ(count(text, "<Time Value=\"0.1\"/>"), 1U);
  EXPECT_EQ(count(text, "<Time Value=\"1.5\"/>"), 1U);
  EXPECT_EQ(count(text, "TopologyType=\"Triangle\" NumberOfElements=\"2\""), 2U);
  EXPECT_EQ(count(text, "GeometryType=\"XYZ\""), 2U);
  EXPECT_EQ(count(text, "Center=\"Node\""), 12U);
  EXPECT_EQ(count(text, "HyperSlab"), 0U);
  EXPECT_EQ(count(text, "<Grid "), count(text, "</Grid>"));
  EXPECT_EQ(count(text, "<DataItem "), count(text, "</DataItem>"));
}

TEST(Xdmf, NamesAreEscaped) {
  const std::vector<VtkhdfStep> steps = {{0, "/levels/000", 3, 1, true}};
  const std::string text = xdmf_text("a&b<c>\"d\".vtkhdf", steps);
  EXPECT_EQ(count(text, "a&amp;b&lt;c&gt;&quot;d&quot;.vtkhdf:/levels/000/points"), 1U);
  EXPECT_EQ(count(text, "a&b"), 0U);
}

}  // namespace
}  // namespace semigeo::io
