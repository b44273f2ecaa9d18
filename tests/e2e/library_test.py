"""Hash libraries: part of a run, or by themselves; the same bytes whatever happens on the way."""

import json
import os
import shutil
import signal
import subprocess
import time
import unittest

import numpy as np

from support import PROGRAM, TIMEOUT, SemigeoTest, boulder, write_ply

LEVELS = ("--levels", "2")


class LibraryTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        for i in range(4):
            write_ply(self.scans / f"{i}.ply", boulder(3, i))
        self.library = self.archive / "library.h5"
        self.parts = self.archive / "library"

    def run_library(self, *arguments, code=0, archive=None):
        return self.run_scans("--library", *LEVELS, *arguments, code=code, archive=archive)

    def make(self, *arguments, code=0):
        """`semigeo library` with these arguments; its JSON."""
        return json.loads(self.semigeo("library", *arguments, "--json", code=code).stdout)

    def names(self, library):
        return [model["name"] for model in self.make("list", library)["models"]]

    def jobs(self, document):
        """States of the jobs that are none of scans, by kind and name."""
        return {(job["kind"], job["name"]): job["state"] for job in document["jobs"]}

    def runs(self, parts):
        """What tells a run that was left alone from one that was made again."""
        return {path.stem: (path.stat().st_ino, path.stat().st_mtime_ns)
                for path in (parts / "triplets").glob("*.run")}


class BuildTest(LibraryTest):
    def test_a_second_run_finds_it_up_to_date(self):
        document = self.run_library()
        self.assertEqual((document["done"], document["library"]["models"]), (10, 4))
        self.assertEqual(set(self.jobs(document)), {("triplets", f"{i}.ply") for i in range(4)} |
                         {("partition", "000.part"), ("library", "library.h5")})
        self.assertEqual(self.names(self.library), [f"{i}.ply" for i in range(4)])
        self.assertEqual(self.make("list", self.archive), self.make("list", self.library))
        self.assertGreater(self.make("list", self.library)["postings"], 100)
        self.assertFalse((self.parts / "partitions").exists())
        before = self.library.stat()
        self.assertEqual(self.run_library()["up_to_date"], 10)
        self.assertEqual(self.make("build", self.archive)["up_to_date"], 6)
        self.assertEqual(self.library.stat().st_ino, before.st_ino)
        self.semigeo("library", "check", self.library)
        said = self.semigeo("run", self.scans, "-o", self.archive, "--library", *LEVELS).stdout
        self.assertIn(f"library: {self.library}: 4 models, up to date\n", said)

    def test_the_same_bytes_on_every_way(self):
        self.run_library("--threads", "1")
        wanted = self.library.read_bytes()
        other = self.folder / "other"
        self.run_library("--threads", "3", "--memory", "200M", archive=other)
        self.assertTrue((other / "library.h5").read_bytes() == wanted)
        datasets = [self.dataset(f"{i}.ply") for i in (2, 0, 3, 1)]
        mine = self.folder / "mine.h5"
        self.make("build", *datasets, "--output", mine)
        self.assertTrue(mine.read_bytes() == wanted)
        # One by one.
        mine.unlink()
        self.make("build", datasets[0], "--output", mine)
        for dataset in datasets[1:]:
            self.make("add", mine, dataset)
        self.assertTrue(mine.read_bytes() == wanted)

    def test_an_archive_s_library_has_all_of_it(self):
        self.run_library()
        wanted = self.library.read_bytes()
        (self.scans / "0.ply").unlink()
        self.assertEqual(self.run_library()["library"], {"output": str(self.library), "state": "up to date",
                                                         "models": 4, "wanted": 4, "missing": []})
        # Without a scan: by datasets alone.
        shutil.rmtree(self.parts)
        self.library.unlink()
        self.assertEqual(self.make("build", self.archive)["done"], 6)
        self.assertTrue(self.library.read_bytes() == wanted)

    def test_a_scan_that_fails_costs_its_model_only(self):
        (self.scans / "bad.obj").write_text("v 0 0 0\nf 1 2 7\n")
        document = self.run_library(code=1)
        self.assertEqual((document["failed"], document["skipped"], document["done"]), (1, 1, 10))
        self.assertEqual(document["library"]["missing"], ["bad.obj"])
        self.assertEqual(self.jobs(document)["triplets", "bad.obj"], "skipped")
        again = self.run_library(code=1)
        self.assertEqual((again["failed"], again["skipped"], again["up_to_date"]), (1, 1, 10))
        said = self.semigeo("run", self.scans, "-o", self.archive, "--library", *LEVELS, code=1).stdout
        self.assertIn("4 of 5 models, up to date; missing: bad.obj\n", said)
        status = json.loads(self.semigeo("status", self.archive, "--json").stdout)
        self.assertEqual((status["state"], status["left"], status["skipped"]), ("ended", 0, 1))

    def test_a_job_that_crashes_costs_its_model_only(self):
        self.run_library()
        # The library must not have the model of the scan that was.
        write_ply(self.scans / "1.ply", boulder(3, 17))
        for faults, code in (("triplets 1.ply=crash", 1), ("", 0)):
            process = self.semigeo("run", self.scans, "-o", self.archive, "--library", *LEVELS, "--json", code=code,
                                   env=os.environ | {"SEMIGEO_TEST_FAULTS": faults})
            document = json.loads(process.stdout)
            self.assertEqual(document["library"]["missing"], ["1.ply"] if faults else [])
            self.assertEqual(self.names(self.library), [f"{i}.ply" for i in range(4) if i != 1 or not faults])
        fresh = self.folder / "fresh"
        self.run_library(archive=fresh)
        self.assertTrue(self.library.read_bytes() == (fresh / "library.h5").read_bytes())

    def test_a_run_that_cannot_be_opened_is_neither_missing_nor_left_out(self):
        self.run_library()
        before = self.library.read_bytes()
        run = self.archive / "library/triplets/1.ply.run"
        data = run.read_bytes()
        run.unlink()
        run.symlink_to(run)  # ELOOP, even for root
        for _ in range(2):
            document = self.run_library(code=1)
            self.assertEqual(document["failed"], 1)
            job = next(job for job in document["jobs"] if job["kind"] == "triplets" and job["name"] == "1.ply")
            self.assertTrue(job["error"].startswith(f"{run}: cannot be opened: "), job["error"])
            self.assertEqual((document["library"]["models"], document["library"]["missing"]), (4, []))
            self.assertTrue(self.library.read_bytes() == before)
        self.library.unlink()  # and none is made without the model
        document = self.run_library(code=1)
        self.assertNotIn(document["library"]["state"], ("done", "up to date"))
        self.assertFalse(self.library.exists())
        run.unlink()
        run.write_bytes(data)
        self.run_library()
        self.assertTrue(self.library.read_bytes() == before)

    def test_a_partition_that_fails_costs_the_library(self):
        process = self.semigeo("run", self.scans, "-o", self.archive, "--library", *LEVELS, code=1,
                               env=os.environ | {"SEMIGEO_TEST_FAULTS": "partition 000.part=crash"})
        self.assertIn("1 failed, 1 skipped", process.stdout)
        self.assertFalse(self.library.exists())
        self.assertEqual(self.run_library()["done"], 2)

    def test_what_would_run_is_known_beforehand(self):
        document = json.loads(self.semigeo("run", self.scans, "-o", self.archive, "--library", "--dry-run",
                                           "--json").stdout)
        self.assertEqual(len(document["scans"]), 4)
        self.assertEqual(set(self.jobs(document).values()), {"would run"})
        graph = json.loads(self.semigeo("run", self.scans, "-o", self.archive, "--library", "--dag", "json").stdout)
        kinds = [node["kind"] for node in graph["nodes"]]
        self.assertEqual({kind: kinds.count(kind) for kind in set(kinds)},
                         {"scan": 4, "surface": 4, "dataset": 4, "triplets": 4, "run": 4, "partition": 1,
                          "postings": 1, "library": 1, "hash library": 1})
        self.assertFalse(self.archive.exists())

    def test_a_locked_archive_is_left_alone(self):
        self.run_library()
        process = subprocess.Popen(
            [str(PROGRAM), "run", str(self.scans), "--output", str(self.archive), "--levels", "3"],
            env=os.environ | {"SEMIGEO_TEST_FAULTS": "0.ply=sleep"}, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + TIMEOUT
        while not (self.archive / "lock").exists():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)
        self.assertIn("lock", self.semigeo("library", "build", self.archive, code=73).stderr)


