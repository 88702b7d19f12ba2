#!/usr/bin/env python3
"""Prints the README's table of estimated beside true error, cycle by cycle.

    python3 tests/verification/effectivity.py [build/patchlight] [--scene NAME ...] [--points N] [--paths N] [--solve ...]

Solves each scene with --pictures none and lets `verify --cycle N` measure every cycle that the run keeps. Effectivity is
estimated over measured error, with its 95 % range. The last columns: share of points whose error is at most twice the
estimate, their patch's own and the mean one; in brackets the points that are too near to it for the paths' noise.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import measure

SCENES = {"cornell-box": ["--unit", "mm"], "furniture-room": [], "gallery": [],
          "narrow-penumbra": [], "wide-penumbra": [], "wall-on-floor": []}


def verified(command, run, cycle, arguments):
    out = subprocess.run([command, "verify", run, "--cycle", str(cycle), "--points", str(arguments.points), "--paths",
                          str(arguments.paths), "--quiet", "--json"], check=True, stdout=subprocess.PIPE, text=True).stdout
    return json.loads(out)


def number(value):
    return "∞" if value is None else f"{value:.2f}"


def shares(points):
    return f"{100 * points['within']:.1f} % ({100 * points['undecided']:.1f} %)"


def row(scene, cycle, v):
    low, high = v["l2_ci"]
    print(f"| {scene} | {cycle['cycle']} | {v['elements']:,} | {100 * v['estimated_error']:.2f} % | {100 * v['l2']:.2f} %"
          f" ({100 * low:.2f}–{100 * high:.2f}) | {number(v['effectivity'])} ({number(v['effectivity_ci'][0])}–"
          f"{number(v['effectivity_ci'][1])}) | {v['verdict']} | {shares(v['within_twice_the_estimate']['patch'])} |"
          f" {shares(v['within_twice_the_estimate']['mean'])} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("command", nargs="?", default=str(measure.ROOT / "build" / "patchlight"))
    parser.add_argument("--scene", nargs="+", choices=list(SCENES), default=list(SCENES))
    parser.add_argument("--points", type=int, default=2000)
    parser.add_argument("--paths", type=int, default=4096)
    parser.add_argument("--every", type=int, default=1, help="only each Nth cycle, and the last")
    parser.add_argument("--solve", nargs=argparse.REMAINDER, default=[], help="further options of solve")
    arguments = parser.parse_args()
    print("| scene | cycle | elements | estimated | measured (95 %) | effectivity (95 %) | the estimate |"
          " within 2 × patch's | within 2 × mean |")
    print("|---|---:|---:|---:|---:|---:|---|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        for scene in arguments.scene:
            run = Path(folder) / scene
            measure.solve(arguments.command, scene, run, *SCENES[scene], *arguments.solve)
            cycles = json.loads((run / "run.json").read_text(encoding="utf-8"))["cycles"]
            for cycle in cycles:
                if cycle["cycle"] % arguments.every == 0 or cycle is cycles[-1]:
                    row(scene, cycle, verified(arguments.command, run, cycle["cycle"], arguments))


if __name__ == "__main__":
    main()
