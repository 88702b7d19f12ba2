"""Writes a scene of planar polygons as OBJ + MTL and as GLB, and checks it. Deterministic: same calls, same bytes."""

import json
import math
import struct
from pathlib import Path


def sub(a, b):
    return [a[k] - b[k] for k in range(3)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def newell(polygon):
    """Area vector of a planar polygon: twice the area long, along the counter-clockwise normal."""
    total = [0.0, 0.0, 0.0]
    for k, p in enumerate(polygon):
        c = cross(p, polygon[(k + 1) % len(polygon)])
        total = [total[i] + c[i] for i in range(3)]
    return total


class SceneFile:
    """Polygons in objects, each of one material; materials are (Kd, Ke)."""

    def __init__(self, title, unit="m"):
        self.title = title
        self.unit = unit
        self.materials = {}
        self.faces = []  # (object, material, polygon)

    def material(self, name, kd, ke=(0, 0, 0)):
        self.materials[name] = (tuple(kd), tuple(ke))

    def face(self, obj, material, polygon):
        assert material in self.materials, material
        assert math.sqrt(dot(newell(polygon), newell(polygon))) > 0, (obj, polygon)
        self.faces.append((obj, material, [tuple(float(c) for c in p) for p in polygon]))

    def quad_towards(self, obj, material, polygon, point):
        """The polygon, turned so that its front looks to the side where `point` lies."""
        towards = dot(newell(polygon), sub(point, polygon[0]))
        assert towards != 0
        self.face(obj, material, polygon if towards > 0 else polygon[::-1])

    def box(self, obj, material, low, high, skip=()):
        """An axis-aligned box with outward fronts; `skip` names sides left out, as in ("-z",)."""
        (x0, y0, z0), (x1, y1, z1) = low, high
        sides = {
            "-x": [(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)],
            "+x": [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)],
            "-y": [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)],
            "+y": [(x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0)],
            "-z": [(x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0)],
            "+z": [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
        }
        for side, polygon in sides.items():
            if side not in skip:
                self.face(obj, material, polygon)

    def prism(self, obj, material, outline, z0, z1, bottom=False, top=True):
        """A standing prism over a counter-clockwise outline (x, y): sides and, if asked for, its ends; outward."""
        n = len(outline)
        for k in range(n):
            (ax, ay), (bx, by) = outline[k], outline[(k + 1) % n]
            self.face(obj, material, [(ax, ay, z0), (bx, by, z0), (bx, by, z1), (ax, ay, z1)])
        if top:
            self.face(obj, material, [(x, y, z1) for x, y in outline])
        if bottom:
            self.face(obj, material, [(x, y, z0) for x, y in reversed(outline)])

    def ring(self, obj, material, outer, inner):
        """The plane between two polygons of as many corners, in trapezoids; the front is that of `outer`."""
        n = len(outer)
        for k in range(n):
            self.face(obj, material, [outer[k], outer[(k + 1) % n], inner[(k + 1) % n], inner[k]])

    def sheet(self, obj, material, polygon):
        """A plate without thickness, fronts on both sides."""
        self.face(obj, material, polygon)
        self.face(obj, material, polygon[::-1])

    # -- checks ---------------------------------------------------------------------------------------------------

    def check_planar(self, tolerance=1e-9):
        size = max(abs(c) for _, _, p in self.faces for v in p for c in v)
        for obj, _, polygon in self.faces:
            n = newell(polygon)
            length = math.sqrt(dot(n, n))
            for p in polygon:
                assert abs(dot(n, sub(p, polygon[0]))) <= tolerance * size * length, (obj, polygon)

    def open_edges(self, objects=None):
        """Directed edges whose opposite isn't there: none in a closed, consistently wound set of polygons."""
        count = {}
        for obj, _, polygon in self.faces:
            if objects is not None and obj not in objects:
                continue
            for k, p in enumerate(polygon):
                q = polygon[(k + 1) % len(polygon)]
                count[(p, q)] = count.get((p, q), 0) + 1
        return [edge for edge, n in count.items() if count.get((edge[1], edge[0]), 0) != n]

    def volume(self, objects=None):
        """Signed volume that the fronts enclose: negative when they look inside, as in a room."""
        total = 0.0
        for obj, _, polygon in self.faces:
            if objects is None or obj in objects:
                for k in range(1, len(polygon) - 1):
                    total += dot(polygon[0], cross(polygon[k], polygon[k + 1])) / 6
        return total

    # -- files ----------------------------------------------------------------------------------------------------

    def write_obj(self, stem):
        folder = Path(__file__).parent
        index = {}
        lines = [f"# {self.title}", f"# unit: {self.unit}", f"mtllib {Path(stem).name}.mtl"]
        body = []
        last = (None, None)
        for obj, material, polygon in self.faces:
            if obj != last[0]:
                body.append(f"o {obj}")
            if (obj, material) != last:
                body.append(f"usemtl {material}")
            last = (obj, material)
            body.append("f " + " ".join(str(index.setdefault(p, len(index) + 1)) for p in polygon))
        lines += ["v " + " ".join(format(c, ".12g") for c in p) for p in index]
        (folder / f"{stem}.obj").write_text("\n".join(lines + body) + "\n", encoding="ascii", newline="\n")
        mtl = [f"# {self.title}"]
        for name, (kd, ke) in self.materials.items():
            mtl += [f"newmtl {name}", "Kd " + " ".join(format(c, ".6g") for c in kd)]
            mtl += ["Ke " + " ".join(format(c, ".6g") for c in ke), ""]
        (folder / f"{stem}.mtl").write_text("\n".join(mtl), encoding="ascii", newline="\n")

    def write_glb(self, stem, metres_per_unit, camera=None):
        """One node and mesh an object, triangles with their own vertices, positions in metres, camera as a node."""
        data = bytearray()
        views, accessors, meshes, nodes = [], [], [], []

        def accessor(raw, component, kind, count, **extra):
            while len(data) % 4:
                data.append(0)
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(raw)})
            data.extend(raw)
            accessors.append({"bufferView": len(views) - 1, "componentType": component, "type": kind,
                              "count": count, **extra})
            return len(accessors) - 1

        names = list(self.materials)
        for obj in dict.fromkeys(o for o, _, _ in self.faces):
            primitives = []
            for material in dict.fromkeys(m for o, m, _ in self.faces if o == obj):
                positions, indices = [], []
                for o, m, polygon in self.faces:
                    if (o, m) != (obj, material):
                        continue
                    first = len(positions)
                    positions += [[f32(c * metres_per_unit) for c in p] for p in polygon]
                    for k in range(1, len(polygon) - 1):
                        indices += [first, first + k, first + k + 1]
                raw = b"".join(struct.pack("<3f", *p) for p in positions)
                position = accessor(raw, 5126, "VEC3", len(positions),
                                    min=[min(p[k] for p in positions) for k in range(3)],
                                    max=[max(p[k] for p in positions) for k in range(3)])
                index = accessor(struct.pack(f"<{len(indices)}H", *indices), 5123, "SCALAR", len(indices))
                primitives.append({"attributes": {"POSITION": position}, "indices": index,
                                   "material": names.index(material)})
            meshes.append({"name": obj, "primitives": primitives})
            nodes.append({"name": obj, "mesh": len(meshes) - 1})
        materials, used = [], []
        for name in names:
            material, extensions = gltf_material(name, *self.materials[name])
            materials.append(material)
            used += [e for e in extensions if e not in used]
        document = {"asset": {"version": "2.0", "generator": "data/scenes/scene_file.py"}, "scene": 0}
        if used:
            document["extensionsUsed"] = used
        if camera:
            nodes.append(camera_node(camera, metres_per_unit))
            document["cameras"] = [{"name": camera["name"], "type": "perspective",
                                    "perspective": {"yfov": math.radians(camera["fov"]), "znear": 0.01}}]
        document.update({"scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": meshes,
                         "materials": materials, "accessors": accessors, "bufferViews": views,
                         "buffers": [{"byteLength": len(data)}]})
        write_glb_file(Path(__file__).parent / f"{stem}.glb", document, bytes(data))


