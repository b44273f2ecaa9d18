"""The sidecar of a dataset in Debian's ParaView, which knows no VTKHDF with time steps."""

import ast
import shutil
import subprocess
import unittest

import h5py

from support import SemigeoTest, icosphere, write_ply

PARAVIEW = """
import sys
from paraview.simple import *
reader = XDMFReader(FileNames=[sys.argv[1]])
reader.UpdatePipeline()
steps = list(reader.TimestepValues)
names = sorted(reader.PointArrayStatus)
points = []
for step in steps:
    reader.UpdatePipeline(step)
    points.append(reader.GetDataInformation().GetNumberOfPoints())
print(repr((steps, names, points)))
"""


class ParaviewTest(SemigeoTest):
    """Slow: ParaView takes seconds to start, where it is installed."""

    def test_the_sidecar_has_all_levels_and_named_arrays(self):
        paraview = shutil.which("pvpython")
        if paraview is None:
            self.skipTest("ParaView (pvpython) is not installed")
        write_ply(self.scans / "a.ply", icosphere(3))
        self.run_scans("--levels", "8")
        sidecar = self.archive / "scans/a.ply.xdmf"
        process = subprocess.run([paraview, "-c", PARAVIEW, sidecar], capture_output=True, text=True, timeout=280)
        self.assertEqual(process.returncode, 0, process.stderr)
        steps, names, points = ast.literal_eval(process.stdout.strip().splitlines()[-1])
        self.assertEqual(len(steps), 9)
        self.assertIn("mean_curvature", names)
        with h5py.File(self.dataset("a.ply"), "r") as file:
            self.assertEqual(points, [len(level["points"]) for level in file["levels"].values()])
            self.assertEqual(steps, [level.attrs["scale"] for level in file["levels"].values()])


if __name__ == "__main__":
    unittest.main()
