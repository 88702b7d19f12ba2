#!/usr/bin/env python3
"""Prints the README's table of exact or sampled visibility on meshes with or without shadow lines [DrettakisSillion96].

    python3 tests/verification/shadow_study.py [build/patchlight] [--case NAME ...] [--budgets N ...] [--grid SIDE]

For each case, budget and combination: solves the scene, probes it at SIDE x SIDE points over the receiver, one at random
in each cell of a grid, and compares with the exact light there: the part of the light that the blocker hides is cut out,
and Lambert's formula is applied to what remains. The error is the relative L2 one; triangles are the receiver's.
"""

import argparse
import csv
import math
import random
import subprocess
import tempfile
from pathlib import Path

import measure

# Light (facing down) and blocker, counter-clockwise from above or from one side: data/scenes/receivers.py.
CASES = {
    "narrow-penumbra": ([(0.45, 0.45, 1), (0.45, 0.55, 1), (0.55, 0.55, 1), (0.55, 0.45, 1)],
                        [(0.31, 0.36, 0.15), (0.67, 0.36, 0.15), (0.67, 0.71, 0.15), (0.31, 0.71, 0.15)]),
    "wide-penumbra": ([(0.2, 0.3, 1), (0.2, 0.7, 1), (0.6, 0.7, 1), (0.6, 0.3, 1)],
                      [(0.35, 0.4, 0.5), (0.65, 0.4, 0.5), (0.65, 0.7, 0.5), (0.35, 0.7, 0.5)]),
    "wall-on-floor": ([(0.1, 0.3, 1), (0.1, 0.6, 1), (0.4, 0.6, 1), (0.4, 0.3, 1)],
                      [(0.52, 0.25, 0), (0.52, 0.75, 0), (0.52, 0.75, 0.3), (0.52, 0.25, 0.3)]),
}
RADIOSITY = 0.5 * math.pi * 10  # reflectance × exitance
MESHES = {"adaptive": "intensity", "adaptive with lines": "both"}


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def clip(loop, normal):
    """The part of a convex loop where normal · x ≥ 0."""
    kept = []
    heights = [dot(normal, a) for a in loop]
    for k, a in enumerate(loop):
        b, ha, hb = loop[k - 1], heights[k], heights[k - 1]
        if ha * hb < 0:
            kept.append(tuple(x + ha / (ha - hb) * (y - x) for x, y in zip(a, b)))
        if ha >= 0:
            kept.append(a)
    return kept


def upward(loop):
    """Lambert: the form factor from a small upward patch at the origin to a loop above it."""
    total = 0
    for k, a in enumerate(loop):
        c = cross(loop[k - 1], a)
        length = math.sqrt(dot(c, c))
        if length > 0:
            total += math.atan2(length, dot(loop[k - 1], a)) * c[2] / length
    return abs(total) / (2 * math.pi)


def exact(x, y, light, blocker):
    """B of the receiver at (x, y, 0). The light isn't cut by the blocker's plane in any of the cases."""
    light, blocker = ([(p[0] - x, p[1] - y, p[2]) for p in loop] for loop in (light, blocker))
    normal = cross([b - a for a, b in zip(blocker[0], blocker[1])], [b - a for a, b in zip(blocker[0], blocker[2])])
    height = dot(normal, blocker[0])  # of the blocker's plane above the point; the light must be beyond it
    hidden = light if height * (dot(normal, light[0]) - height) > 0 else []
    for k, b in enumerate(blocker):
        side = cross(blocker[k - 1], b)
        hidden = clip(hidden, side if height > 0 else [-s for s in side])
    return RADIOSITY * (upward(light) - upward(hidden))


def points_and_light(case, side):
    draw = random.Random(1)
    places = [((i + draw.random()) / side, (j + draw.random()) / side) for i in range(side) for j in range(side)]
    rows = [{"x": repr(x), "y": repr(y), "z": "0", "nx": "0", "ny": "0", "nz": "1"} for x, y in places]
    return rows, [[exact(x, y, *CASES[case])] * 3 for x, y in places]


def triangles(command, run, folder):
    table = Path(folder) / "patches.csv"
    subprocess.run([command, "export", run, "--format", "csv", "-o", table], check=True, stdout=subprocess.DEVNULL)
    with open(table, encoding="utf-8") as file:
        return sum(row["material"] == "receiver" for row in csv.DictReader(file))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("command", nargs="?", default=str(measure.ROOT / "build" / "patchlight"))
    parser.add_argument("--case", nargs="+", choices=list(CASES), default=list(CASES))
    parser.add_argument("--budgets", nargs="+", type=int, default=[256, 1024, 4096])
    parser.add_argument("--grid", type=int, default=200, help="points along an edge [200]")
    arguments = parser.parse_args()
    print("| case | mesh | visibility |" + "".join(f" {n:,}: triangles | error |" for n in arguments.budgets))
    print("|---|---|---|" + "---:|---:|" * len(arguments.budgets))
    with tempfile.TemporaryDirectory() as folder:
        for case in arguments.case:
            rows, known = points_and_light(case, arguments.grid)
            for mesh, refine in MESHES.items():
                for direct in ("sampled", "exact"):
                    line = f"| {case} | {mesh} | {direct} |"
                    for budget in arguments.budgets:
                        run = Path(folder) / f"{case}-{refine}-{direct}-{budget}"
                        measure.solve(arguments.command, case, run, "--refine", refine, "--direct", direct,
                                      "--max-elements", budget, "--iterations", 60, "--local", 0)
                        error = measure.errors(measure.probe(arguments.command, run, rows, folder), known)[0]
                        line += f" {triangles(arguments.command, run, folder):,} | {error:.2e} |"
                    print(line, flush=True)


if __name__ == "__main__":
    main()
