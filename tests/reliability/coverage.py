"""How many lines of meshing, formfactor and solver their tests reach: 90 % of each folder at least.

    python3 tests/reliability/coverage.py [--least 90]

Builds in build-coverage, for the next time, and runs the suites of the three folders. Says a line a folder, and the
files that are reached least. PATCHLIGHT_SOURCE names the sources.
"""

import argparse
import json
import subprocess
import sys

import disturbed
from sanitizers import configured_and_built, run_tests

FOLDERS = ("meshing", "formfactor", "solver")


def covered(build):
    """By file of ours: lines, and those reached."""
    done = subprocess.run(["gcovr", "--root", disturbed.SOURCE, "--json-summary", "-", "--object-directory", build,
                           "--gcov-ignore-parse-errors", *(f"--filter={folder}/" for folder in FOLDERS), build],
                          cwd=disturbed.SOURCE, capture_output=True, text=True, check=True)
    return {file["filename"]: (file["line_total"], file["line_covered"])
            for file in json.loads(done.stdout)["files"]}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--least", type=float, default=90)
    options = parser.parse_args()
    build = configured_and_built("coverage", [f"{folder}_tests" for folder in FOLDERS])
    for counts in build.rglob("*.gcda"):
        counts.unlink()
    ran, failed = run_tests(build, 2, {}, "-R", "^(" + "|".join(FOLDERS) + r")\.")
    files, bad = covered(build), bool(failed) or ran == 0
    for folder in FOLDERS:
        counts = [counts for name, counts in files.items() if name.startswith(folder + "/")]
        lines, reached = (sum(column) for column in zip(*counts))
        bad = bad or 100 * reached < options.least * lines
        print(f"{folder}: {100 * reached / lines:.1f} % of {lines} lines")
    for name, (lines, reached) in sorted(files.items(), key=lambda item: item[1][1] - item[1][0])[:10]:
        print(f"    {lines - reached} lines not reached in {name}")
    print(f"{ran} tests, {len(failed)} failed {' '.join(failed)}")
    sys.exit(bad)


if __name__ == "__main__":
    main()
