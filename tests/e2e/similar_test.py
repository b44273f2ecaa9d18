"""Which models of a library resemble a scan, as a whole or in a part, and which are of one object."""

import json
import os
import unittest

import numpy as np

from support import SemigeoTest, boulder, write_ply


def half(mesh):
    """What of a mesh lies above its middle."""
    points, triangles = mesh
    return points, triangles[(points[triangles][:, :, 2] > points[:, 2].mean()).all(axis=1)]


class SimilarTest(SemigeoTest):
    """Two objects; the first also turned, as a half, and again under a name that is no safe one."""

    def setUp(self):
        super().setUp()
        self.models = self.folder / "models"
        points, triangles = boulder(4, 0)
        turn = np.array([[0, -1, 0], [0, 0, -1], [1, 0, 0]], float)
        write_ply(self.models / "a.ply", (points, triangles))
        write_ply(self.models / "<b>turned.ply", (points @ turn.T + 7, triangles))
        write_ply(self.models / "half.ply", half((points, triangles)))
        write_ply(self.models / "other.ply", boulder(4, 1))
        self.semigeo("run", self.models, "--output", self.archive, "--library", "--levels", "1")

    def similar(self, *arguments, **options):
        process = self.semigeo("similar", *arguments, "--library", self.archive, "--json", **options)
        return json.loads(process.stdout)

    def test_the_same_object_comes_first_then_its_part_then_others(self):
        document = self.similar(self.models / "a.ply")
        (scan,) = document["scans"]
        relations = {os.path.basename(s["scan"]): s["relation"] for s in scan["similar"]}
        self.assertEqual(relations["a.ply"], "same")
        self.assertEqual(relations["<b>turned.ply"], "same")
        self.assertEqual(relations["half.ply"], "part of it")
        self.assertNotIn(relations["other.ply"], ("same", "part of it", "contains it", "overlaps"))
        self.assertEqual(os.path.basename(scan["similar"][-1]["scan"]), "other.ply")
        whole = {os.path.basename(s["scan"]): s["whole"] for s in scan["similar"]}
        self.assertGreater(whole["a.ply"], 0.93)
        self.assertGreater(whole["a.ply"], whole["other.ply"])
        self.assertNotIn("is_model", scan)

    def test_a_dataset_is_not_compared_with_itself(self):
        document = self.similar(self.archive / "scans" / "half.ply.vtkhdf")
        (scan,) = document["scans"]
        self.assertEqual(scan["is_model"], "half.ply")
        self.assertNotIn("half.ply", [s["model"] for s in scan["similar"]])
        self.assertEqual(scan["similar"][0]["relation"], "contains it")

    def test_groups_are_of_one_object(self):
        document = self.similar(self.archive, "--groups")
        (group,) = document["groups"]
        self.assertEqual(len(group["members"]), 3)
        self.assertFalse(any("other.ply" in member for member in group["members"]))
        pairs = [frozenset((link["scan"], link["model"])) for link in group["links"]]
        self.assertEqual(len(pairs), len(set(pairs)))
        text = self.semigeo("similar", self.archive, "--library", self.archive, "--groups").stdout
        self.assertIn("group 1: 3 of one object", text)
        self.assertIn("<b>turned.ply", text)

    def test_results_are_kept_and_threads_do_not_matter(self):
        lists = []
        for threads in "1", "2":
            kept = self.folder / f"kept{threads}"
            arguments = (self.models, "--output", kept)
            lists.append([s["similar"] for s in self.similar(*arguments, "--threads", threads)["scans"]])
            again = self.similar(*arguments)
            self.assertEqual({s["state"] for s in again["scans"]}, {"up to date"})
        self.assertEqual(*lists)

    def test_a_damaged_scan_is_said_and_others_are_compared(self):
        bad = self.folder / "bad.ply"
        bad.write_text("ply\nnothing\n")
        document = self.similar(bad, self.models / "a.ply", code=1)
        states = {os.path.basename(s["input"]): s["state"] for s in document["scans"]}
        self.assertEqual(states, {"bad.ply": "failed", "a.ply": "done"})


if __name__ == "__main__":
    unittest.main()
