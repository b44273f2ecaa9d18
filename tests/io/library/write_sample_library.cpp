// Writes the library of three made-up models that library_h5py_test.py reads. Usage:
// write_sample_library FILE
#include "tests/io/library/sample_library.hpp"

int main(int, char** arguments) {
  semigeo::tests::write_library(arguments[1],
                                semigeo::tests::SampleLibrary(3, {.triplets = 30000}));
}
