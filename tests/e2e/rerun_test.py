"""What a second run does: nothing, or exactly what depends on a change; and that neither threads nor
place nor time show in the bytes."""

import json
import os
import resource
import shutil
import unittest

from support import SemigeoTest, icosphere, joined, plane, write_ply


class RerunTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        write_ply(self.scans / "a.ply", icosphere(3))
        write_ply(self.scans / "deep/b.ply", plane(20))
        write_ply(self.scans / "c.ply", icosphere(2, 5))

    def inode_of(self, name):
        """A remade dataset is a new file."""
        status = os.stat(self.dataset(name))
        return status.st_ino, status.st_mtime_ns

    def test_a_second_run_does_nothing_and_says_so(self):
        first = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 2)
        self.assertIn("3 done, 0 up to date, 0 failed", first.stdout)
        before = [self.inode_of(name) for name in ("a.ply", "deep__b.ply", "c.ply")]
        second = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 2)
        self.assertIn("0 done, 3 up to date, 0 failed; ", second.stdout)
        self.assertNotIn("vertex levels/s", second.stdout)
        self.assertEqual(before,
                         [self.inode_of(name) for name in ("a.ply", "deep__b.ply", "c.ply")])

    def test_a_changed_scan_is_remade_alone(self):
        self.run_scans("--levels", 2)
        before = {name: self.inode_of(name) for name in ("a.ply", "deep__b.ply", "c.ply")}
        write_ply(self.scans / "c.ply", icosphere(2, 6))
        document = self.run_scans("--levels", 2)
        self.assertEqual(self.states(document),
                         {"a.ply": "up to date", "b.ply": "up to date", "c.ply": "done"})
        self.assertEqual({name for name in before if before[name] != self.inode_of(name)},
                         {"c.ply"})

    def test_pipes_and_brackets_in_the_place_of_small_files(self):
        self.run_scans("--levels", 2)
        for name in "estimates.json", "digests.txt", "sources.json":
            for make in os.mkfifo, lambda path: path.write_bytes(b"[" * 10 ** 8):
                path = self.archive / name
                with self.subTest(name=name):
                    data = path.read_bytes()
                    path.unlink()
                    make(path)
                    process = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 2,
                                           code=1 if name == "sources.json" else 0)
                    if name == "sources.json":
                        self.assertIn(f"semigeo: {path}: ", process.stderr)
                    path.unlink()
                    path.write_bytes(data)
        pipe = self.folder / "options.toml"
        os.mkfifo(pipe)
        process = self.semigeo("run", self.scans, "--output", self.archive, "--config", pipe, code=2)
        self.assertIn("is not a regular file", process.stderr)

    def test_too_little_memory_for_the_run_itself_is_a_sentence(self):
        self.run_scans("--levels", 2)
        (self.archive / "sources.json").write_bytes(b'{"a": "' + b"x" * 200_000_000 + b'"}')
        most = 500 << 20
        process = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 2, code=1,
                               preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (most, most)))
        self.assertIn("semigeo: there is not enough memory", process.stderr)

    def test_folders_that_are_links_are_not_written_through(self):
        self.run_scans("--levels", 2)
        for name in "scans", "logs":
            with self.subTest(name=name):
                elsewhere = self.folder / "elsewhere"
                (self.archive / name).rename(elsewhere)
                (self.archive / name).symlink_to(elsewhere)
                before = sorted(elsewhere.iterdir())
                process = self.semigeo("run", self.scans, "--output", self.archive, "--levels", 3, code=1)
                self.assertIn(f"semigeo: {self.archive / name}: is a symbolic link", process.stderr)
                self.assertEqual(sorted(elsewhere.iterdir()), before)
                (self.archive / name).unlink()
                elsewhere.rename(self.archive / name)

    def test_a_file_beside_a_scan_belongs_to_it(self):
        points, triangles = icosphere(3)
        (self.scans / "part").mkdir()
        numbers = self.scans / "part/b 1.bin"
        indices = triangles.astype("<u2").tobytes()

        def write(radius):
            numbers.write_bytes((radius * points).astype("<f4").tobytes() + indices)

        write(1)
        size = numbers.stat().st_size
        (self.scans / "b.gltf").write_text(json.dumps({
            "asset": {"version": "2.0"}, "buffers": [{"uri": "part/b%201.bin", "byteLength": size}],
            "bufferViews": [{"buffer": 0, "byteLength": size - len(indices)},
                            {"buffer": 0, "byteOffset": size - len(indices), "byteLength": len(indices)}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3"},
                          {"bufferView": 1, "componentType": 5123, "count": triangles.size, "type": "SCALAR"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]}))
        document = self.run_scans("--levels", 1)
        self.assertEqual((document["done"], document["failed"]), (4, 0))
        self.assertEqual(self.run_scans("--levels", 1)["up_to_date"], 4)
        write(2)
        self.assertEqual(self.states(self.run_scans("--levels", 1))["b.gltf"], "done")
        numbers.unlink()
        document = self.run_scans("--levels", 1, code=1)
        self.assertEqual((document["up_to_date"], document["failed"]), (3, 1))
        error, = (scan["error"] for scan in document["scans"] if scan["state"] == "failed")
        self.assertIn("'part/b%201.bin', and there is no such file", error)

    def test_a_touched_scan_is_up_to_date(self):
        self.run_scans("--levels", 2)
        os.utime(self.scans / "a.ply")
        os.utime(self.scans / "c.ply", (0, 0))
        self.assertEqual(self.run_scans("--levels", 2)["up_to_date"], 3)

    def test_a_changed_parameter_remakes_all(self):
        self.run_scans("--levels", 2)
        changes = (("--levels", 3), ("--surface", "flat"), ("--step", 1.5),
                   ("--compression", "none"), ("--unit", "mm"))
        for change in changes:
            arguments = change if change[0] == "--levels" else ("--levels", 2, *change)
            with self.subTest(change=change):
                self.assertEqual(self.run_scans(*arguments)["done"], 3)
                self.assertEqual(self.run_scans(*arguments)["up_to_date"], 3)
        self.assertEqual(self.run_scans("--levels", 2)["done"], 3)

    def test_a_new_scan_is_added_alone(self):
        self.run_scans("--levels", 1)
        write_ply(self.scans / "d.ply", icosphere(1))
        document = self.run_scans("--levels", 1)
        self.assertEqual((document["done"], document["up_to_date"]), (1, 3))

    def test_what_failed_is_tried_again(self):
        (self.scans / "d.ply").write_text("no ply")
        self.assertEqual(self.run_scans("--levels", 1, code=1)["failed"], 1)
        document = self.run_scans("--levels", 1, code=1)
        self.assertEqual((document["up_to_date"], document["failed"]), (3, 1))
        write_ply(self.scans / "d.ply", icosphere(1))
        self.assertEqual(self.run_scans("--levels", 1)["done"], 1)

    def test_only_content_shows_in_the_bytes(self):
        self.run_scans("--levels", 2)
        shutil.copytree(self.scans, self.folder / "elsewhere/copy")
        other = self.folder / "elsewhere/archive"
        self.semigeo("run", "copy/", "--output", "archive", "--levels", 2,
                     cwd=self.folder / "elsewhere")
        for archive in (other, self.archive):
            (archive / "sources.json").unlink()  # it names the places
        self.assert_same_archives(other, self.archive)

    def test_a_missing_sidecar_is_remade_without_computing(self):
        self.run_scans("--levels", 2)
        sidecar = self.dataset("a.ply").with_suffix(".xdmf")
        wanted, before = sidecar.read_bytes(), self.inode_of("a.ply")
        sidecar.unlink()
        document = self.run_scans("--levels", 2)
        self.assertEqual(self.states(document),
                         {"a.ply": "done", "b.ply": "up to date", "c.ply": "up to date"})
        self.assertEqual((document["vertex_levels"], self.inode_of("a.ply")), (0, before))
        self.assertEqual(sidecar.read_bytes(), wanted)

    def test_scans_of_one_name_from_two_folders_do_not_replace_each_other(self):
        folders = [self.folder / "two/a", self.folder / "two/b"]
        for radius, folder in enumerate(folders, 1):
            write_ply(folder / "x.ply", icosphere(1, radius))
            self.semigeo("run", folder, "--output", self.archive, "--levels", 1)
        self.assertEqual(len(list((self.archive / "scans").glob("*.vtkhdf"))), 2)
        for inputs in (folders[:1], folders[1:], folders, folders[::-1]):
            process = self.semigeo("run", *inputs, "--output", self.archive, "--levels", 1)
            self.assertIn(f"0 done, {len(inputs)} up to date", process.stdout)
        # They may move, alone or together.
        (self.folder / "two").rename(self.folder / "three")
        process = self.semigeo("run", self.folder / "three/b", self.folder / "three/a", "--output",
                               self.archive, "--levels", 1)
        self.assertIn("0 done, 2 up to date", process.stdout)

    def test_names_do_not_depend_on_the_order_of_the_inputs(self):
        folders = [self.folder / "a", self.folder / "b"]
        archives = [self.folder / "forth", self.folder / "back"]
        for radius, folder in enumerate(folders, 1):
            write_ply(folder / "x.ply", icosphere(1, radius))
        for inputs, archive in zip((folders, folders[::-1]), archives):
            self.semigeo("run", *inputs, "--output", archive, "--levels", 1)
        self.assert_same_archives(*archives)

    def test_every_number_of_threads_gives_the_same_bytes(self):
        # Several chunks of every array, several blocks of vertices, a rim, several parts.
        mesh = joined(icosphere(6), (plane(60)[0] + 3, plane(60)[1]))
        write_ply(self.scans / "large.ply", mesh)
        archives = []
        for threads in (1, 2, 4):
            archives.append(self.folder / f"threads{threads}")
            self.run_scans("--levels", 2, "--threads", threads, archive=archives[-1])
        for archive in archives[1:]:
            self.assert_same_archives(archive, archives[0])


if __name__ == "__main__":
    unittest.main()
