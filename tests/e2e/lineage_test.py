"""What a dataset tells of a surface that falls apart: connectivity, lineage and counts of each level
agree with each other, whatever reads them."""

import json
import unittest
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np

from support import SemigeoTest, icosphere, joined, write_ply

LEVELS = 12
COUNTS = ("flipped", "split", "collapsed", "torn", "inserted", "removed", "dropped_parts")


def dumbbell(around=24, bar=0.25):
    """Two balls of radius 1 on a bar, all one surface of revolution about x."""
    angle = np.linspace(0, np.pi, 13)
    ball = np.stack([-np.cos(angle), np.sin(angle)], axis=1)
    left = (ball - [2, 0])[:-2]
    right = (ball * [1, 1] + [2, 0])[2:]
    middle = np.stack([np.linspace(-1, 1, 9), np.full(9, bar)], axis=1)
    profile = np.concatenate([left[1:], middle, right[:-1]])
    turn = np.arange(around) * 2 * np.pi / around
    rings = [np.stack([np.full(around, x), r * np.cos(turn), r * np.sin(turn)], axis=1)
             for x, r in profile]
    points = np.concatenate([[[-3, 0, 0]], *rings, [[3, 0, 0]]])
    last = len(points) - 1
    at = lambda ring, i: 1 + ring * around + i % around
    triangles = []
    for i in range(around):
        triangles.append((0, at(0, i), at(0, i + 1)))
        triangles.append((last, at(len(rings) - 1, i + 1), at(len(rings) - 1, i)))
        for ring in range(len(rings) - 1):
            triangles.append((at(ring, i), at(ring + 1, i), at(ring, i + 1)))
            triangles.append((at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1)))
    return points, np.array(triangles)


class LineageTest(SemigeoTest):
    def levels_of(self, *options):
        # A chip that is too small for a patch comes along.
        points, triangles = icosphere(1, 0.02)
        write_ply(self.scans / "d.ply", joined(dumbbell(), (points + [0, 3, 0], triangles)))
        self.document = self.run_scans("--levels", LEVELS, *options)
        self.file = h5py.File(self.dataset("d.ply"), "r")
        self.addCleanup(self.file.close)
        return [self.file[f"levels/{k:03d}"] for k in range(LEVELS + 1)]

    def test_levels_tell_what_happened(self):
        levels = self.levels_of()
        first = levels[0]["points"][...]
        changed = 0
        for before, level in zip(levels, levels[1:]):
            counts = {name: level.attrs[name] for name in COUNTS}
            n = len(level["points"])
            self.assertEqual(n, len(before["points"]) - counts["removed"] + counts["inserted"])
            same = not any(counts.values())
            for name in ("triangles", "source_vertex", "part"):
                self.assertEqual(level[name] == before[name], same, name)
            changed += not same

            triangles = level["triangles"][...]
            self.assertEqual(sorted(set(triangles.ravel())), list(range(n)))
            edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]],
                                    triangles[:, [2, 0]]])
            self.assertEqual(len(np.unique(edges, axis=0)), len(edges))  # oriented, closed:
            self.assertEqual(set(map(tuple, edges)), set(map(tuple, edges[:, ::-1])))
            corners = level["points"][...].astype(float)[triangles]
            sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
            areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0],
                                            corners[:, 2] - corners[:, 0]), axis=1)
            shortest = level.attrs["shortest_side"]
            self.assertGreaterEqual(shortest, 0.0999 * level.attrs["mean_edge_length"])
            self.assertGreaterEqual((areas / sides.max(axis=1)).min(), shortest * (1 - 1e-9))

            source = level["source_vertex"][...]
            descended = source[source >= 0]
            self.assertTrue(np.all(np.diff(descended) >= 0))
            self.assertTrue(np.all(source[len(descended):] == -1))
            part = level["part"][...]
            self.assertEqual(level.attrs["parts"], part.max() + 1)
            self.assertTrue(np.all(np.diff(np.unique(part, return_index=True)[1]) > 0))
            self.assertTrue(np.all(part[triangles] == part[triangles[:, :1]]))
        self.assertEqual(levels[1].attrs["dropped_parts"], 1)  # the chip
        self.assertGreater(sum(level.attrs["torn"] for level in levels), 0)
        self.assertGreater(changed, 2)

        # Two ends, and each knows which it is.
        last = levels[-1]
        part, source = last["part"][...], last["source_vertex"][...]
        self.assertEqual(last.attrs["parts"], 2)
        for p in range(2):
            x = first[source[(part == p) & (source >= 0)], 0]
            self.assertTrue(np.all(x > -0.6) or np.all(x < 0.6))
            self.assertGreater(len(x), 100)

        remeshing = self.document["scans"][0]["remeshing"]
        for name in COUNTS:
            self.assertEqual(remeshing[name], sum(level.attrs[name] for level in levels), name)

    def test_viewers_see_every_level_with_its_own_triangles(self):
        levels = self.levels_of()
        vtk = self.file["VTKHDF"]
        self.assertEqual(len(vtk["NumberOfPoints"]), LEVELS + 1)
        for k, level in enumerate(levels):
            begin = vtk["Steps/PointOffsets"][k]
            n = vtk["NumberOfPoints"][k]
            np.testing.assert_array_equal(vtk["Points"][begin:begin + n], level["points"])
        grids = ElementTree.parse(self.dataset("d.ply").with_suffix(".xdmf")).iter("Topology")
        self.assertEqual([int(t.get("NumberOfElements")) for t in grids],
                         [len(level["triangles"]) for level in levels])
        self.semigeo("check", self.archive)
        self.semigeo("export", self.dataset("d.ply"), "--level", LEVELS, "--output",
                     self.folder / "last.ply")
        header = (self.folder / "last.ply").read_bytes()[:400]
        self.assertIn(b"element face %d" % len(levels[-1]["triangles"]), header)
        info = json.loads(self.semigeo("info", self.dataset("d.ply"), "--json").stdout)
        for k, level in enumerate(levels):
            self.assertEqual(info["levels"][k]["remeshing"],
                             {name: level.attrs[name] for name in COUNTS})

    def test_without_remeshing_one_connectivity_for_all(self):
        levels = self.levels_of("--no-remesh")
        for level in levels[1:]:
            self.assertEqual(level["triangles"], levels[0]["triangles"])
            self.assertEqual([level.attrs[name] for name in COUNTS], [0] * len(COUNTS))
            self.assertEqual(level.attrs["shortest_side"], 0)

    def test_a_wire_leaves_a_tetrahedron(self):
        points, triangles = dumbbell(around=3, bar=0.001)
        write_ply(self.scans / "wire.ply", (points * [1, 1e-4, 1e-4], triangles))
        output = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 3).stdout
        self.assertIn("wire.ply: ", output)
        self.assertIn("it has vanished", output)
        with h5py.File(self.dataset("wire.ply"), "r") as file:
            self.assertEqual(len(file["levels"]), 4)
            self.assertEqual(len(file["levels/003/points"]), 4)
            self.assertTrue(np.all(file["levels/003/patch_completeness"][...] == 0))


if __name__ == "__main__":
    unittest.main()
