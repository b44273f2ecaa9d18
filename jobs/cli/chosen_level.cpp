#include "jobs/cli/chosen_level.hpp"

#include <string>

#include "io/files/error.hpp"

namespace semigeo::jobs::cli {

void require_level(const io::Dataset& dataset, int level) {
  if (level >= dataset.level_count())
    throw io::Error(
        dataset.path(), "level " + std::to_string(level),
        "does not exist; there are " + std::to_string(dataset.level_count()) + " levels",
        "give a level from 0 to " + std::to_string(dataset.level_count() - 1));
}

}  // namespace semigeo::jobs::cli
