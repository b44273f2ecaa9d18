#include <cerrno>
#include <utility>

#include "io/files/byte_source.hpp"
#include "io/files/read_error.hpp"
#include "io/scans/scan_formats.hpp"
#include "tests/io/scans/vtk_files.hpp"

namespace semigeo::io {
namespace {

/// A file on a disk that fails once, behind some bytes.
class FailingStream final : public ByteStream {
 public:
  explicit FailingStream(std::string bytes) : bytes_(std::move(bytes)) {}
  const std::filesystem::path& path() const override { return path_; }
  std::int64_t position() const override { return static_cast<std::int64_t>(at_); }
  std::size_t read(std::span<char> bytes) override {
    if (at_ == bytes_.size() && !std::exchange(failed_, true))
      throw ReadError(EIO, path_, "", "cannot be read");
    const std::size_t got = bytes_.copy(bytes.data(), bytes.size(), at_);
    at_ += got;
    return got;
  }

 private:
  std::filesystem::path path_ = "a.vtk";
  std::string bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

using VtkReader = ScanFileTest;
using Eigen::Vector3d;

const Triangles kTwo = {{0, 1, 2}, {0, 2, 3}};

/// Returns the beginning of a file, with the four points of the square.
VtkText points(bool binary, const std::string& version = "4.2",
               const std::string& dataset = "POLYDATA") {
  VtkText file(binary, version);
  file.line("DATASET " + dataset).line("POINTS 4 float").numbers(kSquare);
  return file;
}

/// Returns an unstructured grid of one cell.
std::string one_cell(int type, const std::vector<int>& corners) {
  const std::string size = std::to_string(corners.size());
  VtkText file = points(false, "3.0", "UNSTRUCTURED_GRID");
  file.line("CELLS 1 " + std::to_string(corners.size() + 1)).line(size).numbers(corners);
  return file.line("CELL_TYPES 1").line(std::to_string(type)).text;
}

TEST_F(VtkReader, ReadsPolygons) {
  for (const bool binary : {false, true}) {
    VtkText file = points(binary);
    file.line("POLYGONS 2 8").numbers(std::vector<int>{3, 0, 1, 2, 3, 0, 2, 3});
    file.line("POINT_DATA 4").line("SCALARS a float").line("what follows is not read");
    const Scan scan = read("a.vtk", file.text);
    EXPECT_EQ(scan.format, binary ? "VTK binary" : "VTK ascii");
    ASSERT_EQ(scan.mesh.points.size(), 4u);
    EXPECT_EQ(point(scan, 2), Vector3d(1, 1, 0));
    EXPECT_EQ(scan.mesh.triangles, kTwo);
    EXPECT_EQ(scan.bytes_after_end, 0);
  }
}

TEST_F(VtkReader, ReadsTheLayoutOfVersion5) {
  for (const bool binary : {false, true}) {
    VtkText file = points(binary, "5.1");
    file.line("METADATA").line("INFORMATION 1").line("NAME a LOCATION b").line("DATA 0").line("");
    file.line("POLYGONS 3 6").line("OFFSETS vtktypeint64");
    file.numbers(std::vector<std::int64_t>{0, 3, 6}).line("CONNECTIVITY vtktypeint64");
    file.numbers(std::vector<std::int64_t>{0, 1, 2, 0, 2, 3});
    EXPECT_EQ(read("a.vtk", file.text).mesh.triangles, kTwo);
  }
}

TEST_F(VtkReader, ReadsStripsAndPassesOverLines) {
  for (const bool binary : {false, true}) {
    VtkText file = points(binary);
    file.line("VERTICES 1 2").numbers(std::vector<int>{1, 0});
    file.line("LINES 1 5").numbers(std::vector<int>{4, 0, 1, 2, 3});
    file.line("TRIANGLE_STRIPS 1 5").numbers(std::vector<int>{4, 0, 1, 3, 2});
    const Scan scan = read("a.vtk.gz", gzip(file.text));
    EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 3}, {3, 1, 2}}));
    EXPECT_EQ(scan.faces_skipped, 2);
  }
}

