"""What the hardening of the release build costs: processor seconds of solves by the program and by one built without
(nor position-independent), in turn, in an order that a machine growing slower doesn't favour.

    python3 tests/benchmark/hardening_cost.py BUILD [--rounds 8]

BUILD: an ordinary build. The other one is built in build-soft beside the sources, and stays for the next time.
"""

import argparse
import os
import resource
import shutil
import statistics
import subprocess
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
SCENES = SOURCE / "data/scenes"
SOLVES = {
    "Cornell box, both, 8,000": (SCENES / "cornell-box.obj", "--unit", "mm", "--max-elements", "8000"),
    "Cornell box, exact factors, 1,500": (SCENES / "cornell-box.obj", "--unit", "mm", "--refine", "none",
                                          "--form-factors", "exact", "--max-elements", "1500"),
    "gallery, links, 6,000": (SCENES / "gallery.obj", "--refine", "none", "--solver", "hierarchical", "--max-elements",
                              "6000"),
}


def without_hardening():
    folder = SOURCE / "build-soft"
    subprocess.run(["cmake", "-S", SOURCE, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                    "-DPATCHLIGHT_HARDENING=OFF", "-DPATCHLIGHT_TESTS=OFF", "-DPATCHLIGHT_PYTHON=OFF"], check=True,
                   stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder, "-j", str(os.cpu_count()), "--target", "patchlight"], check=True,
                   stdout=subprocess.DEVNULL)
    return folder / "patchlight"


def seconds(command, words, folder):
    shutil.rmtree(folder, ignore_errors=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([command, "solve", *words, "-o", folder, "--pictures", "none", "--quiet"], check=True,
                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=Path)
    parser.add_argument("--rounds", type=int, default=8)
    options = parser.parse_args()
    hard, soft = options.build.resolve() / "patchlight", without_hardening()
    with tempfile.TemporaryDirectory(prefix="patchlight-cost-") as scratch:
        for name, words in SOLVES.items():
            ratios = []
            for _ in range(options.rounds):
                a, b, c, d = (seconds(command, words, Path(scratch) / "run") for command in (hard, soft, soft, hard))
                ratios.append((a + d) / (b + c))
            error = statistics.stdev(ratios) / len(ratios) ** 0.5
            print(f"{name}: {100 * (statistics.mean(ratios) - 1):+.1f} ± {100 * error:.1f} % processor seconds",
                  flush=True)


if __name__ == "__main__":
    main()
