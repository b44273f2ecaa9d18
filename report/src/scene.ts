// The page of a recognised scene: the scene and the models in it, their poses and scores.

import { type Box, type Frame, floats, words } from "./arrays";
import { type Colour, distanceColour } from "./colours";
import { addThemeSwitch, countsText, element, make, pageData, realText, showPairs, valueText, wholeText } from "./page";
import type { Hit } from "./view";
import { matchBackground, showLegend, startView } from "./viewer";

type Row = number[];

/// A surface, as jobs/report/shown_surface.hpp describes it, in the coordinates of its file.
interface Shape extends Box {
  missing?: string;
  name?: string;
  origin: number[];
  points: string;
  triangles: string;
  shown_vertices: number;
}

interface Candidate {
  model: string;
  score: number;
  votes: number;
  cluster: number;
  support: number;
  match: number;
  conflict: number;
  closeness: number;
  stability: number;
  explained: number;
  pose: Record<string, number> & { matrix: Row[] };
}

interface Found extends Candidate {
  shape: number;
  residual?: { distances: string; share: number; median?: number };
}

/// A recognised scene, as jobs/report/scene_report.hpp describes it.
interface Scene {
  title: string;
  titles: Record<string, string>;
  scene: Record<string, unknown> & { name: string; vertices: number; features: number; repairs?: Record<string, number> };
  library: { digest: string; models: number; parameters: Record<string, unknown> };
  search: Record<string, unknown> & { method: string; min_score: number };
  digest: string;
  scene_triplets: number;
  matches: number;
  models_ranked: number;
  objects: Found[];
  ranking: Candidate[];
  surface: Shape;
  models: Shape[];
  residual?: { limit: number };
}

// Light and dark enough for both backgrounds. Numbers tell objects apart, too.
const colours = ["#d95f02", "#1b9e77", "#7570b3", "#e7298a", "#a6761d", "#66a61e", "#1f78b4", "#b15928"];
const beyond = 65535;
const farColour: Colour = [0.62, 0.63, 0.66];

const scene = pageData<Scene>();
const checked = (id: string): boolean => element<HTMLInputElement>(id).checked;
const titleOf = (one: Candidate): string => scene.titles[one.model] ?? one.model;
const nameOf = (place: number): string => `${place + 1}. ${titleOf(scene.objects[place])}`;
const lengthText = (value: number): string => `${realText(value, 3)} units`;
const view = startView(probe);

/// Returns where a matrix takes the points of a shape, as three numbers for each.
function placed(shape: Shape, matrix: Row[] | undefined): Float64Array {
  const fractions = words(shape.points);
  const result = new Float64Array(fractions.length);
  for (let i = 0; i < fractions.length; i += 3) {
    const p = [0, 1, 2].map(c => shape.origin[c] + shape.low[c] + shape.size * fractions[i + c] / 65535);
    for (let c = 0; c < 3; ++c)
      result[i + c] = matrix ? matrix[c][0] * p[0] + matrix[c][1] * p[1] + matrix[c][2] * p[2] + matrix[c][3] : p[c];
  }
  return result;
}

function frameAround(points: Float64Array[]): Frame {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const list of points)
    list.forEach((value, i) => {
      low[i % 3] = Math.min(low[i % 3], value);
      high[i % 3] = Math.max(high[i % 3], value);
    });
  const sizes = low.map((value, c) => high[c] - value);
  return { middle: low.map((value, c) => (value + high[c]) / 2), size: Math.max(...sizes) || 1 };
}

function framed(points: Float64Array, frame: Frame): Float32Array {
  return Float32Array.from(points, (value, i) => 2 * (value - frame.middle[i % 3]) / frame.size);
}

const shapeOf = (object: Found): Shape | undefined => {
  const shape = scene.models[object.shape];
  return shape && !shape.missing ? shape : undefined;
};
const hasScene = !scene.surface.missing;
const scenePoints = hasScene ? placed(scene.surface, undefined) : new Float64Array();
const posed = scene.objects.map(object => {
  const shape = shapeOf(object);
  return shape && placed(shape, object.pose.matrix);
});
const frame = frameAround(hasScene ? [scenePoints] : posed.filter(points => points !== undefined));
const residuals = scene.objects.map(object => object.residual && words(object.residual.distances));
const isShown = (place: number): boolean => posed[place] !== undefined && checked(`object-${place}`);

