#include "io/scans/obj_writer.hpp"

#include "io/files/output_file.hpp"

namespace semigeo::io {

void write_obj(const std::filesystem::path& path, const MeshView& mesh,
               const std::string& comment) {
  check_mesh(path, mesh);
  OutputFile output(path);
  const Placement placement(mesh.origin);
  output.text("# " + comment + "\n");
  const auto put = [&output](auto number) {
    output.text(" ");
    output.decimal(number);
  };
  for (std::size_t i = 0; i < mesh.points.size(); i += 3) {
    output.text("v");
    placement.place(&mesh.points[i], put);
    if (!mesh.colours.empty())
      for (std::size_t c = i; c < i + 3; ++c) put(static_cast<float>(mesh.colours[c]) / 255);
    output.text("\n");
  }
  for (std::size_t i = 0; i < mesh.normals.size(); i += 3) {
    output.text("vn");
    for (std::size_t c = i; c < i + 3; ++c) put(mesh.normals[c]);
    output.text("\n");
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    output.text("f");
    for (std::size_t c = i; c < i + 3; ++c) {
      put(mesh.triangles[c] + 1);
      if (mesh.normals.empty()) continue;
      output.text("//");
      output.decimal(mesh.triangles[c] + 1);
    }
    output.text("\n");
  }
  output.commit();
}

}  // namespace semigeo::io