def f32(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


def gltf_material(name, kd, ke):
    material = {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*kd, 1.0], "metallicFactor": 0.0}}
    strength = max(ke)
    if strength == 0:
        return material, []
    material["emissiveFactor"] = [c / strength for c in ke]
    material["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": float(strength)}}
    return material, ["KHR_materials_emissive_strength"]


def camera_node(camera, metres_per_unit):
    """glTF cameras look along -z with +y up."""
    unit = lambda a: [c / math.sqrt(dot(a, a)) for c in a]
    back = unit(sub(camera["from"], camera["to"]))
    right = unit(cross(camera["up"], back))
    up = cross(back, right)
    at = [c * metres_per_unit for c in camera["from"]]
    return {"name": camera["name"], "camera": 0, "matrix": [*right, 0, *up, 0, *back, 0, *at, 1]}


def write_glb_file(path, document, data):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    with open(path, "wb") as out:
        out.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(data)))
        out.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        out.write(struct.pack("<II", len(data), 0x004E4942) + data)


def write_view(stem, name, where, to, up, fov):
    view = {"name": name, "from": list(where), "to": list(to), "up": list(up), "fov": fov}
    path = Path(__file__).parent / f"{stem}.view.json"
    path.write_text(json.dumps(view) + "\n", encoding="ascii", newline="\n")
    return view
