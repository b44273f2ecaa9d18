"""The program that looks for the same features again on changed meshes: its table and its rows."""

import csv
import unittest
from collections import defaultdict

import numpy as np

from support import SemigeoTest, boulder, plane, write_ply

COLUMNS = (
    "mesh,case,kind,level,radius,mean_edge_length,scale,changed_level,changed_scale,features,"
    "features_changed,share,chance,share_prominent,share_2_edges,share_scale,"
    "median_distance_edges,median_miss_edges"
).split(",")
CASES = ("identity,rotated,decimated,decimated+noise,resampled,resampled+noise,noise,cut,"
         "decimated+cut").split(",")
KINDS = "gaussian,mean,gaussian_torsion,mean_torsion".split(",")


class RepeatabilityTest(SemigeoTest):
    def measure(self, *arguments):
        """Rows of the CSV by case."""
        table = self.folder / "repeats.csv"
        self.process = self.semigeo(*arguments, "--csv", table)
        self.text = table.read_text()
        reader = csv.DictReader(self.text.splitlines())
        cases = defaultdict(list)
        for row in reader:
            cases[row["case"]].append(row)
        self.assertEqual(reader.fieldnames, COLUMNS)
        return cases

    def maxima(self, rows, column):
        return np.array([float(r[column]) for r in rows
                         if r["kind"] in KINDS[:2] and r["radius"] == "1" and r["level"] == "1"])

    def test_the_same_mesh_has_the_same_features_and_others_most_of_them(self):
        path = write_ply(self.scans / "boulder.ply", boulder(3, 5))
        cases = self.measure(path, "--closed", "--levels", 1)
        self.assertEqual(list(cases), CASES)
        for name, rows in cases.items():
            self.assertEqual(len(rows), 2 * (2 * 4 + 2), name)
            self.assertEqual({r["mesh"] for r in rows}, {"boulder.ply"})
            self.assertTrue((self.maxima(rows, "features") > 0).all(), name)
            share, chance = self.maxima(rows, "share"), self.maxima(rows, "chance")
            if "cut" not in name:  # few are left
                self.assertTrue((share > chance + 0.2).all(), (name, share, chance))
            self.assertTrue((share <= self.maxima(rows, "share_2_edges")).all())
            self.assertTrue((np.abs(np.log2(self.maxima(rows, "scale") /
                                            self.maxima(rows, "changed_scale"))) < 0.3).all())
        for row in cases["identity"]:
            if int(row["features"]) > 0:
                self.assertEqual(row["share"], "1", row)
                self.assertEqual(row["median_distance_edges"], "0", row)
        self.assertTrue((self.maxima(cases["rotated"], "share") > 0.9).all())
        self.assertTrue((self.maxima(cases["cut"], "features") <
                         self.maxima(cases["identity"], "features")).all())
        for name in CASES:
            self.assertRegex(self.process.stdout, rf"(?m)^{name.replace('+', '[+]')} +level \| radius 0 ")
            self.assertIn(f"\nbest kind and level, {name}: ", self.process.stdout)
        for kind in KINDS:
            for level in 0, 1:
                self.assertRegex(self.process.stdout, rf"(?m)^{kind} +{level} \| +(100|-) \(")

    def test_results_repeat_on_any_number_of_threads_and_follow_the_seed(self):
        path = write_ply(self.scans / "boulder.ply", boulder(3, 5))
        arguments = (path, "--levels", 0, "--cases", "decimated+noise", "--strong")
        texts = []
        for more in (("--threads", 1), ("--threads", 2), ("--seed", 2)):
            self.measure(*arguments, *more)
            texts.append(self.text)
        self.assertEqual(texts[0], texts[1])
        self.assertNotEqual(texts[0], texts[2])

    def test_meshes_with_a_boundary_are_skipped_and_named_if_so_wanted(self):
        path = write_ply(self.scans / "plane.ply", plane(10))
        cases = self.measure(path, "--closed", "--levels", 0, "--schedule", "uniform")
        self.assertEqual(len(cases), 0)
        self.assertIn("plane.ply: skipped", self.process.stderr)
        self.assertEqual(len(self.measure(path, "--levels", 0, "--cases", "cut")["cut"]), 10)

    def test_a_scan_that_cannot_be_read_fails_and_misuse_is_exit_code_2(self):
        bad = self.scans / "bad.ply"
        bad.write_text("no scan")
        self.assertIn("bad.ply", self.semigeo(bad, code=1).stderr)
        self.assertEqual(self.semigeo("--help").stdout.strip().splitlines()[0], "Examples:")
        for arguments in ((), ("none.ply",), (bad, "--cases", "bent"), (bad, "--levels", -1)):
            with self.subTest(arguments=arguments):
                self.semigeo(*arguments, code=2)


if __name__ == "__main__":
    unittest.main()
