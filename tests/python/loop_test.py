"""The adaptive loop written by hand: the command's bytes, and steps of one's own."""

from __future__ import annotations

import itertools
import tempfile
import unittest
from pathlib import Path

import numpy as np
import numpy.typing as npt
import patchlight
from cornell import Room, box, solve_by_command

Floats = npt.NDArray[np.float64]


def solve_by_hand(scene: patchlight.Scene, options: patchlight.AdaptiveOptions) -> list[bytes]:
    """The solution.glb of every cycle."""
    caster = patchlight.RayCaster(scene)
    emitted = patchlight.emitted_light(scene, options)
    mesh = patchlight.first_mesh(scene, options)
    coarse = patchlight.Exchange(scene, caster, mesh, emitted)
    system = patchlight.assemble(coarse, options)
    patches = patchlight.solve(coarse, system, options)
    lighting = patchlight.Lighting(coarse, emitted, system, patches, options)
    cycles = []
    for cycle in itertools.count():
        exchange = patchlight.Exchange(scene, caster, mesh, emitted)
        found = patchlight.estimate(exchange, lighting, options)
        B = patches.B if cycle == 0 else patchlight.patch_means(mesh, found.vertex_B)
        plan = patchlight.plan_next(exchange, B, found.error, lighting, emitted, options)
        if patchlight.finished(mesh, found.error, plan, cycle, options):
            nodes = patchlight.final_nodes(exchange, lighting, found.vertex_B, options)
            cycles.append(patchlight.encode_solution(scene, mesh, B, nodes.vertex_B, found.error, nodes.middle_B))
            return cycles
        cycles.append(patchlight.encode_solution(scene, mesh, B, found.vertex_B, found.error))
        mesh = patchlight.refine(scene, mesh, plan, options)
    return cycles


class SameBytes(unittest.TestCase):
    def check(self, options: patchlight.AdaptiveOptions, *words: str) -> None:
        with tempfile.TemporaryDirectory() as folder:
            run = Path(folder) / "run"
            solve_by_command(run, *words)
            by_command = [file.read_bytes() for file in sorted(run.glob("cycles/*/solution.glb"))]
        self.assertTrue(by_command)
        by_hand = solve_by_hand(box(), options)
        self.assertEqual(len(by_hand), len(by_command))
        for cycle, (mine, theirs) in enumerate(zip(by_hand, by_command, strict=True)):
            self.assertTrue(mine == theirs, f"cycle {cycle} differs")

    def test_lines_and_intensity(self) -> None:
        self.check(patchlight.AdaptiveOptions(max_elements=800), "--max-elements", "800")

    def test_links_and_quadratic_elements(self) -> None:
        options = patchlight.AdaptiveOptions(
            max_elements=800,
            elements="quadratic",
            final=patchlight.SolveOptions(solver="hierarchical", tolerance=0.05),
        )
        self.check(options, "--max-elements", "800", "--elements", "quadratic", "--solver", "hierarchical")

    def test_uniform_mesh_by_sampled_light(self) -> None:
        options = patchlight.AdaptiveOptions(
            refine="none", direct="sampled", max_elements=500, meshing=patchlight.MeshingOptions(max_elements=500)
        )
        self.check(options, "--refine", "none", "--direct", "sampled", "--max-elements", "500")

    def test_the_whole_loop_ends_the_same(self) -> None:
        scene, options = box(), patchlight.AdaptiveOptions(max_elements=800)
        steps: list[patchlight.AdaptiveStep] = []
        solution = patchlight.solve_adaptively(scene, options, steps.append)
        by_hand = solve_by_hand(scene, options)
        whole = [patchlight.encode_solution(scene, s.mesh, s.B, s.vertex_B, s.error, s.middle_B) for s in steps]
        self.assertTrue(whole == by_hand)
        self.assertEqual([s.cycle for s in steps], list(range(len(steps))))
        self.assertEqual((steps[0].stage, steps[-1].stage), ("rough", "final"))
        np.testing.assert_array_equal(solution.vertex_B, steps[-1].vertex_B)


