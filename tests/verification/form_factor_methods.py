#!/usr/bin/env python3
"""Prints the README's table of form-factor methods: whole matrices of the closed Cornell box, each by each method.

    python3 tests/verification/form_factor_methods.py [build/patchlight] [--sizes 500,2000,8000] [--folder DIR]

Seconds are the matrix's alone, the memory is the whole command's at its largest. Closure is |1 − ΣF| of a row, what
meets black backs (the floor under the blocks) taken out where the method knows it. Errors are against the exact
method on 200 pairs of patches drawn at random, half of them partly occluded (the exact factor between 2 and 98 % of
the closed form's), half visible (more): the median of |F/F_exact − 1|, and √(Σ(F − F_exact)²/ΣF_exact²). A dash
stands where a method isn't meant for that size: quadrature needs seconds a row at 8,000, and monte-carlo is for
single pairs.
"""

import argparse
import array
import json
import math
import os
import random
import statistics
import struct
import subprocess
import sys
import tempfile
from bisect import bisect_left
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENE = ROOT / "data" / "scenes" / "cornell-box-closed.obj"
METHODS = ["closed-form", "hemicube", "hemisphere", "quadrature", "exact", "monte-carlo"]
LARGEST = {"monte-carlo": 0, "quadrature": 2000}
PAIRS = 200
DASH = "–"


class Factors:
    """A matrix in the file that --help describes; rows are read when they are asked for."""

    def __init__(self, path):
        self.file = open(path, "rb")
        magic, self.n, self.entries = struct.unpack("<8sQQ", self.file.read(24))
        assert magic == b"PLFFCSR1", magic
        self.row_start = self.read(24, "Q", self.n + 1)
        self.columns_at = 24 + 8 * (self.n + 1)
        self.factors_at = self.columns_at + 4 * self.entries

    def read(self, offset, kind, count):
        self.file.seek(offset)
        values = array.array(kind)
        values.fromfile(self.file, count)
        return values

    def factor(self, i, j):
        first, last = self.row_start[i], self.row_start[i + 1]
        columns = self.read(self.columns_at + 4 * first, "I", last - first)
        k = bisect_left(columns, j)
        if k == len(columns) or columns[k] != j:
            return 0.0
        return self.read(self.factors_at + 8 * (first + k), "d", 1)[0]


def run(command, method, size, folder):
    """The command's JSON, its peak memory in MiB, and its factors."""
    out = Path(folder) / f"{method}-{size}.bin"
    words = [command, "formfactors", SCENE, "--unit", "mm", "--max-elements", str(size), "--method", method, "--json",
             "--quiet", "-o", out]
    child = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    text, said = child.stdout.read(), child.stderr.read()
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"{method} at {size}: exit {child.returncode}: {said}")
    return json.loads(text), usage.ru_maxrss / 1024, Factors(out)


def chosen_pairs(exact, unoccluded, seed):
    """Equal numbers of partly occluded and of visible pairs, with their exact factors."""
    source = random.Random(seed)
    partial, visible = [], []
    for _ in range(2_000_000):
        i, j = source.randrange(exact.n), source.randrange(exact.n)
        free = unoccluded.factor(i, j)
        if free <= 0:
            continue
        known = exact.factor(i, j)
        kind = visible if known > 0.98 * free else partial if known >= 0.02 * free else None
        if kind is not None and len(kind) < PAIRS // 2:
            kind.append((i, j, known))
        if len(partial) == len(visible) == PAIRS // 2:
            return visible, partial
    sys.exit("too few partly occluded pairs")


def errors(factors, pairs):
    found = [(factors.factor(i, j), known) for i, j, known in pairs]
    median = statistics.median(abs(f / known - 1) for f, known in found)
    l2 = math.sqrt(sum((f - known) ** 2 for f, known in found) / sum(known**2 for _, known in found))
    return f"{percent(median)} / {percent(l2)}"


def percent(x):
    return f"{100 * x:.2g} %" if 0 < x < 0.995 else f"{100 * x:.0f} %"


def row(size, method, result, visible, partial):
    if result is None:
        return f"| {size:,} | {method} |" + f" {DASH} |" * 6
    said, memory, factors = result
    closure = said["closure"]
    found = [DASH, DASH] if method == "exact" else [errors(factors, visible), errors(factors, partial)]
    return (f"| {said['elements']:,} | {method} | {said['seconds']:.2f} | {memory:,.0f} MiB | {closure['mean']:.1e} |"
            f" {closure['worst']:.1e} | {found[0]} | {found[1]} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("command", nargs="?", default=str(ROOT / "build" / "patchlight"))
    parser.add_argument("--sizes", default="500,2000,8000")
    parser.add_argument("--folder", help="where the matrices are kept [a temporary folder]")
    parser.add_argument("--seed", type=int, default=1, help="of the choice of pairs")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.folder or temporary
        print("| patches | method | seconds | memory | closure, mean | worst | visible pairs: median / L2 error |"
              " partly occluded: median / L2 error |")
        print("|---:|---|---:|---:|---:|---:|---:|---:|")
        for size in map(int, arguments.sizes.split(",")):
            results = {m: run(arguments.command, m, size, folder) if size <= LARGEST.get(m, size) else None
                       for m in METHODS}
            visible, partial = chosen_pairs(results["exact"][2], results["closed-form"][2], arguments.seed)
            for method in METHODS:
                print(row(size, method, results[method], visible, partial), flush=True)


if __name__ == "__main__":
    main()
