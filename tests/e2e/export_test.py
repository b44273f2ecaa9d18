"""`semigeo export`: the files hold the level's arrays, value by value."""

import unittest

import h5py
import numpy as np

from support import SemigeoTest, icosphere, write_ply

KINDS = {"float": "<f4", "double": "<f8", "int": "<i4", "uchar": "u1"}
FEATURES = ("gaussian", "mean", "gaussian_torsion", "mean_torsion")


def read_elements(path):
    """The header of a binary PLY (counts and properties of elements) and the bytes after it."""
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
    return counts, properties, body


def read_points(path):
    """Vertex records and edges (0, 2) of a binary PLY that has no faces."""
    counts, properties, body = read_elements(path)
    vertex = np.dtype([(name, KINDS[kind]) for kind, name in properties["vertex"]])
    points = np.frombuffer(body, vertex, counts["vertex"])
    edges = np.frombuffer(body, "<i4", offset=points.nbytes).reshape(-1, 2)
    assert len(edges) == counts.get("edge", 0)
    if "edge" in counts:
        assert properties["edge"] == [["int", "vertex1"], ["int", "vertex2"]]
    return points, edges


def read_csv(path):
    """Columns by name, as texts."""
    names, *lines = path.read_text().splitlines()
    rows = [line.split(",") for line in lines]
    return {name: [row[i] for row in rows] for i, name in enumerate(names.split(","))}


def read_ply(path):
    """Vertex records and triangles of a binary PLY, by its own header."""
    counts, properties, body = read_elements(path)
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

    def test_features_as_they_are(self):
        self.export(1e6)
        for level in (0, 2):
            for choice in (*FEATURES, "all"):
                kinds = FEATURES if choice == "all" else (choice,)
                with h5py.File(self.dataset("s.ply"), "r") as file:
                    table = file[f"levels/{level:03d}/features"][...]
                    wanted = [table[table["kind"] == FEATURES.index(kind)] for kind in kinds]
                    origin = file.attrs["origin"]
                numbers = np.repeat([FEATURES.index(kind) for kind in kinds],
                                    [len(table) for table in wanted])
                wanted = np.concatenate(wanted)
                arguments = (self.dataset("s.ply"), "--level", level, "--features", choice)
                for name in ("f.ply", "f.csv"):
                    process = self.semigeo("export", *arguments, "-o", self.folder / name)
                    self.assertIn(f"{len(wanted)} features", process.stdout)
                points, _ = read_points(self.folder / "f.ply")
                columns = read_csv(self.folder / "f.csv")
                self.assertEqual(tuple(columns), points.dtype.names)
                np.testing.assert_array_equal(points["kind"], numbers)
                self.assertEqual(columns.pop("kind"), [FEATURES[number] for number in numbers])
                for prefix, member in (("", "position"), ("initial_", "initial_position")):
                    for axis, values in zip("xyz", (wanted[member] + origin).T):
                        np.testing.assert_array_equal(points[prefix + axis], values)
                for axis, values in zip("xyz", wanted["normal"].T):
                    np.testing.assert_array_equal(points["n" + axis], values)
                for member in ("vertex", "value", "prominence", "scale_free_gaussian",
                               "scale_free_mean"):
                    np.testing.assert_array_equal(points[member], wanted[member])
                for name, texts in columns.items():
                    np.testing.assert_array_equal(np.array(texts, points.dtype[name]),
                                                  points[name])

    def test_contours_as_they_are(self):
        self.export(1e6)
        for level, kind in ((0, "gaussian"), (2, "mean")):
            with h5py.File(self.dataset("s.ply"), "r") as file:
                group = file[f"levels/{level:03d}"]
                contours = group["contours"][...]
                contours = contours[contours["kind"] == FEATURES.index(kind)]
                offsets = np.append(0, np.cumsum(contours["count"]))
                first = contours["first"][0] if len(contours) else 0
                wanted = group["contour_points"][first:first + offsets[-1]]
                positions = wanted[:, :3] + file.attrs["origin"]
            arguments = (self.dataset("s.ply"), "--level", level, "--contours", kind)
            for name in ("c.ply", "c.csv"):
                self.semigeo("export", *arguments, "-o", self.folder / name)
            points, edges = read_points(self.folder / "c.ply")
            columns = read_csv(self.folder / "c.csv")
            self.assertEqual(tuple(columns), points.dtype.names)
            closed = contours["closed"]
            np.testing.assert_array_equal(
                np.stack([points[axis] for axis in "xyz"], axis=1), positions)
            np.testing.assert_array_equal(points["torsion"], wanted[:, 3])
            np.testing.assert_array_equal(points["contour"],
                                          np.repeat(np.arange(len(closed)), np.diff(offsets)))
            np.testing.assert_array_equal(points["closed"], np.repeat(closed, np.diff(offsets)))
            lines = [(p - 1, p) for a, b in zip(offsets, offsets[1:]) for p in range(a + 1, b)]
            ends = [(b - 1, a) for a, b, c in zip(offsets, offsets[1:], closed)
                    if c and b - a > 2]
            self.assertEqual(sorted(map(tuple, edges.tolist())), sorted(lines + ends))
            for name, texts in columns.items():
                np.testing.assert_array_equal(np.array(texts, points.dtype[name]), points[name])

    def test_the_extension_says_how(self):
        self.export(0)
        dataset = self.dataset("s.ply")
        for arguments, word in ((("--features", "all", "-o", "f.txt"), ".ply or .csv"),
                                (("--contours", "mean", "-o", "f"), ".ply or .csv"),
                                (("-o", "f.csv"), "ends in .ply"),
                                (("--features", "torsion", "-o", "f.csv"), "torsion"),
                                (("--contours", "all", "-o", "f.csv"), "all"),
                                (("--features", "all", "--contours", "mean", "-o", "f.csv"),
                                 "excludes"),
                                (("--features", "all", "--quality", "mean_curvature", "-o",
                                  "f.csv"), "excludes")):
            with self.subTest(arguments=arguments):
                process = self.semigeo("export", dataset, *arguments, code=2, cwd=self.folder)
                self.assertIn(word, process.stderr)
        self.assertEqual(list(self.folder.glob("f*")), [])
        self.semigeo("export", dataset, "--features", "all", "-o", self.folder / "F.CSV")

    def test_what_cannot_be_exported_is_said(self):
        self.export(0)
        dataset = self.dataset("s.ply")
        output = self.folder / "other.ply"
        for arguments, word in (
                ((dataset, "--level", 3, "--output", output), "0 to 2"),
                ((dataset, "--level", 3, "--output", output, "--features", "all"), "0 to 2"),
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
