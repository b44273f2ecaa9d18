"""Objects of a library are recognised in scenes; what cannot be recognised or read is said."""

import json
import os
import re
import unittest

import numpy as np

from support import SemigeoTest, boulder, contents, icosphere, joined, plane, write_ply

MODELS = 5


def rotation(seed):
    """Any."""
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


def pose(seed, scale, translation):
    matrix = np.eye(4)
    matrix[:3, :3] = scale * rotation(seed)
    matrix[:3, 3] = translation
    return matrix


def moved(mesh, matrix):
    points, triangles = mesh
    return points @ matrix[:3, :3].T + matrix[:3, 3], triangles


def model(index):
    """Another tessellation than that of the scenes would have another seed; this is the object."""
    return boulder(4, index)


def seven(found):
    """The matrix that the thesis' parameters stand for."""
    def turn(axis, angle):
        i, j = [(1, 2), (2, 0), (0, 1)][axis]
        matrix = np.eye(3)
        matrix[i, i] = matrix[j, j] = np.cos(angle)
        matrix[i, j], matrix[j, i] = -np.sin(angle), np.sin(angle)
        return matrix

    for name in "gamma", "beta", "alpha":
        assert abs(np.radians(found[f"{name}_degrees"]) - found[f"{name}_radians"]) < 1e-12
    matrix = np.eye(4)
    matrix[:3, :3] = found["scale"] * (turn(2, found["alpha_radians"]) @ turn(1, found["beta_radians"]) @
                                       turn(0, found["gamma_radians"]))
    matrix[:3, 3] = found["d"], found["h"], found["q"]
    return matrix


class RecogniseTest(SemigeoTest):
    """An archive with a library, made once; self.scans is for scenes."""

    def setUp(self):
        super().setUp()
        models = self.folder / "models"
        for i in range(MODELS):
            write_ply(models / f"{i}.ply", model(i))
        self.semigeo("run", models, "--output", self.archive, "--library", "--levels", "1")
        self.library = self.archive / "library.h5"
        self.kept = self.folder / "kept"

    def recognise(self, *arguments, code=0, **options):
        """The JSON of each scene, by its file's name."""
        process = self.semigeo("recognise", *arguments, "--library", self.library, "--json", code=code, **options)
        self.document = json.loads(process.stdout)
        return {os.path.basename(scene["input"]): scene for scene in self.document["scenes"]}

    def objects(self, scene):
        self.assertIn(scene["state"], ("done", "up to date"))
        return scene["recognised"]["objects"]

    def assert_pose(self, found, wanted):
        """Every point of the model within a hundredth of its size of where it must be."""
        matrix = np.array(found["pose"]["matrix"])
        points, _ = icosphere(1)
        scale = np.cbrt(np.linalg.det(wanted[:3, :3]))
        points = np.concatenate([points, np.ones((len(points), 1))], axis=1)
        np.testing.assert_allclose(points @ matrix.T, points @ wanted.T, atol=0.02 * scale)
        np.testing.assert_allclose(seven(found["pose"]), matrix, atol=1e-6 * np.abs(matrix).max())

    def assert_nothing_left(self, folder):
        """No temporary file, no result."""
        self.assertEqual([path for path in folder.rglob("*") if ".partial" in path.name or
                          path.parent.name == "recognised" and path.name != "sources.json"], [])


