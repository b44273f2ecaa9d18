// The page of one scan: its levels in 3-D, and the data of its dataset.

import { floats, frameOf, framedPoints, integers, octets, words } from "./arrays";
import { type Palette, colourOf } from "./colours";
import { barChart, lineChart } from "./charts";
import { addThemeSwitch, countsText, element, make, pageData, realText, showPairs, valueText, wholeText } from "./page";
import type { Form, Hit } from "./view";
import { matchBackground, showLegend, startView } from "./viewer";

type Field = "H" | "K";

/// A level, as jobs/report/scan_report.hpp describes it.
interface Level {
  level: number;
  scale: number;
  vertices: number;
  shown_vertices: number;
  parts: number;
  invalid: number;
  low: number[];
  size: number;
  points: string;
  triangles: string;
  rows?: string;
  K: string;
  H: string;
  completeness: string;
  limits: Record<Field, number>;
  histograms: Record<Field, number[]>;
  features: Record<string, { count: number; points: string }>;
  contours: Record<string, { count: number; points: string; offsets: string }>;
}

interface Scan {
  title: string;
  file: string;
  unit: string;
  curvature_units: Record<Field, string>;
  origin: number[];
  parameters: Record<string, unknown>;
  repairs: Record<string, number>;
  preparation: Record<string, unknown>;
  input_xxh3: string;
  digest: string;
  creator_version: string;
  level_count: number;
  level: number;
  chosen: string;
  feature_counts: number[];
  scales: number[];
  levels: Level[];
}

/// A kind of feature or contour: its words and its colour. A contour is a line and has no mark.
interface Kind {
  name: string;
  title: string;
  mark: string;
  dashed?: boolean;
  form: Form;
  colour: string;
}

const featureKinds: Kind[] = [
  { name: "gaussian", title: "maxima of |K|", mark: "●", form: "circle", colour: "#111111" },
  { name: "mean", title: "maxima of |H|", mark: "■", form: "square", colour: "#d01c8b" },
  { name: "gaussian_torsion", title: "torsion on K = 0", mark: "▲", form: "triangle", colour: "#007a69" },
  { name: "mean_torsion", title: "torsion on H = 0", mark: "◆", form: "diamond", colour: "#6a2ee0" },
];
const contourKinds: Kind[] = [
  { name: "gaussian", title: "K = 0", mark: "", form: "circle", colour: "#111111" },
  { name: "mean", title: "H = 0", mark: "", dashed: true, form: "circle", colour: "#d01c8b" },
];

const chartWidth = 420;
const scan = pageData<Scan>();
const unit = scan.unit === "unknown" ? "" : scan.unit;
const slider = element<HTMLInputElement>("level");
const checked = (id: string): boolean => element<HTMLInputElement>(id).checked;
let fields: Record<Field, Float32Array> = { H: new Float32Array(), K: new Float32Array() };
let completeness: Uint8Array = new Uint8Array();
let rows: Uint32Array | undefined;

/// Returns a curvature with its unit: "0.12 1/mm".
const curvatureText = (field: Field, value: number): string => `${realText(value, 3)} ${scan.curvature_units[field]}`;

const lengthText = (value: number): string => realText(value) + (unit ? ` ${unit}` : "");

const view = startView(probe);
const frame = frameOf(scan.levels[0].points, scan.levels[0]);
const pointsOf = (text: string): Float32Array => framedPoints(text, levelNow(), frame);

const levelNow = (): Level => scan.levels[Number(slider.value)];

function fieldNow(): Field | undefined {
  const value = (document.querySelector("input[name=field]:checked") as HTMLInputElement).value;
  return value === "none" ? undefined : value as Field;
}

function showScale(field: Field, palette: Palette): void {
  const limit = levelNow().limits[field];
  const low = curvatureText(field, -limit);
  const high = curvatureText(field, limit);
  showLegend(share => colourOf(palette, 2 * share - 1), `${field} ≤ ${low}`, "0", `≥ ${high}`,
    `${field} from ${low} over 0 in the middle to ${high}`);
}

function showField(): void {
  const field = fieldNow();
  if (!field) {
    element("legend").hidden = true;
    view?.setColours(undefined);
    return;
  }
  const palette = element<HTMLSelectElement>("palette").value as Palette;
  showScale(field, palette);
  const limit = levelNow().limits[field] || 1;
  const values = fields[field];
  view?.setColours(v => Number.isNaN(values[v]) ? undefined : colourOf(palette, values[v] / limit));
}

