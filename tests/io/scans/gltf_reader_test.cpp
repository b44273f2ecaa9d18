#include "tests/io/scans/gltf_files.hpp"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <Eigen/Geometry>

#include "io/files/byte_source.hpp"
#include "io/files/read_error.hpp"
#include "io/scans/scan_formats.hpp"

namespace semigeo::io {
namespace {

using GltfReader = ScanFileTest;
using Eigen::Vector3d;

const Triangles kTwo = {{0, 1, 2}, {0, 2, 3}};

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from << " is not in " << text;
  return text.replace(at, from.size(), to);
}

/// Returns a file of the square whose JSON was changed.
std::string changed(std::string_view from, std::string_view to) {
  return replaced(square_parts().gltf(), from, to);
}

TEST_F(GltfReader, ReadsJsonAndBinary) {
  for (const bool binary : {false, true}) {
    const GltfParts parts = square_parts();
    const Scan scan = binary ? read("a.glb", parts.glb()) : read("a.gltf", parts.gltf());
    EXPECT_EQ(scan.format, binary ? "glTF binary" : "glTF");
    ASSERT_EQ(scan.mesh.points.size(), 4u);
    EXPECT_EQ(point(scan, 2), Vector3d(1, 1, 0));
    EXPECT_EQ(scan.mesh.triangles, kTwo);
    EXPECT_EQ(scan.bytes_after_end, 0);
  }
  EXPECT_EQ(read("a.glb.gz", gzip(square_parts().glb())).format, "glTF binary, gzip");
  EXPECT_EQ(read("a.gltf", square_parts().glb()).mesh.triangles, kTwo);
  EXPECT_EQ(read("a.gltf", "\xef\xbb\xbf" + square_parts().gltf()).mesh.triangles, kTwo);
  EXPECT_EQ(read("a.glb", square_parts().glb() + "abc").bytes_after_end, 3);
}

TEST_F(GltfReader, ReadsEveryTypeOfIndices) {
  const auto expect = [&](int type, const auto& indices) {
    GltfParts parts;
    const int positions = parts.add_numbers(5126, "VEC3", kSquare);
    parts.add_primitive(positions, parts.add_numbers(type, "SCALAR", indices));
    EXPECT_EQ(read("a.glb", parts.glb()).mesh.triangles, kTwo) << type;
  };
  expect(5121, std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3});
  expect(5123, std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3});
  expect(5125, std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
}

TEST_F(GltfReader, ReadsEveryMode) {
  const auto triangles = [&](int mode, bool indexed) {
    GltfParts parts;
    std::vector<float> xyz = kSquare;
    xyz.insert(xyz.end(), {2, 0, 0, 2, 1, 0});
    const int positions = parts.add_numbers(5126, "VEC3", xyz);
    const std::vector<std::uint8_t> order = {5, 4, 3, 2, 1, 0};
    parts.add_primitive(positions, indexed ? parts.add_numbers(5121, "SCALAR", order) : -1, mode);
    return read("a.glb", parts.glb()).mesh.triangles;
  };
  EXPECT_EQ(triangles(4, false), (Triangles{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(triangles(-1, true), (Triangles{{5, 4, 3}, {2, 1, 0}}));
  EXPECT_EQ(triangles(5, false), (Triangles{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}}));
  EXPECT_EQ(triangles(5, true), (Triangles{{5, 4, 3}, {3, 4, 2}, {3, 2, 1}, {1, 2, 0}}));
  EXPECT_EQ(triangles(6, false), (Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}, {4, 5, 0}}));
}

TEST_F(GltfReader, TheLargestIndexBeginsANewStripOrFan) {
  const auto triangles = [&](int mode, const std::vector<std::uint8_t>& indices) {
    GltfParts parts;
    std::vector<float> xyz = kSquare;
    xyz.insert(xyz.end(), {2, 0, 0, 2, 1, 0});
    const int positions = parts.add_numbers(5126, "VEC3", xyz);
    parts.add_primitive(positions, parts.add_numbers(5121, "SCALAR", indices), mode);
    return read("a.glb", parts.glb()).mesh.triangles;
  };
  EXPECT_EQ(triangles(5, {0, 1, 2, 255, 1, 2, 3, 4}), (Triangles{{0, 1, 2}, {1, 2, 3}, {3, 2, 4}}));
  EXPECT_EQ(triangles(5, {0, 1, 2, 2, 3, 3, 4, 5}), (Triangles{{0, 1, 2}, {4, 3, 5}}))
      << "repeated corners make no triangle";
  EXPECT_EQ(triangles(6, {0, 1, 2, 3, 255, 3, 4, 5}), (Triangles{{1, 2, 0}, {2, 3, 0}, {4, 5, 3}}));
  GltfParts lists;
  const int positions = lists.add_numbers(5126, "VEC3", kSquare);
  lists.add_primitive(positions,
                      lists.add_numbers(5121, "SCALAR", std::vector<std::uint8_t>{0, 1, 255}));
  expect_parts(error("a.glb", lists.glb()), {"vertex 255 of 4"});
}

