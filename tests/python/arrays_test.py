"""Arrays are views: nothing is copied, nothing can be changed, and their owner lives as long as they do."""

from __future__ import annotations

import gc
import tempfile
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import patchlight
from cornell import box, solve_by_command


class Views(unittest.TestCase):
    def check(self, owner: Any, get: Callable[[Any], Any]) -> None:
        array = get(owner)
        self.assertIs(array.base, owner)
        self.assertFalse(array.flags.owndata)
        self.assertFalse(array.flags.writeable)
        with self.assertRaises(ValueError):
            array[...] = 0
        with self.assertRaises(ValueError):
            array.flags.writeable = True
        # No copy: asked for again, it lies at the same place.
        self.assertEqual(array.__array_interface__["data"][0], get(owner).__array_interface__["data"][0])

    def test_mesh(self) -> None:
        mesh = patchlight.triangulate(box(), patchlight.MeshingOptions(max_elements=200))
        self.check(mesh, lambda m: m.positions)
        self.check(mesh, lambda m: m.triangles)
        self.check(mesh, lambda m: m.areas)
        self.check(mesh, lambda m: m.patch_surface)
        self.assertEqual(mesh.triangles.dtype, np.uint32)
        a, b, c = (mesh.positions[mesh.triangles[:, k]] for k in range(3))
        # Cross products again: rounding alone.
        np.testing.assert_allclose(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2, mesh.areas, rtol=1e-9)
        inner = mesh.neighbours[mesh.neighbours >= 0]
        self.assertEqual(mesh.neighbours.shape, mesh.triangles.shape)
        self.assertLess(inner.max(), len(mesh))

    def test_light(self) -> None:
        solution = patchlight.solve_adaptively(box(), patchlight.AdaptiveOptions(max_elements=300))
        self.check(solution, lambda s: s.B)
        self.check(solution, lambda s: s.vertex_B)
        error = solution.error
        self.check(error, lambda e: e.eta)
        self.check(error, lambda e: e.edge)
        self.assertEqual(solution.B.shape, (len(solution.mesh), 3))
        self.assertEqual(solution.vertex_B.shape, (solution.mesh.vertex_count, 3))
        self.assertEqual(solution.middle_B.shape, (0, 3, 3))

    def test_outlive_the_name_of_their_owner(self) -> None:
        mesh = patchlight.triangulate(box(), patchlight.MeshingOptions(max_elements=5000))
        areas, positions = mesh.areas, mesh.positions
        copies = areas.copy(), positions.copy()
        del mesh
        gc.collect()
        # Whatever is made now would lie where the mesh was, were it gone.
        rubbish = [np.full(len(copies[0]), -1.0) for _ in range(50)]
        np.testing.assert_array_equal(areas, copies[0])
        np.testing.assert_array_equal(positions, copies[1])
        del rubbish

    def test_of_a_part_keep_the_whole(self) -> None:
        eta = patchlight.solve_adaptively(box(), patchlight.AdaptiveOptions(max_elements=300)).error.eta
        copy = eta.copy()
        gc.collect()
        rubbish = [np.full(len(copy), -1.0) for _ in range(50)]
        np.testing.assert_array_equal(eta, copy)
        del rubbish

    def test_factors(self) -> None:
        scene, options = box(), patchlight.AdaptiveOptions(max_elements=400)
        emitted = patchlight.emitted_light(scene, options)
        caster, mesh = patchlight.RayCaster(scene), patchlight.first_mesh(scene, options)
        # Nobody but the exchange holds on to them.
        exchange = patchlight.Exchange(scene, caster, mesh, emitted)
        del scene, caster, emitted
        gc.collect()
        F = patchlight.assemble(exchange, options).F
        self.check(F, lambda f: f.factors)
        sums = np.add.reduceat(F.factors, F.row_start[:-1].astype(np.int64))
        self.assertEqual(len(sums), len(mesh))
        # The box is open: a row sums to 1 at most, but for the single precision that factors of rays have.
        self.assertLessEqual(sums.max(), 1 + 1e-5)
        self.assertGreater(sums.min(), 0)


class Stored(unittest.TestCase):
    def test_run_is_read_as_arrays(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            run_folder = Path(folder) / "run"
            solve_by_command(run_folder, "--max-elements", "300")
            run = patchlight.open_run(run_folder)
            self.assertEqual(run.record["status"], "finished")
            self.assertEqual(run.cycles, list(range(len(run.cycles))))
            for cycle in run.cycles:
                stored = run.solution(cycle)
                self.assertEqual(run.record["cycles"][cycle]["elements"], len(stored.mesh))
                self.assertEqual(stored.eta.shape, (len(stored.mesh),))
            np.testing.assert_array_equal(run.solution().vertex_B, stored.vertex_B)
            solution = patchlight.solve_adaptively(box(), patchlight.AdaptiveOptions(max_elements=300))
            np.testing.assert_array_equal(stored.B, solution.B)
            again = patchlight.read_solution(run_folder / "solution.glb")
            np.testing.assert_array_equal(again.B, solution.B)
            with self.assertRaises(patchlight.RunError):
                run.solution(99)
        with self.assertRaises(patchlight.RunError):
            patchlight.open_run(run_folder)


if __name__ == "__main__":
    unittest.main()
