#include "bench/support/svg_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace semigeo::bench {
namespace {

constexpr double kPanelWidth = 340, kPanelHeight = 260;
constexpr double kLeft = 58, kRight = 12, kTop = 34, kBottom = 46;
// The least width of the legend, and the approximate width of one of its letters.
constexpr double kLegendWidth = 104, kLetterWidth = 6.5;
/// The ratio of the largest to the smallest value above which axes are logarithmic, because a
/// linear axis would hide the lower curves.
constexpr double kLogRatio = 20;

std::string number(double value, const char* format = "%.6g") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

/// Returns the colour of a curve, from dark blue by green to orange. All are dark enough for text,
/// and their brightness grows.
std::string colour(std::size_t i, std::size_t count) {
  static constexpr std::array<std::array<double, 3>, 4> kAnchors = {
      {{40, 30, 110}, {20, 120, 160}, {70, 160, 70}, {230, 120, 20}}};
  const double at = count < 2 ? 0 : 3.0 * static_cast<double>(i) / static_cast<double>(count - 1);
  const auto k = std::min<std::size_t>(2, static_cast<std::size_t>(at));
  std::array<int, 3> rgb{};
  for (int c = 0; c < 3; ++c)
    rgb[c] = static_cast<int>(
        std::lerp(kAnchors[k][c], kAnchors[k + 1][c], at - static_cast<double>(k)));
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", rgb[0] & 255, rgb[1] & 255, rgb[2] & 255);
  return text;
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text,
                    const std::string& more = "") {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\"" +
         more + ">" + escaped(text) + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& stroke) {
  return "<path d=\"M" + number(x1) + " " + number(y1) + "L" + number(x2) + " " + number(y2) +
         "\" stroke=\"" + stroke + "\"/>\n";
}

/// Maps values to pixels, and knows its ticks.
struct Axis {
  double low = 0, high = 1;  ///< Values, or their logarithms.
  double from = 0, to = 1;   ///< In pixels.
  bool logarithmic = false;
  std::vector<double> ticks;

  double at(double value) const {
    const double v = logarithmic ? std::log10(value) : value;
    return from + (to - from) * (v - low) / (high - low);
  }
};

/// Returns three to seven round numbers whose distance is 1, 2 or 5 times a power of ten.
Axis linear_axis(double low, double high, double from, double to) {
  if (!(high > low)) high = low + 1;
  const double power = std::pow(10, std::floor(std::log10((high - low) / 3)));
  double distance = power;
  for (const double factor : {2.0, 5.0})
    if ((high - low) / (factor * power) >= 3) distance = factor * power;
  Axis axis{low, high, from, to, false, {}};
  for (double k = std::ceil(low / distance - 1e-9) + 0.0; k * distance <= high + 1e-9 * distance;
       ++k)
    axis.ticks.push_back(k * distance);
  return axis;
}

/// Returns ticks at 1, 2 and 5 times the powers of ten, or at the powers alone if there would be
/// too many.
Axis log_axis(double low, double high, double from, double to) {
  Axis axis{std::log10(low) - 0.05, std::log10(high) + 0.05, from, to, true, {}};
  const bool sparse = axis.high - axis.low > 3;
  for (double k = std::floor(axis.low); k <= axis.high; ++k)
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10, k);
      const double v = std::log10(value);
      if ((factor == 1 || !sparse) && v >= axis.low && v <= axis.high) axis.ticks.push_back(value);
    }
  return axis;
}

bool drawable(const std::pair<double, double>& p) {
  return std::isfinite(p.first) && std::isfinite(p.second);
}

/// Holds the range of all points that can be drawn. An empty plot has none.
struct Extent {
  double x_low = std::numeric_limits<double>::infinity();
  double x_high = -x_low;
  double y_low = x_low;
  double y_high = -x_low;

  bool empty() const { return !(x_high >= x_low); }
  bool wide() const { return y_low > 0 && y_high > kLogRatio * y_low; }
};

Extent extent_of(const Plot& plot) {
  Extent e;
  for (const Series& series : plot.series)
    for (const auto& p : series.points) {
      if (!drawable(p)) continue;
      e.x_low = std::min(e.x_low, p.first);
      e.x_high = std::max(e.x_high, p.first);
      e.y_low = std::min(e.y_low, p.second);
      e.y_high = std::max(e.y_high, p.second);
    }
  return e;
}

struct Axes {
  Axis x, y;
};

Axes axes_of(const Plot& plot, bool logarithmic) {
  Extent e = extent_of(plot);
  if (e.empty()) e = {0, 1, 0, 1};
  const double bottom = kPanelHeight - kBottom;
  Axes axes{linear_axis(e.x_low, e.x_high, kLeft + 8, kPanelWidth - kRight - 8), {}};
  axes.y = logarithmic && e.y_low > 0
               ? log_axis(e.y_low, e.y_high, bottom, kTop)
               : linear_axis(0, e.y_high > 0 ? 1.08 * e.y_high : 1, bottom, kTop);
  return axes;
}