TEST_F(GltfReader, ReadsNormals) {
  const auto normals = [&](const std::string& node, const std::vector<float>& given) {
    GltfParts parts;
    const int positions = parts.add_numbers(5126, "VEC3", kSquare);
    const int accessor = parts.add_numbers(5126, "VEC3", given);
    parts.add_primitive(positions, -1, 6);
    parts.primitives.insert(parts.primitives.find('{', 1) + 1,
                            R"("NORMAL":)" + std::to_string(accessor) + ",");
    parts.nodes = R"({"mesh":0)" + node + "}";
    return read("a.glb", parts.glb()).mesh.normals;
  };
  const std::vector<float> up = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 3, 4};
  const auto plain = normals("", up);
  ASSERT_EQ(plain.size(), 4u);
  EXPECT_EQ(plain[0], Eigen::Vector3f(0, 0, 1));
  EXPECT_TRUE(plain[3].isApprox(Eigen::Vector3f(0, .6F, .8F)));
  EXPECT_EQ(normals(R"(,"scale":[1,1,-2])", up)[0], Eigen::Vector3f(0, 0, -1)) << "mirrored";
  EXPECT_TRUE(
      normals(R"(,"scale":[1,2,1])", up)[3].isApprox(Eigen::Vector3f(0, 1.5F, 4).normalized()))
      << "they stay perpendicular to what is stretched";
  EXPECT_EQ(normals("", {0, 0, 1})[1], Eigen::Vector3f::Zero()) << "there is one only";
  EXPECT_TRUE(normals(R"(,"scale":[1,1,0])", up).empty()) << "nothing is left of their direction";
}

TEST_F(GltfReader, DamagedNormalsCountAsNone) {
  const Scan scan = read("a.gltf", changed(R"("POSITION":0)", R"("POSITION":0,"NORMAL":7)"));
  EXPECT_EQ(scan.mesh.triangles, kTwo);
  EXPECT_TRUE(scan.mesh.normals.empty());
}

TEST_F(GltfReader, NormalsThatCannotBeReadAreAFailure) {
  GltfParts parts = square_parts();
  parts.primitives.insert(parts.primitives.find('{', 1) + 1, R"("NORMAL":2,)");
  parts.accessors += R"(,{"componentType":5126,"count":4,"type":"VEC3","bufferView":2})";
  parts.views += R"(,{"buffer":1,"byteLength":48})";
  const std::string other = R"("},{"byteLength":48,"uri":"n.bin"}]})";
  const std::string json = replaced(parts.gltf(), R"("}]})", other);
  const auto file = write_file(folder_ / "a.gltf", json);
  const auto normals = [&] {
    ByteSource source(file);
    return kGltfFormat.read(source, {}).mesh.normals.size();
  };
  EXPECT_EQ(normals(), 0u) << "the file is absent";
  std::filesystem::create_symlink(folder_ / "n.bin", folder_ / "n.bin");
  EXPECT_THROW(normals(), ReadError);
}

TEST_F(GltfReader, PassesOverPointsAndLines) {
  for (const auto& [mode, parts_skipped] : {std::pair{0, 4}, {1, 2}, {2, 4}, {3, 3}}) {
    GltfParts parts = square_parts();
    parts.add_primitive(0, -1, mode);
    const Scan scan = read("a.glb", parts.glb());
    EXPECT_EQ(scan.mesh.triangles, kTwo);
    EXPECT_EQ(scan.mesh.points.size(), 4u) << "vertices of one accessor are shared";
    EXPECT_EQ(scan.faces_skipped, parts_skipped) << mode;
  }
  GltfParts points;
  points.add_primitive(points.add_numbers(5126, "VEC3", kSquare), -1, 0);
  expect_parts(error("a.glb", points.glb()), {"4 points but none of its 4 faces"});
}

