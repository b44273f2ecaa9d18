"""The program that measures accuracy: its tables, plots, and that it finds what is known."""

import csv
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np

from support import SemigeoTest, icosphere, write_ply

SVG = "{http://www.w3.org/2000/svg}"
DIRECTION_COLUMNS = (
    "iteration,step_factor,step,quantity,over_directions,mean_percent,median_percent,p95_percent,"
    "mean_percent_of_surface,median_percent_of_surface,vertices_used,vertices_near_zero,"
    "vertices_truncated").split(",")
ANALYTIC_COLUMNS = (
    "shape,tessellation,vertices,surface,coordinates,noise,level,zone,K_median_percent,"
    "K_p95_percent,H_median_percent,H_p95_percent,vertices_used,vertices_invalid,"
    "first_level_us_per_vertex,level_us_per_vertex").split(",")


def read_csv(path):
    with open(path, newline="") as file:
        reader = csv.DictReader(file)
        return reader.fieldnames, list(reader)


class DirectionsTest(SemigeoTest):
    def directions(self, mesh, *arguments):
        path = write_ply(self.scans / "scan.ply", mesh)
        out = self.folder / "out"
        self.semigeo("directions", path, "--output", out, *arguments)
        columns, rows = read_csv(out / "scan.csv")
        self.assertEqual(columns, DIRECTION_COLUMNS)
        return out, rows

    def test_a_sphere_looks_the_same_in_all_directions(self):
        out, rows = self.directions(icosphere(3, radius=50.0), "--iterations", "0,2",
                                    "--steps", "0.5,1,1.5")
        self.assertEqual(len(rows), 2 * 3 * 2 * 3)
        for row in rows:
            self.assertEqual([row[f"vertices_{kind}"] for kind in ("used", "near_zero", "truncated")],
                             ["642", "0", "0"])
            self.assertLess(float(row["mean_percent"]), 0.5, row)
            self.assertAlmostEqual(float(row["mean_percent"]),
                                   float(row["mean_percent_of_surface"]), delta=0.01)
        steps = {row["step_factor"]: float(row["step"]) for row in rows}
        self.assertAlmostEqual(steps["1.5"], 3 * steps["0.5"], places=3)

    def test_maximum_average_and_minimum_are_in_order(self):
        points, triangles = icosphere(3)
        rough = points * (1 + 0.02 * np.sin(37 * points[:, [1]] + 11 * points[:, [0]]))
        _, rows = self.directions((rough, triangles), "--iterations", "0,8", "--steps", "1")
        value = {(r["iteration"], r["quantity"], r["over_directions"]): float(r["mean_percent"])
                 for r in rows}
        for iteration in "0", "8":
            for quantity in "K", "H":
                low, middle, high = (value[iteration, quantity, over]
                                     for over in ("min", "mean", "max"))
                self.assertLess(low, middle)
                self.assertLess(middle, high)
        self.assertLess(value["8", "K", "mean"], value["0", "K", "mean"] / 2)

    def test_vertices_without_curvature_or_with_truncated_patches_are_counted(self):
        i, j = np.divmod(np.arange(441), 21)
        z = np.where(i > 10, 0.01 * (i - 10) ** 2, 0)  # K = 0 everywhere
        corner = (np.arange(20)[:, None] * 21 + np.arange(20)).ravel()
        triangles = np.concatenate([np.stack([corner, corner + 21, corner + 22], 1),
                                    np.stack([corner, corner + 22, corner + 1], 1)])
        _, rows = self.directions((np.stack([i, j, z], 1), triangles), "--iterations", "0",
                                  "--steps", "1", "--surface", "flat")
        row = next(r for r in rows if r["quantity"] == "H")
        self.assertGreater(int(row["vertices_truncated"]), 80)
        self.assertGreater(int(row["vertices_near_zero"]), 10)
        self.assertEqual(441, sum(int(row[f"vertices_{kind}"])
                                  for kind in ("used", "near_zero", "truncated")))

    def test_plots_are_svg_with_a_curve_for_each_iteration(self):
        out, _ = self.directions(icosphere(2), "--iterations", "0,1,3", "--steps", "0.75,1")
        for suffix in "", "_median":
            for quantity in "K", "H":
                for over in "max", "min", "mean":
                    root = ElementTree.parse(out / f"scan_{quantity}_{over}{suffix}.svg").getroot()
                    self.assertEqual(root.tag, f"{SVG}svg")
                    circles = root.findall(f"{SVG}g/{SVG}circle")
                    self.assertEqual(len(circles), 3 * 2)
                    for circle in circles:
                        self.assertTrue(0 < float(circle.get("cx")) < float(root.get("width")))
                        self.assertTrue(0 < float(circle.get("cy")) < float(root.get("height")))
                    texts = [text.text for text in root.iter(f"{SVG}text")]
                    self.assertIn("step size, mean edge lengths", texts)
                    self.assertEqual(texts[-4:], ["iterations", "0", "1", "3"])
            sheet = ElementTree.parse(out / f"scan{suffix}.svg").getroot()
            self.assertEqual(len(sheet.findall(f"{SVG}g")), 6)

    def test_a_mesh_that_cannot_be_read_fails_and_the_others_go_on(self):
        bad = self.scans / "bad.ply"
        bad.write_text("no scan")
        good = write_ply(self.scans / "good.ply", icosphere(1))
        out = self.folder / "out"
        process = self.semigeo("directions", bad, good, "--output", out, "--iterations", "0",
                               "--steps", "1", code=1)
        self.assertIn("bad.ply", process.stderr)
        self.assertTrue((out / "good.csv").exists())
        self.assertFalse((out / "bad.csv").exists())


