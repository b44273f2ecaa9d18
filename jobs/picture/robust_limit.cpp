#include "jobs/picture/robust_limit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace semigeo::jobs {

float robust_limit(std::span<const FieldValues> fields) {
  constexpr double kShare = 0.98;
  std::vector<float> sizes;
  for (const FieldValues& field : fields)
    for (std::size_t v = 0; v < field.values.size(); ++v)
      if (field.completeness[v] > 0 && std::isfinite(field.values[v]))
        sizes.push_back(std::abs(field.values[v]));
  if (sizes.empty()) return 0;
  const auto place =
      sizes.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(sizes.size() - 1));
  std::ranges::nth_element(sizes, place);
  return *place;
}

}  // namespace semigeo::jobs
