#include "jobs/picture/read_triangles.hpp"

#include <algorithm>

#include "io/files/error.hpp"

namespace semigeo::jobs {

std::vector<std::int64_t> read_triangles(const io::Dataset& dataset, int level,
                                         std::size_t vertices) {
  std::vector<std::int64_t> corners = dataset.read_integers(level, "triangles");
  const auto count = static_cast<std::int64_t>(vertices);
  if (std::ranges::any_of(corners, [&](std::int64_t c) { return c < 0 || c >= count; }))
    throw io::Error(dataset.path(), io::level_path(level) + "/triangles",
                    "has a corner that is no vertex", "make the dataset again");
  return corners;
}

}  // namespace semigeo::jobs
