"""A dataset as others read it: h5py, VTKHDF's rules, the XDMF sidecar."""

import json
import unittest
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np

from support import SemigeoTest, boulder, icosphere, joined, plane, write_ply

LEVELS = 3
RADIUS = 10.0


class PrecisionTest(SemigeoTest):
    def test_scan_rounds_away_what_is_finer_than_a_scan(self):
        points, triangles = boulder(4, 1)
        write_ply(self.scans / "b.ply", (points, triangles))
        paths = {}
        for precision in ("full", "scan"):
            archive = self.folder / precision
            self.run_scans("--levels", LEVELS, "--precision", precision, "--principal", archive=archive)
            self.semigeo("check", archive)
            paths[precision] = self.dataset("b.ply", archive)
        self.assertLess(paths["scan"].stat().st_size, 0.8 * paths["full"].stat().st_size)
        with h5py.File(paths["full"]) as full, h5py.File(paths["scan"]) as scan:
            self.assertNotIn("precision", json.loads(full.attrs["parameters"]))
            self.assertEqual(json.loads(scan.attrs["parameters"])["precision"], "scan")
            for name, exact in full["levels"].items():
                self.check_level(exact, scan["levels"][name], first=name == "000")
            np.testing.assert_array_equal(full["selection/feature_counts"], scan["selection/feature_counts"])

    def check_level(self, exact, level, first):
        step = exact.attrs["step"]
        for name in ("triangles", "part", "source_vertex", "contours"):
            np.testing.assert_array_equal(level[name], exact[name])
        if first:
            np.testing.assert_array_equal(level["points"], exact["points"])
            self.assertNotIn("point_quantum", level.attrs)
        else:
            quantum = level.attrs["point_quantum"]
            self.assertEqual(np.abs(level["points"][...] / quantum % 1).max(), 0)
            self.assertLessEqual(quantum, 2e-3 * step)
            self.assertLessEqual(np.abs(level["points"][...] - exact["points"]).max(), 1e-3 * step)
        for name in ("normals", "principal_direction_1", "principal_direction_2"):
            self.assertLessEqual(np.abs(level[name][...] - exact[name]).max(), 1e-3)
        for name in ("gaussian_curvature", "mean_curvature", "patch_completeness", "principal_curvature_1"):
            error = np.abs(level[name][...] - exact[name])
            self.assertTrue((error <= 2.0 ** -14 * np.abs(exact[name])).all())
        ours, theirs = level["features"][...], exact["features"][...]
        for member in ("vertex", "kind", "contour_point"):
            np.testing.assert_array_equal(ours[member], theirs[member])
        for member, most in (("position", 1e-3 * step), ("initial_position", 1e-3 * step), ("normal", 1e-3)):
            self.assertLessEqual(np.abs(ours[member] - theirs[member]).max(), most)
        error = np.abs(ours["value"] - theirs["value"])
        self.assertTrue((error <= 2.0 ** -14 * np.abs(theirs["value"])).all())

    def test_a_word_that_is_no_precision_is_refused(self):
        write_ply(self.scans / "a.ply", icosphere(1))
        self.semigeo("run", self.scans, "--output", self.archive, "--precision", "half", code=2)


class SphereDatasetTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        self.points, self.triangles = icosphere(4, RADIUS)
        write_ply(self.scans / "sphere.ply", (self.points, self.triangles))
        self.run_scans("--levels", LEVELS, "--unit", "mm")
        self.file = h5py.File(self.dataset("sphere.ply"), "r")
        self.addCleanup(self.file.close)
        self.levels = [self.file[f"levels/{k:03d}"] for k in range(LEVELS + 1)]

    def test_says_where_it_comes_from(self):
        attributes = self.file.attrs
        self.assertEqual(attributes["format"], b"semigeo-dataset")
        self.assertEqual(attributes["creator"], b"semigeo")
        self.assertEqual(attributes["length_unit"], b"mm")
        self.assertEqual(attributes["complete"], 1)
        self.assertEqual(json.loads(attributes["parameters"]),
                         {"compression": "deflate", "coordinates": "semigeodesic",
                          "decimate": "0.0 edges", "feature_completeness": 0.6,
                          "feature_radius": 1.5, "fill_holes": 0, "target_vertices": 0, "weld": "auto",
                          "length_unit": "mm", "level": "slope", "levels": LEVELS,
                          "principal": False, "remesh": True, "rescale": "size",
                          "schedule": "uniform", "step": 1.0, "surface": "curved"})
        for name in ("input_xxh3", "digest", "job_key"):
            self.assertEqual(len(attributes[name]), 32, name)

    def test_level_zero_is_the_scan(self):
        np.testing.assert_array_equal(self.levels[0]["points"], self.points.astype("f4"))
        np.testing.assert_array_equal(self.levels[0]["triangles"], self.triangles)
        np.testing.assert_array_equal(self.levels[0]["source_vertex"], np.arange(len(self.points)))

    def test_curvature_is_that_of_the_sphere(self):
        for level in self.levels:
            gaussian = level["gaussian_curvature"][...] * RADIUS ** 2
            mean = level["mean_curvature"][...] * RADIUS
            self.assertLess(abs(np.median(gaussian) - 1), 1e-3)
            self.assertLess(abs(np.median(mean) + 1), 5e-4)
            self.assertLess(np.abs(gaussian - 1).max(), 0.005)
            self.assertLess(np.abs(mean + 1).max(), 0.003)
            np.testing.assert_array_equal(level["patch_completeness"], 1)
            radii = np.linalg.norm(level["points"], axis=1)
            np.testing.assert_allclose(radii, RADIUS, rtol=1e-3)
            outward = np.sum(level["points"] * level["normals"][...], axis=1) / radii
            self.assertGreater(outward.min(), 0.999)

    def test_scales_grow_with_the_smoothings(self):
        scales = [level.attrs["scale"] for level in self.levels]
        step = self.levels[0].attrs["step"]
        np.testing.assert_allclose(scales, step * np.sqrt(np.arange(LEVELS + 1) + 1), rtol=1e-3)
        self.assertEqual([level.attrs["iteration"] for level in self.levels],
                         list(range(LEVELS + 1)))


