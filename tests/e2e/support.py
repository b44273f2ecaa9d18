"""What the end-to-end tests share: the program, a folder of their own, and scans to feed it.
A test program is started as `python3 -B NAME_test.py PROGRAM [unittest's arguments]`."""

import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

PROGRAM = Path(sys.argv.pop(1)).resolve()
TIMEOUT = 600  # of a call that hangs: no test may depend on how fast the machine is


class SemigeoTest(unittest.TestCase):
    """A test with a temporary folder: scans go to self.scans, results to self.archive."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="semigeo-e2e-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.scans = self.folder / "scans"
        self.scans.mkdir()
        self.archive = self.folder / "archive"

    def semigeo(self, *arguments, code=0, **options):
        """Runs the program, expects this exit code, and returns the process with its output."""
        process = subprocess.run([str(PROGRAM), *(a if isinstance(a, bytes) else str(a) for a in arguments)], capture_output=True,
                                 timeout=TIMEOUT, **options)
        process.stdout = process.stdout.decode(errors="backslashreplace")
        process.stderr = process.stderr.decode(errors="backslashreplace")
        self.assertEqual(process.returncode, code, f"{arguments}\n{process.stdout}{process.stderr}")
        return process

    def run_scans(self, *arguments, code=0, archive=None):
        """`semigeo run` over self.scans; its JSON."""
        process = self.semigeo("run", self.scans, "--output", archive or self.archive, "--json",
                               *arguments, code=code)
        return json.loads(process.stdout)

    def states(self, document):
        return {Path(scan["input"]).name: scan["state"] for scan in document["scans"]}

    def dataset(self, name, archive=None):
        return (archive or self.archive) / "scans" / f"{name}.vtkhdf"

    def assert_same_archives(self, found, wanted):
        """Every file, hidden ones too, with every byte; but for the records of runs."""
        found, wanted = contents(found), contents(wanted)
        self.assertEqual(sorted(found), sorted(wanted))
        for path, data in wanted.items():
            self.assertTrue(found[path] == data, f"{path} differs")


# What runs note of themselves, with times in it.
RECORDS = ("digests.txt", "estimates.json", "journal.jsonl")


def cpu_of_children():
    """Seconds of CPU time of all programs that have ended. Other than wall time it says little about what else runs."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def children_of(process):
    """Ids of the children of a process; none once it has ended."""
    try:
        return [int(pid) for pid in Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()]
    except OSError:
        return []


def contents(folder):
    """Every file of a folder but the records of runs."""
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file() and path.name not in RECORDS}


def icosphere(levels, radius=1.0):
    """Points (N, 3) and outward triangles (F, 3) of an icosahedron subdivided `levels` times."""
    g = (1 + 5 ** 0.5) / 2
    points = np.array([(s, t * g, 0) for s in (-1, 1) for t in (-1, 1)], float)
    points = np.concatenate([points, np.roll(points, 1, 1), np.roll(points, 2, 1)])
    points /= np.linalg.norm(points[0])
    near = points @ points.T > 0.4
    faces = [(a, b, c) for a in range(12) for b in range(a) for c in range(b)
             if near[a, b] and near[b, c] and near[a, c]]
    triangles = np.array(
        [f if np.linalg.det(points[list(f)]) > 0 else f[::-1] for f in faces])
    for _ in range(levels):
        edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
        unique, index = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
        middle = len(points) + index.reshape(-1, 3)
        halves = points[unique].sum(axis=1)
        points = np.concatenate([points, halves / np.linalg.norm(halves, axis=1)[:, None]])
        (a, b, c), (ab, bc, ca) = triangles.T, middle.T
        triangles = np.concatenate([np.stack(t, axis=1) for t in (
            (a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return radius * points, triangles


def boulder(levels, seed):
    """A sphere with bumps and dents."""
    points, triangles = icosphere(levels)
    centres = np.random.default_rng(seed).normal(size=(24, 3))
    centres /= np.linalg.norm(centres, axis=1)[:, None]
    near = np.exp(12 * (points @ centres.T - 1))
    return points * (1 + near @ np.tile([0.15, -0.1], 12))[:, None], triangles


def plane(cells):
    """An open square of cells x cells, slightly bent."""
    i, j = np.divmod(np.arange((cells + 1) ** 2), cells + 1)
    points = np.stack([i, j, 0.001 * (i - j) ** 2], axis=1) / cells
    corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    a, b, c, d = corner, corner + cells + 1, corner + cells + 2, corner + 1
    return points, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def joined(*meshes):
    """One mesh of several, which do not touch."""
    points, triangles, first = [], [], 0
    for p, t in meshes:
        points.append(p)
        triangles.append(t + first)
        first += len(p)
    return np.concatenate(points), np.concatenate(triangles)


def ply_header(vertices, faces, format="binary_little_endian", kind="double"):
    return (f"ply\nformat {format} 1.0\nelement vertex {vertices}\n"
            f"property {kind} x\nproperty {kind} y\nproperty {kind} z\n"
            f"element face {faces}\nproperty list uchar int vertex_indices\nend_header\n").encode()


def ply_bytes(mesh):
    points, triangles = mesh
    faces = np.zeros(len(triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    return ply_header(len(points), len(triangles)) + points.astype("<f8").tobytes() + faces.tobytes()


def obj_text(mesh):
    points, triangles = mesh
    return "".join([f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist()] +
                   [f"f {a} {b} {c}\n" for a, b, c in (triangles + 1).tolist()])


def write_ply(path, mesh):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(ply_bytes(mesh))
    return path


def partials(archive):
    """Unfinished files of an archive, with their sizes."""
    found = {}
    for folder in (archive, archive / "scans"):
        try:
            entries = list(os.scandir(folder))
        except FileNotFoundError:
            continue
        for entry in entries:
            if entry.name.endswith(".partial"):
                try:
                    found[entry.name] = entry.stat().st_size
                except FileNotFoundError:
                    pass
    return found
