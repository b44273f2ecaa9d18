#include "io/dataset/vtkhdf.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>

#include "io/files/error.hpp"
#include "io/hdf5/hdf5_library.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

constexpr std::int64_t kVertices[] = {4, 5, 6};
constexpr std::int64_t kTriangles[] = {2, 3, 4};

template <typename Value>
EncodedArray constant(std::int64_t rows, int columns, float value) {
  const std::vector<Value> values(static_cast<std::size_t>(rows * columns),
                                  static_cast<Value>(value));
  ArrayView view = array_of(values);
  view.columns = columns;
  view.rows /= columns;
  view.row_stride *= columns;
  return encode_array(view, Compression::kDeflate);
}

// Three levels with the arrays that /VTKHDF shows, and their steps.
std::vector<VtkhdfStep> write_levels(DigestedFile& file, bool changing) {
  std::vector<VtkhdfStep> steps;
  file.create_group("/levels");
  for (int k = 0; k < 3; ++k) {
    const std::int64_t n = kVertices[changing ? k : 0];
    const std::int64_t f = kTriangles[changing ? k : 0];
    const std::string level = "/levels/00" + std::to_string(k);
    const auto value = static_cast<float>(k + 1);
    file.create_group(level);
    for (const char* name : {"/points", "/normals"})
      file.write_array(level + name, constant<float>(n, 3, value));
    for (const char* name : {"/gaussian_curvature", "/mean_curvature", "/patch_completeness"})
      file.write_array(level + name, constant<float>(n, 1, value));
    file.write_array(level + "/triangles", constant<std::int64_t>(f, 3, value));
    file.write_array(level + "/part", constant<std::int32_t>(n, 1, value));
    file.write_array(level + "/source_vertex", constant<std::int64_t>(n, 1, value));
    steps.push_back({0.5 * k, level, n, f, k == 0 || changing});
  }
  return steps;
}

using Mutation = std::function<void(VtkhdfLayout&)>;