std::string frame(const Plot& plot, const Axes& axes) {
  const double bottom = kPanelHeight - kBottom, right = kPanelWidth - kRight;
  std::string result =
      text_at(kLeft, kTop - 14, "start", plot.title, " font-weight=\"bold\" font-size=\"13\"");
  for (const double tick : axes.y.ticks) {
    const double y = axes.y.at(tick);
    result += line(kLeft, y, right, y, "#dddddd");
    result += text_at(kLeft - 6, y + 4, "end", number(tick, "%.3g"));
  }
  for (const double tick : axes.x.ticks) {
    const double x = axes.x.at(tick);
    result += line(x, bottom, x, bottom + 4, "#444444");
    result += text_at(x, bottom + 17, "middle", number(tick, "%.3g"));
  }
  result += line(kLeft, bottom, right, bottom, "#444444");
  result += line(kLeft, bottom, kLeft, kTop, "#444444");
  result += text_at((kLeft + right) / 2, kPanelHeight - 10, "middle", plot.x_label);
  result += text_at(14, (kTop + bottom) / 2, "middle", plot.y_label,
                    " transform=\"rotate(-90 14 " + number((kTop + bottom) / 2) + ")\"");
  return result;
}

std::string curve(const Series& series, const Axes& axes, const std::string& stroke) {
  std::string path, marks;
  for (const auto& p : series.points) {
    if (!drawable(p)) continue;
    const std::string x = number(axes.x.at(p.first), "%.1f");
    const std::string y = number(axes.y.at(p.second), "%.1f");
    path += (path.empty() ? "M" : "L") + x + " " + y;
    marks += "<circle cx=\"" + x + "\" cy=\"" + y + "\" r=\"2.4\" fill=\"" + stroke + "\"/>\n";
  }
  if (path.empty()) return "";
  return "<path d=\"" + path + "\" fill=\"none\" stroke-width=\"1.6\" stroke=\"" + stroke +
         "\"/>\n" + marks;
}

std::string legend(const Plot& plot, const std::string& title, double x) {
  std::string result = text_at(x, kTop + 4, "start", title, " font-weight=\"bold\"");
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const double y = kTop + 24 + 18 * static_cast<double>(i);
    const std::string stroke = colour(i, plot.series.size());
    result += "<path d=\"M" + number(x) + " " + number(y - 4) +
              "h22\" stroke-width=\"2\" stroke=\"" + stroke + "\"/>\n<circle cx=\"" +
              number(x + 11) + "\" cy=\"" + number(y - 4) + "\" r=\"2.6\" fill=\"" + stroke +
              "\"/>\n";
    result += text_at(x + 28, y, "start", plot.series[i].label);
  }
  return result;
}

}  // namespace

std::string svg(const std::vector<Plot>& panels, int columns, const std::string& legend_title) {
  const int count = static_cast<int>(panels.size());
  const int rows = (count + columns - 1) / columns;
  std::size_t letters = 0;
  if (!panels.empty())
    for (const Series& series : panels[0].series) letters = std::max(letters, series.label.size());
  const double width = columns * kPanelWidth +
                       std::max(kLegendWidth, 44 + kLetterWidth * static_cast<double>(letters));
  const double longest = panels.empty() ? 0 : static_cast<double>(panels[0].series.size());
  const double height = std::max(rows * kPanelHeight, kTop + 24 + 18 * longest);
  std::string result = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(width) +
                       "\" height=\"" + number(height) + "\" viewBox=\"0 0 " + number(width) + " " +
                       number(height) +
                       "\" font-family=\"sans-serif\" font-size=\"11\" fill=\"#222222\">\n"
                       "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  const bool logarithmic =
      std::ranges::any_of(panels, [](const Plot& plot) { return extent_of(plot).wide(); });
  for (int i = 0; i < count; ++i) {
    const Plot& plot = panels[i];
    const Axes axes = axes_of(plot, logarithmic);
    result += "<g transform=\"translate(" + number(i % columns * kPanelWidth) + " " +
              number(i / columns * kPanelHeight) + ")\">\n" + frame(plot, axes);
    for (std::size_t s = 0; s < plot.series.size(); ++s)
      result += curve(plot.series[s], axes, colour(s, plot.series.size()));
    result += "</g>\n";
  }
  if (count > 0) result += legend(panels[0], legend_title, columns * kPanelWidth + 8);
  return result + "</svg>\n";
}

}  // namespace semigeo::bench
