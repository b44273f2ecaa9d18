"""The scans of a night: good, damaged, hostile, huge, empty, and some twice. Each says what must become of it."""

import bz2
import gzip
import io
import math
import os
import socket
import struct
import tarfile
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from support import boulder, icosphere, joined, obj_text, plane, ply_bytes, ply_header

MADE, FAILED, EITHER = "made", "failed", "either"


@dataclass
class Scan:
    path: str  # as the run names it
    outcome: str  # what an undisturbed run makes of it
    kind: str
    changes: bool = False  # while runs are under way


def torus(around, across, radius):
    """A ring, closed in both directions."""
    i, j = np.divmod(np.arange(around * across), across)
    u, v = 2 * np.pi * i / around, 2 * np.pi * j / across
    points = np.stack([(1 + radius * np.cos(v)) * np.cos(u), (1 + radius * np.cos(v)) * np.sin(u), radius * np.sin(v)], 1)
    a, b = i * across + j, (i + 1) % around * across + j
    c, d = (i + 1) % around * across + (j + 1) % across, i * across + (j + 1) % across
    return points, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def stl_bytes(mesh):
    points, triangles = mesh
    faces = np.zeros(len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("unused", "<u2")])
    faces["corners"] = points[triangles]
    return bytes(80) + struct.pack("<I", len(triangles)) + faces.tobytes()


def off_text(mesh):
    points, triangles = mesh
    return f"OFF\n{len(points)} {len(triangles)} 0\n" + "".join(
        [f"{x!r} {y!r} {z!r}\n" for x, y, z in points.tolist()] + [f"3 {a} {b} {c}\n" for a, b, c in triangles.tolist()])


