// Scales of colours for a field that is symmetric about zero.

export type Palette = "safe" | "thesis";
export type Colour = [number, number, number];

const stops: Record<Palette, Colour[]> = {
  // Blue is low, green is flat, red is high. Source: thesis 6.2.
  thesis: [[0, 0, 1], [0, 1, 1], [0, 0.85, 0], [1, 1, 0], [1, 0, 0]],
  // It differs in lightness and between blue and orange, which all kinds of sight tell apart.
  safe: [[0.02, 0.19, 0.45], [0.35, 0.62, 0.85], [0.95, 0.95, 0.94], [0.93, 0.6, 0.27], [0.5, 0.2, 0.02]],
};

/// The colour of vertices without a valid patch.
export const invalidColour: Colour = [0.45, 0.45, 0.47];
/// The colour of a surface without a field.
export const plainColour: Colour = [0.72, 0.74, 0.78];

/// Returns the colour at a share of the way through a list.
function between(list: Colour[], share: number): Colour {
  const place = Math.min(1, Math.max(0, share)) * (list.length - 1);
  const first = Math.min(list.length - 2, Math.floor(place));
  const rest = place - first;
  return [0, 1, 2].map(i => list[first][i] + rest * (list[first + 1][i] - list[first][i])) as Colour;
}

/// Returns the colour of a value between -1 and 1; what lies outside has the colour of the end.
export function colourOf(palette: Palette, value: number): Colour {
  return between(stops[palette], (value + 1) / 2);
}

// From pale over orange to dark purple: lightness alone tells near from far.
const distances: Colour[] = [[0.92, 0.93, 0.9], [0.98, 0.78, 0.45], [0.91, 0.45, 0.24], [0.66, 0.15, 0.33], [0.28, 0.05, 0.36]];

/// Returns the colour of a distance between 0 and 1, as a share of the largest.
export function distanceColour(share: number): Colour {
  return between(distances, share);
}
