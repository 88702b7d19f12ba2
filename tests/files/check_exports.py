"""Solves every scene of data/scenes coarsely, exports it to every format, and holds what independent readers find in the
files to what solution.glb stores. ./dev installs the readers; without one it fails.

    python3 tests/files/check_exports.py REPOSITORY BUILD
"""

import importlib.util
import json
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from readers import Glb, Grid, Picture, read_csv, read_ply, triples

# The largest difference that single precision makes is 6e-8 of a value.
TOLERANCE = 1e-6


def missing_readers(here):
    """What can't be checked without."""
    missing = [f"python3's {module} ({package})" for module, package in
               (("vtkmodules", "python3-vtk9"), ("OpenImageIO", "python3-openimageio"))
               if importlib.util.find_spec(module) is None]
    if not shutil.which("node"):
        missing.append("node (nodejs)")
    if not (here / "node_modules" / "gltf-validator").is_dir():
        missing.append("gltf-validator (npm ci in tests/files)")
    return missing


def near(a, b, scale, tolerance=TOLERANCE):
    """Equal to a part of the value, or of a thousandth of the brightest where it is darker."""
    return len(a) == len(b) and all(abs(x - y) <= tolerance * max(abs(y), 1e-3 * scale) for x, y in zip(a, b))


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def unit(a):
    return [x / length(a) for x in a]


class Run:
    """One scene, solved, and its solution as solution.glb stores it for reading back."""

    def __init__(self, command, scene, folder, elements):
        self.command, self.scene, self.folder = command, scene, folder
        self.in_mm = scene.name.startswith("cornell-box") and scene.suffix == ".obj"
        # The smaller ones with meshes that are cut open along contact lines, and with several cycles.
        refine = ["both", "--iterations", 6] if scene.stat().st_size < 30_000 else ["none", "--direct", "sampled"]
        self.call("solve", scene, "-o", folder / "run", "--unit", "mm" if self.in_mm else "m", "--refine", *refine,
                  "--max-elements", 1000, "--rays", 16, "--vertex-rays", 16, "--shadow-rays", 16, "--pictures", "none",
                  "--quiet", "--elements", elements)
        self.record = json.loads((folder / "run" / "run.json").read_text(encoding="utf-8"))
        self.glb = Glb(folder / "run" / "solution.glb")
        self.vertex_B = triples(self.glb.stored("vertex_radiosity", "d"))
        self.patch_B = triples(self.glb.stored("patch_radiosity", "d"))
        self.patches = triples(self.glb.stored("patches", "I"))
        self.surface = list(self.glb.stored("patch_surface", "I"))
        self.error = list(self.glb.stored("eta", "d"))
        middles = self.glb.stored("midpoint_radiosity", "d")
        self.middle_B = None if middles is None else triples(middles)
        self.metres = 1e-3 if self.in_mm else 1
        center = self.glb.json["nodes"][0]["translation"]
        self.points = [tuple((x + c) / self.metres for x, c in zip(p, center))
                       for p in triples(self.glb.stored("positions", "d"))]
        self.brightest = max(max(B) for B in self.vertex_B)

    def call(self, *words):
        subprocess.run([self.command, *map(str, words)], check=True, stdout=subprocess.DEVNULL)

    def export(self, kind, *more, suffix=None):
        file = self.folder / f"out.{suffix or kind}"
        self.call("export", self.folder / "run", "--format", kind, "-o", file, *more)
        return file

    def probe(self, points):
        """B at (position, normal)s of the surfaces."""
        rows = "".join(",".join(map(repr, [*p, *n])) + "\n" for p, n in points)
        (self.folder / "points.csv").write_text(rows, encoding="utf-8")
        self.call("probe", self.folder / "run", "--points", self.folder / "points.csv", "-o", self.folder / "B.csv")
        return [[float(row[band]) for band in ("Br", "Bg", "Bb")] for row in read_csv(self.folder / "B.csv")]


