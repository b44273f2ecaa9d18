"""One run at a time per archive: a second is told who has it, and what a killed one left is taken
over."""

import json
import os
import signal
import subprocess
import time
import unittest

from support import PROGRAM, TIMEOUT, SemigeoTest, icosphere, write_ply


class LockTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        for i in range(3):
            write_ply(self.scans / f"{i}.ply", icosphere(5, 1 + i))
        self.lock = self.archive / "lock"

    def start_and_stop(self):
        """A run that has the archive and stands still."""
        process = subprocess.Popen([PROGRAM, "run", self.scans, "--output", self.archive],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + TIMEOUT
        while not self.lock.exists():
            self.assertLess(time.monotonic(), deadline)
            self.assertIsNone(process.poll())
            time.sleep(0.0005)
        process.send_signal(signal.SIGSTOP)
        os.waitid(os.P_PID, process.pid, os.WSTOPPED)
        return process

    def test_a_second_run_is_told_who_has_the_archive(self):
        first = self.start_and_stop()
        for arguments in ((), ("--json",)):
            process = self.semigeo("run", self.scans, "--output", self.archive, *arguments, code=73)
            self.assertEqual(process.stdout, "")
            self.assertRegex(process.stderr, rf"^semigeo: {self.lock}: process {first.pid} on \S+ "
                                             r"has the archive since \S+Z; wait .*\n$")
        # Looking is allowed.
        process = self.semigeo("run", self.scans, "--output", self.archive, "--dry-run")
        self.assertIn("would run", process.stdout)
        first.send_signal(signal.SIGCONT)
        self.assertEqual(first.wait(TIMEOUT), 0)
        self.assertFalse(self.lock.exists())
        self.assertEqual(self.run_scans()["up_to_date"], 3)

    def test_the_next_run_takes_over_from_a_killed_one(self):
        first = self.start_and_stop()
        first.kill()
        first.wait()
        self.assertTrue(self.lock.exists())
        self.assertEqual(self.run_scans()["failed"], 0)
        self.assertFalse(self.lock.exists())
        self.semigeo("check", self.archive)

    def test_the_lock_of_another_host_stays(self):
        self.archive.mkdir()
        self.lock.write_text(json.dumps({"host": "elsewhere", "pid": 1, "boot_id": "",
                                         "process_started": 0, "since": "2024-05-31T21:00:00Z"}))
        process = self.semigeo("run", self.scans, "--output", self.archive, code=73)
        self.assertIn("process 1 on elsewhere has the archive since 2024-05-31", process.stderr)
        self.lock.unlink()
        self.run_scans("--levels", 0)

    def test_misuse_leaves_no_lock(self):
        self.semigeo("run", self.folder / "none", "--output", self.archive, code=2)
        self.assertFalse(self.archive.exists())


if __name__ == "__main__":
    unittest.main()
