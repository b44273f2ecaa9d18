// Stands for io/scans/draco_mesh.cpp. Draco itself is not instrumented, and takes what memory it
// likes. Here the bytes of the file are the numbers of the mesh, whatever they are.
#include <cmath>
#include <limits>
#include <stdexcept>

#include "io/scans/draco_mesh.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::io {
namespace {

double coordinate(fuzz::Numbers& numbers) {
  const unsigned kind = numbers.byte();
  if (kind == 255) return std::numeric_limits<double>::quiet_NaN();
  if (kind == 254) return std::numeric_limits<double>::infinity();
  return std::ldexp(static_cast<double>(numbers.byte()) - 128, static_cast<int>(kind / 2));
}

}  // namespace

DracoMesh decode_draco(std::string_view bytes, std::int64_t positions,
                       std::optional<std::int64_t> normals) {
  fuzz::Numbers numbers(bytes);
  if (numbers.below(8) == 7 || positions < 0) throw std::runtime_error("it is damaged");
  const unsigned points = 1 + numbers.byte();
  const unsigned corners = 3 * numbers.below(64);
  DracoMesh mesh;
  for (unsigned i = 0; i < corners; ++i) mesh.indices.push_back(numbers.byte() % points);
  for (unsigned i = 0; i < 3 * points; ++i) mesh.positions.push_back(coordinate(numbers));
  if (normals && *normals == 1)
    for (unsigned i = 0; i < 3 * points; ++i) mesh.normals.push_back(coordinate(numbers));
  return mesh;
}

}  // namespace semigeo::io
