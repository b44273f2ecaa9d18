"""The program that follows surfaces through their levels: its tables, its plot, and its counts."""

import csv
import json
import math
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np

from support import SemigeoTest, icosphere, joined, plane, write_ply

SVG = "{http://www.w3.org/2000/svg}"
COLUMNS = (
    "vertices,triangles,parts,boundary_edges,moved,moved_from_first,volume,area,mean_edge,"
    "shortest_edge,split,collapsed,torn,dropped_parts,remeshing_seconds,remeshing_cpu_seconds,"
    "smoothing_seconds,smoothing_cpu_seconds"
).split(",")


class EvolutionTest(SemigeoTest):
    def evolve(self, *arguments):
        """Columns of the CSV as arrays, and the entries of the JSON."""
        table, document = self.folder / "levels.csv", self.folder / "levels.json"
        self.process = self.semigeo(*arguments, "--csv", table, "--json", document)
        with open(table, newline="") as file:
            reader = csv.DictReader(file)
            rows = list(reader)
        self.assertEqual(reader.fieldnames, ["scan", "level", *COLUMNS])
        scans = json.loads(document.read_text())["scans"]
        self.assertEqual(len(rows), sum(len(scan["levels"]) for scan in scans))
        for row, level in zip(rows, (level for scan in scans for level in scan["levels"])):
            self.assertEqual(sorted(level), sorted(COLUMNS))
            for name in COLUMNS:
                value = math.nan if level[name] is None else level[name]
                np.testing.assert_allclose(float(row[name]), value, rtol=1e-6)
        return {name: np.array([float(row[name]) for row in rows]) for name in COLUMNS}, scans

    def test_a_sphere_keeps_its_size(self):
        path = write_ply(self.scans / "sphere.ply", icosphere(3, radius=5.0))
        level, scans = self.evolve(path, "--levels", 3)
        np.testing.assert_array_equal(level["vertices"], 642)
        np.testing.assert_array_equal(level["triangles"], 1280)
        np.testing.assert_allclose(level["volume"], 4 / 3 * np.pi * 125, rtol=0.02)
        np.testing.assert_allclose(level["area"], 4 * np.pi * 25, rtol=0.02)
        self.assertEqual(level["moved"][0], 0)
        self.assertTrue((level["moved_from_first"] < 0.02).all())
        self.assertEqual(scans[0]["name"], "sphere.ply")
        self.assertRegex(self.process.stdout, r"(?m)^sphere.ply: 642 vertices;")

    def test_without_rescaling_it_shrinks_and_that_is_how_far_it_moved(self):
        path = write_ply(self.scans / "sphere.ply", icosphere(3, radius=5.0))
        level, _ = self.evolve(path, "--levels", 3, "--rescale", "none", "--no-remesh")
        radius = np.sqrt(level["area"] / (4 * np.pi))
        self.assertTrue((np.diff(radius) < 0).all())
        edge = level["mean_edge"][0]
        np.testing.assert_allclose(level["moved_from_first"], (radius[0] - radius) / edge,
                                   rtol=0.02, atol=1e-6)
        np.testing.assert_allclose(np.cumsum(level["moved"]), level["moved_from_first"], rtol=1e-3)

    def test_parts_rims_and_what_was_done_are_counted(self):
        small = icosphere(0, radius=0.01)
        path = write_ply(self.scans / "two.ply", joined(plane(20), (small[0] + 3, small[1])))
        level, _ = self.evolve(path, "--levels", 2)
        self.assertEqual(level["parts"][0], 2)
        self.assertEqual(level["boundary_edges"][0], 80)
        self.assertEqual(level["parts"][1], 1)
        self.assertEqual(level["vertices"][0], 441 + 12)
        self.assertGreater(level["collapsed"][1] + level["dropped_parts"][1], 0)
        self.assertGreater(level["volume"][0], 0)
        self.assertEqual(level["volume"][1], 0)
        np.testing.assert_allclose(
            level["shortest_edge"][0],
            np.linalg.norm(small[0][small[1]] - np.roll(small[0][small[1]], 1, 1), axis=2).min(),
            rtol=1e-3)

    def test_shapes_and_scans_share_one_plot(self):
        path = write_ply(self.scans / "sphere.ply", icosphere(2))
        plot = self.folder / "levels.svg"
        self.evolve(path, "--shape", "torus", "--vertices", 900, "--noise", 0.1, "--levels", 4,
                    "--plot", plot)
        root = ElementTree.parse(plot).getroot()
        self.assertEqual(len(root.findall(f"{SVG}g")), 3)
        self.assertEqual(len(root.findall(f"{SVG}g/{SVG}circle")), 3 * 2 * 5)
        texts = [text.text for text in root.iter(f"{SVG}text")]
        self.assertEqual(texts[-3:], ["scan", "sphere.ply", "torus"])

    def test_a_scan_that_cannot_be_read_fails_and_the_others_go_on(self):
        bad = self.scans / "bad.ply"
        bad.write_text("no scan")
        good = write_ply(self.scans / "good.ply", icosphere(1))
        process = self.semigeo(bad, good, "--levels", 0, code=1)
        self.assertIn("bad.ply", process.stderr)
        self.assertIn("good.ply", process.stdout)

    def test_help_begins_with_examples_and_misuse_is_exit_code_2(self):
        self.assertEqual(self.semigeo("--help").stdout.strip().splitlines()[0], "Examples:")
        for arguments in ((), ("none.ply",), ("--shape", "cube"), ("--shape", "torus", "--levels", -1)):
            with self.subTest(arguments=arguments):
                self.semigeo(*arguments, code=2)


if __name__ == "__main__":
    unittest.main()