TEST_F(GltfReader, ReadsQuantisedPositions) {
  const auto last = [&](int type, const auto& numbers, const std::string& members) {
    GltfParts parts;
    parts.more = R"("extensionsRequired":["KHR_mesh_quantization"],)";
    parts.add_primitive(parts.add_numbers(type, "VEC3", numbers, members));
    return point(read("a.glb", parts.glb()), 2);
  };
  const std::string normalized = R"(,"normalized":true)";
  const std::vector<std::int8_t> bytes = {0, 0, 0, 9, 0, 0, 127, -128, -127};
  const std::vector<std::uint8_t> unsigned_bytes = {0, 0, 0, 9, 0, 0, 255, 51, 0};
  const std::vector<std::int16_t> shorts = {0, 0, 0, 9, 0, 0, 32767, -32768, -32767};
  const std::vector<std::uint16_t> unsigned_shorts = {0, 0, 0, 9, 0, 0, 65535, 13107, 0};
  EXPECT_EQ(last(5120, bytes, ""), Vector3d(127, -128, -127));
  EXPECT_EQ(last(5120, bytes, normalized), Vector3d(1, -1, -1));
  EXPECT_EQ(last(5121, unsigned_bytes, ""), Vector3d(255, 51, 0));
  EXPECT_EQ(last(5121, unsigned_bytes, normalized), Vector3d(1, 0.2, 0));
  EXPECT_EQ(last(5122, shorts, ""), Vector3d(32767, -32768, -32767));
  EXPECT_EQ(last(5122, shorts, normalized), Vector3d(1, -1, -1));
  EXPECT_EQ(last(5123, unsigned_shorts, ""), Vector3d(65535, 13107, 0));
  EXPECT_EQ(last(5123, unsigned_shorts, normalized), Vector3d(1, 0.2, 0));
}

TEST_F(GltfReader, ReadsInterleavedElements) {
  GltfParts parts;
  std::vector<float> values;
  for (int i = 0; i < 3; ++i)
    values.insert(values.end(), {9, static_cast<float>(i), static_cast<float>(i * i), 7, 9});
  const int view = parts.add_view(bytes_of_all(values), R"(,"byteStride":20)");
  parts.add_primitive(parts.add_accessor(
      5126, 3, "VEC3", R"(,"byteOffset":4,"bufferView":)" + std::to_string(view)));
  EXPECT_EQ(point(read("a.glb", parts.glb()), 2), Vector3d(2, 4, 7));
}

std::string sparse(GltfParts& parts, const std::vector<std::uint8_t>& places) {
  const int indices = parts.add_view(bytes_of_all(places));
  const int values = parts.add_view(bytes_of_all(std::vector<float>{5, 6, 7, 8, 9, 10}));
  return R"(,"sparse":{"count":2,"indices":{"componentType":5121,"bufferView":)" +
         std::to_string(indices) + R"(},"values":{"bufferView":)" + std::to_string(values) + "}}";
}

