"""A run that is killed at any moment leaves nothing but whole datasets under final names, and the next
one ends with the bytes of a run that nobody disturbed."""

import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from support import PROGRAM, TIMEOUT, SemigeoTest, contents, icosphere, partials, write_ply

SCANS = 5


class InterruptionTest(SemigeoTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        folder = Path(tempfile.mkdtemp(prefix="semigeo-e2e-"))
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.shared_scans, cls.undisturbed = folder / "scans", folder / "archive"
        for i in range(SCANS):
            write_ply(cls.shared_scans / f"{i}.ply", icosphere(5, 1 + i))
        subprocess.run([PROGRAM, "run", cls.shared_scans, "--output", cls.undisturbed], check=True,
                       stdout=subprocess.DEVNULL, timeout=TIMEOUT)

    def setUp(self):
        super().setUp()
        self.scans = self.shared_scans
        self.size = self.dataset("0.ply", self.undisturbed).stat().st_size

    def start(self):
        process = subprocess.Popen([str(PROGRAM), "run", str(self.scans), "--output",
                                    str(self.archive)], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def kill_at(self, moment):
        """Starts a run and kills it when `moment()` holds; false if that never was seen."""
        process = self.start()
        deadline = time.monotonic() + TIMEOUT
        while not moment():
            if process.poll() is not None:
                return False
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.0005)
        process.kill()
        return process.wait() == -signal.SIGKILL

    def datasets(self):
        folder = self.archive / "scans"
        return sorted(p.name for p in folder.glob("*.vtkhdf")) if folder.exists() else []

    def assert_whole(self):
        """What has a final name is as it will ever be."""
        wanted = contents(self.undisturbed)
        for name in self.datasets():
            self.assertTrue((self.archive / "scans" / name).read_bytes() == wanted[f"scans/{name}"])

    def assert_goes_on(self):
        self.assert_whole()
        kept = len(self.datasets())
        document = self.run_scans()
        self.assertEqual(document["up_to_date"], kept)
        self.assertEqual(document["done"], SCANS - kept)
        self.assert_same_archives(self.archive, self.undisturbed)

    def test_killed_as_soon_as_a_partial_dataset_exists(self):
        # Not one of the configuration's: those are gone in a moment.
        def partial_datasets():
            return [path for path in partials(self.archive) if ".vtkhdf" in str(path)]

        for _ in range(5):  # a moment may pass between a look and the kill
            if self.kill_at(partial_datasets) and partial_datasets() and not self.datasets():
                break
            shutil.rmtree(self.archive)
        else:
            self.fail("the moment never came")
        self.assert_goes_on()

    def test_killed_after_any_number_of_datasets(self):
        # One archive, killed again and again: each run goes on where the last one stopped.
        for count in range(1, SCANS):
            if len(self.datasets()) > count:
                continue  # jobs run side by side: two may end at once
            self.assertTrue(self.kill_at(lambda: len(self.datasets()) >= count))
            self.assertGreaterEqual(len(self.datasets()), count)
            self.assert_whole()
        self.assert_goes_on()

    def test_killed_while_a_dataset_grows(self):
        for share in (0.05, 0.5, 1.0):  # the last: while it is forced to the disk and read back
            with self.subTest(share=share):
                # A moment may pass between two looks; there are SCANS of them in a run.
                for _ in range(5):
                    if self.kill_at(lambda: max(partials(self.archive).values(), default=0) >=
                                    share * self.size):
                        break
                    shutil.rmtree(self.archive)
                else:
                    self.fail("the moment never came")
                self.assert_goes_on()
                shutil.rmtree(self.archive)

    def test_a_leftover_of_the_configuration_is_removed_too(self):
        process = self.start()
        process.wait(TIMEOUT)
        # As a kill between the last dataset and the end leaves it.
        host = os.uname().nodename
        (self.archive / "semigeo.toml").unlink()
        (self.archive / f".semigeo.toml.{host}.{process.pid}.partial").write_text("[ru")
        self.run_scans()
        self.assert_same_archives(self.archive, self.undisturbed)

    def test_two_runs_at_once_do_no_harm(self):
        codes = {process.wait(TIMEOUT) for process in [self.start(), self.start()]}
        self.assertIn(0, codes)  # the other finds the archive locked, or all done
        self.assertLessEqual(codes, {0, 73})
        self.assert_same_archives(self.archive, self.undisturbed)


if __name__ == "__main__":
    unittest.main()
