#pragma once

#include <memory>
#include <vector>

#include "jobs/bench/figure.hpp"
#include "jobs/bench/inputs.hpp"

namespace semigeo::jobs {

/// Points to the inputs that cases share.
using BenchInputsPointer = std::shared_ptr<BenchInputs>;

// Each function adds its cases, each on every one of these numbers of threads.

/// Adds what the machine can do by itself: arithmetic, memory, the disk, small files.
void add_machine_cases(std::vector<BenchCase>& cases, const BenchInputsPointer& inputs,
                       const std::vector<int>& threads);
/// Adds the kernel for each instruction set, and one level with features and the move to the next.
void add_level_cases(std::vector<BenchCase>& cases, const BenchInputsPointer& inputs,
                     const std::vector<int>& threads);
/// Adds whole runs of the program: small scans, a large one, one like a real one.
void add_job_cases(std::vector<BenchCase>& cases, const BenchInputsPointer& inputs,
                   const std::vector<int>& threads);
/// Adds reading and writing of scans and datasets.
void add_file_cases(std::vector<BenchCase>& cases, const BenchInputsPointer& inputs,
                    const std::vector<int>& threads);
/// Adds libraries and recognition.
void add_recognition_cases(std::vector<BenchCase>& cases, const BenchInputsPointer& inputs,
                           const std::vector<int>& threads);

/// Returns all cases.
inline std::vector<BenchCase> all_cases(const BenchInputsPointer& inputs,
                                        const std::vector<int>& threads) {
  std::vector<BenchCase> cases;
  add_machine_cases(cases, inputs, threads);
  add_level_cases(cases, inputs, threads);
  add_job_cases(cases, inputs, threads);
  add_file_cases(cases, inputs, threads);
  add_recognition_cases(cases, inputs, threads);
  return cases;
}

}  // namespace semigeo::jobs