class AnalyticTest(SemigeoTest):
    def analytic(self, *arguments):
        path = self.folder / "errors.csv"
        process = self.semigeo("analytic", "--csv", path, "--runs", 1, *arguments)
        columns, rows = read_csv(path)
        self.assertEqual(columns, ANALYTIC_COLUMNS)
        return process.stdout, rows

    def test_known_errors(self):
        text, rows = self.analytic("--shapes", "sphere,cylinder", "--vertices", 2500, "--noise",
                                   "0,0.05", "--levels", 4)
        for shape in "sphere", "cylinder":
            self.assertRegex(text, rf"(?m)^{shape} +even ")
        exact = [r for r in rows if r["noise"] == "0" and r["zone"] == "inside"]
        self.assertEqual(len(exact), 2 * 4)
        for row in exact:
            self.assertLess(float(row["K_median_percent"]), 0.2, row)
            self.assertLess(float(row["H_median_percent"]), 0.1, row)
            self.assertGreater(float(row["first_level_us_per_vertex"]),
                               float(row["level_us_per_vertex"]))
        noisy = {(r["shape"], r["tessellation"], r["level"]): float(r["K_median_percent"])
                 for r in rows if r["noise"] != "0" and r["zone"] == "inside"}
        self.assertLess(noisy["sphere", "even", "4"], noisy["sphere", "even", "0"] / 5)
        zones = {r["zone"] for r in rows if r["shape"] == "cylinder"}
        self.assertEqual(zones, {"inside", "ring 0", "ring 1", "ring 2"})

    def test_flat_faces_have_their_bias(self):
        _, rows = self.analytic("--shapes", "sphere", "--vertices", 2500, "--noise", "0",
                                "--surface", "curved,flat", "--coordinates", "semigeodesic,polar")
        self.assertEqual(len(rows), 4 * 4)
        for row in rows:
            error = float(row["K_median_percent"])
            if row["surface"] == "flat":
                self.assertTrue(2 < error < 12, row)
            else:
                self.assertLess(error, 0.3, row)


class UsageTest(SemigeoTest):
    def test_help_begins_with_examples(self):
        for arguments in ((), ("directions",), ("analytic",)):
            text = self.semigeo(*arguments, "--help").stdout
            self.assertEqual(text.strip().splitlines()[0], "Examples:", arguments)

    def test_misuse_is_exit_code_2(self):
        mesh = write_ply(self.scans / "a.ply", icosphere(0))
        for arguments in ((), ("directions",), ("directions", mesh), ("directions", "none.ply"),
                          ("directions", mesh, "--output", self.folder / "o", "--steps", "0"),
                          ("analytic", "--shapes", "cube"), ("analytic", "--surface", "round")):
            with self.subTest(arguments=arguments):
                self.semigeo(*arguments, code=2)


if __name__ == "__main__":
    unittest.main()
