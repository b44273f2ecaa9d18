#include "jobs/slurm/slurm_commands.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <system_error>

#include "engine/run_command.hpp"
#include "io/files/error.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// The limit is longer than the time after which Slurm's programs themselves give up.
constexpr int kMostSeconds = 120;
/// The limit is more than the queue of a million tasks.
constexpr std::size_t kMostBytes = std::size_t{1} << 28;
constexpr std::size_t kMostShownBytes = 1000;
constexpr const char* kRemedy =
    "check that the cluster is up and what --slurm-option asks for, or run with --executor local";

std::string in_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file = fs::path(folder.empty() ? "." : folder) / program;
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0) return file;
  }
  throw io::Error(program, "", "is not in PATH",
                  "run where Slurm's programs are, or with --executor local");
}

/// It holds what a program of Slurm printed, and how it ended.
using Answer = engine::CommandResult;

Answer ask(const std::vector<std::string>& arguments) {
  Answer answer = engine::run_command(arguments, {.seconds = kMostSeconds, .bytes = kMostBytes});
  if (answer.exceeded == Answer::Bound::kSeconds)
    answer.text += " (no answer within " + std::to_string(kMostSeconds) + " s)";
  if (answer.exceeded == Answer::Bound::kBytes) answer.text.resize(kMostShownBytes);
  return answer;
}

/// Replaces the line ends, so that the text fits into a sentence.
std::string in_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return std::isspace(c) != 0; }, ' ');
  const std::size_t end = text.find_last_not_of(' ');
  text.erase(end == std::string::npos ? 0 : end + 1);
  return text.empty() ? "nothing" : text;
}

[[noreturn]] void refuse(const std::string& program, const std::string& problem,
                         const Answer& answer) {
  // The array has more tasks than the cluster's MaxArraySize.
  const bool too_many = answer.text.find("Invalid job array") != std::string::npos;
  throw io::Error(program, "", problem + ", and said: " + in_one_line(answer.text),
                  too_many ? "give --scans-per-task more" : kRemedy);
}

std::string failure_of(const Answer& answer) {
  return answer.exit_code < 0 ? "was killed"
                              : "failed with exit code " + std::to_string(answer.exit_code);
}

Answer ask_successfully(const std::vector<std::string>& arguments) {
  Answer answer = ask(arguments);
  if (answer.exit_code != 0) refuse(arguments.front(), failure_of(answer), answer);
  return answer;
}

bool is_number(const std::string& text) {
  return !text.empty() &&
         std::ranges::all_of(text, [](unsigned char c) { return isdigit(c) != 0; });
}

/// Returns whether Slurm no longer knows the job, because it ended long ago.
bool is_forgotten(const Answer& answer) {
  return answer.text.find("Invalid job id") != std::string::npos;
}

}  // namespace

std::vector<std::string> sbatch_arguments(const SlurmArray& array) {
  std::vector<std::string> arguments = {
      "--parsable",
      "--job-name=" + array.name,
      "--array=0-" + std::to_string(array.tasks - 1),
      "--nodes=1",
      "--ntasks=1",
      "--cpus-per-task=" + std::to_string(array.cpus),
      // The path is relative to the folder, because '%' and '\' in the folder's name would have a
      // meaning in the pattern.
      "--chdir=" + fs::absolute(array.folder).string(),
      "--output=task-%a.log",
      "--open-mode=append",
  };
  constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;
  if (array.memory_bytes > 0)
    arguments.push_back(
        "--mem=" + std::to_string((array.memory_bytes + kMebibyte - 1) / kMebibyte) + "M");
  if (array.seconds > 0)
    arguments.push_back("--time=" +
                        std::to_string(static_cast<std::int64_t>(std::ceil(array.seconds / 60))));
  if (!array.after.empty()) {
    std::string jobs;
    for (const std::string& job : array.after) jobs += ':' + job;
    arguments.push_back("--dependency=afterok" + jobs);
    arguments.emplace_back("--kill-on-invalid-dep=yes");
  }
  for (const std::string& option : array.options)
    arguments.push_back(option.starts_with('-') ? option : "--" + option);
  arguments.push_back(fs::absolute(array.script).string());
  return arguments;
}

std::map<int, QueuedTask> parse_queue(const std::string& text) {
  std::map<int, QueuedTask> tasks;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string number;
    std::string state;
    if (!(words >> number >> state) || !is_number(number) || number.size() > 9) continue;
    if (state == "COMPLETING" || state == "COMPLETED" || state == "CANCELLED" ||
        state == "FAILED" || state == "TIMEOUT" || state == "OUT_OF_MEMORY" ||
        state == "NODE_FAIL" || state == "BOOT_FAIL" || state == "DEADLINE")
      continue;
    const bool waits = state == "PENDING" || state.starts_with("REQUEUE") || state == "CONFIGURING";
    QueuedTask& task = tasks[std::stoi(number)];
    task.state = waits ? QueuedTask::State::kPending : QueuedTask::State::kRunning;
    if (waits) words >> task.reason;
  }
  return tasks;
}

SlurmCommands::SlurmCommands()
    : sbatch_(in_path("sbatch")), squeue_(in_path("squeue")), scancel_(in_path("scancel")) {}

std::string SlurmCommands::submit(const SlurmArray& array) const {
  std::vector<std::string> arguments = sbatch_arguments(array);
  arguments.insert(arguments.begin(), sbatch_);
  const Answer answer = ask_successfully(arguments);
  // The output is "1234" or "1234;cluster". There may be warnings before and after it.
  std::istringstream lines(answer.text);
  for (std::string line; std::getline(lines, line);)
    if (std::string id = line.substr(0, line.find(';')); is_number(id)) return id;
  refuse(sbatch_, "told no job id", answer);
}

std::map<int, QueuedTask> SlurmCommands::queue(const std::string& job) const {
  const std::vector<std::string> arguments = {squeue_, "--noheader", "--array", "--jobs=" + job,
                                              "--format=%K %T %r"};
  const Answer answer = ask(arguments);
  if (answer.exit_code == 0) return parse_queue(answer.text);
  if (is_forgotten(answer)) return {};
  refuse(squeue_, failure_of(answer), answer);
}

void SlurmCommands::cancel_pending(const std::string& job) const {
  const Answer answer = ask({scancel_, "--state=PENDING", job});
  if (answer.exit_code != 0 && !is_forgotten(answer)) refuse(scancel_, failure_of(answer), answer);
}

void SlurmCommands::cancel(const std::string& job) const {
  const Answer answer = ask({scancel_, job});
  if (answer.exit_code != 0 && !is_forgotten(answer)) refuse(scancel_, failure_of(answer), answer);
}

}  // namespace semigeo::jobs
