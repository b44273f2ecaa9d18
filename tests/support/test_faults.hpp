#pragma once

#include <stdlib.h>

namespace semigeo::tests {

/// While it lives, workers that are started do what jobs/run/worker.hpp says of
/// SEMIGEO_TEST_FAULTS.
class TestFaults {
 public:
  explicit TestFaults(const char* faults) { setenv(kName, faults, 1); }
  ~TestFaults() { unsetenv(kName); }
  TestFaults(const TestFaults&) = delete;
  TestFaults& operator=(const TestFaults&) = delete;

 private:
  static constexpr const char* kName = "SEMIGEO_TEST_FAULTS";
};

}  // namespace semigeo::tests
