#include "jobs/bench/report.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <string_view>

#include "jobs/run/progress.hpp"
#include "jobs/stages/surface_parameters.hpp"

namespace semigeo::jobs {
namespace {

constexpr double kNightHours = 10;

/// Returns a line as printf makes it.
[[gnu::format(printf, 1, 2)]] std::string line(const char* format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string percent(double share) {
  return line("%.*f %%", share < 0.1 ? 1 : 0, 100 * share);
}

std::string head_of(const BenchReport& report) {
  const MachineDescription& machine = report.machine;
  std::string text = line("%s, %d of %d cores, %.1f GB of memory; kernels use %s (of %s)\n",
                          machine.processor.c_str(), machine.usable_cores, machine.machine_cores,
                          static_cast<double>(machine.usable_bytes) * 1e-9,
                          report.instruction_set.c_str(), report.instruction_sets.c_str());
  text +=
      line("semigeo %s, %s; %s; files in %s (%s)\n", report.version.c_str(), report.build.c_str(),
           machine.system.c_str(), machine.temporary_folder.c_str(), machine.file_system.c_str());
  if (!report.scan.empty()) text += "scan: " + report.scan + "\n";
  return text + "\n";
}

std::string row_of(const Figure& figure) {
  const Spread rate = figure.rate();
  const double each = figure.microseconds_per_vertex_level();
  return line("%-22s %7d %9s %-15s %8s %4zu %12s  %s\n", figure.name.c_str(), figure.threads,
              figure_number(rate.median).c_str(), figure.unit.c_str(),
              percent(rate.relative()).c_str(), figure.repetitions.size(),
              each > 0 ? line("%.2f us", each).c_str() : "", name_of(figure.bound).data());
}

/// Returns what the machine does in a night at the rates of whole jobs on all threads.
std::string night_of(const Measurement& measurement) {
  const int levels = SurfaceParameters{}.levels + 1;
  std::string text;
  for (const Figure& figure : measurement.figures) {
    const bool more_threads = std::ranges::any_of(measurement.figures, [&](const Figure& other) {
      return other.name == figure.name && other.threads > figure.threads;
    });
    if (!figure.name.starts_with("job/") || more_threads || figure.repetitions.empty()) continue;
    const BenchWork& work = figure.repetitions.front().work;
    if (work.amount <= 0) continue;
    text +=
        line("%s%s like %s (%s vertices)", text.empty() ? "" : ", or ",
             figure_number(figure.rate().median * 3600 * kNightHours).c_str(), figure.name.c_str(),
             figure_number(work.vertex_levels / work.amount / levels).c_str());
  }
  if (text.empty()) return "";
  return line("\nA night of %.0f hours is enough for this number of scans: ", kNightHours) + text +
         ".\n";
}

std::string foot_of(const BenchReport& report) {
  const MachineLoad& load = report.measurement.load;
  std::string text = night_of(report.measurement);
  text += line("\nWhile it ran, other processes used %.1f of %d cores", load.other_cores,
               report.machine.machine_cores);
  if (!load.most_name.empty())
    text += line(", at most %.1f during %s", load.most_other_cores, load.most_name.c_str());
  text += line("; the hypervisor took %s; load average %.1f before, %.1f after.\n",
               percent(load.stolen).c_str(), load.load_before, load.load_after);
  if (load.was_busy())
    text += "The machine was not free: rates may be too low, and differences are uncertain.\n";
  text += line(
      "%s in all. Rates are medians; the spread is half of the range without its "
      "extremes.\n",
      short_duration(report.seconds).c_str());
  return text;
}

}  // namespace

std::vector<NamedRate> rates_of(const Measurement& measurement, int machine_cores) {
  std::vector<NamedRate> rates;
  for (const Figure& figure : measurement.figures)
    rates.push_back({.name = figure.full_name(),
                     .unit = figure.unit,
                     .rate = figure.rate(),
                     .cpu_rate = figure.cpu_rate(),
                     .disturbed = figure.was_disturbed(machine_cores)});
  return rates;
}

std::string table_of(const BenchReport& report) {
  std::string text = head_of(report);
  text += line("%-22s %7s %9s %-15s %8s %4s %12s  %s\n", "", "threads", "rate", "", "spread", "n",
               "vertex level", "bounded by");
  std::string_view group;
  for (const Figure& figure : report.measurement.figures) {
    const std::string_view name = figure.name;
    const std::string_view this_group = name.substr(0, name.find('/'));
    if (!group.empty() && this_group != group) text += '\n';
    group = this_group;
    text += row_of(figure);
  }
  return text + foot_of(report);
}

std::string table_of(const Comparison& comparison) {
  std::string text =
      line("%-32s %-15s %9s %9s %6s\n", "against the baseline", "", "before", "now", "ratio");
  for (const ComparedRate& rate : comparison.rates)
    text += line("%-32s %-15s %9s %9s %6.2f  %s\n", rate.name.c_str(), rate.unit.c_str(),
                 figure_number(rate.before.median).c_str(), figure_number(rate.now.median).c_str(),
                 rate.ratio(), rate.verdict());
  if (!comparison.only_now.empty())
    text += "not in the baseline: " + joined(comparison.only_now) + "\n";
  if (!comparison.only_then.empty())
    text += "only in the baseline: " + joined(comparison.only_then) + "\n";
  for (const ComparedRate& rate : comparison.rates)
    if (is_of_machine(rate.name) && rate.is_beyond_spread())
      text += line("The machine itself differs: %s is %.2f of the baseline.\n", rate.name.c_str(),
                   rate.ratio());
  return text;
}

std::string fallen_text(const std::vector<ComparedRate>& fell, double bound) {
  std::string text;
  for (const ComparedRate& rate : fell)
    text += line("fell: %s: %s %s, was %s (%.2f)\n", rate.name.c_str(),
                 figure_number(rate.now.median).c_str(), rate.unit.c_str(),
                 figure_number(rate.before.median).c_str(), rate.ratio());
  if (fell.empty()) text += line("No figure fell below %g of the baseline.\n", bound);
  return text;
}

std::string figure_number(double value) {
  if (value >= 999.5e6) return line("%.3g G", value * 1e-9);
  if (value >= 999.5e3) return line("%.3g M", value * 1e-6);
  if (value >= 9999.5) return line("%.3g k", value * 1e-3);
  if (value >= 999.5) return line("%.0f", value);
  return line("%.3g", value);
}

}  // namespace semigeo::jobs
