#pragma once

#include <any>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/run_context.hpp"
#include "io/files/error.hpp"
#include "jobs/archive/digest_cache.hpp"
#include "jobs/archive/estimates.hpp"
#include "jobs/archive/journal.hpp"
#include "jobs/plan/job.hpp"
#include "jobs/plan/job_state.hpp"
#include "jobs/plan/output_keys.hpp"

namespace semigeo::jobs {

struct PlannedJob;

/// The words in which messages, files and graphs speak of the jobs of one kind.
struct JobWords {
  std::string kind;                ///< "surface": names the kind everywhere.
  std::string output;              ///< "dataset": what the output is called.
  std::string inputs;              ///< "the scan": everything that the output is made of.
  std::string plural;              ///< "scans": what many jobs of the kind are called.
  std::string kill_remedy = {};    ///< " or leave the scan out": follows "run again".
  std::string memory_remedy = {};  ///< ", or decimate the scan": follows "give more memory".
  bool stands_for_scan = false;    ///< Users know the job by its name alone.
  bool merges_files = false;       ///< The job makes one file of many.
};

/// The inputs of an estimate.
struct EstimateContext {
  std::span<const PlannedJob> plan;
  const Estimates& learned;    ///< What the archive knows about scans.
  std::uint64_t memory_bytes;  ///< Memory of all jobs at once; 0: the user gave no limit.
};

/// The resources of a running job.
struct JobContext {
  engine::RunContext engine;
  std::uint64_t memory_bytes = 0;  ///< Memory of all jobs; 0: the user gave no limit.
};

/// A file that a job reads and no job of the plan makes.
struct ExternalFile {
  std::string kind;  ///< "scan", "dataset", "scene", "hash library"
  std::filesystem::path path;
  bool is_readable = true;
};

/// One line of the report about a job. It is printed as "<heading>: <name of the job>: <text>". If
/// many jobs of a run have such a line, their counts are added up, and the worst jobs are named.
struct ReportLine {
  std::string heading;  ///< "repaired"
  std::string text;     ///< If it is empty, the line is left out.
  /// What is added up: "degenerate faces" and their number. Names that have 0 may be there.
  std::vector<std::pair<std::string, std::int64_t>> counts = {};
  double loss = 0;  ///< How much the job has lost or changed, to compare; 0: nothing to look at.
};

/// The report of a run about one job that is done.
struct JobReport {
  /// What people call the job, as UTF-8; if it is empty, the job's own name is printed.
  std::string name = {};
  std::vector<std::pair<std::string, nlohmann::json>> fields;  ///< Members of its JSON object.
  /// The first lines of all jobs of a kind are printed first, then their second lines, and so on.
  std::vector<ReportLine> lines;
};

/// The report at the end of a run about a job, whether it is done or not.
struct JobSummary {
  std::string text;
  std::vector<std::pair<std::string, nlohmann::json>> fields;  ///< Members of the run's document.
  bool is_incomplete = false;  ///< The output was made, but lacks something that it was to have.
};

/// Knows all that the program needs to know about one kind of job. Plan, executors, journal, graph
/// and reports ask it, and know no kind by name. Whoever adds a kind derives from TypedJobKind. All
/// functions are const and may be called from any thread.
class JobKind {
 public:
  JobKind() = default;
  virtual ~JobKind() = default;
  JobKind(const JobKind&) = delete;
  JobKind& operator=(const JobKind&) = delete;

  /// Returns the words for jobs of this kind.
  virtual const JobWords& words() const = 0;

  // The output

  /// Returns the key that an output carries. Throws io::Error if there is none or it is damaged.
  virtual std::string read_key(const std::filesystem::path& output, KeyCheck check) const = 0;
  /// Returns whether the files that belong to the output are there, besides the output itself.
  virtual bool has_all_outputs(const Job& job) const;
  /// Removes what would look complete although it has to be made again.
  virtual void discard_output(const Job& job) const;

  // The inputs

  /// Adapts a job to the inputs that are there when the jobs before it have ended, and sets its
  /// key. A plan is made as if every job were going to succeed; when one has failed, what follows
  /// takes what there is. Looks at files only, so that it does not matter who has made them.
  /// Returns whether the output is there already, or is not needed. Throws io::Error if something
  /// is missing without which the job cannot begin. `keys` are those of outputs of other jobs.
  virtual bool resolve_inputs(Job& job, OutputKeys& keys) const;
  /// Removes an output of other inputs before the job begins, if it must not be mistaken for the
  /// job's own when the job fails. Most kinds leave it until it is replaced.
  virtual void remove_stale_output(const Job& job) const;
  /// Returns the files that the job reads and no job of the plan makes.
  virtual std::vector<ExternalFile> external_files(const PlannedJob& planned) const;

  // The work

  /// Returns what the job is expected to need on one thread.
  virtual Estimate estimate(const PlannedJob& planned, const EstimateContext& context) const;
  /// Returns the bytes by which the time left is judged; 0 if the job reads no scan.
  virtual std::uintmax_t bytes_to_read(const Job& job) const;
  /// Returns whether jobs of this kind fill arrays of many megabytes again and again, so that huge
  /// pages save time. Other jobs would wait for pages to be zeroed of which they need a part.
  virtual bool fills_large_arrays() const;
  /// Does the job in this process. Returns the kind's result, or nothing if there is nothing to
  /// tell. Throws io::Error, std::bad_alloc or another std::exception if the job fails.
  virtual std::any run(const Job& job, const JobContext& context) const = 0;

  // What other processes are told

  /// Returns the data of a job as JSON.
  virtual nlohmann::json data_to_json(const Job& job) const = 0;
  /// Reads what `data_to_json` returns. Throws std::exception on other values.
  virtual std::any data_from_json(const nlohmann::json& object) const = 0;
  /// Returns a result as JSON: null if it is empty.
  virtual nlohmann::json result_to_json(const std::any& result) const = 0;
  /// Reads what `result_to_json` returns. Throws std::exception on other values.
  virtual std::any result_from_json(const nlohmann::json& object) const = 0;

  // What people are told

  /// Returns vertices times levels of the surfaces that were evolved.
  virtual std::int64_t vertex_levels(const std::any& result) const;
  /// Adds to an event of the journal what later estimates are learned from.
  virtual void describe(const Job& job, const std::any& result, JobEnded& event) const;
  /// Returns what the run tells about a job that is done; `result` is not empty.
  virtual JobReport report(const Job& job, const std::any& result) const;
  /// Returns what the run tells about the job at its end, if anything.
  virtual std::optional<JobSummary> summary(const Job& job, JobState state) const;

  // After the run

  /// Lets the cache of the archive know the output of a job that is done. Returns whether
  /// estimates can be learned from the job.
  virtual bool remember(const Job& job, DigestCache& cache) const;
  /// Removes what nothing needs once the output is made.
  virtual void clean_up(const Job& job) const;
};

/// Returns the error that JobKind::resolve_inputs throws if `output` has nothing to be made of.
/// `input` names what is missing: "dataset".
io::Error missing_input(const std::filesystem::path& output, const std::string& input);

/// The kinds of jobs that a process can do.
class JobKinds {
 public:
  explicit JobKinds(std::vector<const JobKind*> kinds) : kinds_(std::move(kinds)) {}
  /// Returns the kind of this name, or null.
  const JobKind* find(std::string_view name) const;

 private:
  std::vector<const JobKind*> kinds_;
};

}  // namespace semigeo::jobs
