"""The solve that the tests of reliability disturb, and what must be true of its folder however it ended."""

import hashlib
import json
import os
import subprocess
import threading
import time
from pathlib import Path

SOURCE = Path(os.environ.get("PATCHLIGHT_SOURCE", Path(__file__).resolve().parents[2]))
COMMAND = Path(os.environ.get("PATCHLIGHT_COMMAND", SOURCE / "build/patchlight"))
CORNELL = [str(SOURCE / "data/scenes/cornell-box.obj"), "--unit", "mm"]

# Half a second, with everything that a solve writes.
SMALL = [*CORNELL, "--max-elements", "300", "--size", "64x64", "--snapshots", "1,2", "--vertex-rays", "16", "--rays",
         "16"]
# Some seconds and a dozen cycles, so that random moments meet different ones.
LONGER = [*CORNELL, "--max-elements", "1500", "--iterations", "12", "--size", "120x120", "--snapshots", "1,2",
          "--vertex-rays", "64", "--rays", "64"]


def solve(run, words=SMALL, *more):
    return [str(COMMAND), "solve", *words, "-o", str(run), "--quiet", *more]


def go(words, **more):
    return subprocess.run(list(map(str, words)), stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300,
                          **more)


def start(words, **more):
    return subprocess.Popen(list(map(str, words)), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, **more)


def digests(folder):
    """Of every file but timing.json and the page that shows it."""
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
            for p in sorted(folder.rglob("*")) if p.is_file() and p.name not in ("timing.json", "report.html")}


def differing(one, other):
    return sorted(name for name in one.keys() | other.keys() if one.get(name) != other.get(name))


def temporaries(folder):
    return [p.name for p in folder.rglob("*") if "patchlight-tmp" in p.name]


def status(folder):
    """run.json must always be whole; none: the run had not begun."""
    record = folder / "run.json"
    return json.loads(record.read_text())["status"] if record.exists() else "none"


def changed_files(folder):
    """Files that aren't what run.json says of them."""
    record = folder / "run.json"
    named = json.loads(record.read_text())["files"] if record.exists() else {}
    found = digests(folder)
    return [name for name, digest in named.items() if found.get(name) != digest]


def cycles(folder):
    """Of every whole cycle on the disk, when its record was written."""
    return {p.parent.name: p.stat().st_mtime_ns for p in folder.glob("cycles/*/record.json")}
