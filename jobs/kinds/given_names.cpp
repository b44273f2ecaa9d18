#include "jobs/kinds/given_names.hpp"

#include "io/files/error.hpp"
#include "jobs/archive/names.hpp"
#include "jobs/kinds/library_plan.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;

GivenNames::GivenNames(const fs::path& library) {
  const LibraryPlace place = place_of(fs::absolute(library).lexically_normal());
  if (place.home == place.parts) return;
  try {
    sources_ = Sources::read(place.home);
  } catch (const io::Error&) {
    return;  // the names of models are enough
  }
}

fs::path GivenNames::scan_of(const std::string& model) const {
  const auto at = sources_.by_name().find(model);
  return at == sources_.by_name().end() ? fs::path() : at->second;
}

std::string GivenNames::shown(const std::string& model) const {
  const std::string given = name_of(model);
  const std::string own = " (" + model + ")";
  return given == model || given.ends_with(own) ? given : given + own;
}

std::string GivenNames::name_of(const std::string& model) const {
  return given_name(scan_of(model), model);
}

}  // namespace semigeo::jobs