def check_glb(run):
    file = run.export("glb")
    glb = Glb(file)
    assert file.read_bytes() == (run.folder / "run" / "solution.glb").read_bytes()
    for B, stored in zip(triples(glb.attribute("_RADIOSITY")), run.vertex_B, strict=True):
        assert near(B, stored, run.brightest)
    scale = glb.json["extras"]["patchlight"]["color_scale"] / math.pi
    for color, B in zip(triples(glb.attribute("COLOR_0")), run.vertex_B, strict=True):
        assert all(abs(c - min(1, scale * b)) <= TOLERANCE for c, b in zip(color, B))
    assert len(glb.triangles()) == len(run.patches)
    assert [m["name"] for m in glb.json["materials"]] and all(m["name"] for m in glb.json["materials"])
    check_camera(run, glb)
    return [file]


def check_camera(run, glb):
    """The camera of NAME.view.json: its place, and its node's −z and y."""
    view_file = run.scene.with_suffix(".view.json")
    if run.scene.suffix != ".obj" or not view_file.exists():
        return
    view = json.loads(view_file.read_text(encoding="utf-8"))
    node = next(n for n in glb.json["nodes"] if n.get("camera") == 0)
    camera = glb.json["cameras"][0]
    assert camera["name"] == view["name"] and camera["type"] == "perspective"
    assert math.isclose(camera["perspective"]["yfov"], math.radians(view["fov"]), rel_tol=1e-12)
    assert length(minus(node["translation"], [x * run.metres for x in view["from"]])) < 1e-9
    x, y, z, w = node["rotation"]
    back = (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))
    up = (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x))
    assert length([a + b for a, b in zip(back, unit(minus(view["to"], view["from"])))]) < 1e-9
    assert abs(dot(up, back)) < 1e-9 and dot(up, view["up"]) > 0


def check_vtu(run, file):
    grid = Grid(file)
    nodes = 6 if run.middle_B else 3
    assert set(grid.types) == {22 if run.middle_B else 5} and len(grid.types) == len(run.patches)
    assert all(len(cell) == nodes and 0 <= min(cell) and max(cell) < len(grid.points) for cell in grid.cells)
    assert {i for cell in grid.cells for i in cell} == set(range(len(grid.points))), "every point is used"
    assert [tuple(cell[:3]) for cell in grid.cells] == run.patches
    B = grid.of_points("radiosity")
    size = max(map(length, run.points))
    for i, stored in enumerate(run.vertex_B):
        assert near(B[i], stored, run.brightest) and length(minus(grid.points[i], run.points[i])) <= 1e-12 * size
    for cell, patch in zip(grid.cells, range(len(run.patches))):
        for k in range(3, nodes):
            a, b = grid.points[cell[k - 3]], grid.points[cell[(k - 2) % 3]]
            assert near(B[cell[k]], run.middle_B[3 * patch + k - 3], run.brightest)
            assert length(minus(grid.points[cell[k]], [(x + y) / 2 for x, y in zip(a, b)])) <= 1e-12 * size
    assert all(near(a, b, run.brightest) for a, b in zip(grid.of_cells("radiosity"), run.patch_B, strict=True))
    assert grid.of_cells("error") == run.error and grid.of_cells("surface") == run.surface
    assert min(grid.of_cells("level")) >= 0 and min(grid.of_cells("material")) >= 0
    area = grid.of_cells("area")
    for cell, stored in zip(grid.cells, area):
        a, b, c = (grid.points[i] for i in cell[:3])
        found = 0.5 * length(cross(minus(b, a), minus(c, a))) * run.metres ** 2
        assert math.isclose(found, stored, rel_tol=1e-6), "thin triangles lose digits to the centre's coordinates"
    assert math.isclose(sum(area), run.record["scene"]["area"], rel_tol=1e-9)


def check_pvd(run, vtu):
    series = run.export("pvd")
    entries = ElementTree.parse(series).getroot().findall("./Collection/DataSet")
    assert [int(e.get("timestep")) for e in entries] == [c["cycle"] for c in run.record["cycles"]]
    files = [series.parent / e.get("file") for e in entries]
    assert files[-1].read_bytes() == vtu.read_bytes()
    for file, cycle in zip(files, run.record["cycles"]):
        assert len(Grid(file).cells) == cycle["elements"]


