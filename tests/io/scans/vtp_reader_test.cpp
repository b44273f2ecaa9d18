#include "tests/io/scans/vtk_files.hpp"

namespace semigeo::io {
namespace {

using VtpReader = ScanFileTest;
using Eigen::Vector3d;

const Triangles kThree = {{0, 1, 2}, {0, 1, 3}, {3, 1, 2}};

std::string changed(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from << " is not in " << text;
  return text.replace(at, from.size(), to);
}

std::string ascii_file() {
  VtpWriter writer;
  return writer.file(writer.piece());
}

TEST_F(VtpReader, ReadsArraysInEveryEncoding) {
  for (const std::string format : {"ascii", "binary", "appended"})
    for (const std::string encoding : {"raw", "base64"})
      for (const std::endian order : {std::endian::little, std::endian::big})
        for (const bool wide_header : {false, true})
          for (const bool compressed : {false, true}) {
            VtpWriter writer{format, encoding, order, wide_header, compressed};
            SCOPED_TRACE(format + " " + encoding + (order == std::endian::big ? " big" : "") +
                         (wide_header ? " wide" : "") + (compressed ? " zlib" : ""));
            const std::string piece = writer.piece();
            const Scan scan = read("a.vtp", writer.file(piece));
            EXPECT_EQ(scan.format, "VTK XML");
            ASSERT_EQ(scan.mesh.points.size(), 4u);
            EXPECT_EQ(point(scan, 3), Vector3d(0, 1, 0));
            EXPECT_EQ(scan.mesh.triangles, kThree);
            EXPECT_EQ(scan.faces_skipped, 1) << "the line";
            EXPECT_EQ(scan.bytes_after_end, 0);
          }
}

TEST_F(VtpReader, ReadsEveryTypeOfNumbers) {
  const auto last = [&](const std::string& type, const auto& numbers) {
    VtpWriter writer{.format = "binary"};
    const std::string points = writer.array("p", type, numbers, 3);
    writer.format = "ascii";
    return point(read("a.vtp", writer.file("<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\">"
                                           "<Points>" +
                                           points + "</Points><Polys>" +
                                           writer.array("offsets", "UInt8", std::vector<int>{3}) +
                                           writer.array("connectivity", "UInt64",
                                                        std::vector<int>{0, 1, 2}) +
                                           "</Polys></Piece>")),
                 2);
  };
  EXPECT_EQ(last("Float64", std::vector<double>{0, 0, 0, 1, 0, 0, 0.1, 1e-300, -3}),
            Vector3d(0.1, 1e-300, -3));
  EXPECT_EQ(last("Int8", std::vector<std::int8_t>{0, 0, 0, 1, 0, 0, -1, 2, 3}), Vector3d(-1, 2, 3));
  EXPECT_EQ(last("UInt8", std::vector<std::uint8_t>{0, 0, 0, 1, 0, 0, 255, 2, 3}),
            Vector3d(255, 2, 3));
  EXPECT_EQ(last("Int16", std::vector<std::int16_t>{0, 0, 0, 1, 0, 0, -300, 2, 3}),
            Vector3d(-300, 2, 3));
  EXPECT_EQ(last("UInt16", std::vector<std::uint16_t>{0, 0, 0, 1, 0, 0, 65535, 2, 3}),
            Vector3d(65535, 2, 3));
  EXPECT_EQ(last("Int32", std::vector<std::int32_t>{0, 0, 0, 1, 0, 0, -70000, 2, 3}),
            Vector3d(-70000, 2, 3));
  EXPECT_EQ(last("UInt32", std::vector<std::uint32_t>{0, 0, 0, 1, 0, 0, 4'000'000'000u, 2, 3}),
            Vector3d(4e9, 2, 3));
  EXPECT_EQ(last("Int64", std::vector<std::int64_t>{0, 0, 0, 1, 0, 0, -5'000'000'000, 2, 3}),
            Vector3d(-5e9, 2, 3));
}

TEST_F(VtpReader, ReadsNormals) {
  const auto normals = [&](const std::string& data, const std::string& name, int components) {
    VtpWriter writer{.format = "binary", .compressed = true};
    const std::string piece = writer.piece();
    std::vector<float> values = {0, 0, 1, 0, 0, 2, 0, 3, 0, 0, 0, 1};
    return read("a.vtp",
                writer.file(piece +
                            changed(piece, "<Points>",
                                    data + writer.array(name, "Float32", values, components) +
                                        "</PointData><Points>")))
        .mesh.normals;
  };
  const auto found = normals("<PointData Normals=\"mine\">", "mine", 3);
  ASSERT_EQ(found.size(), 8u);
  EXPECT_EQ(found[1], Eigen::Vector3f::Zero()) << "the first piece has none";
  EXPECT_EQ(found[5], Eigen::Vector3f(0, 0, 2));
  EXPECT_EQ(normals("<PointData>", "Normals", 3).size(), 8u);
  EXPECT_TRUE(normals("<PointData>", "others", 3).empty());
  EXPECT_TRUE(normals("<PointData>", "Normals", 4).empty());
}

TEST_F(VtpReader, DamagedNormalsCountAsNone) {
  const Scan scan =
      read("a.vtp", changed(ascii_file(), "<Points>",
                            "<PointData><DataArray type=\"Float32\" Name=\"Normals\" "
                            "NumberOfComponents=\"3\" format=\"ascii\">1 2</DataArray>"
                            "</PointData><Points>"));
  EXPECT_EQ(scan.mesh.triangles, kThree);
  EXPECT_TRUE(scan.mesh.normals.empty());
}

TEST_F(VtpReader, ReadsAllPieces) {
  VtpWriter writer{.format = "appended"};
  const std::string pieces = writer.piece() + writer.piece();
  const Scan scan = read("a.vtp.gz", gzip(writer.file(pieces)));
  EXPECT_EQ(scan.mesh.points.size(), 8u);
  ASSERT_EQ(scan.mesh.triangles.size(), 6u);
  EXPECT_EQ(scan.mesh.triangles[5], (std::array{7, 5, 6}));
}

TEST_F(VtpReader, RefusesOtherFiles) {
  expect_parts(error("a.vtp", changed(ascii_file(), "type=\"PolyData\"", "type=\"ImageData\"")),
               {"byte 23", "type 'ImageData' is not a surface", "Extract Surface"});
  VtpWriter writer{.compressed = true};
  const std::string zlib = writer.file(writer.piece());
  for (const std::string name : {"vtkLZ4DataCompressor", "vtkLZMADataCompressor"})
    expect_parts(error("a.vtp", changed(zlib, "vtkZLibDataCompressor", name)),
                 {"compressed by '" + name + "'", "save it with ZLib"});
  expect_parts(error("a.vtp", changed(ascii_file(), "LittleEndian", "x")), {"byte_order"});
  expect_parts(error("a.vtp", changed(ascii_file(), "UInt32", "Int9")), {"header_type"});
  expect_parts(error("a.vtp", "<x/>"), {"no element VTKFile"});
  expect_parts(error("a.vtp", "<?xml version=\"1.0\"?>\n<X3D/>"), {"an XML document"});
  expect_parts(error("a.vtp", "<VTKFile type=\"PolyData\"><PolyData></VTKFile>"),
               {"byte 37", "XML of the file is damaged"});
  expect_parts(error("a.vtp", "<VTKFile type=\"PolyData\"/>"), {"holds no vertices"});
  expect_parts(error("a.ply", ascii_file()), {"a VTK XML file", "correct its extension to .vtp"});
}

TEST_F(VtpReader, RefusesArraysThatDoNotFit) {
  const std::string good = ascii_file();
  expect_parts(error("a.vtp", changed(good, "NumberOfPoints=\"4\"", "NumberOfPoints=\"5\"")),
               {"byte ", "'Points' holds 12 numbers, not the 15"});
  expect_parts(error("a.vtp", changed(good, "NumberOfPolys=\"1\"", "NumberOfPolys=\"2\"")),
               {"'offsets' holds 1 numbers, not the 2"});
  expect_parts(error("a.vtp", changed(good, "NumberOfPolys=\"1\"", "NumberOfPolys=\"-1\"")),
               {"NumberOfPolys is negative"});
  expect_parts(error("a.vtp", changed(good, "0 1 2 \n", "0 1 4 \n")),
               {"refers to point 4 of 4 in its piece"});
  expect_parts(error("a.vtp", changed(good, "0 1 2 \n", "0 x 2 \n")),
               {"'connectivity' has something that is not a number behind 1 numbers"});
  expect_parts(error("a.vtp", changed(good, "\n3 \n", "\n4 \n")),
               {"'connectivity' holds 3 numbers, not the 4"});
  expect_parts(error("a.vtp", changed(good, "\n3 \n", "\n-3 \n")), {"offsets of the cells"});
  expect_parts(error("a.vtp", changed(good, "Name=\"offsets\"", "Name=\"x\"")),
               {"its Polys have no array 'offsets'"});
  expect_parts(error("a.vtp", changed(good, "Float32", "String")),
               {"'Points' has a type that is not one of numbers"});
  expect_parts(error("a.vtp", changed(good, "Int64", "Float32")), {"whole numbers"});
  expect_parts(error("a.vtp", changed(good, "\"ascii\"", "\"x\"")), {"format 'x'"});
  expect_parts(error("a.vtp", changed(good, "Components=\"3\"", "Components=\"2\"")),
               {"three coordinates"});
  expect_parts(error("a.vtp", changed(good, "<Points>", "<P>").replace(0, 0, "")), {"damaged"});
}

TEST_F(VtpReader, RefusesDamagedBinaryArrays) {
  VtpWriter writer{.format = "appended", .compressed = true};
  const std::string piece = writer.piece();
  const std::string good = writer.file(piece);
  const std::size_t data = good.find('_', good.find("<AppendedData")) + 1;
  std::string bad = good;
  bad[data + 40] = static_cast<char>(bad[data + 40] ^ 0x55);
  expect_parts(error("a.vtp", bad), {"'Points' is damaged or ends early"});
  bad = good;
  bad.replace(data, 4, bytes_of(0x7fffffff));  // number of blocks
  expect_parts(error("a.vtp", bad), {"'Points' is damaged"});
  bad = good;
  bad.replace(data + 4, 4, bytes_of(0x7fffffff));  // size of a block
  expect_parts(error("a.vtp", bad), {"'Points' is damaged"});
  expect_parts(error("a.vtp", good.substr(0, data + 20)), {"'Points' is damaged or ends early"});
  expect_parts(error("a.vtp", changed(good, "offset=\"0\"", "offset=\"99999\"")),
               {"'Points' begins behind the end"});
  VtpWriter plain{.format = "binary"};
  const std::string plain_piece = plain.piece();
  expect_parts(error("a.vtp", changed(plain.file(plain_piece), "MAAAAA", "MA*AAA")),
               {"'Points' is damaged or ends early"});
}

TEST_F(VtpReader, ElementsMayBeNestedDeeply) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  for (int i = 0; i < 100'000; ++i) deep += "</a>";
  EXPECT_EQ(read("a.vtp", changed(ascii_file(), "<PolyData>", deep + "<PolyData>")).mesh.triangles,
            kThree);
}

}  // namespace
}  // namespace semigeo::io