/// Returns the nearest of the models that are shown, and its distance as a share of the limit.
function nearestModel(vertex: number): { place: number; share: number } | undefined {
  let best: { place: number; share: number } | undefined;
  residuals.forEach((distances, place) => {
    if (!distances || !isShown(place) || distances[vertex] === beyond) return;
    const share = distances[vertex] / (beyond - 1);
    if (!best || share < best.share) best = { place, share };
  });
  return best;
}

/// The end of the colours as a share of the limit: the 98th percentile of the distances within it.
function endOfColours(): number {
  const nearest: number[] = [];
  const count = residuals.find(one => one)?.length ?? 0;
  for (let v = 0; v < count; ++v) {
    const least = Math.min(...residuals.map(one => one ? one[v] : beyond));
    if (least < beyond) nearest.push(least / (beyond - 1));
  }
  nearest.sort((a, b) => a - b);
  return nearest[Math.floor(0.98 * (nearest.length - 1))] || 1;
}

const colourEnd = endOfColours();

const sceneStyle = (): string => (document.querySelector("input[name=scene]:checked") as HTMLInputElement).value;

function showScene(): void {
  const style = sceneStyle();
  view?.showSurface(hasScene && style !== "hidden");
  const limit = scene.residual?.limit;
  if (style !== "distance" || !limit) {
    view?.setColours(undefined);
    element("legend").hidden = true;
    return;
  }
  view?.setColours(vertex => {
    const nearest = nearestModel(vertex);
    return nearest ? distanceColour(nearest.share / colourEnd) : farColour;
  });
  const end = lengthText(colourEnd * limit);
  showLegend(distanceColour, "0", `distance from the models; grey: over ${lengthText(limit)}`, `≥ ${end}`,
    `Distance of the scene from the models, from 0 to ${end}; what is farther than ${lengthText(limit)} is grey`);
}

function showModels(): void {
  const opacity = Number(element<HTMLInputElement>("opacity").value) / 100;
  scene.objects.forEach((object, place) => {
    const shape = shapeOf(object);
    const points = posed[place];
    const drawing = shape && points && isShown(place)
      ? { points: framed(points, frame), triangles: words(shape.triangles) } : undefined;
    view?.setShape(`object ${place}`, drawing, colours[place % colours.length], opacity, checked("edges"));
  });
  showScene();
}

/// Names what is under the cursor.
function probe(hit: Hit | undefined): void {
  const out = element("probe");
  if (!hit) {
    out.textContent = "Point at the scene or a model to read its values.";
  } else if (hit.shape) {
    const place = Number(hit.shape.replace("object ", ""));
    out.textContent = `Model ${nameOf(place)}, score ${realText(scene.objects[place].score)}.`;
  } else {
    const nearest = nearestModel(hit.vertex);
    const limit = scene.residual?.limit ?? 0;
    out.textContent = nearest
      ? `Scene, ${lengthText(nearest.share * limit)} from model ${nameOf(nearest.place)}.`
      : `Scene, farther than ${lengthText(limit)} from all models that are shown.`;
  }
}

function addShapes(): void {
  scene.objects.forEach((object, place) => {
    const label = make("label");
    const box = make("input");
    box.type = "checkbox";
    box.id = `object-${place}`;
    box.checked = posed[place] !== undefined;
    box.disabled = posed[place] === undefined;
    box.addEventListener("change", showModels);
    const mark = make("span", "■", "mark");
    mark.style.color = colours[place % colours.length];
    mark.setAttribute("aria-hidden", "true");
    const name = make("bdi", titleOf(object));
    label.append(box, " ", mark, ` ${place + 1}. `, name);
    element("shapes").append(label);
  });
  if (scene.objects.length > 0) return;
  element("shapes").append(make("p", "none was found"));
  element<HTMLInputElement>("plain").checked = true;
  for (const id of ["distance-label", "opacity-label", "edges-label"]) element(id).hidden = true;
}