class Meshes:
    """Small meshes of 50 to 3,000 vertices, no two of them equal."""

    def __init__(self, random):
        self.random = random
        self.kept = {}

    def shape(self):
        name = self.random.choice(["sphere", "boulder", "boulder", "plane", "torus", "two"])
        size = self.random.choices([2, 3, 4], [6, 3, 1])[0]
        key = (name, size, self.random.randrange(6))
        if key not in self.kept:
            across = 4 << size
            self.kept[key] = {"sphere": lambda: icosphere(size), "boulder": lambda: boulder(size, key[2]),
                              "plane": lambda: plane(across // 2 + key[2]),
                              "torus": lambda: torus(across, across // 2, 0.3),
                              "two": lambda: joined(icosphere(2), torus(across // 2, 8, 0.4))}[name]()
        return self.kept[key]

    def new(self):
        points, triangles = self.shape()
        turn = self.random.uniform(0, 2 * math.pi)
        c, s = math.cos(turn), math.sin(turn)
        size = 10 ** self.random.uniform(-1, 2)
        return size * (points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])), triangles


def encoded(random, mesh):
    """An extension, and the bytes of the mesh in that format."""
    extension = random.choices([".ply", ".obj", ".off", ".stl", ".ply.gz", ".obj.bz2"], [10, 2, 2, 3, 2, 1])[0]
    plain = {".ply": ply_bytes, ".stl": stl_bytes, ".obj": lambda m: obj_text(m).encode(),
             ".off": lambda m: off_text(m).encode()}["." + extension.split(".")[1]](mesh)
    pack = {"gz": lambda data: gzip.compress(data, 1, mtime=0), "bz2": lambda data: bz2.compress(data, 1)}
    return extension, pack.get(extension.split(".")[-1], bytes)(plain)


def damaged(random, mesh):
    """An extension, bytes with a fault, and what must become of them."""
    points, triangles = mesh[0].copy(), mesh[1].copy()
    whole = ply_bytes(mesh)
    kind = random.choice(["cut", "flipped", "counts", "nan", "index", "packed", "noise", "lines", "zeros"])
    if kind == "cut":
        return ".ply", whole[:random.randrange(1, len(whole))], FAILED
    if kind == "flipped":
        data = bytearray(whole)
        for _ in range(random.randrange(1, 20)):
            data[random.randrange(len(data))] ^= 1 << random.randrange(8)
        return ".ply", bytes(data), EITHER
    if kind == "counts":
        return ".ply", whole.replace(b"element face ", b"element face 9"), FAILED
    if kind == "nan":
        points[:, random.randrange(3)] = math.nan
        return ".ply", ply_bytes((points, triangles)), FAILED
    if kind == "index":
        triangles[random.randrange(len(triangles)), 1] = len(points)
        return ".ply", ply_bytes((points, triangles)), FAILED
    if kind == "packed":
        return ".ply.gz", gzip.compress(whole, 1, mtime=0)[:-random.randrange(9, 60)], FAILED
    if kind == "noise":
        return random.choice([".stl", ".ply", ".glb", ".ply.gz"]), random.randbytes(random.randrange(1, 5000)), FAILED
    if kind == "lines":
        lines = obj_text(mesh).split("\n")
        random.shuffle(lines)
        return ".obj", "\n".join(lines).encode(), EITHER
    return ".stl", bytes(random.randrange(84, 5000)), FAILED


def hostile(random, good):
    """Names, bytes and what must become of each."""
    deep = 100_000
    zeros = gzip.compress(bytes(1 << 24), 9, mtime=0)
    return [
        ("claims.ply", ply_header(2 ** 40, 2 ** 40) + bytes(100), FAILED),
        ("claims.stl", bytes(80) + struct.pack("<I", 2 ** 32 - 1) + bytes(50), FAILED),
        ("claims.off", f"OFF\n{10 ** 18} {10 ** 18} 0\n".encode(), FAILED),
        ("index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9223372036854775807\n", FAILED),
        ("deep.gltf", b'{"asset":' + b'{"a":' * deep + b"1" + b"}" * deep + b"}", FAILED),
        # 1.5 GiB, which is more than a job may have.
        ("bomb.ply.gz", gzip.compress(ply_header(2 ** 26, 1), mtime=0) + 96 * zeros, FAILED),
        ("pointer.ply", b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n", FAILED),
        ("page.obj", b"<!DOCTYPE html><html><body>Not found</body></html>", FAILED),
        ("line\nfailed: all.ply", good, MADE),
        ("esc\x1b[31m\x1b]0;title\a.ply", good, MADE),
        ("line\nesc\x1b[2J.ply", b"ply\n", FAILED),
        ("bytes\udcff\udcfe.ply", good, MADE),
        ("<script>alert(1)<b>.ply", good, MADE),
        ("-rf.ply", good, MADE),
        ("n" * 246 + ".ply", good, MADE),
        ("/".join(["deep"] * 40) + "/a.ply", good, MADE),
        ("junk behind.ply", good + b"\0" * 1000, MADE),
        ("empty.ply", b"", FAILED),
        ("empty.stl", b"", FAILED),
    ]


class Folder:
    """Writes scans, and keeps what must become of them."""

    def __init__(self, folder, random):
        self.folder, self.random = folder, random
        self.scans = []
        self.good = []  # paths of good scans, to be had twice

    def expect(self, path, outcome, kind, changes=False):
        self.scans.append(Scan(str(path), outcome, kind, changes))

    def add(self, name, data, outcome, kind, changes=False):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        self.expect(path, outcome, kind, changes)
        return path

    def add_good(self, name, mesh):
        extension, data = encoded(self.random, mesh)
        self.good.append(self.add(name + extension, data, MADE, "good"))

    def add_container(self, name, meshes):
        """A container with good members, a bad one and one with a name that leads out of it."""
        members = [("a.ply", ply_bytes(meshes[0]), MADE), ("sub/b.ply", ply_bytes(meshes[1]), MADE),
                   ("c.ply", ply_bytes(meshes[0])[:500], FAILED), ("../\x1b[1m/d.ply", ply_bytes(meshes[2]), MADE)]
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if name.endswith(".zip"):
            with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as box:
                for member, data, _ in members:
                    box.writestr(member, data)
        else:
            with tarfile.open(path, "w:gz") as box:
                for member, data, _ in members:
                    info = tarfile.TarInfo(member)
                    info.size = len(data)
                    box.addfile(info, io.BytesIO(data))
        for member, _, outcome in members:
            self.expect(path / member.removeprefix("../"), outcome, "container")

    def add_hostile(self, name, mesh):
        folder = self.folder / name
        for file, data, outcome in hostile(self.random, ply_bytes(mesh)):
            self.add(f"{name}/{file}", data, outcome, "hostile")
        for file, make in (("pipe.ply", os.mkfifo), ("pipe.zip", os.mkfifo), ("socket.ply", bind_socket),
                           ("circle.ply", lambda path: os.symlink("circle.ply", path)),
                           ("dangling.obj", lambda path: os.symlink("nowhere", path)),
                           ("cut.zip", lambda path: path.write_bytes(b"PK\3\4" + bytes(200)))):
            make(folder / file)
            self.expect(folder / file, FAILED, "hostile")
        os.symlink(".", folder / "loop")
        os.symlink("claims.ply", folder / "the same.ply")
        locked = self.add(f"{name}/locked.ply", ply_bytes(mesh), MADE if os.geteuid() == 0 else FAILED, "locked")
        locked.chmod(0)
        self.add(f"{name}/changing.ply", ply_bytes(mesh), MADE, "changing", changes=True)
        self.add(f"{name}/growing.obj", obj_text(mesh).encode(), MADE, "changing", changes=True)


def bind_socket(path):
    """A socket of that name, which need not be short."""
    before = os.getcwd()
    os.chdir(path.parent)
    try:
        with socket.socket(socket.AF_UNIX) as one:
            one.bind(path.name)
    finally:
        os.chdir(before)


def write_scans(folder, twins, count, huge, random):
    """About `count` scans in two folders. Those in `twins` have names that others have. One is much larger than the
    others: an open square of `huge` x `huge` cells."""
    meshes = Meshes(random)
    into = Folder(folder, random)
    for i in range(max(1, count // 400)):
        into.add_hostile(f"hostile {i}", meshes.new())
        for name in ("box.zip", "box.tar.gz"):
            into.add_container(f"boxes {i}/{name}", [meshes.new() for _ in range(3)])
    into.add("huge.ply", ply_bytes(plane(huge)), MADE, "huge")
    os.symlink("/dev/zero", folder / "device.ply")
    into.expect(folder / "device.ply", FAILED, "hostile")
    left = count - len(into.scans)
    for i in range(left // 4):
        extension, data, outcome = damaged(random, meshes.new())
        into.add(f"day {random.randrange(8)}/bad{i}{extension}", data, outcome, "damaged")
    for i in range(left - left // 4 - 2 * (left // 16)):
        into.add_good(f"day{random.randrange(8)}/scan{i}", meshes.new())
    second = Folder(twins, random)
    for path in random.sample(into.good, left // 16):  # twice by content, elsewhere
        into.add(f"copies/copy of {path.name}", path.read_bytes(), MADE, "copy")
    for path in random.sample(into.good, left // 16):  # twice by name
        second.add(path.relative_to(folder), path.read_bytes() if random.random() < 0.5 else ply_bytes(meshes.new()),
                   MADE if path.suffix == ".ply" else EITHER, "twin")
    return into.scans + second.scans
