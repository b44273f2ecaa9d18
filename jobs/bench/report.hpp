#pragma once

#include <string>
#include <vector>

#include "jobs/bench/comparison.hpp"
#include "jobs/bench/machine.hpp"
#include "jobs/bench/measure.hpp"

namespace semigeo::jobs {

/// Says what was measured, by which program, on which machine.
struct BenchReport {
  MachineDescription machine;
  std::string version;           ///< Version of the program.
  std::string build;             ///< Compiler and libraries, in words.
  std::string instruction_set;   ///< What kernels use.
  std::string instruction_sets;  ///< What kernels could use on this processor, with commas.
  std::string date;              ///< When it began, in UTC.
  bool quick = false;
  std::string scan_xxh3;  ///< Digest of the user's scan, or empty.
  std::string scan;       ///< The user's scan, or empty.
  double seconds = 0;     ///< What all of it took.
  Measurement measurement;
};

/// Returns the rates of all figures, to be compared. `machine_cores` says whether there were cores
/// for other processes too.
std::vector<NamedRate> rates_of(const Measurement& measurement, int machine_cores);

/// Returns the report as a table for people, with the machine and its load.
std::string table_of(const BenchReport& report);

/// Returns a comparison as a table for people. It says also if the machine itself differs.
std::string table_of(const Comparison& comparison);

/// Returns lines that name the figures that fell below the bound, or say that none did.
std::string fallen_text(const std::vector<ComparedRate>& fell, double bound);

/// Returns a number with three digits and a unit prefix: "1.23 M", "45.6 k", "0.789".
std::string figure_number(double value);

}  // namespace semigeo::jobs
