#!/usr/bin/env python3
"""Prints the README's table of error against the budget of elements, doubled from 1,000 to 64,000.

    python3 tests/verification/budget_sweep.py [build/patchlight] [--scene NAME ...] [--budgets N ...]

Against the path-traced points of data/reference, whose own variance is subtracted from both errors. All other options are
the defaults; `solve` chooses its rays by the error that the budget's mesh leaves. Beyond 10 %: points where √Σ(B̃−B)² over the bands is above a tenth of √ΣB², of those as bright as a thousandth
of the mean.
"""

import argparse
import json
import math
import tempfile
from pathlib import Path

import measure

SCENES = {"cornell-box": ["--unit", "mm"], "furniture-room": []}
BUDGETS = [1000 * 2**k for k in range(7)]


def share_beyond(answers, known, fraction):
    mean = sum(map(sum, known)) / (3 * len(known))
    beyond = counted = 0
    for found, true in zip(answers, known):
        if sum(true) < 3e-3 * mean:
            continue
        counted += 1
        beyond += math.dist([float(x) for x in found], true) > fraction * math.hypot(*true)
    return beyond / counted


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("command", nargs="?", default=str(measure.ROOT / "build" / "patchlight"))
    parser.add_argument("--scene", nargs="+", choices=list(SCENES), default=list(SCENES))
    parser.add_argument("--budgets", nargs="+", type=int, default=BUDGETS)
    parser.add_argument("--refine", default="both")
    arguments = parser.parse_args()
    print("| scene | budget | elements | rays | relative L2 | of the last | relative RMS | beyond 10 % | seconds |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        for scene in arguments.scene:
            rows, known = measure.reference(scene)
            noise = [[float(row[band]) for band in ("se_r", "se_g", "se_b")] for row in rows]
            before = None
            for budget in arguments.budgets:
                run = Path(folder) / f"{scene}-{budget}"
                seconds = measure.solve(arguments.command, scene, run, *SCENES[scene], "--refine", arguments.refine,
                                        "--max-elements", budget)
                answers = measure.probe(arguments.command, run, rows, folder)
                l2, rms = measure.errors(answers, known, noise)
                record = json.loads((run / "run.json").read_text(encoding="utf-8"))
                elements, rays = record["result"]["elements"], sum(cycle["rays"] for cycle in record["cycles"])
                ratio = f"{l2 / before:.2f}" if before else "–"
                print(f"| {scene} | {budget:,} | {elements:,} | {rays / 1e6:.1f} M | {100 * l2:.2f} % | {ratio} |"
                      f" {100 * rms:.2f} % | {100 * share_beyond(answers, known, 0.1):.2f} % | {seconds:.1f} |", flush=True)
                before = l2


if __name__ == "__main__":
    main()
