#include "jobs/slurm/task_list.hpp"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>

#include "io/files/error.hpp"
#include "io/files/json_value.hpp"
#include "io/files/line_reader.hpp"
#include "jobs/archive/path_text.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kTaskSeconds = 300;
constexpr std::size_t kMostTasks = 10'000;

/// Fills tasks with jobs in their order. A new task begins when the next job would make the task
/// longer than `seconds`.
std::vector<std::vector<std::size_t>> filled(std::span<const std::size_t> order,
                                             std::span<const double> expected, double seconds) {
  std::vector<std::vector<std::size_t>> tasks;
  double sum = 0;
  for (const std::size_t job : order) {
    if (tasks.empty() || sum + expected[job] > seconds) {
      tasks.emplace_back();
      sum = 0;
    }
    tasks.back().push_back(job);
    sum += expected[job];
  }
  return tasks;
}

/// Returns the text by which a task finds its lines among those of others without parsing them.
std::string head_of(int number) {
  return R"({"task":)" + std::to_string(number) + ',';
}

/// Returns the text of an object with more fields at its front.
std::string with_front(const std::string& front, const std::string& object) {
  return front + object.substr(1);
}

json to_json_object(const TaskSettings& settings) {
  return {{"archive", escaped(settings.archive.string())},
          {"threads", settings.threads},
          {"memory_bytes", settings.memory_bytes},
          {"timeout_seconds", settings.timeout_seconds},
          {"retries", settings.retries},
          {"fail_fast", settings.fail_fast},
          {"deadline", settings.deadline}};
}

TaskSettings settings_from(const std::string& line) {
  const json object = json::parse(line);
  TaskSettings settings;
  settings.archive = unescaped(object.at("archive").get<std::string>());
  io::read_value(object.at("threads"), settings.threads);
  io::read_value(object.at("memory_bytes"), settings.memory_bytes);
  object.at("timeout_seconds").get_to(settings.timeout_seconds);
  io::read_value(object.at("retries"), settings.retries);
  object.at("fail_fast").get_to(settings.fail_fast);
  object.at("deadline").get_to(settings.deadline);
  return settings;
}

JobReply reply_of(const TaskResult& result) {
  const JobOutcome& outcome = result.outcome;
  JobReply reply{.kind = JobReply::Kind::kWorked,
                 .error = outcome.error,
                 .result = result.result,
                 .cpu_seconds = outcome.cpu_seconds,
                 .peak_bytes = outcome.peak_bytes,
                 .write_error = outcome.write_error};
  if (outcome.state == JobState::kFailed || outcome.state == JobState::kSkipped)
    reply.kind = JobReply::Kind::kFailed;
  // The task has stopped at this job, because nothing can be written any more. So will the run.
  if (outcome.write_error != 0 && !outcome.error.empty()) reply.kind = JobReply::Kind::kFailed;
  if (is_made(outcome.state)) reply.kind = JobReply::Kind::kDone;
  return reply;
}

TaskResult result_of(JobReply reply) {
  TaskResult result{.outcome = {.error = std::move(reply.error),
                                .cpu_seconds = reply.cpu_seconds,
                                .peak_bytes = reply.peak_bytes,
                                .write_error = reply.write_error},
                    .result = std::move(reply.result)};
  if (reply.kind == JobReply::Kind::kDone) result.outcome.state = JobState::kDone;
  if (reply.kind == JobReply::Kind::kFailed) result.outcome.state = JobState::kFailed;
  return result;
}

}  // namespace

std::vector<std::vector<std::size_t>> share_out(std::span<const double> seconds, int per_task) {
  std::vector<std::size_t> order(seconds.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t job) { return seconds[job]; });
  if (per_task > 0) {
    std::vector<std::vector<std::size_t>> tasks;
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i % static_cast<std::size_t>(per_task) == 0) tasks.emplace_back();
      tasks.back().push_back(order[i]);
    }
    return tasks;
  }
  for (double longest = kTaskSeconds;; longest *= 1.5) {
    auto tasks = filled(order, seconds, longest);
    if (tasks.size() <= kMostTasks) return tasks;
  }
}

std::string task_list_text(const TaskSettings& settings,
                           const std::vector<std::vector<JobRequest>>& tasks) {
  std::string text = to_json_object(settings).dump() + '\n';
  for (std::size_t number = 0; number < tasks.size(); ++number)
    for (const JobRequest& job : tasks[number])
      text += with_front(head_of(static_cast<int>(number)), to_line(job)) + '\n';
  return text;
}

Task read_task(const fs::path& list, int number, const JobKinds& kinds) {
  constexpr const char* kRemedy = "run semigeo again: it makes another list";
  io::LineReader lines(list);
  Task task;
  std::string line;
  int place = 1;
  try {
    lines.next(line);
    task.settings = settings_from(line);
    // The lines of a task stand together.
    const std::string head = head_of(number);
    while (lines.next(line)) {
      ++place;
      if (line.starts_with(head)) {
        task.jobs.push_back(job_request_from(line, kinds));
      } else if (!task.jobs.empty()) {
        break;
      }
    }
  } catch (const io::Error&) {
    throw;
  } catch (const std::exception& e) {
    throw io::Error(list, "line " + std::to_string(place), e.what(), kRemedy);
  }
  if (task.jobs.empty())
    throw io::Error(list, "", "has no task " + std::to_string(number), kRemedy);
  return task;
}

fs::path results_of(const fs::path& list, int number) {
  return list.parent_path() / "results" / (std::to_string(number) + ".jsonl");
}

fs::path log_of_task(const fs::path& list, int number) {
  return list.parent_path() / ("task-" + std::to_string(number) + ".log");
}

std::string results_text(const TaskResults& results) {
  std::string text;
  for (const auto& [job, result] : results) {
    const JobOutcome& outcome = result.outcome;
    const std::string front = json{
        {"job", escaped(job)},
        {"seconds", outcome.seconds},
        {"threads", outcome.threads},
        {"attempts",
         outcome.attempts}}.dump();
    text += with_front(front.substr(0, front.size() - 1) + ',', to_line(reply_of(result))) + '\n';
  }
  return text;
}

TaskResults read_results(const fs::path& file) try {
  TaskResults results;
  io::LineReader lines(file);
  for (std::string line; lines.next(line);) {
    try {
      TaskResult result = result_of(job_reply_from(line));
      JobOutcome& outcome = result.outcome;
      const json object = json::parse(line);
      object.at("seconds").get_to(outcome.seconds);
      io::read_value(object.at("threads"), outcome.threads);
      io::read_value(object.at("attempts"), outcome.attempts);
      results[unescaped(object.at("job").get<std::string>())] = std::move(result);
    } catch (const std::exception&) {
      continue;  // the output itself decides
    }
  }
  return results;
} catch (const io::Error&) {
  return {};  // the outputs of the jobs decide
}

}  // namespace semigeo::jobs
