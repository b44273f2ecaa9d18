// Arrays of numbers, as the program has put them into the page.

function bytes(text: string): ArrayBuffer {
  const decoded = atob(text);
  const result = new Uint8Array(decoded.length);
  for (let i = 0; i < decoded.length; ++i) result[i] = decoded.charCodeAt(i);
  return result.buffer;
}

export const floats = (text: string): Float32Array => new Float32Array(bytes(text));
export const words = (text: string): Uint16Array => new Uint16Array(bytes(text));
export const integers = (text: string): Uint32Array => new Uint32Array(bytes(text));
export const octets = (text: string): Uint8Array => new Uint8Array(bytes(text));

/// The box of a level: its points are 16-bit fractions of `size` above `low`.
export interface Box {
  low: number[];
  size: number;
}

/// The box that all levels are drawn in, so that a level stays where it is. Its middle becomes the
/// origin, and its longest side 2.
export interface Frame {
  middle: number[];
  size: number;
}

const most = 65535;

/// Returns the frame in which the points of a level fill the view.
export function frameOf(text: string, box: Box): Frame {
  const fractions = words(text);
  const high = [0, 0, 0];
  fractions.forEach((fraction, i) => {
    high[i % 3] = Math.max(high[i % 3], fraction);
  });
  return { middle: box.low.map((low, i) => low + box.size * high[i] / most / 2), size: box.size || 1 };
}

/// Returns points of a level in the frame.
export function framedPoints(text: string, box: Box, frame: Frame): Float32Array {
  const scale = 2 / frame.size;
  const shift = box.low.map((low, i) => scale * (low - frame.middle[i]));
  const fraction = scale * box.size / most;
  return Float32Array.from(words(text), (value, i) => shift[i % 3] + fraction * value);
}
