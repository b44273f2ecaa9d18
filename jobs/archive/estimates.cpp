#include "jobs/archive/estimates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "io/files/error.hpp"
#include "io/files/small_file.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using Rates = Estimates::Rates;

constexpr const char* kFileName = "estimates.json";
constexpr double kBaseBytes = 30e6;
constexpr double kMemorySafety = 1.4;
constexpr double kBaseSeconds = 0.02;
constexpr double kMemoryBytes = 500;
constexpr double kMicroseconds = 6;
constexpr double kUnknownFileBytes =
    20;                          // formats that are not listed; gives rather too many vertices
constexpr double kMostOff = 20;  // largest factor between a learned rate and the built-in one
constexpr std::size_t kFewestJobs = 3;
constexpr std::size_t kMostJobs = 200;
/// The least number of vertices of a scan from which rates are learned. In smaller scans the
/// constant costs dominate.
constexpr std::int64_t kFewestVertices = 5000;

/// The bytes of a file for each vertex, with its two triangles.
struct FormatRate {
  std::string_view format;
  double bytes;
};
constexpr std::array<FormatRate, 14> kFormats = {{
    {"PLY binary", 38},  // 12 and two faces of 13
    {"PLY ascii", 70},
    {"OBJ", 70},
    {"OFF", 70},
    {"OFF binary", 52},
    {"STL binary", 100},
    {"STL ascii", 500},
    {"PLY binary, gzip", 22},
    {"PLY ascii, gzip", 25},
    {"OBJ, gzip", 25},
    {"OFF, gzip", 25},
    {"OFF binary, gzip", 25},
    {"STL binary, gzip", 40},
    {"STL ascii, gzip", 60},
}};

double built_in_file_bytes(const std::string& format) {
  const std::size_t compression = format.find(", ");
  const std::string known = compression == std::string::npos
                                ? format
                                : format.substr(0, compression) + ", gzip";  // or a denser one
  const auto* const found = std::ranges::find(kFormats, known, &FormatRate::format);
  return found == kFormats.end() ? kUnknownFileBytes : found->bytes;
}

/// A rate that was measured, and its weight.
struct MeasuredRate {
  double rate;
  double weight;
};

bool is_credible(double rate, double built_in) {
  return rate >= built_in / kMostOff && rate <= built_in * kMostOff;
}

/// Returns the weighted median of the rates, or nothing if there are too few.
std::optional<double> median(std::vector<MeasuredRate> rates) {
  if (rates.size() < kFewestJobs) return std::nullopt;
  std::ranges::sort(rates, {}, &MeasuredRate::rate);
  double weight = 0;
  for (const MeasuredRate& measured : rates) weight += measured.weight;
  double below = 0;
  for (const MeasuredRate& measured : rates) {
    below += measured.weight;
    if (2 * below >= weight) return measured.rate;
  }
  return rates.back().rate;
}

/// Returns the median of `rate` over the jobs for which it is credible.
template <typename Rate>
std::optional<double> learn(std::span<const JobEnded> jobs, double built_in, const Rate& rate) {
  std::vector<MeasuredRate> rates;
  for (const JobEnded& job : jobs) {
    const double measured = rate(job);
    if (is_credible(measured, built_in))
      rates.push_back({measured, static_cast<double>(job.vertices)});
  }
  return median(std::move(rates));
}

Rates learn_costs(std::span<const JobEnded> jobs) {
  Rates rates;
  rates.memory_bytes = learn(jobs, kMemoryBytes, [](const JobEnded& job) {
    return (job.peak_bytes - kBaseBytes) / static_cast<double>(job.vertices);
  });
  rates.microseconds = learn(jobs, kMicroseconds, [](const JobEnded& job) {
    return 1e6 * (job.seconds - kBaseSeconds) * static_cast<double>(job.threads) /
           (static_cast<double>(job.vertices) * static_cast<double>(job.levels));
  });
  return rates;
}

nlohmann::json json_of(const Rates& rates) {
  nlohmann::json document = nlohmann::json::object();
  if (rates.file_bytes) document["file_bytes_per_vertex"] = *rates.file_bytes;
  if (rates.memory_bytes) document["memory_bytes_per_vertex"] = *rates.memory_bytes;
  if (rates.microseconds) document["microseconds_per_vertex_and_level"] = *rates.microseconds;
  return document;
}

