"""Real scans: every one is processed, with the losses that its defects cost and no others.
Usage: real_scans_test.py PROGRAM FOLDER, where FOLDER/MANIFEST.tsv says what the files hold."""

import csv
import json
import shutil
import sys
import unittest
from pathlib import Path

import h5py
import numpy as np

from support import SemigeoTest, cpu_of_children

DATA = Path(sys.argv.pop(1))
LEVELS = 8

# What each scan's defects cost; every other scan is used as it is.
REPAIRS = {
    "assimp_WusonOBJ": {"split_vertices": 9},
    "bff_teapot": {"welded_vertices": 25, "split_vertices": 1},
    "obj_large_clamp": {"welded_vertices": 2, "degenerate_faces": 4, "duplicate_faces": 4,
                        "isolated_vertices": 2},
    "obj_mug": {"welded_vertices": 3, "degenerate_faces": 6, "duplicate_faces": 6,
                "isolated_vertices": 3},
    "obj_spoon": {"welded_vertices": 1, "degenerate_faces": 2, "duplicate_faces": 2,
                  "isolated_vertices": 1},
    "occt_propeller": {"welded_vertices": 18436, "degenerate_faces": 1, "flipped_faces": 4},
    "opencv_bunny_nonmanifold": {"duplicate_faces": 83, "flipped_faces": 4,
                                 "nonmanifold_edges": 103, "split_vertices": 164,
                                 "isolated_vertices": 2},
    "os_lionstatue": {"flipped_faces": 2},
    "syn_skull_noisy_holes": {"split_vertices": 15, "isolated_vertices": 2812},
    "tm_chair_model": {"welded_vertices": 28, "duplicate_faces": 6382, "flipped_faces": 22,
                       "nonmanifold_edges": 51, "split_vertices": 54, "turned_parts": 1},
    "uwa_parasaurolophus_28k": {"nonmanifold_edges": 4, "split_vertices": 21, "turned_parts": 1},
    "uwa_parasaurolophus_6700": {"split_vertices": 13, "turned_parts": 1},
    "uwa_scene_rs1": {"split_vertices": 9},
}


def manifest():
    with open(DATA / "MANIFEST.tsv", newline="") as file:
        rows = list(csv.DictReader(file, delimiter="\t"))
    numbers = ("vertices", "faces", "boundary_edges", "nonmanifold_edges", "components",
               "degenerate_faces")
    return [row | {key: int(row[key]) for key in numbers} for row in rows]


class RealScansTest(SemigeoTest):
    def check_counts(self, row, scan):
        repairs = scan["repairs"]
        wanted = REPAIRS.get(row["name"], {})
        self.assertEqual({k: n for k, n in repairs.items() if n != 0}, wanted)
        vertices, faces = row["vertices"], row["faces"]
        if row["file"].endswith(".stl"):
            vertices = 3 * faces  # the manifest counts them welded
        self.assertEqual(scan["vertices"], vertices - repairs["welded_vertices"] -
                         repairs["gap_vertices"] - repairs["isolated_vertices"] + repairs["split_vertices"])
        self.assertEqual(scan["triangles"], faces - repairs["degenerate_faces"] -
                         repairs["duplicate_faces"])
        defects = row["nonmanifold_edges"] + row["degenerate_faces"]
        if defects == 0:  # then no face is lost, whatever else is wrong
            self.assertEqual(scan["triangles"], row["faces"])
        if not wanted:
            self.assertEqual((scan["vertices"], scan["parts"]),
                             (row["vertices"], row["components"]))

    def check_fields(self, row, path):
        with h5py.File(path, "r") as file:
            levels = [file[f"levels/{k:03d}"] for k in range(LEVELS + 1)]
            scales = [level.attrs["scale"] for level in levels]
            self.assertTrue(np.all(np.diff(scales) > 0), scales)
            corners = levels[0]["points"][...][levels[0]["triangles"][...]]
            size = np.ptp(corners.reshape(-1, 3), axis=0).max()
            for level in levels:
                for name in ("points", "normals", "gaussian_curvature", "mean_curvature",
                             "patch_completeness"):
                    self.assertTrue(np.all(np.isfinite(level[name])), name)
                valid = level["patch_completeness"][...] > 0
                np.testing.assert_allclose(
                    np.linalg.norm(level["normals"][...][valid], axis=1), 1, atol=1e-4)
                # No vertex flies off, however bad the mesh.
                self.assertLess(np.ptp(level["points"], axis=0).max(), 1.5 * size)
            completeness = levels[0]["patch_completeness"][...]
            if row["boundary_edges"] == 0 and row["name"] not in REPAIRS:
                self.assertGreater(np.mean(completeness == 1), 0.95)

    def test_all(self):
        rows = manifest()
        document = self.semigeo_json("run", DATA, "--output", self.archive, "--levels", LEVELS)
        scans = {Path(scan["input"]).name: scan for scan in document["scans"]}
        self.assertEqual(sorted(scans), sorted(row["file"] for row in rows))
        for row in rows:
            with self.subTest(scan=row["name"]):
                scan = scans[row["file"]]
                self.assertEqual(scan["state"], "done", scan.get("error"))
                self.check_counts(row, scan)
                self.check_fields(row, self.dataset(row["file"]))
        self.semigeo("check", self.archive)
        largest = max(scan["vertices"] for scan in scans.values())
        self.assertLess(document["peak_memory_bytes"], 50e6 + 1000 * largest)

        start = cpu_of_children()
        again = self.semigeo_json("run", DATA, "--output", self.archive, "--levels", LEVELS)
        self.assertEqual((again["up_to_date"], again["done"], again["failed"]), (len(rows), 0, 0))
        self.assertLess(cpu_of_children() - start, 2)

    def test_small_ones_have_the_same_bytes_on_one_thread_and_on_two(self):
        for row in manifest():
            if row["vertices"] < 6000:
                shutil.copy(DATA / row["file"], self.scans)
        archives = [self.folder / "one", self.folder / "two"]
        for threads, archive in enumerate(archives, 1):
            self.run_scans("--levels", 3, "--threads", threads, archive=archive)
        self.assert_same_archives(*archives)

    def semigeo_json(self, *arguments):
        return json.loads(self.semigeo(*arguments, "--json").stdout)


if __name__ == "__main__":
    unittest.main()
