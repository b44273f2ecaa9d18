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
  /// none. A file that changes later keeps the key that was read first. Throws io::ReadError if the
  /// system refuses to read the file.
  const std::string& of(const JobKind& kind, const std::filesystem::path& output) {
    const auto known = keys_.find(output);
    if (known != keys_.end()) return known->second;
    return keys_[output] = output_key(kind, output, KeyCheck::kHead);
  }

 private:
  std::map<std::filesystem::path, std::string> keys_;
};

}  // namespace semigeo::jobs