TEST_F(GltfReader, ReadsSparseAccessors) {
  GltfParts parts;
  const std::string elements = sparse(parts, {1, 3});
  parts.add_primitive(parts.add_numbers(5126, "VEC3", kSquare, elements), -1, 5);
  const Scan scan = read("a.glb", parts.glb());
  EXPECT_EQ(point(scan, 1), Vector3d(5, 6, 7));
  EXPECT_EQ(point(scan, 2), Vector3d(1, 1, 0));
  EXPECT_EQ(point(scan, 3), Vector3d(8, 9, 10));

  GltfParts zeros;
  const std::string on_zeros = sparse(zeros, {0, 2});
  zeros.add_primitive(zeros.add_accessor(5126, 3, "VEC3", on_zeros));
  EXPECT_EQ(point(read("a.glb", zeros.glb()), 1), Vector3d(0, 0, 0));
  EXPECT_EQ(point(read("a.glb", zeros.glb()), 2), Vector3d(8, 9, 10));

  GltfParts bad;
  const std::string beyond = sparse(bad, {0, 4});
  bad.add_primitive(bad.add_numbers(5126, "VEC3", kSquare, beyond));
  expect_parts(error("a.glb", bad.glb()), {"accessors[0].sparse.indices", "element 4 of 4"});
  GltfParts huge;
  huge.add_primitive(huge.add_accessor(5126, 2'000'000'000, "VEC3", sparse(huge, {0, 2})));
  expect_parts(error("a.glb", huge.glb()),
               {"accessors[0]", "more elements than the file has bytes"});
}

TEST_F(GltfReader, AppliesTransformations) {
  const auto corner = [&](const std::string& nodes) {
    GltfParts parts = square_parts();
    parts.nodes = nodes;
    return point(read("a.glb", parts.glb()), 1);  // (1, 0, 0)
  };
  EXPECT_EQ(corner(R"({"mesh":0,"translation":[1,2,3]})"), Vector3d(2, 2, 3));
  EXPECT_EQ(corner(R"({"mesh":0,"scale":[2,1,1],"translation":[1,2,3]})"), Vector3d(3, 2, 3));
  // A quarter turn about z, after the scale and before the translation.
  const std::string turn = R"("rotation":[0,0,0.70710678118654752,0.70710678118654752])";
  EXPECT_TRUE(corner(R"({"mesh":0,"scale":[2,1,1],"translation":[1,2,3],)" + turn + "}")
                  .isApprox(Vector3d(1, 4, 3)));
  EXPECT_EQ(corner(R"({"mesh":0,"matrix":[0,2,0,0, 1,0,0,0, 0,0,1,0, 5,6,7,1]})"),
            Vector3d(5, 8, 7));
  EXPECT_TRUE(corner(R"({"children":[1],"translation":[0,0,9]},{"children":[2],)" + turn +
                     R"(},{"mesh":0,"scale":[3,3,3]})")
                  .isApprox(Vector3d(0, 3, 9)));
}

TEST_F(GltfReader, MirroredTrianglesAreTurned) {
  GltfParts parts = square_parts();
  parts.nodes = R"({"mesh":0,"scale":[-1,1,1],"children":[1]},{"mesh":0,"scale":[1,1,-1]})";
  const Scan scan = read("a.glb", parts.glb());
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}}));
}

TEST_F(GltfReader, ReadsMeshesAsOftenAsTheyAreInstanced) {
  GltfParts parts = square_parts();
  parts.nodes =
      R"({"children":[1,2]},{"mesh":0},{"mesh":0,"translation":[5,0,0]},{"mesh":0,"scale":[9,9,9]})";
  const Scan scan = read("a.glb", parts.glb());
  ASSERT_EQ(scan.mesh.points.size(), 8u) << "the fourth node is not in the scene";
  EXPECT_EQ(point(scan, 5), Vector3d(6, 0, 0));
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}));
}

TEST_F(GltfReader, ChoosesTheScene) {
  const auto points = [&](const std::string& scenes) {
    GltfParts parts = square_parts();
    parts.nodes = R"({"mesh":0},{"mesh":0,"children":[2]},{"mesh":0})";
    parts.scenes = scenes;
    return read("a.glb", parts.glb()).mesh.points.size() / 4;
  };
  const std::string both = R"("scenes":[{"nodes":[0]},{"nodes":[0,1]}],)";
  EXPECT_EQ(points(R"("scene":0,)" + both), 1u);
  EXPECT_EQ(points(R"("scene":1,)" + both), 3u);
  EXPECT_EQ(points(both), 3u) << "without a default scene, all scenes are read";
  EXPECT_EQ(points(""), 3u) << "without scenes, all nodes are read";
  GltfParts meshes = square_parts();
  meshes.nodes = meshes.scenes = "";
  EXPECT_EQ(read("a.glb", meshes.glb()).mesh.points.size(), 4u);
}

TEST_F(GltfReader, RefusesNodesThatAreNoTree) {
  const auto message = [&](const std::string& nodes, const std::string& scenes) {
    GltfParts parts = square_parts();
    parts.nodes = nodes;
    parts.scenes = scenes;
    return error("a.glb", parts.glb());
  };
  const std::string scene = R"("scenes":[{"nodes":[0]}],)";
  expect_parts(message(R"({"children":[1]},{"children":[0]})", scene), {"nodes[0]", "form a tree"});
  expect_parts(message(R"({"children":[1]},{"children":[0]})", ""), {"form a cycle"});
  expect_parts(message(R"({"children":[1,1]},{"mesh":0})", scene), {"nodes[1]", "form a tree"});
  expect_parts(message(R"({"children":[7]})", scene), {"nodes[7]", "there are only 1"});
  expect_parts(message(R"({"children":[-1]})", scene), {"nodes[0]", "children[0]"});
  expect_parts(message(R"({"mesh":1})", scene), {"meshes[1]", "there are only 1"});
  expect_parts(message(R"({"mesh":0,"matrix":[1,2]})", scene), {"nodes[0]", "16 numbers"});
  expect_parts(message(R"({"mesh":0,"rotation":[0,0,0,0]})", scene), {"nodes[0]", "quaternion"});
  expect_parts(message(R"({"mesh":0,"matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]})", scene),
               {"nodes[0]", "affine"});
}

