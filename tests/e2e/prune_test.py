"""What an archive has of scans that are gone, and how it is removed."""

import json
import shutil
import subprocess
import unittest
from pathlib import Path

from support import PROGRAM, SemigeoTest, boulder, contents, icosphere, write_ply

LEVELS = ("--levels", 1)


class PruneTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        for seed, name in enumerate(("a.ply", "b.ply", "day 1/c.ply")):
            write_ply(self.scans / name, boulder(3, seed))
        self.other = self.folder / "other"
        write_ply(self.other / "d.ply", boulder(3, 7))
        self.semigeo("run", self.scans, self.other, "-o", self.archive, "--library", *LEVELS)
        self.semigeo("recognise", self.scans / "b.ply", "--library", self.archive, "-o", self.archive)

    def prune(self, *arguments, code=0):
        process = self.semigeo("prune", self.archive, *arguments, "--json", code=code)
        document = json.loads(process.stdout)
        return [(entry["kind"], entry["name"]) for entry in next(iter(document.values()))]

    def models(self):
        document = json.loads(self.semigeo("library", "list", self.archive, "--json").stdout)
        return [model["name"] for model in document["models"]]

    def test_what_is_of_a_gone_scan_is_removed_and_nothing_else(self):
        self.assertEqual(self.prune(), [])
        before = contents(self.archive)
        (self.scans / "b.ply").unlink()
        wanted = [("dataset", "b.ply"), ("recognised", "b.ply")]
        self.assertEqual(self.prune("--dry-run"), wanted)
        self.assertEqual(contents(self.archive), before)
        self.assertEqual(self.prune(), wanted)
        after = contents(self.archive)
        self.assertEqual(set(before) - set(after),
                         {"scans/b.ply.vtkhdf", "scans/b.ply.xdmf", "library/triplets/b.ply.run",
                          "recognised/b.ply.json"})
        for path in after:
            if not path.endswith("sources.json"):
                self.assertEqual(after[path], before[path], path)
        self.assertNotIn("b.ply", json.loads((self.archive / "sources.json").read_text()))
        self.assertEqual(self.prune(), [])

    def test_the_next_run_makes_the_library_without_it(self):
        (self.scans / "b.ply").unlink()
        said = self.semigeo("prune", self.archive).stdout
        self.assertIn("removed: 1 dataset and 1 recognised file of scans that are gone", said)
        self.assertIn("semigeo library build", said)
        self.assertIn("b.ply", self.models())
        document = self.run_scans(self.other, "--library", *LEVELS)
        self.assertEqual(document["library"]["models"], 3)
        self.assertNotIn("b.ply", self.models())
        self.semigeo("library", "check", self.archive)
        # The same bytes as those of an archive that never had it.
        fresh = self.folder / "fresh"
        self.semigeo("run", self.scans, self.other, "-o", fresh, "--library", *LEVELS)
        self.assertEqual((fresh / "library.h5").read_bytes(), (self.archive / "library.h5").read_bytes())
        self.assertEqual(self.run_scans(self.other, "--library", *LEVELS)["done"], 0)

    def test_a_run_says_what_is_left_over_and_how_to_remove_it(self):
        (self.scans / "b.ply").unlink()
        shutil.rmtree(self.scans / "day 1")
        (self.other / "d.ply").unlink()  # not in a folder of this run
        document = self.run_scans(*LEVELS)
        self.assertEqual([entry["name"] for entry in document["leftovers"]],
                         ["b.ply", "day_1__c.ply-" + document["leftovers"][1]["name"][-8:], "b.ply"])
        said = self.semigeo("run", self.scans, "-o", self.archive, *LEVELS).stdout
        line = next(line for line in said.splitlines() if line.startswith("leftovers: "))
        self.assertIn("2 datasets and 1 recognised file", line)
        command = line.split("to remove them: ")[1]
        self.assertEqual(command, f"semigeo prune {self.archive} {self.scans}")
        self.assertIn("leftovers", json.loads(self.semigeo(
            "run", self.scans, "-o", self.archive, *LEVELS, "--dry-run", "--json").stdout))
        subprocess.run(command.replace("semigeo", str(PROGRAM), 1), shell=True, check=True,
                       stdout=subprocess.DEVNULL)
        said = self.semigeo("run", self.scans, "-o", self.archive, *LEVELS).stdout
        self.assertNotIn("leftovers", said)
        self.assertTrue(self.dataset("d.ply").exists())

    def test_run_with_prune_removes_them_and_their_models(self):
        (self.scans / "b.ply").unlink()
        arguments = ("--prune", "--library", *LEVELS)
        self.assertIn("leftovers", self.run_scans(*arguments, "--dry-run"))
        self.assertTrue(self.dataset("b.ply").exists())
        document = self.run_scans(*arguments)
        self.assertEqual([entry["name"] for entry in document["pruned"]], ["b.ply", "b.ply"])
        self.assertFalse(self.dataset("b.ply").exists())
        self.assertNotIn("b.ply", self.models())
        self.assertIn("d.ply", self.models())  # of a folder that was not named
        self.assertNotIn("pruned", self.run_scans(*arguments))

    def test_a_scan_that_moved_keeps_its_dataset(self):
        moved = self.folder / "moved"
        self.scans.rename(moved)
        said = self.semigeo("run", moved, "-o", self.archive, "--prune", *LEVELS).stdout
        self.assertIn("0 done, 3 up to date", said)
        self.assertNotIn("pruned", said)

    def test_a_folder_that_is_missing_is_refused(self):
        before = contents(self.archive)
        shutil.rmtree(self.scans)
        for folders in ((), (self.scans,), (self.other, self.scans)):
            process = self.semigeo("prune", self.archive, *folders, code=2)
            self.assertIn(f"{self.scans}: there is no such folder", process.stderr)
        self.assertEqual(contents(self.archive), before)

    def test_a_folder_that_is_empty_by_accident_is_refused_without_force(self):
        before = contents(self.archive)
        shutil.rmtree(self.scans)
        self.scans.mkdir()
        for folders in ((), (self.scans,), (self.folder,)):
            process = self.semigeo("prune", self.archive, *folders, code=2)
            self.assertIn(f"{self.scans}: all scans that were recorded there are gone", process.stderr)
            self.assertIn("--force", process.stderr)
        self.assertEqual(contents(self.archive), before)
        # One of the folders of a run: nothing is removed, and the run goes on.
        process = self.semigeo("run", self.scans, self.other, "-o", self.archive, "--prune", *LEVELS)
        self.assertIn("nothing is removed", process.stderr)
        self.assertIn("1 up to date", process.stdout)
        self.assertEqual(contents(self.archive), before)
        self.assertEqual(len(self.prune(self.scans, "--force")), 4)
        self.assertEqual([path.name for path in (self.archive / "scans").iterdir()
                          if path.suffix == ".vtkhdf"], ["d.ply.vtkhdf"])

    def test_a_locked_archive_is_left_alone(self):
        (self.scans / "b.ply").unlink()
        lock = json.dumps({"host": "another.host", "pid": 1, "boot_id": "x", "process_started": 1,
                           "since": "2026-01-01T00:00:00Z"})
        (self.archive / "lock").write_text(lock)
        self.semigeo("prune", self.archive, code=73)
        self.assertTrue(self.dataset("b.ply").exists())
        self.semigeo("prune", self.archive, "--dry-run")

    def test_what_is_no_archive_is_refused(self):
        for target in (self.folder / "none", self.scans, self.scans / "a.ply"):
            self.assertIn(str(target), self.semigeo("prune", target, code=2).stderr)
        self.assertEqual(sorted(path.name for path in self.scans.iterdir()),
                         ["a.ply", "b.ply", "day 1"])


if __name__ == "__main__":
    unittest.main()
