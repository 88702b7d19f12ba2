"""What a study runs, reuses, refuses and says; and what its references are worth."""

import json
import os
import unittest

from study_folders import CORNELL, FURNACE, StudyFolder

SMALL = f"""
scene = "{CORNELL}"
unit = "mm"
[vary]
max_elements = [100, 200]
[reference]
kind = "none"
"""


class StudyRuns(unittest.TestCase):
    def test_an_edited_study_keeps_what_is_finished(self):
        study = StudyFolder(self, SMALL)
        study.run("--quiet")
        before = study.cycles()
        study.write(SMALL.replace("[100, 200]", "[50, 100, 200]"))
        study.run("--quiet")
        after = study.cycles()
        self.assertLessEqual(before.items(), after.items())
        self.assertGreater(len(after), len(before))
        self.assertEqual([c["status"] for c in study.result()["cells"]], ["done"] * 3)

    def test_cells_by_themselves_are_the_run_s_cells(self):
        study = StudyFolder(self, SMALL)
        study.run("--quiet")
        study.cell("--index", 0, "--quiet", output="single")
        study.cell("--index", 1, "--quiet", output="single")
        cells = {n: d for n, d in study.files().items() if n.startswith("cells")}
        self.assertEqual(cells, study.files("single"))
        _, said = study.cell("--index", 1, output="single")
        self.assertIn("finished already", said)
        _, complaints = study.cell("--index", 2, expect=2)
        self.assertIn("--index", complaints)

    def test_a_cell_that_needs_too_much_is_named_and_the_rest_goes_on(self):
        study = StudyFolder(self, SMALL.replace("[100, 200]", "[100, 100000000]") + "[limits]\nmemory = \"2GiB\"\n")
        _, complaints = study.run("--quiet", expect=4)
        self.assertIn("max-elements=100000000", complaints)
        self.assertIn("needs", complaints)
        cells = study.result()["cells"]
        self.assertEqual([c["status"] for c in cells], ["done", "failed"])
        self.assertIn("memory: needs", cells[1]["message"])

    def test_a_cell_that_can_t_be_meant_is_named_and_the_rest_goes_on(self):
        study = StudyFolder(self, SMALL.replace("max_elements = [100, 200]", "solver = [\"gauss-seidel\", \"progressive\"]")
                            + "[options]\nmax_elements = 100\novershoot = true\n")
        _, complaints = study.run("--quiet", expect=4)
        self.assertIn("--overshoot is for --solver progressive", complaints)
        self.assertEqual([c["status"] for c in study.result()["cells"]], ["failed", "done"])

    def test_a_cell_over_its_time_goes_on_the_next_time(self):
        slow = SMALL.replace("[100, 200]", "[60000]") + "[limits]\ntime = \"1.5s\"\n"
        study = StudyFolder(self, slow)
        _, complaints = study.run("--quiet", expect=4)
        self.assertIn("limit", complaints)
        cell = study.result()["cells"][0]
        self.assertEqual(cell["status"], "over-time")
        before = study.cycles()
        study.run("--quiet", expect=4)
        self.assertLessEqual(before.items(), study.cycles().items())

    def test_a_target_that_is_missed_is_no_success(self):
        study = StudyFolder(self, SMALL + "[options]\ntarget_error = 0.0001\n")
        study.run("--quiet", expect=4)
        self.assertEqual({c["status"] for c in study.result()["cells"]}, {"not-converged"})

    def test_foreign_folders_are_refused(self):
        study = StudyFolder(self, SMALL)
        (study.folder / "out").mkdir()
        (study.folder / "out/thesis.tex").write_text("mine")
        _, complaints = study.run("--quiet", expect=2)
        self.assertIn("thesis.tex", complaints)
        self.assertEqual(os.listdir(study.folder / "out"), ["thesis.tex"])

    def test_json_is_the_file(self):
        study = StudyFolder(self, SMALL)
        said, _ = study.run("--quiet", "--json")
        self.assertEqual(json.loads(said), study.result())

    def test_probes_are_asked_of_the_last_cycle(self):
        study = StudyFolder(self, SMALL.replace("[reference]", "[metrics]\nprobes = \"points.csv\"\n[reference]"))
        (study.folder / "points.csv").write_text("x,y,z\n278,0,279.5\n1e6,0,0\n")
        study.run("--quiet")
        for cell in study.result()["cells"]:
            self.assertGreater(min(cell["probes"][0]), 0)
            self.assertIsNone(cell["probes"][1])


class References(unittest.TestCase):
    def test_a_furnace_is_solved_to_its_closed_form(self):
        study = StudyFolder(self, f"""
scene = "{FURNACE}"
[vary]
max_elements = [100, 200]
[reference]
kind = "furnace"
points = 300
""")
        study.run("--quiet")
        for cell in study.result()["cells"]:
            # Constant light: rays all find the same, what is left is the linear solve's tolerance of 1e-4.
            self.assertLess(cell["cycles"][-1]["error"], 5e-4)

    def test_a_box_with_a_lamp_is_no_furnace(self):
        study = StudyFolder(self, SMALL.replace("none", "furnace"))
        _, complaints = study.run("--quiet", expect=4)
        self.assertIn("alike all over", complaints)
        self.assertEqual([c["status"] for c in study.result()["cells"]], ["done", "done"])

    def test_paths_and_a_fine_solution_agree(self):
        text = f"""
scene = "{CORNELL}"
unit = "mm"
[vary]
max_elements = [100, 300]
[reference]
"""
        paths = StudyFolder(self, text + "kind = \"path-traced\"\npoints = 400\npaths = 1024\n")
        fine = StudyFolder(self, text + "kind = \"solution\"\npoints = 400\n[reference.options]\nmax_elements = 4000\n")
        paths.run("--quiet")
        fine.run("--quiet")
        for by_paths, by_solution in zip(paths.result()["cells"], fine.result()["cells"]):
            one, other = by_paths["cycles"][-1], by_solution["cycles"][-1]
            low, high = one["error_ci"]
            # The same points: what differs is the paths' noise and the fine solution's own error.
            self.assertLess(low, other["error"])
            self.assertGreater(high, other["error"])

    def test_a_run_and_its_points_are_the_same_reference(self):
        study = StudyFolder(self, SMALL)
        study.run("--quiet")
        ident = study.result()["cells"][1]["id"]
        run = study.folder / f"out/cells/{ident}/run"
        held = StudyFolder(self, SMALL.replace("kind = \"none\"", f"kind = \"run\"\nrun = \"{run}\"\npoints = 300"))
        held.run("--quiet")
        cells = held.result()["cells"]
        self.assertGreater(cells[0]["cycles"][-1]["error"], 1e-3)
        self.assertEqual(cells[1]["cycles"][-1]["error"], 0)


if __name__ == "__main__":
    unittest.main()
