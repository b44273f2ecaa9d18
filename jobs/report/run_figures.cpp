#include "jobs/report/run_figures.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace semigeo::jobs {
namespace {

constexpr double kLeastSeconds = 10;
constexpr int kMostSteps = 96;
constexpr double kSignificant = 1e3;  // curves are drawn with three digits

/// Adds `amount` to the steps between `begin` and `end`, in proportion to the time in each.
void spread(std::vector<double>& steps, double width, double begin, double end, double amount) {
  const double length = end - begin;
  if (length <= 0) return;
  const auto last = std::ssize(steps) - 1;
  for (auto i = std::min(last, static_cast<std::ptrdiff_t>(begin / width)); i <= last; ++i) {
    const double from = std::max(begin, static_cast<double>(i) * width);
    const double to = std::min(end, static_cast<double>(i + 1) * width);
    if (to <= from) break;
    steps[static_cast<std::size_t>(i)] += amount * (to - from) / length;
  }
}

std::vector<double> rounded(std::vector<double> values, double step) {
  for (double& value : values) value = std::round(value / step) * step;
  return values;
}

nlohmann::json curve_of(const LastRun& run) {
  const int count = static_cast<int>(std::clamp(run.seconds / 2, 1.0, double{kMostSteps}));
  const double width = run.seconds / count;
  std::vector<double> rate(static_cast<std::size_t>(count));
  std::vector<double> cores(rate);
  for (const RunSpan& span : run.spans) {
    spread(rate, width, span.begin, span.end, span.vertex_levels / width);
    spread(cores, width, span.begin, span.end, span.threads * (span.end - span.begin) / width);
  }
  const double most = std::ranges::max(rate);
  return {{"seconds", width},
          {"rate", rounded(std::move(rate), most > 0 ? std::ceil(most / kSignificant) : 1)},
          {"cores", rounded(std::move(cores), 0.01)}};
}

nlohmann::json core_time_of(const LastRun& run) {
  const auto cores = static_cast<double>(std::max<std::int64_t>(1, run.start.threads));
  double last_begin = 0;
  for (const RunSpan& span : run.spans) last_begin = std::max(last_begin, span.begin);
  double taken = 0;
  double taken_at_end = 0;  // after the last job had begun
  for (const RunSpan& span : run.spans) {
    taken += span.threads * (span.end - span.begin);
    taken_at_end += span.threads * std::max(0.0, span.end - std::max(span.begin, last_begin));
  }
  const double all = run.seconds * cores;
  const double had = std::clamp(taken / all, 0.0, 1.0);
  const double computing = std::clamp(run.cpu_seconds / all, 0.0, had);
  const double tail =
      std::clamp(((run.seconds - last_begin) * cores - taken_at_end) / all, 0.0, 1 - had);
  return {{"computing", computing},
          {"waiting", had - computing},
          {"held", 1 - had - tail},
          {"tail", tail}};
}

}  // namespace

nlohmann::json figures_of(const LastRun& run) {
  double vertex_levels = 0;
  for (const RunSpan& span : run.spans) vertex_levels += span.vertex_levels;
  nlohmann::json figures = {{"started", run.started},
                            {"seconds", run.seconds},
                            {"version", run.start.version},
                            {"host", run.start.host},
                            {"threads", run.start.threads},
                            {"ended", run.ended},
                            {"up_to_date", run.start.up_to_date},
                            {"cpu_seconds", run.cpu_seconds},
                            {"peak_bytes", run.peak_bytes}};
  if (!run.start.passed_over.empty()) figures["passed_over"] = run.start.passed_over;
  if (run.seconds > 0) figures["vertex_levels_per_second"] = vertex_levels / run.seconds;
  if (run.seconds < kLeastSeconds) return figures;
  figures["core_time"] = core_time_of(run);
  if (vertex_levels > 0) figures["curve"] = curve_of(run);
  return figures;
}

}  // namespace semigeo::jobs
