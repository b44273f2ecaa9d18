#include "bench/evolution/scan_report.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/support/quoted.hpp"
#include "bench/support/svg_plot.hpp"

namespace semigeo::evolution {
namespace {

/// Describes a time before level 0 and its name in tables.
struct Stretch {
  const char* name;
  Seconds ScanReport::*seconds;
};
constexpr Stretch kStretches[] = {
    {"reading", &ScanReport::reading},   {"repair", &ScanReport::repair},
    {"filling", &ScanReport::filling},   {"decimation", &ScanReport::decimation},
    {"ordering", &ScanReport::ordering}, {"normals", &ScanReport::normals},
};

bench::Plot plot(const std::vector<ScanReport>& scans, const char* title,
                 double (*value)(const LevelReport&), bool relative) {
  bench::Plot result{title, "level", relative ? "share of level 0" : "", {}};
  for (const ScanReport& scan : scans) {
    bench::Series series{scan.name, {}};
    const double unit = relative ? value(scan.levels.front()) : 1;
    for (std::size_t k = 0; k < scan.levels.size(); ++k)
      series.points.emplace_back(static_cast<double>(k), value(scan.levels[k]) / unit);
    result.series.push_back(std::move(series));
  }
  return result;
}

}  // namespace

Seconds ScanReport::smoothing() const {
  Seconds sum;
  for (const LevelReport& level : levels) sum += level.smoothing;
  return sum;
}

Seconds ScanReport::remeshing() const {
  Seconds sum;
  for (const LevelReport& level : levels) sum += level.remeshing;
  return sum;
}

void print(const ScanReport& scan) {
  std::printf("%s: %lld vertices;", scan.name.c_str(),
              static_cast<long long>(scan.scanned_vertices));
  for (const Stretch& stretch : kStretches)
    if ((scan.*stretch.seconds).cpu > 0)
      std::printf(" %s %.3g s", stretch.name, (scan.*stretch.seconds).cpu);
  std::printf("\n%5s %9s %9s %6s %8s %7s %7s %11s %11s %8s %7s %9s %5s %7s %8s %8s\n", "level",
              "vertices", "triangles", "parts", "boundary", "moved", "since 0", "volume", "area",
              "shortest", "split", "collapsed", "torn", "dropped", "remesh s", "smooth s");
  for (std::size_t k = 0; k < scan.levels.size(); ++k) {
    const LevelReport& r = scan.levels[k];
    std::printf("%5zu %9lld %9lld %6lld %8lld %7.3f %7.3f %11.6g %11.6g %8.3g", k,
                static_cast<long long>(r.vertices), static_cast<long long>(r.triangles),
                static_cast<long long>(r.parts), static_cast<long long>(r.boundary_edges), r.moved,
                r.moved_from_first, r.volume, r.area, r.shortest_edge);
    std::printf(" %7lld %9lld %5lld %7lld %8.3f %8.3f\n", static_cast<long long>(r.remeshed.split),
                static_cast<long long>(r.remeshed.collapsed),
                static_cast<long long>(r.remeshed.torn),
                static_cast<long long>(r.remeshed.dropped_parts), r.remeshing.cpu, r.smoothing.cpu);
  }
  const Seconds smoothing = scan.smoothing();
  const Seconds remeshing = scan.remeshing();
  std::printf(
      "smoothing %.3g s (%.3g s wall), remeshing %.3g s (%.3g s wall), of the smoothing %.0f "
      "%%\n\n",
      smoothing.cpu, smoothing.wall, remeshing.cpu, remeshing.wall,
      100 * remeshing.cpu / smoothing.cpu);
}

std::string csv(const std::vector<ScanReport>& scans) {
  std::string text = "scan,level";
  for (const Column& column : columns()) text += std::string(",") + column.name;
  text += "\n";
  for (const ScanReport& scan : scans)
    for (std::size_t k = 0; k < scan.levels.size(); ++k) {
      text += bench::quoted(scan.name) + "," + std::to_string(k);
      for (const Column& column : columns()) {
        char cell[40];
        std::snprintf(cell, sizeof cell, column.whole ? ",%.0f" : ",%.9g",
                      column.value(scan.levels[k]));
        text += cell;
      }
      text += "\n";
    }
  return text;
}

std::string json(const std::vector<ScanReport>& scans) {
  auto list = nlohmann::json::array();
  for (const ScanReport& scan : scans) {
    nlohmann::json entry = {{"name", scan.name}, {"scanned_vertices", scan.scanned_vertices}};
    const auto add = [&entry](const std::string& stretch, const Seconds& seconds) {
      entry[stretch + "_seconds"] = seconds.wall;
      entry[stretch + "_cpu_seconds"] = seconds.cpu;
    };
    for (const Stretch& stretch : kStretches) add(stretch.name, scan.*stretch.seconds);
    add("smoothing", scan.smoothing());
    add("remeshing", scan.remeshing());
    for (const LevelReport& level : scan.levels) {
      nlohmann::json row = nlohmann::json::object();
      for (const Column& column : columns()) {
        const double value = column.value(level);
        row[column.name] =
            column.whole ? nlohmann::json(std::llround(value)) : nlohmann::json(value);
      }
      entry["levels"].push_back(std::move(row));
    }
    list.push_back(std::move(entry));
  }
  // File names need not be UTF-8 but JSON must.
  return nlohmann::json{{"scans", list}}.dump(2, ' ', false,
                                              nlohmann::json::error_handler_t::replace) +
         "\n";
}

std::string plots(const std::vector<ScanReport>& scans) {
  const auto area = [](const LevelReport& r) { return r.area; };
  const auto volume = [](const LevelReport& r) { return r.volume; };
  const auto parts = [](const LevelReport& r) { return static_cast<double>(r.parts); };
  return bench::svg({plot(scans, "Area", area, true), plot(scans, "Volume", volume, true),
                     plot(scans, "Parts", parts, false)},
                    3, "scan");
}

}  // namespace semigeo::evolution