// The error of check_vtkhdf for the layout after the mutation; "" if there is none.
std::string error_of(bool changing, const Mutation& mutate) {
  const tests::TemporaryFolder folder;
  {
    DigestedFile file(Hdf5File::create(folder / "a.h5"));
    VtkhdfLayout layout = vtkhdf_layout(write_levels(file, changing));
    mutate(layout);
    write_vtkhdf(file, layout, Compression::kDeflate);
    file.file().close();
  }
  try {
    check_vtkhdf(Hdf5File::open(folder / "a.h5"));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Vtkhdf, WhatWeWriteConforms) {
  EXPECT_EQ(error_of(false, [](VtkhdfLayout&) {}), "");
  EXPECT_EQ(error_of(true, [](VtkhdfLayout&) {}), "");
}

TEST(Vtkhdf, MustExist) {
  const tests::TemporaryFolder folder;
  Hdf5File::create(folder / "a.h5").close();
  EXPECT_THROW(check_vtkhdf(Hdf5File::open(folder / "a.h5")), Error);
}

TEST(Vtkhdf, SameConnectivityMovesOnlyThePoints) {
  const tests::TemporaryFolder folder;
  DigestedFile file(Hdf5File::create(folder / "a.h5"));
  const VtkhdfLayout layout = vtkhdf_layout(write_levels(file, false));
  using Numbers = std::vector<std::int64_t>;
  EXPECT_EQ(layout.tables.at("Steps/PartOffsets").values, (Numbers{0, 0, 0}));
  EXPECT_EQ(layout.tables.at("Steps/PointOffsets").values, (Numbers{0, 4, 8}));
  EXPECT_EQ(layout.tables.at("Steps/PointDataOffsets/Normals").values, (Numbers{0, 4, 8}));
  EXPECT_EQ(layout.tables.at("Steps/CellOffsets").values, Numbers(12, 0));
  EXPECT_EQ(layout.tables.at("NumberOfPoints").values, (Numbers{4}));
  EXPECT_EQ(layout.tables.at("Lines/Offsets").values, (Numbers{0}));
  EXPECT_EQ(layout.views.at("Polygons/Connectivity").pieces.size(), 1U);
  EXPECT_EQ(layout.views.at("Points").pieces.size(), 3U);
}

TEST(Vtkhdf, ChangingConnectivityHasAPartForEachStep) {
  const tests::TemporaryFolder folder;
  DigestedFile file(Hdf5File::create(folder / "a.h5"));
  const VtkhdfLayout layout = vtkhdf_layout(write_levels(file, true));
  using Numbers = std::vector<std::int64_t>;
  EXPECT_EQ(layout.tables.at("Steps/PartOffsets").values, (Numbers{0, 1, 2}));
  EXPECT_EQ(layout.tables.at("Steps/PointOffsets").values, (Numbers{0, 4, 9}));
  EXPECT_EQ(layout.tables.at("Steps/CellOffsets").values,
            (Numbers{0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 5, 0}));
  EXPECT_EQ(layout.tables.at("Steps/ConnectivityIdOffsets").values,
            (Numbers{0, 0, 0, 0, 0, 0, 6, 0, 0, 0, 15, 0}));
  EXPECT_EQ(layout.tables.at("NumberOfPoints").values, (Numbers{4, 5, 6}));
  EXPECT_EQ(layout.tables.at("Lines/Offsets").values, (Numbers{0, 0, 0}));
  write_vtkhdf(file, layout, Compression::kNone);
  file.file().close();
  const std::vector<std::byte> offsets =
      Hdf5File::open(folder / "a.h5").read_through_library("/VTKHDF/Polygons/Offsets");
  const Numbers wanted = {0, 3, 6, 0, 3, 6, 9, 0, 3, 6, 9, 12};
  const auto bytes = std::as_bytes(std::span(wanted));
  EXPECT_EQ(offsets, std::vector<std::byte>(bytes.begin(), bytes.end()));
}

struct Rule {
  std::string place;    // named by the error, under /VTKHDF
  std::string problem;  // part of its text
  Mutation breaks;
  bool changing = false;
};

void PrintTo(const Rule& rule, std::ostream* out) {
  *out << rule.place << ": " << rule.problem;
}

Mutation value(const std::string& table, std::size_t at, std::int64_t number) {
  return [=](VtkhdfLayout& layout) { layout.tables.at(table).values.at(at) = number; };
}

Mutation without(const std::string& table) {
  return [=](VtkhdfLayout& layout) { layout.tables.erase(table); };
}

Mutation view(const std::string& name, const std::function<void(VtkhdfLayout::View&)>& change) {
  return [=](VtkhdfLayout& layout) { change(layout.views.at(name)); };
}

std::vector<Rule> rules() {
  const auto longer = [](const std::string& table) {
    return [=](VtkhdfLayout& layout) { layout.tables.at(table).values.push_back(0); };
  };
  return {
      {"", "Type must be ascii[8]", [](auto& l) { l.type = "PolyData1"; }},
      {"", "Type must be ascii[8], not utf8[8]", [](auto& l) { l.type = "PolyDät"; }},
      {"", "Type must be PolyData", [](auto& l) { l.type = "PolyDate"; }},
      {"", "Version must be 2, 0",
       [](auto& l) {
         l.version = {2, 1};
       }},
      {"", "Version must be int64[2]",
       [](auto& l) {
         l.version = {2, 0, 0};
       }},
      {"/Steps", "NSteps must be at least 1", [](auto& l) { l.steps = 0; }},
      {"/Steps/Values", "one value per step", [](auto& l) { l.steps = 4; }},
      {"/Steps/Values", "strictly increasing", [](auto& l) { l.values[2] = l.values[1]; }},
      {"/Steps/Values", "strictly increasing",
       [](auto& l) { l.values[0] = std::numeric_limits<double>::quiet_NaN(); }},
      {"/Steps/NumberOfParts", "must be 1", value("Steps/NumberOfParts", 1, 2)},
      {"/Steps/NumberOfParts", "must be 1", longer("Steps/NumberOfParts")},
      {"/NumberOfPoints", "one entry", longer("NumberOfPoints")},
      {"/NumberOfPoints", "no count can have", value("NumberOfPoints", 0, -4)},
      {"/Steps/PartOffsets", "must be 0", value("Steps/PartOffsets", 1, 1)},
      {"/Steps/PartOffsets", "must count", value("Steps/PartOffsets", 2, 1), true},
      {"/Steps/PointOffsets", "must be the sums", value("Steps/PointOffsets", 2, 7)},
      {"/Steps/PointOffsets", "must be the sums", value("Steps/PointOffsets", 1, 5), true},
      {"/Steps/PointOffsets", "is missing", without("Steps/PointOffsets")},
      {"/Steps/PointDataOffsets/Normals", "must be the sums",
       value("Steps/PointDataOffsets/Normals", 1, 0)},
      {"/Steps/PointDataOffsets/part", "is missing", without("Steps/PointDataOffsets/part")},
      {"/Steps/CellOffsets", "Polygons must be", value("Steps/CellOffsets", 6, 2)},
      {"/Steps/CellOffsets", "Polygons must be", value("Steps/CellOffsets", 6, 0), true},
      {"/Steps/CellOffsets", "Strips must be", value("Steps/CellOffsets", 7, 1)},
      {"/Steps/CellOffsets", "1 columns instead of 4",
       [](auto& l) { l.tables.at("Steps/CellOffsets").columns = 1; }},
      {"/Steps/ConnectivityIdOffsets", "Polygons must be",
       value("Steps/ConnectivityIdOffsets", 6, 3), true},
      {"/Steps/ConnectivityIdOffsets", "Vertices must be",
       value("Steps/ConnectivityIdOffsets", 4, 1)},
      {"/Polygons/NumberOfCells", "one entry for each part", longer("Polygons/NumberOfCells")},
      {"/Polygons/NumberOfConnectivityIds", "three for each cell",
       value("Polygons/NumberOfConnectivityIds", 0, 7)},
      {"/Polygons/Offsets", "one more than cells", [](auto& l) { l.triangles_of_part[0] = 3; }},
      {"/Polygons/Offsets", "from 0 again",
       [](auto& l) { std::swap(l.triangles_of_part[0], l.triangles_of_part[1]); }, true},
      {"/Vertices/NumberOfCells", "one 0 for each part", value("Vertices/NumberOfCells", 0, 1)},
      {"/Lines/Offsets", "one 0 for each part", longer("Lines/Offsets")},
      {"/Strips/Offsets", "one 0 for each part",
       [](auto& l) { l.tables.at("Strips/Offsets").values.resize(1); }, true},
      {"/Strips/NumberOfConnectivityIds", "is missing", without("Strips/NumberOfConnectivityIds")},
      {"/Lines/Connectivity", "must be empty", longer("Lines/Connectivity")},
      {"/Points", "offsets add up to", view("Points", [](auto& v) { v.pieces.pop_back(); })},
      {"/Points", "wrong type", view("Points", [](auto& v) { v.type = ElementType::kInt32; })},
      {"/PointData/part", "another type or size",
       view("PointData/part", [](auto& v) { v.pieces[1].source = "/levels/001/mean_curvature"; })},
      {"/Points", "is missing", [](auto& l) { l.views.erase("Points"); }},
      {"/PointData/part", "offsets add up to",
       view("PointData/part", [](auto& v) { v.pieces.pop_back(); })},
      {"/PointData/a.b", "must not have a '.'",
       [](auto& l) { l.views["PointData/a.b"] = l.views.at("PointData/part"); }},
      {"/Polygons/Connectivity", "offsets add up to",
       view("Polygons/Connectivity", [](auto& v) { v.pieces.push_back(v.pieces[0]); })},
      {"/Polygons/Connectivity", "must be virtual",
       [](auto& l) {
         l.views.erase("Polygons/Connectivity");
         l.tables["Polygons/Connectivity"] = {1, std::vector<std::int64_t>(6, 0)};
       }},
  };
}

class VtkhdfRule : public ::testing::TestWithParam<Rule> {};

TEST_P(VtkhdfRule, BrokenIsNamed) {
  const Rule& rule = GetParam();
  const std::string message = error_of(rule.changing, rule.breaks);
  EXPECT_NE(message.find(": /VTKHDF" + rule.place + ": "), std::string::npos) << message;
  EXPECT_NE(message.find(rule.problem), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(Each, VtkhdfRule, ::testing::ValuesIn(rules()));

TEST(Vtkhdf, SourcesMustExist) {
  // Writing already refuses a source that does not exist: rename one afterwards.
  const tests::TemporaryFolder folder;
  DigestedFile file(Hdf5File::create(folder / "a.h5"));
  write_vtkhdf(file, vtkhdf_layout(write_levels(file, false)), Compression::kNone);
  file.file().close();
  {
    const Hdf5Handle open(H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    ASSERT_GE(H5Lmove(open.get(), "/levels/001/points", H5L_SAME_LOC, "/levels/001/pointz",
                      H5P_DEFAULT, H5P_DEFAULT),
              0);
  }
  try {
    check_vtkhdf(Hdf5File::open(folder / "a.h5"));
    FAIL() << "a virtual dataset without its source was accepted";
  } catch (const Error& error) {
    EXPECT_NE(error.problem().find("shows /levels/001/points, which does not exist"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace semigeo::io