TEST_F(GltfReader, NodesMayBeNestedDeeply) {
  GltfParts parts = square_parts();
  constexpr int kDepth = 20'000;
  parts.nodes = "";
  for (int i = 0; i < kDepth; ++i)
    parts.nodes += R"({"translation":[0,0,1],"children":[)" + std::to_string(i + 1) + "]},";
  parts.nodes += R"({"mesh":0})";
  EXPECT_EQ(point(read("a.glb", parts.glb()), 1), Vector3d(1, 0, kDepth));
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  EXPECT_EQ(read("a.gltf", changed(R"("asset":{)", R"("extras":)" + deep + R"(,"asset":{)"))
                .mesh.triangles,
            kTwo);
}

TEST_F(GltfReader, RefusesWhatReachesBeyondItsBuffer) {
  expect_parts(error("a.gltf", changed(R"("count":4)", R"("count":5)")),
               {"a.gltf: accessors[0]: its 5 elements reach beyond"});
  expect_parts(error("a.gltf", changed(R"("count":6)", R"("count":9000000000000)")),
               {"accessors[1]", "9000000000000 elements"});
  expect_parts(error("a.gltf", changed(R"("byteOffset":48)", R"("byteOffset":58)")),
               {"bufferViews[1]", "beyond the end of its buffer"});
  expect_parts(error("a.gltf", changed(R"("byteLength":60)", R"("byteLength":61)")),
               {"buffers[0]", "promises 61 bytes, but has only 60"});
  expect_parts(error("a.gltf", changed(R"("bufferView":0)", R"("bufferView":3)")),
               {"bufferViews[3]", "only 2"});
  expect_parts(error("a.gltf", changed(R"("buffer":0)", R"("buffer":1)")), {"buffers[1]"});
  expect_parts(error("a.gltf", changed(R"("byteLength":48)", R"("byteStride":8,"byteLength":48)")),
               {"bufferViews[0]", "byteStride"});
  expect_parts(error("a.gltf", changed(R"("count":4)", R"("count":-4)")),
               {"accessors[0]", "'count' is not a whole number"});
  expect_parts(error("a.gltf", changed(R"("count":4,)", "")), {"accessors[0]", "no 'count'"});
  GltfParts index;
  const int positions = index.add_numbers(5126, "VEC3", kSquare);
  index.add_primitive(positions,
                      index.add_numbers(5121, "SCALAR", std::vector<std::uint8_t>{0, 1, 4}));
  expect_parts(error("a.glb", index.glb()), {"meshes[0].primitives[0]", "refers to vertex 4 of 4"});
}

TEST_F(GltfReader, RefusesOtherTypes) {
  expect_parts(error("a.gltf", changed("VEC3", "VEC2")), {"accessors[0]", "positions"});
  expect_parts(error("a.gltf", changed("5126", "5125")), {"accessors[0]", "positions"});
  expect_parts(error("a.gltf", changed("SCALAR", "VEC2")), {"accessors[1]", "indices"});
  expect_parts(error("a.gltf", changed("5123", "5122")), {"accessors[1]", "indices"});
  expect_parts(error("a.gltf", changed(R"("indices":1)", R"("mode":7,"indices":1)")),
               {"meshes[0].primitives[0]", "mode 7"});
  expect_parts(error("a.gltf", changed(R"([{"primitives")", R"([0,{"primitives")")),
               {"meshes[0]", "no object"});
  expect_parts(error("a.gltf", changed(R"("nodes":[{)", R"("nodes":7,"x":[{)")),
               {"'nodes' is not an array"});
}

