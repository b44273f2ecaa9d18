#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/child_process.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/file_digest.hpp"
#include "jobs/archive/utc_time.hpp"
#include "jobs/bench/bench_json.hpp"
#include "jobs/bench/session.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/temporary_folder.hpp"
#include "jobs/cli/version.hpp"
#include "jobs/run/drain.hpp"
#include "jobs/stages/chosen_instruction_set.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

/// Holds the options of the command.
struct BenchOptions {
  bool quick = false;
  std::string filter;
  int threads = 0;
  fs::path scan;
  std::string format = "table";
  bool json = false;
  fs::path output;
  fs::path baseline;
  std::optional<double> fail_below;
  bool list = false;
};

/// Shows on a terminal what is being measured, and asks to stop after Ctrl-C.
class BenchProgress {
 public:
  ~BenchProgress() { clear(); }
  bool operator()(int done, int total, const std::string& name) {
    if (terminal_ && total == 0) std::fprintf(stderr, "\r\033[Kpreparing %s", name.c_str());
    if (terminal_ && total > 0)
      std::fprintf(stderr, "\r\033[K%d of %d: %s", done, total, name.c_str());
    return drain_.requests() == 0;
  }
  void clear() const {
    if (terminal_) std::fprintf(stderr, "\r\033[K");
  }

 private:
  engine::ChildProcesses children_;  // there are none: the drain only counts
  Drain drain_{children_};
  bool terminal_ = isatty(STDERR_FILENO) == 1;
};

nlohmann::json document_of(const BenchReport& report, const std::string& format) {
  return format == "github" ? github_document(report) : google_document(report);
}

/// Prints the report, and writes it to the file that was asked for.
void print(const BenchReport& report, const BenchOptions& options) {
  const bool table = options.format == "table";
  if (!options.output.empty())
    io::write_file_atomically(options.output, text_of(document_of(report, options.format)));
  if (table || !options.output.empty())
    std::fputs(table_of(report).c_str(), stdout);
  else
    print_document(document_of(report, options.format));
}

/// Compares with the baseline and says what fell. What seems to have fallen is measured again.
/// Returns whether something fell.
bool compare_with_baseline(BenchSession& session, const BenchOptions& options,
                           const std::vector<NamedRate>& before, BenchReport& report,
                           std::string& text) {
  std::vector<ComparedRate> fell;
  if (options.fail_below) fell = session.confirm(report.measurement, before, *options.fail_below);
  text = table_of(compare(before, rates_of(report.measurement, report.machine.machine_cores)));
  if (options.fail_below) text += fallen_text(fell, *options.fail_below);
  return !fell.empty();
}

BenchReport new_report(const BenchOptions& options, const fs::path& folder) {
  BenchReport report;
  report.machine = describe_machine(folder);
  report.version = SEMIGEO_VERSION;
  report.build = build_text();
  report.instruction_sets = supported_instruction_sets();
  report.instruction_set = kernels::name_of(chosen_instruction_set());
  report.date = utc_time();
  report.quick = options.quick;
  report.scan = options.scan.string();
  return report;
}

/// Measures, prints, and returns the exit code.
int bench(const BenchOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<NamedRate> before;
  const std::string scan_xxh3 = options.scan.empty() ? "" : io::xxh3_of_file(options.scan);
  if (!options.baseline.empty())
    before = read_baseline(options.baseline, {.quick = options.quick, .scan_xxh3 = scan_xxh3});
  const TemporaryFolder folder;
  BenchReport report = new_report(options, folder.path());
  report.scan_xxh3 = scan_xxh3;
  BenchProgress progress;
  const int cores = report.machine.usable_cores;
  BenchSession session({.quick = options.quick,
                        .filter = options.filter,
                        .threads = options.threads == 0 ? cores : options.threads,
                        .scan = options.scan,
                        .program = fs::read_symlink("/proc/self/exe"),
                        .folder = folder.path(),
                        .machine_cores = report.machine.machine_cores,
                        .progress = [&](int done, int total, const std::string& name) {
                          return progress(done, total, name);
                        }});
  if (options.list) {
    for (const std::string& name : session.names()) std::printf("%s\n", name.c_str());
    return kAllDone;
  }
  report.measurement = session.measure();
  std::string comparison;
  bool fell = false;
  if (!before.empty() && report.measurement.complete)
    fell = compare_with_baseline(session, options, before, report, comparison);
  progress.clear();
  if (!report.measurement.complete) {
    std::fprintf(stderr, "semigeo: stopped before everything was measured\n");
    return kStoppedEarly;
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  print(report, options);
  // Documents stay alone on standard output.
  const bool document = options.format != "table" && options.output.empty();
  std::fputs(comparison.c_str(), document ? stderr : stdout);
  return fell ? kSomeFailed : kAllDone;
}

/// Measures; what the user got wrong is exit code 2.
int bench_or_usage(const BenchOptions& options) {
  try {
    return bench(options);
  } catch (const std::invalid_argument& e) {
    throw CLI::ValidationError("--filter", e.what());
  } catch (const BaselineError& e) {
    throw CLI::ValidationError("--baseline", e.what());
  }
}

void add_options(CLI::App* command, BenchOptions& options) {
  command->add_flag("--quick", options.quick, "In 10 seconds, on smaller surfaces");
  command->add_option("--filter", options.filter,
                      "Only figures whose name has this regular expression in it; figures of the\n"
                      "machine are always measured");
  command
      ->add_option("--threads", options.threads,
                   "Measure on 1 thread and on so many. 0: one per core")
      ->check(CLI::Range(0, 4096));
  command
      ->add_option("--scan", options.scan,
                   "A scan of yours, instead of the built-in surface that is like one")
      ->check(CLI::ExistingFile);
  command
      ->add_option("--format", options.format,
                   "A table, the JSON of Google Benchmark, or that of github-action-benchmark")
      ->check(CLI::IsMember({"table", "json", "github"}));
  command->add_flag("--json", options.json, "The same as --format json");
  command->add_option("-o,--output", options.output,
                      "Write JSON into this file, and print the table");
  CLI::Option* baseline = command
                              ->add_option("--baseline", options.baseline,
                                           "Compare with this file, which --json has made")
                              ->check(CLI::ExistingFile);
  command
      ->add_option("--fail-below", options.fail_below,
                   "End with 1 if a figure is below this share of the baseline, beyond the spread\n"
                   "of both; it is measured twice before that")
      ->check(CLI::Range(0.01, 1.0))
      ->needs(baseline);
  command->add_flag("--list", options.list, "Name the figures and measure nothing");
}

}  // namespace

void add_bench(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = app.add_subcommand("bench", "Measure how fast this machine is");
  command->footer(
      "Examples:\n"
      "  semigeo bench                          everything, in under a minute\n"
      "  semigeo bench --quick --filter level/  levels only\n"
      "  semigeo bench --scan skull.ply         with a scan of yours\n"
      "  semigeo bench --output base.json       a table here, JSON for later\n"
      "  semigeo bench --baseline base.json --fail-below 0.9   is this build slower?\n"
      "  semigeo bench --format github          for github-action-benchmark, customBiggerIsBetter\n"
      "\n"
      "Every figure is a rate: more is better. Files are made in a temporary folder (TMPDIR), so\n"
      "its disk is measured. Exit codes: 0 measured, 1 something fell, 2 usage, 75 interrupted.\n");
  add_options(command, *options);
  command->callback([options, &exit_code] {
    if (options->json) options->format = "json";
    exit_code = bench_or_usage(*options);
  });
}

}  // namespace semigeo::jobs::cli