/// Returns a matrix for people: fewer digits, in columns.
function shownMatrix(matrix: Row[]): string {
  const cells = matrix.map(row => row.map(value => realText(value, 6)));
  const widths = [0, 1, 2, 3].map(c => Math.max(...cells.map(row => row[c].length)));
  return cells.map(row => row.map((text, c) => text.padStart(widths[c])).join("  ")).join("\n");
}

const matrixText = (matrix: Row[]): string => matrix.map(row => row.map(String).join(" ")).join("\n");
const matrixJson = (matrix: Row[]): string => `[${matrix.map(row => `[${row.map(String).join(", ")}]`).join(",\n ")}]`;

/// Copies a text, also where the browser has no clipboard for local files.
async function copy(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const field = make("textarea");
    field.value = text;
    field.setAttribute("aria-hidden", "true");
    field.className = "copy";
    document.body.append(field);
    field.select();
    const done = document.execCommand("copy");
    field.remove();
    return done;
  }
}

function copyButton(title: string, what: string, text: string): HTMLButtonElement {
  const button = make("button", title);
  button.type = "button";
  button.dataset.text = text;
  button.setAttribute("aria-label", `${title}: ${what}`);
  button.addEventListener("click", () => {
    void copy(text).then(done => {
      element("copied").textContent = done ? `Copied: ${what}.` : "The browser does not allow copying: select the matrix.";
    });
  });
  return button;
}

function objectCard(object: Found, place: number): HTMLElement {
  const card = make("article", "", "card");
  const title = make("h3", `${place + 1}. `);
  title.append(make("bdi", titleOf(object)));
  const pairs = make("dl", "", "pairs");
  const pose = object.pose;
  const found: [string, string][] = [
    ["score", realText(object.score)],
    ["scale", realText(pose.scale, 6)],
    ["translation d h q", [pose.d, pose.h, pose.q].map(value => realText(value, 6)).join(", ")],
    ["angles γ β α", [pose.gamma_degrees, pose.beta_degrees, pose.alpha_degrees]
      .map(value => `${realText(value, 5)}°`).join(", ")],
  ];
  if (object.residual?.median !== undefined)
    found.push(["median distance", `${lengthText(object.residual.median)}, of ${realText(100 * object.residual.share, 3)} % of the scene`]);
  for (const [name, value] of found) pairs.append(make("dt", name), make("dd", value));
  const matrix = make("pre", shownMatrix(pose.matrix), "matrix");
  matrix.tabIndex = 0;
  matrix.setAttribute("aria-label", `Pose of ${nameOf(place)}, a 4 by 4 matrix`);
  const buttons = make("p", "", "buttons");
  buttons.append(copyButton("Copy as text", `pose of ${nameOf(place)}`, matrixText(pose.matrix)),
    copyButton("Copy as JSON", `pose of ${nameOf(place)}, as JSON`, matrixJson(pose.matrix)));
  card.append(title, pairs, matrix, buttons);
  const missing = scene.models[object.shape]?.missing;
  if (missing) card.append(make("p", `It is not drawn: ${missing}.`, "soft"));
  return card;
}

