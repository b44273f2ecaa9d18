#pragma once

#include <string>

namespace semigeo::jobs {

/// The units of curvatures, for people.
struct CurvatureUnits {
  std::string mean;      ///< "1/mm"
  std::string gaussian;  ///< "1/mm²"
};

/// Returns the units of curvatures of a surface with this unit of length. If that is "unknown",
/// they are "1/unit" and "1/unit²".
CurvatureUnits curvature_units(const std::string& length_unit);

}  // namespace semigeo::jobs
