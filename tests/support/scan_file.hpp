#pragma once

#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::tests {

/// Writes a mesh as OBJ, with every digit of its coordinates; returns the path.
inline std::filesystem::path write_obj(const std::filesystem::path& path,
                                       const kernels::TriangleMesh& mesh) {
  std::ofstream out(path);
  out.precision(std::numeric_limits<double>::max_digits10);
  for (const auto& p : mesh.points) out << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const auto& [a, b, c] : mesh.triangles)
    out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
  return path;
}

}  // namespace semigeo::tests
