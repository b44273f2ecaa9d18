"""Real scans lose what is thin before what is thick, and nothing else (thesis 6.1).
Usage: small_parts_test.py PROGRAM FOLDER, where FOLDER holds the scans."""

import shutil
import sys
import unittest
from pathlib import Path

import h5py
import numpy as np

from support import SemigeoTest

DATA = Path(sys.argv.pop(1))
LEVELS = 12
LOST = 5  # mean edge lengths: more than the whole width of what is lost


def farthest(points, others):
    """The largest distance of a point to the nearest of others."""
    return max(np.sqrt(np.min(np.sum((others - p) ** 2, axis=1))) for p in points)


class SmallPartsTest(SemigeoTest):
    def evolve(self, name):
        shutil.copy(DATA / name, self.scans)
        self.run_scans("--levels", LEVELS)
        with h5py.File(self.dataset(name), "r") as file:
            self.levels = [file[f"levels/{k:03d}/points"][...] for k in range(LEVELS + 1)]
            self.edge = file["levels/000"].attrs["mean_edge_length"]
        return self.levels[0]

    def recession(self, region, level):
        """How far the surface has left a region of level 0, at most, in mean edge lengths."""
        points = self.levels[0][region]
        return farthest(points[::len(points) // 200 + 1], self.levels[level]) / self.edge

    def lost_at(self, region):
        """The first level that has left the region, one behind the last if there is none."""
        levels = range(1, LEVELS + 1)
        return next((k for k in levels if self.recession(region, k) > LOST), LEVELS + 1)

    def test_bunny_loses_its_ears_and_keeps_the_rest(self):
        points = self.evolve("npm_bunny.obj")
        x, y, _ = points.T
        ears = [(y > 7.2) & (x < -2), (y > 7.2) & (x >= -2)]
        for ear in ears:  # the thesis' rabbit: after 10 iterations
            self.assertIn(self.lost_at(ear), range(2, 6))
        self.assertLess(self.recession(y < 6, LEVELS), 3)

    def test_goat_loses_its_horns_then_its_ears_and_keeps_its_head(self):
        points = self.evolve("os_goathead.obj")
        x, y, z = points.T
        horns = [(y > 7.5) & (z > 0), (y > 7.5) & (z < 0)]
        ears = [(y < 7) & (z > 4.2), (y < 7) & (z < -3.5)]
        horns_at = [self.lost_at(horn) for horn in horns]
        ears_at = [self.lost_at(ear) for ear in ears]
        self.assertGreater(min(horns_at), 2)
        self.assertLess(max(horns_at), min(ears_at))
        self.assertLess(max(ears_at), LEVELS)
        head = ~np.any(horns + ears, axis=0)
        self.assertLess(self.recession(head & (y < 4), LEVELS), 3)

    def test_mug_loses_its_handle_then_its_wall(self):
        points = self.evolve("obj_mug.obj")
        x = points[:, 0]
        handle = x < -0.045
        handle_at = self.lost_at(handle)
        self.assertIn(handle_at, range(3, 8))
        self.assertGreater(self.lost_at(x > -0.02), handle_at)


if __name__ == "__main__":
    unittest.main()
