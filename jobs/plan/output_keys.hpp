#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "jobs/plan/job.hpp"

namespace semigeo::jobs {

/// Reads keys of outputs, each file once: many jobs of a run may read the same outputs of others.
class OutputKeys {
 public:
  /// Returns the key in the head of a file that a job of this kind has made; empty if there is
  /// none. A file that changes later keeps the key that was read first.
  const std::string& of(const JobKind& kind, const std::filesystem::path& output) {
    const auto [at, is_new] = keys_.try_emplace(output);
    if (is_new) at->second = output_key(kind, output, KeyCheck::kHead);
    return at->second;
  }

 private:
  std::map<std::filesystem::path, std::string> keys_;
};

}  // namespace semigeo::jobs
