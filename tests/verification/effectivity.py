#!/usr/bin/env python3
"""Prints the README's table of estimated beside true error, cycle by cycle.

    python3 tests/verification/effectivity.py [build/patchlight] [--scene NAME ...] [--points N] [--paths N] [--solve ...]

Solves each scene with --pictures none and lets `verify --cycle all` measure every cycle of the run by the same paths.
Effectivity is estimated over measured error, with its 95 % range. The last columns: share of points whose error is surely
beyond twice the estimate, their patch's own and the whole one; in brackets the points too near to it for the paths' noise.
At the end each scene's range from the second cycle on.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import measure

SCENES = {"cornell-box": ["--unit", "mm"], "furniture-room": [], "gallery": [],
          "narrow-penumbra": [], "wide-penumbra": [], "wall-on-floor": []}


def verified(command, run, arguments):
    out = subprocess.run([command, "verify", run, "--cycle", "all", "--points", str(arguments.points), "--paths",
                          str(arguments.paths), "--quiet", "--json"], check=True, stdout=subprocess.PIPE, text=True).stdout
    result = json.loads(out)
    return result.get("cycles", [result])


def number(value):
    return "∞" if value is None else f"{value:.2f}"


def shares(points):
    return f"{100 * points['beyond']:.1f} % ({100 * points['undecided']:.1f} %)"


def row(scene, v):
    low, high = v["l2_ci"]
    print(f"| {scene} | {v['cycle']} | {v['elements']:,} | {100 * v['estimated_error']:.2f} % | {100 * v['l2']:.2f} %"
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
          " beyond 2 × patch's | beyond 2 × whole |")
    print("|---|---:|---:|---:|---:|---:|---|---:|---:|")
    ranges = []
    with tempfile.TemporaryDirectory() as folder:
        for scene in arguments.scene:
            run = Path(folder) / scene
            measure.solve(arguments.command, scene, run, *SCENES[scene], *arguments.solve)
            cycles = verified(arguments.command, run, arguments)
            for v in cycles:
                if v["cycle"] % arguments.every == 0 or v is cycles[-1]:
                    row(scene, v)
            later = cycles[1:] or cycles
            found = [v["effectivity"] for v in later if v["effectivity"] is not None]
            beyond = max(v["within_twice_the_estimate"]["mean"]["beyond"] for v in later)
            ranges.append(f"| {scene} | {len(later)} | {100 * later[0]['estimated_error']:.2f} → "
                          f"{100 * later[-1]['estimated_error']:.2f} % | {min(found):.2f}–{max(found):.2f} |"
                          f" {100 * beyond:.1f} % |")
    print("\n| scene | cycles | estimated, first and last | estimated / measured | points beyond 2 × the estimate, at most |")
    print("|---|---:|---:|---:|---:|", *ranges, sep="\n")


if __name__ == "__main__":
    main()
