#include "jobs/picture/curvature_unit.hpp"

#include "io/files/printable.hpp"

namespace semigeo::jobs {

CurvatureUnits curvature_units(const std::string& length_unit) {
  const std::string unit =
      "1/" + (length_unit == "unknown" ? std::string("unit") : io::printable(length_unit));
  return {.mean = unit, .gaussian = unit + "\u00b2"};
}

}  // namespace semigeo::jobs