class OptionsDatasetTest(SemigeoTest):
    def levels(self, *options):
        write_ply(self.scans / "sphere.ply", icosphere(4, RADIUS))
        self.run_scans("--levels", LEVELS, *options)
        file = h5py.File(self.dataset("sphere.ply"), "r")
        self.addCleanup(file.close)
        return [file[f"levels/{k:03d}"] for k in range(LEVELS + 1)]

    def test_octaves_double_the_scale_in_two_levels(self):
        levels = self.levels("--schedule", "octaves")
        step = levels[0].attrs["step"]
        np.testing.assert_allclose([level.attrs["scale"] / step for level in levels],
                                   [1, 2 ** 0.5, 2, 2 ** 1.5], rtol=5e-3)
        np.testing.assert_allclose([level.attrs["step"] / step for level in levels],
                                   [1, 1, 2 ** 0.5, 2], rtol=5e-3)
        radii = [np.linalg.norm(level["points"], axis=1).mean() for level in levels]
        self.assertTrue(np.all(np.diff(radii) < 0))  # nothing is rescaled

    def test_too_many_octaves_are_refused(self):
        process = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 17,
                               "--schedule", "octaves", code=2)
        self.assertIn("at most 16", process.stderr)

    def test_polar_patches_see_the_same_sphere(self):
        for level in self.levels("--coordinates", "polar"):
            self.assertLess(abs(np.median(level["mean_curvature"]) * RADIUS + 1), 1e-3)

    def test_principal_curvatures_and_directions(self):
        for level in self.levels("--principal"):
            for name in ("principal_curvature_1", "principal_curvature_2"):
                self.assertLess(np.abs(level[name][...] * RADIUS + 1).max(), 0.02)
            first, second = level["principal_direction_1"], level["principal_direction_2"]
            np.testing.assert_allclose(np.linalg.norm(first, axis=1), 1, rtol=1e-5)
            np.testing.assert_allclose(np.cross(first, second), level["normals"], atol=0.01)
        process = self.semigeo("export", self.dataset("sphere.ply"), "--quality",
                               "principal_curvature_2", "--output", self.folder / "k2.ply")
        self.assertIn("principal_curvature_2", process.stdout)
        self.assertIn("1 checked, 0 broken", self.semigeo("check", self.archive).stdout)


class PreparedDatasetTest(SemigeoTest):
    def holed(self):
        points, triangles = icosphere(4, RADIUS)
        keep = ~np.isin(triangles, [20, 100, 150]).any(axis=1)
        return points, triangles[keep]

    def test_filled_holes_are_marked_in_every_level(self):
        write_ply(self.scans / "holed.ply", self.holed())
        process = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 1,
                               "--fill-holes", 10)
        self.assertIn("prepared: holed.ply: 3 of 3 holes filled", process.stdout)
        with h5py.File(self.dataset("holed.ply"), "r") as file:
            counts = json.loads(file.attrs["preparation"])
            self.assertEqual(counts["holes_filled"], 3)
            for level in file["levels"].values():
                self.assertEqual(level["face_filled"].dtype, np.dtype("u1"))
                self.assertEqual(np.sum(level["face_filled"]), counts["filled_faces"])
                self.assertEqual(np.sum(level["vertex_filled"]), counts["filled_vertices"])
                self.assertEqual(level["patch_completeness"][...].min(), 1)
            self.assertIn("vertex_filled", file["VTKHDF/PointData"])
        self.assertIn("1 checked, 0 broken", self.semigeo("check", self.archive).stdout)
        document = json.loads(self.semigeo("info", self.dataset("holed.ply"), "--json").stdout)
        self.assertEqual(document["preparation"], counts)

    def test_decimation_by_tolerance_and_by_target(self):
        write_ply(self.scans / "sphere.ply", icosphere(4, RADIUS))
        self.run_scans("--levels", 0, "--unit", "mm", "--decimate", "0.05mm")
        with h5py.File(self.dataset("sphere.ply"), "r") as file:
            counts = json.loads(file.attrs["preparation"])
            self.assertEqual(counts["decimation_tolerance"], 0.05)
            self.assertLess(counts["decimation_distance_maximum"], 0.055)
            self.assertLess(len(file["levels/000/points"]), 2000)
        document = self.run_scans("--levels", 0, "--target-vertices", 800)
        self.assertEqual(document["scans"][0]["preparation"]["removed_vertices"], 1762)
        with h5py.File(self.dataset("sphere.ply"), "r") as file:
            self.assertEqual(len(file["levels/000/points"]), 800)

    def test_a_tolerance_in_another_unit_is_refused(self):
        write_ply(self.scans / "sphere.ply", icosphere(1))
        for text, word in (("0.1cm", "not cm"), ("fine", "positive"), ("-1", "positive"),
                           ("nan", "positive")):
            process = self.semigeo("run", self.scans, "--output", self.archive, "--unit", "mm",
                                   f"--decimate={text}", code=2)
            self.assertIn(word, process.stderr)


class SeveralPartsDatasetTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        square = plane(30)  # edges as long as the sphere's
        mesh = joined(icosphere(3), (4.5 * square[0] + 3, square[1]))
        write_ply(self.scans / "parts.ply", mesh)
        self.run_scans("--levels", LEVELS)
        self.file = h5py.File(self.dataset("parts.ply"), "r")
        self.addCleanup(self.file.close)
        self.levels = [self.file[f"levels/{k:03d}"] for k in range(LEVELS + 1)]
        self.vertices, self.faces = len(mesh[0]), len(mesh[1])

    def test_vtkhdf_shows_the_levels(self):
        vtk = self.file["VTKHDF"]
        self.assertEqual(vtk.attrs["Type"], b"PolyData")
        self.assertEqual(list(vtk.attrs["Version"]), [2, 0])
        names = {"Normals": "normals"} | {name: name for name in (
            "gaussian_curvature", "mean_curvature", "patch_completeness", "part", "source_vertex")}
        self.assertEqual(set(vtk["PointData"]), set(names))
        steps = vtk["Steps"]
        self.assertEqual(steps.attrs["NSteps"], LEVELS + 1)
        np.testing.assert_array_equal(steps["Values"], [l.attrs["scale"] for l in self.levels])
        for k, level in enumerate(self.levels):
            rows = slice(steps["PointOffsets"][k], steps["PointOffsets"][k] + self.vertices)
            np.testing.assert_array_equal(vtk["Points"][rows], level["points"])
            for shown, name in names.items():
                first = steps["PointDataOffsets"][shown][k]
                np.testing.assert_array_equal(vtk["PointData"][shown][first:first + self.vertices],
                                              level[name], err_msg=f"{k} {name}")
        np.testing.assert_array_equal(vtk["Polygons/Connectivity"],
                                      np.ravel(self.levels[0]["triangles"]))
        np.testing.assert_array_equal(vtk["Polygons/Offsets"], 3 * np.arange(self.faces + 1))

    def test_parts_and_rims_are_told(self):
        level = self.levels[0]
        self.assertEqual(level.attrs["parts"], 2)
        np.testing.assert_array_equal(level["part"][...], np.arange(self.vertices) >= 642)
        completeness = level["patch_completeness"][...]
        np.testing.assert_array_equal(completeness[:642], 1)
        self.assertGreater(np.sum(completeness[642:] < 1), 4 * 30)  # the rim of the square
        self.assertGreater(np.sum(completeness[642:] == 1), 100)    # its middle
        # All four corners, and nothing but rims, may be invalid.
        self.assertLess(np.sum(completeness == 0), 20)

    def test_the_sidecar_refers_to_what_there_is(self):
        sidecar = self.dataset("parts.ply").with_suffix(".xdmf")
        items = ElementTree.parse(sidecar).getroot().findall(".//DataItem")
        self.assertGreaterEqual(len(items), 4 * (LEVELS + 1))
        for item in items:
            name, path = item.text.strip().split(":")
            self.assertEqual(name, "parts.ply.vtkhdf")
            self.assertEqual([int(n) for n in item.attrib["Dimensions"].split()],
                             list(self.file[path].shape))


class FarAwayDatasetTest(SemigeoTest):
    def test_map_coordinates_keep_their_detail(self):
        points, triangles = icosphere(3)
        points = points + (4_500_000.25, -5_400_000.5, 812.125)
        write_ply(self.scans / "far.ply", (points, triangles))
        self.run_scans("--levels", 1)
        with h5py.File(self.dataset("far.ply"), "r") as file:
            stored = file["levels/000/points"][...] + file.attrs["origin"]
            np.testing.assert_allclose(stored, points, rtol=0, atol=1e-6)
            np.testing.assert_allclose(file["levels/001/mean_curvature"], -1, atol=0.03)


if __name__ == "__main__":
    unittest.main()