/// Returns the segments of polylines, two points for each. Dashed lines lack every other pair of them.
function segmentsOf(points: Float32Array, offsets: Uint32Array, dashed: boolean): Float32Array {
  const result: number[] = [];
  for (let line = 0; line + 1 < offsets.length; ++line)
    for (let p = offsets[line]; p + 1 < offsets[line + 1]; ++p)
      if (!dashed || (p & 3) < 2) result.push(...points.subarray(3 * p, 3 * p + 6));
  return Float32Array.from(result);
}

function showMarks(): void {
  if (!view) return;
  const level = levelNow();
  for (const kind of featureKinds) {
    const shown = checked(`feature-${kind.name}`);
    view.setPoints(`feature ${kind.name}`, shown ? pointsOf(level.features[kind.name].points) : undefined, kind.colour,
      kind.form);
  }
  for (const kind of contourKinds) {
    const contours = level.contours[kind.name];
    const lines = checked(`contour-${kind.name}`)
      ? segmentsOf(pointsOf(contours.points), integers(contours.offsets), kind.dashed ?? false) : undefined;
    view.setLines(`contour ${kind.name}`, lines, kind.colour);
  }
  view.setWireframe(checked("wireframe"), "#222222");
  view.setRims(checked("rims"), "#e6007e");
  const points = pointsOf(level.points);
  const invalid: number[] = [];
  completeness.forEach((share, v) => {
    if (share === 0) invalid.push(...points.subarray(3 * v, 3 * v + 3));
  });
  view.setPoints("invalid", checked("invalid") ? Float32Array.from(invalid) : undefined, "#e6007e", "cross", 8);
}

function showLevelText(): void {
  const level = levelNow();
  const text = `${level.level} of ${scan.level_count - 1}, sigma ${lengthText(level.scale)}`;
  element("level-text").textContent = text + (level.level === scan.level ? ", recognised here" : "");
  slider.setAttribute("aria-valuetext", text);
  for (const [kinds, group, found] of [[featureKinds, "feature", level.features],
    [contourKinds, "contour", level.contours]] as const)
    for (const kind of kinds)
      element(`count-${group}-${kind.name}`).textContent = ` (${wholeText(found[kind.name].count)})`;
  const notes = [`${wholeText(level.vertices)} vertices`];
  if (level.shown_vertices < level.vertices) notes.push(`${wholeText(level.shown_vertices)} of them are drawn`);
  if (level.invalid) notes.push(`${wholeText(level.invalid)} without a patch`);
  element("note").textContent = `${notes.join(", ")}.`;
}

function showLevel(): void {
  const level = levelNow();
  fields = { H: floats(level.H), K: floats(level.K) };
  completeness = octets(level.completeness);
  rows = level.rows ? integers(level.rows) : undefined;
  view?.setSurface({
    points: pointsOf(level.points),
    triangles: words(level.triangles),
  });
  showLevelText();
  showField();
  showMarks();
  showHistograms();
}

/// Shows how many vertices of the level have which curvature.
function showHistograms(): void {
  const level = levelNow();
  element("histogram-title").textContent = `Distribution of curvature on level ${level.level}`;
  element("histograms").replaceChildren(...(["H", "K"] as const).map(field => {
    const counts = level.histograms[field];
    const limit = level.limits[field] || 1;
    const most = Math.max(...counts, 1);
    const sentence = `Number of vertices by ${field}, from ${curvatureText(field, -limit)} to ` +
      `${curvatureText(field, limit)}; ${wholeText(most)} in the highest of ${counts.length} bars`;
    return barChart({
      width: chartWidth,
      sentence,
      x: { title: field === "H" ? "H, mean curvature" : "K, Gaussian curvature", low: -limit, high: limit,
        text: value => curvatureText(field, value) },
      y: { title: "vertices", low: 0, high: most, text: value => wholeText(Math.round(value)) },
    }, counts);
  }));
}

/// Shows the number of features of each level over its sigma, with the level of recognition.
function showCurve(): void {
  const counts = scan.feature_counts;
  const most = Math.max(...counts, 1);
  const chosen = `level ${scan.level}, ${wholeText(counts[scan.level])} features`;
  element("curve").append(lineChart({
    width: chartWidth,
    sentence: `Number of features by sigma: ${wholeText(counts[0])} on level 0, ${wholeText(counts[counts.length - 1])} ` +
      `on level ${counts.length - 1}. Recognised at ${chosen}.`,
    x: { title: `sigma${unit ? `, ${unit}` : ""}`, low: scan.scales[0], high: scan.scales[counts.length - 1],
      text: value => realText(value, 3) },
    y: { title: "features", low: 0, high: most, text: value => wholeText(Math.round(value)) },
  }, counts.map((y, k) => ({ x: scan.scales[k], y })), { place: scan.level, text: `★ ${chosen}` }));
}

