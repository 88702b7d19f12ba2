"""Solves random small scenes in the ordinary build: twenty times as many a second as the sanitized one of run.py does.

    python3 tests/fuzz/random_scenes.py [--seconds N] [--seed N] [--jobs N]

PATCHLIGHT_FUZZ_REPLAY names the program fuzz_replay [build/tests/fuzz/fuzz_replay]. What it is given are the bytes that
the fuzzer's target for scenes chooses by (scene.cpp): random ones, mostly such as choose places on a grid, and the
corpus with a few bytes changed. An input that fails, crashes or takes 20 s is kept in build-fuzz/found and named;
exit code 1 then. One line says how many there were.
"""

import argparse
import concurrent.futures
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
CORPUS = SOURCE / "tests" / "fuzz" / "corpus" / "scene"
FOUND = SOURCE / "build-fuzz" / "found"
REPLAY = os.environ.get("PATCHLIGHT_FUZZ_REPLAY", SOURCE / "build" / "tests" / "fuzz" / "fuzz_replay")
BATCH = 100
SECONDS = 60  # for a batch, of which an input takes 0.02
LONGEST = 20  # for an input: outlines with corners 1e-8 apart take 6,600 elements, and quadrature of their pairs 6 s


def random_input(numbers, seeds):
    if numbers.random() < 0.4:
        data = bytearray(numbers.choice(seeds) + numbers.randbytes(numbers.randrange(30)))
        for _ in range(numbers.randrange(1, 8)):
            data[numbers.randrange(len(data))] = numbers.randrange(256)
        return bytes(data)
    size, on_grid = numbers.choice([20, 40, 80, 120, 166]), numbers.choice([0.5, 0.8, 0.95])
    return bytes(numbers.randrange(180 if numbers.random() < on_grid else 256) for _ in range(size))


def replay(corpus):
    """Names of the inputs given, and of those that failed with what they said; the last fails with a crash or hang."""
    try:
        done = subprocess.run([REPLAY, corpus, "scene", str(LONGEST)], stdout=subprocess.PIPE, text=True,
                              errors="replace", timeout=SECONDS, env=dict(os.environ, TMPDIR=str(corpus)))
        said, end = done.stdout, None if done.returncode in (0, 1) else f"ended with {done.returncode}"
    except subprocess.TimeoutExpired as stopped:
        said, end = (stopped.stdout or b"").decode(errors="replace"), f"took {SECONDS} s"
    given, failed = [], []
    for line in said.splitlines():
        if line.startswith("scene: ") and "FAILED" not in line:
            given.append(line.removeprefix("scene: "))
        elif "FAILED" in line and given:
            failed.append((given[-1], line.strip()))
    if end and given:
        failed.append((given[-1], end))
    return given, failed


def try_batch(numbers, seeds, name):
    """How many inputs were given, and the failures with the files they are kept in."""
    kept, tried = [], 0
    with tempfile.TemporaryDirectory(prefix="patchlight-scenes-") as corpus:
        scenes = Path(corpus) / "scene"
        scenes.mkdir()
        for k in range(BATCH):
            (scenes / f"{k:03}").write_bytes(random_input(numbers, seeds))
        while any(scenes.iterdir()):
            given, failed = replay(Path(corpus))
            if not given:
                raise RuntimeError(f"{REPLAY} says nothing")
            for which, what in failed:
                shutil.copy(scenes / which, FOUND / f"scene-{name}-{which}")
                kept.append((FOUND / f"scene-{name}-{which}", what))
            tried += len(given)
            for which in given:  # after a crash the rest is still to be given
                (scenes / which).unlink()
    return tried, kept


def work(seed, end, seeds):
    numbers, tried, bad = random.Random(seed), 0, 0
    while time.monotonic() < end:
        given, kept = try_batch(numbers, seeds, f"{seed}-{tried}")
        tried, bad = tried + given, bad + len(kept)
        for path, what in kept:
            print(f"{path}: {what}", flush=True)
    return tried, bad


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=300, help="until no more are begun [300]")
    parser.add_argument("--seed", type=int, default=1, help="of the random numbers [1]")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="how many at a time [one a core]")
    options = parser.parse_args()
    FOUND.mkdir(parents=True, exist_ok=True)
    seeds = [path.read_bytes() for path in sorted(CORPUS.iterdir())]
    end = time.monotonic() + options.seconds
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        done = list(pool.map(lambda job: work(1000 * options.seed + job, end, seeds), range(options.jobs)))
    tried, bad = (sum(numbers) for numbers in zip(*done))
    print(f"random scenes: {tried} solved, {bad} failed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
