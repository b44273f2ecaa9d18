"""The program that counts how often objects are recognised: its tables and its JSON."""

import json
import unittest

from support import SemigeoTest, boulder, plane, write_ply

SCENES = "A,B,C,F,H".split(",")
ABSENT = "X-A,X-B,X-C,X-D,X-E".split(",")


class RecognitionBenchTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        for seed in range(4):
            write_ply(self.scans / f"boulder{seed}.ply", boulder(4, seed))

    def measure(self, *arguments):
        """The JSON."""
        path = self.folder / "rates.json"
        self.process = self.semigeo("--models", self.scans, "--json", path, *arguments)
        return json.loads(path.read_text())

    def test_objects_are_recognised_and_counted(self):
        write_ply(self.scans / "a_plane.ply", plane(10))  # has a boundary
        document = self.measure("--short", "--verbose")
        self.assertEqual(document["models"], [f"boulder{seed}" for seed in range(4)])
        self.assertIn("a_plane.ply: skipped: it has a boundary", self.process.stderr)
        self.assertEqual(set(document["kinds"]), set(SCENES + ABSENT))
        for kind in SCENES + ABSENT:
            scenes = [s for s in document["scenes"] if s["kind"] == kind]
            rates = document["kinds"][kind]
            self.assertEqual(rates["scenes"], 4)
            self.assertEqual(len(scenes), 4)
            for what in "named", "posed", "reported":
                self.assertEqual(rates[what], sum(s[what] for s in scenes))
            self.assertRegex(self.process.stdout, rf"(?m)^{kind} +4 +{rates['named']} ")
            for scene in scenes:
                self.assertEqual(len(scene["objects"]) > 0, kind in SCENES)
                self.assertGreater(scene["vertices"], 0)
        for kind in "A", "C", "H":
            self.assertEqual(document["kinds"][kind]["posed"], 4, kind)
            self.assertEqual(document["kinds"][kind]["reported"], 4, kind)
        for kind in ABSENT:  # the default threshold lies far above what wrong models reach here
            self.assertEqual(document["kinds"][kind]["false_objects"], 0, kind)
        for scene in document["scenes"]:
            if scene["kind"] == "A":
                self.assertEqual(scene["false_objects"], 0)
                self.assertLess(scene["objects"][0]["pose_error"]["degrees"], 1)
                self.assertLess(scene["objects"][0]["pose_error"]["box"], 0.01)
            if scene["kind"] == "F":
                self.assertEqual(len({o["model"] for o in scene["objects"]}), 3)
            if scene["kind"] == "H":
                self.assertEqual({o["model"] for o in scene["objects"]}, {scene["scene"]})
            if scene["kind"] in ABSENT:
                self.assertNotEqual(scene["first"], scene["scene"])

    def test_nothing_is_reported_below_the_least_score(self):
        document = self.measure("--kinds", "A", "--min-score", 2, "--model-vertices", 1000)
        self.assertEqual(document["kinds"]["A"]["named"], 4)
        self.assertEqual(document["kinds"]["A"]["reported"], 0)
        self.assertEqual(self.process.stdout.count("not reported, first"), 4)

    def test_results_repeat_on_any_number_of_threads_and_follow_the_seed(self):
        found = []
        for more in (("--threads", 1), ("--threads", 2), ("--seed", 2)):
            document = self.measure("--kinds", "D", "--model-vertices", 1000, *more)
            for scene in document["scenes"]:
                del scene["seed"], scene["scale_space_seconds"], scene["search_seconds"]
            found.append(document["scenes"])
        self.assertEqual(found[0], found[1])
        self.assertNotEqual(found[0], found[2])

    def test_the_method_of_the_thesis_names_what_is_whole(self):
        document = self.measure("--kinds", "A", "--method", "thesis", "--model-vertices", 1000,
                                "--strongest", 15)
        self.assertEqual(document["kinds"]["A"]["named"], 4)

    def test_tables_of_the_thesis(self):
        document = self.measure("--thesis-tables", "--model-vertices", 1000, "--strongest", 12)
        for table in range(1, 7):
            self.assertIn(f"\nTable 6.{table}: ", "\n" + self.process.stdout)
        self.assertEqual(len(document["complete"]), 4)
        self.assertEqual(len(document["partial"]), 4)
        self.assertEqual(len(document["composed"]), 3)
        for scene in document["complete"] + document["partial"] + document["composed"]:
            self.assertEqual(len(scene["scores"]), 4)
            for score in scene["scores"]:
                self.assertAlmostEqual(score["total"], sum(score["of_kind"]) / 4, places=6)
                if not score["survives"]:
                    self.assertEqual(score["cluster"], 0)

    def test_misuse_is_exit_code_2_and_no_models_fail(self):
        self.assertEqual(self.semigeo("--help").stdout.strip().splitlines()[0], "Examples:")
        for arguments in (("--kinds", "Z"), ("--seeds", 0), ("--method", "guess")):
            with self.subTest(arguments=arguments):
                self.semigeo(*arguments, code=2)
        empty = self.folder / "empty"
        empty.mkdir()
        self.assertIn("no closed mesh", self.semigeo("--models", empty, code=1).stderr)


if __name__ == "__main__":
    unittest.main()
