"""Fuzzes every reader, and the way from polygons to light, with libFuzzer under ASan and UBSan.

    python3 tests/fuzz/run.py [--seconds N] [--seed N] [--repeatable] [--targets NAME,...] [--json FILE] [--keep FOLDER]

Builds build-fuzz in the sources' folder first where it is missing or old: clang++ is needed. Two targets run at once.
A line a target says how many inputs were tried, how many of them reached something new, and how many edges of the
program were reached. Inputs that crash a target, or take it 10 s or 2 GiB, are kept in build-fuzz/found; exit code 1.
--repeatable: as nearly the same inputs on every machine as threads and names of temporary files allow, no more of them
than were once tried in that time, and 100 s for each: a test must not fail by what only a faster machine comes to. What
is new is looked for without it, with another --seed.
--keep: what reached something new, beyond the corpus, is kept there and taken up again. Without clang++: exit code 77.
"""

import argparse
import concurrent.futures
import ctypes
import json
import os
import queue
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
BUILD = SOURCE / "build-fuzz"
CORPUS = SOURCE / "tests" / "fuzz" / "corpus"
WORDS = SOURCE / "tests" / "fuzz" / "words"
FOUND = BUILD / "found"
ADDR_NO_RANDOMIZE = 0x0040000  # linux/personality.h
# By target, --repeatable: what two cores with nothing else to do try in 30 s.
EXECUTIONS = {"checkpoint": 600, "configuration": 100_000, "gltf": 120_000, "mtl": 450_000, "obj": 70_000,
              "points": 600_000, "record": 80_000, "scene": 180, "solution": 40_000, "study": 120_000}


def build():
    if not (BUILD / "build.ninja").exists():
        subprocess.run(["cmake", "--preset", "fuzz"], cwd=SOURCE, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", BUILD, "-j2", "--target", "fuzz_targets"], check=True,
                   stdout=subprocess.DEVNULL)


def programs():
    """By the targets' names."""
    return {path.name: BUILD / "tests" / "fuzz" / f"fuzz_{path.name}" for path in sorted(CORPUS.iterdir())}


def on_one_core(core):
    os.sched_setaffinity(0, {core})
    # Addresses, too, are compared, and what is compared goes into inputs. Containers may forbid it: then they differ.
    ctypes.CDLL(None).personality(ADDR_NO_RANDOMIZE)


def last_number(pattern, text):
    found = re.findall(pattern, text)
    return int(found[-1]) if found else 0


def fuzz(name, program, core, options):
    """What became of one target, on one core: with threads no run is like another."""
    # In memory: readers of files write one for each input.
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix="patchlight-fuzz-", dir=memory) as scratch:
        kept = options.keep / name if options.keep else Path(scratch) / "new"
        kept.mkdir(parents=True, exist_ok=True)
        environment = dict(os.environ, TMPDIR=scratch, ASAN_OPTIONS="allocator_may_return_null=1",
                           UBSAN_OPTIONS="print_stacktrace=1")
        # By name: a folder lists its files in another order on each machine, and then other inputs are made of them.
        seeds = Path(scratch) / "seeds"
        seeds.write_text(",".join(map(str, sorted((CORPUS / name).iterdir()))))
        command = [program, kept, f"-seed_inputs=@{seeds}", f"-max_total_time={options.seconds}",
                   f"-seed={options.seed}", "-rss_limit_mb=2048", f"-timeout={100 if options.repeatable else 10}",
                   "-print_final_stats=1", f"-artifact_prefix={FOUND / name}-"]
        if options.repeatable:
            # What it does each second, by the clock, changes which inputs are kept.
            command += [f"-runs={EXECUTIONS[name]}", "-reload=0", "-purge_allocator_interval=-1"]
        if (WORDS / name).exists():
            command.append(f"-dict={WORDS / name}")
        done = subprocess.run(list(map(str, command)), env=environment, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, errors="replace",
                              preexec_fn=lambda: on_one_core(core))
        inputs = sum(1 for _ in kept.iterdir())
    said = done.stderr
    artifact = re.search(r"Test unit written to (\S+)", said)
    return {"target": name,
            "executions": last_number(r"stat::number_of_executed_units:\s*(\d+)", said),
            "per_second": last_number(r"stat::average_exec_per_sec:\s*(\d+)", said),
            "new_inputs": inputs,
            "edges": last_number(r"cov: (\d+)", said),
            "peak_mb": last_number(r"stat::peak_rss_mb:\s*(\d+)", said),
            "found": artifact.group(1) if artifact else None,
            "exit_code": done.returncode,
            "end": said[-6000:] if done.returncode else ""}


def line_of(result):
    line = "{target:<14} {executions:>9} executions {per_second:>7}/s {new_inputs:>6} new inputs {edges:>7} edges".format(
        **result)
    if result["exit_code"]:
        line += f"\n{result['end']}\n{result['target']}: FAILED on {result['found']}"
    return line


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=int, default=30, help="for each target [30]")
    parser.add_argument("--seed", type=int, default=1, help="of libFuzzer's random numbers [1]")
    parser.add_argument("--repeatable", action="store_true", help="the same inputs each time, and no more")
    parser.add_argument("--targets", help="names, with commas between [all]")
    parser.add_argument("--json", type=Path, help="where the figures go as JSON [nowhere]")
    parser.add_argument("--keep", type=Path, help="folder for inputs that reach something new [none]")
    options = parser.parse_args()
    if shutil.which("clang++") is None:
        print("no clang++ here")
        return 77
    build()
    FOUND.mkdir(exist_ok=True)
    chosen = programs()
    if options.targets:
        chosen = {name: chosen[name] for name in options.targets.split(",")}
    results, cores = [], queue.SimpleQueue()
    for core in sorted(os.sched_getaffinity(0))[:2]:
        cores.put(core)

    def on_a_core(name, program):
        core = cores.get()
        try:
            return fuzz(name, program, core, options)
        finally:
            cores.put(core)

    with concurrent.futures.ThreadPoolExecutor(cores.qsize()) as pool:
        for future in [pool.submit(on_a_core, name, program) for name, program in chosen.items()]:
            results.append(future.result())
            print(line_of(results[-1]), flush=True)
    if options.json:
        options.json.write_text(json.dumps(results, indent=2) + "\n")
    return 1 if any(result["exit_code"] for result in results) else 0


if __name__ == "__main__":
    sys.exit(main())
