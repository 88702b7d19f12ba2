"""A study that is killed again and again ends with the bytes of one that wasn't, and does no finished cycle twice."""

import os
import random
import signal
import time
import unittest

from study_folders import CORNELL, StudyFolder, differing

# Twelve cells of a second at most, so that twenty kills meet all stages of them.
STUDY = f"""
scene = "{CORNELL}"
unit = "mm"
[vary]
refine = ["none", "intensity", "both"]
max_elements = [100, 150, 200, 300]
[reference]
kind = "path-traced"
points = 400
paths = 256
"""


def kill_group(process):
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()


def wait_for_a_cycle(study):
    """Until the first cell is on its way; the others are still to come."""
    deadline = time.monotonic() + 60
    while not study.cycles() and time.monotonic() < deadline:
        time.sleep(0.01)


class KilledStudies(unittest.TestCase):
    def test_twenty_kills_leave_no_trace(self):
        study = StudyFolder(self, STUDY)
        begin = time.monotonic()
        study.run("--quiet", output="whole")
        seconds = time.monotonic() - begin
        moments = random.Random(7)
        kills = 0
        for _ in range(20):
            process = study.start("--quiet")
            # Twenty times a tenth of the whole, on average: kills fall all over the study.
            try:
                process.communicate(timeout=moments.uniform(0.02, 0.18) * seconds)
                self.assertEqual(process.returncode, 0)
            except Exception:
                kill_group(process)
                kills += 1
            before = study.cycles()
            self.check_kept(study, before)
        self.assertGreaterEqual(kills, 10)
        before = study.cycles()
        study.run("--quiet")
        self.check_kept(study, before)
        self.assertEqual(differing(study.files("whole"), study.files()), [])

    def check_kept(self, study, before):
        """What was whole on the disk is the file it was: only the cycle that was being computed is lost."""
        kept = getattr(self, "seen", {})
        for name, when in kept.items():
            self.assertEqual(before.get(name), when, f"{name} was computed again")
        self.seen = before

    def test_two_jobs_give_the_bytes_of_one(self):
        study = StudyFolder(self, STUDY)
        study.run("--quiet", output="one")
        study.run("--quiet", "--jobs", 2, output="two")
        self.assertEqual(differing(study.files("one"), study.files("two")), [])

    def test_interrupt_ends_within_a_second_and_keeps_all(self):
        study = StudyFolder(self, STUDY)
        process = study.start("--quiet", "--jobs", 2)
        wait_for_a_cycle(study)
        os.killpg(process.pid, signal.SIGINT)
        begin = time.monotonic()
        process.communicate(timeout=10)
        # A second is promised; on a machine with other work to do, half of one more.
        self.assertLess(time.monotonic() - begin, 1.5)
        self.assertEqual(process.returncode, 130)
        before = study.cycles()
        study.run("--quiet")
        self.assertLessEqual(before.items(), study.cycles().items())

    def test_children_of_a_killed_run_stop_and_the_next_run_waits_for_them(self):
        study = StudyFolder(self, STUDY)
        process = study.start("--quiet")
        wait_for_a_cycle(study)
        process.kill()  # the parent alone
        process.communicate()
        study.run("--quiet")
        study.run("--quiet", output="whole")
        self.assertEqual(differing(study.files("whole"), study.files()), [])

    def test_what_a_kill_left_half_written_goes(self):
        study = StudyFolder(self, STUDY.replace("[100, 150, 200, 300]", "[100]"))
        study.run("--quiet")
        before = study.files()
        (study.folder / "out/.study.json.1.patchlight-tmp").write_text("{")
        study.run("--quiet")
        self.assertEqual(differing(before, study.files()), [])

    def test_a_second_run_says_who_is_there(self):
        study = StudyFolder(self, STUDY)
        first = study.start("--quiet")
        deadline = time.monotonic() + 20
        while not (study.folder / "out/cells").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        _, complaints = study.run("--quiet", expect=2)
        self.assertIn("is being written by another patchlight", complaints)
        kill_group(first)


if __name__ == "__main__":
    unittest.main()
