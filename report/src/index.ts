// The first page of a report: totals, failures, the last run, recognised scenes, and a table of all scans.

import { areaChart } from "./charts";
import { addThemeSwitch, bytesText, countsText, element, make, pageData, secondsText, shortText, wholeText } from "./page";

type State = "failed" | "damaged" | "skipped" | "missing" | "running" | "done";

/// A scan, as jobs/report/archive_report.cpp describes it. Fields that are not known are absent.
interface Scan {
  name: string;
  title: string;
  state: State;
  reason?: string;
  remedy?: string;
  page?: string;
  thumbnail?: string;
  unit?: string;
  vertices?: number;
  parts?: number;
  repairs?: Record<string, number>;
  levels?: number;
  level?: number;
  features?: number;
  seconds?: number;
  peak_bytes?: number;
  dataset_bytes?: number;
}

interface Failure {
  job: string;
  reason: string;
  remedy?: string;
}

/// A recognised scene.
interface Scene {
  title: string;
  page?: string;
  reason?: string;
  vertices?: number;
  features?: number;
  objects?: { title: string; score: number }[];
}

/// The last run, as jobs/report/run_figures.hpp describes it.
interface Run {
  state: string;
  started?: string;
  seconds?: number;
  host?: string;
  threads?: number;
  peak_bytes?: number;
  passed_over?: string;
  vertex_levels_per_second?: number;
  core_time?: { computing: number; waiting: number; held: number; tail: number };
  curve?: { seconds: number; rate: number[] };
}

interface Report {
  archive: string;
  version: string;
  run: Run;
  failures: Failure[];
  scans: Scan[];
  scenes: Scene[];
}

interface Column {
  title: string;
  explanation: string;
  numeric: boolean;
  /// The value to sort by; scans without one come last.
  value: (scan: Scan) => string | number | undefined;
  text: (scan: Scan) => string;
  className?: string;
  isPicture?: boolean;
}

const none = "–";
const stateOrder: State[] = ["failed", "damaged", "skipped", "missing", "running", "done"];
const stateWords: Record<State, string> = {
  failed: "✗ failed", damaged: "✗ damaged", skipped: "⊘ skipped", missing: "? not made", running: "… running",
  done: "✓ done",
};
const failuresAtFirst = 20;
const namesAtFirst = 12;
const manyRows = 400;

function numeric(title: string, explanation: string, value: (scan: Scan) => number | undefined,
  text: (value: number) => string = wholeText): Column {
  return {
    title, explanation, numeric: true, value,
    text: scan => {
      const known = value(scan);
      return known === undefined ? none : text(known);
    },
  };
}

const columns: Column[] = [
  { title: "Picture", explanation: "The surface, coloured by mean curvature", numeric: false, isPicture: true,
    value: () => undefined, text: () => "" },
  { title: "Name", explanation: "Name of the scan", numeric: false, value: s => s.title, text: s => s.title },
  { title: "State", explanation: "What became of the scan", numeric: false,
    value: s => stateOrder.indexOf(s.state), text: s => stateWords[s.state], className: "state" },
  { title: "Unit", explanation: "Unit of length", numeric: false, value: s => s.unit, text: s => s.unit ?? none },
  numeric("Vertices", "Vertices of level 0", s => s.vertices),
  numeric("Parts", "Connected parts of level 0", s => s.parts),
  { title: "Repairs, reason", explanation: "What was repaired or left out, or why there is nothing; sorted by the number of repairs", numeric: false,
    value: s => s.repairs && Object.values(s.repairs).reduce((sum, count) => sum + count, 0),
    text: s => s.repairs ? countsText(s.repairs) || "none" : s.reason ? reasonWithoutFile(s.title, s.reason) : none,
    className: "repairs" },
  numeric("Levels", "Number of levels", s => s.levels),
  numeric("Recognised at", "Level at which the scan is recognised", s => s.level),
  numeric("Features", "Features at that level", s => s.features),
  numeric("Time", "Time of the job", s => s.seconds, secondsText),
  numeric("Memory", "Largest use of memory", s => s.peak_bytes, bytesText),
];

const report = pageData<Report>();
const collator = new Intl.Collator(undefined, { numeric: true });
const rows = new Map<Scan, HTMLTableRowElement>();
const texts = new Map<Scan, string>();
const hiddenStates = new Set<State>();
const nameColumn = 1;
let sortedBy = 2;
let descending = false;

const simplified = (text: string): string => text.normalize("NFKC").toLowerCase();

