"""What planning remembers of scans and datasets never hides a change."""

import os
import time
import unittest

from support import SemigeoTest, icosphere, write_ply


class CacheTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        for i, name in enumerate(("a", "b")):
            write_ply(self.scans / f"{name}.ply", icosphere(1, 1 + i))
        self.run_scans("--levels", 0)
        # What was changed a moment ago is not remembered: wait until it is no more.
        newest = max(path.stat().st_ctime for folder in (self.scans, self.archive / "scans")
                     for path in folder.iterdir())
        while time.time() < newest + 2.1:
            time.sleep(0.05)
        self.assertEqual(self.run_scans("--levels", 0)["up_to_date"], 2)
        self.cache = self.archive / "digests.txt"
        self.assertEqual(len(self.cache.read_text().splitlines()), 1 + 2 + 2)

    def states_now(self, levels=0):
        states = self.states(self.run_scans("--levels", levels, "--dry-run"))
        return states["a.ply"], states["b.ply"]

    def test_it_makes_no_difference(self):
        remembered = self.cache.read_bytes()
        for text in (remembered, b"", b"nonsense\n", remembered[:-1], remembered[:100], None):
            self.cache.unlink()
            if text is not None:
                self.cache.write_bytes(text)
            self.assertEqual(self.states_now(), ("up to date", "up to date"))
            self.assertEqual(self.states_now(levels=1), ("would run", "would run"))
            # A dry run writes nothing.
            self.assertEqual(self.cache.read_bytes() if self.cache.exists() else None, text)
            self.run_scans("--levels", 0)
            self.assertEqual(self.cache.read_bytes(), remembered)

    def test_other_bytes_of_the_same_size_and_time_are_noticed(self):
        scan = self.scans / "b.ply"
        before = scan.stat()
        changed = scan.read_bytes()[::-1]
        with open(scan, "r+b") as file:  # in place: the inode stays
            file.write(changed)
        os.utime(scan, ns=(before.st_atime_ns, before.st_mtime_ns))
        after = scan.stat()
        self.assertEqual((before.st_size, before.st_mtime_ns, before.st_ino),
                         (after.st_size, after.st_mtime_ns, after.st_ino))
        self.assertEqual(self.states_now(), ("up to date", "would run"))

    def test_a_damaged_header_of_a_dataset_is_noticed(self):
        dataset = self.dataset("b.ply")
        before = dataset.stat()
        with open(dataset, "r+b") as file:
            file.write(b"no HDF5!")
        os.utime(dataset, ns=(before.st_atime_ns, before.st_mtime_ns))
        self.assertEqual(self.states_now(), ("up to date", "would run"))
        dataset.unlink()
        self.assertEqual(self.states_now(), ("up to date", "would run"))


if __name__ == "__main__":
    unittest.main()
