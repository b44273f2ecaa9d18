"""`semigeo export`: the PLY holds the level's arrays, value by value."""

import unittest

import h5py
import numpy as np

from support import SemigeoTest, icosphere, write_ply

KINDS = {"float": "<f4", "double": "<f8"}


def read_ply(path):
    """Vertex records and triangles of a binary PLY, by its own header."""
    data = path.read_bytes()
    header, body = data.split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"], lines
    counts, properties, element = {}, {}, None
    for line in lines[2:]:
        words = line.split()
        if words[0] == "element":
            element = words[1]
            counts[element], properties[element] = int(words[2]), []
        elif words[0] == "property":
            properties[element].append(words[1:])
    vertex = np.dtype([(name, KINDS[kind]) for kind, name in properties["vertex"]])
    assert properties["face"] == [["list", "uchar", "int", "vertex_indices"]]
    face = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
    assert len(body) == counts["vertex"] * vertex.itemsize + counts["face"] * face.itemsize
    vertices = np.frombuffer(body, vertex, counts["vertex"])
    faces = np.frombuffer(body, face, counts["face"], counts["vertex"] * vertex.itemsize)
    assert np.all(faces["count"] == 3)
    return vertices, faces["corners"]


class ExportTest(SemigeoTest):
    def export(self, shift, *arguments):
        points, triangles = icosphere(3)
        write_ply(self.scans / "s.ply", (points + shift, triangles))
        self.run_scans("--levels", 2)
        output = self.folder / "out.ply"
        self.semigeo("export", self.dataset("s.ply"), "--output", output, *arguments)
        return read_ply(output)

    def check(self, found, level, quality, shift=0.0):
        vertices, triangles = found
        with h5py.File(self.dataset("s.ply"), "r") as file:
            group = file[f"levels/{level:03d}"]
            points = group["points"][...]
            if shift:
                points = points + file.attrs["origin"]
            np.testing.assert_array_equal(
                np.stack([vertices[axis] for axis in "xyz"], axis=1), points)
            np.testing.assert_array_equal(
                np.stack([vertices[axis] for axis in ("nx", "ny", "nz")], axis=1),
                group["normals"])
            for name in ("gaussian_curvature", "mean_curvature"):
                np.testing.assert_array_equal(vertices[name], group[name])
            np.testing.assert_array_equal(vertices["quality"], group[quality])
            np.testing.assert_array_equal(triangles, group["triangles"])

    def test_a_level_as_it_is(self):
        self.check(self.export(0, "--level", 2), 2, "mean_curvature")

    def test_level_zero_by_default_and_another_quality(self):
        self.check(self.export(0, "--quality", "gaussian_curvature"), 0, "gaussian_curvature")
        self.check(self.export(0, "--quality", "patch_completeness"), 0, "patch_completeness")

    def test_map_coordinates_are_doubles(self):
        found = self.export(1e6, "--level", 1)
        self.assertEqual(found[0].dtype["x"], np.dtype("<f8"))
        self.check(found, 1, "mean_curvature", shift=1e6)

    def test_an_export_is_a_scan_again(self):
        self.export(0, "--level", 1)
        process = self.semigeo("run", self.folder / "out.ply", "--output", self.archive,
                               "--levels", 0)
        self.assertIn("1 done", process.stdout)
        with h5py.File(self.dataset("out.ply"), "r") as again, \
                h5py.File(self.dataset("s.ply"), "r") as first:
            np.testing.assert_array_equal(again["levels/000/points"], first["levels/001/points"])

    def test_what_cannot_be_exported_is_said(self):
        self.export(0)
        dataset = self.dataset("s.ply")
        output = self.folder / "other.ply"
        for arguments, word in (
                ((dataset, "--level", 3, "--output", output), "0 to 2"),
                ((dataset, "--output", self.folder / "no/folder.ply"), "no/folder.ply"),
                ((self.folder / "none.vtkhdf", "--output", output), "none.vtkhdf"),
                ((self.folder / "out.ply", "--output", output), "out.ply")):
            with self.subTest(arguments=arguments):
                process = self.semigeo("export", *arguments, code=1)
                self.assertIn(word, process.stderr)
                self.assertEqual(process.stdout, "")
        self.assertFalse(output.exists())
        self.semigeo("export", dataset, "--output", output, "--quality", "torsion", code=2)


if __name__ == "__main__":
    unittest.main()
