"""Range scans: grids of points as a scanner gives them, in each of the formats, become surfaces."""

import json
import struct
import unittest

import h5py
import numpy as np

from support import SemigeoTest, contents

ROWS, COLUMNS = 20, 30
EYE = np.array([1.0, 2.0, 9.0])


def grid():
    """Points of two planes, one before the other, seen from the eye; a corner met nothing."""
    rows, columns = np.mgrid[0:ROWS, 0:COLUMNS]
    depth = np.where(columns < 12, 4.0, 6.0)
    rays = np.stack([0.02 * (columns - 15), 0.02 * (rows - 10), np.full_like(depth, -1)], axis=-1)
    points = EYE + depth[..., None] * rays
    points[0, 0] = np.nan
    return points


def ply_text(points):
    met = ~np.isnan(points[..., 0].ravel())
    index = np.where(met, np.cumsum(met) - 1, -1)
    vertices = points.reshape(-1, 3)[met]
    lines = ["ply", "format ascii 1.0", f"obj_info num_cols {COLUMNS}", f"obj_info num_rows {ROWS}",
             f"element vertex {len(vertices)}", "property float x", "property float y",
             "property float z", f"element range_grid {ROWS * COLUMNS}",
             "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(repr, map(float, p))) for p in vertices]
    lines += [f"1 {i}" if i >= 0 else "0" for i in index]
    return "\n".join(lines) + "\n"


def lzf(data):
    """The bytes as liblzf packs them, which HDF5's filter of that name does."""
    with h5py.File("memory", "w", driver="core", backing_store=False) as file:
        packed = file.create_dataset("data", data=np.frombuffer(data, "u1"), chunks=(len(data),),
                                     compression="lzf")
        mask, chunk = packed.id.read_direct_chunk((0,))
    assert mask == 0, "the data cannot be packed"
    return struct.pack("<II", len(chunk), len(data)) + chunk


def pcd_bytes(points, height=ROWS, width=COLUMNS, packed=False):
    eye = " ".join(map(str, EYE))
    head = ("VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
            f"WIDTH {width}\nHEIGHT {height}\nVIEWPOINT {eye} 1 0 0 0\n"
            f"POINTS {width * height}\nDATA binary{'_compressed' if packed else ''}\n")
    points = points.astype("<f4").reshape(-1, 3)
    return head.encode() + (lzf(points.T.tobytes()) if packed else points.tobytes())


def ptx_text(points):
    """The same in the scanner's frame, column after column."""
    local = np.nan_to_num(points - EYE).transpose(1, 0, 2).reshape(-1, 3)
    head = [COLUMNS, ROWS, *(" ".join(map(str, r)) for r in [EYE, *np.eye(3).tolist()])]
    matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [*EYE, 1]]
    lines = [*map(str, head), *(" ".join(map(str, row)) for row in matrix)]
    return "\n".join(lines + [" ".join(map(repr, map(float, p))) + " 0.5" for p in local]) + "\n"


class RangeGridTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        points = grid()
        (self.scans / "a.ply").write_text(ply_text(points))
        (self.scans / "b.pcd").write_bytes(pcd_bytes(points))
        (self.scans / "packed.pcd").write_bytes(pcd_bytes(points, packed=True))
        (self.scans / "c.ptx").write_text(ptx_text(points))

    def run_level_1(self, *arguments, code=0):
        return self.run_scans("--levels", 1, *arguments, code=code)

    def test_all_formats_give_the_same_surface(self):
        vertices = ROWS * COLUMNS - 1
        triangles = 2 * (ROWS - 1) * (COLUMNS - 2) - 1
        for scan in self.run_level_1()["scans"]:
            with self.subTest(scan=scan["name"]):
                self.assertEqual(scan["vertices"], vertices)
                self.assertEqual(scan["triangles"], triangles)
                self.assertEqual(scan["parts"], 2)
                self.assertEqual(scan["repairs"]["depth_jump_triangles"], 2 * (ROWS - 1))
                with h5py.File(scan["output"]) as file:
                    self.assertEqual(json.loads(file.attrs["repairs"])["depth_jump_triangles"],
                                     2 * (ROWS - 1))
                    normals = file["levels/000/normals"][()]
                self.assertTrue((normals[:, 2] > 0.99).all())  # towards the eye

    def test_the_depth_jump_is_a_parameter_of_the_dataset(self):
        self.run_level_1()
        before = contents(self.archive)
        self.assertEqual(self.run_level_1("--depth-jump", 4)["up_to_date"], 4)
        again = self.run_level_1("--depth-jump", 1000)
        self.assertEqual(again["done"], 4)
        self.assertEqual({scan["parts"] for scan in again["scans"]}, {1})
        self.assertEqual(self.run_level_1()["done"], 4)
        after = contents(self.archive)
        for name in ("scans/a.ply.vtkhdf", "scans/b.pcd.vtkhdf", "scans/c.ptx.vtkhdf"):
            self.assertEqual(before[name], after[name])
        for scan in self.run_level_1()["scans"]:
            with h5py.File(scan["output"]) as file:
                self.assertNotIn("depth_jump", json.loads(file.attrs["parameters"]))

    def test_a_point_cloud_is_refused_with_what_would_work(self):
        (self.scans / "cloud.pcd").write_bytes(pcd_bytes(grid(), 1, ROWS * COLUMNS))
        result = self.run_level_1(code=1)
        self.assertEqual(result["done"], 4)
        error = next(scan["error"] for scan in result["scans"] if scan["state"] == "failed")
        for word in ("without order", "organised PCD", "PTX", "range_grid", "Poisson"):
            self.assertIn(word, error)


if __name__ == "__main__":
    unittest.main()
