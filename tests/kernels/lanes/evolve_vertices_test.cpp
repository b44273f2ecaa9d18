#include "kernels/lanes/evolve_vertices.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "kernels/lanes/patch_block.hpp"
#include "tests/support/prepared_surface.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/solids.hpp"

namespace semigeo::kernels {
namespace {

/// A disc, or a cone, of `valence` triangles around a hub.
TriangleMesh fan(int valence, float height) {
  TriangleMesh mesh;
  mesh.points.emplace_back(0, 0, height);
  for (int i = 0; i < valence; ++i) {
    const double angle = 2 * std::numbers::pi * i / valence;
    mesh.points.emplace_back(std::cos(angle), std::sin(angle), 0);
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % valence});
  }
  return mesh;
}

/// Tetrahedra that do not touch: fewer vertices in a part than a patch has samples.
TriangleMesh tetrahedra(int count) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const float x = 4.0f * static_cast<float>(i);
    const std::int32_t first = 4 * i;
    mesh.points.insert(mesh.points.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}, {x, 0, 1}});
    for (const std::array<std::int32_t, 3> t :
         {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{1, 2, 3}, std::array{0, 3, 2}})
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

/// A torus with one vertex pulled far out, so that its fan is a spike.
TriangleMesh spike() {
  TriangleMesh mesh = shapes::torus(1, 0.4, 40, 16);
  mesh.points[17] *= 3;
  return mesh;
}

/// A torus of which some vertices were pushed through the other side.
TriangleMesh folded() {
  TriangleMesh mesh = shapes::torus(1, 0.4, 40, 16);
  for (std::size_t i = 5; i < mesh.points.size(); i += 37) mesh.points[i] *= 0.55f;
  return mesh;
}

/// Slivers: the torus flattened until faces have almost no height.
TriangleMesh slivers() {
  TriangleMesh mesh = shapes::torus(1, 0.4, 40, 16);
  for (auto& p : mesh.points) p.x() *= 1e-6f;
  return mesh;
}

/// A torus with an edge of length zero at many vertices.
TriangleMesh zero_edges() {
  TriangleMesh mesh = shapes::torus(1, 0.4, 40, 16);
  for (std::size_t i = 0; i + 16 < mesh.points.size(); i += 23)
    mesh.points[i] = mesh.points[i + 16];
  return mesh;
}

TriangleMesh noisy(TriangleMesh mesh, double sigma) {
  shapes::add_noise(mesh, sigma, 7);
  return mesh;
}

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

