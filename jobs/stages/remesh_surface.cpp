#include "jobs/stages/remesh_surface.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace semigeo::jobs {
namespace {

constexpr std::int64_t kFaceBlock = 8192;
/// The sides and heights that refining makes exceed the shortest side by this factor, so that a
/// change of the mean edge length cannot make them odd.
constexpr double kMargin = 2;
/// Few edges are so many times as long as the mean edge, and they are usually enough to refine.
constexpr double kMuchLonger = 1.5;

/// Returns the faces or edges that `find` picks from ranges of faces, in the order of the faces.
template <typename Find>
std::vector<std::int32_t> find_all(const kernels::LevelMesh& mesh,
                                   const engine::RunContext& context, const Find& find) {
  const std::int64_t faces = mesh.connectivity.face_count();
  std::vector<std::vector<std::int32_t>> blocks((faces + kFaceBlock - 1) / kFaceBlock);
  const auto block_count = static_cast<std::int64_t>(blocks.size());
  context.workers.for_blocks(block_count, 1, [&](engine::IndexRange range) {
    for (auto b = range.begin; b < range.end; ++b)
      find(static_cast<std::int32_t>(b * kFaceBlock),
           static_cast<std::int32_t>(std::min((b + 1) * kFaceBlock, faces)), blocks[b]);
  });
  std::vector<std::int32_t> all;
  for (const auto& block : blocks) all.insert(all.end(), block.begin(), block.end());
  return all;
}

/// Returns at least one face of each part that is to be dropped.
std::vector<std::int32_t> faces_of_dropped(const kernels::LevelMesh& mesh,
                                           std::span<const std::uint8_t> dropped) {
  std::vector<std::int32_t> faces;
  if (std::ranges::find(dropped, 1) == dropped.end()) return faces;
  std::int32_t last = kernels::kNone;
  for (std::int32_t f = 0; f < mesh.connectivity.face_count(); ++f) {
    const std::int32_t part = mesh.part[mesh.connectivity.triangles[f][0]];
    if (part != last && dropped[part] != 0) faces.push_back(f);
    last = part;
  }
  return faces;
}

}  // namespace

RemeshResult remesh_surface(kernels::LevelMesh& mesh, std::vector<PartMeasure> parts,
                            const RemeshOptions& options, const engine::RunContext& context) {
  RemeshResult result;
  std::vector<std::int32_t> dropped = faces_of_dropped(mesh, options.dropped);
  bool refined = false;
  while (true) {
    const double reference = std::max(options.first_edge_length, mean_edge_length(parts));
    result.shortest_side = kShortestSide * reference;
    const auto find_odd = [&](std::int32_t begin, std::int32_t end, auto& faces) {
      kernels::find_odd_faces(mesh, begin, end, result.shortest_side, faces);
    };
    const auto odd = find_all(mesh, context, find_odd);
    if (odd.empty() && dropped.empty() &&
        (refined || mesh.connectivity.face_count() >= options.faces))
      break;
    kernels::Remesher remesher(mesh, options.curved);
    for (const std::int32_t face : std::exchange(dropped, {})) remesher.drop_part(face);
    remesher.remove_odd(odd, result.shortest_side);
    // Once: edges that become odd because the mean edge length has grown must not come back.
    if (!std::exchange(refined, true)) {
      const std::int64_t target = options.faces - remesher.counts().dropped_faces;
      const double least = kMargin * result.shortest_side;
      for (const double longer : {kMuchLonger * reference, reference, 2 * least}) {
        if (remesher.face_count() >= target) break;
        const auto find_long = [&](std::int32_t begin, std::int32_t end, auto& edges) {
          kernels::find_long_edges(mesh, begin, end, longer, edges);
        };
        remesher.refine(find_all(mesh, context, find_long), target, longer, least);
      }
    }
    result.vanished = result.vanished || remesher.vanished();
    result.counts += remesher.finish();
    parts = measure_parts(mesh, options.edge_limit, context);
    // All that is left is one triangle or tetrahedron. Far from the origin, where rounding makes
    // its corners one point, it would be odd again and again.
    if (remesher.vanished()) break;
  }
  result.parts = std::move(parts);
  return result;
}

}  // namespace semigeo::jobs
