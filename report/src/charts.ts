// Small charts as SVG. The colours come from the style of the page.

const height = 180;
const left = 64;
const right = 12;
const top = 12;
const bottom = 40;

type Attributes = Record<string, string | number>;

function draw(into: Element, tag: string, attributes: Attributes, text = ""): SVGElement {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  if (text) made.textContent = text;
  into.append(made);
  return made;
}

export interface Axis {
  title: string;
  low: number;
  high: number;
  text: (value: number) => string;
}

export interface Chart {
  /// Width in units of a letter's height of 12; 640 if there is none.
  width?: number;
  /// The chart in one sentence, for those who do not see it.
  sentence: string;
  x: Axis;
  y: Axis;
}

/// Narrow pages get narrow charts, so that their texts stay readable.
const widthOf = (chart: Chart): number => Math.max(300, Math.min(chart.width ?? 640, window.innerWidth - 40));
const placeX = (chart: Chart, x: number): number =>
  left + (widthOf(chart) - left - right) * (x - chart.x.low) / (chart.x.high - chart.x.low || 1);
const placeY = (chart: Chart, y: number): number =>
  height - bottom - (height - top - bottom) * (y - chart.y.low) / (chart.y.high - chart.y.low || 1);

/// Returns the empty chart with its axes.
function frame(chart: Chart): SVGElement {
  const width = widthOf(chart);
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", chart.sentence);
  const base = height - bottom;
  for (const share of [0, 0.5, 1]) {
    const y = base - (base - top) * share;
    draw(svg, "line", { x1: left, y1: y, x2: width - right, y2: y, class: share ? "grid" : "axis" });
    draw(svg, "text", { x: left - 6, y: y + 4, "text-anchor": "end" },
      chart.y.text(chart.y.low + share * (chart.y.high - chart.y.low)));
    const x = left + (width - left - right) * share;
    draw(svg, "text", { x, y: base + 16, "text-anchor": share === 0 ? "start" : share === 1 ? "end" : "middle" },
      chart.x.text(chart.x.low + share * (chart.x.high - chart.x.low)));
  }
  draw(svg, "text", { x: (left + width - right) / 2, y: height - 6, "text-anchor": "middle", class: "title" },
    chart.x.title);
  draw(svg, "text", { x: 12, y: (base + top) / 2, "text-anchor": "middle", class: "title",
    transform: `rotate(-90 12 ${(base + top) / 2})` }, chart.y.title);
  return svg;
}

export interface Point {
  x: number;
  y: number;
}

/// Returns a line through points, with a dot at each if there are few, and a mark at one of them.
export function lineChart(chart: Chart, points: Point[], mark?: { place: number; text: string }): SVGElement {
  const width = widthOf(chart);
  const svg = frame(chart);
  const places = points.map(p => `${placeX(chart, p.x).toFixed(1)},${placeY(chart, p.y).toFixed(1)}`);
  draw(svg, "polyline", { points: places.join(" "), class: "line" });
  if (points.length <= 40)
    for (const p of points) draw(svg, "circle", { cx: placeX(chart, p.x), cy: placeY(chart, p.y), r: 3.5, class: "dot" });
  if (mark) {
    const p = points[mark.place];
    const x = placeX(chart, p.x);
    draw(svg, "line", { x1: x, y1: top, x2: x, y2: height - bottom, class: "mark-line" });
    draw(svg, "circle", { cx: x, cy: placeY(chart, p.y), r: 6, class: "mark-dot" });
    const isRight = x > width / 2;
    const isHigh = placeY(chart, p.y) < (top + height - bottom) / 2;
    draw(svg, "text", { x: x + (isRight ? -8 : 8), y: isHigh ? height - bottom - 8 : top + 10, "text-anchor": isRight ? "end" : "start", class: "mark-text" },
      mark.text);
  }
  return svg;
}

/// Returns a line through the heights of equal steps, with the area below it.
export function areaChart(chart: Chart, heights: number[]): SVGElement {
  const width = widthOf(chart);
  const svg = frame(chart);
  const step = (chart.x.high - chart.x.low) / heights.length;
  const places: string[] = [];
  heights.forEach((y, i) => {
    for (const end of [i, i + 1])
      places.push(`${placeX(chart, chart.x.low + end * step).toFixed(1)},${placeY(chart, y).toFixed(1)}`);
  });
  const base = height - bottom;
  draw(svg, "polygon", { points: `${left},${base} ${places.join(" ")} ${width - right},${base}`, class: "area" });
  draw(svg, "polyline", { points: places.join(" "), class: "line" });
  return svg;
}

/// Returns bars of equal width, and a line at zero of the horizontal axis.
export function barChart(chart: Chart, heights: number[]): SVGElement {
  const width = widthOf(chart);
  const svg = frame(chart);
  const step = (width - left - right) / heights.length;
  heights.forEach((y, i) => {
    const at = placeY(chart, y);
    draw(svg, "rect", { x: left + i * step + 0.5, y: at, width: Math.max(1, step - 1), height: height - bottom - at, class: "bar" });
  });
  const zero = placeX(chart, 0);
  draw(svg, "line", { x1: zero, y1: top, x2: zero, y2: height - bottom, class: "mark-line" });
  return svg;
}
