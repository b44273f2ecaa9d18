// What all pages of the report share: their data, the switch of colours, numbers as text.

/// Returns the element with this id, which the page must have.
export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no element ${id}`);
  return found as T;
}

/// Returns a new element with this text. Texts are never read as HTML.
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K, text = "", className = ""): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  if (text) made.textContent = text;
  if (className) made.className = className;
  return made;
}

/// Returns the document that the program has put into the page.
export function pageData<T>(): T {
  return JSON.parse(element("data").textContent ?? "null") as T;
}

/// Lets the reader choose light or dark colours. Remembers the choice where the browser allows it.
export function addThemeSwitch(changed: () => void = () => undefined): void {
  const key = "semigeo-theme";
  const select = element<HTMLSelectElement>("theme");
  const apply = (): void => {
    if (select.value === "auto") delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = select.value;
    changed();
  };
  try {
    const known = localStorage.getItem(key);
    if (known === "light" || known === "dark") select.value = known;
  } catch {
    // The browser keeps nothing for local files.
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
  select.addEventListener("change", () => {
    apply();
    try {
      localStorage.setItem(key, select.value);
    } catch {
      // The choice holds for this page alone.
    }
  });
  apply();
}

const wholeNumbers = new Intl.NumberFormat("en");

export function wholeText(value: number): string {
  return wholeNumbers.format(value);
}

/// Returns a real number with this many significant digits.
export function realText(value: number, digits = 4): string {
  return Number.isFinite(value) ? String(Number(value.toPrecision(digits))) : "not a number";
}

/// Returns a number in a few characters: "120 k".
export function shortText(value: number): string {
  if (value >= 1e6) return `${realText(value / 1e6, 3)} M`;
  return value >= 1e3 ? `${realText(value / 1e3, 3)} k` : realText(value, 3);
}

export function secondsText(seconds: number): string {
  if (seconds < 1) return `${realText(seconds, 1)} s`;
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  if (seconds < 60) return `${Math.round(seconds)} s`;
  if (seconds < 600) return `${Math.floor(Math.round(seconds) / 60)} min ${Math.round(seconds) % 60} s`;
  const minutes = Math.round(seconds / 60);
  if (minutes < 60) return `${minutes} min`;
  return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

export function bytesText(bytes: number): string {
  if (bytes >= 1e9) return `${(bytes / 1e9).toFixed(1)} GB`;
  if (bytes >= 1e6) return `${(bytes / 1e6).toFixed(bytes < 1e7 ? 1 : 0)} MB`;
  return `${Math.ceil(bytes / 1e3)} kB`;
}

/// Returns "3 welded vertices, 1 split vertex"; an empty text if there is nothing.
export function countsText(counts: Record<string, number>): string {
  const words = (name: string, count: number): string => {
    const many = name.replaceAll("_", " ");
    return count === 1 ? many.replace(/vertices$/, "vertex").replace(/s$/, "") : many;
  };
  return Object.entries(counts).map(([name, count]) => `${wholeText(count)} ${words(name, count)}`).join(", ");
}

/// Returns a value of JSON as text for people.
export function valueText(value: unknown): string {
  if (Array.isArray(value)) return value.map(valueText).join(", ");
  if (value !== null && typeof value === "object")
    return Object.entries(value).map(([name, one]) => `${name} ${valueText(one)}`).join(", ");
  return String(value);
}

/// Adds names and values to a list.
export function showPairs(id: string, pairs: [string, string][]): void {
  const list = element(id);
  for (const [name, value] of pairs) {
    const text = make("dd", value);
    text.dir = "auto";
    list.append(make("dt", name), text);
  }
}