class OwnSteps(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.room = Room(box(), patchlight.AdaptiveOptions(max_elements=1500, refine="intensity"))

    room: Room

    def test_own_indicator(self) -> None:
        def indicator(mesh: patchlight.PatchMesh, vertex_B: Floats) -> Floats:
            """How much B differs between a patch's corners, over its area: the lecture's."""
            corners = vertex_B[mesh.triangles]
            across = corners.max(axis=1) - corners.min(axis=1)
            eta: Floats = np.sqrt(mesh.areas * (across**2).sum(axis=1))
            return eta

        room, mesh = self.room, self.room.mesh
        errors = []
        for _ in range(4):
            found = patchlight.estimate(room.exchange(mesh), room.lighting, room.options)
            errors.append(found.error.relative)
            own = patchlight.ErrorEstimate(room.scene, mesh, found.vertex_B, indicator(mesh, found.vertex_B))
            B = patchlight.patch_means(mesh, found.vertex_B)
            plan = patchlight.mark(room.scene, mesh, B, own, room.options.mark)
            mesh = patchlight.refine(room.scene, mesh, plan, room.options)
        # What it refines by isn't the residual, but that falls all the same.
        self.assertLess(errors[-1], 0.8 * errors[0])
        self.assertGreater(len(mesh), len(room.mesh))
        # The same as the command's indicator of that name, apart from black patches and the edge that is halved.
        room.options.estimate.indicator = "vertex-difference"
        found = patchlight.estimate(room.exchange(mesh), room.lighting, room.options)
        room.options.estimate.indicator = "residual"
        mine, theirs = indicator(mesh, found.vertex_B), found.error.eta
        # Sums of three squares in another order: a few roundings.
        np.testing.assert_allclose(mine[theirs > 0], theirs[theirs > 0], rtol=1e-12)

    def test_own_marking(self) -> None:
        room, mesh = self.room, self.room.mesh
        found = patchlight.estimate(room.exchange(mesh), room.lighting, room.options)
        worst = np.argsort(-found.error.eta, kind="stable")[:10]
        plan = patchlight.RefinementPlan(worst, found.error.edge[worst])
        self.assertTrue(plan)
        finer = patchlight.refine(room.scene, mesh, plan, room.options)
        # Each halved edge splits one or two patches.
        self.assertGreaterEqual(len(finer), len(mesh) + 10)
        self.assertLessEqual(len(finer), len(mesh) + 40)
        self.assertAlmostEqual(finer.areas.sum(), mesh.areas.sum(), places=9)
        np.testing.assert_array_equal(plan.patches, worst)

    def test_plans_and_estimates_that_mean_nothing(self) -> None:
        room, mesh = self.room, self.room.mesh
        for patches, edges in (([len(mesh)], [0]), ([0], [3]), ([0, 0], [0, 1])):
            with self.assertRaises(ValueError):
                patchlight.refine(room.scene, mesh, patchlight.RefinementPlan(patches, edges), room.options)
        with self.assertRaises(ValueError):
            patchlight.RefinementPlan([1, 2], [0])
        vertex_B = np.zeros((mesh.vertex_count, 3))
        for eta in (np.full(len(mesh), np.nan), np.full(len(mesh), -1.0), np.zeros(len(mesh) - 1)):
            with self.assertRaises(ValueError):
                patchlight.ErrorEstimate(room.scene, mesh, vertex_B, eta)
        with self.assertRaises(ValueError):
            patchlight.patch_means(mesh, vertex_B[1:])
        with self.assertRaises(ValueError):
            patchlight.estimate(room.exchange(mesh), Room(box(), room.options).lighting, room.options)
        self.assertFalse(patchlight.RefinementPlan([]))

    def test_light_at_points(self) -> None:
        room, mesh = self.room, self.room.mesh
        found = patchlight.estimate(room.exchange(mesh), room.lighting, room.options)
        p = int(np.argmax(np.where(found.error.eta > 0, mesh.areas, 0)))
        middle = mesh.positions[mesh.triangles[p]].mean(axis=0)
        surface = int(mesh.patch_surface[p])
        point = patchlight.SurfacePoint(position=middle, limit=middle, surface=surface)
        H = room.lighting.irradiance(room.exchange(mesh), [point])
        material = room.scene.materials[room.scene.surfaces[surface].material]
        B = np.array(material.emission) + np.array(material.reflectance) * H[0]
        # A coarse mesh's linear light is within a third of the light found there.
        np.testing.assert_allclose(found.vertex_B[mesh.triangles[p]].mean(axis=0), B, rtol=0.33)


if __name__ == "__main__":
    unittest.main()
