// The first page of a report: totals, failures, and a table of all scans.

import { addThemeSwitch, bytesText, countsText, element, make, pageData, secondsText, wholeText } from "./page";

type State = "failed" | "damaged" | "skipped" | "missing" | "running" | "done";

/// A scan, as jobs/report/archive_report.cpp describes it. Fields that are not known are absent.
interface Scan {
  name: string;
  title: string;
  state: State;
  reason?: string;
  remedy?: string;
  page?: string;
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

interface Report {
  archive: string;
  version: string;
  run: { state: string; started?: string; seconds?: number; vertex_levels_per_second?: number };
  failures: Failure[];
  scans: Scan[];
}

interface Column {
  title: string;
  explanation: string;
  numeric: boolean;
  /// The value to sort by; scans without one come last.
  value: (scan: Scan) => string | number | undefined;
  text: (scan: Scan) => string;
  className?: string;
}

const none = "–";
const stateOrder: State[] = ["failed", "damaged", "skipped", "missing", "running", "done"];
const stateWords: Record<State, string> = {
  failed: "✗ failed", damaged: "✗ damaged", skipped: "⊘ skipped", missing: "? not made", running: "… running",
  done: "✓ done",
};
const failuresAtFirst = 20;

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
  { title: "Name", explanation: "Name of the scan", numeric: false, value: s => s.title, text: s => s.title },
  { title: "State", explanation: "What became of the scan", numeric: false,
    value: s => stateOrder.indexOf(s.state), text: s => stateWords[s.state], className: "state" },
  { title: "Unit", explanation: "Unit of length", numeric: false, value: s => s.unit, text: s => s.unit ?? none },
  numeric("Vertices", "Vertices of level 0", s => s.vertices),
  numeric("Parts", "Connected parts of level 0", s => s.parts),
  { title: "Repairs", explanation: "What was repaired or left out; sorted by the number of repairs", numeric: false,
    value: s => s.repairs && Object.values(s.repairs).reduce((sum, count) => sum + count, 0),
    text: s => s.repairs ? countsText(s.repairs) || "none" : none, className: "repairs" },
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
let sortedBy = 1;
let descending = false;

const simplified = (text: string): string => text.normalize("NFKC").toLowerCase();

function showHead(): void {
  document.title = `${report.archive} – semigeo report`;
  element("archive").textContent = report.archive;
  const run = report.run;
  const parts = [`last run: ${run.state}`];
  if (run.started) parts.push(`started ${run.started.replace("T", " ").replace("Z", " UTC")}`);
  if (run.seconds) parts.push(`took ${secondsText(run.seconds)}`);
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

function failureItem(failure: Failure): HTMLLIElement {
  const item = make("li");
  const name = make("p", "", "name");
  const text = make("bdi", failure.job);
  name.append(text);
  const reason = make("p", failure.reason);
  reason.dir = "auto";
  item.append(name, reason);
  if (failure.remedy) {
    const remedy = make("p", `What to do: ${failure.remedy}`, "remedy");
    remedy.dir = "auto";
    item.append(remedy);
  }
  return item;
}

function showFailures(): void {
  const failures = report.failures;
  if (failures.length === 0) return;
  element("failures").hidden = false;
  element("failures-title").textContent = `Failures (${wholeText(failures.length)})`;
  const list = element("failure-list");
  list.append(...failures.slice(0, failuresAtFirst).map(failureItem));
  if (failures.length <= failuresAtFirst) return;
  const button = element<HTMLButtonElement>("all-failures");
  button.hidden = false;
  button.textContent = `Show all ${wholeText(failures.length)} failures`;
  button.addEventListener("click", () => {
    list.append(...failures.slice(failuresAtFirst).map(failureItem));
    button.hidden = true;
  });
}

function cellOf(column: Column, scan: Scan): HTMLTableCellElement {
  const isName = column === columns[0];
  const cell = make(isName ? "th" : "td");
  if (isName) {
    cell.scope = "row";
    const name = scan.page ? make("a") : make("bdi");
    name.textContent = scan.title;
    name.dir = "auto";
    if (name instanceof HTMLAnchorElement && scan.page) name.href = scan.page;
    cell.append(name);
    return cell;
  }
  cell.textContent = column.text(scan);
  if (column.numeric) cell.className = "number";
  if (column.className) cell.className = column.className;
  if (column.className === "state") cell.classList.add(scan.state);
  return cell;
}

function rowOf(scan: Scan): HTMLTableRowElement {
  const row = make("tr");
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

function sortRows(): void {
  const sorted = [...report.scans].sort(compare);
  element("rows").append(...sorted.map(scan => rows.get(scan) as HTMLTableRowElement));
  element("columns").querySelectorAll("th").forEach((head, place) => {
    const mark = head.querySelector("span") as HTMLSpanElement;
    mark.textContent = place !== sortedBy ? "" : descending ? " ▼" : " ▲";
    if (place === sortedBy) head.setAttribute("aria-sort", descending ? "descending" : "ascending");
    else head.removeAttribute("aria-sort");
  });
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
  columns.forEach((column, place) => {
    const head = make("th", "", column.numeric ? "number" : "");
    head.scope = "col";
    const button = make("button", column.title);
    button.type = "button";
    button.title = column.explanation;
    const mark = make("span");
    mark.setAttribute("aria-hidden", "true");
    button.append(mark);
    button.addEventListener("click", () => {
      descending = place === sortedBy ? !descending : false;
      sortedBy = place;
      sortRows();
    });
    head.append(button);
    element("columns").append(head);
  });
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
showColumns();
showStates();
for (const scan of report.scans) {
  rows.set(scan, rowOf(scan));
  texts.set(scan, simplified([scan.title, scan.name, scan.unit, scan.reason].join(" ")));
}
sortRows();
filterRows();
element("search").addEventListener("input", filterRows);
addKeys();