/// Returns a pyramid over a square, with normals, compressed by Draco.
std::string draco_pyramid(int method) {
  const std::vector<std::array<float, 3>> points = {
      {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 2}};
  const Triangles triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(triangles.size()));
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  const std::array<float, 3> up = {0, 0, 1};
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const draco::FaceIndex face(static_cast<std::uint32_t>(f));
    const auto& [a, b, c] = triangles[f];
    builder.SetAttributeValuesForFace(position, face, &points[a], &points[b], &points[c]);
    builder.SetAttributeValuesForFace(normal, face, &up, &up, &up);
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.size()};
}

/// Returns a file of a primitive that is compressed by Draco.
std::string draco_glb(const std::string& bytes, const std::string& ids) {
  GltfParts parts;
  parts.more = R"("extensionsRequired":["KHR_draco_mesh_compression"],)";
  parts.nodes = R"({"mesh":0,"scale":[1,1,-1]})";
  const int view = parts.add_view(bytes);
  const int positions = parts.add_accessor(5126, 18, "VEC3", "");
  parts.add_primitive(positions, parts.add_accessor(5125, 18, "SCALAR", ""), -1,
                      R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":)" +
                          std::to_string(view) + R"(,"attributes":)" + ids + "}}");
  return parts.glb();
}

double volume_of(const Scan& scan) {
  double volume = 0;
  for (const auto& [a, b, c] : scan.mesh.triangles)
    volume += point(scan, a).dot(point(scan, b).cross(point(scan, c))) / 6;
  return volume;
}

TEST_F(GltfReader, ReadsDraco) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const Scan scan =
        read("a.glb", draco_glb(draco_pyramid(method), R"({"POSITION":0,"NORMAL":1})"));
    EXPECT_EQ(scan.mesh.triangles.size(), 6u);
    EXPECT_NEAR(volume_of(scan), 8.0 / 3, 1e-3) << "mirrored, and facing outwards";
    ASSERT_EQ(scan.mesh.normals.size(), scan.mesh.points.size());
    EXPECT_LT((scan.mesh.normals[0] + Eigen::Vector3f::UnitZ()).norm(), .02);
  }
}

TEST_F(GltfReader, WhatIsThereWithoutDracoIsReadWithoutIt) {
  GltfParts parts;
  const int positions = parts.add_numbers(5126, "VEC3", kSquare);
  parts.add_primitive(positions, -1, 6,
                      R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0}})");
  EXPECT_EQ(read("a.glb", parts.glb()).mesh.triangles.size(), 2u);
}

TEST_F(GltfReader, DamagedDracoIsAnError) {
  const std::string ids = R"({"POSITION":0})";
  const std::string whole = draco_pyramid(draco::MESH_EDGEBREAKER_ENCODING);
  expect_parts(error("a.glb", draco_glb("DRACO", ids)),
               {"meshes[0].primitives[0].extensions.KHR_draco", "Draco data is damaged"});
  expect_parts(error("a.glb", draco_glb(whole, R"({"POSITION":7})")), {"it has no positions"});
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const std::string bytes = draco_pyramid(method);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      for (const int change : {1, 0xff}) {
        std::string damaged = bytes;
        damaged[i] = static_cast<char>(damaged[i] ^ change);
        try {
          read("a.glb", draco_glb(damaged, ids));
        } catch (const Error&) {
        }
      }
      expect_parts(error("b.glb", draco_glb(bytes.substr(0, i), ids)), {"b.glb"});
    }
  }
}

TEST_F(GltfReader, ReadsBuffersInFilesBesideIt) {
  const GltfParts parts = square_parts();
  std::filesystem::create_directories(folder_ / "part");
  write_file(folder_ / "part/a b.bin", parts.bytes + "more");
  const std::string json = parts.json(R"(,"uri":"./part/a%20b.bin")");
  EXPECT_EQ(read("a.gltf", json).mesh.triangles, kTwo);
  EXPECT_EQ(read("a.gltf.gz", gzip(json)).mesh.triangles, kTwo);
  EXPECT_EQ(read("a.glb", glb(json, "")).mesh.triangles, kTwo);
  write_file(folder_ / "part/a b.bin", parts.bytes.substr(1));
  expect_parts(error("a.gltf", json), {"buffers[0]", "promises 60 bytes, but has only 59"});
}

