"""Builds everything with a sanitizer and runs the tests in it; a report fails the test that made it.

    python3 tests/reliability/sanitizers.py memory|threads|valgrind [--jobs N]

memory: address and undefined-behaviour sanitizers, all tests but those listed below. threads: the thread sanitizer, the
suites of what runs in parallel; loops then run on tests/reliability/instrumented instead of TBB. valgrind: the demo, in
the ordinary build that PATCHLIGHT_COMMAND names. PATCHLIGHT_SOURCE names the sources; builds stay in build-asan and
build-tsan there, for the next time. One line says what was run.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import disturbed

# What doesn't run under sanitizers, and why.
LEFT_OUT = {
    r"^package\.": "what is built on us would have to be linked with it, too",
    r"^python\.": "the interpreter isn't instrumented",
    r"^reliability\.": "they measure memory and seconds, limit them, or put libraries in front of the sanitizer's own",
    r"^fuzz\.": "an instrumented build of its own",
    r"^readme\.": "its commands build and run the ordinary program",
    r"^study\.slurm$": "a cluster of its own, with the ordinary build's limits",
    r"^benchmark\.": "seconds are all they tell",
    r"a_needle_costs_little$|APictureOfTheUsualSizeTakesLessThanASecond$": "the same",
}
SUITES = ("formfactor", "solver", "run", "imaging")
RACE = """
#include <tbb/parallel_for.h>
int main()
{
    int sum = 0;
    tbb::parallel_for(0, 1000000, [&](int k) { sum += k; });
    return sum == 1;
}
"""


def configured_and_built(preset, targets):
    folder = disturbed.SOURCE / f"build-{preset}"
    subprocess.run(["cmake", "--preset", preset, "-S", disturbed.SOURCE], check=True, stdout=subprocess.DEVNULL,
                   cwd=disturbed.SOURCE)
    chosen = [word for target in targets for word in ("--target", target)]
    subprocess.run(["cmake", "--build", folder, "-j", str(os.cpu_count()), *chosen], check=True,
                   stdout=subprocess.DEVNULL)
    return folder


def run_tests(folder, jobs, environment, *choice):
    """How many tests ran, and the names of those that failed."""
    # Sanitizers stand in for dlopen, which then looks for our module along their own path, not the program's.
    environment = os.environ | environment | {"LD_LIBRARY_PATH": str(folder)}
    done = subprocess.run(["ctest", "--test-dir", folder, "-j", str(jobs), "--timeout", "3600", "--output-on-failure",
                           *choice], env=environment, stdout=subprocess.PIPE, text=True)
    failed = re.findall(r"^\s*\d+ - (.+) \((?!Skipped|Disabled)", done.stdout, re.M)
    ran = re.search(r"tests passed, \d+ tests failed out of (\d+)", done.stdout)
    if done.returncode != 0:
        print(done.stdout[-20000:])
    return int(ran[1]) if ran else 0, failed or (["ctest"] if done.returncode != 0 else [])


def check_memory(jobs):
    folder = configured_and_built("asan", [])
    # What is allocated once and kept until the end is no leak of ours: the libraries' own.
    environment = {"ASAN_OPTIONS": "detect_leaks=0:detect_stack_use_after_return=1:allocator_may_return_null=1",
                   "UBSAN_OPTIONS": "print_stacktrace=1"}
    ran, failed = run_tests(folder, jobs, environment, "-LE", "^long$", "-E", "|".join(LEFT_OUT))
    print(f"address and undefined-behaviour sanitizers: {ran} tests, {len(failed)} with reports or failures "
          f"{' '.join(failed)}")
    return ran == 0 or bool(failed)


def finds_a_race(folder):
    """What is there to be found is found; else silence says nothing."""
    source = folder / "race.cpp"
    source.write_text(RACE)
    subprocess.run(["c++", "-std=c++20", "-fsanitize=thread", "-I", disturbed.SOURCE / "tests/reliability/instrumented",
                    source, "-o", folder / "race"], check=True)
    done = subprocess.run([folder / "race"], capture_output=True, text=True)
    return "data race" in done.stderr


def check_threads(jobs):
    folder = configured_and_built("tsan", [f"{suite}_tests" for suite in SUITES])
    suppressions = disturbed.SOURCE / "tests/reliability/thread_sanitizer.supp"
    environment = {"TSAN_OPTIONS": f"suppressions={suppressions}:halt_on_error=1"}
    found = finds_a_race(folder)
    ran, failed = run_tests(folder, jobs, environment, "-R", "^(" + "|".join(SUITES) + r")\.", "-E", "|".join(LEFT_OUT))
    print(f"thread sanitizer: {ran} tests, {len(failed)} with reports or failures {' '.join(failed)}"
          f"{'' if found else '; it does not find the race that is there'}")
    return ran == 0 or bool(failed) or not found


def check_valgrind():
    with tempfile.TemporaryDirectory(prefix="patchlight-valgrind-") as scratch:
        done = subprocess.run(["valgrind", "--error-exitcode=99", "--num-callers=30", "-q", disturbed.COMMAND, "demo",
                               "-o", Path(scratch) / "demo", "--quiet"], capture_output=True, text=True)
    reports = len(re.findall(r"^==\d+== \S", done.stderr, re.M))
    print(f"valgrind: the demo ended with {done.returncode}, {reports} lines of reports")
    if done.returncode != 0 or reports:
        print(done.stderr[:8000])
    return done.returncode != 0 or reports > 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("kind", choices=("memory", "threads", "valgrind"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    bad = {"memory": lambda: check_memory(options.jobs), "threads": lambda: check_threads(options.jobs),
           "valgrind": check_valgrind}[options.kind]()
    sys.exit(bad)


if __name__ == "__main__":
    main()
