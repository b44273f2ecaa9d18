// Reads a dataset with h5wasm: node read_dataset.mjs DATASET. Prints as JSON what it finds in /levels and
// /VTKHDF: attributes, shapes, and sums over arrays.
import { readFileSync } from "node:fs";
import h5wasm from "h5wasm/node";

await h5wasm.ready;
const path = process.argv[2];
const file = new h5wasm.File(path, "r");

const plain = value => typeof value === "bigint" ? Number(value)
  : ArrayBuffer.isView(value) || Array.isArray(value) ? Array.from(value, plain) : value;

/// Returns type, shape and sum of a dataset.
function array(dataset) {
  let sum = 0;
  for (const number of dataset.value) sum += Number(number);
  return { type: dataset.dtype, shape: dataset.shape.map(Number), sum };
}

function attributes(object) {
  return Object.fromEntries(Object.entries(object.attrs).map(([name, attribute]) => [name, plain(attribute.value)]));
}

const levels = {};
for (const name of file.get("levels").keys()) {
  const level = file.get(`levels/${name}`);
  const arrays = {};
  for (const key of level.keys()) {
    const dataset = level.get(key);
    if (key === "features" || key === "contours") arrays[key] = { shape: dataset.shape.map(Number) };
    else arrays[key] = array(dataset);
  }
  levels[name] = { attributes: attributes(level), arrays };
}
const vtk = file.get("VTKHDF");
console.log(JSON.stringify({
  root: attributes(file),
  levels,
  vtkhdf: {
    attributes: attributes(vtk),
    points: array(file.get("VTKHDF/Points")),
    mean: array(file.get("VTKHDF/PointData/mean_curvature")),
    connectivity: array(file.get("VTKHDF/Polygons/Connectivity")),
    values: plain(file.get("VTKHDF/Steps/Values").value),
    point_offsets: plain(file.get("VTKHDF/Steps/PointOffsets").value),
  },
}));