function showHead(): void {
  document.title = `${report.archive} – semigeo report`;
  element("archive").textContent = report.archive;
  const run = report.run;
  const parts = [`last run: ${run.state}`];
  if (run.started) parts.push(`started ${run.started.replace("T", " ").replace("Z", " UTC")}`);
  if (run.seconds) parts.push(`took ${secondsText(run.seconds)}`);
  if (run.host) parts.push(`on ${run.host}`);
  element("run").textContent = parts.join(", ");
  element("made").textContent = `Made by semigeo ${report.version}.`;
}

function showTotals(): void {
  const sum = (value: (scan: Scan) => number | undefined): number =>
    report.scans.reduce((total, scan) => total + (value(scan) ?? 0), 0);
  const totals: [string, string][] = [["scans", wholeText(report.scans.length)]];
  for (const state of stateOrder) {
    const count = report.scans.filter(scan => scan.state === state).length;
    if (count) totals.push([stateWords[state], wholeText(count)]);
  }
  totals.push(["vertices", wholeText(sum(s => s.vertices))], ["time of all jobs", secondsText(sum(s => s.seconds))]);
  totals.push(["datasets on disk", bytesText(sum(s => s.dataset_bytes))]);
  const rate = report.run.vertex_levels_per_second;
  if (rate) totals.push(["vertex levels per second", wholeText(Math.round(rate))]);
  for (const [name, value] of totals) {
    const pair = make("div");
    pair.append(make("dt", name), make("dd", value));
    element("totals").append(pair);
  }
}

/// Returns the failures in groups, the largest first. Those of a group have the same remedy, and the
/// same reason but for numbers and the name of the file.
function groupsOf(failures: Failure[]): Failure[][] {
  const groups = new Map<string, Failure[]>();
  for (const failure of failures) {
    const key = `${reasonWithoutFile(failure.job, failure.reason).replace(/\d+/g, "#")}\n${failure.remedy ?? ""}`;
    const group = groups.get(key);
    if (group) group.push(failure);
    else groups.set(key, [failure]);
  }
  return [...groups.values()].sort((a, b) => b.length - a.length);
}

/// Returns a reason without the file that it begins with, which has this name.
function reasonWithoutFile(name: string, reason: string): string {
  const at = reason.indexOf(`${name}: `);
  return at < 0 ? reason : reason.slice(at + name.length + 2);
}

function textBlock(text: string, className = ""): HTMLParagraphElement {
  const block = make("p", text, className);
  block.dir = "auto";
  return block;
}

/// Returns the item of a group, with some or all of its names.
/// Returns whether failures have the same reason, numbers included.
const isSame = (group: Failure[]): boolean =>
  group.every(one => reasonWithoutFile(one.job, one.reason) === reasonWithoutFile(group[0].job, group[0].reason));

function failureItem(group: Failure[]): HTMLLIElement {
  const item = make("li");
  const names = make("p", "", "name");
  const show = (count: number): void => {
    names.replaceChildren();
    group.slice(0, count).forEach((failure, place) => names.append(place ? ", " : "", make("bdi", failure.job)));
    if (count >= group.length) return;
    const button = make("button", `and ${wholeText(group.length - count)} more`);
    button.type = "button";
    button.addEventListener("click", () => show(group.length));
    names.append(" ", button);
  };
  show(namesAtFirst);
  const first = group[0];
  const reason = group.length === 1 ? first.reason
    : `${wholeText(group.length)} times${isSame(group) ? "" : ", for example"}: ${reasonWithoutFile(first.job, first.reason)}`;
  item.append(names, textBlock(reason));
  if (first.remedy) item.append(textBlock(`What to do: ${first.remedy}`, "remedy"));
  return item;
}

function showFailures(): void {
  const failures = report.failures;
  if (failures.length === 0) return;
  element("failures").hidden = false;
  element("failures-title").textContent = `Failures (${wholeText(failures.length)})`;
  const groups = groupsOf(failures);
  const list = element("failure-list");
  list.append(...groups.slice(0, failuresAtFirst).map(failureItem));
  if (groups.length <= failuresAtFirst) return;
  const button = element<HTMLButtonElement>("all-failures");
  button.hidden = false;
  button.textContent = `Show all ${wholeText(groups.length)} reasons`;
  button.addEventListener("click", () => {
    list.append(...groups.slice(failuresAtFirst).map(failureItem));
    button.hidden = true;
  });
}

