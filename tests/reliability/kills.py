"""Ends a solve at random moments, the same ones each time, and looks at what is left.

    python3 tests/reliability/kills.py [--signals N] [--kills N]

SIGINT and SIGTERM: gone within a second, with 130 or 143; what is there is valid, marked interrupted, and has no
temporaries; the same command ends with the very files of an undisturbed run. SIGKILL, again and again in one folder: a
cycle that was whole is never computed again, so one at most is lost; and the same files at the end.
PATCHLIGHT_SOURCE and PATCHLIGHT_COMMAND name the sources and the command.
"""

import argparse
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import disturbed

# A second is promised on a machine that isn't busy; tests run beside others.
PROMISED, SPARE = 1.0, 0.5


class Kills:
    def __init__(self, scratch):
        self.run = scratch / "run"
        whole = scratch / "whole"
        begin = time.monotonic()
        done = disturbed.go(disturbed.solve(whole, disturbed.LONGER))
        assert done.returncode == 0, done.stderr
        self.seconds = time.monotonic() - begin
        self.expected = disturbed.digests(whole)
        self.problems = []
        self.slowest = 0.0

    def clean(self):
        shutil.rmtree(self.run, ignore_errors=True)

    def must(self, fine, what):
        if not fine:
            self.problems.append(what)
            print(what, flush=True)

    def start(self):
        return disturbed.start(disturbed.solve(self.run, disturbed.LONGER))

    def finish(self, what):
        done = disturbed.go(disturbed.solve(self.run, disturbed.LONGER))
        self.must(done.returncode == 0, f"{what}: the same command then ended with {done.returncode}: {done.stderr}")
        self.must(disturbed.differing(self.expected, disturbed.digests(self.run)) == [],
                  f"{what}: the same command then ended with other files")

    def check_part(self, what):
        self.must(disturbed.changed_files(self.run) == [], f"{what}: not what run.json says: "
                  f"{disturbed.changed_files(self.run)}")
        self.must(disturbed.temporaries(self.run) == [], f"{what}: left {disturbed.temporaries(self.run)}")

    def interrupt(self, moment, number):
        """Whether the signal came before the end."""
        what = f"signal {number} after {moment:.3f} s"
        self.clean()
        process = self.start()
        time.sleep(moment)
        begin = time.monotonic()
        process.send_signal(number)
        _, said = process.communicate(timeout=60)
        took = time.monotonic() - begin
        state = disturbed.status(self.run)
        if process.returncode == 0:
            self.must(state == "finished", f"{what}: exit code 0, but {state}")
            return False
        self.slowest = max(self.slowest, took)
        self.must(took < PROMISED + SPARE, f"{what}: took {took:.2f} s")
        # Until main begins, the system ends it, and nothing has been written.
        early = process.returncode == -number and state == "none"
        self.must(early or process.returncode == 128 + number, f"{what}: exit code {process.returncode}: {said}")
        self.must(early or state in ("interrupted", "finished", "none"), f"{what}: run.json says {state}")
        self.check_part(what)
        self.finish(what)
        return True

    def kill_again_and_again(self, count):
        """Each run ten times at most. Returns the most cycles that one cost, and how many came while cycles were done."""
        moments = random.Random(11)
        kills, kept, most, early = 0, {}, 0, 0
        self.clean()
        while kills < count:
            process = self.start()
            time.sleep(moments.uniform(0, 0.9) * self.seconds)
            process.kill()
            _, said = process.communicate()
            what = f"kill {kills + 1}"
            if process.returncode == 0:
                self.must(disturbed.differing(self.expected, disturbed.digests(self.run)) == [],
                          f"after {kills} kills: other files")
                self.clean()
                kept = {}
                continue
            self.must(process.returncode == -signal.SIGKILL, f"{what}: ended with {process.returncode}: {said}")
            kills += 1
            found = disturbed.cycles(self.run)
            again = [cycle for cycle, when in kept.items() if found.get(cycle) != when]
            self.must(again == [], f"{what}: cycles {again} were whole and are computed again")
            # Begun and not whole: what this kill costs.
            begun = {p.name for p in self.run.glob("cycles/*")} - found.keys()
            most = max(most, len(begun) + len(again))
            self.must(len(begun) <= 1, f"{what}: cycles {sorted(begun)} are not whole")
            kept = found
            early += len(found) < sum(name.endswith("record.json") for name in self.expected)
            disturbed.status(self.run)
            if kills % 10 == 0 or kills == count:
                # A new one, or all that follow would meet the pictures at the end.
                self.finish(f"after {kills} kills")
                self.clean()
                kept = {}
        return most, early


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--signals", type=int, default=10)
    parser.add_argument("--kills", type=int, default=10)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="patchlight-kills-") as scratch:
        kills = Kills(Path(scratch))
        moments = random.Random(5)
        met = sum(kills.interrupt(moments.uniform(0, kills.seconds), signal.SIGTERM if i % 2 else signal.SIGINT)
                  for i in range(options.signals))
        print(f"signals: {options.signals}, {met} before the end of a solve of {kills.seconds:.1f} s; slowest end "
              f"after {kills.slowest:.2f} s")
        # A test that only ever meets finished runs shows nothing.
        kills.must(met >= options.signals / 2, "most signals came too late")
        most, early = kills.kill_again_and_again(options.kills)
        print(f"kills: {options.kills}, {early} while cycles were computed, the others at the pictures; {most} cycle "
              f"lost at most by one")
    print(f"{len(kills.problems)} problems")
    sys.exit(bool(kills.problems))


if __name__ == "__main__":
    main()
