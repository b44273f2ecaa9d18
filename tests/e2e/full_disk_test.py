"""An archive on a small disk of its own: what a run does when it is full, and how the next one goes on. Needs the right
to mount."""

import json
import os
import subprocess
import unittest

from support import PROGRAM, TIMEOUT, SemigeoTest, boulder, partials, write_ply

LEVELS = ("--levels", 2)
SCANS = 12


class FullDiskTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        self.disk = self.folder / "disk"
        self.disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "none", self.disk],
                                 capture_output=True)
        if mounted.returncode != 0:
            self.skipTest("mounting a disk is not permitted here")
        self.addCleanup(subprocess.run, ["umount", "-l", self.disk], check=True)
        self.archive = self.disk / "archive"
        for seed in range(SCANS):
            write_ply(self.scans / f"{seed}.ply", boulder(4, seed))
        self.arguments = ("run", self.scans, "-o", self.archive, *LEVELS)

    def remount(self, options):
        subprocess.run(["mount", "-o", f"remount,{options}", self.disk], check=True)

    def test_a_full_disk_stops_the_run_once_and_the_next_one_goes_on(self):
        process = self.semigeo(*self.arguments, "--json", "--threads", 2, code=75)
        document = json.loads(process.stdout)
        self.assertGreater(document["done"], 0)
        self.assertEqual(document["failed"], 0)
        self.assertEqual(document["done"] + document["not_run"], SCANS)
        self.assertIn("No space left on device; free some space and run again", document["stopped"])
        self.assertNotIn("failed", process.stderr)
        self.assertEqual(process.stderr.count("No space left"), 1, process.stderr)
        self.assertEqual(partials(self.archive), {})
        self.semigeo("check", self.archive)
        self.remount("size=100m")
        document = self.run_scans(*LEVELS)
        self.assertEqual((document["failed"], document["not_run"]), (0, 0))
        self.assertEqual(document["done"] + document["up_to_date"], SCANS)
        self.semigeo("check", self.archive)

    def test_one_sentence_in_one_place(self):
        process = subprocess.run([PROGRAM, *map(str, self.arguments)], stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT, text=True, timeout=TIMEOUT)
        self.assertEqual(process.returncode, 75, process.stdout)
        self.assertEqual(process.stdout.count("No space left"), 1, process.stdout)
        process = self.semigeo(*self.arguments, "--quiet", code=75)
        self.assertEqual(process.stderr, "")
        self.assertEqual(process.stdout.count("stopped: "), 1)

    def test_a_disk_without_any_room_stops_the_run_before_it_begins(self):
        self.remount("size=100m")
        self.semigeo("run", self.scans / "0.ply", "-o", self.archive, *LEVELS)
        room = os.statvfs(self.disk)
        with open(self.disk / "filler", "wb") as filler:
            try:
                filler.write(b"x" * (room.f_bavail * room.f_frsize))
            except OSError:
                pass
        code = subprocess.run([PROGRAM, *map(str, self.arguments)], capture_output=True,
                              timeout=TIMEOUT).returncode
        self.assertIn(code, (1, 75))  # the lock itself may not fit
        self.assertTrue(self.dataset("0.ply").exists())
        (self.disk / "filler").unlink()
        self.semigeo(*self.arguments)


if __name__ == "__main__":
    unittest.main()
