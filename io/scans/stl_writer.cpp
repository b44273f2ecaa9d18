#include "io/scans/stl_writer.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <string>

#include "io/files/error.hpp"
#include "io/files/output_file.hpp"

namespace semigeo::io {

void write_stl(const std::filesystem::path& path, const MeshView& mesh) {
  check_mesh(path, mesh);
  const std::size_t triangles = mesh.triangles.size() / 3;
  if (triangles > std::numeric_limits<std::uint32_t>::max())
    throw Error(path, "", "would need more than 32 bits to count its triangles", "write a .ply");
  OutputFile output(path);
  constexpr std::size_t kHeaderBytes = 80;
  std::string header = "binary STL written by semigeo";
  header.resize(kHeaderBytes, ' ');
  output.text(header);
  output.number(static_cast<std::uint32_t>(triangles));
  const auto corner = [&mesh](std::size_t i) {
    return Eigen::Vector3f(&mesh.points[3 * static_cast<std::size_t>(mesh.triangles[i])]);
  };
  const auto put = [&output](const Eigen::Vector3f& vector) {
    for (const float x : {vector.x(), vector.y(), vector.z()}) output.number(x);
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const Eigen::Vector3f a = corner(i);
    const Eigen::Vector3f b = corner(i + 1);
    const Eigen::Vector3f c = corner(i + 2);
    const Eigen::Vector3f normal = (b - a).cross(c - a);
    put(normal.norm() > 0 ? normal.normalized().eval() : Eigen::Vector3f::Zero().eval());
    put(a);
    put(b);
    put(c);
    output.number(std::uint16_t{0});
  }
  output.commit();
}

}  // namespace semigeo::io
