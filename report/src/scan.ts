// The page of one scan: its levels in 3-D, and the data of its dataset.

import { floats, frameOf, framedPoints, integers, octets, words } from "./arrays";
import { type Palette, colourOf } from "./colours";
import { addThemeSwitch, countsText, element, make, pageData, realText, wholeText } from "./page";
import { SurfaceView } from "./view";

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
  features: Record<string, { count: number; points: string }>;
  contours: Record<string, { count: number; points: string; offsets: string }>;
}

interface Scan {
  title: string;
  file: string;
  unit: string;
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
  levels: Level[];
}

/// A kind of feature or contour: its words and its colour.
interface Kind {
  name: string;
  title: string;
  colour: string;
}

const featureKinds: Kind[] = [
  { name: "gaussian", title: "■ maxima of |K|", colour: "#111111" },
  { name: "mean", title: "■ maxima of |H|", colour: "#d01c8b" },
  { name: "gaussian_torsion", title: "■ torsion on K = 0", colour: "#00a08a" },
  { name: "mean_torsion", title: "■ torsion on H = 0", colour: "#7b3ff2" },
];
const contourKinds: Kind[] = [
  { name: "gaussian", title: "━ K = 0", colour: "#111111" },
  { name: "mean", title: "━ H = 0", colour: "#d01c8b" },
];

const scan = pageData<Scan>();
const unit = scan.unit === "unknown" ? "" : scan.unit;
const slider = element<HTMLInputElement>("level");
const checked = (id: string): boolean => element<HTMLInputElement>(id).checked;
let view: SurfaceView | undefined;
let fields: Record<Field, Float32Array> = { H: new Float32Array(), K: new Float32Array() };
let completeness: Uint8Array = new Uint8Array();
let rows: Uint32Array | undefined;

/// Returns a curvature with its unit: of H 1/length, of K 1/length².
function curvatureText(field: Field, value: number): string {
  const power = field === "K" ? "²" : "";
  return realText(value, 3) + (unit ? ` / ${unit}${power}` : ` / length${power}`);
}

const lengthText = (value: number): string => realText(value) + (unit ? ` ${unit}` : "");

const frame = frameOf(scan.levels[0].points, scan.levels[0]);
const pointsOf = (text: string): Float32Array => framedPoints(text, levelNow(), frame);

const levelNow = (): Level => scan.levels[Number(slider.value)];

function fieldNow(): Field | undefined {
  const value = (document.querySelector("input[name=field]:checked") as HTMLInputElement).value;
  return value === "none" ? undefined : value as Field;
}

function showLegend(field: Field | undefined): void {
  element("legend").hidden = !field;
  if (!field) return;
  const limit = levelNow().limits[field];
  const low = curvatureText(field, -limit);
  const high = curvatureText(field, limit);
  element("low").textContent = `${field} ≤ ${low}`;
  element("high").textContent = `≥ ${high}`;
  element("legend").setAttribute("aria-label", `${field} from ${low} over 0 in the middle to ${high}`);
  const palette = element<HTMLSelectElement>("palette").value as Palette;
  const context = element<HTMLCanvasElement>("scale").getContext("2d");
  if (!context) return;
  for (let x = 0; x < 256; ++x) {
    const [r, g, b] = colourOf(palette, x / 127.5 - 1).map(share => Math.round(255 * share));
    context.fillStyle = `rgb(${r}, ${g}, ${b})`;
    context.fillRect(x, 0, 1, 1);
  }
}

function showField(): void {
  const field = fieldNow();
  showLegend(field);
  if (!field) {
    view?.setColours(undefined);
    return;
  }
  const palette = element<HTMLSelectElement>("palette").value as Palette;
  const limit = levelNow().limits[field] || 1;
  const values = fields[field];
  view?.setColours(v => Number.isNaN(values[v]) ? undefined : colourOf(palette, values[v] / limit));
}

/// Returns the segments of polylines, two points for each.
function segmentsOf(points: Float32Array, offsets: Uint32Array): Float32Array {
  const result: number[] = [];
  for (let line = 0; line + 1 < offsets.length; ++line)
    for (let p = offsets[line]; p + 1 < offsets[line + 1]; ++p) result.push(...points.subarray(3 * p, 3 * p + 6));
  return Float32Array.from(result);
}

