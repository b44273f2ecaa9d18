#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace semigeo::jobs {

/// One reason why a job runs.
struct Reason {
  /// The kinds of reasons.
  enum class Kind {
    kNoDataset,
    kUnusableDataset,  ///< The dataset is damaged, incomplete or of another format.
    kDamagedArrays,
    kScan,       ///< The scan has other bytes than the one that the dataset was made of.
    kParameter,  ///< A parameter has another value.
    kProgram,    ///< The program makes other bytes of the same scan and parameters.
    kNoSidecar,
    kDamagedSidecar,
    // These are for outputs that are made of datasets. `before` is what the output is called.
    kNoOutput,
    kUnusableOutput,  ///< The output is damaged, incomplete or of another version.
    kDamagedOutput,
    kInputs  ///< The inputs (named by `now`), the parameters or the program have changed.
  };
  Kind kind;
  std::string parameter = {};  ///< Name of the parameter.
  /// The value of the parameter before (null: there was none), the digest of the scan before, the
  /// version of the program before, or what the output is called.
  nlohmann::json before = {};
  /// The value or digest now, the name of the inputs, or what is wrong with the file.
  nlohmann::json now = {};
  friend bool operator==(const Reason&, const Reason&) = default;
};

/// Returns the name of a kind for programs: "scan", "parameter", "no dataset", ...
std::string_view name_of(Reason::Kind kind);

/// Returns the reason as a phrase with all details: "parameter levels: 8, now 20".
std::string in_words(const Reason& reason);

/// Returns all reasons as one phrase: "the scan and the parameters changed". It is empty if there
/// is no reason.
std::string in_short(const std::vector<Reason>& reasons);

/// Returns a reason for each parameter that differs between two JSON objects, sorted by name. A
/// value that is no object has no parameters.
std::vector<Reason> parameter_differences(const nlohmann::json& before, const nlohmann::json& now);

}  // namespace semigeo::jobs