/// Names the values of a vertex below the view.
function probe(hit: Hit | undefined): void {
  if (!hit) {
    element("probe").textContent = "Point at the surface to read its values.";
    return;
  }
  const vertex = hit.vertex;
  const K = fields.K[vertex];
  const H = fields.H[vertex];
  const parts = [`vertex ${wholeText(rows ? rows[vertex] : vertex)} of level ${levelNow().level}`];
  if (Number.isNaN(H)) {
    parts.push("no valid patch, so no curvature");
  } else {
    const root = Math.sqrt(Math.max(0, H * H - K));
    parts.push(`K ${curvatureText("K", K)}`, `H ${curvatureText("H", H)}`);
    parts.push(`k1 ${curvatureText("H", H + root)}`, `k2 ${curvatureText("H", H - root)}`);
    parts.push(`patch ${Math.round(completeness[vertex] / 2.55)} % complete`);
  }
  element("probe").textContent = `${parts.join(", ")}.`;
}

function addChoices(kinds: Kind[], group: string, into: string): void {
  for (const kind of kinds) {
    const label = make("label");
    const box = make("input");
    box.type = "checkbox";
    box.id = `${group}-${kind.name}`;
    box.addEventListener("change", showMarks);
    const mark = make("span", kind.mark, kind.mark ? "mark" : "line-mark");
    mark.style.color = kind.colour;
    mark.style.setProperty("--line-colour", kind.colour);
    if (kind.dashed) mark.style.setProperty("--dash", "0.35rem");
    mark.setAttribute("aria-hidden", "true");
    const count = make("span");
    count.id = `count-${group}-${kind.name}`;
    label.append(box, " ", mark, ` ${kind.title}`, count);
    element(into).append(label);
  }
}

/// Returns a text as a Python literal that holds nothing but it.
const pythonText = (text: string): string => JSON.stringify(text);

function showData(): void {
  document.title = `${scan.title} – semigeo report`;
  element("title").textContent = scan.title;
  showPairs("provenance", [
    ["scan", scan.title], ["xxh3 of the scan", scan.input_xxh3], ["dataset", scan.file], ["digest", scan.digest],
    ["made by", `semigeo ${scan.creator_version}`], ["unit of length", scan.unit], ["origin", valueText(scan.origin)],
    ["recognised at", `level ${scan.level}, chosen by ${scan.chosen === "option" ? "the user" : "the curve of its features"}`],
  ]);
  const repairs = Object.entries(scan.repairs).filter(([, count]) => count !== 0);
  showPairs("repairs", repairs.length ? [["repaired", countsText(Object.fromEntries(repairs))]] : [["repaired", "nothing"]]);
  const prepared = Object.entries(scan.preparation);
  if (prepared.length) showPairs("repairs", [["prepared", valueText(scan.preparation)]]);
  showPairs("parameters", Object.entries(scan.parameters).map(([name, value]) => [name, valueText(value)]));
  element("python").textContent = "import h5py\n" + `file = h5py.File(${pythonText(`scans/${scan.file}`)})\n` +
    `H = file["levels/${String(scan.level).padStart(3, "0")}/mean_curvature"][:]\n`;
  if (unit) element("sigma-title").textContent = `Sigma, ${unit}`;
  for (const level of scan.levels) {
    const row = make("tr");
    const name = level.level === scan.level ? `${level.level} ★` : String(level.level);
    const cells = [name, realText(level.scale), wholeText(level.vertices), wholeText(level.parts),
      wholeText(scan.feature_counts[level.level])];
    row.append(...cells.map(text => make("td", text, "number")));
    element("levels").append(row);
  }
  const shown = scan.levels.length;
  element("levels-note").textContent = "★ level at which the scan is recognised." +
    (shown < scan.level_count ? ` ${shown} of ${scan.level_count} levels are shown.` : "");
}

showData();
showCurve();
addChoices(featureKinds, "feature", "features");
addChoices(contourKinds, "contour", "contours");
slider.max = String(scan.levels.length - 1);
slider.value = String(Math.max(0, scan.levels.findIndex(level => level.level === scan.level)));
showLevel();
addThemeSwitch(() => matchBackground(view));
slider.addEventListener("input", showLevel);
for (const input of document.querySelectorAll("input[name=field]")) input.addEventListener("change", showField);
element("palette").addEventListener("change", showField);
for (const id of ["wireframe", "rims", "invalid"]) element(id).addEventListener("change", showMarks);
