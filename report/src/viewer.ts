// The view of a page with its keys, its pointer and its legend.

import type { Colour } from "./colours";
import { element } from "./page";
import { type Hit, SurfaceView } from "./view";

function addKeys(canvas: HTMLCanvasElement, view: SurfaceView, probe: (hit: Hit | undefined) => void): void {
  const step = Math.PI / 18;
  const keys: Record<string, () => void> = {
    ArrowLeft: () => view.turn(-step, 0, 1),
    ArrowRight: () => view.turn(step, 0, 1),
    ArrowUp: () => view.turn(0, -step, 1),
    ArrowDown: () => view.turn(0, step, 1),
    "+": () => view.turn(0, 0, 0.9),
    "-": () => view.turn(0, 0, 1 / 0.9),
    "0": () => view.reset(),
    Enter: () => probe(view.hitAt()),
  };
  canvas.addEventListener("keydown", event => {
    const action = keys[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action();
  });
}

/// Starts the view of the page. Returns nothing, and says so on the page, if the browser has no
/// WebGL. `probe` is told what is under the cursor.
export function startView(probe: (hit: Hit | undefined) => void): SurfaceView | undefined {
  const canvas = element<HTMLCanvasElement>("canvas");
  let view: SurfaceView;
  try {
    view = new SurfaceView(canvas);
  } catch {
    canvas.hidden = true;
    element("no-view").hidden = false;
    return undefined;
  }
  addKeys(canvas, view, probe);
  element("reset").addEventListener("click", () => view.reset());
  canvas.addEventListener("pointermove", event => {
    if (event.buttons === 0) probe(view.hitAt({ x: event.clientX, y: event.clientY }));
  });
  canvas.addEventListener("click", event => probe(view.hitAt({ x: event.clientX, y: event.clientY })));
  return view;
}

/// Gives the view the background of its canvas, which changes with the colours of the page.
export function matchBackground(view: SurfaceView | undefined): void {
  view?.setBackground(getComputedStyle(element("canvas")).backgroundColor);
}

/// Shows the legend: the colours from left to right, the texts below its ends and its middle, and
/// the sentence for those who do not see it.
export function showLegend(colourAt: (share: number) => Colour, low: string, middle: string, high: string,
  sentence: string): void {
  element("legend").hidden = false;
  element("low").textContent = low;
  element("zero").textContent = middle;
  element("high").textContent = high;
  element("legend").setAttribute("aria-label", sentence);
  const context = element<HTMLCanvasElement>("scale").getContext("2d");
  if (!context) return;
  for (let x = 0; x < 256; ++x) {
    const [r, g, b] = colourAt(x / 255).map(share => Math.round(255 * share));
    context.fillStyle = `rgb(${r}, ${g}, ${b})`;
    context.fillRect(x, 0, 1, 1);
  }
}
