"""Two builds, by other compilers or with other options, give the same factors: closed forms and exact ones to 1e-9,
sampled ones within three of their standard errors; and each reads what the other has written.

    python3 tests/reliability/other_build.py COMMAND_A COMMAND_B
    python3 tests/reliability/other_build.py COMMAND --compiler clang++
    python3 tests/reliability/other_build.py COMMAND --without-avx2

--compiler: builds the other one, some minutes; without that compiler there is nothing to compare, and it says so.
--without-avx2: the same command, but with the C library's mathematics for machines without AVX2 and FMA.
PATCHLIGHT_SOURCE names the sources.
"""

import argparse
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import disturbed

PAIRS = (("light", "floor"), ("floor", "ceiling"), ("left_wall", "right_wall"), ("short_block", "left_wall"),
         ("tall_block", "back_wall"))
SAME = {"closed-form", "exact"}
SAMPLED = {"monte-carlo", "hemisphere"}
# Of the names that glibc 2.33 and later have, and those of before.
NARROW = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX2_Usable,-FMA_Usable"}


def answer(side, *words):
    command, environment = side
    done = disturbed.go([command, *words], env=environment)
    assert done.returncode == 0, f"{command} {words}: exit code {done.returncode}: {done.stderr}"
    return done.stdout


def factor(side, pair, method):
    return json.loads(answer(side, "formfactors", disturbed.CORNELL[0], "--between", *pair, "--method", method,
                             "--json"))


def compare_factors(sides):
    """The largest differences, absolute and in standard errors, and how many are too large."""
    apart, errors, bad = 0.0, 0.0, 0
    for pair in PAIRS:
        for method in sorted(SAME | SAMPLED):
            a, b = (factor(side, pair, method) for side in sides)
            difference = abs(a["value"] - b["value"])
            if method in SAME:
                apart = max(apart, difference)
                fine = difference <= 1e-9
            else:
                standard = math.hypot(a["error"], b["error"])
                errors = max(errors, difference / standard if standard else 0.0)
                fine = difference <= 3 * standard
            if not fine:
                bad += 1
                print(f"{method} of {pair}: {a['value']} and {b['value']}, errors {a['error']}, {b['error']}")
    return apart, errors, bad


def compare_solves(sides, scratch):
    """Each checks and measures what the other has solved; the estimates agree as two seeds' would."""
    runs = [scratch / "a", scratch / "b"]
    for side, run in zip(sides, runs):
        answer(side, "solve", *disturbed.SMALL, "-o", run, "--quiet")
    for side, run in zip(sides, reversed(runs)):
        answer(side, "verify", run, "--files-only")
        answer(side, "export", run, "--format", "csv", "-o", scratch / "x.csv")
    measured = [json.loads(answer(sides[0], "verify", run, "--points", "300", "--json")) for run in runs]
    (low_a, high_a), (low_b, high_b) = (m["l2_ci"] for m in measured)
    bad = low_a > high_b or low_b > high_a
    if bad:
        print(f"measured errors: {low_a} … {high_a} and {low_b} … {high_b}")
    others = disturbed.differing(*(disturbed.digests(run) for run in runs))
    return bad, others


def built_by(compiler, folder):
    subprocess.run(["cmake", "-S", disturbed.SOURCE, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                    f"-DCMAKE_CXX_COMPILER={compiler}"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder, "-j", "2", "--target", "patchlight"], check=True,
                   stdout=subprocess.DEVNULL)
    return folder / "patchlight"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command", type=Path)
    parser.add_argument("other", type=Path, nargs="?")
    parser.add_argument("--compiler")
    parser.add_argument("--without-avx2", action="store_true")
    options = parser.parse_args()
    if options.compiler and not shutil.which(options.compiler):
        print(f"there is no {options.compiler}")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="patchlight-builds-") as made:
        scratch = Path(made)
        other = options.other or options.command
        if options.compiler:
            other = built_by(options.compiler, scratch / "build")
        sides = [(options.command.resolve(), dict(os.environ)),
                 (other.resolve(), os.environ | (NARROW if options.without_avx2 else {}))]
        apart, errors, bad = compare_factors(sides)
        print(f"closed-form and exact factors: {apart:.3g} apart at most; sampled: {errors:.3g} standard errors")
        unlike, others = compare_solves(sides, scratch)
        print(f"a solve: {len(others)} files with other bytes")
    sys.exit(bad + unlike > 0)


if __name__ == "__main__":
    main()