class ChangeTest(LibraryTest):
    def setUp(self):
        super().setUp()
        self.run_library()
        self.mine = self.folder / "mine.h5"
        self.mine_parts = self.folder / "mine.h5.parts"
        self.make("build", self.dataset("0.ply"), self.dataset("1.ply"), "--output", self.mine)

    def test_other_models_are_left_alone(self):
        before = self.runs(self.mine_parts)
        two = self.mine.read_bytes()
        document = self.make("add", self.mine, self.dataset("2.ply"))
        self.assertEqual(set(self.jobs(document)),
                         {("triplets", "2.ply"), ("partition", "000.part"), ("library", "mine.h5")})
        after = self.runs(self.mine_parts)
        self.assertEqual({name: after[name] for name in before}, before)
        self.assertEqual(self.names(self.mine), ["0.ply", "1.ply", "2.ply"])
        self.make("remove", self.mine, "2.ply")
        self.assertEqual(self.runs(self.mine_parts), before)
        self.assertTrue(self.mine.read_bytes() == two)

    def test_models_need_their_datasets_no_more(self):
        two = self.mine.read_bytes()
        self.dataset("0.ply").unlink()
        self.make("add", self.mine, self.dataset("2.ply"), self.dataset("3.ply"))
        self.make("remove", self.mine, "3.ply", "2.ply")
        self.assertTrue(self.mine.read_bytes() == two)

    def test_adding_what_is_there_changes_nothing(self):
        before = self.mine.stat().st_ino
        self.assertEqual(self.make("add", self.mine, self.dataset("1.ply"))["done"], 0)
        self.assertEqual(self.mine.stat().st_ino, before)

    def test_what_cannot_be_is_refused(self):
        before = self.mine.read_bytes()
        self.assertIn("has no model x", self.semigeo("library", "remove", self.mine, "x", code=1).stderr)
        self.assertIn("no model left",
                      self.semigeo("library", "remove", self.mine, "0.ply", "1.ply", code=1).stderr)
        copy = self.folder / "copy" / "1.ply.vtkhdf"
        copy.parent.mkdir()
        shutil.copy(self.dataset("1.ply"), copy)
        said = self.semigeo("library", "add", self.mine, self.dataset("1.ply"), copy, code=1).stderr
        self.assertIn("has the name of another dataset", said)
        new = self.folder / "new.h5"
        self.semigeo("library", "add", new, self.dataset("1.ply"), code=1)
        self.semigeo("library", "build", self.folder / "none", "--output", new, code=1)
        self.semigeo("library", "build", self.dataset("1.ply"), code=2)  # where to?
        self.assertEqual(sorted(path.name for path in self.folder.glob("new*")), [])
        self.assertTrue(self.mine.read_bytes() == before)

    def test_a_missing_run_is_named(self):
        run = self.mine_parts / "triplets" / "0.ply.run"
        run.unlink()
        said = self.semigeo("library", "add", self.mine, self.dataset("2.ply"), code=1).stderr
        self.assertIn(f"{run}: is missing or damaged", said)
        self.assertEqual(self.make("build", self.dataset("0.ply"), self.dataset("1.ply"), "--output", self.mine)["failed"], 0)
        self.assertTrue(run.exists())

    def test_a_damaged_run_is_found_and_made_again(self):
        run = self.parts / "triplets" / "0.ply.run"
        whole = run.read_bytes()
        wanted = self.library.read_bytes()
        damaged = bytearray(whole)
        damaged[len(whole) // 2] ^= 255
        run.write_bytes(damaged)
        self.assertEqual(self.run_library()["done"], 0)  # headers are what they were
        document = self.run_library("--verify")
        self.assertEqual(self.jobs(document)["triplets", "0.ply"], "done")
        self.assertTrue(run.read_bytes() == whole)
        # Before a library is made of it, all of it is read.
        for broken in (damaged, whole[:-9], b""):
            run.write_bytes(broken)
            self.library.unlink()
            document = self.run_library()
            self.assertEqual(self.jobs(document)["triplets", "0.ply"], "done")
            self.assertTrue(self.library.read_bytes() == wanted)

    def test_a_damaged_library_is_found_and_made_again(self):
        whole = self.library.read_bytes()
        damaged = bytearray(whole)
        damaged[len(whole) // 2] ^= 255
        self.library.write_bytes(damaged)
        self.assertIn("broken: ", self.semigeo("library", "check", self.library, code=1).stdout)
        self.assertEqual(self.run_library("--verify")["done"], 2)
        self.assertTrue(self.library.read_bytes() == whole)

    def test_another_version_is_refused_and_replaced(self):
        import h5py
        whole = self.library.read_bytes()
        with h5py.File(self.library, "r+") as file:
            file.attrs["format_version"] = np.int64(999)
        for command in ("list", "check"):
            process = self.semigeo("library", command, self.library, code=1)
            self.assertIn("999", process.stdout + process.stderr)
        self.assertIn("999", self.semigeo("library", "add", self.library, self.dataset("0.ply"), code=1).stderr)
        self.assertEqual(self.run_library()["done"], 2)
        self.assertTrue(self.library.read_bytes() == whole)


class KillTest(LibraryTest):
    def moments(self):
        """Conditions that a run meets one after the other."""
        runs = lambda: len(list(self.parts.glob("triplets/*.run")))
        return [lambda: self.dataset("0.ply").exists(), lambda: runs() >= 1, lambda: runs() >= 3,
                lambda: (self.parts / "partitions").exists(), lambda: list(self.parts.glob("partitions/*.part")),
                lambda: list(self.archive.glob(".library.h5*")), self.library.exists]

    def test_after_kills_it_goes_on_to_the_same_bytes(self):
        wanted = self.folder / "wanted"
        self.run_library(archive=wanted)
        for moment in self.moments():
            process = subprocess.Popen(
                [str(PROGRAM), "run", str(self.scans), "--output", str(self.archive), "--library", *LEVELS],
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            while not moment() and process.poll() is None:
                time.sleep(0.0005)
            process.kill()
            process.wait()
            if self.library.exists():
                self.assertTrue(self.library.read_bytes() == (wanted / "library.h5").read_bytes())
        document = self.run_library()
        self.assertEqual(document["failed"], 0)
        self.assert_same_archives(self.archive, wanted)

    def test_a_killed_partition_is_tried_again(self):
        process = self.semigeo("run", self.scans, "-o", self.archive, "--library", *LEVELS,
                               env=os.environ | {"SEMIGEO_TEST_FAULTS": "library library.h5=crash-once"})
        self.assertIn(f"again: {self.library}: crashed", process.stderr)


if __name__ == "__main__":
    unittest.main()