function showRanking(): void {
  const hasShares = scene.search.method !== "thesis";
  const share = (value: number): string => hasShares ? value.toFixed(3) : "–";
  const columns: [string, (one: Candidate) => string][] = [
    ["Score", one => realText(one.score)], ["Match", one => share(one.match)], ["Conflict", one => share(one.conflict)],
    ["Closeness", one => share(one.closeness)], ["Stability", one => share(one.stability)],
    ["Explained", one => share(one.explained)], ["Votes", one => one.votes.toFixed(2)],
    ["Cluster", one => one.cluster.toFixed(2)], ["Support", one => one.support.toFixed(2)],
  ];
  for (const title of ["", "Model", ...columns.map(([name]) => name)]) {
    const head = make("th", title || "Rank", title === "Model" ? "" : "number");
    head.scope = "col";
    element("ranking-columns").append(head);
  }
  const found = new Set(scene.objects.map(object => object.model));
  scene.ranking.forEach((one, place) => {
    const row = make("tr");
    const name = make("th");
    name.scope = "row";
    name.append(make("bdi", titleOf(one)), found.has(one.model) ? " ★" : "");
    row.append(make("td", String(place + 1), "number"), name,
      ...columns.map(([, text]) => make("td", text(one), "number")));
    element("ranking").append(row);
  });
  element("ranking-note").textContent = scene.ranking.length === 0 ? "Nothing agrees with any model."
    : `★ is in the scene: its score reaches ${realText(scene.search.min_score)}, and no better model has its place. ` +
      `${wholeText(scene.ranking.length)} of ${wholeText(scene.models_ranked)} models that were looked at closely.`;
}

function verdict(): string {
  const count = scene.objects.length;
  if (count > 0) return count === 1 ? "1 object was found" : `${wholeText(count)} objects were found`;
  return scene.scene.features === 0 ? "no features: nothing can be recognised" : "no model of the library is in this scene";
}

/// Says that nothing was found, and how near the best candidate came.
function failedVerdict(): string {
  const text = verdict();
  const best = scene.ranking[0];
  const nearest = best === undefined ? "" : ` The best candidate is ${titleOf(best)}: its score is ${realText(best.score, 3)}, ` +
    `and ${realText(scene.search.min_score)} is needed.`;
  return `${text[0].toUpperCase()}${text.slice(1)}.${nearest}`;
}

function showData(): void {
  document.title = `${scene.title} – semigeo report`;
  element("title").textContent = scene.title;
  element("verdict").textContent = verdict();
  element("object-list").append(...scene.objects.map(objectCard));
  if (scene.objects.length === 0) element("object-list").append(make("p", failedVerdict()));
  showPairs("scene", Object.entries(scene.scene).filter(([name]) => name !== "repairs")
    .map(([name, value]) => [name.replaceAll("_", " "), typeof value === "number" ? wholeText(value) : valueText(value)]));
  const repairs = Object.fromEntries(Object.entries(scene.scene.repairs ?? {}).filter(([, count]) => count !== 0));
  showPairs("scene", [["repaired", countsText(repairs) || "nothing"], ["digest", scene.digest]]);
  showPairs("library", [["models", wholeText(scene.library.models)], ["digest", scene.library.digest],
    ...Object.entries(scene.library.parameters).map(([name, value]): [string, string] => [name.replaceAll("_", " "), valueText(value)])]);
  showPairs("search", [...Object.entries(scene.search).map(([name, value]): [string, string] =>
    [name.replaceAll("_", " "), valueText(value)]), ["triplets of the scene", wholeText(scene.scene_triplets)],
  ["matches", wholeText(scene.matches)]]);
  element("python").textContent = "import json\n" +
    `found = json.load(open(${JSON.stringify(`recognised/${scene.scene.name}.json`)}))["objects"]\n` +
    'poses = [(one["model"], one["pose"]["matrix"]) for one in found]\n';
  const notes: string[] = [];
  if (scene.surface.missing) notes.push(`The scene is not drawn: ${scene.surface.missing}.`);
  else if (scene.surface.shown_vertices < scene.scene.vertices)
    notes.push(`${wholeText(scene.surface.shown_vertices)} of ${wholeText(scene.scene.vertices)} vertices of the scene are drawn.`);
  element("note").textContent = notes.join(" ");
}

showData();
addShapes();
showRanking();
view?.setSurface({
  points: hasScene ? framed(scenePoints, frame) : floats(""),
  triangles: hasScene ? words(scene.surface.triangles) : new Uint16Array(),
});
showModels();
probe(undefined);
addThemeSwitch(() => matchBackground(view));
for (const input of document.querySelectorAll("input[name=scene]")) input.addEventListener("change", showScene);
element("opacity").addEventListener("input", showModels);
element("edges").addEventListener("change", showModels);
