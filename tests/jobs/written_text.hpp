#pragma once

#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "io/files/error.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/plan/typed_job_kind.hpp"

namespace semigeo::tests {

/// A job that writes a text.
struct TextJobData {
  std::string text = {};
  double seconds = 0;  ///< What the job is expected to take.
  double bytes = 0;    ///< What the job is expected to need.
};
struct TextJobResult {
  std::int64_t letters = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TextJobData, text, seconds, bytes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TextJobResult, letters)

/// A kind of jobs that the program does not have: each writes its key and its text into its output.
/// A job of the text "fail" fails.
class TextKind final : public jobs::TypedJobKind<TextJobData, TextJobResult> {
 public:
  const jobs::JobWords& words() const override { return words_; }

  std::string read_key(const std::filesystem::path& output, jobs::KeyCheck) const override {
    std::ifstream stream(output);
    std::string key;
    std::getline(stream, key);
    return key;
  }

  jobs::Estimate estimate(const jobs::PlannedJob& planned,
                          const jobs::EstimateContext&) const override {
    return {.peak_bytes = data(planned.job).bytes, .seconds = data(planned.job).seconds};
  }

  std::any run(const jobs::Job& job, const jobs::JobContext& context) const override {
    const std::string& text = data(job).text;
    if (text == "fail") throw io::Error(job.output, "", "cannot be written", "give another text");
    std::ofstream(job.output) << job.key << '\n' << text;
    context.engine.observer.worked(static_cast<std::int64_t>(text.size()));
    return TextJobResult{static_cast<std::int64_t>(text.size())};
  }

  std::int64_t vertex_levels(const std::any& value) const override {
    return result(value) == nullptr ? 0 : result(value)->letters;
  }

  jobs::JobReport report(const jobs::Job&, const std::any& value) const override {
    const std::string letters = std::to_string(result(value)->letters);
    return {.fields = {{"letters", result(value)->letters}},
            .lines = {{"written", letters + " letters"}, {"noted", ""}, {"closed", "the book"}}};
  }

 private:
  const jobs::JobWords words_ = {
      .kind = "text", .output = "page", .inputs = "the text", .plural = "texts"};
};

inline const TextKind& text_kind() {
  static const TextKind kind;
  return kind;
}

/// Plans a job that writes a text, after the jobs at some places of the plan.
inline jobs::PlannedJob text_job(const std::string& name, const std::filesystem::path& folder,
                                 TextJobData data, std::vector<std::size_t> after = {}) {
  jobs::PlannedJob planned;
  planned.job = {.kind = &text_kind(),
                 .name = name,
                 .input = folder,
                 .output = folder / name,
                 .key = "key of " + name,
                 .data = std::move(data)};
  planned.after = std::move(after);
  jobs::judge_output(planned);
  return planned;
}

}  // namespace semigeo::tests