Rates rates_in(const nlohmann::json& document, const std::string& format) {
  const auto rate = [&](const char* name, double built_in) -> std::optional<double> {
    const auto found = document.find(name);
    if (found == document.end() || !is_credible(found->get<double>(), built_in))
      return std::nullopt;
    return found->get<double>();
  };
  return {.file_bytes = rate("file_bytes_per_vertex", built_in_file_bytes(format)),
          .memory_bytes = rate("memory_bytes_per_vertex", kMemoryBytes),
          .microseconds = rate("microseconds_per_vertex_and_level", kMicroseconds)};
}

constexpr io::TextBounds kBounds = {.bytes = std::int64_t{1} << 20, .depth = 3};

}  // namespace

Estimates::Estimates(std::map<std::string, Rates> by_format, Rates all)
    : by_format_(std::move(by_format)), all_(all) {}

Estimates Estimates::read(const fs::path& archive) {
  try {
    const auto document = io::read_json(archive / kFileName, kBounds);
    std::map<std::string, Rates> by_format;
    for (const auto& [format, rates] : document.at("formats").items())
      by_format[format] = rates_in(rates, format);
    return {std::move(by_format), rates_in(document.at("all"), "")};
  } catch (const nlohmann::json::exception&) {
    return {};
  } catch (const io::Error&) {
    return {};  // they are learned again
  }
}

Estimate Estimates::of(const ScanSize& scan, int levels, int threads) const {
  const auto found = by_format_.find(scan.format);
  const Rates rates = found == by_format_.end() ? Rates{} : found->second;
  const double vertices =
      static_cast<double>(scan.bytes) / rates.file_bytes.value_or(built_in_file_bytes(scan.format));
  return of(vertices, rates, levels, threads);
}

Estimate Estimates::of(double vertices, int levels, int threads) const {
  return of(vertices, {}, levels, threads);
}

Estimate Estimates::of(double vertices, const Rates& rates, int levels, int threads) const {
  const auto known = [&](std::optional<double> Rates::*rate, double built_in) {
    return (rates.*rate).value_or((all_.*rate).value_or(built_in));
  };
  return {.vertices = vertices,
          .peak_bytes =
              (kBaseBytes + known(&Rates::memory_bytes, kMemoryBytes) * vertices) * kMemorySafety,
          .seconds = kBaseSeconds + 1e-6 * known(&Rates::microseconds, kMicroseconds) * vertices *
                                        std::max(levels, 1) / std::max(threads, 1)};
}

void Estimates::write(const fs::path& archive) const {
  nlohmann::json formats = nlohmann::json::object();
  for (const auto& [format, rates] : by_format_) formats[format] = json_of(rates);
  const nlohmann::json document = {{"all", json_of(all_)}, {"formats", formats}};
  const std::string text =
      document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
  io::write_if_different(archive / kFileName, text);
}

void EstimateLearner::add(const JobEnded& job) {
  const bool whole = job.state == "done" && !job.format.empty() && job.input_bytes > 0 &&
                     job.levels > 0 && job.threads > 0 && std::isfinite(job.seconds) &&
                     std::isfinite(job.peak_bytes);
  if (!whole || job.vertices < kFewestVertices) return;
  std::deque<JobEnded>& jobs = jobs_[job.format];
  jobs.push_back(job);
  if (jobs.size() > kMostJobs) jobs.pop_front();
}

Estimates EstimateLearner::learned() const {
  std::map<std::string, Rates> by_format;
  std::vector<JobEnded> all;
  for (const auto& [format, last] : jobs_) {
    const std::vector<JobEnded> jobs(last.begin(), last.end());
    Rates rates = learn_costs(jobs);
    rates.file_bytes = learn(jobs, built_in_file_bytes(format), [](const JobEnded& job) {
      return static_cast<double>(job.input_bytes) / static_cast<double>(job.vertices);
    });
    if (rates != Rates{}) by_format[format] = rates;
    std::ranges::copy(jobs, std::back_inserter(all));
  }
  return {std::move(by_format), learn_costs(all)};
}

Estimates learn_estimates(const fs::path& archive) {
  EstimateLearner learner;
  read_journal(archive, [&](const JournalEntry& entry) {
    if (const auto* ended = std::get_if<JobEnded>(&entry.event)) learner.add(*ended);
  });
  return learner.learned();
}

}  // namespace semigeo::jobs
