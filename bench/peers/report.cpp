#include "bench/peers/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/support/svg_plot.hpp"

namespace semigeo::peers {
namespace {

/// Returns a number with two or three digits, or "-".
std::string number(double value, const char* format = "%.3g") {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string per_cent(double share) {
  return number(100 * share, "%.1f");
}

/// Returns the different values of a member, in the order in which they come.
std::vector<std::string> names(const std::vector<MethodRow>& rows, std::string MethodRow::*member) {
  std::vector<std::string> result;
  for (const MethodRow& row : rows)
    if (std::ranges::count(result, row.*member) == 0) result.push_back(row.*member);
  return result;
}

const MethodRow* find(const std::vector<MethodRow>& rows, const std::string& subject,
                      const MethodRow& method) {
  for (const MethodRow& row : rows)
    if (row.subject == subject && row.library == method.library && row.method == method.method)
      return &row;
  return nullptr;
}

std::string libraries_text(const Report& report) {
  std::string text;
  for (const Library& library : report.libraries)
    if (library.version.empty())
      text += "- " + library.name + " is left out: the package " + library.package +
              " was not installed when this program was built.\n";
    else
      text += "- " + library.name + ", " + library.version + "\n";
  return text;
}

std::string methods_table(const Report& report) {
  const auto subjects = names(report.methods, &MethodRow::subject);
  std::string head = "| method |", line = "|---|";
  for (const std::string& subject : subjects) {
    head += " " + subject + " |";
    line += "---|";
  }
  std::string text = head + "\n" + line + "\n";
  for (const MethodRow& first : report.methods) {
    if (first.subject != subjects.front()) break;
    text += "| " + first.library + ": " + first.method + " |";
    for (const std::string& subject : subjects) {
      const MethodRow* const row = find(report.methods, subject, first);
      text += " " + number(row->median_microseconds) + " / " + number(row->least_microseconds);
      if (std::isfinite(row->mean_error))
        text += "; " + number(row->gaussian_error, "%.2g") + ", " +
                number(row->mean_error, "%.2g") + " %";
      text += " |";
    }
    text += "\n";
  }
  return text;
}

/// Returns the rows of one method.
std::vector<AgreementRow> rows_of(const Report& report, const std::string& method) {
  std::vector<AgreementRow> result;
  for (const AgreementRow& row : report.agreement)
    if (row.method == method) result.push_back(row);
  return result;
}

constexpr const char* kOurs = "semigeo";
constexpr const char* kJets[] = {"jets of degree 2", "jets of degree 4"};

std::string agreement_table(const Report& report) {
  std::string text =
      "| method | size | us a vertex | RMS of H | RMS difference, % | median difference, % |\n"
      "|---|---|---|---|---|---|\n";
  for (const AgreementRow& row : report.agreement)
    text += "| " + row.method + " | " + number(row.size) + " | " + number(row.microseconds) +
            " | " + number(row.agreement.rms) + " | " + per_cent(row.agreement.rms_difference) +
            " | " + per_cent(row.agreement.median_difference) + " |\n";
  return text;
}

std::string cell(const AgreementRow& row) {
  if (!std::isfinite(row.size)) return " - | - |";
  return " " + per_cent(row.agreement.rms_difference) + " (" +
         per_cent(row.agreement.median_difference) + ") | " + number(row.microseconds) + " |";
}

/// Returns levels beside the jets that leave as much detail.
std::string equal_detail_table(const Report& report) {
  std::string text =
      "| level | RMS of H | ours, % | us | jets 2, % | us | jets 4, % | us |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const AgreementRow& row : rows_of(report, kOurs)) {
    text += "| " + number(row.size) + " | " + number(row.agreement.rms) + " |" + cell(row);
    for (const char* method : kJets)
      text += cell(at_equal_detail(rows_of(report, method), row.agreement.rms));
    text += "\n";
  }
  return text;
}

bench::Series series(const std::string& label, const std::vector<AgreementRow>& rows,
                     double most_detail, bool time) {
  bench::Series result{label, {}};
  for (const AgreementRow& row : rows)
    if (row.agreement.rms <= most_detail)
      result.points.emplace_back(row.agreement.rms,
                                 time ? row.microseconds : 100 * row.agreement.rms_difference);
  return result;
}

}  // namespace

std::string markdown(const Report& report) {
  std::string text = libraries_text(report);
  if (!report.methods.empty())
    text += "\nMedian / least CPU time of a vertex in us, " + std::to_string(report.rounds) +
            " runs in turns; median errors of K, H.\n\n" + methods_table(report);
  if (!report.agreement.empty())
    text += "\nAgreement of range views in H, " +
            std::to_string(report.agreement.front().agreement.places) + " places.\n\n" +
            agreement_table(report) + "\nAt equal detail: RMS difference (median difference).\n\n" +
            equal_detail_table(report);
  return text;
}

std::string json(const Report& report) {
  nlohmann::ordered_json document{{"rounds", report.rounds}};
  for (const Library& library : report.libraries)
    document["libraries"].push_back({{"name", library.name}, {"version", library.version}});
  for (const MethodRow& row : report.methods)
    document["methods"].push_back({{"subject", row.subject},
                                   {"library", row.library},
                                   {"method", row.method},
                                   {"median_microseconds", row.median_microseconds},
                                   {"least_microseconds", row.least_microseconds},
                                   {"gaussian_error_per_cent", row.gaussian_error},
                                   {"mean_error_per_cent", row.mean_error}});
  for (const AgreementRow& row : report.agreement)
    document["agreement"].push_back({{"method", row.method},
                                     {"size", row.size},
                                     {"microseconds", row.microseconds},
                                     {"places", row.agreement.places},
                                     {"rms", row.agreement.rms},
                                     {"rms_difference", row.agreement.rms_difference},
                                     {"median_difference", row.agreement.median_difference}});
  return document.dump(2) + "\n";
}

std::string chart(const Report& report) {
  const std::vector<AgreementRow> levels = rows_of(report, kOurs);
  double most = 0;
  for (const AgreementRow& row : levels) most = std::max(most, 1.05 * row.agreement.rms);
  bench::Plot apart{
      "Two scans of one object", "detail left: RMS of H, 1/m", "difference of H, %", {}};
  bench::Plot time{"Time", "detail left: RMS of H, 1/m", "µs a vertex", {}};
  for (bench::Plot* plot : {&apart, &time}) {
    const bool is_time = plot == &time;
    plot->series.push_back(series("semigeo, levels 0 to 8", levels, most, is_time));
    for (const char* method : kJets)
      plot->series.push_back(
          series(std::string("CGAL, ") + method, rows_of(report, method), most, is_time));
  }
  return bench::svg({apart, time}, 2, "method");
}

}  // namespace semigeo::peers
