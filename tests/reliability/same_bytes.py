"""The same inputs give the same bytes of every output: at any number of threads, time and again, and whatever language,
time zone, home, permissions and folder are around.

    python3 tests/reliability/same_bytes.py [--every]

--every: 1, 2, 4 and 8 threads ten times each, and each oddity of the surroundings for itself; otherwise once with 1 and
with 8, and the oddities that don't exclude each other at once.
PATCHLIGHT_SOURCE and PATCHLIGHT_COMMAND name the sources and the command.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import disturbed

FORMATS = {"glb": "glb", "vtu": "vtu", "pvd": "pvd", "ply": "ply", "csv": "csv", "lightmap": "exr"}
# Lines, exact light, pictures and snapshots, hierarchical links: what has parallel loops of its own.
SOLVES = {
    "both": [*disturbed.SMALL, "--refine", "both"],
    "hierarchical": [*disturbed.SMALL, "--solver", "hierarchical"],
    "hemicube": [*disturbed.SMALL, "--form-factors", "hemicube"],
}
STUDY = f"""
scene = "{disturbed.CORNELL[0]}"
unit = "mm"
[vary]
refine = ["intensity", "both"]
max_elements = [100, 200]
[reference]
kind = "path-traced"
points = 200
paths = 128
"""


class Outputs:
    """Everything that the command writes, in one folder."""

    def __init__(self, folder, environment, threads, umask=-1, home=None):
        folder.mkdir()
        self.folder = folder
        self.more = {"env": environment, "umask": umask, "cwd": home or folder}
        if threads == 1:
            # Not every command has --threads.
            self.more["preexec_fn"] = lambda: os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
        self.threads = ["--threads", threads]

    def go(self, *words):
        done = disturbed.go([disturbed.COMMAND, *words], **self.more)
        assert done.returncode == 0, f"{words}: exit code {done.returncode}: {done.stderr}"
        return done.stdout

    def say(self, name, *words):
        """What is said, without the seconds that it took."""
        said = json.loads(self.go(*words, "--json"))
        for clock in ("seconds", "cpu_seconds"):
            said.pop(clock, None)
        (self.folder / f"{name}.json").write_text(json.dumps(said))

    def write(self):
        for name, words in SOLVES.items():
            self.go("solve", *words, "-o", self.folder / name, "--quiet", *self.threads)
        run = self.folder / "both"
        for name, ending in FORMATS.items():
            size = ["--size", "256"] if name == "lightmap" else []
            self.go("export", run, "--format", name, "-o", self.folder / f"exported/{name}.{ending}", *size)
        self.go("render", run, "-o", self.folder / "wires.png", "--wireframe", "--size", "80x80")
        self.go("report", run, "-o", self.folder / "page.html")
        self.go("compare", run, self.folder / "hierarchical", "-o", self.folder / "compared")
        points = self.folder / "points.csv"
        points.write_text("0.25,0,0.75\n0.1,0,0.1\n")
        self.go("probe", run, "--points", points, "-o", self.folder / "light.csv")
        self.say("verified", "verify", run, "--points", "40", "--paths", "64", *self.threads)
        self.say("factors", "formfactors", disturbed.CORNELL[0], "--between", "floor", "ceiling", "--method", "exact")
        file = self.folder / "study.toml"
        file.write_text(STUDY)
        self.go("study", "run", file, "-o", self.folder / "study", "--quiet", *self.threads)
        return disturbed.digests(self.folder)


def surroundings(scratch, every):
    """Environments by what is odd in them."""
    plain = {key: value for key, value in os.environ.items() if not key.startswith("LC_")} | {"SOURCE_DATE_EPOCH": "0"}
    locales = scratch / "locales"
    locales.mkdir()
    for name in ("de_DE", "tr_TR"):
        subprocess.run(["localedef", "-i", name, "-f", "UTF-8", "--no-archive", locales / f"{name}.UTF-8"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    spoken = lambda name: plain | {"LOCPATH": str(locales), "LC_ALL": f"{name}.UTF-8", "LANG": f"{name}.UTF-8"}
    bare = {key: value for key, value in plain.items() if key not in ("HOME", "USER", "LOGNAME", "TERM")}
    if every:
        return plain, {
            "a decimal comma": {"environment": spoken("de_DE")},
            "a dotless i": {"environment": spoken("tr_TR")},
            "another time zone": {"environment": plain | {"TZ": "Pacific/Chatham"}},
            "no home": {"environment": bare},
            "a umask of 077": {"environment": plain, "umask": 0o077},
            "another folder": {"environment": plain, "home": Path("/")},
        }
    return plain, {
        "a decimal comma, another time zone, and a umask of 077":
            {"environment": spoken("de_DE") | {"TZ": "Pacific/Chatham"}, "umask": 0o077},
        "a dotless i, no home, another folder":
            {"environment": bare | {"LOCPATH": str(locales), "LC_ALL": "tr_TR.UTF-8"}, "home": Path("/")},
    }


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--every", action="store_true")
    options = parser.parse_args()
    repeats, counts = (10, (1, 2, 4, 8)) if options.every else (1, (1, 8))
    problems = 0
    with tempfile.TemporaryDirectory(prefix="patchlight-bytes-") as made:
        scratch = Path(made)
        plain, others = surroundings(scratch, options.every)
        # The folder is named the same each time: its name is in what the commands print.
        folder = scratch / "outputs"

        def outputs(threads=2, environment=plain, **more):
            shutil.rmtree(folder, ignore_errors=True)
            return Outputs(folder, environment, threads, **more).write()

        expected = outputs()

        def compare(what, found):
            nonlocal problems
            other = disturbed.differing(expected, found)
            problems += bool(other)
            if other:
                print(f"{what}: {other} differ", flush=True)

        for repeat in range(repeats):
            for threads in counts:
                compare(f"{threads} threads, repeat {repeat + 1}", outputs(threads))
        for what, around in others.items():
            compare(what, outputs(**around))
        print(f"{len(expected)} files, {repeats} times with {counts} threads, and with {'; '.join(others)}: {problems} "
              f"times other bytes")
    sys.exit(problems > 0)


if __name__ == "__main__":
    main()
