"""Scans, datasets and folders as the night brings them: each failure is named, with its reason, and
harms nothing else."""

import gzip
import json
import os
import shutil
import struct
import subprocess
import unittest

import h5py
import numpy as np

from support import (PROGRAM, TIMEOUT, SemigeoTest, contents, icosphere, obj_text, partials, ply_bytes,
                     ply_header, write_ply)


def bad_scans():
    """File name, bytes, and a word that the reason must hold."""
    sphere = icosphere(2)
    whole = ply_bytes(sphere)
    nan = (sphere[0].copy(), sphere[1])
    nan[0][:, 1] = np.nan
    wrong_index = (sphere[0], sphere[1].copy())
    wrong_index[1][5, 2] = 162
    return [
        ("empty.ply", b"", "empty"),
        ("pointer.ply", b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n", "git lfs pull"),
        ("page.obj", b"<!DOCTYPE html><html><body>Not found</body></html>", "web page"),
        ("photo.stl", b"\xff\xd8\xff\xe0" + bytes(range(256)) * 20, "JPEG"),
        ("notepad.obj", obj_text(sphere).encode("utf-16"), "UTF-16"),
        ("zeros.stl", bytes(84 + 50 * 20), "zeros"),
        ("empty.stl", b"", "empty"),
        ("text.ply", b"Dear colleague,\nplease find the scan attached.\n", "PLY"),
        ("truncated.ply", whole[:len(whole) // 2], "end"),
        ("truncated.ply.gz", gzip.compress(whole, mtime=0)[:-100], "gzip"),
        ("nan.ply", ply_bytes(nan), "finite"),
        ("index.ply", ply_bytes(wrong_index), "162"),
        ("cloud.ply", ply_header(2, 0) + bytes(48), "face"),
        ("huge.ply", ply_header(10 ** 12, 10 ** 12) + bytes(100), "vert"),
        ("large.ply", ply_header(150_000_000, 300_000_000) + bytes(1000), "vert"),
        ("huge.stl", bytes(80) + struct.pack("<I", 2 ** 32 - 1) + bytes(50), "triangle"),
        ("degenerate.obj", b"v 0 0 0\nv 1 0 0\nv 1 0 0\nf 1 2 3\nf 1 1 2\n", "triangle"),
        ("letters.obj", b"v 0 0 zero\n", "line 1"),
        ("binary.off", bytes(range(256)) * 10, "OFF"),
    ]


class BadScansTest(SemigeoTest):
    def test_each_is_named_with_its_reason_and_the_others_are_done(self):
        write_ply(self.scans / "a_first.ply", icosphere(2))
        write_ply(self.scans / "m_middle.ply", icosphere(1))
        write_ply(self.scans / "z_last.ply", icosphere(2))
        for name, data, _ in bad_scans():
            (self.scans / name).write_bytes(data)
        os.symlink("circle.ply", self.scans / "circle.ply")
        os.symlink("nowhere", self.scans / "dangling.ply")
        os.mkfifo(self.scans / "pipe.ply")
        os.symlink(".", self.scans / "loop")
        for name in ("a.jpg", "b.jpg", "a.mtl"):
            (self.scans / name).touch()
        cases = bad_scans() + [("circle.ply", b"", "symbolic"), ("dangling.ply", b"", "no such"),
                               ("pipe.ply", b"", "regular")]

        document = self.run_scans("--levels", 2, code=1)
        self.assertEqual((document["done"], document["failed"]), (3, len(cases)))
        self.assertEqual(document["passed_over"], {".jpg": 2, ".mtl": 1})
        by_name = {scan["input"]: scan for scan in document["scans"]}
        for name, _, word in cases:
            with self.subTest(scan=name):
                scan = by_name[str(self.scans / name)]
                self.assertEqual(scan["state"], "failed")
                self.assertTrue(scan["error"].startswith(f"{self.scans / name}: "), scan["error"])
                reason = scan["error"][len(str(self.scans / name)):]
                self.assertIn(word.lower(), reason.lower())
                self.assertNotIn("\n", reason)
                self.assertFalse(self.dataset(name).exists())
        self.assertLess(document["peak_memory_bytes"], 300e6)
        self.assertEqual(partials(self.archive), {})
        self.semigeo("check", self.archive)

        # As text: counted by reason on stdout, one line each on stderr, and the totals last.
        process = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 2, code=1)
        lines = process.stdout.splitlines()
        self.assertIn("failed, ", process.stdout)
        self.assertEqual(sum(line.startswith("failed: ") for line in process.stderr.splitlines()), len(cases))
        self.assertEqual(lines[-3], "passed over: 2 .jpg, 1 .mtl")
        self.assertIn(f"0 done, 3 up to date, {len(cases)} failed", lines[-1])

    def test_names_that_are_no_utf8(self):
        name = os.fsencode(self.scans) + "/Krug Nº bad".encode() + b"\xffname.obj"
        with open(name, "w") as file:
            file.write(obj_text(icosphere(1)))
        with open(os.fsencode(self.scans) + b"/\xfe.ply", "w") as file:
            file.write("no ply")
        self.run_scans("--levels", 1, "--dry-run")
        document = self.run_scans("--levels", 1, code=1)
        self.assertEqual((document["done"], document["failed"]), (1, 1))
        self.semigeo("check", self.archive)
        self.semigeo("info", self.archive)
        made = json.loads(self.semigeo("info", self.archive, "--json").stdout)["datasets"]
        self.assertEqual([d["input_name"] for d in made], ["Krug Nº bad\ufffdname.obj"])
        again = self.run_scans("--levels", 1, code=1)
        self.assertEqual((again["up_to_date"], again["failed"]), (1, 1))


class DamagedDatasetTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        for name in ("a", "b", "c"):
            write_ply(self.scans / f"{name}.ply", icosphere(3, ord(name)))
        self.run_scans("--levels", 2)
        self.whole = contents(self.archive)

    def damage(self, name, at):
        """Turns one bit over."""
        path = self.dataset(name)
        data = bytearray(path.read_bytes())
        data[at] ^= 0x10
        path.write_bytes(data)
        return path

    def chunks(self, name):
        """Name, place and size of every chunk of every array under /levels; a small array is one."""
        found = []
        data = self.dataset(name).read_bytes()
        with h5py.File(self.dataset(name), "r") as file:
            def add(path, item):
                if not isinstance(item, h5py.Dataset) or item.size == 0:
                    return
                if item.chunks is None:
                    rows = item[...].tobytes()
                    found.append((path, data.index(rows), len(rows)))
                else:
                    for i in range(item.id.get_num_chunks()):
                        chunk = item.id.get_chunk_info(i)
                        found.append((path, chunk.byte_offset, chunk.size))
            file["levels"].visititems(add)
        return found

    def everything(self, name):
        """All that h5py sees of a dataset."""
        seen = {}

        def add(path, item):
            seen[path] = {key: np.asarray(value).tolist() for key, value in item.attrs.items()}
            if isinstance(item, h5py.Dataset):
                seen[path]["="] = (str(item.dtype), item.shape, item[...].tobytes())
            else:
                for key in item:
                    add(f"{path}{key}/", item[key])

        with h5py.File(self.dataset(name), "r") as file:
            add("/", file)
        return seen

    def test_check_passes_what_is_whole(self):
        process = self.semigeo("check", self.archive)
        self.assertEqual(process.stdout, "3 checked, 0 broken\n")
        self.assertEqual(self.semigeo("check", self.dataset("a.ply")).stdout,
                         "1 checked, 0 broken\n")

    def test_check_finds_one_wrong_bit_in_any_chunk_and_names_the_file(self):
        chunks = self.chunks("b.ply")
        self.assertGreaterEqual(len(chunks), 3 * 5 + 3)
        for array, offset, size in chunks:
            path = self.damage("b.ply", offset + size // 2)
            process = self.semigeo("check", self.archive, code=1)
            self.assertIn(f"broken: {path}: ", process.stdout)
            self.assertIn("3 checked, 1 broken", process.stdout)
            path.write_bytes(self.whole["scans/b.ply.vtkhdf"])

    def test_what_check_passes_says_to_others_what_it_said_before(self):
        # Not every byte of an HDF5 file means something; those that do must be found.
        wanted = self.everything("b.ply")
        found = 0
        size = len(self.whole["scans/b.ply.vtkhdf"])
        for at in range(size // 80, size, size // 40):
            path = self.damage("b.ply", at)
            process = subprocess.run([PROGRAM, "check", path], capture_output=True, timeout=TIMEOUT)
            if process.returncode == 0:
                self.assertEqual(self.everything("b.ply"), wanted, f"byte {at}")
            else:
                self.assertEqual(process.returncode, 1)
                found += 1
            path.write_bytes(self.whole["scans/b.ply.vtkhdf"])
        self.assertGreater(found, 3)

    def test_check_finds_what_was_changed_with_all_checksums_right(self):
        def value(file):
            file["levels/001/gaussian_curvature"][3] += 1

        def attribute(file):
            file["levels/001"].attrs.modify("scale", 1.01 * file["levels/001"].attrs["scale"])

        def addition(file):
            file["levels/001"].attrs["remark"] = "mine"

        for change in (value, attribute, addition):
            with self.subTest(change=change.__name__):
                path = self.dataset("b.ply")
                with h5py.File(path, "r+") as file:
                    change(file)
                process = self.semigeo("check", self.archive, code=1)
                self.assertIn(f"broken: {path}: ", process.stdout)
                path.write_bytes(self.whole["scans/b.ply.vtkhdf"])

    def test_check_finds_arrays_stored_otherwise(self):
        path = self.dataset("b.ply")
        with h5py.File(path, "r+") as file:
            normals = file["levels/001/normals"][...]
            del file["levels/001/normals"]
            file["levels/001"].create_dataset("normals", data=normals, compression="gzip")
        process = self.semigeo("check", self.archive, code=1)
        self.assertIn("filters", process.stdout)

    def test_a_cut_or_emptied_dataset_is_found_and_remade(self):
        for size in (0, 100, -1):
            path = self.dataset("b.ply")
            with self.subTest(size=size):
                os.truncate(path, size if size >= 0 else path.stat().st_size - 1)
                process = self.semigeo("check", self.archive, code=1)
                self.assertIn(str(path), process.stdout)
                self.assertEqual(self.states(self.run_scans("--levels", 2)),
                                 {"a.ply": "up to date", "b.ply": "done", "c.ply": "up to date"})
                self.assertEqual(contents(self.archive), self.whole)

    def test_a_damaged_dataset_is_remade_by_a_run_that_verifies(self):
        _, offset, size = self.chunks("b.ply")[0]
        self.damage("b.ply", offset + size // 2)
        self.assertIn("run with --verify", self.semigeo("check", self.archive, code=1).stdout)
        self.assertEqual(self.run_scans("--levels", 2)["up_to_date"], 3)
        process = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 2,
                               "--verify", "--dry-run")
        self.assertIn("b.ply: would run: its arrays are damaged\n", process.stdout)
        self.assertEqual(self.states(self.run_scans("--levels", 2, "--verify")),
                         {"a.ply": "up to date", "b.ply": "done", "c.ply": "up to date"})
        self.assertEqual(contents(self.archive), self.whole)
        self.assertEqual(self.run_scans("--levels", 2, "--verify")["up_to_date"], 3)

    def test_a_damaged_dataset_is_remade_once_it_is_removed(self):
        _, offset, size = self.chunks("b.ply")[0]
        path = self.damage("b.ply", offset + size // 2)
        self.semigeo("check", self.archive, code=1)
        path.unlink()
        self.assertEqual(self.run_scans("--levels", 2)["done"], 1)
        self.assertEqual(contents(self.archive), self.whole)

    def test_info_names_the_broken_one_and_shows_the_others(self):
        self.dataset("b.ply").write_text("not HDF5")
        process = self.semigeo("info", self.archive, code=1)
        self.assertIn("b.ply.vtkhdf", process.stderr)
        self.assertEqual(len(process.stdout.splitlines()), 2)


class UnprivilegedTest(SemigeoTest):
    def unprivileged(self):
        """Arguments that run a process as one who may not write everywhere."""
        if os.geteuid() != 0:
            return {}
        self.folder.chmod(0o755)
        return {"user": 65534, "group": 65534, "extra_groups": []}

    def run_unprivileged(self, archive, *arguments):
        program = self.folder / "semigeo"  # where anybody may read it
        shutil.copy(PROGRAM, program)
        return subprocess.run([program, "run", self.scans, "--output", archive, "--levels", "1",
                               *arguments],
                              capture_output=True, text=True, timeout=TIMEOUT, **self.unprivileged())


class UnreadableScansTest(UnprivilegedTest):
    def setUp(self):
        super().setUp()
        write_ply(self.scans / "a.ply", icosphere(1))
        write_ply(self.scans / "locked/b.ply", icosphere(1))
        write_ply(self.scans / "z/c.ply", icosphere(1))
        self.archive.mkdir()
        self.archive.chmod(0o777)

    def test_a_folder_that_cannot_be_searched_is_a_failure_with_a_sentence(self):
        locked = self.scans / "locked"
        locked.chmod(0)
        self.addCleanup(locked.chmod, 0o755)
        for arguments in (("--dry-run",), ()):
            process = self.run_unprivileged(self.archive, *arguments)
            self.assertEqual(process.returncode, 1)
            self.assertIn(f"{locked}: cannot be searched", process.stdout)
        self.assertIn("2 done, 0 up to date, 1 failed", process.stdout)
        self.assertIn(f"failed: {locked}: cannot be searched", process.stderr)

    def test_a_dry_run_over_an_unreadable_scan_is_a_failure(self):
        (self.scans / "a.ply").unlink()
        os.symlink("nowhere", self.scans / "a.ply")
        process = self.semigeo("run", self.scans, "--output", self.archive, "--dry-run", code=1)
        self.assertIn(f"{self.scans / 'a.ply'}: ", process.stdout)
        self.assertIn("3 scans: 2 would run, 0 up to date, 1 cannot be read\n", process.stdout)


class OutputFolderTest(UnprivilegedTest):
    def setUp(self):
        super().setUp()
        write_ply(self.scans / "a.ply", icosphere(1))

    def test_missing_folders_are_made(self):
        self.run_scans(archive=self.folder / "x/y/z")
        self.assertTrue(self.dataset("a.ply", self.folder / "x/y/z").exists())

    def test_a_file_in_the_way_is_named(self):
        (self.folder / "file").write_text("")
        for archive in ("file", "file/below"):
            process = self.semigeo("run", self.scans, "--output", self.folder / archive, code=1)
            self.assertIn(f"semigeo: {self.folder / archive}", process.stderr)
            self.assertIn("directory", process.stderr)
            self.assertNotIn("filesystem error", process.stderr)

    def test_a_read_only_folder_is_named(self):
        self.archive.mkdir(mode=0o555)
        process = self.run_unprivileged(self.archive)
        self.assertEqual(process.returncode, 1)
        self.assertIn(str(self.archive), process.stderr)
        self.assertIn("ermission", process.stderr)
        self.assertEqual(contents(self.archive), {})

    def test_a_read_only_archive_that_is_up_to_date_is_fine(self):
        self.run_scans("--levels", 1)
        self.archive.chmod(0o555)
        (self.archive / "scans").chmod(0o555)
        process = self.run_unprivileged(self.archive)
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("1 up to date", process.stdout)

    def test_a_read_only_archive_in_which_something_is_to_be_made_is_named(self):
        self.run_scans("--levels", 1)
        (self.archive / "scans/a.ply.vtkhdf").unlink()
        self.archive.chmod(0o555)
        process = self.run_unprivileged(self.archive)
        self.assertEqual(process.returncode, 1)
        self.assertIn(f"semigeo: {self.archive / 'lock'}: cannot be written: ", process.stderr)
        self.assertEqual(process.stdout, "")

    def test_a_read_only_folder_of_datasets_fails_each_scan_by_name(self):
        self.run_scans("--levels", 1)
        (self.archive / "scans/a.ply.vtkhdf").unlink()
        (self.archive / "scans").chmod(0o555)
        self.archive.chmod(0o777)
        process = self.run_unprivileged(self.archive)
        self.assertEqual(process.returncode, 1)
        self.assertIn("failed: ", process.stdout)
        self.assertIn("a.ply.vtkhdf", process.stdout)
        self.assertIn("0 done, 0 up to date, 1 failed", process.stdout)


if __name__ == "__main__":
    unittest.main()
