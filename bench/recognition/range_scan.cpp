#include "bench/recognition/range_scan.hpp"

#include "io/scans/scan_reader.hpp"

namespace semigeo::recognition {

std::optional<RangeScan> read_range_scan(const std::filesystem::path& folder,
                                         std::int64_t model_vertices, std::int64_t scene_vertices) {
  const auto model = folder / "uwa_parasaurolophus_28k.ply";
  const auto scene = folder / "uwa_scene_rs1.ply";
  if (!std::filesystem::exists(model) || !std::filesystem::exists(scene)) return std::nullopt;
  RangeScan result;
  result.model = make_model(model.stem().string(), io::read_scan(model).mesh, model_vertices);
  result.scene = {.kind = "G",
                  .name = result.model->name,
                  .seed = 0,
                  .mesh = repaired(io::read_scan(scene).mesh, scene_vertices),
                  .objects = {PlacedObject{}}};
  // As the data set has it, in mm.
  kernels::Similarity& pose = result.scene.objects.front().pose;
  pose.rotation << 0.99438444, -0.086785696, 0.060562618,  //
      0.099112768, 0.56310357, -0.82042125,                //
      0.037097803, 0.82181666, 0.568543;
  pose.translation << -74.489564, -601.35135, -292.75749;
  return result;
}

}  // namespace semigeo::recognition
