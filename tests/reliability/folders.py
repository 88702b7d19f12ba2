"""A full disk, a folder that can't be written, and one that is taken away, replaced or wanted by two while in use.

PATCHLIGHT_SOURCE and PATCHLIGHT_COMMAND name the sources and the command.
"""

import os
import resource
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import disturbed


class Folders(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="patchlight-folders-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.run_folder = self.folder / "run"

    def mount(self, size):
        """A file system of its own of so many bytes; skips the test where that isn't allowed."""
        place = self.folder / "small"
        place.mkdir()
        if os.getuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", place],
                                              capture_output=True).returncode != 0:
            self.skipTest("may not mount a file system here")
        self.addCleanup(subprocess.run, ["umount", place], check=True)
        return place

    def remount(self, place, option):
        subprocess.run(["mount", "-o", f"remount,{option}", place], check=True)

    def expect_output_error(self, done, name):
        self.assertEqual(done.returncode, 6, done.stderr)
        self.assertIn("error[output]: ", done.stderr)
        self.assertIn(str(name), done.stderr)

    def expect_sound(self, run):
        """What is there is what run.json says, and no temporary."""
        self.assertEqual(disturbed.changed_files(run), [])
        self.assertEqual(disturbed.temporaries(run), [])

    def expect_whole(self, run, words=disturbed.SMALL):
        """The same command ends, with the files of an undisturbed run."""
        self.assertEqual(disturbed.go(disturbed.solve(run, words)).returncode, 0)
        whole = self.folder / "whole"
        self.assertEqual(disturbed.go(disturbed.solve(whole, words)).returncode, 0)
        self.assertEqual(disturbed.differing(disturbed.digests(whole), disturbed.digests(run)), [])

    def begin(self):
        """A solve of some seconds that has two whole cycles."""
        process = disturbed.start(disturbed.solve(self.run_folder, disturbed.LONGER))
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 30
        while not (self.run_folder / "cycles/01/record.json").exists():
            self.assertLess(time.monotonic(), deadline)
            self.assertIsNone(process.poll())
            time.sleep(0.005)
        return process

    def ended(self, process):
        out, err = process.communicate(timeout=60)
        return subprocess.CompletedProcess(process.args, process.returncode, out, err)

    def test_a_full_disk(self):
        place = self.mount("16k")
        run = place / "run"
        full = 0
        # Each a little larger, until it fits: the disk is full at another file each time.
        for size in (16, 48, 96, 160, 240, 320, 480, 640, 1024, 8192):
            self.remount(place, f"size={size}k")
            done = disturbed.go(disturbed.solve(run))
            if done.returncode == 0:
                break
            full += 1
            self.expect_output_error(done, run)
            self.assertIn("No space left on device", done.stderr)
            self.expect_sound(run)
        self.assertGreaterEqual(full, 4)
        self.expect_whole(run)

    def test_a_file_that_may_not_grow(self):
        """The full disk's stand-in where nothing may be mounted."""
        limited = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
        done = disturbed.go(disturbed.solve(self.run_folder), preexec_fn=limited)
        self.expect_output_error(done, self.run_folder)
        self.expect_sound(self.run_folder)
        self.expect_whole(self.run_folder)

    def test_a_disk_that_may_only_be_read(self):
        place = self.mount("8m")
        run = place / "run"
        done = disturbed.go(disturbed.solve(run))
        self.assertEqual(done.returncode, 0)
        before = disturbed.digests(run)
        self.remount(place, "ro")
        self.expect_output_error(disturbed.go(disturbed.solve(place / "another")), place / "another")
        again = disturbed.go(disturbed.solve(run))
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(disturbed.digests(run), before)
        for words in (("render", run, "-o", place / "x.png"), ("export", run, "--format", "ply", "-o", place / "x.ply"),
                      ("report", run, "-o", place / "x.html")):
            self.expect_output_error(disturbed.go([disturbed.COMMAND, *words]), words[-1])
        self.remount(place, "rw")

    def test_a_disk_that_turns_read_only_while_solving(self):
        place = self.mount("64m")
        self.run_folder = place / "run"
        process = self.begin()
        process.send_signal(19)  # stopped, or an open file would keep the disk writable
        time.sleep(0.1)
        stopped = subprocess.run(["mount", "-o", "remount,ro", place], capture_output=True)
        process.send_signal(18)
        if stopped.returncode != 0:
            self.skipTest("a file was just being written")
        self.expect_output_error(self.ended(process), self.run_folder)
        self.remount(place, "rw")
        self.assertEqual(disturbed.changed_files(self.run_folder), [])
        self.expect_whole(self.run_folder, disturbed.LONGER)

    def test_a_folder_removed_while_solving(self):
        process = self.begin()
        # As rm -rf does, file by file: a new one may come meanwhile, so until it is gone.
        while self.run_folder.exists():
            shutil.rmtree(self.run_folder, ignore_errors=True)
        self.expect_output_error(self.ended(process), self.run_folder)
        self.assertFalse(self.run_folder.exists(), "came back")

    def test_cycles_removed_while_solving(self):
        process = self.begin()
        shutil.rmtree(self.run_folder / "cycles/00")
        self.expect_output_error(self.ended(process), self.run_folder / "cycles/00/solution.glb")
        self.expect_whole(self.run_folder, disturbed.LONGER)

    def test_a_folder_replaced_by_a_file_while_solving(self):
        process = self.begin()
        self.run_folder.rename(self.folder / "moved")
        self.run_folder.write_text("mine")
        self.expect_output_error(self.ended(process), self.run_folder)
        self.assertEqual(self.run_folder.read_text(), "mine")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["moved", "run"])
        self.assertEqual(disturbed.changed_files(self.folder / "moved"), [])
        self.expect_whole(self.folder / "moved", disturbed.LONGER)

    def test_a_folder_replaced_by_another_while_solving(self):
        process = self.begin()
        self.run_folder.rename(self.folder / "moved")
        self.run_folder.mkdir()
        (self.run_folder / "run.json").write_text("mine")
        self.expect_output_error(self.ended(process), self.run_folder)
        self.assertEqual({p.name: p.read_text() for p in self.run_folder.iterdir()}, {"run.json": "mine"})

    def test_two_processes_on_one_folder(self):
        process = self.begin()
        second = disturbed.go(disturbed.solve(self.run_folder, disturbed.LONGER))
        self.assertEqual(second.returncode, 2)
        self.assertIn(f"is being written by another patchlight (process {process.pid})", second.stderr)
        first = self.ended(process)
        self.assertEqual(first.returncode, 0, first.stderr)
        self.expect_whole(self.run_folder, disturbed.LONGER)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["run", "whole"])


if __name__ == "__main__":
    unittest.main()