def check_ply(run):
    from vtkmodules.vtkIOPLY import vtkPLYReader
    file = run.export("ply")
    vertices, faces = read_ply(file)
    per_patch = 4 if run.middle_B else 1
    assert len(faces) == per_patch * len(run.patches)
    for row, point, B in zip(vertices, run.points, run.vertex_B):
        assert near(row[6:], B, run.brightest) and row[:3] == point
    if run.middle_B:
        for patch, corners in enumerate(run.patches):
            middles = faces[4 * patch + 3][1:4]
            assert [faces[4 * patch + k][1 + k] for k in range(3)] == list(corners)
            assert all(near(vertices[m][6:], run.middle_B[3 * patch + k], run.brightest)
                       for k, m in enumerate(middles))
    else:
        assert len(vertices) == len(run.points) and [face[1:4] for face in faces] == run.patches
    reader = vtkPLYReader()
    reader.SetFileName(str(file))
    reader.Update()
    assert reader.GetOutput().GetNumberOfPoints() == len(vertices)
    assert reader.GetOutput().GetNumberOfPolys() == len(faces)
    assert reader.GetOutput().GetPointData().GetArray("RGB") is not None


def check_csv(run):
    rows = read_csv(run.export("csv"))
    for row, B, surface, error in zip(rows, run.patch_B, run.surface, run.error, strict=True):
        assert near([float(row[k]) for k in ("Br", "Bg", "Bb")], B, run.brightest)
        assert int(row["surface"]) == surface and float(row["eta"]) == error
    assert math.isclose(sum(float(r["area"]) for r in rows), run.record["scene"]["area"], rel_tol=1e-9)


def first_hit(start, direction, corners):
    """The nearest triangle's point, its normal, and how far inside; None beside all."""
    best = None
    for a, b, c in corners:
        e1, e2 = minus(b, a), minus(c, a)
        p = cross(direction, e2)
        det = dot(e1, p)
        if det == 0:
            continue
        s = minus(start, a)
        q = cross(s, e1)
        u, v, t = dot(s, p) / det, dot(direction, q) / det, dot(e2, q) / det
        if min(u, v, 1 - u - v) >= 0 and t > 0 and (best is None or t < best[0]):
            best = (t, [x + t * d for x, d in zip(start, direction)], cross(e1, e2), min(u, v, 1 - u - v), det > 0)
    return best


def check_exr(run, corners):
    """A picture can be laid over the scene by its metadata alone; π times a pixel is B at the point it shows."""
    run.call("render", run.folder / "run", "-o", run.folder / "view.exr", "--size", "30x24")
    picture = Picture(run.folder / "view.exr")
    about = {key.removeprefix("patchlight:"): value for key, value in picture.metadata.items()}
    assert about["quantity"] == "radiance B/pi" and about["unit"].startswith("W/(m2 sr)")
    assert json.loads(about["options"])["run"] == run.record["options"]
    assert float(about["metres_per_unit"]) == run.metres and "DateTime" not in about
    if len(corners) > 100:
        return 0
    start, forward, up = ([float(x) for x in about[f"camera_{key}"].split()] for key in ("from", "forward", "up"))
    right = unit(cross(forward, up))
    up = cross(right, forward)
    half = math.tan(math.radians(float(about["camera_vertical_fov"])) / 2)
    seen, pixels = [], []
    for y in range(picture.height):
        for x in range(picture.width):
            across, above = (2 * x + 1 - picture.width) / picture.height, (picture.height - 2 * y - 1) / picture.height
            direction = [f + half * (across * r + above * u) for f, r, u in zip(forward, right, up)]
            hit = first_hit(start, direction, corners)
            # Rays along edges may be another surface's; backs are black.
            if hit and hit[4] and hit[3] > 1e-4:
                seen.append((hit[1], hit[2]))
                pixels.append(picture.at(x, y))
    assert len(seen) > 50
    others = 0
    for pixel, B in zip(pixels, run.probe(seen), strict=True):
        found = [math.pi * p for p in pixel]
        # On a patch's edge a last bit of the point decides which of two patches answers: a few differ by more than
        # single precision, by what light changes over 1e-6 of a patch.
        others += not near(found, B, run.brightest)
        assert near(found, B, run.brightest, 10 * TOLERANCE), (found, B)
    assert others <= 0.01 * len(seen), f"{others} of {len(seen)}"
    return len(seen)


