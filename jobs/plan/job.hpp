#pragma once

#include <any>
#include <filesystem>
#include <string>

namespace semigeo::jobs {

class JobKind;

/// A job makes one file from other files. This head is all that planning, running and reporting
/// need to know; `data` holds what only the job's kind understands.
struct Job {
  const JobKind* kind = nullptr;  ///< Says everything about jobs of this kind; never null.
  std::string name;               ///< Tells the job from the others of its kind.
  std::filesystem::path input;    ///< The file or folder that the job reads first.
  std::filesystem::path output;   ///< The file that the job makes.
  std::string key;                ///< Hash of all that the output depends on.
  std::any data = {};             ///< The kind's own description of the job.
};

/// Returns "surface <name>": the name of the job in the journal, in logs and in the graph.
std::string job_id(const Job& job);

/// Returns the name by which users know the job: what they call the scan (given_name) if the job
/// stands for one, otherwise its identifier.
std::string shown_name(const Job& job);

/// Returns the file that messages about the job name: its input, or its output if the job merges
/// many files into one.
const std::filesystem::path& subject_of(const Job& job);

/// Says how much of an output is read before its key counts.
enum class KeyCheck {
  kHead,  ///< The head of the file, for many files at once.
  kWhole  ///< Whatever the format protects by checksums.
};

/// Returns the key that the job's output carries. The key is empty if there is no output, or if it
/// is damaged. Throws io::ReadError if the system refuses to read it: then nothing is known of it.
std::string output_key(const Job& job, KeyCheck check = KeyCheck::kWhole);

/// Returns the same for a file that a job of this kind makes.
std::string output_key(const JobKind& kind, const std::filesystem::path& output, KeyCheck check);

/// Returns whether the output is there in full and was made under the job's key. Throws
/// io::ReadError as output_key does.
bool is_complete(const Job& job);

}  // namespace semigeo::jobs