/// Names what bounded a run, by what its cores did.
function boundText(time: NonNullable<Run["core_time"]>): string {
  const percent = (share: number): string => `${Math.round(100 * share)} %`;
  if (time.computing >= 0.5) return `The cores bounded this run: they computed for ${percent(time.computing)} of the time.`;
  const most = Math.max(time.waiting, time.held, time.tail);
  if (most === time.waiting)
    return `The disk or other programs bounded this run: jobs had cores, but waited for ${percent(most)} of the time.`;
  if (most === time.tail)
    return `The last jobs bounded this run: for ${percent(most)} of the time cores were free, and no other job was left.`;
  return `Memory, or jobs that others wait for, bounded this run: for ${percent(most)} of the time cores were free, ` +
    "and jobs were left that could not begin.";
}

function showRun(): void {
  const run = report.run;
  element("night").hidden = !run.seconds;
  if (run.core_time) {
    element("bound").textContent = boundText(run.core_time);
    const names = { computing: "cores were computing", waiting: "cores waited for the disk or other programs",
      held: "cores were free, but jobs could not begin", tail: "cores were free at the end" } as const;
    for (const [key, name] of Object.entries(names))
      element("core-time").append(make("dt", name), make("dd", `${(100 * run.core_time[key as keyof typeof names]).toFixed(0)} %`));
    if (run.threads) element("core-time").append(make("dt", "cores"), make("dd", wholeText(run.threads)));
    if (run.peak_bytes) element("core-time").append(make("dt", "largest job"), make("dd", bytesText(run.peak_bytes)));
  }
  else if (run.seconds) element("bound").textContent = "The run was too short to say what bounded it.";
  if (run.passed_over) element("passed-over").textContent = `Passed over: ${run.passed_over}`;
  if (!run.curve) return;
  const { seconds, rate } = run.curve;
  const most = Math.max(...rate);
  const length = seconds * rate.length;
  element("throughput").append(areaChart({
    sentence: `Throughput over ${secondsText(length)}: at most ${wholeText(Math.round(most))} vertex levels per second, ` +
      `${wholeText(Math.round(run.vertex_levels_per_second ?? 0))} on average.`,
    x: { title: "time since the start", low: 0, high: length, text: secondsText },
    y: { title: "vertex levels / s", low: 0, high: most, text: shortText },
  }, rate));
}

function sceneRow(scene: Scene): HTMLTableRowElement {
  const row = make("tr");
  const name = make("th");
  name.scope = "row";
  name.append(nameOf(scene.title, scene.page));
  const objects = make("td", "", "wide-cell");
  if (scene.reason) objects.textContent = scene.reason;
  else if (!scene.objects?.length) objects.textContent = "none";
  else scene.objects.forEach((object, place) =>
    objects.append(place ? ", " : "", make("bdi", object.title), ` (${object.score.toFixed(2)})`));
  const count = (value?: number): HTMLElement => make("td", value === undefined ? none : wholeText(value), "number");
  row.append(name, objects, count(scene.vertices), count(scene.features));
  return row;
}

function showScenes(): void {
  element("scenes").hidden = report.scenes.length === 0;
  element("scene-rows").append(...report.scenes.map(sceneRow));
}

/// Returns a name that leads to its page, if there is one. A name may be of any script.
function nameOf(title: string, page: string | undefined): HTMLElement {
  const name = page ? make("a") : make("bdi");
  name.textContent = title;
  name.dir = "auto";
  if (name instanceof HTMLAnchorElement && page) name.href = page;
  return name;
}

/// The picture says nothing that the row does not say, so that it has no text.
function pictureOf(scan: Scan): HTMLElement {
  if (!scan.thumbnail) return make("span", "", "no-picture");
  const picture = make("img");
  picture.alt = "";
  picture.width = picture.height = 64;
  picture.decoding = "async";
  picture.src = `data:image/png;base64,${scan.thumbnail}`;
  return picture;
}

function cellOf(column: Column, scan: Scan): HTMLTableCellElement {
  const isName = column === columns[nameColumn];
  const cell = make(isName ? "th" : "td");
  cell.setAttribute("role", isName ? "rowheader" : "cell");
  if (column.className) cell.className = column.className;
  if (column.numeric) cell.className = "number";
  if (isName) {
    cell.scope = "row";
    cell.append(nameOf(scan.title, scan.page));
  } else if (column.isPicture) {
    cell.className = "picture";
    cell.append(pictureOf(scan));
  } else {
    cell.textContent = column.text(scan);
    if (cell.textContent === none) cell.classList.add("empty");
    cell.dataset.title = column.className === "repairs" ? hasNoDataset(scan) ? "Reason" : "Repairs" : column.title;
  }
  if (column.className === "state") cell.classList.add(scan.state);
  return cell;
}