def check_lightmap(run):
    file = run.export("lightmap", "--size", 512, suffix="exr")
    glb = Glb(file.with_suffix(".glb"))
    assert glb.json["extras"]["lightmap"] == file.name
    picture = Picture(file)
    assert picture.metadata["patchlight:unit"].startswith("W/m2")
    center = glb.json["nodes"][0]["translation"]
    points = [[(x + c) / run.metres for x, c in zip(p, center)] for p in triples(glb.attribute("POSITION"))]
    flat = glb.attribute("TEXCOORD_0")
    texture = list(zip(flat[0::2], flat[1::2]))
    assert 0 <= min(flat) and max(flat) <= 1
    triangles = glb.triangles()
    corners = [[points[i] for i in t] for t in triangles]
    normals = [cross(minus(b, a), minus(c, a)) for a, b, c in corners]
    areas = [length(n) / 2 * run.metres ** 2 for n in normals]
    # Positions are in single precision.
    assert math.isclose(sum(areas), run.record["scene"]["area"], rel_tol=1e-5)
    draw = random.Random(1)
    places, found = [], []
    for t in draw.choices(range(len(triangles)), areas, k=400):
        u, v = sorted((draw.random(), draw.random()))
        w = (u, v - u, 1 - v)
        places.append(([dot(w, x) for x in zip(*corners[t])], normals[t]))
        found.append(picture.looked_up(*(dot(w, x) for x in zip(*(texture[i] for i in triangles[t])))))
    differences, sum_B = 0, 0
    for B, exact in zip(found, run.probe(places), strict=True):
        differences += sum(abs(x - y) for x, y in zip(B, exact))
        sum_B += sum(exact)
    # Where light breaks off within a texel it is smoothed; tests/imaging/lightmap_test.cpp bounds that point by point.
    assert differences <= 0.02 * sum_B, f"{differences / sum_B:.4f}"
    return [file.with_suffix(".glb")], corners, differences / sum_B


def check(command, scene, folder, elements):
    start = time.monotonic()
    run = Run(command, scene, folder, elements)
    files = check_glb(run)
    vtu = run.export("vtu")
    check_vtu(run, vtu)
    check_pvd(run, vtu)
    check_ply(run)
    check_csv(run)
    more, corners, smoothed = check_lightmap(run)
    pixels = check_exr(run, corners)
    print(f"{scene.name}: {len(run.patches)} {elements} elements, lightmap within {100 * smoothed:.2f} % of B, "
          f"{pixels} pixels, {time.monotonic() - start:.1f} s", flush=True)
    return files + more


def main():
    repository, build = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    here = repository / "tests" / "files"
    missing = missing_readers(here)
    if missing:
        sys.exit("./dev installs what is missing: " + ", ".join(missing))
    scenes = sorted(f for f in (repository / "data" / "scenes").iterdir() if f.suffix in (".obj", ".glb"))
    assert len(scenes) > 5
    with tempfile.TemporaryDirectory(prefix="patchlight-files-") as folder:
        files = []
        for i, scene in enumerate(scenes):
            (Path(folder) / scene.name).mkdir()
            elements = "linear" if i % 2 else "quadratic"
            files += check(build / "patchlight", scene, Path(folder) / scene.name, elements)
        subprocess.run(["node", here / "validate_glb.js", *files], check=True)
        print(f"{len(files)} GLB files without an error or a warning of the Khronos validator")


if __name__ == "__main__":
    os.environ["LC_ALL"] = "C.UTF-8"
    main()
