// Writes the seeds that are binary or long into a folder: `make_seeds FOLDER` makes
// FOLDER/<target>/<name>. The other seeds lie in tests/fuzz/seeds.
#include <cstdio>
#include <exception>

#include "tests/fuzz/seed_folder.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    semigeo::fuzz::make_file_seeds(argv[1]);
    semigeo::fuzz::make_job_seeds(argv[1]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "make_seeds: %s\n", e.what());
    return 1;
  }
  return 0;
}
