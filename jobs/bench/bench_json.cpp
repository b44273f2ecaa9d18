#include "jobs/bench/bench_json.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "jobs/bench/inputs.hpp"

namespace semigeo::jobs {
namespace {

using nlohmann::json;

json context_of(const BenchReport& report) {
  const MachineDescription& machine = report.machine;
  const MachineLoad& load = report.measurement.load;
  return {{"date", report.date},
          {"host_name", machine.host},
          {"executable", "semigeo"},
          {"num_cpus", machine.usable_cores},
          {"library_build_type", "release"},
          {"load_avg", {load.load_before, load.load_after}},
          {"caches", json::array()},
          {"json_schema_version", 1},
          {"semigeo_version", report.version},
          {"semigeo_build", report.build},
          {"workload", kBenchWorkload},
          {"quick", report.quick},
          {"scan", report.scan},
          {"scan_xxh3", report.scan_xxh3},
          {"processor", machine.processor},
          {"instruction_set", report.instruction_set},
          {"instruction_sets", report.instruction_sets},
          {"machine_cores", machine.machine_cores},
          {"memory_bytes", machine.usable_bytes},
          {"system", machine.system},
          {"file_system", machine.file_system},
          {"other_cores", load.other_cores},
          {"most_other_cores", load.most_other_cores},
          {"stolen", load.stolen},
          {"seconds", report.seconds}};
}

/// Holds the times of one repetition, or an aggregate of many.
struct Times {
  double real = 0;  ///< In milliseconds for one call.
  double cpu = 0;
  double rate = 0;
};

Times times_of(const BenchRepetition& repetition) {
  return {.real = 1e3 * repetition.seconds / repetition.calls,
          .cpu = 1e3 * repetition.cpu_seconds / repetition.calls,
          .rate = repetition.rate()};
}

json entry_of(const Figure& figure, const Times& times) {
  return {{"run_name", figure.full_name()},
          {"threads", figure.threads},
          {"repetitions", figure.repetitions.size()},
          {"real_time", times.real},
          {"cpu_time", times.cpu},
          {"time_unit", "ms"},
          {"items_per_second", times.rate},
          {"label", figure.unit},
          {"bound", name_of(figure.bound)}};
}

json repetition_entry(const Figure& figure, int family, std::size_t index) {
  const BenchRepetition& repetition = figure.repetitions[index];
  json entry = entry_of(figure, times_of(repetition));
  entry["name"] = figure.full_name();
  entry["run_type"] = "iteration";
  entry["family_index"] = family;
  entry["per_family_instance_index"] = 0;
  entry["repetition_index"] = index;
  entry["iterations"] = repetition.calls;
  entry["other_cores"] = repetition.other_cores;
  if (repetition.work.vertex_levels > 0)
    entry["microseconds_per_vertex_level"] =
        1e6 * repetition.seconds / repetition.work.vertex_levels;
  return entry;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double deviation_of(const std::vector<double>& values) {
  if (values.size() < 2) return 0;
  const double mean = mean_of(values);
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

/// Applies a function to the times and rates of all repetitions.
template <typename Function>
Times over_repetitions(const Figure& figure, const Function& function) {
  std::vector<double> real, cpu, rates;
  for (const BenchRepetition& repetition : figure.repetitions) {
    const Times times = times_of(repetition);
    real.push_back(times.real);
    cpu.push_back(times.cpu);
    rates.push_back(times.rate);
  }
  return {.real = function(real), .cpu = function(cpu), .rate = function(rates)};
}

void add_aggregates(json& benchmarks, const Figure& figure, int family) {
  const auto share = [](const std::vector<double>& values) {
    const double mean = mean_of(values);
    return mean == 0 ? 0 : deviation_of(values) / mean;
  };
  const auto median = [](const std::vector<double>& values) { return median_of(values); };
  const std::pair<const char*, Times> aggregates[] = {
      {"mean", over_repetitions(figure, mean_of)},
      {"median", over_repetitions(figure, median)},
      {"stddev", over_repetitions(figure, deviation_of)},
      {"cv", over_repetitions(figure, share)}};
  for (const auto& [name, times] : aggregates) {
    json entry = entry_of(figure, times);
    entry["name"] = figure.full_name() + "_" + name;
    entry["run_type"] = "aggregate";
    entry["aggregate_name"] = name;
    entry["aggregate_unit"] = std::string(name) == "cv" ? "percentage" : "time";
    entry["family_index"] = family;
    entry["per_family_instance_index"] = 0;
    entry["iterations"] = figure.repetitions.size();
    benchmarks.push_back(std::move(entry));
  }
}

}  // namespace

json google_document(const BenchReport& report) {
  json benchmarks = json::array();
  int family = 0;
  for (const Figure& figure : report.measurement.figures) {
    if (figure.repetitions.empty()) continue;
    for (std::size_t i = 0; i < figure.repetitions.size(); ++i)
      benchmarks.push_back(repetition_entry(figure, family, i));
    add_aggregates(benchmarks, figure, family++);
  }
  return {{"context", context_of(report)}, {"benchmarks", benchmarks}};
}

json github_document(const BenchReport& report) {
  json list = json::array();
  for (const Figure& figure : report.measurement.figures) {
    const Spread rate = figure.rate();
    const std::string range = "± " + figure_number((rate.high - rate.low) / 2);
    list.push_back({{"name", figure.full_name()},
                    {"unit", figure.unit},
                    {"value", rate.median},
                    {"range", range},
                    {"extra", "bounded by: " + std::string(name_of(figure.bound)) +
                                  "\nrepetitions: " + std::to_string(figure.repetitions.size())}});
  }
  return list;
}

std::vector<NamedRate> read_baseline(const std::filesystem::path& path,
                                     const BenchConditions& conditions) {
  const auto refuse = [&](const std::string& problem) {
    throw BaselineError(path.string() + " " + problem +
                        "; make it with `semigeo bench --json` and the same options");
  };
  std::vector<NamedRate> result;
  try {
    std::ifstream file(path, std::ios::binary);
    const json document = json::parse(file);
    const json& context = document.at("context");
    if (context.at("workload") != kBenchWorkload || context.at("quick") != conditions.quick ||
        context.at("scan_xxh3") != conditions.scan_xxh3)
      refuse("was measured on other surfaces");
    std::map<std::string, std::vector<double>> rates, cpu_rates;
    for (const json& entry : document.at("benchmarks")) {
      if (entry.at("run_type") != "iteration") continue;
      const std::string name = entry.at("run_name");
      const double rate = entry.at("items_per_second");
      if (rates[name].empty()) result.push_back({.name = name, .unit = entry.at("label")});
      rates[name].push_back(rate);
      if (const double cpu_time = entry.at("cpu_time"); cpu_time > 0)
        cpu_rates[name].push_back(rate * entry.at("real_time").get<double>() / cpu_time);
    }
    for (NamedRate& rate : result) {
      rate.rate = spread_of(rates[rate.name]);
      rate.cpu_rate = median_of(cpu_rates[rate.name]);
    }
  } catch (const json::exception&) {
    refuse("has no rates of `semigeo bench`");
  }
  return result;
}

}  // namespace semigeo::jobs