TEST_F(VtkReader, ReadsEveryTypeOfPoints) {
  const auto expect = [&](const std::string& type, auto number) {
    using Number = decltype(number);
    for (const bool binary : {false, true}) {
      VtkText file(binary);
      file.line("dataset polydata").line("points 3 " + type);
      file.numbers(std::vector<Number>{0, 0, 0, 1, 0, 0, 0, number, 1});
      file.line("polygons 1 4").numbers(std::vector<int>{3, 0, 1, 2});
      EXPECT_EQ(point(read("a.vtk", file.text), 2), Vector3d(0, static_cast<double>(number), 1))
          << type;
    }
  };
  expect("float", 7.f);
  expect("double", 7.0);
  expect("char", std::int8_t{-7});
  expect("unsigned_char", std::uint8_t{200});
  expect("short", std::int16_t{-300});
  expect("unsigned_short", std::uint16_t{65'000});
  expect("int", std::int32_t{-70'000});
  expect("unsigned_int", std::uint32_t{4'000'000'000u});
  expect("long", std::int64_t{-5'000'000'000});
  expect("vtkIdType", std::int32_t{7});
}

TEST_F(VtkReader, ReadsSurfaceCellsOfUnstructuredGrids) {
  const auto triangles = [&](int type, const std::vector<int>& corners) {
    return read("a.vtk", one_cell(type, corners)).mesh.triangles;
  };
  EXPECT_EQ(triangles(5, {0, 1, 2}), (Triangles{{0, 1, 2}}));
  EXPECT_EQ(triangles(6, {0, 1, 3, 2}), (Triangles{{0, 1, 3}, {3, 1, 2}}));
  EXPECT_EQ(triangles(7, {0, 1, 2}), (Triangles{{0, 1, 2}}));
  EXPECT_EQ(triangles(9, {0, 1, 2, 3}), triangles(8, {0, 1, 3, 2}));
  EXPECT_EQ(triangles(9, {0, 1, 2, 3}).size(), 2u);
  expect_parts(error("a.vtk", one_cell(3, {0, 1})), {"none of its 1 faces has three corners"});
  expect_parts(error("a.vtk", one_cell(10, {0, 1, 2, 3})),
               {"face 0", "of type 10", "Extract Surface"});
  expect_parts(error("a.vtk", one_cell(5, {0, 1, 2, 3})), {"face 0", "4 corners, not 3"});
  VtkText binary = points(true, "5.1", "UNSTRUCTURED_GRID");
  binary.line("CELLS 3 7").line("OFFSETS vtktypeint64");
  binary.numbers(std::vector<std::int64_t>{0, 3, 7}).line("CONNECTIVITY vtktypeint64");
  binary.numbers(std::vector<std::int64_t>{0, 1, 2, 0, 1, 2, 3});
  binary.line("CELL_TYPES 2").numbers(std::vector<int>{5, 9});
  EXPECT_EQ(read("a.vtk", binary.text).mesh.triangles.size(), 3u);
}

TEST_F(VtkReader, PassesOverFields) {
  for (const bool binary : {false, true}) {
    VtkText file(binary);
    file.line("DATASET POLYDATA").line("FIELD FieldData 2").line("time 1 1 double");
    file.numbers(std::vector<double>{2.5}).line("b 2 3 int");
    file.numbers(std::vector<int>{1, 2, 3, 4, 5, 6});
    if (!binary) file.line("FIELD x 1").line("names 1 2 string").line("POINTS 3").line("b c");
    file.line("POINTS 4 float").numbers(kSquare);
    file.line("POLYGONS 1 5").numbers(std::vector<int>{4, 0, 1, 2, 3});
    EXPECT_EQ(read("a.vtk", file.text).polygons_triangulated, 1);
  }
  VtkText file(true);
  file.line("DATASET POLYDATA").line("FIELD x 1").line("names 1 2 string");
  expect_parts(error("a.vtk", file.text), {"type of numbers 'string'"});
}

TEST_F(VtkReader, ReadsNormalsBehindOtherData) {
  for (const bool binary : {false, true}) {
    VtkText file = points(binary);
    file.line("POLYGONS 1 5").numbers(std::vector<int>{4, 0, 1, 2, 3});
    file.line("CELL_DATA 1").line("NORMALS of_cells float").numbers(std::vector<float>{7, 7, 7});
    file.line("POINT_DATA 4").line("SCALARS a short 2").line("LOOKUP_TABLE t");
    file.numbers(std::vector<std::int16_t>(8, 5)).line("LOOKUP_TABLE t 2");
    file.numbers(std::vector<std::uint8_t>(8, 9)).line("SCALARS b double").line("LOOKUP_TABLE t");
    file.numbers(std::vector<double>(4, 1)).line("COLOR_SCALARS c 3");
    file.numbers(std::vector<std::uint8_t>(12, 9)).line("VECTORS v double");
    file.numbers(std::vector<double>(12, 2)).line("TENSORS t float");
    file.numbers(std::vector<float>(36, 2)).line("TEXTURE_COORDINATES uv 2 float");
    file.numbers(std::vector<float>(8, 2)).line("GLOBAL_IDS ids vtkIdType");
    file.numbers(std::vector<std::int32_t>(4, 2)).line("FIELD f 1").line("x 1 4 float");
    file.numbers(std::vector<float>(4, 2)).line("METADATA").line("INFORMATION 0").line("");
    file.line("NORMALS n double").numbers(std::vector<double>{0, 0, 1, 0, 0, 2, 0, 3, 0, 0, 0, 1});
    const Scan scan = read("a.vtk", file.text);
    ASSERT_EQ(scan.mesh.normals.size(), 4u) << binary;
    EXPECT_EQ(scan.mesh.normals[1], Eigen::Vector3f(0, 0, 2));
    EXPECT_EQ(scan.mesh.normals[2], Eigen::Vector3f(0, 3, 0));
    EXPECT_EQ(scan.bytes_after_end, 0);
  }
}

TEST_F(VtkReader, BehindDataThatCannotBeReadThereAreNoNormals) {
  const std::vector<std::string> starts = {
      "POINT_DATA 4\nHYPER h float\n",
      "POINT_DATA 4\nSCALARS a bit\nLOOKUP_TABLE t\n",
      "POINT_DATA 4\nSCALARS a float\n",
      "POINT_DATA x\n",
      "POINT_DATA 4\nVECTORS v float\n1 2",
      "POINT_DATA 1000000000000000\nCOLOR_SCALARS c 1000000000000000\n"};
  for (const bool binary : {false, true})
    for (const std::string& start : starts) {
      VtkText file = points(binary);
      file.line("POLYGONS 1 5").numbers(std::vector<int>{4, 0, 1, 2, 3}).text += start;
      file.line("NORMALS n float").numbers(std::vector<float>(12, 1));
      const Scan scan = read("a.vtk", file.text);
      EXPECT_EQ(scan.mesh.triangles.size(), 2u) << start;
      EXPECT_TRUE(scan.mesh.normals.empty()) << start;
    }
}

TEST_F(VtkReader, AFailureOfTheDiskIsNoReasonToLeaveOutNormals) {
  VtkText file = points(false);
  file.line("POLYGONS 1 5").numbers(std::vector<int>{4, 0, 1, 2, 3}).line("POINT_DATA 900000");
  file.line("NORMALS n float").numbers(std::vector<float>(2'000'000, 1));
  ASSERT_GT(file.text.size(), 2 * std::size_t{ByteSource::kWindowBytes});
  FailingStream stream(file.text);
  ByteSource source(stream);
  EXPECT_THROW(kVtkFormat.read(source, {}), ReadError);
}

TEST_F(VtkReader, DamagedDataBehindTheFacesIsDamageOfTheFile) {
  VtkText file = points(false);
  file.line("POLYGONS 1 5").numbers(std::vector<int>{4, 0, 1, 2, 3}).line("POINT_DATA 40000");
  std::vector<float> numbers;
  for (int i = 0; i < 120'000; ++i) numbers.push_back(static_cast<float>(i * 7919 % 10007));
  const std::string whole = gzip(file.line("NORMALS n float").numbers(numbers).text);
  expect_parts(error("a.vtk.gz", whole.substr(0, whole.size() / 2)), {"gzip"});
}

TEST_F(VtkReader, RefusesOtherFiles) {
  expect_parts(error("a.vtk", "hello\n"), {"line 1", "# vtk DataFile Version"});
  expect_parts(error("a.vtk", "# vtk DataFile Version 2.0\n\nTEXT\n"),
               {"line 3", "neither ASCII nor BINARY"});
  expect_parts(error("a.vtk", points(false, "3.0", "STRUCTURED_GRID").text),
               {"line 4", "'structured_grid' is not a surface", "Extract Surface"});
  expect_parts(error("a.vtk", points(false).line("POLYHEDRA 1 2").text),
               {"line 7", "keyword of VTK: 'polyhedra'"});
  expect_parts(error("a.vtk", points(false).line("POINTS 1 float").text), {"second list"});
  expect_parts(error("a.vtk", VtkText(false).line("DATASET POLYDATA").line("POINTS 1 bit").text),
               {"line 5", "type of numbers 'bit'"});
  expect_parts(error("a.vtk", points(false).text), {"4 points but no faces"});
  expect_parts(error("a.obj", points(false).text), {"a VTK file", ".vtk"});
}

TEST_F(VtkReader, RefusesCellsThatDoNotFit) {
  const auto message = [&](const std::string& counts, const std::vector<int>& numbers) {
    return error("a.vtk", points(false).line("POLYGONS " + counts).numbers(numbers).text);
  };
  expect_parts(message("1 4", {3, 0, 1, 4}), {"refers to vertex 4", "only 4 vertices"});
  expect_parts(message("1 4", {3, 0, 1, -1}), {"refers to vertex -1"});
  expect_parts(message("1 4", {4, 0, 1, 2}), {"line 7", "counts of the cells do not fit"});
  expect_parts(message("2 4", {3, 0, 1, 2}), {"line 7", "counts of the cells do not fit"});
  expect_parts(message("1 4", {-3, 0, 1, 2}), {"line 8", "out of range"});
  expect_parts(message("1 5", {3, 0, 1, 2}), {"promises 5 numbers of cells", "ends after 4"});
  expect_parts(message("-1 5", {3, 0, 1, 2}), {"line 7", "number of cells is negative"});
  VtkText offsets = points(false, "5.1");
  offsets.line("POLYGONS 2 3").line("OFFSETS vtktypeint64").line("0 4");
  offsets.line("CONNECTIVITY vtktypeint64").line("0 1 2");
  expect_parts(error("a.vtk", offsets.text), {"offsets of the cells do not fit"});
  VtkText alone = points(false, "5.1");
  alone.line("POLYGONS 2 3").line("OFFSETS vtktypeint64").line("0 3").line("X");
  expect_parts(error("a.vtk", alone.text), {"no CONNECTIVITY"});
  expect_parts(error("a.vtk", points(true, "5.1").line("POLYGONS 1 4").line("x").text),
               {"no OFFSETS"});
  VtkText types = points(false, "3.0", "UNSTRUCTURED_GRID");
  expect_parts(error("a.vtk", types.line("CELLS 1 4").line("3 0 1 2").text),
               {"1 cells, but 0 types"});
}

TEST_F(VtkReader, RefusesCutFiles) {
  VtkText text(true);
  text.line("DATASET POLYDATA").line("POINTS 4 float").text += std::string(20, '\1');
  expect_parts(error("a.vtk", text.text), {"byte ", "promises 12 coordinates", "ends after 5"});
  VtkText ascii(false);
  ascii.line("DATASET POLYDATA").line("POINTS 4 float").line("0 0 0").line("1 0");
  expect_parts(error("a.vtk", ascii.text), {"line ", "promises 12 coordinates", "ends after 5"});
  ascii.line("x");
  expect_parts(error("a.vtk", ascii.text), {"line 8", "found 'x'"});
}

}  // namespace
}  // namespace semigeo::io
