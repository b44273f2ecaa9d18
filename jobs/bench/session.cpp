#include "jobs/bench/session.hpp"

#include <algorithm>
#include <regex>
#include <stdexcept>

#include "jobs/bench/report.hpp"

namespace semigeo::jobs {
namespace {

/// All repetitions together take so many seconds on two free cores.
constexpr double kSeconds = 45;
constexpr double kQuickSeconds = 8;

std::string full_name(const BenchCase& bench) {
  return Figure{.name = bench.name, .threads = bench.threads}.full_name();
}

/// Leaves the cases of the machine, and those whose names have the filter in them.
void choose(std::vector<BenchCase>& cases, const std::string& filter) {
  if (filter.empty()) return;
  try {
    const std::regex expression(filter);
    const auto matches = [&](const BenchCase& bench) {
      return std::regex_search(full_name(bench), expression);
    };
    if (std::ranges::none_of(cases, matches))
      throw std::invalid_argument("no figure has " + filter +
                                  " in its name; `semigeo bench --list` names them");
    std::erase_if(cases, [&](const BenchCase& bench) {
      return !is_of_machine(bench.name) && !matches(bench);
    });
  } catch (const std::regex_error&) {
    throw std::invalid_argument(filter + " is no regular expression");
  }
}

}  // namespace

BenchSession::BenchSession(const SessionSettings& settings) : settings_(settings) {
  const auto inputs = std::make_shared<BenchInputs>(settings.folder, settings.program,
                                                    settings.scan, bench_sizes(settings.quick));
  std::vector<int> threads = {1};
  if (settings.threads > 1) threads.push_back(settings.threads);
  cases_ = all_cases(inputs, threads);
  choose(cases_, settings.filter);
}

std::vector<std::string> BenchSession::names() const {
  std::vector<std::string> names;
  for (const BenchCase& bench : cases_) names.push_back(full_name(bench));
  return names;
}

Measurement BenchSession::measure() {
  return measure(cases_, settings_.quick ? kQuickSeconds : kSeconds);
}

Measurement BenchSession::measure(const std::vector<BenchCase>& cases, double seconds) {
  const RepetitionLimits limits = {
      .least = settings_.quick ? 3 : 5, .most = settings_.quick ? 7 : 15, .seconds = seconds};
  return jobs::measure(cases, workers_,
                       {.repetitions = limits,
                        .least_seconds = settings_.quick ? 0.01 : 0.03,
                        .machine_cores = settings_.machine_cores,
                        .progress = settings_.progress});
}

std::vector<ComparedRate> BenchSession::confirm(Measurement& measurement,
                                                const std::vector<NamedRate>& before,
                                                double bound) {
  const std::vector<ComparedRate> first =
      fallen(compare(before, rates_of(measurement, settings_.machine_cores)), bound);
  const auto is_suspect = [&](const std::string& name) {
    return std::ranges::find(first, name, &ComparedRate::name) != first.end();
  };
  std::vector<BenchCase> suspects;
  for (const BenchCase& bench : cases_)
    if (is_suspect(full_name(bench))) suspects.push_back(bench);
  if (suspects.empty()) return {};
  const Measurement again = measure(suspects, (settings_.quick ? kQuickSeconds : kSeconds) / 5);
  for (const Figure& figure : again.figures) {
    auto& all =
        std::ranges::find(measurement.figures, figure.full_name(), &Figure::full_name)->repetitions;
    all.insert(all.end(), figure.repetitions.begin(), figure.repetitions.end());
  }
  measurement.complete = measurement.complete && again.complete;
  return fallen(compare(before, rates_of(again, settings_.machine_cores)), bound);
}

}  // namespace semigeo::jobs