class FindingTest(RecogniseTest):
    def test_a_copy_that_was_turned_scaled_and_moved(self):
        wanted = pose(7, 2.5, (10, -20, 30))
        write_ply(self.scans / "scene.ply", moved(model(2), wanted))
        found = self.objects(self.recognise(self.scans / "scene.ply")["scene.ply"])
        self.assertEqual([o["model"] for o in found], ["2.ply"])
        self.assert_pose(found[0], wanted)
        self.assertGreater(found[0]["match"], 0.9)
        self.assertLess(found[0]["conflict"], 0.05)

    def test_several_objects_and_copies_of_one(self):
        wanted = {"1.ply": [pose(1, 1, (0, 0, 0)), pose(2, 1.4, (4, 0, 0))], "3.ply": [pose(3, 0.8, (0, 4, 0))]}
        parts = [moved(model(int(name[0])), matrix) for name, poses in wanted.items() for matrix in poses]
        write_ply(self.scans / "scene.ply", joined(*parts))
        found = self.objects(self.recognise(self.scans)["scene.ply"])
        self.assertEqual(sorted(o["model"] for o in found), ["1.ply", "1.ply", "3.ply"])
        for o in found:
            errors = [np.abs(np.array(o["pose"]["matrix"]) - matrix).max() for matrix in wanted[o["model"]]]
            self.assert_pose(o, wanted[o["model"]].pop(int(np.argmin(errors))))

    def test_an_object_that_the_library_lacks(self):
        write_ply(self.scans / "other.ply", boulder(4, 99))
        scene = self.recognise(self.scans)["other.ply"]
        self.assertEqual(self.objects(scene), [])
        said = self.semigeo("recognise", self.scans, "--library", self.library).stdout
        self.assertIn("other.ply: no model of the library is in this scene", said)
        self.assertIn("1 scene, 5 models: 0 with objects, 1 without, 0 failed", said)
        self.assertEqual(len(self.objects(self.recognise(self.scans, "--min-score", 0)["other.ply"])) > 0,
                         len(scene["recognised"]["ranking"]) > 0)

    def test_a_dataset_is_a_scene(self):
        dataset = self.dataset("4.ply")
        found = self.objects(self.recognise(dataset)["4.ply.vtkhdf"])
        self.assertEqual([o["model"] for o in found], ["4.ply"])
        self.assert_pose(found[0], np.eye(4))
        # A folder of them, too, and the archive that is named.
        self.assertEqual(len(self.recognise(self.archive / "scans")), MODELS)
        self.assertEqual(len(self.recognise(self.archive)), MODELS)
        self.assertEqual(len(self.recognise(self.folder)), MODELS)  # the scans; not the archive in it

    def test_the_thesis_method_names_one_model(self):
        wanted = pose(5, 1.5, (1, 2, 3))
        write_ply(self.scans / "scene.ply", moved(model(0), wanted))
        scene = self.recognise(self.scans, "--method", "thesis")["scene.ply"]
        self.assertEqual([o["model"] for o in self.objects(scene)], ["0.ply"])
        self.assert_pose(self.objects(scene)[0], wanted)
        self.assertEqual(scene["recognised"]["search"]["method"], "thesis")
        scene = self.recognise(self.scans, "--method", "thesis", "--min-score", 1e6)["scene.ply"]
        self.assertEqual(self.objects(scene), [])
        self.assertGreater(len(scene["recognised"]["ranking"]), 0)

    def test_a_scene_without_features(self):
        points, triangles = plane(20)
        points[:, 2] = 0
        write_ply(self.scans / "plane.ply", (points, triangles))
        scene = self.recognise(self.scans)["plane.ply"]
        self.assertEqual(scene["recognised"]["scene"]["features"], 0)
        self.assertEqual((self.objects(scene), scene["recognised"]["ranking"]), ([], []))
        self.assertIn("plane.ply: no features: nothing can be recognised\n",
                      self.semigeo("recognise", self.scans, "--library", self.library).stdout)
        self.recognise(self.scans, "--method", "thesis")


