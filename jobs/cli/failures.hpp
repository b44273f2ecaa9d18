#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace semigeo::jobs::cli {

/// The number of failures or reports up to which each gets a line of its own.
inline constexpr std::size_t kFew = 5;

/// A job that has failed.
struct Failure {
  std::string sentence;   ///< It begins with the file that it is about.
  std::string file = {};  ///< That file; empty if it is not known.
};

/// Failures that have the same reason.
struct FailureGroup {
  std::string example;    ///< The sentence about the first of them.
  std::size_t count = 0;  ///< Their number.
};

/// Returns the failures by reason, the most frequent reason first. Two sentences have the same
/// reason if they differ in the file, the place in it, numbers and the remedy only.
std::vector<FailureGroup> grouped(const std::vector<Failure>& failures);

/// Prints failures on stdout: each of a few; of many, the most frequent reasons with their number
/// and an example. If they were `told` in the same place before, only those reasons are printed
/// that many have. Returns whether something was left out.
bool print_failures(const std::vector<Failure>& failures, bool told = false);

/// Returns whether standard output and standard error are the same file or terminal, so that what
/// was told on one need not be printed on the other.
bool outputs_are_one_place();

/// Returns the text cut to this number of lines of a terminal of 80 columns.
std::string cut(std::string_view text, std::size_t lines);

}  // namespace semigeo::jobs::cli
