#!/usr/bin/env python3
"""Prints the README's measured table: the error of stored runs against the path-traced points of data/reference.

    python3 tests/verification/measure.py [build/patchlight] [--folder DIR]

Solves, probes the reference's points, compares. Relative L2 as `error` means it, √(Σ|B̃−B|²/Σ|B|²), and relative
RMS over points and bands, √mean((B̃/B−1)²), where B is above a thousandth of its mean (a covered floor has B = 0, and no surface that answers).
"""

import argparse
import csv
import json
import math
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CASES = [
    ("cornell-box", ["--unit", "mm"], "none", 2000),
    ("cornell-box", ["--unit", "mm"], "none", 8000),
    ("cornell-box", ["--unit", "mm"], "none", 20000),
    ("cornell-box", ["--unit", "mm"], "both", 2000),
    ("cornell-box", ["--unit", "mm"], "both", 8000),
    ("cornell-box", ["--unit", "mm"], "both", 20000),
    ("furniture-room", [], "none", 20000),
    ("furniture-room", [], "both", 20000),
]


def reference(scene):
    with open(ROOT / "data" / "reference" / f"{scene}-points.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return rows, [[float(row[band]) for band in ("Br", "Bg", "Bb")] for row in rows]


def probe(command, run, rows, folder):
    points = Path(folder) / "points.csv"
    with open(points, "w", encoding="utf-8") as file:
        file.write("x,y,z,nx,ny,nz\n")
        for row in rows:
            file.write(",".join(row[k] for k in ("x", "y", "z", "nx", "ny", "nz")) + "\n")
    out = subprocess.run([command, "probe", run, "--points", points], check=True, stdout=subprocess.PIPE, text=True).stdout
    return [[row[band] for band in ("Br", "Bg", "Bb")] for row in csv.DictReader(out.splitlines())]


def solve(command, scene, run, *options):
    """Solves a scene of data/scenes into the folder `run`; seconds of the whole command."""
    begin = time.monotonic()
    subprocess.run([command, "solve", ROOT / "data" / "scenes" / f"{scene}.obj", "-o", run, "--pictures", "none",
                    "--quiet", *map(str, options)], check=True, stdout=subprocess.DEVNULL)
    return time.monotonic() - begin


def errors(answers, known, noise=None):
    """Relative L2 and relative RMS error; `noise` are the standard errors of `known`, whose part is subtracted."""
    # Where the floor is covered there is no surface to answer.
    found = [[0.0] * 3 if not any(b) and not any(r) else [float(x) for x in b] for b, r in zip(answers, known)]
    squares = norm = relative = counted = 0
    mean = sum(map(sum, known)) / (3 * len(known))
    for b, r, s in zip(found, known, noise or [[0.0] * 3] * len(known)):
        for x, y, z in zip(b, r, s):
            squares += (x - y) ** 2 - z**2
            norm += y**2
            if y >= 1e-3 * mean:
                relative += ((x - y) ** 2 - z**2) / y**2
                counted += 1
    return math.sqrt(max(0.0, squares / norm)), math.sqrt(max(0.0, relative / counted))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("command", nargs="?", default=str(ROOT / "build" / "patchlight"))
    parser.add_argument("--folder", help="where the runs are kept [a temporary folder]")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.folder or temporary
        print("| scene | mesh | elements | relative L2 | relative RMS | estimated | seconds |")
        print("|---|---|---:|---:|---:|---:|---:|")
        for scene, unit, refine, elements in CASES:
            run = Path(folder) / f"{scene}-{refine}-{elements}"
            seconds = solve(arguments.command, scene, run, *unit, "--refine", refine, "--max-elements", elements)
            result = json.loads((run / "run.json").read_text(encoding="utf-8"))["result"]
            rows, known = reference(scene)
            l2, rms = errors(probe(arguments.command, run, rows, folder), known)
            mesh = "uniform" if refine == "none" else "adapted"
            print(f"| {scene} | {mesh} | {result['elements']:,} | {100 * l2:.2f} % | {100 * rms:.1f} % |"
                  f" {100 * result['estimated_error']:.1f} % | {seconds:.1f} |", flush=True)


if __name__ == "__main__":
    main()