class OutputTest(RecogniseTest):
    def setUp(self):
        super().setUp()
        for i in range(3):
            write_ply(self.scans / f"scene{i}.ply", moved(model(i), pose(i, 1 + i, (i, 0, 0))))

    def test_the_same_bytes_for_any_number_of_threads(self):
        other = self.folder / "other"
        self.recognise(self.scans, "--threads", 1, "--output", self.kept)
        self.recognise(self.scans, "--threads", 2, "--output", other)
        self.recognise(self.scans / "scene0.ply", "--threads", 2, "--output", self.folder / "alone")
        self.assertEqual(len(list((self.kept / "recognised").glob("scene*.json"))), 3)
        self.assert_same_archives(other, self.kept)
        self.assertEqual((self.folder / "alone/recognised/scene0.ply.json").read_bytes(),
                         (self.kept / "recognised/scene0.ply.json").read_bytes())

    def test_what_is_up_to_date_is_left_alone(self):
        self.recognise(self.scans, "--output", self.kept)
        states = lambda: sorted(scene["state"] for scene in self.document["scenes"])
        self.assertEqual(states(), ["done"] * 3)
        before = contents(self.kept)
        self.recognise(self.scans, "--output", self.kept)
        self.assertEqual(states(), ["up to date"] * 3)
        # What changes any byte is not.
        self.recognise(self.scans, "--output", self.kept, "--min-score", 0.01)
        self.assertEqual(states(), ["done"] * 3)
        self.recognise(self.scans, "--output", self.kept)
        self.assertEqual(contents(self.kept), before)
        write_ply(self.scans / "scene1.ply", model(4))
        file = self.kept / "recognised/scene2.ply.json"
        file.write_text(file.read_text().replace('"votes": ', '"votes": 1', 1))
        self.recognise(self.scans, "--output", self.kept)
        self.assertEqual(states(), ["done"] * 2 + ["up to date"])
        self.semigeo("library", "remove", self.library, "0.ply")
        scenes = self.recognise(self.scans, "--output", self.kept)
        self.assertEqual(states(), ["done"] * 3)
        self.assertEqual(self.objects(scenes["scene0.ply"]), [])

    def test_scenes_of_one_name_are_kept_apart(self):
        write_ply(self.folder / "more/scene0.ply", model(4))
        self.recognise(self.folder / "more", "--output", self.kept)
        self.recognise(self.scans, "--output", self.kept)
        files = sorted(path.name for path in (self.kept / "recognised").glob("*.ply*.json"))
        self.assertEqual(len(files), 4)
        self.assertRegex(files[0], r"^scene0\.ply--[0-9a-f]{8}\.json$")

    def test_nothing_is_left_without_a_folder(self):
        temporary = self.folder / "tmp"
        temporary.mkdir()
        scenes = self.recognise(self.scans, env=os.environ | {"TMPDIR": str(temporary)})
        self.assertNotIn("output", scenes["scene0.ply"])
        self.assertEqual(list(temporary.iterdir()), [])

    def test_an_archive_keeps_what_was_recognised_in_its_scenes(self):
        process = self.semigeo("recognise", self.scans, "--library", self.archive, "--output", self.archive)
        self.assertIn("3 scenes, 5 models: 3 with objects, 0 without, 0 failed", process.stdout)
        self.assertEqual(len(list((self.archive / "recognised").glob("scene*.json"))), 3)
        self.assertIn("recognise scene0.ply", (self.archive / "journal.jsonl").read_text())
        self.semigeo("check", self.archive)

    def test_what_is_printed(self):
        arguments = (self.scans / "scene1.ply", "--library", self.library)
        said = self.semigeo("recognise", *arguments).stdout
        self.assertIn("scene1.ply: 1 object\n", said)
        self.assertRegex(said, r"(?m)^ +scale 2\.?\d*; d h q .* degrees$")
        ranked = lambda said: re.findall(r"(?m)^ +\d+  \d\.ply ", said[said.index("ranking"):])
        self.assertGreater(len(ranked(said)), 1)
        self.assertEqual(len(ranked(self.semigeo("recognise", *arguments, "--top", 1).stdout)), 1)
        self.assertNotIn("ranking", self.semigeo("recognise", *arguments, "--top", 0).stdout)
        self.assertEqual(len(self.recognise(self.scans / "scene1.ply", "--top", 1)["scene1.ply"]
                             ["recognised"]["ranking"]), 1)
        same = lambda text: text[:text.index("1 scene,")]  # but for times
        self.assertEqual(same(self.semigeo("recognize", *arguments).stdout), same(said))

    def test_what_would_run_is_known_beforehand(self):
        self.recognise(self.scans / "scene0.ply", "--output", self.kept)
        said = self.semigeo("recognise", self.scans, "--library", self.library, "--output", self.kept,
                            "--dry-run").stdout
        self.assertIn("3 scenes: 2 would run, 1 up to date", said)
        graph = json.loads(self.semigeo("recognise", self.scans, "--library", self.library, "--dag", "json").stdout)
        kinds = [node["kind"] for node in graph["nodes"]]
        self.assertEqual({kind: kinds.count(kind) for kind in set(kinds)},
                         {"scene": 3, "hash library": 1, "recognise": 3, "recognition": 3})

    def test_a_job_that_is_killed_leaves_nothing(self):
        # After the crash the other scenes are up to date, so that only the loop can reach the limit.
        for fault, limit in ("crash", ()), ("loop", ("--timeout", 1)):
            scenes = self.recognise(self.scans, "--output", self.kept, *limit, "--retries", 0, code=1,
                                    env=os.environ | {"SEMIGEO_TEST_FAULTS": f"recognise scene1.ply={fault}"})
            self.assertEqual(scenes["scene1.ply"]["state"], "failed")
            self.assertEqual(sorted(path.name for path in (self.kept / "recognised").iterdir()),
                             ["scene0.ply.json", "scene2.ply.json", "sources.json"])
        self.recognise(self.scans, "--output", self.kept)
        fresh = self.folder / "fresh"
        self.recognise(self.scans, "--output", fresh)
        self.assert_same_archives(self.kept, fresh)