function showMarks(): void {
  if (!view) return;
  const level = levelNow();
  for (const kind of featureKinds) {
    const shown = checked(`feature-${kind.name}`);
    view.setPoints(`feature ${kind.name}`, shown ? pointsOf(level.features[kind.name].points) : undefined, kind.colour);
  }
  for (const kind of contourKinds) {
    const contours = level.contours[kind.name];
    const lines = checked(`contour-${kind.name}`)
      ? segmentsOf(pointsOf(contours.points), integers(contours.offsets)) : undefined;
    view.setLines(`contour ${kind.name}`, lines, kind.colour);
  }
  view.setWireframe(checked("wireframe"), "#222222");
  view.setRims(checked("rims"), "#e6007e");
  const points = pointsOf(level.points);
  const invalid: number[] = [];
  completeness.forEach((share, v) => {
    if (share === 0) invalid.push(...points.subarray(3 * v, 3 * v + 3));
  });
  view.setPoints("invalid", checked("invalid") ? Float32Array.from(invalid) : undefined, "#e6007e", 5);
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
}

/// Names the values of a vertex below the view.
function probe(vertex: number | undefined): void {
  if (vertex === undefined) {
    element("probe").textContent = "Point at the surface to read its values.";
    return;
  }
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
    const mark = make("span", kind.title.slice(0, 1), "mark");
    mark.style.color = kind.colour;
    mark.setAttribute("aria-hidden", "true");
    const count = make("span");
    count.id = `count-${group}-${kind.name}`;
    label.append(box, " ", mark, kind.title.slice(1), count);
    element(into).append(label);
  }
}

function addKeys(canvas: HTMLCanvasElement, drawn: SurfaceView): void {
  const step = Math.PI / 18;
  const keys: Record<string, () => void> = {
    ArrowLeft: () => drawn.turn(-step, 0, 1),
    ArrowRight: () => drawn.turn(step, 0, 1),
    ArrowUp: () => drawn.turn(0, -step, 1),
    ArrowDown: () => drawn.turn(0, step, 1),
    "+": () => drawn.turn(0, 0, 0.9),
    "-": () => drawn.turn(0, 0, 1 / 0.9),
    "0": () => drawn.reset(),
    Enter: () => probe(drawn.vertexAt()),
  };
  canvas.addEventListener("keydown", event => {
    const action = keys[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action();
  });
}

function startView(): void {
  const canvas = element<HTMLCanvasElement>("canvas");
  try {
    view = new SurfaceView(canvas);
  } catch {
    canvas.hidden = true;
    element("no-view").hidden = false;
    return;
  }
  const drawn = view;
  addKeys(canvas, drawn);
  element("reset").addEventListener("click", () => drawn.reset());
  canvas.addEventListener("pointermove", event => {
    if (event.buttons === 0) probe(drawn.vertexAt({ x: event.clientX, y: event.clientY }));
  });
  canvas.addEventListener("click", event => probe(drawn.vertexAt({ x: event.clientX, y: event.clientY })));
}

function valueText(value: unknown): string {
  if (Array.isArray(value)) return value.map(valueText).join(", ");
  if (value !== null && typeof value === "object")
    return Object.entries(value).map(([name, one]) => `${name} ${valueText(one)}`).join(", ");
  return String(value);
}

function showPairs(id: string, pairs: [string, string][]): void {
  const list = element(id);
  for (const [name, value] of pairs) {
    const text = make("dd", value);
    text.dir = "auto";
    list.append(make("dt", name), text);
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
  for (const level of scan.levels) {
    const row = make("tr");
    const name = level.level === scan.level ? `${level.level} ★` : String(level.level);
    const cells = [name, lengthText(level.scale), wholeText(level.vertices), wholeText(level.parts),
      wholeText(scan.feature_counts[level.level])];
    row.append(...cells.map(text => make("td", text, "number")));
    element("levels").append(row);
  }
}

showData();
addChoices(featureKinds, "feature", "features");
addChoices(contourKinds, "contour", "contours");
startView();
slider.max = String(scan.levels.length - 1);
slider.value = String(Math.max(0, scan.levels.findIndex(level => level.level === scan.level)));
showLevel();
addThemeSwitch(() => view?.setBackground(getComputedStyle(element("canvas")).backgroundColor));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () =>
  view?.setBackground(getComputedStyle(element("canvas")).backgroundColor));
slider.addEventListener("input", showLevel);
for (const input of document.querySelectorAll("input[name=field]")) input.addEventListener("change", showField);
element("palette").addEventListener("change", showField);
for (const id of ["wireframe", "rims", "invalid"]) element(id).addEventListener("change", showMarks);
