"""Reads a library with h5py: our chunks through HDF5's own filters, by what docs/formats/library.md says and
nothing else. Usage: library_h5py_test.py WRITER"""

import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

POSTING = np.dtype([("invariants", "u1", 16), ("model", "<i4"), ("corners", "<u2", 3)])
FEATURE = np.dtype([("position", "<f4", 3), ("normal", "<f4", 3), ("scale_free_gaussian", "<f4"),
                    ("scale_free_mean", "<f4"), ("value", "<f4"), ("code", "u1"), ("level", "u1")])


def texts(array):
    return bytes(array[:]).split(b"\0")[:-1]


def directions(packed):
    u, v = ((packed.astype("f8") - 32767) / 32767).T
    z = 1 - abs(u) - abs(v)
    sign = lambda x: np.where(x >= 0, 1, -1)
    x = np.where(z >= 0, u, sign(u) * (1 - abs(v)))
    y = np.where(z >= 0, v, sign(v) * (1 - abs(u)))
    n = np.stack([x, y, z], axis=1)
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def check_models(models):
    assert texts(models["names"]) == [b"model-000000", b"model-000001", b"model-000002"]
    assert texts(models["digests"]) == [32 * b"a", 32 * b"b", 32 * b"c"]
    assert texts(models["length_units"]) == [b"mm", b"unknown", b"mm"]
    assert models["features"].dtype == FEATURE
    assert list(models["feature_offsets"]) == [0, 300, 600, 900]
    assert list(models["sample_offsets"]) == [0, 500, 1000, 1500]
    assert list(models["level_offsets"]) == [0, 3, 6, 9]
    assert np.array_equal(models["level_scales"], np.tile(np.float32([0.1, 0.2, 0.5]), 3))
    features = models["features"][:]
    assert features["code"].max() == 7 and features["level"].max() == 2
    assert np.allclose(np.linalg.norm(features["normal"], axis=1), 1, atol=1e-5)
    assert abs(features["position"]).max() < 1 < models["diagonals"][:].min()
    assert models["sample_points"].shape == (1500, 3) and models["origins"].shape == (3, 3)
    # Evenly spread: their mean is near zero, and as many point up as down.
    normals = directions(models["sample_normals"][:])
    assert np.linalg.norm(normals.mean(axis=0)) < 0.1
    assert models["sample_points"].chunks[0] == 1500 and models["sample_points"].fletcher32


def check_postings(file):
    postings, cells = file["postings"][:], file["cells"][:]
    assert file["postings"].dtype == POSTING and file["postings"].chunks == (65536,)
    assert file["postings"].compression is None and file["cells"].compression == "gzip"
    assert len(cells) == 672 * 512 + 1 and cells[0] == 0 and cells[-1] == len(postings) > 65536
    counts = np.bincount(postings["model"], minlength=3)
    assert np.array_equal(counts, file["models/triplets"])
    # The codes of a cell are those of the corners' features.
    cell = np.repeat(np.arange(672 * 512), np.diff(cells))
    rows = postings["corners"] + 300 * postings["model"][:, None]
    code = file["models/features"][:]["code"][rows].astype("i8")
    assert np.array_equal(cell % 512, code @ [64, 8, 1])
    key = np.stack([cell, postings["model"], *postings["corners"].T.astype("i8")])
    assert np.array_equal(np.lexsort(key[::-1]), np.arange(len(postings)))


def main():
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "library.h5")
        subprocess.run([sys.argv[1], path], check=True)
        with h5py.File(path) as file:
            assert file.attrs["format"] == b"semigeo-library" and file.attrs["complete"] == 1
            assert file.attrs["parameters"] == b'{"levels":3}' and len(file.attrs["digest"]) == 32
            check_models(file["models"])
            check_postings(file)


main()
