"""Scans in containers and compressed files: each is a scan, with the same content as the file that it
would be unpacked to."""

import bz2
import gzip
import io
import json
import lzma
import os
import tarfile
import unittest
import zipfile

import h5py

from support import SemigeoTest, contents, icosphere, obj_text, ply_bytes, write_ply


def write_tar(path, mode, members):
    with tarfile.open(path, mode) as tar:
        for name, data in members:
            info = tarfile.TarInfo(name)
            info.size = len(data)
            tar.addfile(info, io.BytesIO(data))


class ContainersTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        self.sphere = icosphere(2)
        self.ply = ply_bytes(self.sphere)

    def points(self, name):
        with h5py.File(self.dataset(name)) as file:
            return file["levels/001/points"][()].tobytes()

    def test_every_kind_gives_the_same_surface(self):
        members = [("part/a.ply", self.ply), ("b.txt", b"no scan")]
        write_ply(self.scans / "plain.ply", self.sphere)
        for name, module in (("a.ply.gz", gzip), ("a.ply.bz2", bz2), ("a.ply.xz", lzma)):
            (self.scans / name).write_bytes(module.compress(self.ply))
        for name, mode in (("a.tar", "w"), ("a.tgz", "w:gz"), ("a.tar.bz2", "w:bz2"), ("a.tar.xz", "w:xz")):
            write_tar(self.scans / name, mode, members)
        with zipfile.ZipFile(self.scans / "a.zip", "w", zipfile.ZIP_DEFLATED) as box:
            for member in members:
                box.writestr(*member)
            box.writestr("part/packed.ply.gz", gzip.compress(self.ply))
        document = self.run_scans("--levels", 1)
        names = ["plain.ply", "a.ply.gz", "a.ply.bz2", "a.ply.xz", "a.zip__part__packed.ply.gz"]
        names += [f"{box}__part__a.ply" for box in ("a.tar", "a.tgz", "a.tar.bz2", "a.tar.xz", "a.zip")]
        self.assertEqual(document["done"], len(names))
        self.assertEqual(document["passed_over"], {".txt": 5})
        for name in names:
            self.assertEqual(self.points(name), self.points("plain.ply"), name)
        formats = {scan["name"]: scan["format"] for scan in document["scans"]}
        self.assertEqual(formats["a.ply.xz"], formats["plain.ply"] + ", xz")
        self.assertEqual(formats["a.zip__part__packed.ply.gz"], formats["plain.ply"] + ", gzip")

        first = contents(self.archive)
        self.assertEqual(self.run_scans("--levels", 1)["up_to_date"], len(names))
        self.assertEqual(contents(self.archive), first)
        # The same content elsewhere in the container's place is the same scan.
        write_tar(self.scans / "a.tar", "w", [("first.obj", obj_text(self.sphere).encode())] + members)
        document = self.run_scans("--levels", 1)
        self.assertEqual((document["done"], document["up_to_date"]), (1, len(names)))

    def test_one_bad_member_harms_no_other(self):
        with zipfile.ZipFile(self.scans / "box.zip", "w") as box:
            box.writestr("a.ply", self.ply)
            box.writestr("b.ply", self.ply[:100])
            box.writestr("../\x1b[31mc.ply", self.ply)
            box.writestr("inner.zip", b"PK")
        write_tar(self.scans / "cut.tar.gz", "w:gz", [(f"{i}.ply", os.urandom(200_000) ) for i in range(2)])
        cut = (self.scans / "cut.tar.gz").read_bytes()
        (self.scans / "cut.tar.gz").write_bytes(cut[:len(cut) * 3 // 4])
        (self.scans / "page.zip").write_bytes(b"<html>not found</html>")
        process = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 1, code=1)
        self.assertNotIn("\x1b", process.stdout + process.stderr)
        self.assertIn("passed over: " + str(self.scans / "box.zip/inner.zip") + ": ", process.stdout)
        failed = [line for line in process.stdout.splitlines() if line.startswith("failed: ")]
        self.assertEqual(len(failed), 5, process.stdout)
        for part in ("box.zip/b.ply: ", "cut.tar.gz/0.ply: ", "cut.tar.gz/1.ply: ", "cut.tar.gz: byte ",
                     "page.zip: the file is a web page"):
            self.assertTrue(any(part in line for line in failed), f"{part} not in {failed}")
        self.assertIn("2 done", process.stdout)
        # Nothing was written outside of the archive.
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["archive", "scans"])

    def test_formats_names_all_containers(self):
        containers = json.loads(self.semigeo("formats", "--json").stdout)["containers"]
        self.assertEqual(sorted(containers), sorted([".zip", ".7z", ".tar", ".tgz", ".tbz2", ".txz", ".tzst", ".tar.gz",
                                                     ".tar.bz2", ".tar.xz", ".tar.zst"]))
        said = self.semigeo("formats").stdout
        for extension in containers:
            self.assertIn(extension, said)

    def test_commands_go_through_containers(self):
        box = self.scans / "box.zip"
        with zipfile.ZipFile(box, "w") as file:
            file.writestr("part/a.ply", self.ply)
            file.writestr("b.ply", self.ply)
            file.writestr("c.txt", b"no scan")
        shown = self.semigeo("info", box).stdout
        self.assertIn("part/a.ply", shown)
        document = json.loads(self.semigeo("info", box, "--json").stdout)
        self.assertEqual([m["kind"] for m in document["members"]], ["scan", "scan", "no scan"])
        shown = self.semigeo("run", box, "--output", self.archive, "--dry-run").stdout
        self.assertIn("box.zip/part/a.ply: would run", shown)
        self.assertIn("2 scans: 2 would run", shown)
        self.semigeo("run", box / "part/a.ply", "--output", self.archive, "--levels", 2, "--library")
        process = self.semigeo("recognise", box / "part/a.ply", "--library", self.archive, "--json")
        scene = json.loads(process.stdout)["scenes"][0]
        self.assertEqual((scene["input"], scene["state"]), (str(box / "part/a.ply"), "done"))
        process = self.semigeo("run", box / "x", "--output", self.archive, code=2)
        self.assertIn("no scan of this name", process.stderr)


if __name__ == "__main__":
    unittest.main()
