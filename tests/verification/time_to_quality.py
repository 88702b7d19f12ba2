#!/usr/bin/env python3
"""Prints the README's table of time to quality on the Cornell box.

    python3 tests/verification/time_to_quality.py [build/patchlight] [--seeds N] [--targets F ...] [--paths N]

For each target `solve --pictures none --target-error F`, all else default: CPU seconds of the whole process (user and
system, all threads; means over the seeds), and the error it reached at the 2,000 path-traced points of data/reference,
whose own variance is subtracted: relative L2, which --target-error means, and relative RMS over points and bands.

Beside it what the path tracer of `verify` takes on the same machine to know the light at as many points to that relative
RMS. It is run once; its time is extrapolated by 1/√n from the standard error that it reached.
"""

import argparse
import json
import os
import subprocess
import tempfile
from pathlib import Path

import measure

SCENE, OPTIONS = "cornell-box", ["--unit", "mm"]
TARGETS = (0.05, 0.03, 0.02, 0.01, 0.007, 0.005, 0.004, 0.003)
LIMITS = {0.05: 0.5, 0.02: 2.0, 0.01: 10.0}  # CPU seconds for this relative RMS


def timed(*words):
    """CPU seconds of a command and its exit code."""
    with subprocess.Popen(list(map(str, words)), stdout=subprocess.DEVNULL) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_utime + usage.ru_stime, process.returncode


def one_run(command, target, seed, run, rows, known, noise, folder):
    seconds, code = timed(command, "solve", measure.ROOT / "data" / "scenes" / f"{SCENE}.obj", "-o", run, *OPTIONS,
                          "--pictures", "none", "--quiet", "--target-error", target, "--seed", seed)
    if code not in (0, 4):
        raise SystemExit(f"solve --target-error {target} --seed {seed}: exit {code}")
    result = json.loads((run / "run.json").read_text(encoding="utf-8"))["result"]
    l2, rms = measure.errors(measure.probe(command, run, rows, folder), known, noise)
    return seconds, l2, rms, result["elements"], result["estimated_error"], code == 0


def mean(values):
    return sum(values) / len(values)


def path_tracer(command, run, points, paths):
    """CPU seconds and the relative RMS of the standard error that they gave."""
    out = subprocess.run([command, "verify", run, "--points", str(points), "--paths", str(paths), "--quiet", "--json"],
                         check=True, stdout=subprocess.PIPE, text=True).stdout
    result = json.loads(out)
    return result["cpu_seconds"], result["path_noise"]["relrms"], result["paths"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("command", nargs="?", default=str(measure.ROOT / "build" / "patchlight"))
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--targets", type=float, nargs="+", default=TARGETS)
    parser.add_argument("--paths", type=int, default=4096, help="of the path tracer, from each point at most")
    arguments = parser.parse_args()
    rows, known = measure.reference(SCENE)
    noise = [[float(row[band]) for band in ("se_r", "se_g", "se_b")] for row in rows]
    table = []
    with tempfile.TemporaryDirectory() as folder:
        for target in arguments.targets:
            runs = [one_run(arguments.command, target, seed, Path(folder) / f"{target}-{seed}", rows, known, noise, folder)
                    for seed in range(1, arguments.seeds + 1)]
            table.append((target, [mean(column) for column in zip(*(r[:5] for r in runs))], all(r[5] for r in runs)))
        spent, reached, paths = path_tracer(arguments.command, Path(folder) / f"{arguments.targets[-1]}-1", len(rows),
                                            arguments.paths)
    print("| --target-error | CPU s | relative L2 | relative RMS | elements | estimated |"
          " path tracer to that RMS, CPU s | ratio |")
    print("|---:|---:|---:|---:|---:|---:|---:|---:|")
    for target, (seconds, l2, rms, elements, estimated), met in table:
        traced = spent * (reached / rms) ** 2 if rms > 0 else float("inf")
        print(f"| {100 * target:g} % | {seconds:.2f} | {100 * l2:.2f} % | {100 * rms:.2f} % | {elements:,.0f} |"
              f" {100 * estimated:.2f} %{'' if met else ' (not met)'} | {traced:.2f} | {traced / seconds:.2f} |")
    print()
    for level, limit in LIMITS.items():
        there = [(values[0], target) for target, values, met in table if values[2] <= level]
        if there:
            seconds, target = min(there)
            print(f"relative RMS {100 * level:g} %: {seconds:.2f} CPU s (limit {limit:g}) by --target-error {target:g}")
        else:
            print(f"relative RMS {100 * level:g} %: not reached")
    print(f"\nPath tracer: {spent:.2f} CPU s for {paths} paths from each of {len(rows):,} points, relative RMS of their"
          f" standard errors {100 * reached:.2f} %; other times by 1/√n.")


if __name__ == "__main__":
    main()
