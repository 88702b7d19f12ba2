"""Light doesn't leak: twenty layouts of sealed rooms, a lamp in one of them. In the others the light must be 0, to the
bit, by every kind of form factors and by links.

    python3 tests/reliability/sealed_rooms.py [-k WORD]

PATCHLIGHT_SOURCE and PATCHLIGHT_COMMAND name the sources and the command.
"""

import argparse
import csv
import math
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import disturbed

MATERIALS = """newmtl white
Kd .8 .8 .8
newmtl both
Kd .8 .8 .8
newmtl lamp
Kd .2 .2 .2
Ke 10 9 8
"""
METHODS = {
    "default": [],
    "sampled": ["--direct", "sampled"],
    "uniform": ["--refine", "none"],
    "hemicube": ["--refine", "none", "--form-factors", "hemicube", "--resolution", "64"],
    "quadrature": ["--refine", "none", "--form-factors", "quadrature"],
    "exact": ["--refine", "none", "--form-factors", "exact"],
    "links": ["--refine", "none", "--solver", "hierarchical"],
}
DEAR = ("quadrature", "exact")  # with fewer elements


def box(low, high, outward=False):
    """Six quads that face in, unless told."""
    (a, b, c), (d, e, f) = low, high
    quads = [[(a, b, c), (a, b, f), (d, b, f), (d, b, c)], [(a, e, c), (d, e, c), (d, e, f), (a, e, f)],
             [(a, b, c), (a, e, c), (a, e, f), (a, b, f)], [(d, b, c), (d, b, f), (d, e, f), (d, e, c)],
             [(a, b, c), (d, b, c), (d, e, c), (a, e, c)], [(a, b, f), (a, e, f), (d, e, f), (d, b, f)]]
    return [quad[::-1] if outward else quad for quad in quads]


def prism(outline, low, high):
    """An upright room over an outline that goes counter-clockwise, seen from above (z up); faces in."""
    floor, ceiling = [(x, y, low) for x, y in outline], [(x, y, high) for x, y in reversed(outline)]
    walls = [[(*q, low), (*p, low), (*p, high), (*q, high)] for p, q in zip(outline, outline[1:] + outline[:1])]
    return [floor, ceiling] + walls


def lamp(x, y, z, size=.1):
    return [(x - size, y - size, z), (x - size, y + size, z), (x + size, y + size, z), (x + size, y - size, z)]


def turned(point):
    """About all three axes, by angles that no binary fraction knows."""
    x, y, z = point
    for angle in (.7, 1.1, -.4):
        x, y, z = y, math.cos(angle) * z - math.sin(angle) * x, math.sin(angle) * z + math.cos(angle) * x
    return x, y, z


def layouts():
    """Name, rooms, two-sided walls, lamp. The first room is lit."""
    one, lit = box((0, 0, 0), (1, 1, 1)), lamp(.5, .5, .8)
    beside = box((1, 0, 0), (2, 1, 1))
    outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    quarter = [box((x, y, 0), (x + 1, y + 1, 1)) for x in (0, 1) for y in (0, 1)]
    gap = lambda d: [one, box((1 + d, 0, 0), (2, 1, 1)), box((0, 1 + d, 0), (1, 2, 1))]
    chamber = box((.3, .3, .3), (.6, .6, .6))
    plans = [
        ("a wall of no thickness", [one, beside], [], lit),
        ("a wall that is one two-sided polygon", [one[:3] + one[4:], beside[:2] + beside[3:]], [one[3]], lit),
        ("walls 1e-3 thick", gap(1e-3), [], lit),
        ("walls 1e-6 thick", gap(1e-6), [], lit),
        ("rooms that meet in a point", [one, box((1, 1, 1), (2, 2, 2))], [], lit),
        ("rooms that meet in an edge", [one, box((1, 1, 0), (2, 2, 1))], [], lit),
        ("an L round a room", [prism(outline, 0, 1), box((1, 1, 0), (2, 2, 1))], [], lit),
        ("four rooms round an edge", quarter, [], lit),
        ("a chamber in a room", [one + box((.3, .3, .3), (.6, .6, .6), outward=True), chamber], [], lit),
        ("small rooms along a wall, lamp in one", [box((1, .2, .1), (1.5, .7, .6)), box((0, 0, 0), (1, 1, 1)),
                                                   box((1, .7, .1), (1.5, .9, .6))], [], lamp(1.25, .45, .5)),
    ]
    return [(f"{name}, {'turned' if turn else 'straight'}", rooms, both, light, turned if turn else lambda p: p)
            for name, rooms, both, light in plans for turn in (False, True)]


