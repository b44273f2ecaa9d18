#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace semigeo::jobs {

/// One thing because of which a job runs.
struct Reason {
  enum class Kind {
    kNoDataset,
    kUnusableDataset,  ///< damaged, incomplete, of another format
    kDamagedArrays,
    kScan,       ///< it has other bytes than the one that the dataset was made of
    kParameter,  ///< it has another value
    kProgram,    ///< it makes other bytes of the same scan and parameters
    kNoSidecar,
    kDamagedSidecar,
    // Of what is made of datasets. `before` is what the output is called.
    kNoOutput,
    kUnusableOutput,  ///< damaged, incomplete, of another version
    kDamagedOutput,
    kInputs  ///< what it was made of (`now`), the parameters or the program
  };
  Kind kind;
  std::string parameter = {};  ///< its name
  std::string before = {};     ///< a digest, a JSON value (empty: there was none), a version
  std::string now = {};        ///< likewise; of what is unusable or damaged: what is wrong with it
  friend bool operator==(const Reason&, const Reason&) = default;
};

/// "scan", "parameter", "no dataset", ...: for programs.
std::string_view name_of(Reason::Kind kind);

/// "parameter levels: 8, now 20".
std::string in_words(const Reason& reason);

/// All of them as one phrase: "the scan and the parameters changed". Empty for none.
std::string in_short(const std::vector<Reason>& reasons);

/// The parameters that differ between two texts of to_json(SurfaceParameters), by name. What cannot
/// be understood has no parameters.
std::vector<Reason> parameter_differences(const std::string& before, const std::string& now);

}  // namespace semigeo::jobs
