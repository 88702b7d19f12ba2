#!/usr/bin/env python3
"""Prints how time and memory of the hierarchical solver grow with the scene: cities of 10^4, 10^5 and 10^6 polygons.

    python3 tests/verification/scaling.py [build/patchlight] [--polygons 10000,100000,1000000] [--tolerance T]

Writes each city (data/scenes/city.py), reads it (`inspect`), solves it on its coarsest mesh (`solve --refine none --solver
hierarchical --pictures none`), and prints seconds by stage, the peak of memory, links, links / n², and the exponent of
the seconds in the elements from one size to the next. Takes 20 minutes and 16 GB for 10^6 polygons.
"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ELEMENTS_PER_POLYGON = 3.6  # the coarsest mesh has about these


def timed(*command):
    """Seconds, peak MiB and stdout of a program."""
    begin = time.monotonic()
    run = subprocess.run(["/usr/bin/time", "-f", "%M", *map(str, command)], check=True, text=True,
                         stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    return time.monotonic() - begin, int(run.stderr.split()[-1]) / 1024, run.stdout


def measure(command, polygons, tolerance, folder):
    stem = Path(folder) / "city"
    subprocess.run([sys.executable, ROOT / "data" / "scenes" / "city.py", "--polygons", str(polygons), "--stem", stem],
                   check=True, stdout=subprocess.DEVNULL)
    read, _, _ = timed(command, "inspect", f"{stem}.obj", "--json")
    run = Path(folder) / f"run{polygons}"
    whole, peak, out = timed(command, "solve", f"{stem}.obj", "-o", run, "--refine", "none", "--solver", "hierarchical",
                             "--tolerance", tolerance, "--max-elements", int(ELEMENTS_PER_POLYGON * polygons),
                             "--vertex-rays", 64, "--pictures", "none", "--quiet", "--json")
    cycle = json.loads(out)["cycles"][0]
    stages = json.loads((run / "timing.json").read_text(encoding="utf-8"))["cycles"][0]["seconds"]
    return {"n": cycle["elements"], "read": read, "whole": whole, "peak": peak, "links": cycle["solve"]["links"],
            "converged": cycle["solve"]["converged"], "residual": cycle["energy"]["relative_residual"], **stages}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("command", nargs="?", default=ROOT / "build" / "patchlight")
    options.add_argument("--polygons", default="10000,100000,1000000")
    options.add_argument("--tolerance", type=float, default=0.1)
    options = options.parse_args()
    print("| polygons | elements | inspect s | mesh s | links s | gather, estimate s | whole s | MiB | links | links / n² "
          "| energy residual | exponent: links s, whole s |")
    print("|" + "---:|" * 12)
    before = None
    with tempfile.TemporaryDirectory(prefix="patchlight-scaling-") as folder:
        for polygons in map(int, options.polygons.split(",")):
            m = measure(options.command, polygons, options.tolerance, folder)
            grown = lambda what: math.log(m[what] / before[what]) / math.log(m["n"] / before["n"])
            exponents = f"{grown('solve'):.2f}, {grown('whole'):.2f}" if before else ""
            print(f"| {polygons:,} | {m['n']:,} | {m['read']:.1f} | {m['mesh']:.1f} | {m['solve']:.1f} "
                  f"| {m['gather'] + m['estimate']:.1f} | {m['whole']:.1f} | {m['peak']:,.0f} | {m['links']:,} "
                  f"| {m['links'] / m['n'] ** 2:.1e} | {m['residual']:+.3f} | {exponents} |", flush=True)
            before = m


if __name__ == "__main__":
    main()
