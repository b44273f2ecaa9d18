#include "jobs/cli/given_names.hpp"

#include "io/files/error.hpp"
#include "jobs/kinds/library_plan.hpp"

namespace semigeo::jobs::cli {

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
  const std::string given = scan_of(model).filename().string();
  return given.empty() || model.ends_with(given) ? model : given + " (" + model + ")";
}

}  // namespace semigeo::jobs::cli
