"""Studies written, run and looked at by the tests."""

import hashlib
import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

SOURCE = Path(os.environ["PATCHLIGHT_SOURCE"])
COMMAND = os.environ["PATCHLIGHT_COMMAND"]
CORNELL = SOURCE / "data/scenes/cornell-box.obj"
FURNACE = SOURCE / "data/scenes/furnace.obj"


class StudyFolder:
    """A study file in a folder of its own, and what is run of it."""

    def __init__(self, test, text):
        self.folder = Path(tempfile.mkdtemp(prefix="patchlight-study-"))
        test.addCleanup(shutil.rmtree, self.folder)
        self.file = self.folder / "study.toml"
        self.write(text)

    def write(self, text):
        self.file.write_text(text)

    def command(self, *words):
        return [COMMAND, "study", *map(str, words)]

    def start(self, *words, output="out", **more):
        """`study run` as the first process of a group of its own."""
        return subprocess.Popen(self.command("run", self.file, "-o", self.folder / output, *words),
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
                                **more)

    def run(self, *words, output="out", expect=0):
        process = self.start(*words, output=output)
        said, complaints = process.communicate(timeout=600)
        assert process.returncode == expect, f"exit {process.returncode}, not {expect}: {complaints}\n{said}"
        return said, complaints

    def cell(self, *words, output="out", expect=0):
        done = subprocess.run(self.command("cell", self.file, "-o", self.folder / output, *words),
                              capture_output=True, text=True, timeout=600)
        assert done.returncode == expect, f"exit {done.returncode}, not {expect}: {done.stderr}"
        return done.stdout, done.stderr

    def result(self, output="out"):
        return json.loads((self.folder / output / "study.json").read_text())

    def files(self, output="out"):
        """The digest of every file but those that the clock is in."""
        root = self.folder / output
        return {str(path.relative_to(root)): hashlib.sha256(path.read_bytes()).hexdigest()
                for path in sorted(root.rglob("*"))
                if path.is_file() and path.name not in ("timing.json", "report.html")}

    def cycles(self, output="out"):
        """Of every whole cycle on the disk, when its record was written."""
        root = self.folder / output
        return {str(path.relative_to(root)): path.stat().st_mtime_ns for path in root.rglob("cycles/*/record.json")}


def differing(one, other):
    return sorted(name for name in one.keys() | other.keys() if one.get(name) != other.get(name))
