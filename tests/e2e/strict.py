"""Readers of files that `semigeo export` writes, as strict as their formats: every byte must have a meaning. Each returns
the arrays of the file by name; triangles are (F, 3)."""

import json
import re
import struct
import xml.etree.ElementTree as ElementTree

import numpy as np

PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4",
             "float": "<f4", "double": "<f8"}


def require(condition, message):
    if not condition:
        raise ValueError(message)


def read_ply(path):
    """Binary little-endian PLY with vertices and triangles. Source: Greg Turk's description of the format."""
    head, found, body = path.read_bytes().partition(b"end_header\n")
    require(found, "no end of the header")
    lines = head.decode("ascii").split("\n")
    require(lines[:2] == ["ply", "format binary_little_endian 1.0"] and lines[-1] == "", lines)
    elements = []
    for line in lines[2:-1]:
        words = line.split(" ")
        if words[0] == "comment":
            continue
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        else:
            require(words[0] == "property", line)
            elements[-1][2].append(words[1:])
    require([e[0] for e in elements] == ["vertex", "face"], elements)
    (_, vertices, properties), (_, faces, face_properties) = elements
    names = [name for _, name in properties]
    require(len(set(names)) == len(names), f"a property twice: {names}")
    record = np.dtype([(name, PLY_TYPES[kind]) for kind, name in properties])
    require(face_properties == [["list", "uchar", "int", "vertex_indices"]], face_properties)
    face = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
    require(len(body) == vertices * record.itemsize + faces * face.itemsize, "bytes that belong to nothing")
    table = np.frombuffer(body, record, vertices)
    triangles = np.frombuffer(body, face, faces, offset=table.nbytes)
    require((triangles["count"] == 3).all(), "a face that is no triangle")
    require_corners(triangles["corners"], vertices)
    return {**{name: table[name] for name in names}, "triangles": triangles["corners"]}


def require_corners(triangles, vertices):
    require(len(triangles) == 0 or (triangles.min() >= 0 and triangles.max() < vertices), "a corner that is no vertex")


def read_obj(path):
    """OBJ of v (3 or 6 numbers), vn and f a//a. Source: Wavefront's appendix B1."""
    rows = {"v": [], "vn": [], "f": []}
    for number, line in enumerate(path.read_text("ascii").split("\n"), 1):
        words = line.split(" ")
        if line == "" or words[0] == "#":
            continue
        require(words[0] in rows, f"line {number}: {line}")
        if words[0] == "f":
            pairs = [re.fullmatch(r"(\d+)//(\d+)", word) for word in words[1:]]
            require(all(pairs) and all(p[1] == p[2] for p in pairs), line)
            rows["f"].append([int(p[1]) - 1 for p in pairs])
        else:
            rows[words[0]].append([float(word) for word in words[1:]])
    vertices = np.array(rows["v"])
    require(vertices.shape[1] == 6, vertices.shape)
    require_corners(np.array(rows["f"]), len(vertices))
    return {"points": vertices[:, :3], "colours": vertices[:, 3:], "normals": np.array(rows["vn"]),
            "triangles": np.array(rows["f"])}


def read_stl(path):
    """Binary STL. Source: 3D Systems' interface specification."""
    data = path.read_bytes()
    require(not data.startswith(b"solid"), "looks like a text")
    count = struct.unpack("<I", data[80:84])[0]
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    require(record.itemsize == 50 and len(data) == 84 + 50 * count, "bytes that belong to nothing")
    table = np.frombuffer(data, record, count, offset=84)
    require((table["attribute"] == 0).all(), "attributes")
    return {"corners": table["corners"], "normals": table["normal"]}


GLB_TYPES = {5121: "u1", 5125: "<u4", 5126: "<f4"}


def read_glb(path):
    """Binary glTF 2.0 with one mesh. Source: Khronos' specification, 3.6, 3.7 and 4."""
    data = path.read_bytes()
    magic, version, length, json_length, json_kind = struct.unpack("<4sIII4s", data[:20])
    require((magic, version, length, json_kind) == (b"glTF", 2, len(data), b"JSON"), data[:20])
    document = json.loads(data[20:20 + json_length])
    binary = data[20 + json_length:]
    size, kind = struct.unpack("<I4s", binary[:8])
    require(kind == b"BIN\0" and size == len(binary) - 8 and size % 4 == 0 and json_length % 4 == 0, "chunks")
    require(document["buffers"] == [{"byteLength": size}], document["buffers"])

    def array(number):
        accessor = document["accessors"][number]
        view = document["bufferViews"][accessor["bufferView"]]
        columns = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        dtype = np.dtype(GLB_TYPES[accessor["componentType"]])
        require(view["byteOffset"] % 4 == 0, "not aligned")
        require(view["byteLength"] == accessor["count"] * columns * dtype.itemsize, "a view of another size")
        values = np.frombuffer(binary, dtype, accessor["count"] * columns, offset=8 + view["byteOffset"])
        values = values.reshape(-1, columns)[:, 0] if columns == 1 else values.reshape(-1, columns)
        if "min" in accessor:
            np.testing.assert_array_equal(values.min(axis=0), np.float32(accessor["min"]))
            np.testing.assert_array_equal(values.max(axis=0), np.float32(accessor["max"]))
        return values

    [primitive] = document["meshes"][0]["primitives"]
    require("min" in document["accessors"][primitive["attributes"]["POSITION"]], "POSITION needs bounds")
    arrays = {name: array(number) for name, number in primitive["attributes"].items()}
    arrays["triangles"] = array(primitive["indices"]).reshape(-1, 3)
    require_corners(arrays["triangles"], len(arrays["POSITION"]))
    return {**arrays, "node": document["nodes"][0]}


VTP_TYPES = {"Float32": "<f4", "Float64": "<f8", "Int64": "<i8", "UInt8": "u1"}


def read_vtp(path):
    """VTK XML PolyData with raw appended arrays. Source: VTK's file formats, XML."""
    head, found, rest = path.read_bytes().partition(b'<AppendedData encoding="raw">\n   _')
    require(found, "no appended data")
    data, found, tail = rest.rpartition(b"\n  </AppendedData>\n</VTKFile>\n")
    require(found and tail == b"", "no end")
    root = ElementTree.fromstring(head + b"</VTKFile>")
    require(root.attrib == {"type": "PolyData", "version": "1.0", "byte_order": "LittleEndian",
                            "header_type": "UInt64"}, root.attrib)
    piece = root.find("PolyData/Piece")
    arrays, end = {}, 0
    for element in piece.iter("DataArray"):
        at = int(element.get("offset"))
        require(at == end, "bytes between arrays")
        size = struct.unpack("<Q", data[at:at + 8])[0]
        columns = int(element.get("NumberOfComponents"))
        values = np.frombuffer(data[at + 8:at + 8 + size], VTP_TYPES[element.get("type")])
        arrays[element.get("Name")] = values if columns == 1 else values.reshape(-1, columns)
        end = at + 8 + size
    require(end == len(data), "bytes that belong to nothing")
    require(len(arrays["Points"]) == int(piece.get("NumberOfPoints")), "points")
    triangles = arrays.pop("connectivity").reshape(-1, 3)
    require(len(triangles) == int(piece.get("NumberOfPolys")), "triangles")
    np.testing.assert_array_equal(arrays.pop("offsets"), 3 * np.arange(1, len(triangles) + 1))
    require_corners(triangles, len(arrays["Points"]))
    return {**arrays, "triangles": triangles}