class BadInputTest(RecogniseTest):
    def refused(self, *arguments, code=1):
        """The sentence."""
        process = self.semigeo("recognise", *arguments, "--output", self.kept, code=code)
        self.assert_nothing_left(self.kept)
        return process.stdout + process.stderr

    def test_libraries_that_are_none(self):
        scene = write_ply(self.scans / "scene.ply", model(0))
        self.assertIn("no such library", self.refused(scene, "--library", self.folder / "no.h5"))
        self.assertIn("the folder has no hash library; build it: semigeo library build",
                      self.refused(scene, "--library", self.scans))
        self.assertIn("scene.ply", self.refused(scene, "--library", scene))
        self.assertIn("4.ply.vtkhdf", self.refused(scene, "--library", self.dataset("4.ply")))
        self.refused(scene, code=2)

    def test_libraries_of_other_versions_and_parameters(self):
        scene = write_ply(self.scans / "scene.ply", model(0))
        import h5py
        for name, value, sentence in (("format_version", np.int64(2), "version"),
                                      ("parameters", '{"levels":3,"news":1}', "parameters that this version"),
                                      ("parameters", "none", "parameters that this version")):
            other = self.folder / "other.h5"
            other.write_bytes(self.library.read_bytes())
            with h5py.File(other, "r+") as file:
                file.attrs[name] = np.bytes_(value) if isinstance(value, str) else value
            self.assertIn(sentence, self.refused(scene, "--library", other))

    def test_damaged_libraries(self):
        scene = write_ply(self.scans / "scene.ply", model(0))
        data = self.library.read_bytes()
        broken = self.folder / "broken.h5"
        for end in len(data) // 3, len(data) - 1:
            broken.write_bytes(data[:end])
            self.assertIn("broken.h5", self.refused(scene, "--library", broken))
        import h5py
        with h5py.File(self.library) as file:
            chunks = [file[name].id.get_chunk_info(0) for name in ("postings", "models/sample_points")]
        for chunk in chunks:
            damaged = bytearray(data)
            middle = chunk.byte_offset + chunk.size // 2
            for at in range(middle, middle + 8):
                damaged[at] ^= 0x55
            broken.write_bytes(damaged)
            said = self.refused(scene, "--library", broken)
            self.assertRegex(said, r"failed: .*broken\.h5: ")
            self.assertIn("1 failed", said)

    def test_scenes_that_are_none(self):
        write_ply(self.scans / "empty.ply", (np.zeros((3, 3)), np.zeros((0, 3), int)))
        (self.scans / "torn.ply").write_bytes((self.scans / "empty.ply").read_bytes()[:60])
        degenerate = write_ply(self.scans / "degenerate.ply", (np.zeros((3, 3)), np.array([[0, 1, 2]])))
        self.assertIn("degenerate.ply: no usable triangle is left", self.refused(degenerate, "--library", self.library))
        scenes = self.recognise(self.scans, "--output", self.kept, code=1)
        self.assertEqual([scene["state"] for scene in scenes.values()], ["failed"] * 3)
        self.assert_nothing_left(self.kept)
        dataset = self.folder / "torn.vtkhdf"
        dataset.write_bytes(self.dataset("0.ply").read_bytes()[:5000])
        self.assertIn("torn.vtkhdf", self.refused(dataset, "--library", self.library))
        text = self.folder / "scene.txt"
        text.write_text("no scan")
        self.assertIn("is not a scan that semigeo reads", self.refused(text, "--library", self.library, code=2))
        self.assertIn("no such file", self.refused(self.folder / "no.ply", "--library", self.library, code=2))
        (self.folder / "nothing").mkdir()
        self.assertIn("was found", self.refused(self.folder / "nothing", "--library", self.library, code=2))

    def test_one_bad_scene_among_good_ones(self):
        for i in range(2):
            write_ply(self.scans / f"{i}.ply", model(i))
        (self.scans / "bad.obj").write_text("v 0 0 0\nf 1 2 7\n")
        scenes = self.recognise(self.scans, "--output", self.kept, code=1)
        self.assertEqual({name: scene["state"] for name, scene in scenes.items()},
                         {"0.ply": "done", "1.ply": "done", "bad.obj": "failed"})
        self.assertIn("bad.obj", scenes["bad.obj"]["error"])
        self.assertNotIn("recognised", scenes["bad.obj"])
        said = self.semigeo("recognise", self.scans, "--library", self.library, code=1).stdout
        self.assertIn("3 scenes, 5 models: 2 with objects, 0 without, 1 failed", said)
        self.assertRegex(said, r"(?m)^failed: .*bad\.obj")

    def test_options_that_make_no_sense(self):
        scene = write_ply(self.scans / "scene.ply", model(0))
        for wrong in (("--top", 21), ("--top", "-1"), ("--min-score", "nan"), ("--min-score", "-1"),
                      ("--method", "guess"), ("--executor", "slurm")):
            self.semigeo("recognise", scene, "--library", self.library, *wrong, code=2)


if __name__ == "__main__":
    unittest.main()
