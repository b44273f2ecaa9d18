// write_sample_dataset FILE same|changing deflate|none: the sample dataset, for
// dataset_h5py_test.py.
#include <iostream>
#include <string>

#include "tests/io/dataset/sample_dataset.hpp"

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  semigeo::tests::Sample sample{.vertices = 50000, .triangles = 90000};
  sample.changing = argv[2] == std::string("changing");
  if (argv[3] == std::string("none")) sample.compression = semigeo::io::Compression::kNone;
  std::cout << semigeo::tests::write_sample(argv[1], sample) << "\n";
}