std::vector<NamedMesh> meshes() {
  std::vector<NamedMesh> all;
  all.push_back({"icosphere", shapes::icosphere(4)});
  all.push_back({"even torus", shapes::torus(1, 0.4, 60, 24)});
  all.push_back({"uneven noisy torus", noisy(shapes::torus(1, 0.4, 60, 24, 0.8), 0.004)});
  all.push_back({"hemisphere", shapes::hemisphere(4)});
  all.push_back({"short cylinder", shapes::cylinder(1, 0.25, 60, 4)});
  all.push_back({"noisy saddle", noisy(shapes::saddle(2, 20), 0.01)});
  all.push_back({"cube", shapes::cube(1, 6)});
  all.push_back({"spike", spike()});
  all.push_back({"folded torus", folded()});
  all.push_back({"slivers", slivers()});
  all.push_back({"edges of length zero", zero_edges()});
  all.push_back({"fan of 65", fan(65, 0)});
  all.push_back({"cone of 200", fan(200, 2)});
  all.push_back({"fan beyond the limit", fan(kMaxFan + 1, 0.1f)});
  all.push_back({"tetrahedra", tetrahedra(5)});
  all.push_back({"one triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}});
  return all;
}

/// All that a vertex has, as the numbers themselves, so that NaN and signed zeros count as well.
std::array<float, 20> numbers_of(const EvolvedVertex& e) {
  std::array<float, 20> all{};
  Eigen::Map<Eigen::VectorXf>(all.data(), all.size()) << e.position, e.smoothed_normal, e.normal,
      e.gaussian_curvature, e.mean_curvature, e.patch_completeness, e.principal.k1, e.principal.k2,
      e.principal.first, e.principal.second;
  return all;
}

class EvolveVerticesTest : public testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override {
    if (!supported(GetParam())) GTEST_SKIP() << "this CPU has no " << name_of(GetParam());
  }

  /// Compares all vertices of a surface with the scalar kernel.
  static void expect_same(const SampledSurface& surface, std::vector<std::int32_t> first,
                          const PatchLayout& layout, const std::string& what) {
    std::vector<EvolvedVertex> results(first.size());
    if (!results.empty())
      std::memset(static_cast<void*>(results.data()), 0xee, results.size() * sizeof(EvolvedVertex));
    evolve_vertices(surface, first, layout, GetParam(), results);
    int differences = 0;
    for (std::size_t i = 0; i < first.size() && differences < 3; ++i) {
      PatchLayout own = layout;
      own.first = first[i];
      const auto expected = numbers_of(evolve_vertex(surface, surface.mesh.origin(first[i]), own));
      const auto actual = numbers_of(results[i]);
      if (std::memcmp(&expected, &actual, sizeof expected) == 0) continue;
      ++differences;
      for (std::size_t k = 0; k < expected.size(); ++k)
        EXPECT_EQ(std::bit_cast<std::uint32_t>(expected[k]),
                  std::bit_cast<std::uint32_t>(actual[k]))
            << what << ", vertex " << i << ", number " << k << ": " << expected[k] << " and "
            << actual[k];
    }
  }

  static std::vector<std::int32_t> first_edges(const SampledSurface& surface) {
    std::vector<std::int32_t> first(surface.mesh.points.size());
    for (std::size_t v = 0; v < first.size(); ++v)
      first[v] = first_edge(surface.mesh, static_cast<std::int32_t>(v));
    return first;
  }
};

TEST_P(EvolveVerticesTest, EveryLayoutOfEveryMeshHasTheBytesOfTheScalarKernel) {
  for (NamedMesh& named : meshes())
    for (const bool curved : {true, false}) {
      const PreparedSurface s(named.mesh, curved);
      const auto mean = static_cast<float>(mean_edge_length(s.surface));
      for (const Coordinates coordinates : {Coordinates::kSemigeodesic, Coordinates::kPolar})
        for (const float factor : {0.3f, 1.0f, 2.5f})
          expect_same(s.sampled(), first_edges(s.sampled()),
                      {.step = factor * mean, .coordinates = coordinates, .principal = true},
                      named.name + (curved ? ", curved" : ", flat") +
                          (coordinates == Coordinates::kPolar ? ", polar" : ", semigeodesic") +
                          ", step " + std::to_string(factor));
    }
}

TEST_P(EvolveVerticesTest, HardlyAnyVertexOfAScanIsLeftToTheScalarKernel) {
  const TriangleMesh smooth = shapes::torus(1, 0.4, 80, 32);
  for (const TriangleMesh& mesh : {smooth, noisy(smooth, 0.01), shapes::plane(2, 40)}) {
    PreparedSurface s(mesh);
    const auto step = static_cast<float>(mean_edge_length(s.surface));
    s.sharpen_normals(step);
    const std::vector<std::int32_t> first = first_edges(s.sampled());
    std::vector<EvolvedVertex> results(first.size());
    const auto left = evolve_vertices(s.sampled(), first, {.step = step}, GetParam(), results);
    if (GetParam() == InstructionSet::kScalar)
      EXPECT_EQ(left, std::ssize(first));
    else
      EXPECT_LE(left, std::ssize(first) / 500);
  }
}

TEST_P(EvolveVerticesTest, AnyFirstEdgeAndAnyOrderOfVertices) {
  PreparedSurface s(noisy(shapes::torus(1, 0.4, 40, 16, 0.5), 0.01));
  const auto step = static_cast<float>(mean_edge_length(s.surface));
  s.sharpen_normals(step);
  std::vector<std::int32_t> first;  // every half-edge, far ones beside each other
  for (std::int32_t f = 0; f < s.surface.face_count(); ++f)
    for (int k = 0; k < 3; ++k)
      first.push_back(halfedge((f * 7) % static_cast<std::int32_t>(s.surface.face_count()), k));
  expect_same(s.sampled(), first, {.step = step}, "every half-edge");
}

TEST_P(EvolveVerticesTest, AnyNumberOfVertices) {
  const PreparedSurface s(shapes::hemisphere(3));
  const auto step = static_cast<float>(mean_edge_length(s.surface));
  const std::vector<std::int32_t> all = first_edges(s.sampled());
  for (const std::size_t count : {0, 1, 3, 4, 5, 15, 16, 17, 63, 64, 65, 127, 128, 130})
    expect_same(s.sampled(), {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)},
                {.step = step}, std::to_string(count) + " vertices");
}

TEST_P(EvolveVerticesTest, LinesEndAtTheLimitOfCrossings) {
  const PreparedSurface s(shapes::torus(1, 0.4, 60, 24, 0.5));
  const auto step = 2 * static_cast<float>(mean_edge_length(s.surface));
  for (const int limit : {0, 1, 2, 7, 30, lanes::kMostCrossings, lanes::kMostCrossings + 1}) {
    SampledSurface surface = s.sampled();
    surface.mesh.max_crossings = limit;
    expect_same(surface, first_edges(surface), {.step = step}, std::to_string(limit));
  }
}

std::string name_of_case(const testing::TestParamInfo<InstructionSet>& info) {
  return std::string(name_of(info.param));
}

INSTANTIATE_TEST_SUITE_P(All, EvolveVerticesTest, testing::ValuesIn(kInstructionSets),
                         name_of_case);

}  // namespace
}  // namespace semigeo::kernels
