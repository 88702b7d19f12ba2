"""Fails one call after the other of a solve: writes, fsyncs, renames, making folders, allocations. Each time the command
must end with exit code 6 (5 for memory) and a message, not crash; what was finished before must be whole; no temporary
file may be left; and the same command without the fault must end with the very files of an undisturbed run.

    python3 tests/reliability/faults.py SOURCE BUILD [--every] [--demo]

--every: each call; otherwise each of the rarer kinds and a choice of allocations. --demo: of the demo, not a small solve.
"""

import argparse
import hashlib
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

KINDS = ("write", "fsync", "rename", "mkdir", "memory")
ALLOCATIONS = 60  # chosen of some hundred thousand


def digests(folder):
    """Of every file but timing.json and the page that shows it."""
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
            for p in sorted(folder.rglob("*")) if p.is_file() and p.name not in ("timing.json", "report.html")}


class Faults:
    def __init__(self, source, build, demo, scratch):
        self.library = scratch / "failing_calls.so"
        subprocess.run(["cc", "-shared", "-fPIC", "-O2", "-o", self.library,
                        source / "tests/reliability/failing_calls.c", "-ldl"], check=True)
        self.run = scratch / "run"
        self.count = scratch / "count"
        command = [build / "patchlight"]
        if demo:
            self.command = [*command, "demo", "-o", self.run, "--quiet"]
        else:
            self.command = [*command, "solve", source / "data/scenes/cornell-box.obj", "--unit", "mm", "-o", self.run,
                            "--max-elements", "300", "--size", "64x64", "--snapshots", "1,2", "--vertex-rays", "16",
                            "--rays", "16", "--quiet"]
        self.clean()
        assert self.go().returncode == 0
        self.expected = digests(self.run)

    def clean(self):
        shutil.rmtree(self.run, ignore_errors=True)

    def go(self, kind=None, at=0, forever=False):
        environment = dict(os.environ)
        if kind:
            environment |= {"LD_PRELOAD": str(self.library), "FAIL_CALL": kind, "FAIL_AT": str(at),
                            "FAIL_FOREVER": str(int(forever)), "COUNT_FILE": str(self.count)}
        return subprocess.run(self.command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=300)

    def calls(self, kind):
        self.clean()
        assert self.go(kind).returncode == 0
        return int(self.count.read_text())

    def problem(self, kind, at, forever):
        """What is wrong with how a fault ends; None: nothing."""
        self.clean()
        ended = self.go(kind, at, forever)
        wanted = 5 if kind == "memory" else 6
        # A library may do without an allocation (a cache, a message); then all must be as without the fault.
        if ended.returncode == 0 and kind == "memory":
            return None if digests(self.run) == self.expected else "ended with 0 and other files"
        if ended.returncode != wanted:
            return f"exit code {ended.returncode}, not {wanted}: {ended.stderr[-300:]}"
        if "error[" not in ended.stderr:
            return f"no message: {ended.stderr[-300:]!r}"
        if self.run.exists():
            left = [p.name for p in self.run.rglob("*") if "patchlight-tmp" in p.name]
            if left:
                return f"temporaries left: {left}"
            record = self.run / "run.json"
            if record.exists():
                if json.loads(record.read_text())["status"] == "finished":
                    # The fault came behind the last file of the run itself.
                    if digests(self.run) != self.expected and kind != "fsync":
                        return "marked finished, and isn't what it would be"
        ended = self.go()
        if ended.returncode != 0:
            return f"the same command afterwards: exit code {ended.returncode}: {ended.stderr[-300:]}"
        if digests(self.run) != self.expected:
            return "the same command afterwards ended with other files"
        return None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("source", type=Path)
    parser.add_argument("build", type=Path)
    parser.add_argument("--every", action="store_true")
    parser.add_argument("--demo", action="store_true")
    parser.add_argument("--kinds", default=",".join(KINDS))
    options = parser.parse_args()
    bad = 0
    with tempfile.TemporaryDirectory(prefix="patchlight-faults-") as scratch:
        faults = Faults(options.source.resolve(), options.build.resolve(), options.demo, Path(scratch))
        for kind in options.kinds.split(","):
            calls = faults.calls(kind)
            places = list(range(1, calls + 1))
            if kind == "memory" and not options.every:
                # Few at the beginning are the same ones each time; then evenly spread, by a fixed seed.
                places = sorted(random.Random(1).sample(places, min(ALLOCATIONS, calls)))
            elif not options.every:
                places = places[::4] + places[-1:]
            for at in places:
                for forever in (False, True) if kind == "memory" and at % 2 else (False,):
                    problem = faults.problem(kind, at, forever)
                    if problem:
                        bad += 1
                        print(f"{kind} {at} of {calls}{' and all after' if forever else ''}: {problem}", flush=True)
            print(f"{kind}: {len(places)} of {calls} calls made to fail", flush=True)
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
