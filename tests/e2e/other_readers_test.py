"""Files of semigeo, opened by readers that are not ours: NumPy, strict parsers of each format (strict.py), h5wasm, the
validator of Khronos, and VTK. Started as `python3 -B other_readers_test.py PROGRAM PACKAGES NODE`, where PACKAGES
has the npm packages of tests/e2e/readers, or is `none`."""

import json
import subprocess
import sys
import unittest
from pathlib import Path

PACKAGES, NODE = Path(sys.argv.pop(2)), sys.argv.pop(2)

import h5py
import numpy as np

import strict
from support import TIMEOUT, SemigeoTest, boulder, icosphere, plane, write_ply

class OtherReadersTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        points, triangles = boulder(3, 1)
        write_ply(self.scans / "near.ply", (points, triangles))
        write_ply(self.scans / "far.ply", (points + [4e6, 0, 5e5], triangles))
        write_ply(self.scans / "open.ply", plane(12))
        self.run_scans("--levels", "2", "--unit", "mm", "--principal")
        self.output = self.folder / "files"

    def export(self, name, *arguments, level=1, suffix="ply"):
        path = self.folder / f"{name}.{suffix}"
        self.semigeo("export", self.dataset(f"{name}.ply"), "--level", level, "--output", path, *arguments)
        return path

    def level(self, name, level=1):
        with h5py.File(self.dataset(f"{name}.ply"), "r") as file:
            arrays = {key: values[...] for key, values in file[f"levels/{level:03d}"].items()}
            return {**arrays, "origin": file.attrs["origin"]}

    def same(self, found, wanted):
        np.testing.assert_array_equal(found, wanted)

    def placed(self, level):
        """The points of a level in the coordinates of its scan."""
        return level["points"] + level["origin"] if level["origin"].any() else level["points"]

    def test_npz_by_numpy_alone(self):
        for name in ("near", "far", "open"):
            path, level = self.export(name, suffix="npz"), self.level(name)
            with np.load(path, allow_pickle=False) as file:
                for key in ("points", "normals", "triangles", "gaussian_curvature", "mean_curvature",
                            "patch_completeness", "part", "source_vertex", "principal_curvature_1",
                            "principal_curvature_2", "principal_direction_1", "principal_direction_2", "origin"):
                    self.same(file[key], level[key])
                for key in ("kind", "vertex", "value", "prominence", "position", "normal"):
                    self.same(file[f"feature_{key}"], level["features"][key])
                self.assertEqual((str(file["length_unit"]), float(file["level"])), ("mm", 1))
                self.assertGreater(float(file["scale"]), 0)
            first = path.read_bytes()
            self.assertEqual(self.export(name, suffix="npz").read_bytes(), first)

    def check_ply(self, found, level, prefix="", scalars=True):
        self.same(np.stack([found[axis] for axis in "xyz"], 1), self.placed(level))
        self.same(np.stack([found["n" + axis] for axis in "xyz"], 1), level["normals"])
        self.same(found["triangles"], level["triangles"])
        for key in ("gaussian_curvature", "mean_curvature", "patch_completeness", "principal_curvature_1",
                    "principal_curvature_2", "part", "source_vertex"):
            self.same(found[prefix + key], level[key])

    def test_ply_of_every_dialect(self):
        for name in ("near", "far"):
            level = self.level(name)
            meshlab = strict.read_ply(self.export(name, "--for", "meshlab"))
            self.check_ply(meshlab, level)
            self.same(meshlab["quality"], level["mean_curvature"])
            self.check_ply(strict.read_ply(self.export(name, "--for", "cloudcompare")), level, "scalar_")
            blender = strict.read_ply(self.export(name, "--for", "blender"))
            self.check_ply(blender, {**level, "origin": np.zeros(3)})
            self.assertEqual(blender["x"].dtype, np.float32)
            convex = (level["mean_curvature"] < 0) & (level["patch_completeness"] > 0)
            self.assertTrue((blender["blue"][convex] >= blender["red"][convex]).all())
            self.same(meshlab["red"], blender["red"])

    def test_obj(self):
        for name in ("near", "far"):
            found, level = strict.read_obj(self.export(name, suffix="obj")), self.level(name)
            points = found["points"] if level["origin"].any() else np.float32(found["points"])
            self.same(points, self.placed(level))
            self.same(np.float32(found["normals"]), level["normals"])
            self.same(found["triangles"], level["triangles"])
            self.assertTrue(((found["colours"] >= 0) & (found["colours"] <= 1)).all())

    def test_stl(self):
        found, level = strict.read_stl(self.export("far", suffix="stl")), self.level("far")
        corners = level["points"][level["triangles"]]
        self.same(found["corners"], corners)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        np.testing.assert_allclose(found["normals"], normals / np.linalg.norm(normals, axis=1)[:, None], atol=1e-4)

    def test_glb(self):
        for name in ("near", "far", "open"):
            path, level = self.export(name, suffix="glb"), self.level(name)
            found = strict.read_glb(path)
            self.same(found["POSITION"], level["points"])
            self.same(found["NORMAL"], level["normals"])
            for key in ("gaussian_curvature", "mean_curvature", "patch_completeness"):
                self.same(found["_" + key.upper()], level[key])
            self.same(found["triangles"], level["triangles"])
            self.assertEqual(found["COLOR_0"].shape, (len(level["points"]), 4))
            self.assertEqual(found["node"]["scale"], [0.001] * 3)
            np.testing.assert_allclose(found["node"].get("translation", [0, 0, 0]), level["origin"] / 1000)

    def test_vtp(self):
        for name in ("near", "far"):
            path, level = self.export(name, suffix="vtp"), self.level(name)
            found = strict.read_vtp(path)
            self.same(found["Points"], self.placed(level))
            for key, values in found.items():
                if key not in ("Points", "Normals"):
                    self.same(values, level[key])
            self.same(found["Normals"], level["normals"])

    def test_vtp_by_vtk(self):
        path, level = self.export("far", suffix="vtp"), self.level("far")
        code = ("import vtk, sys; from vtk.util.numpy_support import vtk_to_numpy as n; "
                "r = vtk.vtkXMLPolyDataReader(); r.SetFileName(sys.argv[1]); r.Update(); o = r.GetOutput(); "
                "print(o.GetNumberOfPoints(), o.GetNumberOfPolys(), "
                "float(n(o.GetPointData().GetArray('mean_curvature')).sum(dtype='f8')))")
        process = subprocess.run(["/usr/bin/python3", "-c", code, path], capture_output=True, text=True)
        if "ModuleNotFoundError" in process.stderr:
            self.skipTest("python3-vtk9 is not installed")
        points, polygons, total = process.stdout.split()
        self.assertEqual((int(points), int(polygons)), (len(level["points"]), len(level["triangles"])))
        self.assertAlmostEqual(float(total), level["mean_curvature"].sum(dtype="f8"), places=6)

    def run_node(self, script, *arguments):
        if not (PACKAGES / "node_modules").is_dir():
            self.skipTest("the npm packages of tests/e2e/readers are not installed")
        process = subprocess.run([NODE, PACKAGES / script, *arguments], capture_output=True, text=True, timeout=TIMEOUT)
        self.assertEqual(process.returncode, 0, process.stderr)
        return json.loads(process.stdout)

    def test_glb_by_the_validator_of_khronos(self):
        for name in ("near", "far", "open"):
            report = self.run_node("validate_glb.mjs", self.export(name, suffix="glb"))
            issues = report["issues"]
            self.assertEqual((issues["numErrors"], issues["numWarnings"]), (0, 0), issues["messages"][:5])
            self.assertEqual(report["info"]["totalTriangleCount"], len(self.level(name)["triangles"]))

    def test_datasets_by_h5wasm(self):
        for name in ("near", "far"):
            found = self.run_node("read_dataset.mjs", self.dataset(f"{name}.ply"))
            self.assertEqual(found["root"]["format"], "semigeo-dataset")
            self.assertEqual(sorted(found["levels"]), ["000", "001", "002"])
            with h5py.File(self.dataset(f"{name}.ply"), "r") as file:
                for number, read in found["levels"].items():
                    level = file["levels"][number]
                    self.assertEqual(read["attributes"]["scale"], level.attrs["scale"])
                    self.assertEqual(sorted(read["arrays"]), sorted(level))
                    for key, array in read["arrays"].items():
                        self.assertEqual(array["shape"], list(level[key].shape))
                        if "sum" in array:
                            np.testing.assert_allclose(array["sum"], level[key][...].sum(dtype="f8"), rtol=1e-9,
                                                       atol=1e-9)
                vtk, read = file["VTKHDF"], found["vtkhdf"]
                for key, path in (("points", "Points"), ("mean", "PointData/mean_curvature"),
                                  ("connectivity", "Polygons/Connectivity")):
                    self.assertEqual(read[key]["shape"], list(vtk[path].shape))
                    np.testing.assert_allclose(read[key]["sum"], vtk[path][...].sum(dtype="f8"), rtol=1e-9, atol=1e-9)
                self.same(read["values"], vtk["Steps/Values"])
                self.same(read["point_offsets"], vtk["Steps/PointOffsets"])


class ArchiveTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        for name in "abc":
            write_ply(self.scans / f"{name}.ply", icosphere(2))
        self.run_scans("--levels", "2")
        self.output = self.folder / "files"

    def names(self):
        return sorted(path.name for path in self.output.iterdir())

    def test_every_level_of_every_dataset(self):
        printed = self.semigeo("export", self.archive, "--levels", "0,2", "--output", self.output).stdout
        self.assertEqual(self.names(), [f"{n}.ply.{k}.ply" for n in "abc" for k in ("000", "002")])
        self.assertIn("3 datasets exported, 0 failed", printed)
        self.semigeo("export", self.archive, "--levels", "all", "--format", "npz", "--output", self.output)
        self.assertEqual(len(list(self.output.glob("*.npz"))), 9)
        self.semigeo("export", self.archive, "--for", "paraview", "--output", self.output)
        self.assertEqual(len(list(self.output.glob("*.000.vtp"))), 3)
        self.semigeo("export", self.archive, "--features", "all", "--output", self.output)
        self.semigeo("export", self.archive, "--contours", "mean", "--level", "1", "--output", self.output)
        self.assertTrue((self.output / "a.ply.000.features.csv").is_file())
        self.assertTrue((self.output / "b.ply.001.contours.csv").is_file())

    def test_one_failure_stops_no_other(self):
        broken = self.dataset("b.ply")
        broken.write_bytes(broken.read_bytes()[:4000])
        process = self.semigeo("export", self.archive, "--level", "1", "--output", self.output, code=1)
        self.assertEqual(self.names(), ["a.ply.001.ply", "c.ply.001.ply"])
        self.assertIn("2 datasets exported, 1 failed", process.stdout)
        self.assertIn("b.ply.vtkhdf", process.stderr)

    def test_a_level_that_a_dataset_lacks_is_said(self):
        process = self.semigeo("export", self.archive, "--levels", "0,5", "--output", self.output, code=1)
        self.assertIn("level 5: does not exist", process.stderr)
        self.assertEqual(self.names(), [])

    def test_misuse_is_refused(self):
        for arguments, word in ((("--levels", "0,x"), "commas"), (("--levels", ""), "levels"),
                                (("--levels", "1,"), "levels"), (("--levels", "1", "--level", "2"), "--level"),
                                (("--format", "csv"), ".ply"), (("--format", "vrml"), "vrml"),
                                (("--features", "all", "--format", "glb"), ".csv")):
            with self.subTest(arguments=arguments):
                process = self.semigeo("export", self.archive, *arguments, "--output", self.output, code=2)
                self.assertIn(word, process.stderr)
        self.assertFalse(self.output.exists())


if __name__ == "__main__":
    unittest.main()