TEST_F(GltfReader, SparseElementsMayBeMoreThanTheBytesOfItsJson) {
  GltfParts parts;
  const int count = 9'000;
  const std::string members = sparse(parts, {1, 2});
  const std::string whole = parts.bytes + std::string(count, '\0');
  parts.bytes = whole;
  parts.add_primitive(parts.add_accessor(5126, count, "VEC3", members));
  write_file(folder_ / "a.bin", whole);
  EXPECT_EQ(read("a.gltf", parts.json(R"(,"uri":"a.bin")")).mesh.points.size(), count);
}

TEST_F(GltfReader, RefusesOtherFiles) {
  const GltfParts parts = square_parts();
  expect_parts(error("a.gltf", parts.json(R"(,"uri":"a b.bin")")),
               {"buffers[0]", "'a b.bin', and there is no such file", "beside the scan"});
  expect_parts(error("a.gltf", parts.json(R"(,"uri":"https://example.org/a.bin")")),
               {"buffers[0]", "on the network", ".glb"});
  expect_parts(error("a.gltf", parts.json(R"(,"uri":"../a.bin")")),
               {"buffers[0]", "outside of the folder", ".glb"});
  expect_parts(error("a.gltf", parts.json(R"(,"uri":"data:,abc")")), {"not in Base64"});
  expect_parts(error("a.gltf", parts.json(R"(,"uri":"data:;base64,A*")")), {"Base64", "damaged"});
  expect_parts(error("a.gltf", parts.json()), {"buffers[0]", "no bytes"});
}

TEST_F(GltfReader, RefusesExtensionsThatItLacks) {
  const auto message = [&](const std::string& extension) {
    GltfParts parts = square_parts();
    parts.more = R"("extensionsRequired":[")" + extension + "\"],";
    return error("a.glb", parts.glb());
  };
  expect_parts(message("EXT_meshopt_compression"),
               {"compressed by meshopt", "without compression"});
  expect_parts(message("EXT_x"), {"requires the extension 'EXT_x'"});
  expect_parts(error("a.gltf", changed(R"("byteLength":48)",
                                       R"("extensions":{"EXT_meshopt_compression":{}},
                                          "byteLength":48)")),
               {"bufferViews[0]", "meshopt"});
  GltfParts harmless = square_parts();
  harmless.more = R"("extensionsRequired":["KHR_materials_unlit","KHR_texture_transform"],)";
  EXPECT_EQ(read("a.glb", harmless.glb()).mesh.triangles, kTwo);
}

TEST_F(GltfReader, RefusesDamagedFiles) {
  expect_parts(error("a.gltf", square_parts().gltf() + "x"), {"byte ", "JSON", "damaged"});
  expect_parts(error("a.gltf", "hello"), {"byte 1", "damaged"});
  expect_parts(error("a.gltf", "{}"), {"no glTF file"});
  expect_parts(error("a.gltf", R"({"asset":{"version":"1.0"}})"), {"asset", "version 1.0"});
  expect_parts(error("a.gltf", R"({"asset":{}})"), {"asset", "the version of glTF is missing"});
  expect_parts(error("a.gltf", R"({"asset":{"version":"2.0"}})"), {"holds no vertices"});
  const std::string good = square_parts().glb();
  expect_parts(error("a.glb", good.substr(0, 8)), {"ends in its header"});
  expect_parts(error("a.glb", good.substr(0, good.size() - 1)), {"promises", "ends after"});
  std::string bad = good;
  bad.replace(4, 4, bytes_of(1));
  expect_parts(error("a.glb", bad), {"byte 4", "version 1"});
  bad = good;
  bad.replace(12, 4, bytes_of(0x7fffffff));
  expect_parts(error("a.glb", bad), {"byte 12", "chunk reaches beyond"});
  bad = good;
  bad.replace(16, 4, "NOSJ");
  expect_parts(error("a.glb", bad), {"byte 12", "not JSON"});
}

TEST_F(GltfReader, DropsFacesOfBadVertices) {
  GltfParts parts;
  std::vector<float> xyz = kSquare;
  xyz[10] = std::nanf("");
  parts.add_primitive(parts.add_numbers(5126, "VEC3", xyz), -1, 5);
  EXPECT_EQ(read("a.glb", parts.glb()).faces_of_bad_vertices, 1);
  xyz[1] = xyz[10] = std::nanf("");
  GltfParts none;
  none.add_primitive(none.add_numbers(5126, "VEC3", xyz), -1, 6);
  expect_parts(error("a.glb", none.glb()), {"vertex 0: the", "coordinate is not a finite number"});
}

}  // namespace
}  // namespace semigeo::io
