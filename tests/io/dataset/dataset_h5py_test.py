"""Reads the sample dataset of sample_dataset.cpp with h5py: our chunks through HDF5's own filters,
the virtual datasets of /VTKHDF, and every attribute. Usage: dataset_h5py_test.py WRITER"""

import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

LEVELS, VERTICES, TRIANGLES = 3, 50000, 90000


def expected_level(level, changing):
    n = VERTICES - (100 * level if changing else 0)
    f = TRIANGLES - (50 * level if changing else 0)
    i, t = np.arange(n), np.arange(f)
    points = np.stack([0.25 * i, np.full(n, level), (i * 7919 % 1000) / 8], axis=1)
    normals = np.stack([np.zeros(n), np.full(n, level), np.ones(n)], axis=1)
    return {
        "points": points.astype("f4"),
        "normals": normals.astype("f4"),
        "gaussian_curvature": (0.5 * i - level).astype("f4"),
        "mean_curvature": (level - 0.5 * i).astype("f4"),
        "patch_completeness": (i % 2).astype("f4"),
        "source_vertex": np.where(i % 10 == 9, -1, i).astype("i8"),
        "part": (i // 1000).astype("i4"),
        "triangles": np.stack([t % n, (t + 1) % n, (t + 2) % n], axis=1).astype("i8"),
    }


FEATURE = np.dtype([("vertex", "<i8"), ("value", "<f4"), ("prominence", "<f4"),
                    ("position", "<f4", 3), ("initial_position", "<f4", 3), ("normal", "<f4", 3),
                    ("scale_free_gaussian", "<f4"), ("scale_free_mean", "<f4"),
                    ("kind", "<i4"), ("contour_point", "<i8")])
CONTOUR = np.dtype([("first", "<i8"), ("count", "<i8"), ("kind", "<i4"), ("closed", "<i4")])


def expected_features(level, kind):
    rows = np.zeros(level * (5 + kind), FEATURE)
    i = np.arange(len(rows))
    rows["vertex"], rows["value"], rows["prominence"] = i, i - kind, 0.5 * i
    rows["position"][:, 0], rows["position"][:, 1:] = i, (kind, level)
    rows["initial_position"][:, 0], rows["initial_position"][:, 1:] = i, (kind, -1)
    rows["normal"] = (0, level, 1)
    rows["scale_free_gaussian"], rows["scale_free_mean"] = 0.25 * i, -0.25 * i
    rows["kind"], rows["contour_point"] = kind, -1
    if kind >= 2:
        rows["contour_point"] = i
    if kind == 3:
        rows["contour_point"] += len(expected_contours(level, 0)[1])
    return rows


def expected_contours(level, kind):
    """Contours, and their points; of H = 0 they follow those of K = 0."""
    contours = np.zeros(level * (2 + kind), CONTOUR)
    i = np.arange(len(contours))
    contours["count"], contours["kind"], contours["closed"] = 3 + i, kind, i % 2
    before = len(expected_contours(level, 0)[1]) if kind == 1 else 0
    contours["first"] = before + np.cumsum(contours["count"]) - contours["count"]
    p = np.arange(contours["count"].sum())
    points = np.stack([0.5 * p, np.full(len(p), kind), np.full(len(p), level), p - kind], axis=1)
    return contours, points.astype("f4")


def is_compact(array):
    return array.id.get_create_plist().get_layout() == h5py.h5d.COMPACT


def check_same(found, wanted, what):
    assert found.dtype == wanted.dtype, (what, found.dtype, wanted.dtype)
    np.testing.assert_array_equal(found[...], wanted, err_msg=what)


def check_levels(file, levels, compression):
    assert sorted(file["levels"]) == ["000", "001", "002"]
    for k, wanted in enumerate(levels):
        group = file[f"levels/{k:03d}"]
        assert sorted(group) == sorted([*wanted, "features", "contours", "contour_points"])
        attributes = dict(group.attrs)
        for name, values in (("feature_counts", [k * (5 + kind) for kind in range(4)]),
                             ("contour_counts", [2 * k, 3 * k]),
                             ("contour_lengths", [2.5 * len(expected_contours(k, kind)[1])
                                                  for kind in range(2)])):
            assert list(attributes.pop(name)) == values, name
        assert attributes == {"iteration": k, "step": 0.5, "scale": 0.25 + k,
                              "mean_edge_length": 1.5, "parts": 50, "shortest_side": 0.125,
                              "split": 1, "collapsed": 2, "torn": 3, "inserted": 4, "removed": 5,
                              "dropped_parts": 6, "flipped": 7}, attributes
        for name, values in wanted.items():
            check_same(group[name], values, f"{k} {name}")
            assert group[name].fletcher32
            assert group[name].shuffle == (compression == "deflate")


def check_features(file, compression):
    assert FEATURE.itemsize == 72 and CONTOUR.itemsize == 24
    for k in range(LEVELS):
        level = file[f"levels/{k:03d}"]
        contours, points = zip(*(expected_contours(k, kind) for kind in range(2)))
        wanted = {"features": np.concatenate([expected_features(k, kind) for kind in range(4)]),
                  "contours": np.concatenate(contours), "contour_points": np.concatenate(points)}
        for name, rows in wanted.items():
            check_same(level[name], rows, f"{k} {name}")
            assert is_compact(level[name]) == (k > 0), (k, name)
    features = file["levels/002/features"][...]
    np.testing.assert_array_equal(features["value"][features["kind"] == 1], np.arange(12) - 1)


def check_selection(file, changing):
    selection = file["selection"]
    check_same(selection["feature_counts"], np.array([0, 26, 52], "i8"), "feature_counts")
    check_same(selection["smoothed"], np.array([0.5, 26.5, 52.5]), "smoothed")
    assert dict(selection.attrs) == {"level": 2, "chosen": b"option" if changing else b"slope"}


def check_sharing(file, changing):
    for name in ("triangles", "source_vertex", "part"):
        same = file[f"levels/000/{name}"] == file[f"levels/002/{name}"]
        assert same != changing, name


def check_vtkhdf(file, levels, changing):
    vtk = file["VTKHDF"]
    kind = vtk.attrs.get_id("Type")
    assert vtk.attrs["Type"] == b"PolyData" and kind.get_type().get_size() == 8
    assert kind.get_type().get_cset() == h5py.h5t.CSET_ASCII
    assert list(vtk.attrs["Version"]) == [2, 0]
    names = {"Normals": "normals", "gaussian_curvature": "gaussian_curvature",
             "mean_curvature": "mean_curvature", "patch_completeness": "patch_completeness",
             "part": "part", "source_vertex": "source_vertex"}
    assert sorted(vtk["PointData"]) == sorted(names)
    steps = vtk["Steps"]
    assert list(steps["Values"]) == [0.25, 1.25, 2.25] and steps.attrs["NSteps"] == 3
    # As VTK's reader does: part and first point, cell and corner of the step, then ranges.
    for k, level in enumerate(levels):
        part = steps["PartOffsets"][k]
        first = steps["PointOffsets"][k]
        count = vtk["NumberOfPoints"][part]
        check_same(vtk["Points"][first:first + count], level["points"], "Points")
        for name, source in names.items():
            start = steps["PointDataOffsets"][name][k]
            check_same(vtk["PointData"][name][start:start + count], level[source], name)
        corner = steps["ConnectivityIdOffsets"][k][2]
        corners = vtk["Polygons/NumberOfConnectivityIds"][part]
        check_same(vtk["Polygons/Connectivity"][corner:corner + corners],
                   level["triangles"].ravel(), "Connectivity")
        cells = vtk["Polygons/NumberOfCells"][part]
        start = steps["CellOffsets"][k][2] + part
        check_same(vtk["Polygons/Offsets"][start:start + cells + 1],
                   3 * np.arange(cells + 1, dtype="i8"), "Offsets")
    for table in (steps["Values"], steps["PointOffsets"], vtk["Polygons/NumberOfCells"]):
        assert is_compact(table)
    assert vtk["Points"].is_virtual and vtk["Polygons/Connectivity"].is_virtual
    assert len(vtk["NumberOfPoints"]) == (LEVELS if changing else 1)
    # Reading across the border of two sources.
    everything = np.concatenate([level["points"] for level in levels])
    middle = len(levels[0]["points"])
    check_same(vtk["Points"][middle - 7:middle + 9], everything[middle - 7:middle + 9], "border")


def check_no_times(file):
    """A time of day in any object would make two equal runs differ."""
    seen = []
    file.visititems(lambda name, object: seen.append(
        (name, h5py.h5g.get_objinfo(object.id).mtime)))
    assert len(seen) > 40 and all(time == 0 for _, time in seen), seen


def check_header(file, digest):
    text = {name: value.decode() for name, value in file.attrs.items()
            if isinstance(value, bytes)}
    assert text["format"] == "semigeo-dataset" and text["creator"] == "semigeo"
    assert text["digest"] == digest and len(digest) == 32
    assert text["input_name"] == "vases/Krug Nº 7.ply"
    assert text["job_key"] == "key-of-the-job" and text["length_unit"] == "mm"
    assert text["parameters"] == '{"levels":3}'
    assert text["repairs"] == '{"duplicate_faces":2}'
    assert text["preparation"] == '{"holes":1}'
    assert file.attrs["complete"] == 1 and file.attrs["format_version"] == 4
    assert list(file.attrs["origin"]) == [1000.5, -2, 3]


def main(writer):
    for changing in (False, True):
        for compression in ("deflate", "none"):
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "sample.vtkhdf")
                mode = "changing" if changing else "same"
                digest = subprocess.run([writer, path, mode, compression], check=True, text=True,
                                        capture_output=True).stdout.strip()
                assert sorted(os.listdir(folder)) == ["sample.vtkhdf", "sample.xdmf"]
                levels = [expected_level(k, changing) for k in range(LEVELS)]
                with h5py.File(path, "r") as file:
                    check_header(file, digest)
                    check_no_times(file)
                    check_levels(file, levels, compression)
                    check_features(file, compression)
                    check_selection(file, changing)
                    check_sharing(file, changing)
                    check_vtkhdf(file, levels, changing)
                print(mode, compression, "ok")


main(sys.argv[1])
