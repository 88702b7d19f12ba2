"""Fails one call after the other of a solve: write, fsync, rename, mkdir, an allocation. Each time the command must end
with exit code 6 (5 for memory) and a message, not crash; what was finished before must be whole; no temporary file may
be left; and the same command without the fault must end with the very files of an undisturbed run (of the demo, which
takes seconds, after every tenth).

    python3 tests/reliability/faults.py [--every] [--demo] [--kinds write,memory]

--every: each call but allocations, of those a thousand, or a hundred of the demo; otherwise a choice of all. --demo: of
the demo, not of a small solve. A solve a core at once, each in a folder of its own.
PATCHLIGHT_SOURCE and PATCHLIGHT_COMMAND name the sources and the command.
"""

import argparse
import concurrent.futures
import os
import queue
import random
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import disturbed

KINDS = ("write", "fsync", "rename", "mkdir", "memory")
# Allocations chosen of some hundred thousand, and every which of the other calls: within a minute, or many.
ALLOCATIONS, EVERY_ALLOCATIONS, EVERY_ALLOCATIONS_OF_DEMO, STEP = 16, 1000, 100, 10
AFTERWARDS_OF_DEMO = 10
# What ends the program by itself without memory, and can't be kept from it: glibc, when a thread needs the variables of
# a library that was loaded late, and GLib, which OpenImageIO brings along.
LIBRARIES_END = {127: "thread-local data: ABORT", -signal.SIGTRAP: "GLib-ERROR"}


class Faults:
    def __init__(self, demo, scratch):
        scratch.mkdir()
        self.afterwards = AFTERWARDS_OF_DEMO if demo else 1
        self.library = scratch / "failing_calls.so"
        subprocess.run(["cc", "-shared", "-fPIC", "-O2", "-o", self.library,
                        disturbed.SOURCE / "tests/reliability/failing_calls.c", "-ldl"], check=True)
        self.run = scratch / "run"
        self.count = scratch / "count"
        self.command = ([disturbed.COMMAND, "demo", "-o", self.run, "--quiet"] if demo else disturbed.solve(self.run))
        self.clean()
        assert self.go().returncode == 0
        self.expected = disturbed.digests(self.run)

    def clean(self):
        shutil.rmtree(self.run, ignore_errors=True)

    def go(self, kind=None, at=0, forever=False):
        environment = dict(os.environ)
        if kind:
            environment |= {"LD_PRELOAD": str(self.library), "FAIL_CALL": kind, "FAIL_AT": str(at),
                            "FAIL_FOREVER": str(int(forever)), "COUNT_FILE": str(self.count)}
        return disturbed.go(self.command, env=environment)

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
            return None if disturbed.digests(self.run) == self.expected else "ended with 0 and other files"
        if kind == "memory" and (words := LIBRARIES_END.get(ended.returncode)) and words in ended.stderr:
            return self.problem_afterwards(at)
        if ended.returncode != wanted:
            return f"exit code {ended.returncode}, not {wanted}: {ended.stderr[-300:]}"
        if "error[" not in ended.stderr:
            return f"no message: {ended.stderr[-300:]!r}"
        if disturbed.temporaries(self.run):
            return f"temporaries left: {disturbed.temporaries(self.run)}"
        if disturbed.changed_files(self.run):
            return f"not what run.json says: {disturbed.changed_files(self.run)}"
        # The fault may come behind the last file of the run itself.
        if disturbed.status(self.run) == "finished" and disturbed.digests(self.run) != self.expected:
            return "marked finished, and isn't what it would be"
        return self.problem_afterwards(at)

    def problem_afterwards(self, at):
        if at % self.afterwards != 0:
            return None
        ended = self.go()
        if ended.returncode != 0:
            return f"the same command afterwards: exit code {ended.returncode}: {ended.stderr[-300:]}"
        if disturbed.digests(self.run) != self.expected:
            return "the same command afterwards ended with other files"
        return None


def places(kind, calls, options):
    """Which calls are made to fail, and whether all after them, too."""
    if kind == "memory":
        wanted = (EVERY_ALLOCATIONS_OF_DEMO if options.demo else EVERY_ALLOCATIONS) if options.every else ALLOCATIONS
        chosen = sorted(random.Random(1).sample(range(1, calls + 1), min(wanted, calls)))
        return [(at, forever) for at in chosen for forever in ((False, True) if at % 2 else (False,))]
    every = range(1, calls + 1)
    return [(at, False) for at in (every if options.every else sorted({*every[::STEP], *every[-1:]}))]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--every", action="store_true")
    parser.add_argument("--demo", action="store_true")
    parser.add_argument("--kinds", default=",".join(KINDS))
    options = parser.parse_args()
    bad = 0
    with tempfile.TemporaryDirectory(prefix="patchlight-faults-") as scratch:
        free = queue.SimpleQueue()
        for core in range(os.cpu_count()):
            free.put(Faults(options.demo, Path(scratch) / str(core)))

        def with_one(work):
            faults = free.get()
            try:
                return work(faults)
            finally:
                free.put(faults)

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for kind in options.kinds.split(","):
                calls = with_one(lambda faults: faults.calls(kind))
                chosen = places(kind, calls, options)
                found = pool.map(lambda place: with_one(lambda faults: faults.problem(kind, *place)), chosen)
                for (at, forever), problem in zip(chosen, found):
                    if problem:
                        bad += 1
                        print(f"{kind} {at} of {calls}{' and all after' if forever else ''}: {problem}", flush=True)
                print(f"{kind}: {len({at for at, _ in chosen})} of {calls} calls made to fail", flush=True)
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