/// Returns whether there is nothing to say about a scan but its state and the reason.
const hasNoDataset = (scan: Scan): boolean => scan.vertices === undefined;

function rowOf(scan: Scan): HTMLTableRowElement {
  const row = make("tr", "", hasNoDataset(scan) ? "lacking" : "");
  row.setAttribute("role", "row");
  row.append(...columns.map(column => cellOf(column, scan)));
  return row;
}

function compare(a: Scan, b: Scan): number {
  const column = columns[sortedBy];
  const left = column.value(a);
  const right = column.value(b);
  if (left === undefined || right === undefined) {
    if (left !== right) return left === undefined ? 1 : -1;
  } else {
    const order = typeof left === "number" && typeof right === "number"
      ? left - right : collator.compare(String(left), String(right));
    if (order !== 0) return descending ? -order : order;
  }
  return collator.compare(a.title, b.title);
}

/// Sorts the rows and says so in the heads of the columns. The rows are moved out of the page, so
/// that the browser lays them out once.
function sortRows(): void {
  const sorted = [...report.scans].sort(compare);
  const fragment = document.createDocumentFragment();
  for (const scan of sorted) fragment.append(rows.get(scan) as HTMLTableRowElement);
  element("rows").append(fragment);
  element("columns").querySelectorAll("th").forEach((head, place) => {
    const mark = head.querySelector("span");
    if (mark) mark.textContent = place !== sortedBy ? "" : descending ? " ▼" : " ▲";
    if (place === sortedBy) head.setAttribute("aria-sort", descending ? "descending" : "ascending");
    else head.removeAttribute("aria-sort");
  });
  element<HTMLSelectElement>("sort").value = String(sortedBy);
  element("direction").textContent = descending ? "▼ descending" : "▲ ascending";
}

function sortBy(place: number, down: boolean): void {
  sortedBy = place;
  descending = down;
  sortRows();
}

function filterRows(): void {
  const words = simplified(element<HTMLInputElement>("search").value).split(/\s+/).filter(word => word);
  let shown = 0;
  for (const [scan, row] of rows) {
    const text = texts.get(scan) ?? "";
    const fits = !hiddenStates.has(scan.state) && words.every(word => text.includes(word));
    row.hidden = !fits;
    if (fits) ++shown;
  }
  element("shown").textContent = `${wholeText(shown)} of ${wholeText(rows.size)} scans`;
}

function showColumns(): void {
  const select = element<HTMLSelectElement>("sort");
  columns.forEach((column, place) => {
    const head = make("th", "", column.numeric ? "number" : column.isPicture ? "picture" : "");
    head.scope = "col";
    head.setAttribute("role", "columnheader");
    element("columns").append(head);
    if (column.isPicture) {
      head.append(make("span", column.title, "for-readers"));
      return;
    }
    const button = make("button", column.title);
    button.type = "button";
    button.title = column.explanation;
    const mark = make("span");
    mark.setAttribute("aria-hidden", "true");
    button.append(mark);
    button.addEventListener("click", () => sortBy(place, place === sortedBy && !descending));
    head.append(button);
    const option = make("option", column.title);
    option.value = String(place);
    select.append(option);
  });
  select.addEventListener("change", () => sortBy(Number(select.value), false));
  element("direction").addEventListener("click", () => sortBy(sortedBy, !descending));
}

function showStates(): void {
  const present = stateOrder.filter(state => report.scans.some(scan => scan.state === state));
  for (const state of present) {
    const label = make("label");
    const box = make("input");
    box.type = "checkbox";
    box.checked = true;
    box.value = state;
    box.addEventListener("change", () => {
      if (box.checked) hiddenStates.delete(state);
      else hiddenStates.add(state);
      filterRows();
    });
    label.append(box, ` ${stateWords[state]}`);
    element("states").append(label);
  }
}

function addKeys(): void {
  document.addEventListener("keydown", event => {
    const typing = event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement;
    if (event.key !== "/" || typing || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    element("search").focus();
  });
}

addThemeSwitch();
showHead();
showTotals();
showFailures();
showRun();
showScenes();
showColumns();
showStates();
for (const scan of report.scans) {
  rows.set(scan, rowOf(scan));
  texts.set(scan, simplified([scan.title, scan.name, scan.unit, scan.reason].join(" ")));
}
// Rows out of view are laid out when they come into view, if they are many.
element("table").classList.toggle("many", report.scans.length > manyRows);
sortRows();
filterRows();
element("search").addEventListener("input", filterRows);
addKeys();
