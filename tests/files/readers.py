"""Readers of patchlight's files that share no code with what wrote them."""

import array
import csv
import json
import struct

COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}


def triples(values):
    return list(zip(values[0::3], values[1::3], values[2::3]))


class Glb:
    """A GLB's JSON, its accessors, and the named views that `extras` lists."""

    def __init__(self, path):
        data = path.read_bytes()
        magic, version, length = struct.unpack_from("<4sII", data)
        assert (magic, version, length) == (b"glTF", 2, len(data)), path
        size, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON"
        self.json = json.loads(data[20:20 + size])
        self.binary = data[28 + size:]

    def accessor(self, index):
        entry = self.json["accessors"][index]
        view = self.json["bufferViews"][entry["bufferView"]]
        count = entry["count"] * COMPONENTS[entry["type"]]
        values = array.array({5126: "f", 5125: "I"}[entry["componentType"]])
        values.frombytes(self.binary[view.get("byteOffset", 0):][:count * values.itemsize])
        return values

    def attribute(self, name):
        return self.accessor(self.json["meshes"][0]["primitives"][0]["attributes"][name])

    def triangles(self):
        found = []
        for primitive in self.json["meshes"][0]["primitives"]:
            found += triples(self.accessor(primitive["indices"]))
        return found

    def stored(self, name, kind):
        """Numbers of an array that only reading back uses; None when there is none."""
        names = self.json["extras"]["patchlight"]["views"]
        if name not in names:
            return None
        view = self.json["bufferViews"][names[name]]
        values = array.array(kind)
        values.frombytes(self.binary[view.get("byteOffset", 0):][:view["byteLength"]])
        return values


def read_ply(path):
    """Rows of vertices and faces, as tuples in the order of the header's properties."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + 11
    lines = data[:end].decode("ascii").splitlines()
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"]
    letters = {"double": "d", "float": "f", "uchar": "B", "uint": "I"}
    elements = []
    for line in lines[2:]:
        words = line.split()
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            # Every list here is of triangles.
            elements[-1][2].append("B3I" if words[1] == "list" else letters[words[1]])
    rows, offset = {}, end
    for name, count, properties in elements:
        row = struct.Struct("<" + "".join(properties))
        rows[name] = list(row.iter_unpack(data[offset:offset + count * row.size]))
        offset += count * row.size
    assert offset == len(data), "nothing follows"
    return rows["vertex"], rows["face"]


def read_csv(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


class Grid:
    """A .vtu, read by VTK."""

    def __init__(self, path):
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        reader = vtkXMLUnstructuredGridReader()
        problems = []
        for event in ("ErrorEvent", "WarningEvent"):
            reader.AddObserver(event, lambda *_: problems.append(str(path)))
        reader.SetFileName(str(path))
        reader.Update()
        assert not problems and reader.GetErrorCode() == 0, f"VTK complains about {path}"
        self.grid = reader.GetOutput()
        cells = range(self.grid.GetNumberOfCells())
        self.points = [self.grid.GetPoint(i) for i in range(self.grid.GetNumberOfPoints())]
        self.types = [self.grid.GetCellType(i) for i in cells]
        connectivity, offsets = self.grid.GetCells().GetConnectivityArray(), self.grid.GetCells().GetOffsetsArray()
        ends = [int(offsets.GetComponent(i, 0)) for i in range(offsets.GetNumberOfTuples())]
        nodes = [int(connectivity.GetComponent(i, 0)) for i in range(connectivity.GetNumberOfTuples())]
        self.cells = [nodes[a:b] for a, b in zip(ends, ends[1:])]

    @staticmethod
    def _tuples(values):
        rows = [values.GetTuple(i) for i in range(values.GetNumberOfTuples())]
        return rows if values.GetNumberOfComponents() > 1 else [row[0] for row in rows]

    def of_points(self, name):
        return self._tuples(self.grid.GetPointData().GetArray(name))

    def of_cells(self, name):
        return self._tuples(self.grid.GetCellData().GetArray(name))


class Picture:
    """An EXR, read by OpenImageIO."""

    def __init__(self, path):
        import OpenImageIO
        self.buffer = OpenImageIO.ImageBuf(str(path))
        spec = self.buffer.spec()
        assert (spec.nchannels, str(spec.format)) == (3, "float"), path
        self.width, self.height = spec.width, spec.height
        self.metadata = {a.name: a.value for a in spec.extra_attribs}

    def at(self, x, y):
        clamped = min(max(x, 0), self.width - 1), min(max(y, 0), self.height - 1)
        return self.buffer.getpixel(*clamped)

    def looked_up(self, u, v):
        """Bilinear, (0, 0) the upper left corner."""
        x, y = u * self.width - 0.5, v * self.height - 0.5
        i, j = int(x // 1), int(y // 1)
        f, g = x - i, y - j
        rows = [[(1 - f) * a + f * b for a, b in zip(self.at(i, j + k), self.at(i + 1, j + k))] for k in (0, 1)]
        return [(1 - g) * a + g * b for a, b in zip(*rows)]