def write_scene(file, rooms, both, light, place):
    lines, count = ["mtllib rooms.mtl"], 0
    for material, quads in (("white", [quad for room in rooms for quad in room]), ("both", both), ("lamp", [light])):
        for quad in quads:
            lines += ["v {!r} {!r} {!r}".format(*place(corner)) for corner in quad]
            count += len(quad)
            lines += [f"usemtl {material}",
                      "f " + " ".join(str(count - len(quad) + k + 1) for k in range(len(quad)))]
    file.write_text("\n".join(lines) + "\n")
    (file.parent / "rooms.mtl").write_text(MATERIALS)


def points_on(quads, place, numbers):
    """Places on faces, many close to their borders, and the faces' normals. An L's outline is sampled on its first
    corner's parallelogram, which lies in it."""
    for quad in quads:
        a, b, d = (place(quad[k]) for k in (0, 1, -1))
        u, v = ([q - p for p, q in zip(a, c)] for c in (b, d))
        if len(quad) > 4:
            u, v = ([.49 * x for x in w] for w in (u, v))
        normal = [u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3] for k in range(3)]
        for _ in range(12):
            s, t = (numbers.choice((numbers.random(), 1e-4, 1 - 1e-4)) for _ in "st")
            yield [p + s * x + t * y for p, x, y in zip(a, u, v)] + normal


def problem_of(command, scene, folder, points, lit_count, method):
    run = folder / method
    elements = "150" if method in DEAR else "400"
    ended = subprocess.run([command, "solve", scene, "-o", run, "--pictures", "none", "--quiet", "--max-elements",
                            elements, "--vertex-rays", "64", "--rays", "128", "--two-sided", "both", *METHODS[method]],
                           capture_output=True, text=True)
    if ended.returncode != 0:
        return f"exit code {ended.returncode}: {ended.stderr[-300:]}"
    probed = subprocess.run([command, "probe", run, "--points", points], capture_output=True, text=True)
    rows = list(csv.DictReader(probed.stdout.splitlines()))
    if any(row["Br"] == "" for row in rows):
        return "some points are on no surface"
    lit, dark = rows[:lit_count], rows[lit_count:]
    leaks = [row for row in dark if any(float(row[band]) != 0 for band in ("Br", "Bg", "Bb"))]
    if leaks:
        return f"light at {len(leaks)} of {len(dark)} points in the dark: {leaks[0]}"
    if not sum(float(row["Br"]) > 0 for row in lit) > 0.9 * len(lit):
        return "the lit room is dark"
    return None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("-k", default="", help="only layouts whose name has this in it")
    options = parser.parse_args()
    command, bad, began = disturbed.COMMAND, 0, time.monotonic()
    chosen = [layout for layout in layouts() if options.k in layout[0]]
    with tempfile.TemporaryDirectory(prefix="patchlight-rooms-") as scratch:
        for number, (name, rooms, both, light, place) in enumerate(chosen):
            folder = Path(scratch) / str(number)
            folder.mkdir()
            write_scene(folder / "rooms.obj", rooms, both, light, place)
            numbers = random.Random(3)
            lit = list(points_on(rooms[0][:6], place, numbers))
            dark = [row for room in rooms[1:] for row in points_on(room, place, numbers)]
            # The dark side of a wall that two rooms share.
            dark += [row for quad in both for row in points_on([quad[::-1]], place, numbers)]
            points = folder / "points.csv"
            points.write_text("x,y,z,nx,ny,nz\n" + "".join(",".join(map(repr, row)) + "\n" for row in lit + dark))
            problems = {method: problem_of(command, folder / "rooms.obj", folder, points, len(lit), method)
                        for method in METHODS}
            found = {method: problem for method, problem in problems.items() if problem}
            print(f"{'BAD' if found else 'ok '} {name}: {len(dark)} points in the dark, {len(METHODS)} methods",
                  flush=True)
            for method, problem in found.items():
                bad += 1
                print(f"    {method}: {problem}", flush=True)
    print(f"{len(chosen)} layouts, {time.monotonic() - began:.0f} s")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
